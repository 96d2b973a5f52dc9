// SPDX-License-Identifier: GPL-3.0-or-later
// Defines what governor.hpp declares.
#pragma once

#include "revchain/governor.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/special/incomplete_elliptic.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic {
namespace detail {

inline constexpr std::string_view governor_motion = "analytic::GovernorMotion";

[[noreturn]] inline void throw_apart(double angle_rate) {
    throw_invalid(governor_motion,
                  "angular speed, sqrt(gravity / pendulum length), angle rate and angle must be "
                  "within a factor of 1e150 of each other or 0; angle rate",
                  angle_rate);
}

}  // namespace detail

/// Coefficients e, 2 b, f of 4 tau'^2 at the start, in units of `pace`, so that all numbers are
/// about 1.
struct GovernorMotion::Quartic {
    double s, c, w, n;  ///< sine and cosine of theta/2, theta', axis
    double off;         ///< n^2 (cos theta - lambda/l)
    double e, f, b;
    double R, plus, minus;  ///< sqrt(b^2 - e f), R + b, R - b

    Quartic(const Governor& given, double pull, double turning, double pace)
        : w(given.angle_rate / pace), n(turning / pace) {
        const double G = pull / pace * (pull / pace), n2 = n * n;
        const double half = 0.5 * std::remainder(given.angle, 2 * std::numbers::pi);
        s = std::sin(half), c = std::cos(half);
        if (given.gravity < 0) {
            w = -w;
            std::swap(s, c);
            if (c < 0) s = -s, c = -c;
        }
        // G - n^2 is computed in two words, because it alone distinguishes pendulum lengths near
        // the conical height.
        using Two = DoubleWord<double>;
        const Two speed(given.angular_speed),
            held = (Two(1.0) - Two(given.axial_inertia)) * speed * speed;
        const double excess =
            static_cast<double>((Two(std::abs(given.gravity)) / Two(given.pendulum_length) - held) /
                                Two(pace) / Two(pace));
        const bool near_by = std::abs(excess) < 0.5 * n2;  // chooses the form without differences
        const double cosine = (c - s) * (c + s);
        off = near_by ? -(excess + 2 * n2 * s * s) : n2 * cosine - G;
        e = w * w + 4 * s * s * (near_by ? excess + n2 * s * s : G - n2 * c * c);
        if (G == 0 && std::abs(e) <= 1e-15 * w * w) e = 0;  // within the rounding of the start
        f = G == 0 ? e : w * w - 4 * c * c * (G + n2 * s * s);
        b = w * w + (near_by ? 4 * n2 * s * s * s * s - 2 * excess * cosine
                             : 2 * n2 * (s * s * s * s + c * c * c * c) - 2 * G * cosine);
        R = 2 * std::hypot(n * w, off);
        plus = b >= 0 ? b + R : -e * f / (R - b);
        minus = b >= 0 ? -e * f / plus : R - b;
    }
};

inline GovernorMotion::GovernorMotion(const Governor& given) : angle_(given.angle) {
    constexpr std::string_view place = detail::governor_motion;
    detail::require_finite(place, "angular speed", given.angular_speed, "gravity", given.gravity,
                           "angle", given.angle, "angle rate", given.angle_rate);
    detail::require_positive(place, "pendulum length", given.pendulum_length);
    if (!(given.axial_inertia >= 0 && given.axial_inertia <= 1))
        detail::throw_invalid(place, "axial inertia must lie between 0 and 1", given.axial_inertia);

    const double pull = std::sqrt(std::abs(given.gravity)) / std::sqrt(given.pendulum_length);
    const double turning = std::abs(given.angular_speed) * std::sqrt(1 - given.axial_inertia);
    const double pace = std::max({pull, turning, std::abs(given.angle_rate)});
    least_ = greatest_ = angle_;
    if (pace == 0) return;
    upside_down_ = given.gravity < 0;
    const Quartic q(given, pull, turning, pace);
    bottom_ = (upside_down_ ? q.f : q.e) * pace * pace,
    top_ = (upside_down_ ? q.e : q.f) * pace * pace;
    if (q.w == 0 && (q.s == 0 || q.c == 0 || q.R == 0)) return;
    choose_form(q, pace, given.angle_rate);
    if (!std::isfinite(phase_) || !std::isfinite(rate_) || !std::isfinite((*this)(0).angle_rate))
        detail::throw_apart(given.angle_rate);
    turns_ = std::nearbyint((angle_ - unfolded(half_at(phase_))) / (2 * std::numbers::pi));
    if (regime_ != GovernorRegime::rest) set_range(q.minus);
}

/// Sets the phase to the argument whose sn and cn are these, up to a common factor.
inline void GovernorMotion::set_phase(double sn, double cn) {
    const double whole = std::hypot(sn, cn), k = modulus().complementary_modulus();
    sn /= whole, cn /= whole;
    const double dn = std::hypot(cn, k * sn);
    phase_ = sn * detail::carlson_rf(cn * cn, dn * dn, 1);
    if (cn < 0) phase_ = std::copysign(2 * functions_.complete().K, sn) - phase_;
}

