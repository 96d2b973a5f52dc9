// SPDX-License-Identifier: MPL-2.0
// Defines what sensitivity.hpp declares.
#pragma once

#include <string>

#include "revchain/linear/mode_shape.hpp"
#include "revchain/linear/scaled_links.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/sensitivity.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Describes how a mode moves one link: the slope s (lower less upper pin, over the length), the
/// offset of the centre of gravity, and the sum of a s^2 over the links above. In a bound, the
/// members are upper limits, and the third is the root of the sum.
template <class N>
struct Movement {
    N slope, centre, above;
};

/// Returns the five derivatives of y^T (M - lambda K) y, in the order of `Datum`, with the offsets
/// of the pins fixed.
template <class S>
std::array<S, 5> energy_derivatives(const ScaledLink<S>& link, const S& lambda,
                                    const Movement<S>& y) {
    const auto& [W, a, h, rho, below] = link;
    const S square = y.slope * y.slope, mixed = y.slope * y.centre, turning = rho * rho * square;
    const S pull = lambda * square;
    const S doubled = h * mixed + turning;
    return {(y.centre * y.centre + turning) - lambda * (h * square + y.above),
            ((h + h) * W / a + below) * pull - (doubled + doubled) * W / a,
            W * ((mixed + mixed) - pull), (rho + rho) * W * square, link.pull() * pull};
}

/// Returns bounds of |x^T (dM - lambda dK) y|; all arguments are absolute values.
template <class M>
std::array<M, 5> energy_bounds(const ScaledLink<M>& link, const M& lambda, const Movement<M>& x,
                               const Movement<M>& y) {
    const auto& [W, a, h, rho, below] = link;
    const M square = x.slope * y.slope, mixed = x.slope * y.centre + x.centre * y.slope;
    const M turning = rho * rho * square;
    return {x.centre * y.centre + turning + lambda * (h * square + x.above * y.above),
            (M(2) * W * h / a + below) * lambda * square + (h * mixed + M(2) * turning) * W / a,
            W * (mixed + lambda * square), M(2) * W * rho * square,
            (W * h / a + below) * lambda * square};
}

/// Sets the derivatives of one mode's height and their error bounds. With w any vector as long as y
/// in the norm of K, and e the tangent of the angle between y and the exact shape x,
///     |x^T E x - y^T E y| <= e^2 |y^T E y| + (1 + e^2)(2 e |w^T E y| + e^2 |w^T E w|).
/// The energy of w bounds its slopes, offsets and sums of slopes: s^2 <= 1/kappa, y^2 <= sum of 1/k
/// up to the support, sum a s^2 <= c/S, c the most by which W h and a S cancel.
template <Real T>
void set_derivatives(Sensitivity<T>& result, Index j, const std::vector<ScaledLink<Wide<T>>>& links,
                     const ChainUnits& units, const WideMode<T>& mode,
                     const Narrow<Wide<T>>& entry_error) {
    using std::abs, std::ldexp, std::sqrt;
    using S = Wide<T>;
    using M = Narrow<S>;
    const auto size_of = [](const S& x) { return M(abs(static_cast<M>(x))); };
    const Index n = static_cast<Index>(links.size());
    const M lambda = static_cast<M>(mode.height), e = mode.tangent;
    const M energy = sqrt(static_cast<M>(mode.stiffness));
    const M rounding = operation_error<S>() * M(8 * n + 64) + M(4) * entry_error + mode.off;
    const M unit = sizeof(T) == sizeof(M) ? static_cast<M>(epsilon<T>()) : epsilon<M>();
    S above(M(0));
    M flexibility(0), cancelled(1);
    for (Index m = n; m-- > 0;) {
        const std::size_t i = static_cast<std::size_t>(m);
        const ScaledLink<S>& link = links[i];
        const S upper = mode.offset[i + 1], slope = (mode.offset[i] - upper) / link.length;
        const Movement<S> y{slope, upper + link.centroid * slope, above};
        const auto value = energy_derivatives(link, mode.height, y);

        const ScaledLink<M> sizes{size_of(link.weight), size_of(link.length),
                                  size_of(link.centroid), size_of(link.radius),
                                  size_of(link.below)};
        const M kappa = size_of(link.pull()) * sizes.length, root = M(1) / sqrt(kappa);
        const M pulled = sizes.weight * sizes.centroid + sizes.length * sizes.below;
        cancelled = std::max(cancelled, pulled / kappa);
        const Movement<M> own{size_of(y.slope) / energy,
                              (size_of(upper) + sizes.centroid * size_of(y.slope)) / energy,
                              sqrt(size_of(above)) / energy};
        const Movement<M> any{root, sqrt(flexibility) + sizes.centroid * root,
                              sqrt(cancelled / (sizes.below + sizes.weight))};
        const auto cross = energy_bounds(sizes, lambda, any, own);
        const auto square = energy_bounds(sizes, lambda, any, any);
        const auto itself = energy_bounds(sizes, lambda, own, own);
        for (std::size_t d = 0; d < 5; ++d) {
            const int exponent = d == 0 ? units.length_exponent - units.weight_exponent : 0;
            const S derivative = value[d] / mode.stiffness;
            const M size = size_of(derivative);
            M bound = e * e * size + (M(1) + e * e) * e * (M(2) * cross[d] + e * square[d]) +
                      rounding * itself[d] + unit * size;
            if (!(bound <= std::numeric_limits<M>::max()))
                bound = std::numeric_limits<M>::infinity();
            auto& to = result.by_datum[d];
            to.value(j, m) = ldexp(static_cast<T>(derivative), exponent);
            to.error_bound(j, m) = ldexp(static_cast<T>(bound * M(1.001)), exponent);
        }
        above = above + slope * slope * link.length;
        flexibility = flexibility + sizes.length * (sizes.length / kappa);
    }
    // The length of the lowest link has no effect, because nothing hangs from its lower pin.
    result.by_datum[1].value(j, 0) = result.by_datum[1].error_bound(j, 0) = T(0);
}

}  // namespace detail

