// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>

#include "revchain/linear/mode_shapes.hpp"
#include "revchain/models/for_modes.hpp"
#include "revchain/modes.hpp"
#include "revchain/questions/mode_certificate.hpp"
#include "revchain/questions/mode_range.hpp"
#include "revchain/system/converted.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

template <Real T>
ModeRange chosen(const Chain<T>& chain, LazyCounter<T>& assembled, const ModesOptions<T>& options) {
    return chosen(
        chain.mode_count(), options,
        [&](const T& height) { return assembled.counter().above_height(height); },
        [&](const T& speed) { return assembled.counter().below_speed(speed, options.gravity); });
}

template <Real T>
Modes<T> room_for_modes(const ModeRange& range) {
    Modes<T> result;
    result.first = range.first;
    result.conical_height.resize(range.count);
    result.error_bound.resize(range.count);
    return result;
}

/// Stores height number `j`, given in units of 2^exponent. The bound takes up what is lost where the
/// height leaves the normal range of T. A bound beyond the tolerance asked is `tolerance_not_met`.
template <Real T>
void set_height(Modes<T>& modes, Index j, const T& height, T bound, int exponent, const std::optional<T>& rtol) {
    using std::abs, std::ldexp;
    const T stored = ldexp(height, exponent);
    const T lost = abs(ldexp(stored, -exponent) - height);
    if (lost > T(0)) bound = bound + T(2) * (lost / height);
    if (lost > T(0) && !(stored > T(0))) bound = std::numeric_limits<T>::infinity();
    modes.conical_height[j] = stored;
    modes.error_bound[j] = bound;
    if (!(bound <= rtol.value_or(std::numeric_limits<T>::max()))) modes.status = Status::tolerance_not_met;
}

template <Real T, Real P>
void certify(Modes<T>& modes, const Pencils<P>& pencils, Index mode_count) {
    certify(modes, mode_count, [&](const T& lower, const T& upper) {
        return pencils.template certified_count<2>({pencils.scaled(Wide<P>(lower)), pencils.scaled(Wide<P>(upper))});
    });
}

template <Real T>
LazyModeShapes<T> shapes_when_read(ShapeFinder<T> finder, Index threads) {
    return LazyModeShapes<T>([finder = std::move(finder), threads](Index first, Index count,
                                                                   bool details, Progress* progress) {
        const Threads used("modes", threads);
        return finder(first, count, details, progress);
    });
}

/// Heights by the cheapest model, or by the method asked for; by bisection where that has none.
/// A template, so that only a program that asks for modes compiles the models.
template <std::same_as<double> T>
models::Solution solved(const Chain<T>& chain, const ModeRange& range, const ModesOptions<T>& options) {
    const models::Question question = models::question_of(range, options.rtol, options.progress);
    if (options.method == ModesMethod::automatic) return solve(models::for_modes, chain, question);
    const models::ChainKind kind(chain);
    const auto by = [&](const auto& model) {
        auto answer = models::detail::answer_by(model, chain, kind, question);
        return models::Solution{std::move(answer), model.name, Status::success};
    };
    models::Solution found{models::Answer::none(), {}, Status::success};
    if (options.method == ModesMethod::aberth) found = by(models::Aberth{});
    if (options.method == ModesMethod::interpolated) found = by(models::Interpolated{});
    if (options.method == ModesMethod::condensed) found = by(models::Condensed{});
    return found.answer.found ? found : by(models::Bisection{});
}

