// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/branch/branch_links.hpp"
#include "revchain/finite/branch/state.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns the inner product of the arc: mean product of the tau plus product of log lambda.
REVCHAIN_LAZY
double inner(const BranchState& x, const BranchState& y) {
    double sum = 0;
    for (std::size_t m = 0; m < x.rise.size(); ++m) sum += x.rise[m] * y.rise[m];
    return sum / as_double(x.rise.size()) + x.log_height * y.log_height;
}
REVCHAIN_LAZY
BranchState moved(BranchState x, double share, const BranchState& direction) {
    for (std::size_t m = 0; m < x.rise.size(); ++m) x.rise[m] += share * direction.rise[m];
    x.log_height += share * direction.log_height;
    return x;
}
/// Scales a direction to length 1 along the arc and returns its former length.
REVCHAIN_LAZY
double normalise(BranchState& direction) {
    const double length = std::sqrt(inner(direction, direction));
    for (double& rise : direction.rise) rise /= length;
    direction.log_height /= length;
    return length;
}
REVCHAIN_LAZY
double largest_rise(const BranchState& x) {
    double largest = 0;
    for (const double rise : x.rise) largest = std::max(largest, std::abs(rise));
    return largest;
}
/// Returns the larger of a correction's length along the arc and 1/4 of its largest tau.
REVCHAIN_LAZY
double size_of(const BranchState& x) {
    return std::max(std::sqrt(inner(x, x)), largest_rise(x) / 4);
}

/// A linear solver for the balance of a chain together with one condition. The unknowns are changes
/// d of the links' reaches a sin delta, changes y of the pins' offsets, and h of log lambda:
///     T y + h (change of pull along log lambda) = forces,      sum row d + row_height h = left.
/// T is the tangent stiffness of the elements, lambda sigma sec^3 delta/a + X between pins, less
/// the masses on the diagonal. Elements are eliminated from the free end up, with forces summed
/// from there. No matrix is assembled, which keeps the digits of the slowest modes of long chains.
/// The last pin and log lambda are solved together, as T is singular where a branch folds.
class BorderedChain {
   public:
    explicit BorderedChain(std::size_t size)
        : size_(size),
          below_(size),
          pivot_(size),
          force_(size),
          along_height_(size),
          weight_(size) {}

    /// Factors the system at a shape, from element stiffnesses, masses at lower and upper pins,
    /// pull = lambda sigma tan delta, and the condition's row and derivative by log lambda.
    template <class Link>
    void factor(const std::vector<double>& stiffness, const std::vector<Link>& links,
                const std::vector<double>& pull, const std::vector<double>& row,
                double row_height) {
        corner_ = row_height;
        double dynamic = 0, eliminated = 0, share = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double k = stiffness[m], u = dynamic - as_double(links[m].moment);
            const double p = guarded(u + k, k), inverse = 1 / p, ratio = u * inverse;
            const double h = pull[m] - eliminated, whole = share + row[m];
            below_[m] = u, pivot_[m] = p, along_height_[m] = h, weight_[m] = whole;
            if (m + 1 == size_) break;
            corner_ -= whole * inverse * h;
            share = (share * k - row[m] * u) * inverse;
            eliminated += ratio * h;
            dynamic = k * ratio - as_double(links[m].rest);
        }
    }

    /// Solves for given forces, summed from the free end, and a given residual of the condition.
    /// Fills `reach` with the changes of the reaches and returns the change of log lambda.
    double solve(const std::vector<double>& summed, double left, std::vector<double>& reach) {
        const std::size_t top = size_ - 1;
        double eliminated = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double g = summed[m] - eliminated;
            force_[m] = g;
            if (m == top) break;
            const double share = g / pivot_[m];
            left -= weight_[m] * share;
            eliminated += below_[m] * share;
        }
        // pivot x + along_height h = force,  weight x + corner h = left
        const double p = pivot_[top], q = along_height_[top], r = weight_[top], g = force_[top];
        double x, h;
        if (std::abs(p) * std::abs(corner_) + std::abs(q) * std::abs(r) == 0)
            return degenerate(reach);
        if (std::abs(p) >= std::abs(q)) {
            h = (left - r * (g / p)) / (corner_ - r * (q / p));
            x = (g - q * h) / p;
        } else {
            x = (left - corner_ * (g / q)) / (r - corner_ * (p / q));
            h = (g - p * x) / q;
        }
        reach[top] = x;
        for (std::size_t m = top; m-- > 0;) {
            reach[m] = (force_[m] - along_height_[m] * h - below_[m] * x) / pivot_[m];
            x += reach[m];
        }
        return h;
    }

   private:
    static double guarded(double pivot, double stiffness) {
        const double least = 1e-30 * std::abs(stiffness);
        return std::abs(pivot) < least ? least : pivot;
    }
    static double degenerate(std::vector<double>& reach) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        reach.assign(reach.size(), unknown);
        return unknown;
    }

    std::size_t size_;
    std::vector<double> below_, pivot_, force_, along_height_, weight_;
    double corner_ = 0;
};

