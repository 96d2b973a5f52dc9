// SPDX-License-Identifier: MPL-2.0
// Defines what methods.hpp declares.
#pragma once

#include <concepts>
#include <tuple>
#include <vector>

#include "revchain/methods.hpp"
#include "revchain/models/select.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// Returns the given methods and bisection, which always answers.
template <class... Models>
auto with_bisection(const std::tuple<Models...>& methods) {
    return std::tuple_cat(methods, std::tuple<models::Bisection>());
}

/// Returns the question about a range of modes. Without a tolerance, bounds must be proved.
REVCHAIN_LAZY
models::Question question_of(const ModeRange& range, const std::optional<double>& tolerance,
                             Progress* progress = nullptr,
                             LazyCounter<double>* assembled = nullptr) {
    const double rtol = tolerance.value_or(0.0);
    return {range.first, range.count, rtol, 0, progress, !(rtol > 0), assembled};
}

/// The name of a method in `Modes::method`.
REVCHAIN_LAZY
std::string_view name_of(ModesMethod method) {
    switch (method) {
        case ModesMethod::condensed:
            return models::Condensed::name;
        case ModesMethod::aberth:
            return models::Aberth::name;
        case ModesMethod::interpolated:
            return models::Interpolated::name;
        default:
            return models::Bisection::name;
    }
}

/// Returns heights by the cheapest method or the requested one; by bisection if that has no answer.
template <class... Models>
models::Solution solved(const Chain<double>& chain, LazyCounter<double>& assembled,
                        const ModeRange& range, const ModesOptions<double>& options,
                        const std::tuple<Models...>& methods) {
    const models::Question question =
        question_of(range, options.rtol, options.progress, &assembled);
    if (options.method == ModesMethod::automatic) return solve(methods, chain, question);
    models::Solution found = models::solve_by(methods, name_of(options.method), chain, question);
    if (found.answer.found) return found;
    return models::solve_by(methods, models::Bisection::name, chain, question);
}

/// Returns heights in the units of the chain's pencils, as `ShapeFinder` takes them.
REVCHAIN_LAZY
std::vector<Height<double>> heights_in_units(const Chain<double>& chain,
                                             const models::Answer& answer) {
    const int exponent = -chain.units().length_exponent;
    std::vector<Height<double>> heights;
    heights.reserve(static_cast<std::size_t>(answer.conical_height.size()));
    for (Index j = 0; j < answer.conical_height.size(); ++j) {
        const Wide<double> height =
            answer.unrounded.empty() ? Wide<double>(std::ldexp(answer.conical_height[j], exponent))
                                     : answer.unrounded[static_cast<std::size_t>(j)];
        heights.push_back({static_cast<double>(height), answer.error_bound[j], height});
    }
    return heights;
}

template <class Model, class Methods>
inline constexpr bool is_among = false;
template <class Model, class... Models>
inline constexpr bool is_among<Model, std::tuple<Models...>> = (std::same_as<Model, Models> || ...);

/// Computes modes of a chain of doubles by any of the methods.
template <class Methods>
Modes<double> modes_by(const Methods& methods, const Chain<double>& chain,
                       const ModesOptions<double>& options) {
    LazyCounter<double> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    Modes<double> result = room_for_modes<double>(range);
    models::Solution found{{}, models::Bisection::name, Status::success};
    if (range.count > 0) found = solved(chain, assembled, range, options, methods);
    result.method = found.model;
    for (Index j = 0; j < range.count; ++j)
        set_height(result, j, found.answer.conical_height[j], found.answer.error_bound[j], 0,
                   options.rtol);
    if (range.count > 0 && options.certify)
        certify(result, assembled.pencils(), chain.mode_count());
    const bool loose = is_loose(chain, HeightsOptions<double>{options.rtol});
    auto find = [finder = ShapeFinder<double>{chain, heights_in_units(chain, found.answer), loose,
                                              assembled.kept_pencils()},
                 condense = options.method != ModesMethod::bisection,
                 first = range.first](Index from, Index count, bool details, Progress* progress) {
        if constexpr (is_among<models::Condensed, Methods>)
            if (const auto begin = finder.height.begin() + from; condense && count > 0)
                if (auto shapes = condensed_shapes(finder.chain, first + from,
                                                   Heights<double>(begin, begin + count), progress))
                    return std::move(*shapes);
        return finder(from, count, details, progress);
    };
    ShapesBehind::of(result) = shapes_when_read<double>(std::move(find), options.threads);
    if (range.count > 0) advance(options.progress, 1.0);
    return result;
}

}  // namespace detail

template <Real T, class... Models>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options,
               const std::tuple<Models...>& methods) {
    const auto in_double = [&](const Chain<double>& wide, const ModesOptions<double>& asked) {
        return detail::modes_by(detail::with_bisection(methods), wide, asked);
    };
    return detail::modes_through(in_double, chain, options);
}

}  // namespace revchain
