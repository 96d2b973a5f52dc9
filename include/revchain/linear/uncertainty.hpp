// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>

#include "revchain/linear/sensitivity.hpp"

namespace revchain {

/// How uncertain one datum is: one standard deviation for every link, one for each (N), or a covariance (N, N).
/// Deviations of different links are independent unless a covariance says otherwise; those of different data always.
template <Real T>
struct Deviation {
    Vector<T> standard{};  ///< (1) or (N); empty where a covariance is given
    Matrix<T> covariance{};
};

/// One for each `Datum`; absent: exactly known.
template <Real T>
using Deviations = std::array<std::optional<Deviation<T>>, datum_names.size()>;

/// Of k modes. First order: deviations of the heights are taken as linear in those of the data.
template <Real T>
struct Uncertainty {
    Vector<T> conical_height;                        ///< (k,) standard deviations, in the unit of the heights
    Vector<T> relative;                              ///< (k,) over the heights; of speeds and periods half as much
    std::array<Table<T>, datum_names.size()> share;  ///< (k, N) each, of the variance; all of a mode add up to 1
    std::vector<Datum> datum;                        ///< (k,) what contributes most, and of which link (from 0)
    std::vector<Index> link;
};

/// Standard deviations of conical heights from those of the data: variance = sum of (d lambda/dx)^2 var x, with a
/// covariance C of one datum d^T C d. What is left out is of second order: the variance's relative error is some
/// (sigma_x d^2 lambda/dx^2 / (d lambda/dx))^2, large where a derivative is all but 0.
/// Cost O(k N), with a covariance O(k N^2). Throws InvalidArgument for lists that are neither of one number nor of N,
/// deviations negative or not finite, a covariance not N by N, not symmetric or with a negative variance, and heights
/// not as many as the sensitivity's.
template <Real T>
Uncertainty<T> uncertainty(const Sensitivity<T>& sensitivity, const Vector<T>& conical_height,
                           const Deviations<T>& deviations) {
    using std::abs;
    using std::isfinite;
    using std::sqrt;
    constexpr std::string_view place = "uncertainty";
    const Index k = sensitivity.size(), n = sensitivity.weight().value.cols();
    if (conical_height.size() != k)
        detail::throw_invalid(place, "there must be as many heights as modes, " + std::to_string(k),
                              conical_height.size());
    Uncertainty<T> result{Vector<T>::Zero(k),
                          Vector<T>::Zero(k),
                          {},
                          std::vector<Datum>(static_cast<std::size_t>(k)),
                          std::vector<Index>(static_cast<std::size_t>(k))};
    for (auto& share : result.share) share = Table<T>::Zero(k, n);
    for (std::size_t d = 0; d < datum_names.size(); ++d) {
        if (!deviations[d]) continue;
        const auto& [standard, covariance] = *deviations[d];
        const std::string name(datum_names[d]);
        const auto sound = [&](const T& x) { return isfinite(x) && x >= T(0); };
        const bool correlated = standard.size() == 0;
        if (!correlated && standard.size() != 1 && standard.size() != n)
            detail::throw_invalid(
                place, name + " must have one deviation or one for each of the " + std::to_string(n) + " links",
                standard.size());
        if (correlated && (covariance.rows() != n || covariance.cols() != n))
            detail::throw_invalid(place,
                                  "the covariance of " + name + " must have " + std::to_string(n) + " rows and columns",
                                  covariance.rows());
        for (const T& x : standard)
            if (!sound(x)) detail::throw_invalid(place, name + " must be finite and not negative", x);
        for (Index i = 0; i < covariance.rows(); ++i)
            for (Index m = 0; m <= i; ++m)
                if (!isfinite(covariance(i, m)) || covariance(i, m) != covariance(m, i) ||
                    (i == m && !sound(covariance(i, i))))
                    detail::throw_invalid(
                        place, "the covariance of " + name + " must be finite, symmetric and its diagonal not negative",
                        covariance(i, m));
        const Table<T>& value = sensitivity.by_datum[d].value;
        for (Index j = 0; j < k; ++j)
            for (Index m = 0; m < n; ++m) {
                const T deviation = correlated ? T(0) : value(j, m) * standard[standard.size() == 1 ? 0 : m];
                const T variance =
                    correlated ? value(j, m) * T(covariance.row(m).dot(value.row(j))) : deviation * deviation;
                result.share[d](j, m) = variance;
                result.conical_height[j] += variance;
            }
    }
    for (Index j = 0; j < k; ++j) {
        const std::size_t mode = static_cast<std::size_t>(j);
        const T variance = result.conical_height[j];
        T most(-1);
        for (std::size_t d = 0; d < datum_names.size(); ++d)
            for (Index m = 0; m < n; ++m) {
                T& share = result.share[d](j, m);
                if (abs(share) > most)
                    most = abs(share), result.datum[mode] = static_cast<Datum>(d), result.link[mode] = m;
                share = variance > T(0) ? share / variance : T(0);
            }
        result.conical_height[j] = variance > T(0) ? sqrt(variance) : T(0);
        result.relative[j] = result.conical_height[j] / conical_height[j];
    }
    return result;
}

}  // namespace revchain
