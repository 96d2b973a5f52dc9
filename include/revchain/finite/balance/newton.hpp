// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/support_end.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A steady shape as offsets of the pins, free end first, support last.
template <class S>
struct Balanced {
    std::vector<S> offset;
    std::vector<Posture> posture;  ///< of each link; empty if all hang
    bool converged = false;        ///< whether Newton's method reached the last digits of S
    std::vector<S> tangent{};      ///< of links, if offsets fail near the horizontal; else empty

    bool stands(std::size_t m) const { return !posture.empty() && posture[m] == Posture::stands; }
    void mirror() {
        for (S& y : offset) y = -y;
        for (S& t : tangent) t = -t;
    }
};

/// Returns cos d from sin d = difference/length. It is accurate near a right angle.
template <class S>
S cosine_of(const S& length, const S& difference, bool stands = false) {
    using std::sqrt;
    const S size = sqrt((length - difference) * (length + difference)) / length;
    return stands ? -size : size;
}

template <class S>
S cosine_in(const Balanced<S>& shape, const std::vector<Link<S>>& links, std::size_t m) {
    if (shape.tangent.empty())
        return cosine_of(links[m].length, shape.offset[m] - shape.offset[m + 1], shape.stands(m));
    const S size = cosine_at(shape.tangent[m]);
    return shape.stands(m) ? -size : size;
}
template <class S>
S tangent_in(const Balanced<S>& shape, const std::vector<Link<S>>& links, std::size_t m) {
    if (!shape.tangent.empty()) return shape.tangent[m];
    const S d = shape.offset[m] - shape.offset[m + 1];
    return d / (links[m].length * cosine_of(links[m].length, d, shape.stands(m)));
}

/// Solves a symmetric tridiagonal system. `x` is the right side on entry, the solution on return.
/// `upper[m]` couples rows m and m + 1; its last entry is not used. Pivots overwrite the diagonal.
REVCHAIN_LAZY
void solve_tridiagonal(std::vector<double>& diagonal, const std::vector<double>& upper,
                       std::vector<double>& x) {
    for (std::size_t m = 0; m < x.size(); ++m) {
        if (m > 0) {
            const double share = upper[m - 1] / diagonal[m - 1];
            diagonal[m] -= share * upper[m - 1], x[m] -= share * x[m - 1];
        }
        if (diagonal[m] == 0) diagonal[m] = std::numeric_limits<double>::min();
    }
    for (std::size_t m = x.size(); m-- > 0;)
        x[m] = (x[m] - (m + 1 < x.size() ? upper[m] * x[m + 1] : 0.0)) / diagonal[m];
}

/// Returns the steady shape near the offsets `start` with the given postures, by Newton's method on
/// all pins at once. The forces at the pins are computed in S. Their derivative is computed in
/// double: the tridiagonal tangent stiffness lambda k sec^3 [1 -1; -1 1] - M of the elements. Tips
/// of 1e-100 and almost horizontal links keep their relative accuracy. Each step costs O(N).
/// Iterations that free the height (finite/branch) and the one of the proof stay separate: one loop
/// for all took 26 lines more than it saved.
template <class S, class End = OnAxis>
Balanced<S> balance(const std::vector<Link<S>>& links, const S& height, std::vector<S> start,
                    std::vector<Posture> posture = {}, const End& support = {}) {
    using std::abs;
    constexpr int max_steps = 60;
    const std::size_t n = links.size();
    Balanced<S> result{std::move(start), std::move(posture)};
    std::vector<S>& y = result.offset;
    support.place(y);
    const std::size_t rows = n + (support.yields() ? 1 : 0);        // with the topmost pin
    std::vector<double> diagonal(rows), upper(rows), change(rows);  // change: forces, then steps
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < max_steps; ++step) {
        S from_below(
            0);  // lambda sigma tan d + a X sin d, less centrifugal force, of the link below
        double below_stiffness = 0, below_mass = 0;
        for (std::size_t m = 0; m < n; ++m) {
            const Link<S>& link = links[m];
            const S d = y[m] - y[m + 1];
            if (!(abs(d) < link.length)) return result;
            const S cosine = cosine_of(link.length, d, result.stands(m)),
                    tangent = d / (link.length * cosine);
            const S pull = height * link.pull * tangent, turn = link.cross * d,
                    at_lower = link.moment * y[m], at_upper = link.rest * y[m + 1];
            // lambda times the force of the link on its lower pin, opposite on its upper pin
            change[m] = -as_double(from_below + (pull + turn - at_lower));
            const double c = as_double(cosine), a = as_double(link.length);
            const double stiffness =
                as_double(height * link.pull) / (a * c * c * c) + as_double(link.cross);
            diagonal[m] = below_stiffness - below_mass + stiffness - as_double(link.moment);
            upper[m] = -stiffness;
            from_below = -(pull + turn) - at_upper;
            below_stiffness = stiffness, below_mass = as_double(link.rest);
        }
        if constexpr (is_support<End>) {
            if (support.yields()) {
                change[n] = -as_double(from_below + support.stiffness * (y[n] - support.radius) -
                                       support.carriage * y[n]);
                diagonal[n] =
                    below_stiffness - below_mass + as_double(support.stiffness - support.carriage);
            }
        }
        solve_tridiagonal(diagonal, upper, change);
        double largest = 0;
        for (std::size_t m = 0; m < rows; ++m) {
            const double share = as_double(abs(y[m]));
            largest =
                std::max(largest, share > 0 ? std::abs(change[m]) / share : std::abs(change[m]));
            y[m] = y[m] + S(change[m]);
        }
        if (!(largest < std::numeric_limits<double>::infinity())) return result;
        if (largest < 1e-14 && (largest > 0.25 * last || largest < as_double(epsilon<S>()))) {
            result.converged = true;
            break;
        }
        last = largest;
    }
    return result;
}

}  // namespace revchain::finite
