// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <numbers>

#include "revchain/numeric/zero_between.hpp"
#include "revchain/special/bessel_zero.hpp"
#include "revchain/special/chain_arguments.hpp"

/// The uniform chain of Greenhill (1908) §4 with a particle at its free end, at small amplitude.
/// `tip` is the length of chain that weighs as much as the particle; tip = 0 is the chain of
/// `heavy_chain`. x is the distance from the free end.
///
/// With z = 2 sqrt((tip + x)/lambda), z_0 at the particle and z_L at the support, the offset is a
/// cylinder function of order 0 of z. The heights solve Y_2(z_0) J_0(z_L) = J_2(z_0) Y_0(z_L), or
/// with theta the phase of J + iY
///     theta_0(z_L) - theta_2(z_0) = mode pi.
/// Every mode has exactly one height: at a fixed z_0/z_L the left side rises from 0 to infinity,
/// because M_0(z_L) < M_2(z_0) in theta' = 2/(pi z M^2). Functions throw as in
/// special/heavy_chain.hpp, and for a tip that is negative or above 1e250 lengths.
namespace revchain::inline REVCHAIN_BUILD::analytic::tip_mass {
namespace detail {

using namespace analytic::detail;

inline const PhaseSeries& series(int order) {
    static const std::array<PhaseSeries, 3> all{PhaseSeries(0), PhaseSeries(1), PhaseSeries(2)};
    return all[static_cast<std::size_t>(order)];
}

/// J_0 and Y_0 at a point, and theta_0'.
struct OrderZero {
    TwoDoubles J, Y;
    double rate;

    explicit OrderZero(const TwoDoubles& place) {
        const double z = place.high;
        if (z < 45) {
            const Cylinders f(place);
            J = f.J0, Y = f.Y0;
            rate = 2 / (std::numbers::pi * z * (J.high * J.high + Y.high * Y.high));
        } else {
            rate = 1 / series(0).density(z);
            const TwoDoubles phase = place - two_word_pi * 0.25 - series(0).lag(z);
            const double c = std::cos(phase.high), s = std::sin(phase.high);
            J = two_sum(c, -s * phase.low), Y = two_sum(s, c * phase.low);
        }
    }
    /// theta_0 to about a tenth.
    static double rough(double z) {
        return std::max(z - 0.25 * std::numbers::pi - 0.125 / z, -0.5 * std::numbers::pi);
    }
};

/// The lower end z_0: J and Y of order 2 with a particle, of order 0 where the end is held; the
/// slope `rate` of their phase theta, and `rough`, theta to about a tenth.
struct LowerEnd {
    static constexpr double series_from = 30, nothing_below = 1e-5;  // J_2/Y_2 < 1e-21

    int order;
    double z, rate = 0, rough;
    TwoDoubles J{0.0}, Y{-1.0};

    LowerEnd(int of_order, const TwoDoubles& place) : order(of_order), z(place.high) {
        rough = z > 1.5 ? z - 1.25 * std::numbers::pi + 1.875 / z : -0.5 * std::numbers::pi;
        if (order == 0) rough = OrderZero::rough(z);
        if (is_far()) {
            rate = 1 / series(order).density(z);
        } else if (order == 0) {
            const OrderZero at(place);
            J = at.J, Y = at.Y, rate = at.rate;
        } else if (z >= nothing_below) {
            const Cylinders f(place);
            J = f.J2, Y = f.Y2;
            rate = 2 / (std::numbers::pi * z * (J.high * J.high + Y.high * Y.high));
        }
    }
    bool is_far() const { return z >= series_from; }
};

struct ValueAndRate {
    double value, rate;
};

/// A zero of an increasing function by Newton's method from w, in two words.
template <class F>
TwoDoubles phase_zero(double low, double high, double w, const F& value_and_rate) {
    const auto last = revchain::detail::newton_between(low, high, value_and_rate, w, 1e-9);
    return TwoDoubles(last.from) - last.step;
}

/// theta_0(z_0 + apart) - theta(z_0) - i pi, and theta_0' there.
inline ValueAndRate excess(const LowerEnd& end, const TwoDoubles& place, const TwoDoubles& apart,
                           Index i) {
    const double z = place.high, turns = static_cast<double>(i), pi = std::numbers::pi;
    if (end.is_far())
        return {(apart - two_word_pi * (turns - end.order / 2)).high +
                    (series(end.order).lag(end.z) - series(0).lag(z)),
                1 / series(0).density(z)};
    const bool at_tip = end.order == 2 && z < LowerEnd::nothing_below;
    const OrderZero at(at_tip ? TwoDoubles(LowerEnd::nothing_below) : place);
    const TwoDoubles sine = end.J * at.Y - end.Y * at.J, cosine = end.J * at.J + end.Y * at.Y;
    const double value = std::atan(sine.high / cosine.high);
    const double whole = std::round((OrderZero::rough(z) - end.rough - value) / pi - turns);
    return {value + pi * whole, at.rate};
}

inline Index check(std::string_view where, std::string_view name, Index number, double length,
                   double tip) {
    analytic::detail::check(where, name, number, length);
    if (tip >= 0 && tip / length <= 1e250) return number;
    revchain::detail::throw_invalid(where, "tip must lie between 0 and 1e250 lengths", tip);
}

/// The data that all modes share, and z_L - z_0 of each mode.
struct Ends {
    TwoDoubles share;  ///< length / (length + tip)
    TwoDoubles ratio;  ///< z_0 / z_L
    TwoDoubles gap;    ///< 1 - ratio

