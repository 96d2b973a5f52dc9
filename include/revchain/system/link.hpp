// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/product.hpp"
#include "revchain/numeric/status.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// One link of a chain: a rigid body with an upper and a lower pin. Greenhill (1908) §8.
/// Units: any consistent set; weights enter only by their ratios. `Chain` checks the numbers.
template <Real T>
struct Link {
    T weight{};    ///< W >= 0 (0: a massless thread or wire)
    T length{};    ///< a > 0, pin to pin
    T centroid{};  ///< h, centre of gravity from the UPPER pin towards the lower pin; any sign
    /// (rho/a)^2 >= 0, with rho the radius of gyration about the centre of gravity. The pendulum
    /// length l = h + rho^2/h is not stored, because h = 0 is allowed. A ratio stays in the range
    /// of T in any unit of length. Twice the digits reproduce the given numbers to 1e-31.
    Wide<T> gyration_ratio{T(0)};

    friend bool operator==(const Link&, const Link&) = default;
};

/// A link hangs (cos d > 0) or stands, above the horizontal through its upper pin (cos d < 0).
enum class Posture { hangs = 1, stands = -1 };

namespace detail {

/// Returns x / length in twice the digits, for any unit of length.
template <Real T>
Wide<T> in_lengths(const Wide<T>& x, const T& length) {
    return Product<Wide<T>>::of(x).over(Wide<T>(length)).value();
}

/// Returns x times `length`, rounded once, for any unit.
template <Real T>
T times_length(const Wide<T>& x, const T& length) {
    using std::ldexp;
    const auto product = Product<Wide<T>>::of(x).times(length);
    return ldexp(static_cast<T>(product.fraction), product.exponent);
}

/// The largest ratio of two lengths a, |h|, rho of a chain: 1e77 in double. Products of larger
/// ratios leave the range of T.
template <Real T>
T length_span() {
    using std::ldexp;
    return ldexp(T(1), std::numeric_limits<T>::max_exponent / 4);
}

/// Returns `ratio` = (rho/a)^2. Throws InvalidArgument if rho and a are too far apart.
template <Real T>
Wide<T> in_reach(std::string_view place, const Wide<T>& ratio, const T& length) {
    const Wide<T> largest(length_span<T>() * length_span<T>());
    if (!(ratio <= largest && Wide<T>(T(1)) <= ratio * largest))
        throw_invalid(
            place,
            "radius of gyration and length are too far apart for this scalar, with a length of " +
                in_digits(length));
    return ratio;
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
    return {weight, length, length / T(2), Wide<T>(T(1)) / Wide<T>(T(12))};
}

/// The data of a rigid link: exactly one of `pendulum_length` and `radius_of_gyration` is given.
template <Real T>
struct CompoundPendulum {
    T weight{};
    T length{};
    T centroid{};  ///< h
    std::optional<T>
        pendulum_length{};  ///< l, of the equivalent simple pendulum about the upper pin; sign of h
    std::optional<T> radius_of_gyration{};  ///< rho >= 0, about the centre of gravity
};

namespace detail {

/// (rho/a)^2 from rho. Throws InvalidArgument for a negative rho or one that is not finite.
template <Real T>
Wide<T> gyration_from_radius(std::string_view place, T length, T radius) {
    require_not_negative(place, "radius of gyration", radius);
    require_positive(place, "length", length);
    if (radius == T(0)) return Wide<T>(T(0));
    const Wide<T> ratio = in_lengths<T>(radius, length);
    return in_reach(place, ratio * ratio, length);
}

/// (rho/a)^2 from rho^2 = h (l - h), §8 (1). Throws InvalidArgument for an imaginary rho, and for
/// h = 0, where l does not determine rho.
template <Real T>
Wide<T> gyration_from_pendulum_length(std::string_view place, T length, T centroid,
                                      T pendulum_length) {
    require_finite(place, "centroid", centroid, "pendulum length", pendulum_length);
    if (centroid == T(0))
        throw_invalid(place,
                      "a centroid at the upper pin has no pendulum length; give the radius of "
                      "gyration instead");
    require_positive(place, "length", length);
    if (centroid > T(0) ? pendulum_length < centroid : centroid < pendulum_length)
        throw_invalid(place,
                      "imaginary radius of gyration: centroid (pendulum length - centroid) must "
                      "not be negative, with centroid " +
                          in_digits(centroid) + " and pendulum length " +
                          in_digits(pendulum_length));
    if (pendulum_length == centroid) return Wide<T>(T(0));
    const Wide<T> beyond = Wide<T>(pendulum_length) - Wide<T>(centroid);  // exact
    return in_reach(place, in_lengths<T>(centroid, length) * in_lengths(beyond, length), length);
}

}  // namespace detail

/// Any rigid link:
///     compound_pendulum<double>(
///         {.weight = 3, .length = 1, .centroid = -0.05, .radius_of_gyration = 0.4})
/// Throws InvalidArgument for an imaginary radius of gyration, or if not exactly one of
/// `pendulum_length` and `radius_of_gyration` is given.
template <Real T>
Link<T> compound_pendulum(const CompoundPendulum<T>& body) {
    constexpr std::string_view place = "compound_pendulum";
    if (body.pendulum_length.has_value() == body.radius_of_gyration.has_value())
        detail::throw_invalid(place,
                              "give either pendulum_length or radius_of_gyration (not both)");
    return {body.weight, body.length, body.centroid,
            body.radius_of_gyration
                ? detail::gyration_from_radius<T>(place, body.length, *body.radius_of_gyration)
                : detail::gyration_from_pendulum_length<T>(place, body.length, body.centroid,
                                                           *body.pendulum_length)};
}

/// rho, radius of gyration about the centre of gravity.
template <Real T>
T radius_of_gyration(const Link<T>& link) {
    using std::sqrt;
    return detail::times_length<T>(sqrt(link.gyration_ratio), link.length);
}

/// l = h + rho^2 / h, length of the equivalent simple pendulum about the upper pin; infinite where
/// h = 0 < rho.
template <Real T>
T pendulum_length(const Link<T>& link) {
    if (link.gyration_ratio == Wide<T>(T(0))) return link.centroid;
    if (link.centroid == T(0)) return std::numeric_limits<T>::infinity();
    const Wide<T> h = detail::in_lengths<T>(link.centroid, link.length);
    return detail::times_length<T>(h + link.gyration_ratio / h, link.length);
}

}  // namespace revchain
