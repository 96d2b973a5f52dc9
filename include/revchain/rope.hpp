// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "revchain/conical_pendulum.hpp"
#include "revchain/special/incomplete_elliptic.hpp"
#include "revchain/special/jacobi.hpp"
#include "revchain/special/root_between.hpp"

/// The rope that whirls between two points of its axis, gravity left out: y = b sn(K x/a). Greenhill (1908) §5.
/// Neighbouring nodes are 2 a apart, b is the sag, lambda = g/n^2 the conical height, and h the length of rope that
/// weighs as much as the tension in the middle of a half wave; the form depends on lambda h alone.
namespace revchain::analytic {

/// What is known: two of span, length (or slack = length - span, where the two nearly agree), sag, and tension together
/// with angular speed. One of these last two may be added to two of the others.
struct RopeGiven {
    std::optional<double> span{}, length{}, slack{};  ///< of the whole rope
    std::optional<double> sag{};                      ///< the largest offset
    std::optional<double> angular_speed{};            ///< n
    std::optional<double> tension{};                  ///< h
    Index half_waves = 1;
    double gravity = conical_pendulum::standard_gravity;  ///< turns weight into mass: relates n to lambda, nothing else
};

/// What there is at one place of the rope.
struct RopePoint {
    double x, arc;         ///< distance from an end along the axis, and along the rope
    double offset;         ///< y
    double slope;          ///< tan psi = dy/dx
    double tension_ratio;  ///< of the tension to that in the middle of a half wave
};

/// Accuracy: 1e-14 relative in what the two given determine well. Cost: 20 microseconds, a point 0.2, by its arc 10.
class SkippingRope {
   public:
    /// Throws InvalidArgument for numbers that are not positive and finite, too few or too many of them, and for what
    /// no rope does: a length not above the span, a sag not below half the length, a rope too slow or too tight to
    /// bend.
    explicit SkippingRope(const RopeGiven& given);

    Index half_waves() const { return half_waves_; }
    EllipticModulus modulus() const { return functions_.modulus(); }
    // What was given is kept as it was.
    double span() const { return span_; }
    double slack() const { return slack_; }
    double length() const { return length_; }
    double sag() const { return sag_; }
    double slope_at_ends() const { return 2 * (kappa() / complement()) / complement(); }
    double tension_ratio_at_ends() const { return 1 + kappa() * slope_at_ends(); }
    /// lambda h.
    double height_times_tension() const { return strength() * strength(); }
    /// About the axis, over the mass per length: a length cubed.
    double moment_of_inertia() const;

    /// Whether one of angular speed and tension was given; the next four throw InvalidArgument if not.
    bool has_speed() const { return conical_height_.has_value(); }
    double conical_height() const;
    double angular_speed() const { return conical_pendulum::angular_speed(conical_height(), gravity_); }
    double tension_in_the_middle() const { return strength() / conical_height() * strength(); }
    double tension_at_ends() const { return tension_in_the_middle() * tension_ratio_at_ends(); }

    /// At x from an end, 0 ... span.
    RopePoint at(double x) const;
    /// At so much rope from an end, 0 ... length.
    RopePoint at_arc(double arc) const;

    /// The ends drawn together or apart, the length and the angular momentum kept. Work done on the rope is the gain in
    /// moment_of_inertia() n^2 / 2, h w times each element of the way.
    SkippingRope drawn_to(double span) const;

   private:
    double waves() const { return static_cast<double>(half_waves_); }
    double kappa() const { return modulus().modulus(); }
    double complement() const { return modulus().complementary_modulus(); }
    double strength() const { return quarter_ / (complement() * functions_.complete().K); }  // sqrt(lambda h)
    RopePoint at_argument(double u) const;

    double span_ = 0, slack_ = 0, length_ = 0, sag_ = 0, quarter_ = 0, gravity_ = 0;
    std::optional<double> conical_height_;
    Index half_waves_ = 1;
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

namespace detail {

/// Of one half wave, over half its span: ln kappa/kappa' is the unknown in which all of them are nearly straight.
struct RopeRatios {
    double sag, slack, length, strength;

