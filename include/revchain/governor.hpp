// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "revchain/numeric/double_word.hpp"
#include "revchain/special/incomplete_elliptic.hpp"

/// A compound link hinged on an axis that is made to turn: the ball of a governor swinging in its turning plane.
/// Greenhill (1908) §7.
namespace revchain::analytic {

/// What is given. Angles from the downward vertical, rad; units of length and time any consistent set.
struct Governor {
    double angular_speed;        ///< n of the axis; 0 is the plain pendulum
    double pendulum_length;      ///< l, about the hinge
    double gravity;              ///< g; negative: the axis upside down
    double angle;                ///< theta at time 0
    double angle_rate = 0;       ///< theta' at time 0
    double axial_inertia = 0.0;  ///< of the link about its own line, over its transverse moment at the hinge: 0 ... 1
};

/// How it moves, §7 (4)-(13).
enum class GovernorRegime {
    rest,         ///< an equilibrium, or relative equilibrium at cos theta = lambda / l
    aside,        ///< between two angles of one side: dn
    asymptotic,   ///< to an equilibrium and never there: sech, sinh and what gravity reversed makes of them
    through,      ///< to and fro through the lowest point (the highest, for gravity reversed): cn, nc
    revolutions,  ///< round and round: tn
};

inline std::string_view to_string(GovernorRegime regime) {
    constexpr std::string_view names[]{"rest", "aside", "asymptotic", "through", "revolutions"};
    return names[static_cast<std::size_t>(regime)];
}

/// Angle and its rate at one time.
struct GovernorState {
    double angle, angle_rate;
};

/// The motion  theta'' = n^2 sin theta cos theta - (g/l) sin theta.
///
/// Method: with tau = tan(theta/2),  4 tau'^2 = e + 2 b tau^2 + f tau^4,  e and f the squares of theta' at the bottom
/// and at the top, so that kappa or kappa' follow from e, f and b without a difference, next to the separatrices too.
/// Accuracy: 1e-14 (|theta| + |t theta'|) and as much of theta', where e and f are not themselves lost in rounding:
/// they are given to 1e-16 (theta'^2 + n^2 + |g/l|) by the start. Lengths near the conical height are told from it to
/// the last digit. Cost: a microsecond, and 0.2 for each time.
class GovernorMotion {
   public:
    /// Throws InvalidArgument for numbers that are not finite, a length not positive, an axial inertia outside [0, 1].
    explicit GovernorMotion(const Governor& given);

    GovernorRegime regime() const { return regime_; }
    /// Of the motion; of one turn where it revolves; infinite where it never returns; 0 at rest.
    double period() const { return period_; }
    /// The angles between which it moves, within (-pi, 2 pi); minus and plus infinity where it revolves.
    double least_angle() const { return least_; }
    double greatest_angle() const { return greatest_; }
    /// theta'^2 at the bottom and at the top, were it to come there; the sign says whether it can.
    double energy_at_bottom() const { return bottom_; }
    double energy_at_top() const { return top_; }
    EllipticModulus modulus() const { return functions_.modulus(); }

    GovernorState operator()(double time) const;

   private:
    enum class Form { constant, growing, cn, dn, tn };

    /// opposite : adjacent = tan(angle/2) after so many whole turns; the rate of that angle.
    struct Half {
        double opposite, adjacent, turns, rate;
    };
    Half half_at(double u) const;
    double unfolded(const Half& half) const {
        const double angle = upside_down_ ? std::atan2(half.adjacent, half.opposite) - half.turns * std::numbers::pi
                                          : std::atan2(half.opposite, half.adjacent) + half.turns * std::numbers::pi;
        return 2 * (angle + turns_ * std::numbers::pi);
    }