/// A chain of floats: in double, where a million links lose nothing, and rounded, which adds half
/// an ulp of float to the bound. A template, so that a program without floats does not compile it.
template <std::same_as<float> T>
Modes<T> modes_in_double(const Chain<T>& chain, const ModesOptions<T>& options) {
    const double half_ulp = 0.50001 * static_cast<double>(epsilon<float>());
    const Chain<double> wide = converted<double>(chain);
    ModesOptions<double> asked{.first = options.first, .count = options.count};
    if (options.conical_height) asked.conical_height = {options.conical_height->low, options.conical_height->high};
    if (options.angular_speed) asked.angular_speed = {options.angular_speed->low, options.angular_speed->high};
    if (options.rtol && *options.rtol > 4 * half_ulp) asked.rtol = *options.rtol - half_ulp;
    asked.gravity = options.gravity, asked.method = options.method;
    asked.threads = options.threads, asked.progress = options.progress;
    const Modes<double> fine = modes(wide, asked);

    constexpr float infinity = std::numeric_limits<float>::infinity();
    Modes<float> result = room_for_modes<float>(fine.range());
    result.method = fine.method;
    for (Index j = 0; j < fine.size(); ++j) {
        const double exact = fine.conical_height[j];
        const float height = static_cast<float>(exact);
        const double off = std::abs(static_cast<double>(height) - exact) / exact;
        double bound = (off + fine.error_bound[j] * (1 + off)) * (1 + 1e-15);
        if (!(height > 0 && std::isfinite(height))) bound = std::numeric_limits<double>::infinity();
        set_height(result, j, height, std::nextafter(static_cast<float>(bound), infinity), 0, options.rtol);
    }
    if (fine.size() > 0 && options.certify) certify(result, Pencils<double>(wide), chain.mode_count());
    ShapesBehind::of(result) = LazyModeShapes<float>(
        [wide, fine, heights = result.conical_height](Index first, Index count, bool details, Progress* progress) {
            const ModeShapes<double> found = ShapesBehind::of(fine).some(first, count, details, progress);
            ModeShapes<float> shapes{found.offset.cast<float>(), Vector<float>(details ? count : 0), {}};
            if (count == 0 || !details) return shapes;
            const Pencils<double> own(wide);
            for (Index j = 0; j < count; ++j) {
                const Vector<double> offset = shapes.offset.row(j).transpose().cast<double>();
                const double height = own.scaled(static_cast<double>(heights[first + j]));
                shapes.residual[j] = static_cast<float>(pencil::relative_residual(own.rounded(), height, offset));
                shapes.nodes.push_back(found.nodes[static_cast<std::size_t>(j)].cast<float>());
            }
            return shapes;
        });
    return result;
}

/// In T itself: every method in double, bisection in other scalars.
template <Real T>
Modes<T> modes_in_scalar(const Chain<T>& chain, const ModesOptions<T>& options) {
    LazyCounter<T> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    const HeightsOptions<T> stage{options.rtol, options.progress};
    Modes<T> result = room_for_modes<T>(range);
    result.method = "bisection";
    const int unit = chain.units().length_exponent;
    Heights<T> heights;
    bool condense = false;
    if (range.count == 0) {  // nothing to find
    } else if constexpr (std::is_same_v<T, double>) {
        const models::Solution found = solved(chain, range, options);
        const models::Answer& answer = found.answer;
        for (Index j = 0; j < range.count; ++j) {
            const T given = answer.conical_height[j], bound = answer.error_bound[j];
            set_height(result, j, given, bound, 0, options.rtol);
            const Wide<T> height = answer.unrounded.empty() ? Wide<T>(std::ldexp(given, -unit))
                                                            : answer.unrounded[static_cast<std::size_t>(j)];
            heights.push_back({static_cast<T>(height), bound, height});
        }
        result.method = found.model, condense = options.method != ModesMethod::bisection;
    } else {
        heights = heights_by_bisection(chain, assembled, range, stage);
        for (Index j = 0; j < range.count; ++j) {
            const Height<T>& height = heights[static_cast<std::size_t>(j)];
            set_height(result, j, height.eigenvalue, height.error_bound, unit, options.rtol);
        }
    }
    if (range.count > 0 && options.certify) certify(result, assembled.pencils(), chain.mode_count());
    ShapesBehind::of(result) = shapes_when_read(
        ShapeFinder<T>(chain, range.first, std::move(heights), is_loose(chain, stage), condense),
        options.threads);
    if (range.count > 0) advance(options.progress, 1.0);
    return result;
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    static_assert(
        !std::is_same_v<T, DoubleWord<double>> && !std::is_same_v<T, DoubleWord<long double>>,
        "a double word is the working arithmetic of a narrower scalar; as a scalar of its own take DoubleDouble");
    detail::check(options);
    const detail::Threads threads("modes", options.threads);
    if constexpr (std::is_same_v<T, float>)
        return detail::modes_in_double(chain, options);
    else
        return detail::modes_in_scalar(chain, options);
}

}  // namespace revchain