    explicit RopeRatios(const EllipticModulus& modulus) {
        const CompleteIntegrals c = complete_integrals(modulus);
        const double k = modulus.modulus(), kc = modulus.complementary_modulus();
        strength = 1 / (kc * c.K);  // sqrt(lambda h)
        sag = 2 * k * strength / kc;
        slack = 2 * k * strength / kc * (k * c.B);
        length = 1 + slack;
    }
    static EllipticModulus modulus(double logarithm) {
        return EllipticModulus::of_ratio(std::exp(0.5 * logarithm), std::exp(-0.5 * logarithm));
    }
};

}  // namespace detail

inline SkippingRope::SkippingRope(const RopeGiven& given) : gravity_(given.gravity), half_waves_(given.half_waves) {
    constexpr std::string_view place = "analytic::SkippingRope";
    const auto check = [&](std::string_view name, const std::optional<double>& value) {
        if (value) revchain::detail::require_positive(place, name, *value);
        return value.has_value();
    };
    revchain::detail::require_positive(place, "gravity", gravity_);
    if (half_waves_ < 1) revchain::detail::throw_invalid(place, "half waves must be at least 1", half_waves_);
    std::optional<double> span = given.span, slack = given.slack, length = given.length, strength;
    const bool has_span = check("span", span), has_length = check("length", length), has_slack = check("slack", slack);
    const bool has_sag = check("sag", given.sag), has_speed = check("angular speed", given.angular_speed);
    const bool has_tension = check("tension", given.tension), has_both = has_speed && has_tension;
    const int known = has_span + has_length + has_slack + has_sag + has_both;
    if (known != 2)
        revchain::detail::throw_invalid(
            place, "two of span, length, slack, sag, and tension together with angular speed must be given", known);
    if (has_length && (has_span || has_slack)) {
        const double other = has_span ? *span : *slack;
        if (!(*length > other))
            revchain::detail::throw_invalid(
                place, std::string("length must be greater than the ") + (has_span ? "span" : "slack"), *length);
        (has_span ? slack : span) = *length - other;
        length.reset();
    }
    if (has_speed) {
        conical_height_ = conical_pendulum::height(*given.angular_speed, gravity_);
        revchain::detail::require_positive(place, "gravity / angular speed^2", *conical_height_);
    }
    if (has_both) strength = std::sqrt(*conical_height_) * std::sqrt(*given.tension);

    const auto require_less = [&](const std::optional<double>& a, const std::optional<double>& b, double factor,
                                  std::string_view sentence, const std::optional<double>& shown) {
        if (a && b && !(*a < factor * *b)) revchain::detail::throw_invalid(place, sentence, *shown);
    };
    require_less(given.sag, length, 0.5 / waves(), "sag must be less than half the length of a half wave", given.sag);
    require_less(slack, given.sag, 2 * waves(), "slack must be less than twice the sag of every half wave", slack);
    require_less(span, strength, std::numbers::pi * waves(),
                 "too slow or too tight to bend: span must be less than pi sqrt(tension g) / n for each half wave",
                 span);
    require_less(strength, length, 1 / (std::numbers::pi * waves()),
                 "too slow or too tight to bend: length must be greater than pi sqrt(tension g) / n for each half wave",
                 length);

    // Two equations  given = a * ratio(kappa): their quotient for kappa.
    struct Equation {
        double value;
        double (*ratio)(const detail::RopeRatios&);
    };
    std::array<Equation, 2> equation{};
    std::size_t count = 0;
    const auto add = [&](const std::optional<double>& value, double share, double (*ratio)(const detail::RopeRatios&)) {
        if (value && count < 2) equation[count++] = {*value * share, ratio};
    };
    const double half = 0.5 / waves();  // of a half wave, and of that
    add(span, half, [](const detail::RopeRatios&) { return 1.0; });
    add(slack, half, [](const detail::RopeRatios& r) { return r.slack; });
    add(given.sag, 1, [](const detail::RopeRatios& r) { return r.sag; });
    add(strength, 1, [](const detail::RopeRatios& r) { return r.strength; });
    add(length, half, [](const detail::RopeRatios& r) { return r.length; });
    const auto logarithm_of_ratio = [](double x,
                                       double y) {  // not a difference of two: that loses digits with the unit
        int up = 0, down = 0;
        const double ratio = std::frexp(x, &up) / std::frexp(y, &down);
        return std::log(ratio) + (up - down) * std::numbers::ln2;
    };
    const double wanted = logarithm_of_ratio(equation[0].value, equation[1].value);
    const auto off = [&](double logarithm) {
        const detail::RopeRatios r(detail::RopeRatios::modulus(logarithm));
        return logarithm_of_ratio(equation[0].ratio(r), equation[1].ratio(r)) - wanted;
    };
    constexpr double farthest = 340;  // kappa or kappa' = 1e-148
    const auto logarithm = detail::root_between(off, -farthest, farthest);
    if (!logarithm) revchain::detail::throw_invalid(place, "no rope that double can hold has this form");
    functions_ = JacobiFunctions(detail::RopeRatios::modulus(*logarithm));
    const detail::RopeRatios r(modulus());
    quarter_ = equation[0].value / equation[0].ratio(r);
    const double along = 2 * quarter_ * waves();
    span_ = given.span.value_or(along), slack_ = given.slack.value_or(along * r.slack);
    length_ = given.length.value_or(along * r.length), sag_ = given.sag.value_or(quarter_ * r.sag);
    if (has_tension && !has_speed) conical_height_ = this->strength() / *given.tension * this->strength();
}

inline double SkippingRope::conical_height() const {
    if (!conical_height_)
        revchain::detail::throw_invalid("analytic::SkippingRope", "neither angular speed nor tension was given");
    return *conical_height_;
}

inline double SkippingRope::moment_of_inertia() const {
    const CompleteIntegrals& c = functions_.complete();
    const double k2 = kappa() * kappa(), c2 = complement() * complement();
    double mixed;  // int sin^2 cos^2 / Delta over a quarter turn
    if (k2 > 0.25) {
        mixed = (c.B - c2 * c.D) / (3 * k2);
    } else {  // pi/16 2F1(1/2, 3/2; 3; kappa^2)
        double term = 1;
        mixed = 1;
        for (double m = 0; term > 1e-17 * mixed; ++m) {
            term *= (m + 0.5) * (m + 1.5) / ((m + 3) * (m + 1)) * k2;
            mixed += term;
        }
        mixed *= std::numbers::pi / 16;
    }
    return 2 * waves() * sag() * sag() * (quarter_ / c.K) * (c.D + 2 * kappa() * slope_at_ends() / 2 * mixed);
}

inline RopePoint SkippingRope::at_argument(double u) const {
    const JacobiValues f = functions_(u);
    const double scale = quarter_ / functions_.complete().K, c2 = complement() * complement();
    return {scale * u, scale * (2 * f.epsilon / c2 - u), sag() * f.sn, slope_at_ends() * f.cn * f.dn,
            1 + kappa() * slope_at_ends() * f.cn * f.cn};
}

inline RopePoint SkippingRope::at(double x) const {
    if (!(x >= 0 && x <= span() * (1 + 1e-15)))
        revchain::detail::throw_invalid("analytic::SkippingRope::at", "x must lie between 0 and the span", x);
    RopePoint point = at_argument(x / quarter_ * functions_.complete().K);
    point.x = x;
    return point;
}

inline RopePoint SkippingRope::at_arc(double arc) const {
    if (!(arc >= 0 && arc <= length() * (1 + 1e-15)))
        revchain::detail::throw_invalid("analytic::SkippingRope::at_arc", "arc must lie between 0 and the length", arc);
    const double end = 2 * waves() * functions_.complete().K;
    const auto off = [&](double u) { return at_argument(u).arc - arc; };
    RopePoint point = at_argument(detail::root_between(off, 0.0, end).value_or(end));
    point.arc = arc;
    return point;
}

inline SkippingRope SkippingRope::drawn_to(double span) const {
    const double momentum = moment_of_inertia() * angular_speed();
    RopeGiven given{.span = span, .length = length(), .half_waves = half_waves_, .gravity = gravity_};
    given.angular_speed = momentum / SkippingRope(given).moment_of_inertia();
    return SkippingRope(given);
}

}  // namespace revchain::analytic

/// The rope that whirls without gravity and winds round its axis, its ends off the axis: the third elliptic integral.
/// Greenhill (1908) §5, text after (6).
///
/// With R the square of the distance from the axis, R1 <= R <= R2, c^2 = lambda h and  r = sqrt(R1 R2 + 4 c^4),
///     R3 = R1 + R2 + 2 r,   d = sqrt(R3 - R1),   kappa^2 = (R2 - R1)/(R3 - R1),   u = d x / (2 c^2):
///     R = R1 cn^2 u + R2 sn^2 u,   arc = d E(am u) - (r/d) u,   theta = sqrt(R2 R3/R1)/d Pi(1 - R2/R1; am u).
namespace revchain::analytic {

/// What is given; positive, but for the least radius, which may be 0 (the plane rope) and at most the greatest (equal:
/// a helix).
struct TortuousGiven {
    double least_radius, greatest_radius;
    double angular_speed;                                 ///< n
    double tension;                                       ///< h: what pulls along the axis, as a length of rope
    double gravity = conical_pendulum::standard_gravity;  ///< relates n to lambda, nothing else
};

/// What there is at one place of the rope.
struct TortuousPoint {
    double x, arc;         ///< along the axis and along the rope, from where the rope is nearest to the axis
    double radius;         ///< distance from the axis
    double angle;          ///< round the axis, rad; of the plane rope -pi/2 and pi/2 on either side of x = 0
    double radius_slope;   ///< d radius / dx
    double angle_slope;    ///< d angle / dx
    double tension_ratio;  ///< of the tension to its part along the axis
};

/// Accuracy: 1e-14 relative each, of the angle 1e-14 (1 + |angle|). Cost: 2 microseconds, a point 1.
class TortuousRope {
   public:
    /// Throws InvalidArgument for numbers that are not as said above, or beyond what double holds.
    explicit TortuousRope(const TortuousGiven& given);