inline void GovernorMotion::choose_form(const Quartic& q, double pace, double angle_rate) {
    // Sets the functions from kappa^2 : kappa'^2; returns K.
    const auto set_functions = [&](double kappa, double complement) {
        if (!(kappa >= 0 && complement >= 0 && kappa + complement > 0))
            detail::throw_apart(angle_rate);
        functions_ =
            JacobiFunctions(EllipticModulus::of_ratio(std::sqrt(kappa), std::sqrt(complement)));
        return functions_.complete().K;
    };
    const auto [s, c, w, n, off, e, f, b, R, plus, minus] = q;
    if (f < 0 && e > 0) {
        form_ = Form::cn;
        regime_ = GovernorRegime::through;
        opposite_ = std::sqrt(b >= 0 ? plus : e), adjacent_ = std::sqrt(b >= 0 ? -f : minus);
        rate_ = std::sqrt(0.5 * R);
        period_ = 4 * set_functions(plus, minus) / (rate_ * pace);
        const double cn = s * adjacent_ / (c * opposite_), k = modulus().modulus() * cn;
        const double dn = std::hypot(modulus().complementary_modulus(), k);
        set_phase(-w * adjacent_ / (2 * c * c * opposite_ * rate_ * dn), cn);
    } else if (f < 0) {
        form_ = Form::dn;
        regime_ = e < 0 ? GovernorRegime::aside : GovernorRegime::asymptotic;
        opposite_ = std::copysign(std::sqrt(plus), s), adjacent_ = std::sqrt(-f);
        rate_ = 0.5 * std::sqrt(plus);
        const double rest = -minus;  // e f / plus
        period_ = 2 * set_functions(2 * R, rest) / (rate_ * pace);
        if (R == 0) regime_ = GovernorRegime::rest, period_ = 0;
        const double chi = 0.5 * std::atan2(n * std::abs(w), off);
        set_phase(std::cos(chi) * std::sqrt(plus - f), std::sin(chi) * std::sqrt(rest - f));
        if (w * s > 0) phase_ = -phase_;
    } else if (e > 0) {
        form_ = Form::tn;
        regime_ = f > 0 ? GovernorRegime::revolutions : GovernorRegime::asymptotic;
        opposite_ = std::sqrt(e), adjacent_ = std::sqrt(plus);
        rate_ = 0.5 * std::sqrt(plus);
        period_ = 2 * set_functions(2 * R, -minus) / (rate_ * pace);
        set_phase(s * adjacent_, c * opposite_);
        rate_ = std::copysign(rate_, w);
    } else {  // without gravity, between bottom and top
        form_ = Form::growing;
        regime_ = GovernorRegime::asymptotic;
        period_ = std::numeric_limits<double>::infinity();
        opposite_ = s, adjacent_ = c;
        rate_ = 0.25 * w / (s * c);
    }
    rate_ *= pace;
}

inline void GovernorMotion::set_range(double minus) {
    const auto at = [&](double opposite, double adjacent) {
        return unfolded({opposite, adjacent, 0, 0});
    };
    double first = at(-opposite_, adjacent_), last = at(opposite_, adjacent_);
    if (form_ == Form::dn)
        first = at(std::copysign(std::sqrt(std::max(0.0, -minus)), opposite_), adjacent_);
    if (form_ == Form::tn) first = at(-1, 0), last = at(1, 0);
    if (form_ == Form::growing) first = at(0, 1), last = at(std::copysign(1.0, opposite_), 0);
    least_ = std::min(first, last), greatest_ = std::max(first, last);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (regime_ == GovernorRegime::revolutions) least_ = -infinity, greatest_ = infinity;
}

inline double GovernorMotion::unfolded(const Half& half) const {
    constexpr double pi = std::numbers::pi;
    const double angle = upside_down_ ? std::atan2(half.adjacent, half.opposite) - half.turns * pi
                                      : std::atan2(half.opposite, half.adjacent) + half.turns * pi;
    return 2 * (angle + turns_ * pi);
}

inline GovernorMotion::Half GovernorMotion::half_at(double u) const {
    if (form_ == Form::growing) {
        const double grown = std::exp(std::clamp(u, -350.0, 350.0));
        return {opposite_ * grown, adjacent_ / grown, 0, 2 * rate_};
    }
    const JacobiValues j = functions_(u);
    const double k2 = modulus().modulus() * modulus().modulus();
    Half half{opposite_, adjacent_, 0, rate_};
    if (form_ == Form::cn) {
        half.opposite *= j.cn, half.rate *= -j.sn * j.dn;
    } else if (form_ == Form::dn) {
        half.opposite *= j.dn, half.rate *= -k2 * j.sn * j.cn;
    } else {
        half.turns = std::nearbyint(j.amplitude / std::numbers::pi);
        const double sign = std::fmod(half.turns, 2.0) == 0 ? 1.0 : -1.0;
        half.opposite *= sign * j.sn, half.adjacent *= sign * j.cn, half.rate *= j.dn;
    }
    return half;
}

inline GovernorState GovernorMotion::operator()(double time) const {
    detail::require_finite(detail::governor_motion, "time", time);
    if (form_ == Form::constant) return {angle_, 0};
    const auto require_finite = [&](double x) {
        if (std::isfinite(x)) return;
        detail::throw_invalid(detail::governor_motion,
                              "time must be so small that the angle does not overflow", time);
    };
    const double u = phase_ + rate_ * time;
    require_finite(u);
    const Half half = half_at(u);
    const double scale =
        form_ == Form::growing ? half.opposite * half.adjacent : opposite_ * adjacent_;
    const double whole = std::hypot(half.opposite, half.adjacent);
    const double rate = 2 * half.rate * (scale / whole / whole);
    const GovernorState state{unfolded(half), upside_down_ ? -rate : rate};
    require_finite(state.angle);
    return state;
}

}  // namespace revchain::analytic
