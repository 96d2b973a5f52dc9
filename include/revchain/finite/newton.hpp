// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/links.hpp"

namespace revchain::finite {

/// A steady shape as offsets of the pins, free end first, the support's 0 last; what Newton's method left of the balance.
template <class S>
struct Balanced {
    std::vector<S> offset;
    double residual = 0;   ///< largest force left over at a pin, over the sum of sizes of its terms
    double condition = 0;  ///< largest change of a sine for relative changes of that size in the links' numbers
    bool converged = false;
};

namespace detail {

/// cos d of sin d = d/a, from (a - d)(a + d): the inclination may be all but a right angle.
template <class S>
S cosine_of(const S& length, const S& difference) {
    using std::sqrt;
    return sqrt((length - difference) * (length + difference)) / length;
}

}  // namespace detail

/// Newton's method on all pins at once, from offsets near a steady shape: the balance of forces at each pin in S, its
/// derivative, the tridiagonal tangent stiffness  lambda k sec^3 [1 -1; -1 1] - M  of the elements, in double. What is
/// small is kept to its own digits, tips of 1e-100 and links all but horizontal. Cost O(N) a step.
template <class S>
Balanced<S> balance(const std::vector<Link<S>>& links, const S& height, std::vector<S> start, int most_steps = 60) {
    using std::abs;
    const std::size_t n = links.size();
    Balanced<S> result{std::move(start), 0, 0, false};
    std::vector<S>& y = result.offset;
    y[n] = S(0);
    std::vector<double> diagonal(n), upper(n), force(n), change(n), size(n);
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
        S carried(0);  // lambda sigma tan d + a X sin d, minus what mass asks, of the link below
        double below_stiffness = 0, below_mass = 0, below_size = 0;
        result.residual = 0;
        for (std::size_t m = 0; m < n; ++m) {
            const Link<S>& link = links[m];
            const S d = y[m] - y[m + 1];
            if (!(abs(d) < link.length)) return result;
            const S cosine = detail::cosine_of(link.length, d), tangent = d / (link.length * cosine);
            const S pull = height * link.pull * tangent, turn = link.cross * d, at_lower = link.moment * y[m],
                    at_upper = link.rest * y[m + 1];
            // Forces times lambda on the lower pin: pull - W h/a (its own offset) + X d ..., on the upper the opposite.
            const S lower = pull + turn - at_lower;
            const S left = carried + lower;
            force[m] = -static_cast<double>(left);
            const double c = static_cast<double>(cosine), a = static_cast<double>(link.length);
            const double stiffness =
                static_cast<double>(height * link.pull) / (a * c * c * c) + static_cast<double>(link.cross);
            diagonal[m] = below_stiffness - below_mass + stiffness - static_cast<double>(link.moment);
            upper[m] = -stiffness;
            size[m] = below_size + static_cast<double>(abs(pull)) + static_cast<double>(abs(turn)) +
                      static_cast<double>(abs(at_lower));
            result.residual = std::max(result.residual, size[m] > 0 ? std::abs(force[m]) / size[m] : 0.0);
            carried = -(pull + turn) - at_upper;
            below_stiffness = stiffness, below_mass = static_cast<double>(link.rest);
            below_size =
                static_cast<double>(abs(pull)) + static_cast<double>(abs(turn)) + static_cast<double>(abs(at_upper));
        }
        // Elimination from the tip up, substitution from the support down.
        for (std::size_t m = 0; m < n; ++m) {
            double pivot = diagonal[m], right = force[m];
            if (m > 0) {
                const double factor = upper[m - 1] / change[m - 1];
                pivot -= factor * upper[m - 1];
                right -= factor * force[m - 1];
            }
            if (pivot == 0) pivot = std::numeric_limits<double>::min();
            change[m] = pivot, force[m] = right;
        }
        double above = 0, largest = 0;
        for (std::size_t m = n; m-- > 0;) {
            above = (force[m] - upper[m] * above) / change[m];
            const double share = static_cast<double>(abs(y[m]));
            largest = std::max(largest, share > 0 ? std::abs(above) / share : std::abs(above));
            y[m] = y[m] + S(above);
        }
        if (!(largest < std::numeric_limits<double>::infinity())) return result;
        if (largest < 1e-14 && (largest > 0.25 * last || largest < static_cast<double>(epsilon<S>()))) {
            result.converged = true;
            break;
        }
        last = largest;
    }
    return result;
}

}  // namespace revchain::finite