    double least_radius() const { return first_; }
    double greatest_radius() const { return second_; }
    double conical_height() const { return height_; }
    double height_times_tension() const { return strength2_; }
    EllipticModulus modulus() const { return functions_.modulus(); }

    /// From one place nearest to the axis to the next: along the axis, along the rope, how much longer that is, and the
    /// angle round the axis (pi for the plane rope, which crosses it).
    double half_wave() const { return 2 * functions_.complete().K * scale_; }
    double half_wave_slack() const;
    double half_wave_length() const { return half_wave() + half_wave_slack(); }
    double half_wave_angle() const;

    /// At any x, of either sign.
    TortuousPoint at(double x) const;

   private:
    /// Least and greatest radius so far apart that the angle is that of the plane rope to the last digit.
    bool is_plane() const { return first_ <= 1e-20 * second_; }

    double first_, second_, third_;  // square roots of R1, R2, R3
    double height_, strength2_;      // lambda, c^2
    double root_, d_, scale_;        // r; d; x = scale u
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

inline TortuousRope::TortuousRope(const TortuousGiven& given)
    : first_(given.least_radius), second_(given.greatest_radius) {
    constexpr std::string_view place = "analytic::TortuousRope";
    if (!(first_ >= 0)) revchain::detail::throw_invalid(place, "least radius must not be negative", first_);
    revchain::detail::require_positive(place, "greatest radius", second_);
    if (!(first_ <= second_))
        revchain::detail::throw_invalid(place, "least radius must not exceed the greatest", first_);
    revchain::detail::require_positive(place, "tension", given.tension);
    revchain::detail::require_positive(place, "angular speed", given.angular_speed);
    revchain::detail::require_positive(place, "gravity", given.gravity);
    height_ = conical_pendulum::height(given.angular_speed, given.gravity);
    strength2_ = height_ * given.tension;
    if (!(strength2_ >= std::numeric_limits<double>::min()))
        revchain::detail::throw_invalid(place, "tension times gravity / angular speed^2 must be at least 2^-1022",
                                        strength2_);
    revchain::detail::require_positive(place, "tension times gravity / angular speed^2", strength2_);
    root_ = std::hypot(first_ * second_, 2 * strength2_);
    const double beyond = std::sqrt(2 * root_);
    d_ = std::hypot(second_, beyond);
    third_ = std::hypot(d_, first_);
    revchain::detail::require_positive(place, "greatest radius squared", d_ * d_);
    if (!std::isfinite(d_ * d_ / strength2_))  // tension_ratio and the slopes are at most that
        revchain::detail::throw_invalid(
            place,
            "greatest radius must be so small that radius^2 angular speed^2 / (tension gravity) does not overflow",
            second_);
    functions_ = JacobiFunctions(EllipticModulus::of_ratio(std::sqrt(second_ - first_) * std::sqrt(second_ + first_),
                                                           std::hypot(first_, beyond)));
    scale_ = 2 * (strength2_ / d_);
}

inline double TortuousRope::half_wave_slack() const {
    const CompleteIntegrals& c = functions_.complete();
    const double mixed = first_ * second_ / (root_ + 2 * strength2_) * (first_ * second_);
    return 2 * (second_ / d_ * second_ * c.B + first_ / d_ * first_ * c.D + mixed / d_ * c.K);
}

inline double TortuousRope::half_wave_angle() const {
    if (is_plane()) return std::numbers::pi;
    const double ratio = second_ / first_;
    return 2 * ratio * (third_ / d_) * complete_pi((1 - ratio) * (1 + ratio), modulus());
}

inline TortuousPoint TortuousRope::at(double x) const {
    if (!std::isfinite(x / scale_))
        revchain::detail::throw_invalid(
            "analytic::TortuousRope::at",
            "x must be finite, and so small that the number of half waves does not overflow", x);
    const JacobiValues f = functions_(x / scale_);
    TortuousPoint point{
        x, d_ * f.epsilon - root_ / d_ * (x / scale_), std::hypot(first_ * f.cn, second_ * f.sn), 0, 0, 0, 0};
    const double bend = f.dn / scale_;
    if (is_plane()) {  // through the axis, or so near that it turns there and nowhere else: half a turn
        const double half_turns = std::nearbyint(f.amplitude / std::numbers::pi);
        const double sign = std::fmod(half_turns, 2.0) == 0 ? 1 : -1;
        point.angle = half_turns * std::numbers::pi + std::atan2(sign * second_ * f.sn, sign * first_ * f.cn);
    } else {
        const double ratio = second_ / first_;
        point.angle = ratio * (third_ / d_) * incomplete_pi((1 - ratio) * (1 + ratio), f, modulus());
    }
    if (first_ == 0) {
        point.radius_slope = std::copysign(second_ * f.cn * bend, f.sn * f.cn * bend);
    } else {
        point.radius_slope = (second_ - first_) * ((second_ + first_) * f.sn / point.radius) * f.cn * bend;
        point.angle_slope = first_ / point.radius * (second_ / point.radius) * (third_ / (2 * strength2_));
    }
    if (!std::isfinite(point.arc))
        revchain::detail::throw_invalid("analytic::TortuousRope::at",
                                        "x must be so small that the rope up to it does not overflow", x);
    // (R1 + R2 + r - R) / 2 c^2
    point.tension_ratio = (std::pow(std::hypot(first_ * f.sn, second_ * f.cn), 2) + root_) / (2 * strength2_);
    return point;
}

}  // namespace revchain::analytic
