// SPDX-License-Identifier: MPL-2.0
// Defines what compound_link.hpp declares.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "revchain/compound_link.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Pendulum length of `link` minus that of `other`. Accuracy: 1 ulp for built-in scalars, also
/// where both nearly agree, for centroids above 1e-140 of the lengths.
template <std::floating_point T>
T pendulum_difference(const CompoundLink<T>& link, const CompoundLink<T>& other) {
    using S = Wide<T>;
    if constexpr (std::is_same_v<T, float>) {
        return static_cast<T>(
            pendulum_difference(CompoundLink<double>{link.centroid, link.radius_of_gyration},
                                CompoundLink<double>{other.centroid, other.radius_of_gyration}));
    } else {
        int power = 0;
        std::frexp(std::max(link.pendulum_length(), other.pendulum_length()), &power);
        const auto scaled = [&](const T& x) { return std::ldexp(x, -power); };
        const T h = scaled(link.centroid), k = scaled(link.radius_of_gyration);
        const T h0 = scaled(other.centroid), k0 = scaled(other.radius_of_gyration);
        const S whole = CompoundLink<S>{S(h), S(k)}.pendulum_length() -
                        CompoundLink<S>{S(h0), S(k0)}.pendulum_length();
        if (std::abs(static_cast<T>(whole)) > T(0x1p-20))
            return std::ldexp(static_cast<T>(whole), power);
        // h h0 times the difference is a sum of products of three numbers, each exactly four words.
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
        // Each pass leaves the exact sum unchanged and moves rounding errors to the front.
        for (std::size_t pass = 1; pass < size; ++pass)
            for (std::size_t i = 1; i < size; ++i) {
                const DoubleWord<T> sum = two_sum(terms[i], terms[i - 1]);
                terms[i] = sum.high, terms[i - 1] = sum.low;
            }
        return Product<T>{terms.back(), power}.over(h).over(h0).value();
    }
}

}  // namespace detail

template <Real T>
SwungLink<T> swung_link(const CompoundLink<T>& link, const T& height) {
    using std::abs, std::asin, std::atan, std::hypot, std::sqrt;
    detail::check("swung_link", link);
    detail::require_positive("swung_link", "height", height);
    const T h = link.centroid, length = link.pendulum_length();
    const auto squares = detail::squares_over_centroid(link);
    const T longer =
        height <= h
            ? static_cast<T>(squares.plus(h - height).over(length).root().value())
            : sqrt(detail::pendulum_difference(link, CompoundLink<T>{height, T(0)}) / length);
    if (!(longer > T(0))) return {T(0), T(1), T(0), T(0)};
    const T inclination = T(2) * asin(longer / sqrt(T(2)));
    const T sine = longer * sqrt(T(1) + height / length), outwards = h / height * sine;
    const T arm = link.square_over_centroid();
    return {inclination, hypot(T(1), outwards), atan(outwards),
            (T(1) + (abs(h - arm) + T(2) * arm) / length) * (height / length) / sine / inclination};
}

}  // namespace revchain
