// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/condensed_shapes.hpp"
#include "revchain/linear/heights.hpp"
#include "revchain/linear/interpolated_heights.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/system/converted.hpp"

namespace revchain {

/// Whirl speeds of small amplitude, Greenhill (1908) §8 (21) with sec delta = 1: the slowest, any range of mode numbers
/// without the ones before, or those in a window of heights or speeds (which modes lie in it is decided by
/// `ModeCounter::within`, by proved counts, not by the heights returned: a height just above `low` may round to it).
///
/// Method: bisection on counts in T, eight shifts to a pass; a twisted shape and its Rayleigh quotient in `Wide<T>`; two
/// proved counts for every mode; and the shape in `Wide<T>`. With a loose `rtol` the quotient is left out and the rest
/// done in T. In double faster ways to the same heights where they pay: `ModesMethod`; a chain of floats is solved in
/// double and the result rounded, its bound half an ulp of float.
/// Accuracy: conical heights within 0.501 ulp of the exact ones of the stored numbers (measured, N up to 1e5, ten kinds
/// of chain: tests/cpp/modes.cpp), error bound 2 ulp and proved; a loose `rtol` is kept by the bound. Shapes
/// 3.5e-16 of the largest offset; with a loose `rtol` as good as their height, rtol / (gap to the next height). Where
/// `Wide<T>` is T itself (DoubleDouble, a user's own scalar) errors and bounds grow with N: tests/cpp/modes.cpp.
/// Cost: about 0.55 microseconds per link and mode with shapes, 0.3 without (double), for many modes 0.25 and 0.005;
/// O(N k) memory.
/// Throws InvalidArgument for numbers outside 1 ... `chain.mode_count()`, for a window that is none, for numbers and a
/// window together, and for a tolerance that is negative or NaN. An empty window gives no modes. A tolerance out of reach
/// is `Status::tolerance_not_met` with the bounds reached.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

namespace detail {

/// The eigenvector in `Wide<T>` at a height in `Wide<T>`, rounded to T.
template <Real T>
pencil::Eigenvector<T> fine_shape(const pencil::ElementPencil<Wide<T>>& wide, const Wide<T>& height) {
    if constexpr (std::is_same_v<Narrow<Wide<T>>, T>) {
        return pencil::eigenvector(wide, height);
    } else {
        const auto vector = pencil::eigenvector(wide, height);
        pencil::Eigenvector<T> rounded{vector.offset.template cast<T>(), {}};
        for (const auto& crossing : vector.crossings)
            rounded.crossings.push_back({crossing.element, static_cast<T>(crossing.share)});
        return rounded;
    }
}

/// Stage 2 of `modes`: shape, residual and nodes of mode `j`. In T where the tolerance is loose and else in `Wide<T>` at
/// the height before it is rounded.
template <Real T>
void find_shape(Modes<T>& modes, Index j, const Chain<T>& chain, const Pencils<T>& pencils, const Height<T>& height,
                bool loose) {
    if (loose)
        set_shape(modes, j, chain, pencils.rounded(), height.value,
                  pencil::eigenvector(pencils.rounded(), height.value));
    else
        set_shape(modes, j, chain, pencils.wide(), height.value, fine_shape<T>(pencils.wide(), height.unrounded));
}

/// Stage 3 of `modes`: proved counts at other numbers of T on either side of height `j`, as far away as its error bound
/// says, and where rounding to T leaves that in doubt a little farther.
template <Real T, Real P>
void certify(Modes<T>& modes, Index j, const Pencils<P>& pencils, Index mode_count) {
    using std::isfinite;
    const T height = modes.conical_height[j], bound = modes.error_bound[j];
    const Index before = modes.first - 1 + j;
    modes.certificate.lower[j] = T(0);
    modes.certificate.upper[j] = std::numeric_limits<T>::infinity();
    modes.certificate.above_lower[j] = mode_count;
    modes.certificate.above_upper[j] = 0;
    if (!(bound < T(1))) return;
    bool below = false, above = false;
    T reach = height * std::max(bound, epsilon<T>());
    for (int attempt = 0; attempt < 8 && !(below && above); ++attempt, reach = reach + reach) {
        const T lower = height - reach, upper = height + reach;
        if (!(lower > T(0)) || !isfinite(upper)) return;
        const auto count =
            pencils.template certified_count<2>({pencils.scaled(Wide<P>(lower)), pencils.scaled(Wide<P>(upper))});
        if (!below && count[0].proved && count[0].above > before) {
            modes.certificate.lower[j] = lower;
            modes.certificate.above_lower[j] = count[0].above;
            below = true;
        }
        if (!above && count[1].proved && count[1].above <= before) {
            modes.certificate.upper[j] = upper;
            modes.certificate.above_upper[j] = count[1].above;
            above = true;
        }
    }
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    static_assert(
        !std::is_same_v<T, DoubleWord<double>> && !std::is_same_v<T, DoubleWord<long double>>,
        "a double word is the working arithmetic of a narrower scalar; as a scalar of its own take DoubleDouble");
    detail::check(options);
    detail::LazyCounter<T> assembled(chain);
    const ModeRange range = detail::chosen(chain, assembled, options);
    Modes<T> result = detail::room_for_modes(chain, range, options);  // early: it may not fit into memory
    result.method = "bisection";
    if (range.count == 0) return result;

    const double to_heights = options.shapes ? 0.6 : options.certify ? 0.8 : 1.0;
    const auto set_heights = [&](const detail::Heights<T>& found) {
        result.method = found.method;
        for (Index j = 0; j < range.count; ++j) {
            const auto& height = found.height[static_cast<std::size_t>(j)];
            detail::set_height(result, j, height.value, height.error_bound, chain.units().length_exponent, options);
        }
    };
    const auto set_shapes = [&](const detail::Heights<T>& found) {
        const bool loose = detail::is_loose(chain, options);
        for (Index j = 0; options.shapes && j < range.count; ++j) {
            detail::find_shape(result, j, chain, assembled.pencils(), found.height[static_cast<std::size_t>(j)], loose);
            detail::advance(options.progress, to_heights + (1 - to_heights) * static_cast<double>(j + 1) /
                                                               static_cast<double>(range.count));
        }
    };
    bool found = false;
    const auto take = [&](const auto& heights) {  // those of a way that may have found none
        if (!heights) return;
        set_heights(*heights);
        set_shapes(*heights);
        found = true;
    };
    if constexpr (std::is_same_v<T, double>) {
        const auto may = [&](ModesMethod method, bool pays) {
            return !found && (options.method == method || (options.method == ModesMethod::automatic && pays));
        };
        if (may(ModesMethod::together, detail::all_together_pays(chain, range, options)))
            take(detail::heights_all_together(chain, range, options));
        if (may(ModesMethod::spectrum, detail::spectrum_pays(chain, range, options)))
            take(detail::heights_by_spectrum(assembled, range, chain.mode_count(), options, to_heights));
        if (may(ModesMethod::blocks, detail::compression_pays(chain, range)))
            if (const auto fast = detail::heights_by_compression(chain, range, options, to_heights)) {
                set_heights(fast->found);
                found =
                    !options.shapes || detail::shapes_by_compression(result, chain, fast->compressed,
                                                                     fast->found.height, options.progress, to_heights);
            }
    }
    if (!found) {
        result.status = Status::success;
        take(std::optional(detail::heights_by_bisection(chain, assembled, range, options, to_heights)));
    }
    for (Index j = 0; options.certify && j < range.count; ++j) {
        detail::look();
        detail::certify(result, j, assembled.pencils(), chain.mode_count());
    }
    return result;
}

/// All in double, where every way is open and a million links lose nothing, and rounded: half an ulp of float beside.
template <>
inline Modes<float> modes(const Chain<float>& chain, const ModesOptions<float>& options) {
    detail::check(options);
    const double half_ulp = 0.50001 * static_cast<double>(epsilon<float>());
    const Chain<double> wide = converted<double>(chain);
    ModesOptions<double> asked{.first = options.first, .count = options.count};
    if (options.conical_height) asked.conical_height = {options.conical_height->low, options.conical_height->high};
    if (options.angular_speed)
        asked.angular_speed = {options.angular_speed->low, options.angular_speed->high, options.angular_speed->gravity};
    if (options.rtol && *options.rtol > 4 * half_ulp) asked.rtol = *options.rtol - half_ulp;
    asked.shapes = options.shapes;
    asked.progress = options.progress;
    asked.method = options.method;
    const Modes<double> fine = modes(wide, asked);

    Modes<float> result = detail::room_for_modes(chain, fine.range(), options);
    result.method = fine.method;
    std::optional<detail::Pencils<double>> pencils;
    if (fine.size() > 0 && (options.shapes || options.certify)) pencils.emplace(wide);
    for (Index j = 0; j < fine.size(); ++j) {
        const float height = static_cast<float>(fine.conical_height[j]);
        const double off = std::abs(static_cast<double>(height) / fine.conical_height[j] - 1);
        const double bound = height > 0 && std::isfinite(height) ? (off + fine.error_bound[j] * (1 + off)) * (1 + 1e-15)
                                                                 : std::numeric_limits<double>::infinity();
        detail::set_height(result, j, height,
                           std::nextafter(static_cast<float>(bound), std::numeric_limits<float>::infinity()), 0,
                           options);
        if (options.shapes) {
            result.shape.row(j) = fine.shape.row(j).cast<float>();
            const Vector<double> offset = result.shape.row(j).transpose().cast<double>();
            result.residual[j] = static_cast<float>(
                pencil::relative_residual(pencils->rounded(), pencils->scaled(static_cast<double>(height)), offset));
            result.nodes[static_cast<std::size_t>(j)] = fine.nodes[static_cast<std::size_t>(j)].cast<float>();
        }
        if (options.certify) detail::certify(result, j, *pencils, chain.mode_count());
    }
    return result;
}

}  // namespace revchain