    Ends(double length, TwoDoubles tip) {
        int unit = 0;  // a power of two near the larger: no sum, no split product overflows
        std::frexp(std::max(length, tip.high), &unit);
        length = std::ldexp(length, -unit), tip = ldexp(tip, -unit);
        const TwoDoubles whole = tip + length;
        share = TwoDoubles(length) / whole;
        ratio = sqrt(tip / whole);
        gap = share / (ratio + 1.0);
    }

    /// z - z_0 at `part` of the length, over z_L - z_0. It is 0 and 1 at the ends.
    double part_apart(double part) const {
        const double r = ratio.high, z = std::sqrt(r * r + part * share.high);  // over z_L
        if (part > 0.5) return 1 - (1 - part) * ((1 + r) / (1 + z));
        return part > 0 ? part * ((1 + r) / (z + r)) : 0.0;
    }

    /// z_L - z_0 by Newton's method on the phases: below mode pi, as theta_0' > 1 and
    /// theta_0 >= theta at z_0. `order`: that of the lower end.
    TwoDoubles apart(int order, Index mode) const {
        const double r = ratio.high, g = gap.high, k = static_cast<double>(mode);
        const double pi = std::numbers::pi, high = k * pi;
        double low = 0, w = high;
        if (order == 0) {
            w -= 0.125 * std::min(1.0, g / r);
        } else {
            const double strings = (k - 1) * pi, c = r > 0 ? 4 * g * (0.125 + 1.875 / r) : 0;
            low = g * (k - 0.25) * pi;
            w = 0.5 * (strings + std::sqrt(strings * strings + c));  // both ends far out
            if (!(w * r > 2 * g)) w = low * (1 + 1e-3);
        }
        return phase_zero(low, high, w, [&](double at) {
            const TwoDoubles place = TwoDoubles(at) / gap;
            const LowerEnd end(order, place * ratio);
            const ValueAndRate e = excess(end, place, TwoDoubles(at), mode);
            if (!end.is_far()) return ValueAndRate{e.value, (e.rate - r * end.rate) / g};
            // without cancellation
            const double upper = series(0).density_above_one(place.high);
            const double lower = series(order).density_above_one(end.z);
            const double change = (lower - upper) / ((1 + upper) * (1 + lower)) / g;
            return ValueAndRate{e.value, change + 1 / (1 + lower)};
        });
    }

    double height(const TwoDoubles& apart, double length) const {
        int unit = 0;
        const double part = std::frexp(length, &unit);
        const TwoDoubles q = TwoDoubles(2.0) / (ratio + 1.0);
        return std::ldexp((share / apart * q * (q / apart) * part).high, unit);
    }
};

/// One mode of a cord with either lower end, of that order; `lower` is the tension there as a
/// length.
class EitherMode {
   protected:
    EitherMode(int order, Index mode, double length, const TwoDoubles& lower)
        : mode_(mode),
          length_(length),
          lower_(lower.high),
          ends_(length, lower),
          apart_(ends_.apart(order, mode)),
          place_(apart_ / ends_.gap * ends_.ratio),
          height_(ends_.height(apart_, length)),
          end_(order, place_) {}

    static double lag(int order, double z) { return series(order).lag(z); }
    static double density(int order, double z) { return series(order).density(z); }
    /// z - z_0 at x.
    double apart_at(double x, std::string_view where) const {
        check_place(where, x, length_);
        return apart_.high * ends_.part_apart(x / length_);
    }
    /// z - z_0 at node i, from `start`.
    double node_apart_from(Index i, double high, double start) const {
        const auto off = [&](double at) { return excess(end_, place_ + at, TwoDoubles(at), i); };
        return phase_zero(0, high, start, off).high;
    }
    double place_of(double apart) const {
        return length_ * (apart / apart_.high) *
               ((apart + 2 * end_.z) / (apart_.high + 2 * end_.z));
    }

