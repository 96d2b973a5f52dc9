// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/newton.hpp"
#include "revchain/finite/branch/branch_links.hpp"
#include "revchain/finite/branch/corrector.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A condition on shape and height, in double-double, solved together with the balance of forces.
struct Condition {
    virtual ~Condition() = default;
    /// Returns the given minus the actual value at offsets of the pins, and the derivative of the
    /// actual value by log lambda. Fills `row` with its derivatives by the reaches a sin delta.
    virtual std::pair<Fine, double> shortfall(const BranchLinks<Fine>& links,
                                              const std::vector<Fine>& offset, const Fine& height,
                                              std::vector<double>& row) const = 0;
    /// Returns the condition's change for a relative change 1 of the given number; 0 without one.
    virtual double size(const Fine& height) const = 0;
    virtual bool gives_height() const { return false; }
};

struct GivenHeight : Condition {
    Fine wanted;
    explicit GivenHeight(Fine height) : wanted(std::move(height)) {}
    std::pair<Fine, double> shortfall(const BranchLinks<Fine>&, const std::vector<Fine>&,
                                      const Fine& height, std::vector<double>& row) const override {
        std::fill(row.begin(), row.end(), 0.0);
        return {(wanted - height) / wanted, as_double(height / wanted)};
    }
    double size(const Fine&) const override { return 1; }
    bool gives_height() const override { return true; }
};

/// The condition sin(inclination of the lowest link - wanted) = 0, where `wanted` has the link's
/// sign. It is accurate near the horizontal too.
struct GivenTipInclination : Condition {
    Fine sine, cosine;
    double angle;
    explicit GivenTipInclination(double wanted)
        : sine(DoubleDouble(std::sin(static_cast<long double>(wanted))).word()),
          cosine(DoubleDouble(std::cos(static_cast<long double>(wanted))).word()),
          angle(wanted) {}
    std::pair<Fine, double> shortfall(const BranchLinks<Fine>& links, const std::vector<Fine>& y,
                                      const Fine&, std::vector<double>& row) const override {
        std::fill(row.begin(), row.end(), 0.0);
        const Fine &a = links.links[0].length, d = y[0] - y[1], s = d / a, c = cosine_of(a, d);
        const Fine signed_sine = d < Fine(0) ? -sine : sine;
        row[0] = as_double((cosine + s * signed_sine / c) / a);
        return {signed_sine * c - s * cosine, 0.0};
    }
    double size(const Fine&) const override { return angle; }
};

/// The condition that gives the free end's distance from the axis, on its current side.
struct GivenTipRadius : Condition {
    Fine wanted;
    explicit GivenTipRadius(Fine radius) : wanted(std::move(radius)) {}
    std::pair<Fine, double> shortfall(const BranchLinks<Fine>&, const std::vector<Fine>& y,
                                      const Fine&, std::vector<double>& row) const override {
        std::fill(row.begin(), row.end(), 1.0);
        return {(y[0] < Fine(0) ? -wanted : wanted) - y[0], 0.0};
    }
    double size(const Fine&) const override { return as_double(wanted); }
};

/// The condition that gives the tension T at the support: |sum of weights times offsets| = lambda
/// sqrt(T^2 - S^2), with S the weight on the topmost pin.
struct GivenTopTension : Condition {
    Fine across;   ///< the sideways part of T, positive
    double share;  ///< relative change of `across` per relative change of T
    GivenTopTension(Fine sideways, double sensitivity)
        : across(std::move(sideways)), share(sensitivity) {}
    std::pair<Fine, double> shortfall(const BranchLinks<Fine>& links, const std::vector<Fine>& y,
                                      const Fine& height, std::vector<double>& row) const override {
        Fine sum(0);
        double weights = 0;
        for (std::size_t m = 0; m < links.bodies(); ++m) {
            const Link<Fine>& link = links.links[m];
            sum = sum + link.moment * y[m] + link.rest * y[m + 1];
            row[m] = weights + as_double(link.moment);
            weights = row[m] + as_double(link.rest);
        }
        if (links.spring) row.back() = weights;
        const Fine pull = sum < Fine(0) ? -(height * across) : height * across;
        return {pull - sum, -as_double(pull)};
    }
    double size(const Fine& height) const override {
        return share * std::abs(as_double(height * across));
    }
};

