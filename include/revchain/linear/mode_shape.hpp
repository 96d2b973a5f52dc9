// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/linear/pencils.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// One mode to the digits of `Wide<T>`, in the units of its pencils, with error bounds.
template <Real T>
struct WideMode {
    using S = Wide<T>;
    S height;               ///< conical height
    std::vector<S> offset;  ///< offsets of pins 0 ... N, the largest 1
    S stiffness;            ///< y^T K y
    Narrow<S> tangent;      ///< bound of the angle to the exact shape in the norm of K, or infinity
    Narrow<S> off;          ///< bound of the relative error of `height`
};

/// Returns half the relative distance from `height` within which proved counts find conical height
/// `number` and no other; 0 if they do not. The search begins at `guess`, below 1.
template <Real T>
Narrow<Wide<T>> separation(const Pencils<T>& pencils, Index number, const Wide<T>& height,
                           Narrow<Wide<T>> guess = Narrow<Wide<T>>(0.5)) {
    using S = Wide<T>;
    using M = Narrow<S>;
    for (int round = 0; round < 40; ++round, guess = guess / M(4)) {
        const S away = height * S(guess);
        const auto count = pencils.template certified_count<2>({height - away, height + away});
        const bool proved = count[0].proved && count[1].proved;
        if (proved && count[0].above == number && count[1].above == number - 1)
            return guess * M(0.999);
    }
    return M(0);
}

/// Returns the residual (lambda K - M) y in the norm of K^-1, relative to lambda y in the norm of
/// K, with errors of rounding and data. It is sum f^2/k; f sums residual forces from the free end.
/// Cost O(N).
template <Real S>
Narrow<S> residual_size(const pencil::ElementPencil<S>& pencil, const S& height,
                        const std::vector<S>& offset, S* stiffness) {
    using std::abs, std::sqrt;
    using M = Narrow<S>;
    const auto size_of = [](const S& x) { return M(abs(static_cast<M>(x))); };
    S hung(M(0)), energy(M(0));  // mass times offset of all below, and y^T K y
    M hung_size(0), sum(0), link(0);
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const pencil::Element<S>& e = pencil.elements[m];
        const S lower = offset[m], upper = offset[m + 1], difference = lower - upper;
        const S spring = e.stiffness * difference, near = e.lower * lower + e.cross * upper;
        const M turns = size_of(e.cross) + M(2) * size_of(e.turning);
        const M masses = size_of(e.lower * lower) + turns * (size_of(lower) + size_of(upper)) +
                         size_of(e.upper * upper);
        const M rounding = (pencil.entry_error * M(3) + operation_error<S>() * (M(8) + link)) *
                           (size_of(height * spring) + hung_size + masses);
        const M force = size_of(height * spring - (hung + near)) + rounding;
        sum = sum + force * (force / static_cast<M>(e.stiffness));
        energy = energy + spring * difference;
        hung = hung + near + (e.cross * lower + e.upper * upper);
        hung_size = hung_size + masses;
        link = link + M(4);
    }
    *stiffness = energy;
    return sqrt(sum / static_cast<M>(energy)) / static_cast<M>(height) * M(1.001);
}

/// Returns mode `number` from a height near it. It alternates between the shape's Rayleigh quotient
/// in `Wide<T>`, whose error is the square of the shape's, and the shape at that quotient. It stops
/// when the shape is within 2^-70, or after three rounds. The angle is proved: residual over the
/// gap to the next height (Davis and Kahan).
template <Real T>
WideMode<T> wide_mode(const Pencils<T>& pencils, Index number, const T& near,
                      Narrow<Wide<T>> guess = Narrow<Wide<T>>(0.5)) {
    using std::sqrt;
    using S = Wide<T>;
    using M = Narrow<S>;
    WideMode<T> mode{
        S(static_cast<M>(near)), {}, S(M(0)), std::numeric_limits<M>::infinity(), M(1)};
    const auto rough = pencil::eigenvector(pencils.rounded(), near).offset;
    mode.height = pencil::rayleigh_quotient<S>(pencils.wide(), rough);
    M apart(0);
    for (int round = 0; round < 3; ++round) {
        auto vector = pencil::unrounded_eigenvector<S>(pencils.wide(), mode.height);
        for (S& y : vector.offset) y = y / vector.largest;
        mode.offset = std::move(vector.offset);
        const M size = residual_size(pencils.wide(), mode.height, mode.offset, &mode.stiffness);
        if (round == 0) apart = separation(pencils, number, mode.height, guess);
        if (!(apart > M(0))) return mode;
        const M sine = size / apart;
        if (sine < M(0.5)) {
            mode.tangent = sine / sqrt(M(1) - sine * sine);
            mode.off = size / (M(1) - size);
        }
        if (!(mode.tangent > M(0x1p-70)) || round == 2) return mode;
        S inertia(M(0));
        for (std::size_t m = 0; m < pencils.wide().elements.size(); ++m)
            inertia = inertia + pencil::mass_form(pencils.wide().elements[m], mode.offset[m],
                                                  mode.offset[m + 1]);
        mode.height = inertia / mode.stiffness;
    }
    return mode;
}

}  // namespace revchain::detail