    GovernorRegime regime_ = GovernorRegime::rest;
    Form form_ = Form::constant;
    bool upside_down_ = false;            // angles counted from the top, so that gravity pulls downwards
    double turns_ = 0;                    // whole turns between the angle given and the one computed
    double angle_ = 0;                    // given
    double rate_ = 0, phase_ = 0;         // u = phase + rate t
    double opposite_ = 0, adjacent_ = 1;  // tan(theta/2): their ratio times cn, dn or tn
    double period_ = 0, least_ = 0, greatest_ = 0, bottom_ = 0, top_ = 0;
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

inline GovernorMotion::GovernorMotion(const Governor& given) : angle_(given.angle) {
    const auto check = [](std::string_view name, double value) {
        if (!std::isfinite(value))
            revchain::detail::throw_invalid("analytic::GovernorMotion", std::string(name) + " must be finite", value);
    };
    check("angular speed", given.angular_speed), check("gravity", given.gravity);
    check("angle", given.angle), check("angle rate", given.angle_rate);
    revchain::detail::require_positive("analytic::GovernorMotion", "pendulum length", given.pendulum_length);
    if (!(given.axial_inertia >= 0 && given.axial_inertia <= 1))
        revchain::detail::throw_invalid("analytic::GovernorMotion", "axial inertia must lie between 0 and 1",
                                        given.axial_inertia);

    // In units of `pace` everything is about 1.
    const double pull = std::sqrt(std::abs(given.gravity)) / std::sqrt(given.pendulum_length);
    const double turning = std::abs(given.angular_speed) * std::sqrt(1 - given.axial_inertia);
    const double pace = std::max({pull, turning, std::abs(given.angle_rate)});
    least_ = greatest_ = angle_;
    if (pace == 0) return;
    const double G = pull / pace * (pull / pace), n = turning / pace, n2 = n * n;
    upside_down_ = given.gravity < 0;
    const double half = 0.5 * std::remainder(given.angle, 2 * std::numbers::pi);
    double s = std::sin(half), c = std::cos(half), w = given.angle_rate / pace;
    if (upside_down_) {
        w = -w;
        std::swap(s, c);
        if (c < 0) s = -s, c = -c;
    }
    // What G exceeds n^2 by, to its own last digit: all that tells pendulums of about the conical height apart.
    using Two = DoubleWord<double>;
    const Two speed(given.angular_speed), held = (Two(1.0) - Two(given.axial_inertia)) * speed * speed;
    const double excess =
        static_cast<double>((Two(std::abs(given.gravity)) / Two(given.pendulum_length) - held) / Two(pace) / Two(pace));
    const bool near_by = std::abs(excess) < 0.5 * n2;  // then the first forms, else the second are no differences
    const double cosine = (c - s) * (c + s);
    const double off = near_by ? -(excess + 2 * n2 * s * s) : n2 * cosine - G;  // n^2 (cos theta - lambda/l)
    double e = w * w + 4 * s * s * (near_by ? excess + n2 * s * s : G - n2 * c * c);
    if (G == 0 && std::abs(e) <= 1e-15 * w * w) e = 0;  // bottom and top at once: no further than the start is known
    const double f = G == 0 ? e : w * w - 4 * c * c * (G + n2 * s * s);
    const double b = w * w + (near_by ? 4 * n2 * s * s * s * s - 2 * excess * cosine
                                      : 2 * n2 * (s * s * s * s + c * c * c * c) - 2 * G * cosine);
    const double R = 2 * std::hypot(n * w, off);                                                    // sqrt(b^2 - e f)
    const double plus = b >= 0 ? b + R : -e * f / (R - b), minus = b >= 0 ? -e * f / plus : R - b;  // R + b, R - b
    bottom_ = (upside_down_ ? f : e) * pace * pace, top_ = (upside_down_ ? e : f) * pace * pace;
    if (w == 0 && (s == 0 || c == 0 || R == 0)) return;

    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto refuse_apart = [&] {
        revchain::detail::throw_invalid(
            "analytic::GovernorMotion",
            "angular speed, sqrt(gravity / pendulum length), angle rate and angle must be within "
            "a factor of 1e150 of each other or 0; angle rate",
            given.angle_rate);
    };
    const auto set_functions = [&](double kappa, double complement) {
        if (!(kappa >= 0 && complement >= 0 && kappa + complement > 0)) refuse_apart();
        functions_ = JacobiFunctions(EllipticModulus::of_ratio(std::sqrt(kappa), std::sqrt(complement)));
        return functions_.complete().K;
    };
    const auto set_phase = [&](double sn, double cn) {  // up to a common factor
        const double whole = std::hypot(sn, cn), k = modulus().complementary_modulus();
        sn /= whole, cn /= whole;
        const double dn = std::hypot(cn, k * sn);
        phase_ = sn * detail::carlson_rf(cn * cn, dn * dn, 1);
        if (cn < 0) phase_ = std::copysign(2 * functions_.complete().K, sn) - phase_;
    };
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
        period_ = infinity;
        opposite_ = s, adjacent_ = c;
        rate_ = 0.25 * w / (s * c);
    }
    rate_ *= pace;
    if (!std::isfinite(phase_) || !std::isfinite(rate_) || !std::isfinite((*this)(0).angle_rate)) refuse_apart();
    turns_ = std::nearbyint((angle_ - unfolded(half_at(phase_))) / (2 * std::numbers::pi));
    if (regime_ == GovernorRegime::rest) return;
    const auto at = [&](double opposite, double adjacent) { return unfolded({opposite, adjacent, 0, 0}); };
    double first = at(-opposite_, adjacent_), last = at(opposite_, adjacent_);
    if (form_ == Form::dn) first = at(std::copysign(std::sqrt(std::max(0.0, -minus)), opposite_), adjacent_);
    if (form_ == Form::tn) first = at(-1, 0), last = at(1, 0);
    if (form_ == Form::growing) first = at(0, 1), last = at(std::copysign(1.0, s), 0);
    least_ = std::min(first, last), greatest_ = std::max(first, last);
    if (regime_ == GovernorRegime::revolutions) least_ = -infinity, greatest_ = infinity;
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
        half.opposite *= j.cn;
        half.rate *= -j.sn * j.dn;
    } else if (form_ == Form::dn) {
        half.opposite *= j.dn;
        half.rate *= -k2 * j.sn * j.cn;
    } else {
        half.turns = std::nearbyint(j.amplitude / std::numbers::pi);
        const double sign = std::fmod(half.turns, 2.0) == 0 ? 1.0 : -1.0;
        half.opposite *= sign * j.sn;
        half.adjacent *= sign * j.cn;
        half.rate *= j.dn;
    }
    return half;
}

inline GovernorState GovernorMotion::operator()(double time) const {
    if (!std::isfinite(time)) revchain::detail::throw_invalid("analytic::GovernorMotion", "time must be finite", time);
    if (form_ == Form::constant) return {angle_, 0};
    const auto require_finite = [&](double x) {
        if (!std::isfinite(x))
            revchain::detail::throw_invalid("analytic::GovernorMotion",
                                            "time must be so small that the angle does not overflow", time);
    };
    const double u = phase_ + rate_ * time;
    require_finite(u);
    const Half half = half_at(u);
    const double scale = form_ == Form::growing ? half.opposite * half.adjacent : opposite_ * adjacent_;
    const double whole = std::hypot(half.opposite, half.adjacent);
    const double rate = 2 * half.rate * (scale / whole / whole);
    const GovernorState state{unfolded(half), upside_down_ ? -rate : rate};
    require_finite(state.angle);
    return state;
}

}  // namespace revchain::analytic
