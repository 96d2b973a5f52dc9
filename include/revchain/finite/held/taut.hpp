// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/supports.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace finite {

/// Small offsets of a chain held at both ends, tau = lambda times the tension at the lower end, `along`: the pencil of
/// link elements of stiffness (lambda sigma + tau)/a, both ends on the axis or on springs about it.

/// How many tau, or how many lambda at tau in proportion, are larger: negative pivots of stiffness less mass, from the
/// lower end up, told by the signs of offsets and links.
template <class S>
Index taut_count(const std::vector<Link<S>>& links, const S& height, const S& along, const HeldEnds<S>& ends = {}) {
    revchain::detail::look();
    Index negative = 0;
    int sign_below = 1;
    S y(0), H(-1);
    const bool yields = ends.lower.yields();
    if (yields) {
        const S &give = ends.lower.compliance, whole = S(1) + give;
        y = give / whole, H = (ends.lower.carriage * give - S(1)) / whole;
    }
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<S>& link = links[m];
        const S R = H + link.moment * y;
        S stiffness = height * link.pull + along + link.length * link.cross;
        if (stiffness == S(0)) stiffness = S(std::numeric_limits<double>::min());
        y = y - link.length * R / stiffness;
        H = R + link.rest * y;
        const int sign = y < S(0) ? -1 : 1, bent = stiffness < S(0) ? -1 : 1;
        if ((m > 0 || yields) && sign * sign_below * bent < 0) ++negative;
        sign_below = sign;
        const double size = std::abs(static_cast<double>(y)) + std::abs(static_cast<double>(H));
        if (size > 1e100 || size < 1e-100) y = y / S(size), H = H / S(size);
    }
    if (ends.upper.yields() && (ends.upper.miss(y, H) < S(0) ? -1 : 1) * sign_below < 0) ++negative;
    return negative;
}

/// Offsets of the pins, firm ends 0, for a unit pull inwards at the lower end, or for a unit offset of one on a spring;
/// to be called at the height of a mode. The pencil is eliminated from both ends to the pin where least is left over
/// (twisted factorization), so that the offsets are as accurate in a light part of the chain as in a heavy one.
template <class S>
std::vector<S> taut_shape(const std::vector<Link<S>>& links, const S& height, const S& along,
                          const HeldEnds<S>& ends = {}) {
    using std::abs;
    const std::size_t count = links.size(), first = ends.lower.firm ? 1 : 0, last = ends.upper.firm ? count - 1 : count;
    std::vector<S> y(count + 1, S(0)), diagonal = y, beside = y;  // of pins; beside[m]: of pins m and m + 1
    if (last < first) return y;
    for (std::size_t m = 0; m < count; ++m) {
        const Link<S>& link = links[m];
        const S k = (height * link.pull + along) / link.length;
        diagonal[m] = diagonal[m] + (k - (link.moment - link.cross));
        diagonal[m + 1] = diagonal[m + 1] + (k - (link.rest - link.cross));
        beside[m] = -(k + link.cross);
    }
    if (ends.lower.yields()) diagonal[0] = diagonal[0] + (ends.lower.stiffness - ends.lower.carriage);
    if (ends.upper.yields()) diagonal[count] = diagonal[count] + (ends.upper.stiffness - ends.upper.carriage);
    const auto pivot = [](const S& x) { return x == S(0) ? S(std::numeric_limits<double>::min()) : x; };
    std::vector<S> from_below = diagonal, from_above = diagonal;
    for (std::size_t m = first + 1; m <= last; ++m)
        from_below[m] = diagonal[m] - beside[m - 1] * beside[m - 1] / pivot(from_below[m - 1]);
    for (std::size_t m = last; m-- > first;)
        from_above[m] = diagonal[m] - beside[m] * beside[m] / pivot(from_above[m + 1]);
    const auto left = [&](std::size_t m) { return abs(from_below[m] + from_above[m] - diagonal[m]); };
    std::size_t meet = first;
    for (std::size_t m = first + 1; m <= last; ++m)
        if (left(m) < left(meet)) meet = m;
    y[meet] = S(1);
    for (std::size_t m = meet; m-- > first;) y[m] = -(beside[m] * y[m + 1]) / pivot(from_below[m]);
    for (std::size_t m = meet + 1; m <= last; ++m) y[m] = -(beside[m - 1] * y[m - 1]) / pivot(from_above[m]);
    const Link<S>& lowest = links.front();
    const S unit = ends.lower.yields()
                       ? S(S(1) / pivot(y[0]))
                       : S(lowest.length / pivot(y[1]) / (height * lowest.pull + along + lowest.length * lowest.cross));
    for (S& offset : y) offset = offset * unit;
    return y;
}

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

