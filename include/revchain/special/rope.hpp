// SPDX-License-Identifier: GPL-3.0-or-later
// Defines what rope.hpp declares.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "revchain/numeric/zero_between.hpp"
#include "revchain/rope.hpp"
#include "revchain/special/incomplete_elliptic.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic {
namespace detail {

/// Lengths of half of a half wave, divided by half its span.
struct RopeRatios {
    double span = 1, length, slack, sag, strength;  ///< strength: sqrt(lambda h)

    explicit RopeRatios(const EllipticModulus& modulus) {
        const CompleteIntegrals c = complete_integrals(modulus);
        const double k = modulus.modulus(), kc = modulus.complementary_modulus();
        strength = 1 / (kc * c.K);
        sag = 2 * k * strength / kc;
        slack = sag * (k * c.B);
        length = 1 + slack;
    }
};

/// The modulus with ln(kappa/kappa') = logarithm. In this unknown all ratios are nearly linear.
inline EllipticModulus rope_modulus(double logarithm) {
    return EllipticModulus::of_ratio(std::exp(0.5 * logarithm), std::exp(-0.5 * logarithm));
}

/// ln(x/y). A difference of two logarithms would depend on the unit.
inline double logarithm_of_ratio(double x, double y) {
    int up = 0, down = 0;
    const double ratio = std::frexp(x, &up) / std::frexp(y, &down);
    return std::log(ratio) + (up - down) * std::numbers::ln2;
}

/// Two of the five lengths, which determine a rope; the other three are empty.
struct RopeLengths {
    std::optional<double> span, length, slack, sag, strength;
};

inline RopeLengths rope_lengths(std::string_view place, const RopeGiven& given,
                                const std::optional<double>& conical_height) {
    RopeLengths l{given.span, given.length, given.slack, given.sag, {}};
    const bool has_both = given.angular_speed && given.tension;
    const int known = l.span.has_value() + l.length.has_value() + l.slack.has_value() +
                      l.sag.has_value() + has_both;
    if (known != 2)
        throw_invalid(place,
                      "two of span, length, slack, sag, and tension together with angular speed "
                      "must be given",
                      known);
    if (l.length && (l.span || l.slack)) {
        const double other = l.span ? *l.span : *l.slack;
        const std::string name = l.span ? "span" : "slack";
        if (!(*l.length > other))
            throw_invalid(place, "length must be greater than the " + name, *l.length);
        (l.span ? l.slack : l.span) = *l.length - other;
        l.length.reset();
    }
    if (has_both) l.strength = std::sqrt(*conical_height) * std::sqrt(*given.tension);

    const double waves = static_cast<double>(given.half_waves), pi = std::numbers::pi;
    const auto require_less = [&](const std::optional<double>& a, const std::optional<double>& b,
                                  double factor, std::string_view sentence,
                                  const std::optional<double>& shown) {
        if (a && b && !(*a < factor * *b)) throw_invalid(place, sentence, *shown);
    };
    require_less(l.sag, l.length, 0.5 / waves,
                 "sag must be less than half the length of a half wave", l.sag);
    require_less(l.slack, l.sag, 2 * waves,
                 "slack must be less than twice the sag of every half wave", l.slack);
    require_less(l.span, l.strength, pi * waves,
                 "too slow or too tight to bend: span must be less than pi sqrt(tension g) / n for "
                 "each half wave",
                 l.span);
    require_less(l.strength, l.length, 1 / (pi * waves),
                 "too slow or too tight to bend: length must be greater than pi sqrt(tension g) / "
                 "n for each half wave",
                 l.length);
    return l;
}

}  // namespace detail

