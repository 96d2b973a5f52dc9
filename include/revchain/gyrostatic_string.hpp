// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/product.hpp"

/// Circular and plane waves along a row of links with flywheels: Thomson's gyrostatic string.
///
///     const revchain::GyrostaticString<double> string{
///         .weight = 1.0, .length = 0.1, .tension = 50.0, .momentum = 0.01, .centroid = 0.05};
///     revchain::link_phase(string, 20.0).phase;  // 0.278261 rad from link to link at 20 rad/s
///     revchain::wave_speeds(string, 0.3)[0];     // 21.6189 rad/s forward
///     revchain::plane_rotation(string, 20.0);    // 0.00560363 rad from link to link
///
/// Links are jointed in a row under one tension. Their weight counts only as inertia; offsets are
/// small. Units: any consistent set, angles in rad.
///
/// In a circular wave every pin runs round the line with the speed n, an angle theta behind its
/// neighbour. n is positive in the direction of rotation of a wheel with positive momentum:
///     (T/a + n H/a^2) 4 sin^2(theta/2) = (n^2/g) (W - 4 X sin^2(theta/2)),
///     X = W (h (a - h) - rho^2)/a^2.
/// All functions are O(1). They throw InvalidArgument unless weight, length, tension and gravity
/// are positive and all numbers finite, and for a negative radius of gyration.
namespace revchain::inline REVCHAIN_BUILD {

/// A row of equal links.
template <Real T>
struct GyrostaticString {
    T weight;                ///< W > 0, of a link with its wheel
    T length;                ///< a > 0, from pin to pin
    T tension;               ///< T > 0
    T momentum;              ///< H, of a wheel about its link: force x length x time, of any sign
    T centroid;              ///< h, from one of the pins
    T radius_of_gyration{};  ///< rho >= 0, across the link, about the centre of gravity
    T gravity = T(conical_pendulum::standard_gravity);  ///< turns weight into mass
};

/// Propagation of a circular wave: exp(i m phase) exp(-m attenuation) at link m. A wave that
/// propagates has attenuation 0; otherwise the phase is 0 or pi.
template <Real T>
struct LinkPhase {
    T phase{};        ///< 0 ... pi
    T attenuation{};  ///< >= 0
};

namespace detail {

/// X/W.
template <Real T>
T share_across(const GyrostaticString<T>& s) {
    const T p = s.centroid / s.length, r = s.radius_of_gyration / s.length;
    return p * (T(1) - p) - r * r;
}

template <Real T>
void check(std::string_view place, const GyrostaticString<T>& s) {
    using std::isfinite;
    require_positive(place, "weight", s.weight, "length", s.length, "tension", s.tension, "gravity",
                     s.gravity);
    require_finite(place, "momentum", s.momentum, "centroid", s.centroid);
    require_not_negative(place, "radius of gyration", s.radius_of_gyration);
    if (!isfinite(share_across(s)))
        throw_invalid(place,
                      "length must not be so small that centroid or radius of gyration over it, "
                      "squared, overflow",
                      s.length);
}

/// n H/a^2 over the inertia W n^2/g.
template <Real T>
Product<T> spin_ratio(const GyrostaticString<T>& s, const T& n) {
    const T a = s.length;
    return Product<T>::of(s.momentum).over(a).over(a).over(s.weight).times(s.gravity).over(n);
}

/// sin^2 and cos^2 of half the phase; one of them is negative if the wave does not propagate.
template <Real T>
std::array<Product<T>, 2> half_phase(const GyrostaticString<T>& s, const T& n) {
    using P = Product<T>;
    if (n == T(0)) return {P{T(0)}, P{T(1)}};
    const P pull = P::of(s.tension).over(s.length).over(s.weight).times(s.gravity).over(n).over(n);
    const P stiffness = pull.plus(spin_ratio(s, n)).plus(share_across(s));  // over the inertia
    return {P{T(1)}.over(stiffness).over(T(4)), stiffness.plus(T(-0.25)).over(stiffness)};
}

}  // namespace detail

/// The circular wave at the speed n, of either sign. Accuracy: 4 ulp, divided by cos(phase/2) where
/// that is small, and multiplied by the cancellation of T/a, n H/a^2 and (n^2/g) X
/// (tests/cpp/gyrostatic_string.cpp). Also throws InvalidArgument for a speed that is not finite.
template <Real T>
[[nodiscard]] LinkPhase<T> link_phase(const GyrostaticString<T>& string, const T& angular_speed) {
    using std::asinh, std::atan2;
    detail::check("link_phase", string);
    detail::require_finite("link_phase", "angular speed", angular_speed);
    const auto [sine, cosine] = detail::half_phase(string, angular_speed);
    if (sine.fraction < T(0)) return {T(0), T(2) * asinh(sine.times(T(-1)).root().value())};
    if (cosine.fraction < T(0))
        return {detail::pi<T>, T(2) * asinh(cosine.times(T(-1)).root().value())};
    return {T(2) * atan2(sine.root().value(), cosine.root().value()), T(0)};
}

/// The two speeds of a circular wave with a given phase from link to link: forward (positive) and
/// backward. Accuracy: 4 ulp, and 1 ulp more for each bit that cancels in 1 - 4 X sin^2/W. Also
/// throws InvalidArgument unless 0 < phase <= pi.
template <Real T>
[[nodiscard]] std::array<T, 2> wave_speeds(const GyrostaticString<T>& string, const T& phase) {
    using std::abs, std::sin;
    detail::check("wave_speeds", string);
    if (!(phase > T(0)) || !(phase <= detail::pi<T>))
        detail::throw_invalid("wave_speeds", "phase must lie above 0 and not above pi", phase);
    using P = detail::Product<T>;
    const T chord = phase < epsilon<T>() ? phase : T(2) * sin(phase / T(2));
    // A x^2 - B x - C = 0 with x = n / chord, for momentum |H|
    const P A = P::of(string.weight)
                    .over(string.gravity)
                    .times(T(1) - chord * chord * detail::share_across(string));
    const P B = P::of(abs(string.momentum)).over(string.length).over(string.length).times(chord);
    const P C = P::of(string.tension).over(string.length);
    const P q = B.plus(B.times(B).plus(A.times(C).times(T(4))).root()).over(T(2));
    const T slower = C.over(q).times(chord).value();
    const T faster = B.fraction > T(0) ? q.over(A).times(chord).value() : slower;
    return string.momentum < T(0) ? std::array<T, 2>{slower, -faster}
                                  : std::array<T, 2>{faster, -slower};
}

/// Angle by which the plane of a vibration to and fro turns from link to link: half the difference
/// of the phases of the two circular parts, positive in the direction of rotation of a wheel with
/// positive momentum. NaN if one of the parts does not propagate. Accuracy: 8 ulp, divided by the
/// cosine of half the larger phase where that is small, and multiplied by the cancellation as for
/// `link_phase`. Also throws InvalidArgument for a speed that is not positive.
template <Real T>
[[nodiscard]] T plane_rotation(const GyrostaticString<T>& string, const T& angular_speed) {
    using std::asin;
    detail::check("plane_rotation", string);
    detail::require_positive("plane_rotation", "angular speed", angular_speed);
    const auto [ahead, ahead_rest] = detail::half_phase(string, angular_speed);
    const auto [back, back_rest] = detail::half_phase(string, T(-angular_speed));
    for (const auto& square : {ahead, ahead_rest, back, back_rest})
        if (square.fraction < T(0)) return std::numeric_limits<T>::quiet_NaN();
    if (string.momentum == T(0)) return T(0);
    // the difference of sin^2 of both halves, in which the tension cancels
    const auto difference =
        detail::spin_ratio(string, angular_speed).times(T(8)).times(ahead).times(back);
    const auto sum = back.times(ahead_rest).root().plus(ahead.times(back_rest).root());
    return asin(difference.over(sum).value());
}

}  // namespace revchain
