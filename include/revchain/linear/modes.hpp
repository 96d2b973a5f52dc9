// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <limits>
#include <optional>

#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/condensed_shapes.hpp"
#include "revchain/linear/interpolated_heights.hpp"
#include "revchain/linear/mode_table.hpp"
#include "revchain/linear/one_mode.hpp"
#include "revchain/modes.hpp"
#include "revchain/system/converted.hpp"

namespace revchain {

namespace detail {

/// Stage 2 of `modes`: shape, residual and nodes of mode `j`. In T where the tolerance is loose and else in `Wide<T>`
/// at the height before it is rounded.
template <Real T>
void find_shape(Modes<T>& modes, Index j, const Chain<T>& chain, const Pencils<T>& pencils, const Height<T>& height,
                bool loose) {
    if (loose)
        set_shape(modes, j, chain, pencils.rounded(), height.eigenvalue,
                  pencil::eigenvector(pencils.rounded(), height.eigenvalue));
    else
        set_shape(modes, j, chain, pencils.wide(), height.eigenvalue, fine_shape<T>(pencils.wide(), height.unrounded));
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

/// A chain of floats: all in double, where every way is open and a million links lose nothing, and rounded: half an ulp
/// of float beside. A template, so that a program without floats does not compile it.
template <std::same_as<float> T>
Modes<T> modes_in_double(const Chain<T>& chain, const ModesOptions<T>& options) {
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

    Modes<float> result = room_for_modes(chain, fine.range(), options);
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

/// In T itself.
template <Real T>
Modes<T> modes_in_scalar(const Chain<T>& chain, const ModesOptions<T>& options) {
    LazyCounter<T> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    const HeightsOptions<T> stage{options.rtol, options.shapes, options.progress};
    Modes<T> result = room_for_modes(chain, range, options);  // early: it may not fit into memory
    result.method = "bisection";
    if (range.count == 0) return result;

    const double to_heights = options.shapes ? 0.6 : options.certify ? 0.8 : 1.0;
    const auto set_heights = [&](const Heights<T>& found) {
        result.method = found.method;
        for (Index j = 0; j < range.count; ++j) {
            const auto& height = found.height[static_cast<std::size_t>(j)];
            set_height(result, j, height.eigenvalue, height.error_bound, chain.units().length_exponent, options);
        }
    };
    const auto set_shapes = [&](const Heights<T>& found) {
        const bool loose = is_loose(chain, stage);
        for (Index j = 0; options.shapes && j < range.count; ++j) {
            find_shape(result, j, chain, assembled.pencils(), found.height[static_cast<std::size_t>(j)], loose);
            advance(options.progress,
                    to_heights + (1 - to_heights) * static_cast<double>(j + 1) / static_cast<double>(range.count));
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
        if (may(ModesMethod::together, all_together_pays(chain, range, stage)))
            take(heights_all_together(chain, range, stage));
        if (may(ModesMethod::spectrum, spectrum_pays(chain, range, stage)))
            take(heights_by_spectrum(assembled, range, chain.mode_count(), stage, to_heights));
        if (may(ModesMethod::blocks, compression_pays(chain, range)))
            if (const auto fast = heights_by_compression(chain, range, stage, to_heights)) {
                set_heights(fast->found);
                found = !options.shapes || shapes_by_compression(result, chain, fast->compressed, fast->found.height,
                                                                 options.progress, to_heights);
            }
    }
    if (!found) {
        result.status = Status::success;
        take(std::optional(heights_by_bisection(chain, assembled, range, stage, to_heights)));
    }
    for (Index j = 0; options.certify && j < range.count; ++j) {
        look();
        certify(result, j, assembled.pencils(), chain.mode_count());
    }
    return result;
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    static_assert(
        !std::is_same_v<T, DoubleWord<double>> && !std::is_same_v<T, DoubleWord<long double>>,
        "a double word is the working arithmetic of a narrower scalar; as a scalar of its own take DoubleDouble");
    detail::check(options);
    if constexpr (std::is_same_v<T, float>)
        return detail::modes_in_double(chain, options);
    else
        return detail::modes_in_scalar(chain, options);
}

}  // namespace revchain