inline SkippingRope::SkippingRope(const RopeGiven& given)
    : gravity_(given.gravity), half_waves_(given.half_waves) {
    constexpr std::string_view place = "analytic::SkippingRope";
    const auto check = [&](std::string_view name, const std::optional<double>& value) {
        if (value) detail::require_positive(place, name, *value);
    };
    detail::require_positive(place, "gravity", gravity_);
    if (half_waves_ < 1) detail::throw_invalid(place, "half waves must be at least 1", half_waves_);
    check("span", given.span), check("length", given.length), check("slack", given.slack),
        check("sag", given.sag);
    check("angular speed", given.angular_speed), check("tension", given.tension);
    if (given.angular_speed)
        conical_height_ = conical_pendulum::height(*given.angular_speed, gravity_);
    check("gravity / angular speed^2", conical_height_);
    const detail::RopeLengths lengths = detail::rope_lengths(place, given, conical_height_);

    // Two equations  given = a * ratio(kappa): their quotient is solved for kappa.
    struct Equation {
        double value;
        double detail::RopeRatios::*ratio;
    };
    std::array<Equation, 2> equation{};
    std::size_t count = 0;
    const auto add = [&](const std::optional<double>& value, double share,
                         double detail::RopeRatios::*ratio) {
        if (value && count < 2) equation[count++] = {*value * share, ratio};
    };
    const double half = 0.5 / waves();  // half of each half wave
    add(lengths.span, half, &detail::RopeRatios::span);
    add(lengths.slack, half, &detail::RopeRatios::slack);
    add(lengths.sag, 1, &detail::RopeRatios::sag);
    add(lengths.strength, 1, &detail::RopeRatios::strength);
    add(lengths.length, half, &detail::RopeRatios::length);
    constexpr double farthest = 340;  // ln(kappa/kappa'), either way: kappa or kappa' = 1e-148
    const double wanted = detail::logarithm_of_ratio(equation[0].value, equation[1].value);
    if (lengths.sag && lengths.strength &&
        std::abs(wanted) < farthest) {  // sag / strength = 2 kappa/kappa'
        functions_ =
            JacobiFunctions(EllipticModulus::of_ratio(*lengths.sag, 2 * *lengths.strength));
    } else {
        const auto off = [&](double logarithm) {
            const detail::RopeRatios r(detail::rope_modulus(logarithm));
            return detail::logarithm_of_ratio(r.*equation[0].ratio, r.*equation[1].ratio) - wanted;
        };
        const revchain::detail::SignChange<double> within{{-farthest, off(-farthest)},
                                                          {farthest, off(farthest)}};
        const double logarithm = revchain::detail::zero_between(within, off);
        if (std::isnan(logarithm))
            detail::throw_invalid(place, "no rope that double can hold has this form");
        functions_ = JacobiFunctions(detail::rope_modulus(logarithm));
    }
    const detail::RopeRatios r(modulus());
    quarter_ = equation[0].value / r.*equation[0].ratio;
    const double along = 2 * quarter_ * waves();
    span_ = given.span.value_or(along), slack_ = given.slack.value_or(along * r.slack);
    length_ = given.length.value_or(along * r.length), sag_ = given.sag.value_or(quarter_ * r.sag);
    if (given.tension && !given.angular_speed)
        conical_height_ = strength() / *given.tension * strength();
}

inline double SkippingRope::conical_height() const {
    if (!conical_height_)
        detail::throw_invalid("analytic::SkippingRope",
                              "neither angular speed nor tension was given");
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
    return 2 * waves() * sag() * sag() * (quarter_ / c.K) *
           (c.D + kappa() * slope_at_ends() * mixed);
}

inline RopePoint SkippingRope::at_argument(double u) const {
    const JacobiValues f = functions_(u);
    const double scale = quarter_ / functions_.complete().K, c2 = complement() * complement();
    return {scale * u, scale * (2 * f.epsilon / c2 - u), sag() * f.sn,
            slope_at_ends() * f.cn * f.dn, 1 + kappa() * slope_at_ends() * f.cn * f.cn};
}

inline RopePoint SkippingRope::at(double x) const {
    if (!(x >= 0 && x <= span() * (1 + 1e-15)))
        detail::throw_invalid("analytic::SkippingRope::at", "x must lie between 0 and the span", x);
    RopePoint point = at_argument(x / quarter_ * functions_.complete().K);
    point.x = x;
    return point;
}

inline RopePoint SkippingRope::at_arc(double arc) const {
    if (!(arc >= 0 && arc <= length() * (1 + 1e-15)))
        detail::throw_invalid("analytic::SkippingRope::at_arc",
                              "arc must lie between 0 and the length", arc);
    const double end = 2 * waves() * functions_.complete().K;
    const auto off = [&](double u) { return at_argument(u).arc - arc; };
    const revchain::detail::SignChange<double> within{{0, -arc}, {end, off(end)}};
    const double u = revchain::detail::zero_between(within, off);
    RopePoint point = at_argument(std::isnan(u) ? end : u);
    point.arc = arc;
    return point;
}