/// Modes of small amplitude of a straight chain whose two ends are held on the axis or on springs about it, its lower
/// end pulled down. Shapes of finite amplitude begin at their heights, where the span is all but the length.
class TautChain {
   public:
    using S = Wide<double>;

    /// `lower_tension`: at the lower end, in the unit of the weights. Weightless: as at the upper end.
    TautChain(const Chain<double>& chain, const S& lower_tension, bool weightless = false,
              const HeldSupports& supports = {})
        : chain_(links_of(chain)), tension_(ldexp(lower_tension, -chain_.units.weight_exponent)), supports_(supports) {
        if (weightless)
            for (Link<S>& link : chain_.links) link.pull = S(0);
    }

    /// How many conical heights exceed `height`.
    Index above(double height) const { return count(scaled(height)); }
    /// N - 1 of N links, one more for each end on a spring, one less for each pin that moves without mass.
    Index mode_count() const { return count(lowest); }
    /// The conical height at index k, from 0 for the largest, to a rounding. Cost: 60 counts.
    double height(Index k) const {
        return std::ldexp(taut_number([&](double x) { return count(x); }, k, 1.0), chain_.units.length_exponent);
    }
    /// Offsets of the pins, lower end first, at a conical height; the largest 1, that of the lowest free pin positive.
    Vector<double> shape(double height) const {
        const S at(scaled(height));
        const std::vector<S> y = taut_shape(chain_.links, at, S(tension_ * at), ends(at));
        Vector<double> offset(static_cast<Index>(y.size()));
        for (Index m = 0; m < offset.size(); ++m) offset[m] = static_cast<double>(y[static_cast<std::size_t>(m)]);
        return offset / offset.cwiseAbs().maxCoeff();
    }
    /// The largest force that the offsets leave unbalanced at a pin that moves, over the largest sum of forces at one.
    double residual(double height, const Vector<double>& offset) const {
        const auto size_of = [](const S& x) { return std::abs(static_cast<double>(x)); };
        const S at(scaled(height));
        const HeldEnds<S> held = ends(at);
        const auto hold = [](const Held<S>& end) { return end.firm ? S(0) : S(end.stiffness - end.carriage); };
        S force = hold(held.lower) * S(offset[0]);  // carried over from the link below
        double size = 0, worst = 0, largest = 0;
        for (std::size_t m = 0; m < chain_.links.size(); ++m) {
            const Link<S>& link = chain_.links[m];
            const auto i = static_cast<Index>(m);
            const S lower(offset[i]), upper(offset[i + 1]), stiffness = (at * link.pull + tension_ * at) / link.length;
            const S spring = stiffness * (lower - upper);
            const double spring_size = size_of(stiffness) * (size_of(lower) + size_of(upper));
            const S on_lower = (link.moment - link.cross) * lower + link.cross * upper;
            const S on_upper = (link.rest - link.cross) * upper + link.cross * lower;
            if (m > 0 || held.lower.yields()) worst = std::max(worst, size_of(force + (spring - on_lower)));
            largest = std::max(largest, size + spring_size + size_of(on_lower));
            force = -spring - on_upper, size = spring_size + size_of(on_upper);
        }
        if (held.upper.yields())
            worst = std::max(worst, size_of(force + hold(held.upper) * S(offset[offset.size() - 1])));
        return worst / largest;
    }
    /// Distances from the lower end at which the chain crosses the axis between its ends.
    Vector<double> nodes(const Vector<double>& offset) const {
        std::vector<double> found;
        S below(0);
        for (std::size_t m = 0; m < chain_.links.size(); ++m) {
            const auto i = static_cast<Index>(m);
            const double y = offset[i], next = offset[i + 1];
            const S length = chain_.links[m].length;
            if (y * next < 0 || (i > 0 && y == 0)) {
                const S place = y == 0 ? below : below + length * S(y / (y - next));
                found.push_back(std::ldexp(static_cast<double>(place), chain_.units.length_exponent));
            }
            below = below + length;
        }
        return Eigen::Map<const Vector<double>>(found.data(), static_cast<Index>(found.size()));
    }

   private:
    static constexpr double lowest = 0x1p-400;  // below every height: `taut_number` goes no further down
    double scaled(double height) const { return std::ldexp(height, -chain_.units.length_exponent); }
    HeldEnds<S> ends(const S& height) const { return held_ends(supports_, chain_.units, height); }
    Index count(double height) const {
        return taut_count(chain_.links, S(height), S(tension_ * S(height)), ends(S(height)));
    }

    Links<S> chain_;
    S tension_;
    HeldSupports supports_;
};

}  // namespace finite
}  // namespace revchain