/// The plane across the branch at one of its points: it fixes the point on the arc, even at folds.
/// The point is given in double. What is missing below its rounding counts as 0. Otherwise changes of
/// an almost vertical link, relative to its inclination, would not become small.
struct GivenPlace : Condition {
    const BranchPoint* point;
    explicit GivenPlace(const BranchPoint& p) : point(&p) {}
    std::pair<Fine, double> shortfall(const BranchLinks<Fine>& links, const std::vector<Fine>& y,
                                      const Fine& height, std::vector<double>& row) const override {
        double sum = 0, rounded = 0;
        const double per_link = 1 / as_double(links.size());
        for (std::size_t m = 0; m < links.size(); ++m) {
            const Fine &a = links.links[m].length, d = y[m] - y[m + 1],
                       c = links.is_spring(m) ? Fine(1) : cosine_of(a, d);
            const double tangent = as_double(d / (a * c)), length = as_double(a),
                         slope = links.is_spring(m) ? std::hypot(1, tangent) : as_double(c * c),
                         tau = point->state.tau[m], along = per_link * point->tangent.tau[m];
            row[m] = along / (length * slope);
            sum += along * (tau - std::asinh(tangent));
            rounded += std::abs(along) * (1 + std::abs(tau));
        }
        const double log_height = point->state.log_height, rise = point->tangent.log_height;
        sum += rise * (log_height - std::log(as_double(height)));
        rounded += std::abs(rise) * (1 + std::abs(log_height));
        return {std::abs(sum) > 0x1p-51 * rounded ? Fine(sum) : Fine(0), rise};
    }
    double size(const Fine&) const override { return 0; }
};

struct Polished {
    Balanced<Fine> shape;
    Fine height;
    double residual = 0;  ///< largest residual force at a pin over the sum of sizes of its terms
    /// Largest change of an inclination (rad) for relative changes 1 of all forces, in a few
    /// patterns of signs, or of the given number. The exact maximum would cost O(N^2).
    double condition = 0;
};

/// Returns `Polished::condition`, from the factors at a shape and the sizes of forces. `given` is
/// the condition's change for that of the number. `tau_per_reach` is the derivative of tau by the
/// reach, 1/(a cos^2); 1/a for a spring.
REVCHAIN_LAZY
double condition_of(const BranchLinks<Fine>& links, BorderedChain& border,
                    const std::vector<double>& size, const std::vector<double>& tau_per_reach,
                    double given) {
    const std::size_t n = links.size();
    std::vector<double> summed_forces(n), reach(n);
    double worst = 0;
    for (unsigned pattern = 0; pattern < 5; ++pattern) {
        unsigned state = 2463534242U + pattern;
        double total = 0;
        for (std::size_t m = 0; m < n; ++m) {
            state ^= state << 13, state ^= state >> 17, state ^= state << 5;
            total += pattern > 0 && (state & 64U) ? -size[m] : size[m];
            summed_forces[m] = pattern < 4 ? total : 0.0;
        }
        border.solve(summed_forces, pattern < 4 ? 0.0 : given, reach);
        for (std::size_t m = 0; m < links.bodies(); ++m) {
            const double turn =
                reach[m] * std::sqrt(tau_per_reach[m] / as_double(links.links[m].length));
            worst = std::max(worst, std::abs(turn));
        }
    }
    return worst;
}

/// Returns the offsets of the pins of a state; the firm end of the support is last.
REVCHAIN_LAZY
std::vector<Fine> offsets_of(const BranchLinks<Fine>& links, const BranchState& state) {
    std::vector<Fine> y(links.size() + 1);
    y.back() = links.radius;
    for (std::size_t m = links.size(); m-- > 0;) {  // from a - a sin, accurate near the horizontal
        const double tau = state.tau[m];
        const Fine &a = links.links[m].length,
                   d = a * (Fine(1) - Fine(2) / (Fine(1) + Fine(std::exp(2 * std::abs(tau)))));
        const bool small = links.is_spring(m) || std::abs(tau) < 0.1;
        y[m] = y[m + 1] + (small ? a * Fine(links.is_spring(m) ? std::sinh(tau) : std::tanh(tau))
                           : tau < 0 ? -d
                                     : d);
    }
    return y;
}

