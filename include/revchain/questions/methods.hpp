// SPDX-License-Identifier: MPL-2.0
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

/// The methods given, and bisection, which always answers.
template <class... Models>
auto with_bisection(const std::tuple<Models...>& methods) {
    return std::tuple_cat(methods, std::tuple<models::Bisection>());
}

/// The question about a range of modes. Without a tolerance bounds have to be proved.
REVCHAIN_LAZY
models::Question question_of(const ModeRange& range, const std::optional<double>& tolerance,
                                    Progress* progress = nullptr) {
    const double rtol = tolerance.value_or(0.0);
    return {range.first, range.count, rtol, 0, progress, !(rtol > 0)};
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

/// Heights by the cheapest method, or by the one asked for; by bisection where that has none.
template <class... Models>
models::Solution solved(const Chain<double>& chain, const ModeRange& range, const ModesOptions<double>& options,
                        const std::tuple<Models...>& methods) {
    const models::Question question = question_of(range, options.rtol, options.progress);
    if (options.method == ModesMethod::automatic) return solve(methods, chain, question);
    models::Solution found = models::solve_by(methods, name_of(options.method), chain, question);
    if (found.answer.found) return found;
    return models::solve_by(methods, models::Bisection::name, chain, question);
}

/// Heights in the units of the chain's pencils, as `ShapeFinder` takes them.
REVCHAIN_LAZY
std::vector<Height<double>> heights_in_units(const Chain<double>& chain, const models::Answer& answer) {
    const int exponent = -chain.units().length_exponent;
    std::vector<Height<double>> heights;
    heights.reserve(static_cast<std::size_t>(answer.conical_height.size()));
    for (Index j = 0; j < answer.conical_height.size(); ++j) {
        const Wide<double> height = answer.unrounded.empty()
                                        ? Wide<double>(std::ldexp(answer.conical_height[j], exponent))
                                        : answer.unrounded[static_cast<std::size_t>(j)];
        heights.push_back({static_cast<double>(height), answer.error_bound[j], height});
    }
    return heights;
}

/// Shapes by the method for long chains, where it is among the methods and pays.
template <class... Models>
std::optional<ModeShapes<double>> shapes_of_long_chain(const std::tuple<Models...>&, const Chain<double>& chain,
                                                       Index first, const Heights<double>& heights,
                                                       Progress* progress) {
    if constexpr ((std::same_as<Models, models::Condensed> || ...))
        return condensed_shapes(chain, first, heights, progress);
    else
        return std::nullopt;
}

/// Modes of a chain of doubles by any of the methods.
template <class Methods>
Modes<double> modes_by(const Methods& methods, const Chain<double>& chain, const ModesOptions<double>& options) {
    LazyCounter<double> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    Modes<double> result = room_for_modes<double>(range);
    result.method = models::Bisection::name;
    if (range.count == 0) {
        ShapesBehind::of(result) = LazyModeShapes<double>(room_for_shapes(chain, 0));
        return result;
    }
    models::Solution found = solved(chain, range, options, methods);
    result.method = found.model;
    for (Index j = 0; j < range.count; ++j)
        set_height(result, j, found.answer.conical_height[j], found.answer.error_bound[j], 0, options.rtol);
    const bool loose = is_loose(chain, HeightsOptions<double>{options.rtol});
    ShapesBehind::of(result) =
        LazyModeShapes<double>([chain, first = range.first, answer = std::move(found.answer), loose, methods,
                                condense = options.method != ModesMethod::bisection,
                                threads = options.threads](Index from, Index count, bool details, Progress* progress) {
            const Threads used("modes", threads);
            const Heights<double> all = heights_in_units(chain, answer);
            const Heights<double> some(all.begin() + from, all.begin() + from + count);
            if (condense && count > 0)
                if (auto shapes = shapes_of_long_chain(methods, chain, first + from, some, progress)) return *shapes;
            return ShapeFinder<double>(chain, some, loose)(0, count, details, progress);
        });
    if (options.certify) certify(result, assembled.pencils(), chain.mode_count());
    advance(options.progress, 1.0);
    return result;
}

}  // namespace detail

template <Real T, class... Models>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options, const std::tuple<Models...>& methods) {
    const auto in_double = [all = detail::with_bisection(methods)](const Chain<double>& wide,
                                                                   const ModesOptions<double>& asked) {
        detail::check(asked);
        const detail::Threads threads("modes", asked.threads);
        return detail::modes_by(all, wide, asked);
    };
    if constexpr (std::is_same_v<T, double>) {
        return in_double(chain, options);
    } else if constexpr (std::is_same_v<T, float>) {
        detail::check(options);
        return detail::modes_in_double(chain, options, in_double);
    } else {
        return detail::modes_by_bisection(chain, options);
    }
}

}  // namespace revchain
