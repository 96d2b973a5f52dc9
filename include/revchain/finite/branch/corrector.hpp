// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/branch/branch_links.hpp"
#include "revchain/finite/branch/state.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns the inner product that defines the arc of a branch. It is the mean of the products of
/// each link's tau, plus the product of log lambda.
REVCHAIN_LAZY
double inner(const BranchState& x, const BranchState& y) {
    double sum = 0;
    for (std::size_t m = 0; m < x.tau.size(); ++m) sum += x.tau[m] * y.tau[m];
    return sum / as_double(x.tau.size()) + x.log_height * y.log_height;
}
REVCHAIN_LAZY
BranchState moved(BranchState x, double times, const BranchState& direction) {
    for (std::size_t m = 0; m < x.tau.size(); ++m) x.tau[m] += times * direction.tau[m];
    x.log_height += times * direction.log_height;
    return x;
}
/// Scales a direction to length 1 along the arc and returns its former length.
REVCHAIN_LAZY
double normalise(BranchState& direction) {
    const double length = std::sqrt(inner(direction, direction));
    for (double& tau : direction.tau) tau /= length;
    direction.log_height /= length;
    return length;
}
REVCHAIN_LAZY
double largest_tau(const BranchState& x) {
    double largest = 0;
    for (const double tau : x.tau) largest = std::max(largest, std::abs(tau));
    return largest;
}
/// Returns the larger of a correction's length along the arc and 1/4 of its largest tau.
REVCHAIN_LAZY
double size_of(const BranchState& x) {
    return std::max(std::sqrt(inner(x, x)), largest_tau(x) / 4);
}

/// A solver of one step of Newton's method: the balance of a chain together with one condition. No
/// matrix is assembled, which keeps the digits of the slowest modes of long chains. Unknowns are
///     d  the changes of the links' reaches a sin delta (across the axis), which sum to
///     y  the changes of the pins' offsets, and
///     h  the change of log lambda.
/// The equations are
///     T y + h column = forces,      row . d + h corner = residual.
/// T is the tangent stiffness: that of link m between its pins, lambda sigma sec^3 delta/a + X,
/// less the weights at the pins on the diagonal. The column holds the derivatives of the links'
/// sideways pulls by log lambda. Row and corner are the derivatives of the condition by the reaches
/// and by log lambda. Links are eliminated from the free end up, with forces summed from there. The
/// topmost link and log lambda are solved together, because T is singular where a branch folds.
class BorderedChain {
   public:
    explicit BorderedChain(std::size_t size)
        : size_(size), below_(size), pivot_(size), force_(size), column_(size), row_(size) {}

    /// Factors the system at a shape, from the links' stiffnesses and weights at their pins, and
    /// the column, row and corner.
    template <class Link>
    void factor(const std::vector<double>& stiffness, const std::vector<Link>& links,
                const std::vector<double>& column, const std::vector<double>& row, double corner) {
        corner_ = corner;
        double dynamic = 0, eliminated = 0, row_below = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double k = stiffness[m], u = dynamic - as_double(links[m].moment);
            const double p = guarded(u + k, k), inverse = 1 / p, ratio = u * inverse;
            const double q = column[m] - eliminated, r = row_below + row[m];
            below_[m] = u, pivot_[m] = p, column_[m] = q, row_[m] = r;
            if (m + 1 == size_) break;
            corner_ -= r * inverse * q;
            row_below = (row_below * k - row[m] * u) * inverse;
            eliminated += ratio * q;
            dynamic = k * ratio - as_double(links[m].rest);
        }
    }

    /// Solves for given forces, summed from the free end, and a given residual of the condition.
    /// Fills `reach` with the changes of the reaches and returns the change of log lambda; both are
    /// NaN if the system is singular.
    double solve(const std::vector<double>& summed_forces, double residual,
                 std::vector<double>& reach) {
        const std::size_t top = size_ - 1;
        double eliminated = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double g = summed_forces[m] - eliminated;
            force_[m] = g;
            if (m == top) break;
            const double change = g / pivot_[m];
            residual -= row_[m] * change;
            eliminated += below_[m] * change;
        }
        // pivot x + column h = force,  row x + corner h = residual
        const double p = pivot_[top], q = column_[top], r = row_[top], g = force_[top];
        double x, h;
        if (std::abs(p) * std::abs(corner_) + std::abs(q) * std::abs(r) == 0)
            return degenerate(reach);
        if (std::abs(p) >= std::abs(q)) {
            h = (residual - r * (g / p)) / (corner_ - r * (q / p));
            x = (g - q * h) / p;
        } else {
            x = (residual - corner_ * (g / q)) / (r - corner_ * (p / q));
            h = (g - p * x) / q;
        }
        reach[top] = x;
        for (std::size_t m = top; m-- > 0;) {
            reach[m] = (force_[m] - column_[m] * h - below_[m] * x) / pivot_[m];
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
    /// For each link, with all below it eliminated: the dynamic stiffness at its lower pin, the
    /// pivot of its reach, and its entries of the forces, the column and the row.
    std::vector<double> below_, pivot_, force_, column_, row_;
    double corner_ = 0;
};

