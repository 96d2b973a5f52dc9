// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain {

/// Whirl speeds of a chain held straight between two points of its axis.
struct TautModes {
    double tension = 0;             ///< at the lower end, in the unit of the weights
    Vector<double> conical_height;  ///< of mode k + 1, descending
    Vector<double> error_bound;     ///< relative
    Table<double> shape;            ///< (modes, N + 1) offsets of the pins, largest 1, the lowest free pin's positive
};

namespace finite {

/// Small offsets of a chain held at both ends, tau = lambda times the tension at the lower end: the pencil of link
/// elements of stiffness (lambda sigma + tau)/a, both end pins on the axis.
template <class S>
class TautLinks {
   public:
    explicit TautLinks(const std::vector<Link<S>>& links) : links_(&links) {}

    /// How many tau, or how many lambda at tau in proportion, are larger: negative pivots of stiffness less mass, from
    /// the lower end up, told by the signs of offsets and links.
    Index count(const S& height, const S& along) const {
        Index negative = 0;
        int sign_below = 0;
        sweep(height, along, [&](std::size_t m, const S& y, const S& stiffness) {
            const int sign = (y < S(0) ? -1 : 1), bent = stiffness < S(0) ? -1 : 1;
            if (m > 0 && sign * sign_below * bent < 0) ++negative;
            sign_below = sign;
        });
        return negative;
    }
    /// Offsets of the pins for a unit pull inwards at the lower end. To be called where the last comes out 0.
    std::vector<S> shape(const S& height, const S& along) const {
        std::vector<S> y{S(0)};
        sweep(
            height, along, [&](std::size_t, const S& offset, const S&) { y.push_back(offset); }, false);
        return y;
    }
    Index pins() const { return static_cast<Index>(links_->size()) - 1; }

   private:
    template <class Visit>
    void sweep(const S& height, const S& along, Visit&& visit, bool rescale = true) const {
        using std::abs;
        revchain::detail::look();
        S y(0), H(-1);
        for (std::size_t m = 0; m < links_->size(); ++m) {
            const Link<S>& link = (*links_)[m];
            const S R = H + link.moment * y;
            S stiffness = height * link.pull + along + link.length * link.cross;
            if (stiffness == S(0)) stiffness = S(std::numeric_limits<double>::min());
            y = y - link.length * R / stiffness;
            H = R + link.rest * y;
            visit(m, y, stiffness);
            const double size = std::abs(static_cast<double>(y)) + std::abs(static_cast<double>(H));
            if (rescale && (size > 1e100 || size < 1e-100)) y = y / S(size), H = H / S(size);
        }
    }
    const std::vector<Link<S>>* links_;
};

/// Number k (from 0, descending) of what `count` counts, by halving between powers of two; 0 where there are fewer.
template <class Count>
double taut_number(const Count& count, Index k, double start) {
    double high = start, low = start;
    for (int i = 0; i < 2000 && count(high) > k; ++i) high *= 2;
    for (int i = 0; i < 400 && count(low) <= k; ++i) low /= 2;
    if (count(low) <= k) return 0;
    for (int i = 0; i < 2000; ++i) {
        const double middle = high > 2 * low ? std::sqrt(low) * std::sqrt(high) : low + (high - low) / 2;
        if (!(low < middle && middle < high)) break;
        (count(middle) > k ? low : high) = middle;
    }
    return low;
}

}  // namespace finite

/// Whirl speeds of the straight chain whose two ends are held on the axis, its lower end pulled down with `tension`, in
/// the unit of the weights: the first `count` conical heights, and the offsets. Shapes held at finite amplitude leave
/// from these: `held_shapes` of a span as short of the length as one likes.
///
/// Method: counts of negative pivots in double-double, from the held lower pin up, halved until two neighbouring
/// doubles enclose the height. Accuracy: 1 ulp, the bound returned; shapes 1e-13 / gap of the heights. Cost 60 N for
/// each. Fewer are returned where there are fewer: N - 1 of N links, one less for each pin without mass.
/// Throws InvalidArgument for a tension that is not positive and finite, and a count below 1.
inline TautModes taut_modes(const Chain<double>& chain, double tension, Index count) {
    using S = Wide<double>;
    constexpr std::string_view place = "taut_modes";
    detail::require_positive(place, "tension", tension);
    if (count < 1) detail::throw_invalid(place, "count must be at least 1", count);
    const auto chained = finite::links_of(chain);
    const finite::TautLinks<S> taut(chained.links);
    const S pull(std::ldexp(tension, -chained.units.weight_exponent));
    const auto above = [&](double height) { return taut.count(S(height), pull * S(height)); };
    std::vector<double> found;
    for (Index k = 0; k < std::min(count, taut.pins()); ++k) {
        const double height = finite::taut_number(above, k, 1.0);
        if (height == 0) break;
        found.push_back(height);
    }
    TautModes modes;
    modes.tension = tension;
    const auto size = static_cast<Index>(found.size());
    modes.conical_height.resize(size), modes.shape.resize(size, chain.size() + 1);
    modes.error_bound = Vector<double>::Constant(size, epsilon<double>());
    for (Index k = 0; k < size; ++k) {
        const double height = found[static_cast<std::size_t>(k)];
        modes.conical_height[k] = std::ldexp(height, chained.units.length_exponent);
        const std::vector<S> y = taut.shape(S(height), pull * S(height));
        for (Index m = 0; m <= chain.size(); ++m)
            modes.shape(k, m) = static_cast<double>(y[static_cast<std::size_t>(m)]);
        modes.shape(k, chain.size()) = 0;
        modes.shape.row(k) /= modes.shape.row(k).cwiseAbs().maxCoeff();
    }
    return modes;
}

}  // namespace revchain