template <Real T>
Sensitivity<T> sensitivity(const Chain<T>& chain, const Modes<T>& modes) {
    detail::require_one_weight_unit("sensitivity", chain);
    Sensitivity<T> result;
    result.first = modes.first;
    for (auto& derivatives : result.by_datum)
        derivatives = {Table<T>(modes.size(), chain.size()), Table<T>(modes.size(), chain.size())};
    if (modes.size() == 0) return result;
    using M = Narrow<Wide<T>>;
    const detail::Pencils<T> pencils(chain);
    const auto links = detail::scaled_links(chain);
    for (Index j = 0; j < modes.size(); ++j) {
        detail::check_interrupt();
        const T height = modes.conical_height[j];
        M guess(0.5);  // closer than the neighbours that are known
        for (const Index i : {j - 1, j + 1})
            if (i >= 0 && i < modes.size() && height > T(0)) {
                const M apart = static_cast<M>(modes.conical_height[i] / height - T(1));
                guess = std::min(guess, (apart > M(0) ? apart : -apart) * M(0.75));
            }
        if (!(guess > M(0))) guess = M(0.5);
        const auto mode =
            detail::wide_mode<T>(pencils, modes.first + j, pencils.scaled(height), guess);
        detail::set_derivatives(result, j, links, chain.units(), mode, pencils.wide().entry_error);
    }
    return result;
}

template <Real T>
Uncertainty<T> uncertainty(const Sensitivity<T>& sensitivity,
                           const std::type_identity_t<Vector<T>>& conical_height,
                           const Deviations<T>& deviations) {
    using detail::throw_invalid;
    using std::abs, std::isfinite, std::sqrt;
    constexpr std::string_view place = "uncertainty";
    const Index k = sensitivity.size(), n = sensitivity.weight().value.cols();
    if (conical_height.size() != k)
        throw_invalid(place, "there must be as many heights as modes, " + std::to_string(k),
                      conical_height.size());
    const auto modes = static_cast<std::size_t>(k);
    Uncertainty<T> result{Vector<T>::Zero(k),
                          Vector<T>::Zero(k),
                          {},
                          std::vector<Datum>(modes),
                          std::vector<Index>(modes)};
    for (auto& share : result.share) share = Table<T>::Zero(k, n);
    for (std::size_t d = 0; d < datum_names.size(); ++d) {
        if (!deviations[d]) continue;
        const auto& [standard, covariance] = *deviations[d];
        const std::string name(datum_names[d]);
        const auto sound = [&](const T& x) { return isfinite(x) && x >= T(0); };
        const bool correlated = standard.size() == 0;
        if (!correlated && standard.size() != 1 && standard.size() != n)
            throw_invalid(place,
                          name + " must have one deviation or one for each of the " +
                              std::to_string(n) + " links",
                          standard.size());
        if (correlated && (covariance.rows() != n || covariance.cols() != n))
            throw_invalid(place,
                          "the covariance of " + name + " must have " + std::to_string(n) +
                              " rows and columns",
                          covariance.rows());
        for (const T& x : standard)
            if (!sound(x)) throw_invalid(place, name + " must be finite and not negative", x);
        for (Index i = 0; i < covariance.rows(); ++i)
            for (Index m = 0; m <= i; ++m)
                if (!isfinite(covariance(i, m)) || covariance(i, m) != covariance(m, i) ||
                    (i == m && !sound(covariance(i, i))))
                    throw_invalid(place,
                                  "the covariance of " + name +
                                      " must be finite, symmetric and its diagonal not negative",
                                  covariance(i, m));
        const Table<T>& value = sensitivity.by_datum[d].value;
        for (Index j = 0; j < k; ++j)
            for (Index m = 0; m < n; ++m) {
                T& variance = result.share[d](j, m);
                variance = value(j, m) * (correlated ? T(covariance.row(m).dot(value.row(j)))
                                                     : standard[standard.size() == 1 ? 0 : m]);
                if (!correlated) variance *= variance;
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
                    most = abs(share), result.datum[mode] = static_cast<Datum>(d),
                    result.link[mode] = m;
                share = variance > T(0) ? share / variance : T(0);
            }
        result.conical_height[j] = variance > T(0) ? sqrt(variance) : T(0);
        result.relative[j] = result.conical_height[j] / conical_height[j];
    }
    return result;
}

}  // namespace revchain