    Index mode_;
    double length_, lower_;
    Ends ends_;
    TwoDoubles apart_, place_;  // z_L - z_0, z_0
    double height_;
    LowerEnd end_;
};

}  // namespace detail

/// Conical heights of the `count` slowest modes, descending. With a heavy tip the first mode is
/// nearly that of a plummet on a thread of this length; the others are half waves of a string with
/// z_L - z_0 = (mode - 1) pi nearly. Accuracy: 2 ulp (measured 1.04).
/// Cost of each: 0.15 microseconds where z_0 > 30, 10 to 15 where z_L < 45, else 3 to 5.
inline Vector<double> conical_heights(Index count, double length, double tip) {
    detail::check("analytic::tip_mass::conical_heights", "count", count, length, tip);
    const detail::Ends ends(length, tip);
    const auto height = [&](Index mode) { return ends.height(ends.apart(2, mode), length); };
    return detail::for_numbers(count, height);
}

/// One mode of the chain with a particle. Cost: that of its height.
class Mode : private detail::EitherMode {
   public:
    Mode(Index mode, double length, double tip)
        : EitherMode(2, detail::check("analytic::tip_mass::Mode", "mode", mode, length, tip),
                     length, tip) {
        if (end_.is_far()) return;
        const detail::TwoDoubles quarter = ldexp(place_ * place_, -2);
        const detail::TwoDoubles scale = detail::two_word_pi * quarter;
        if (end_.z < detail::LowerEnd::nothing_below) {
            a_ = quarter + 1.0, b_ = scale * ldexp(quarter, -1);
        } else {
            a_ = -(scale * end_.Y), b_ = scale * end_.J;
        }
    }

    double conical_height() const { return height_; }

    /// Offset at x, 1 at the free end: (pi z_0^2/4) (J_2(z_0) Y_0(z) - Y_2(z_0) J_0(z)).
    /// Accuracy: absolute error 6e-16 (1 + z_L - z_0) times the largest offset, which is 1 for
    /// mode 1 and up to sqrt(1 + tip/lambda) for others.
    /// Cost: 0.1 to 0.3 microseconds, 2 where z_0 > 1 and z < 45.
    double shape(double x) const {
        const double w = apart_at(x, "analytic::tip_mass::Mode::shape"), z = end_.z + w;
        if (!end_.is_far()) return cylinder(0, w);
        return -0.5 * end_.z * far_out(0, z) * std::sin(w - (lag(0, z) - lag(2, end_.z)));
    }

    /// dy/dx, -1/lambda at the free end. Accuracy: as `shape`, times the largest slope.
    double slope(double x) const {
        const double w = apart_at(x, "analytic::tip_mass::Mode::slope"), z = end_.z + w;
        if (end_.is_far())
            return -far_out(1, z) * (end_.z / z) * std::cos(w - (lag(1, z) - lag(2, end_.z))) /
                   height_;
        return z > 0 ? -cylinder(1, w) / (0.5 * z) / height_ : -1 / height_;
    }

    /// (mode - 1) distances x where the chain crosses the axis, ascending:
    /// theta_0(z) - theta_2(z_0) = i pi, i < mode. Accuracy: 1e-15 length.
    /// Cost: 0.2 to 10 microseconds each.
    Vector<double> nodes() const {
        Vector<double> points(mode_ - 1);
        double high = apart_.high;
        for (Index i = mode_ - 1; i >= 1; --i) {
            revchain::detail::check_interrupt();
            double w = std::max(high - std::numbers::pi, 0.5 * high);
            if (i == 1 && end_.is_far()) w = lag(0, end_.z) - lag(2, end_.z);  // near a heavy tip
            high = node_apart_from(i, high, w);
            points[i - 1] = place_of(high);
        }
        return points;
    }

    /// Distances x at which the chain is vertical, one above each node. Accuracy: 1e-15 length.
    /// Cost: seven slopes each.
    Vector<double> vertical_points() const {
        return revchain::detail::zeros_between(nodes(), length_, [&](double x) {
            const double steep = slope(x);
            return std::pair(steep, -(shape(x) / height_ + steep) / (lower_ + x));
        });
    }

   private:
    /// The modulus of an order over that of order 2 at z_0, where both are far out.
    double far_out(int order, double z) const {
        return std::sqrt(density(order, z) * density(2, end_.z) * (end_.z / z));
    }
    /// a J + b Y of order 0 or 1 at z_0 + w.
    double cylinder(int order, double w) const {
        const double z = end_.z + w;
        if (end_.z > 1 && z < 45) {  // the two terms nearly cancel in double
            const detail::Cylinders f(place_ + w);
            return (order == 0 ? a_ * f.J0 + b_ * f.Y0 : a_ * f.J1 + b_ * f.Y1).high;
        }
        const auto J = order == 0 ? gsl_sf_bessel_J0_e : gsl_sf_bessel_J1_e;
        const auto Y = order == 0 ? gsl_sf_bessel_Y0_e : gsl_sf_bessel_Y1_e;
        const double second = b_.high != 0 ? b_.high * detail::gsl_value(Y, z) : 0.0;
        return a_.high * detail::gsl_value(J, z) + second;
    }

    detail::TwoDoubles a_, b_;  // the offset is a J_0 + b Y_0
};

}  // namespace revchain::analytic::tip_mass