/// Returns the result of Newton's method on all pins and the height with one condition, as in
/// `balance`. Each step costs O(N).
REVCHAIN_LAZY
Polished polished(const BranchLinks<Fine>& links, const BranchState& start,
                  const Condition& condition) {
    using std::abs;
    const std::size_t n = links.size();
    Polished result{{offsets_of(links, start), {}}, Fine(std::exp(start.log_height))};
    std::vector<Fine>& y = result.shape.offset;
    Fine& height = result.height;
    BorderedChain border(n);
    std::vector<double> stiffness(n), column(n), summed_forces(n), size(n), row(n), reach(n),
        tau_per_reach(n);
    double last = 1;
    for (int round = 0; round < 40; ++round) {
        Fine sum(0), before(0);
        const Fine speed = links.speed_at(height);
        double below_size = 0;
        result.residual = 0;
        for (std::size_t m = 0; m < n; ++m) {
            const Link<Fine>& link = links.links[m];
            const Fine d = y[m] - y[m + 1];
            if (!links.is_spring(m) && !(abs(d) < link.length)) return result;
            const Fine cosine = links.is_spring(m) ? Fine(1) : cosine_of(link.length, d),
                       lambda_pull = height * links.pull(m, speed),
                       tangent = d / (link.length * cosine), pulled = lambda_pull * tangent,
                       turn = link.cross * d, at_lower = link.moment * y[m],
                       at_upper = link.rest * y[m + 1];
            const Fine whole = sum + at_lower - pulled - turn;
            const double c = as_double(cosine), a = as_double(link.length);
            const double pull = as_double(pulled);
            summed_forces[m] = as_double(whole), column[m] = pull;
            if (!links.spin.empty())
                column[m] = as_double(height * links.growing_pull(m, speed) * tangent);
            tau_per_reach[m] = 1 / (a * c * c);
            stiffness[m] = as_double(lambda_pull) / (a * c * c * c) + as_double(link.cross);
            const double parts = std::abs(pull) + as_double(abs(turn));
            size[m] = below_size + parts + as_double(abs(at_lower));
            below_size = parts + as_double(abs(at_upper));
            const double force = std::abs(as_double(whole - before));
            if (size[m] > 0) result.residual = std::max(result.residual, force / size[m]);
            before = whole;
            sum = sum + at_lower + at_upper;
        }
        const auto [missing, corner] = condition.shortfall(links, y, height, row);
        border.factor(stiffness, links.links, column, row, corner);
        if (result.shape.converged) break;  // the factors are now those of the result
        const double log_change = border.solve(summed_forces, as_double(missing), reach);
        // Changes are relative to a link's own inclination and to the steepest one. The start was
        // summed in double. The offset of an almost vertical link may thus be rounding alone, for
        // example 1e-18 instead of 1e-40. This is harmless.
        double largest = std::abs(log_change), steepest = 0, farthest = 0, x = 0;
        for (std::size_t m = n; m-- > 0;) {
            // a link that happens to be vertical counts with what double-double offsets resolve
            const double lower = std::abs(as_double(y[m])), upper = std::abs(as_double(y[m + 1])),
                         there = std::abs(as_double(y[m] - y[m + 1])) * tau_per_reach[m],
                         told = std::max(
                             {there, 1e-18 * tau_per_reach[m] * std::max(lower, upper), 1e-280}),
                         change = std::abs(reach[m]) * tau_per_reach[m];
            largest = std::max(largest, change / (links.is_spring(m) ? told : std::min(1.0, told)));
            steepest = std::max(steepest, there), farthest = std::max(farthest, change);
            x += reach[m];
            y[m] = y[m] + Fine(x);
        }
        if (!(std::abs(log_change) < 1) ||
            !(farthest < (steepest > 0 ? std::min(1.0, steepest) : 1.0)))
            return result;
        height = height + height * Fine(log_change);
        // the size of the next step if convergence continues at this rate
        const double next = largest * std::min(1.0, largest / std::min(1.0, last));
        result.shape.converged =
            (round > 0 && next < 1e-18) || (largest < 1e-14 && largest > 0.25 * last);
        last = largest;
    }
    if (result.shape.converged)
        result.condition = condition_of(links, border, size, tau_per_reach, condition.size(height));
    return result;
}

/// Returns a shape found at a height by Newton's method, `verified` at the heights `within`.
REVCHAIN_LAZY
SteadyShape verified_shape(const BranchSystem& system, const Fine& height, const Span& within,
                           Balanced<Fine> found, bool height_is_given) {
    if (!system.rig)
        return verified_shape(system.chain, enclosed<Far>(system.chain.links), height, within,
                              std::move(found), height_is_given);
    const RiggedLinks rig = system.rigged_at(height);
    found.offset.resize(rig.links.size() + 1);  // without the firm end of a spring
    found.posture = rig.posture;
    return verified_shape(rig, folded_links(rig), height, within, std::move(found),
                          height_is_given);
}

/// Returns the shape near a point of a branch that satisfies a condition. At a given height its
/// bound is that of `verified`. If the height is found, the bound adds the residual of Newton's
/// method times the condition number. If nothing is proved, as at a fold, the bound is this
/// product.
REVCHAIN_LAZY
std::optional<SteadyShape> shape_at(const BranchSystem& system, const BranchState& near,
                                    const Condition& condition) {
    auto found = polished(system.links, near, condition);
    if (!found.shape.converged) return std::nullopt;
    const bool given = condition.gives_height();
    const auto height = given ? enclosed<Far>(found.height) : Span(Far(found.height));
    SteadyShape shape = verified_shape(system, found.height, height, std::move(found.shape), given);
    const bool proved = shape.error_bound < 1;
    if (given && proved) return shape;
    shape.condition = found.condition;
    shape.error_bound =
        (proved ? shape.error_bound : 0x1p-52) + found.condition * (found.residual + 1e-30);
    return shape;
}

}  // namespace revchain::finite
