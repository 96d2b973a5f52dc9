// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "revchain/analytic/detail/root.hpp"
#include "revchain/analytic/jacobi.hpp"
#include "revchain/core/conical_pendulum.hpp"

/// The rope that whirls between two points of its axis, gravity left out: y = b sn(K x/a). Greenhill (1908) §5.
/// Neighbouring nodes are 2 a apart, b is the sag, lambda = g/n^2 the conical height, and h the length of rope that weighs
/// as much as the tension in the middle of a half wave; the form depends on lambda h alone.
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
    /// Throws InvalidArgument for numbers that are not positive and finite, too few or too many of them, and for what no
    /// rope does: a length not above the span, a sag not below half the length, a rope too slow or too tight to bend.
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
    if (half_waves_ < 1) revchain::detail::refuse(place, "half waves must be at least 1", half_waves_);
    std::optional<double> span = given.span, slack = given.slack, length = given.length, strength;
    const bool has_span = check("span", span), has_length = check("length", length), has_slack = check("slack", slack);
    const bool has_sag = check("sag", given.sag), has_speed = check("angular speed", given.angular_speed);
    const bool has_tension = check("tension", given.tension), has_both = has_speed && has_tension;
    const int known = has_span + has_length + has_slack + has_sag + has_both;
    if (known != 2)
        revchain::detail::refuse(
            place, "two of span, length, slack, sag, and tension together with angular speed must be given", known);
    if (has_length && (has_span || has_slack)) {
        const double other = has_span ? *span : *slack;
        if (!(*length > other))
            revchain::detail::refuse(
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
        if (a && b && !(*a < factor * *b)) revchain::detail::refuse(place, sentence, *shown);
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
    if (!logarithm) revchain::detail::refuse(place, "no rope that double can hold has this form");
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
        revchain::detail::refuse("analytic::SkippingRope", "neither angular speed nor tension was given");
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
        revchain::detail::refuse("analytic::SkippingRope::at", "x must lie between 0 and the span", x);
    RopePoint point = at_argument(x / quarter_ * functions_.complete().K);
    point.x = x;
    return point;
}

inline RopePoint SkippingRope::at_arc(double arc) const {
    if (!(arc >= 0 && arc <= length() * (1 + 1e-15)))
        revchain::detail::refuse("analytic::SkippingRope::at_arc", "arc must lie between 0 and the length", arc);
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
