// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/core/double_word.hpp"
#include "revchain/core/status.hpp"

namespace revchain {

/// One link of a chain: a rigid body with an upper and a lower pin. Greenhill (1908) §8.
/// Units: any consistent set; weights enter only by their ratios. `Chain` checks the numbers.
template <Real T>
struct Link {
    T weight{};    ///< W >= 0 (0: a massless thread or wire)
    T length{};    ///< a > 0, pin to pin
    T centroid{};  ///< h, from the UPPER pin to the centre of gravity, positive towards the lower pin; any sign
    /// rho^2 >= 0, square of the radius of gyration about the centre of gravity. Kept instead of the pendulum length
    /// l = h + rho^2/h because h = 0 is allowed, and in twice the digits because h (l - h) and rho rho do not fit in T:
    /// the answers then belong to the numbers the user gave, not to a rounding of them.
    Wide<T> gyration_squared{};

    friend bool operator==(const Link&, const Link&) = default;
};

namespace detail {
/// Refuses lengths whose square leaves the range in which double words of T are exact (1e-138 ... 1e153 in double).
template <Real T>
void require_squarable(std::string_view place, std::string_view name, const T& x) {
    using std::abs;
    using std::ldexp;
    using limits = std::numeric_limits<T>;
    if (abs(x) > ldexp(T(1), limits::max_exponent / 2 - 2) ||
        (x != T(0) && abs(x) < ldexp(T(1), limits::min_exponent / 2 + limits::digits)))
        refuse(place, std::string(name) + " is out of this scalar's reach; choose another unit of length", x);
}
}  // namespace detail

/// All weight at the lower pin (h = l = a): a plummet on a light thread. Greenhill (1908) §1, §2.
template <Real T>
Link<T> plummet(T weight, T length) {
    return {weight, length, length, Wide<T>(T(0))};
}

/// A uniform rod between its pins: h = a/2, rho^2 = a^2/12 (l = 2a/3).
template <Real T>
Link<T> uniform_rod(T weight, T length) {
    detail::require_squarable<T>("uniform_rod", "length", length);
    const Wide<T> a(length);
    return {weight, length, length / T(2), a * a / Wide<T>(T(12))};
}

/// What is known of a rigid link; exactly one of `pendulum_length` and `radius_of_gyration` is given.
template <Real T>
struct CompoundPendulum {
    T weight{};
    T length{};
    T centroid{};                           ///< h
    std::optional<T> pendulum_length{};     ///< l, of the equivalent simple pendulum about the upper pin; sign of h
    std::optional<T> radius_of_gyration{};  ///< rho >= 0, about the centre of gravity
};

namespace detail {

/// rho^2 from rho; refuses a negative or missing rho.
template <Real T>
Wide<T> gyration_from_radius(std::string_view place, T radius) {
    using std::isfinite;
    if (!isfinite(radius) || radius < T(0)) refuse(place, "radius of gyration must be finite and not negative", radius);
    require_squarable(place, "radius of gyration", radius);
    return Wide<T>(radius) * Wide<T>(radius);
}

/// rho^2 = h (l - h), §8 (1); refuses an imaginary rho, and h = 0 where l says nothing.
template <Real T>
Wide<T> gyration_from_pendulum_length(std::string_view place, T centroid, T pendulum_length) {
    using std::isfinite;
    if (!isfinite(centroid)) refuse(place, "centroid must be finite", centroid);
    if (!isfinite(pendulum_length)) refuse(place, "pendulum length must be finite", pendulum_length);
    if (centroid == T(0))
        refuse(place, "a centroid at the upper pin has no pendulum length; give the radius of gyration instead");
    require_squarable(place, "centroid", centroid);
    require_squarable(place, "pendulum length", pendulum_length);
    const Wide<T> squared = Wide<T>(centroid) * (Wide<T>(pendulum_length) - Wide<T>(centroid));
    if (squared < Wide<T>(T(0)))
        refuse(
            place,
            "imaginary radius of gyration: centroid (pendulum length - centroid) must not be negative, with centroid " +
                in_digits(centroid) + " and pendulum length " + in_digits(pendulum_length));
    return squared;
}

}  // namespace detail

/// Any rigid link: `compound_pendulum<double>({.weight = 3, .length = 1, .centroid = -0.05, .radius_of_gyration = 0.4})`.
/// Throws InvalidArgument for an imaginary radius of gyration, or if not exactly one of the last two is given.
template <Real T>
Link<T> compound_pendulum(const CompoundPendulum<T>& body) {
    constexpr std::string_view place = "compound_pendulum";
    if (body.pendulum_length.has_value() == body.radius_of_gyration.has_value())
        detail::refuse(place, "give either pendulum_length or radius_of_gyration (not both)");
    return {body.weight, body.length, body.centroid,
            body.radius_of_gyration
                ? detail::gyration_from_radius<T>(place, *body.radius_of_gyration)
                : detail::gyration_from_pendulum_length<T>(place, body.centroid, *body.pendulum_length)};
}

/// rho, radius of gyration about the centre of gravity.
template <Real T>
T radius_of_gyration(const Link<T>& link) {
    using std::sqrt;
    return static_cast<T>(sqrt(link.gyration_squared));
}

/// l = h + rho^2 / h, length of the equivalent simple pendulum about the upper pin (infinite where h = 0 < rho).
template <Real T>
T pendulum_length(const Link<T>& link) {
    if (link.gyration_squared == Wide<T>(T(0))) return link.centroid;
    if (link.centroid == T(0)) return std::numeric_limits<T>::infinity();
    return static_cast<T>(Wide<T>(link.centroid) + link.gyration_squared / Wide<T>(link.centroid));
}

}  // namespace revchain