/// Newton's method in double for a chain and log lambda, in a plane across a direction.
class Corrector {
   public:
    explicit Corrector(BranchLinks<double> links)
        : links_(std::move(links)), border_(links_.size()), half_waves_are_kept_(links_.plain) {
        for (auto* each : {&tau_per_reach_, &column_, &stiffness_, &summed_forces_, &row_, &reach_,
                           &at_lower_, &at_upper_})
            each->resize(size());
        // cross < 0 if the pendulum length l of a link exceeds its length a
        for (const auto& link : links_.links) half_waves_are_kept_ &= !(link.cross < 0);
    }
    explicit Corrector(std::vector<Link<double>> chain)
        : Corrector(BranchLinks<double>(std::move(chain))) {}
    std::size_t size() const { return links_.size(); }
    const BranchLinks<double>& links() const { return links_; }
    /// Returns true if the number of half waves is constant along a branch. So it is for a chain
    /// with h >= 0 and l <= a for all links, positive pulls and a firm support on the axis: if a
    /// pin is on the axis, its neighbours are on opposite sides.
    bool half_waves_are_kept() const { return half_waves_are_kept_; }

    struct Change {
        BranchState correction, tangent;
    };
    /// Returns one step of Newton's method and the direction of the branch, from the same factors.
    /// The correction is orthogonal to `across`; the tangent has length 1 and is on its side. All
    /// is NaN if the system is singular.
    Change step(const BranchState& at, const BranchState& across) {
        const std::size_t n = links_.size();
        const double height = std::exp(at.log_height), per_link = 1 / as_double(n);
        Change change{{std::vector<double>(n), 0}, {std::vector<double>(n), 0}};
        balance_at(at, height);
        for (std::size_t m = 0; m < n; ++m) row_[m] = per_link * across.tau[m] * tau_per_reach_[m];
        border_.factor(stiffness_, links_.links, column_, row_, across.log_height);
        const auto solve = [&](double residual, BranchState& direction) {
            direction.log_height = border_.solve(summed_forces_, residual, reach_);
            for (std::size_t m = 0; m < n; ++m) direction.tau[m] = reach_[m] * tau_per_reach_[m];
        };
        solve(0, change.correction);
        summed_forces_.assign(n, 0.0);
        solve(1, change.tangent);
        normalise(change.tangent);
        return change;
    }

    /// Returns the state on the branch in the plane through `start` across a direction. Returns
    /// none if a step is longer than `farthest` or longer than `contraction` times the one before,
    /// if the system is singular, or if the last of seven steps is not small. Convergence is
    /// quadratic: after a step below 1e-7 the error is rounding.
    std::optional<BranchPoint> corrected(BranchState start, const BranchState& across,
                                         double farthest, double contraction = 0.3) {
        constexpr int most_steps = 7;
        double last = 0;
        for (int number = 0; number < most_steps; ++number) {
            Change change = step(start, across);
            const double size = size_of(change.correction);
            if (!(size <= farthest) || std::isnan(inner(change.tangent, change.tangent)))
                return std::nullopt;
            const bool small = size < 1e-7;
            if (number > 0 && !small && size > contraction * last) return std::nullopt;
            start = moved(std::move(start), 1, change.correction);
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
            const double d = links_.links[m].length * links_.inclined(m, at.tau[m]).sine;
            y += d, reached += std::abs(d);
            if (!(std::abs(y) > 1e-13 * reached)) return 0;
            waves += y * last < 0;
            last = y;
        }
        return waves;
    }

   private:
    /// Computes the residual forces, summed from the free end, the stiffnesses and the column.
    void balance_at(const BranchState& at, double height) {
        const std::size_t n = links_.size();
        const double speed = links_.speed_at(height);
        double y = links_.radius;
        for (std::size_t m = n; m-- > 0;) {
            const Link<double>& link = links_.links[m];
            const Inclined here = links_.inclined(m, at.tau[m]);
            // lambda times the pull along and across the axis
            const double along = height * links_.pull(m, speed), across = along * here.tangent;
            const double d = link.length * here.sine, upper = y;
            tau_per_reach_[m] = 1 / (link.length * here.slope);
            column_[m] = across;
            if (!links_.spin.empty())
                column_[m] = height * links_.growing_pull(m, speed) * here.tangent;
            stiffness_[m] = along / link.length * here.steepening + link.cross;
            summed_forces_[m] = -across - link.cross * d;
            y += d;
            at_lower_[m] = link.moment * y, at_upper_[m] = link.rest * upper;
        }
        double sum = 0;
        for (std::size_t m = 0; m < n; ++m) {
            summed_forces_[m] += sum + at_lower_[m];
            sum += at_lower_[m] + at_upper_[m];
        }
    }

    BranchLinks<double> links_;
    BorderedChain border_;
    bool half_waves_are_kept_;
    std::vector<double> tau_per_reach_;  ///< derivative of tau by the reach a sin delta
    std::vector<double> column_, stiffness_, summed_forces_, row_, reach_;
    std::vector<double> at_lower_, at_upper_;  ///< weights at the pins of a link times offsets
};

}  // namespace revchain::finite