/// Newton's method in double on a chain and its height, in a plane across a direction.
class Corrector {
   public:
    explicit Corrector(BranchLinks<double> links)
        : links_(std::move(links)), border_(links_.size()), half_waves_are_kept_(links_.plain) {
        for (auto* each : {&growth_, &along_, &stiffness_, &left_, &row_, &reach_})
            each->resize(size());
        for (const auto& link : links_.links) half_waves_are_kept_ &= !(link.cross < 0);
    }
    explicit Corrector(std::vector<Link<double>> chain)
        : Corrector(BranchLinks<double>(std::move(chain))) {}
    std::size_t size() const { return links_.size(); }
    const BranchLinks<double>& links() const { return links_; }
    /// Returns true if the number of half waves is constant along a branch: in chains with l <= a
    /// for all links. There a pin on the axis has its neighbours on opposite sides.
    bool half_waves_are_kept() const { return half_waves_are_kept_; }

    struct Change {
        BranchState correction, tangent;
    };
    /// Returns one step of Newton's method and the direction of the branch, from the same factors.
    /// The correction is orthogonal to `across`; the tangent has length 1 and is on its side.
    Change step(const BranchState& at, const BranchState& across) {
        const std::size_t n = links_.size();
        const double height = std::exp(at.log_height), share = 1 / as_double(n);
        Change change{{std::vector<double>(n), 0}, {std::vector<double>(n), 0}};
        balance_at(at, height);
        for (std::size_t m = 0; m < n; ++m) row_[m] = share * across.rise[m] * growth_[m];
        border_.factor(stiffness_, links_.links, along_, row_, across.log_height);
        const auto in_rise = [&](BranchState& direction) {
            for (std::size_t m = 0; m < n; ++m) direction.rise[m] = reach_[m] * growth_[m];
        };
        change.correction.log_height = border_.solve(left_, 0, reach_);
        in_rise(change.correction);
        left_.assign(n, 0.0);
        change.tangent.log_height = border_.solve(left_, 1, reach_);
        in_rise(change.tangent);
        normalise(change.tangent);
        return change;
    }

    /// Returns the state on the branch in the plane through `start` across a direction. Returns
    /// none if a step is longer than `farthest`, or longer than `contraction` times the one before.
    std::optional<BranchPoint> corrected(BranchState start, const BranchState& across,
                                         double farthest, double contraction = 0.3) {
        double last = 0;
        for (int round = 0; round < 12; ++round) {
            Change change = step(start, across);
            const double size = size_of(change.correction);
            if (!(size <= farthest) || !(inner(change.tangent, change.tangent) < 2))
                return std::nullopt;
            const bool small = size < 1e-7;
            if (round > 0 && !small && size > contraction * last) return std::nullopt;
            if (round > 5 && !small) return std::nullopt;
            start = moved(std::move(start), 1, change.correction);
            // convergence is quadratic: after a step of 1e-7 the error is rounding
            if (small) {
                const int waves = half_waves(start);
                return BranchPoint{std::move(start), std::move(change.tangent), 0, waves};
            }
            last = size;
        }
        return std::nullopt;
    }

    /// Returns 1 + the sign changes of the offsets; 0 if rounding leaves a sign undecided.
    int half_waves(const BranchState& at) const {
        double y = links_.radius, last = 0, reached = std::abs(y);
        int waves = 1;
        for (std::size_t m = links_.size(); m-- > 0;) {
            const double d = links_.links[m].length * links_.inclined(m, at.rise[m]).sine;
            y += d, reached += std::abs(d);
            if (!(std::abs(y) > 1e-13 * reached)) return 0;
            waves += y * last < 0;
            last = y;
        }
        return waves;
    }

   private:
    /// Computes residual forces, summed from the free end, and stiffnesses.
    void balance_at(const BranchState& at, double height) {
        const std::size_t n = links_.size();
        const double speed = links_.speed_at(height);
        double y = links_.radius;
        for (std::size_t m = n; m-- > 0;) {
            const Link<double>& link = links_.links[m];
            const Inclined here = links_.inclined(m, at.rise[m]);
            const double factor = height * links_.pull(m, speed), pull = factor * here.tangent;
            const double d = link.length * here.sine, upper = y;
            growth_[m] = 1 / (link.length * here.slope);
            along_[m] = pull;
            if (!links_.spin.empty())
                along_[m] = height * links_.growing_pull(m, speed) * here.tangent;
            stiffness_[m] = factor / link.length * here.steepening + link.cross;
            left_[m] = -pull - link.cross * d;
            y += d;
            // moments of the link's own weight, summed from the free end below
            row_[m] = link.moment * y, reach_[m] = link.rest * upper;
        }
        double sum = 0;
        for (std::size_t m = 0; m < n; ++m) {
            left_[m] += sum + row_[m];
            sum += row_[m] + reach_[m];
        }
    }

    BranchLinks<double> links_;
    BorderedChain border_;
    bool half_waves_are_kept_;
    std::vector<double> growth_, along_, stiffness_, left_, row_, reach_;
};

}  // namespace revchain::finite