inline SkippingRope SkippingRope::drawn_to(double span) const {
    const double momentum = moment_of_inertia() * angular_speed();
    RopeGiven given{
        .span = span, .length = length(), .half_waves = half_waves_, .gravity = gravity_};
    given.angular_speed = momentum / SkippingRope(given).moment_of_inertia();
    return SkippingRope(given);
}

inline TortuousRope::TortuousRope(const TortuousGiven& given)
    : first_(given.least_radius), second_(given.greatest_radius) {
    constexpr std::string_view place = "analytic::TortuousRope";
    if (!(first_ >= 0)) detail::throw_invalid(place, "least radius must not be negative", first_);
    detail::require_positive(place, "greatest radius", second_);
    if (!(first_ <= second_))
        detail::throw_invalid(place, "least radius must not exceed the greatest", first_);
    detail::require_positive(place, "tension", given.tension, "angular speed", given.angular_speed,
                             "gravity", given.gravity);
    height_ = conical_pendulum::height(given.angular_speed, given.gravity);
    strength2_ = height_ * given.tension;
    if (!std::isnormal(strength2_))
        detail::throw_invalid(
            place, "tension times gravity / angular speed^2 must be at least 2^-1022 and finite",
            strength2_);
    root_ = std::hypot(first_ * second_, 2 * strength2_);
    const double beyond = std::sqrt(2 * root_);
    d_ = std::hypot(second_, beyond);
    third_ = std::hypot(d_, first_);
    detail::require_positive(place, "greatest radius squared", d_ * d_);
    if (!std::isfinite(d_ * d_ / strength2_))  // the bound of tension_ratio and the slopes
        detail::throw_invalid(place,
                              "greatest radius must be so small that radius^2 angular speed^2 / "
                              "(tension gravity) does not overflow",
                              second_);
    functions_ = JacobiFunctions(EllipticModulus::of_ratio(
        std::sqrt(second_ - first_) * std::sqrt(second_ + first_), std::hypot(first_, beyond)));
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
    constexpr std::string_view place = "analytic::TortuousRope::at";
    if (!std::isfinite(x / scale_))
        detail::throw_invalid(
            place, "x must be finite, and so small that the number of half waves does not overflow",
            x);
    const JacobiValues f = functions_(x / scale_);
    TortuousPoint point{x,
                        d_ * f.epsilon - root_ / d_ * (x / scale_),
                        std::hypot(first_ * f.cn, second_ * f.sn),
                        0,
                        0,
                        0,
                        0};
    const double bend = f.dn / scale_;
    if (is_plane()) {  // half a turn where it (nearly) crosses the axis, and no turn elsewhere
        const double half_turns = std::nearbyint(f.amplitude / std::numbers::pi);
        const double sign = std::fmod(half_turns, 2.0) == 0 ? 1 : -1;
        point.angle =
            half_turns * std::numbers::pi + std::atan2(sign * second_ * f.sn, sign * first_ * f.cn);
    } else {
        const double ratio = second_ / first_;
        point.angle =
            ratio * (third_ / d_) * incomplete_pi((1 - ratio) * (1 + ratio), f, modulus());
    }
    if (first_ == 0) {
        point.radius_slope = std::copysign(second_ * f.cn * bend, f.sn * f.cn * bend);
    } else {
        point.radius_slope =
            (second_ - first_) * ((second_ + first_) * f.sn / point.radius) * f.cn * bend;
        point.angle_slope =
            first_ / point.radius * (second_ / point.radius) * (third_ / (2 * strength2_));
    }
    if (!std::isfinite(point.arc) || !std::isfinite(point.angle))
        detail::throw_invalid(place, "x must be so small that the rope up to it does not overflow",
                              x);
    // (R1 + R2 + r - R) / 2 c^2
    point.tension_ratio =
        (std::pow(std::hypot(first_ * f.sn, second_ * f.cn), 2) + root_) / (2 * strength2_);
    return point;
}

}  // namespace revchain::analytic
