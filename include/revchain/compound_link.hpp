// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/product.hpp"
#include "revchain/numeric/status.hpp"

/// One rigid link, Greenhill (1908) §6. Lengths in any unit. All throw InvalidArgument for a centroid not positive, a
/// radius of gyration negative, or either not finite.
namespace revchain {

/// A compound link: its weight acts at `centroid` from the pin it hangs by, and turns about there with
/// `radius_of_gyration`.
template <Real T>
struct CompoundLink {
    T centroid;            ///< h > 0
    T radius_of_gyration;  ///< k >= 0; 0 is a plummet

    /// l = h + k^2/h, of the equivalent simple pendulum; also the distance of the centre of oscillation from the pin.
    T pendulum_length() const {
        using std::isfinite;
        const T length = static_cast<T>(Wide<T>(centroid) + squares_over_centroid().value());
        return isfinite(length) ? length : centroid + square_over_centroid();  // infinite where it overflows
    }
    /// k^2/h: the centroid from the centre of oscillation; hung from there the two change places, §6.
    T square_over_centroid() const { return static_cast<T>(squares_over_centroid().value()); }
    detail::Product<Wide<T>> squares_over_centroid() const {
        const Wide<T> k(radius_of_gyration);
        return detail::Product<Wide<T>>{}.times(k).times(k).over(centroid);
    }
    /// Share h/l of the weight at the centre of oscillation, where two particles that move as the link does replace it
    /// (Maxwell); the rest is at the pin. §6.
    T share_at_centre_of_oscillation() const { return centroid / pendulum_length(); }
};

namespace detail {
template <Real T>
void check(std::string_view place, const CompoundLink<T>& link) {
    require_positive(place, "centroid", link.centroid);
    using std::isfinite;
    if (!(link.radius_of_gyration >= T(0)) || !isfinite(link.pendulum_length()))
        throw_invalid(place, "radius of gyration must not be negative, nor its square too large for the centroid",
                      link.radius_of_gyration);
}

/// The pendulum length of `link` less that of `other`. Accuracy: 1 ulp for built-in numbers however near the two are,
/// for centroids above 1e-140 of the lengths.
template <std::floating_point T>
T pendulum_difference(const CompoundLink<T>& link, const CompoundLink<T>& other) {
    using S = Wide<T>;
    if constexpr (std::is_same_v<T, float>) {
        const auto in_double = [](const CompoundLink<T>& x) {
            return CompoundLink<double>{x.centroid, x.radius_of_gyration};
        };
        return static_cast<T>(pendulum_difference(in_double(link), in_double(other)));
    } else {
        int power = 0;
        std::frexp(std::max(link.pendulum_length(), other.pendulum_length()), &power);
        const T h = std::ldexp(link.centroid, -power), k = std::ldexp(link.radius_of_gyration, -power);
        const T h0 = std::ldexp(other.centroid, -power), k0 = std::ldexp(other.radius_of_gyration, -power);
        const S whole = CompoundLink<S>{S(h), S(k)}.pendulum_length() - CompoundLink<S>{S(h0), S(k0)}.pendulum_length();
        if (std::abs(static_cast<T>(whole)) > T(0x1p-20)) return std::ldexp(static_cast<T>(whole), power);
        // h h0 times the difference: a sum of products of three numbers, each four words, exact
        std::array<T, 16> terms;
        std::size_t size = 0;
        const auto add = [&](const T& x, const T& y, const T& z) {
            const DoubleWord<T> product = two_product(x, y);
            for (const T& word : {product.high, product.low}) {
                const DoubleWord<T> part = two_product(word, z);
                terms[size++] = part.high, terms[size++] = part.low;
            }
        };
        add(h, h, h0), add(k, k, h0), add(h0, h0, T(-h)), add(k0, k0, T(-h));
        for (std::size_t pass = 1; pass < size;
             ++pass)  // no digit is lost: each pass moves what sums leave over downwards
            for (std::size_t i = 1; i < size; ++i) {
                const DoubleWord<T> sum = two_sum(terms[i], terms[i - 1]);
                terms[i] = sum.high, terms[i - 1] = sum.low;
            }
        return Product<T>{terms.back(), power}.over(h).over(h0).value();
    }
}
}  // namespace detail

/// A link that swings round, hung from an axle on the axis.
template <Real T>
struct SwungLink {
    T inclination;           ///< to the vertical, rad, 0 ... pi/2
    T reaction;              ///< at the axle, over the weight
    T reaction_inclination;  ///< of its line, which runs through the point E below the centroid, level with L; rad
    /// Relative change of the inclination over the largest relative change of the data; 0 for a vertical link.
    T condition;
};

/// A link turning at the speed whose conical height is `height`: inclined as a plummet at its centre of oscillation,
/// cos(inclination) = height/l, it pulls at its axle with its weight downwards and W (h/height) sin(inclination)
/// outwards. §6 (1), (2). Accuracy: 4 ulp, for the data as given, however near `height` and l are. There the
/// inclination changes by up to `condition` times as much as the data, in ratio:  cot d / d (1 + (|h - k^2/h| + 2
/// k^2/h)/l).
/// Throws InvalidArgument for a height that is not positive and finite.
template <Real T>
SwungLink<T> swung_link(const CompoundLink<T>& link, const T& height) {
    using std::abs;
    using std::asin;
    using std::atan;
    using std::hypot;
    using std::sqrt;
    detail::check("swung_link", link);
    detail::require_positive("swung_link", "height", height);
    const T h = link.centroid, length = link.pendulum_length();
    const T longer = height <= h
                         ? static_cast<T>(link.squares_over_centroid().plus(h - height).over(length).root().value())
                         : sqrt(detail::pendulum_difference(link, CompoundLink<T>{height, T(0)}) / length);
    if (!(longer > T(0))) return {T(0), T(1), T(0), T(0)};
    const T inclination = T(2) * asin(longer / sqrt(T(2)));
    const T sine = longer * sqrt(T(1) + height / length), outwards = h / height * sine;
    const T arm = link.square_over_centroid();
    return {inclination, hypot(T(1), outwards), atan(outwards),
            (T(1) + (abs(h - arm) + T(2) * arm) / length) * (height / length) / sine / inclination};
}

}  // namespace revchain
