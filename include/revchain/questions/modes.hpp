// SPDX-License-Identifier: MPL-2.0
// Defines what modes.hpp declares.
#pragma once

#include <concepts>

#include "revchain/linear/mode_shapes.hpp"
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

/// Stores height number `j`, given in units of 2^exponent. The bound is widened if the height
/// leaves the normal range of T and loses digits. If the bound exceeds the requested tolerance, the
/// status becomes `tolerance_not_met`.
template <Real T>
void set_height(Modes<T>& modes, Index j, const T& height, T bound, int exponent,
                const std::optional<T>& rtol) {
    using std::abs, std::ldexp;
    const T stored = ldexp(height, exponent);
    const T lost = abs(ldexp(stored, -exponent) - height);
    if (lost > T(0)) bound = bound + T(2) * (lost / height);
    if (lost > T(0) && !(stored > T(0))) bound = std::numeric_limits<T>::infinity();
    modes.conical_height[j] = stored;
    modes.error_bound[j] = bound;
    if (!(bound <= rtol.value_or(std::numeric_limits<T>::max())))
        modes.status = Status::tolerance_not_met;
}

template <Real T, Real P>
void certify(Modes<T>& modes, const Pencils<P>& pencils, Index mode_count) {
    certify(modes, mode_count, [&](const T& lower, const T& upper) {
        return pencils.template certified_count<2>(
            {pencils.scaled(Wide<P>(lower)), pencils.scaled(Wide<P>(upper))});
    });
}

/// Computes modes of a chain of floats in double, which suffices for a million links, and rounds
/// them. Rounding adds half an ulp of float to the bound. `in_double(wide, asked)` returns the
/// modes in double.
template <std::same_as<float> T, class InDouble>
Modes<T> modes_in_double(const Chain<T>& chain, const ModesOptions<T>& options,
                         const InDouble& in_double) {
    const double half_ulp = 0.50001 * static_cast<double>(epsilon<T>());
    const Chain<double> wide = converted<double>(chain);
    ModesOptions<double> asked{.first = options.first, .count = options.count};
    if (options.conical_height)
        asked.conical_height = {options.conical_height->low, options.conical_height->high};
    if (options.angular_speed)
        asked.angular_speed = {options.angular_speed->low, options.angular_speed->high};
    if (options.rtol && *options.rtol > 4 * half_ulp) asked.rtol = *options.rtol - half_ulp;
    asked.gravity = options.gravity, asked.method = options.method;
    asked.threads = options.threads, asked.progress = options.progress;
    const Modes<double> fine = in_double(wide, asked);

    constexpr T infinity = std::numeric_limits<T>::infinity();
    Modes<T> result = room_for_modes<T>(fine.range());
    result.method = fine.method;
    for (Index j = 0; j < fine.size(); ++j) {
        const double exact = fine.conical_height[j];
        const T height = static_cast<T>(exact);
        const double off = std::abs(static_cast<double>(height) - exact) / exact;
        double bound = (off + fine.error_bound[j] * (1 + off)) * (1 + 1e-15);
        if (!(height > 0 && std::isfinite(height))) bound = std::numeric_limits<double>::infinity();
        set_height(result, j, height, std::nextafter(static_cast<T>(bound), infinity), 0,
                   options.rtol);
    }
    if (fine.size() > 0 && options.certify)
        certify(result, Pencils<double>(wide), chain.mode_count());
    ShapesBehind::of(result) = LazyModeShapes<T>([wide, fine, heights = result.conical_height](
                                                     Index first, Index count, bool details,
                                                     Progress* progress) {
        const ModeShapes<double> found =
            ShapesBehind::of(fine).some(first, count, details, progress);
        ModeShapes<T> shapes{found.offset.template cast<T>(), Vector<T>(details ? count : 0), {}};
        if (count == 0 || !details) return shapes;
        const Pencils<double> own(wide);
        for (Index j = 0; j < count; ++j) {
            const Vector<double> offset = shapes.offset.row(j).transpose().template cast<double>();
            const double height = own.scaled(static_cast<double>(heights[first + j]));
            shapes.residual[j] =
                static_cast<T>(pencil::relative_residual(own.rounded(), height, offset));
            shapes.nodes.push_back(found.nodes[static_cast<std::size_t>(j)].template cast<T>());
        }
        return shapes;
    });
    return result;
}

/// Computes modes by bisection in the scalar T itself.
template <Real T>
Modes<T> modes_in_scalar(const Chain<T>& chain, const ModesOptions<T>& options) {
    LazyCounter<T> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    const HeightsOptions<T> stage{options.rtol, options.progress};
    Modes<T> result = room_for_modes<T>(range);
    result.method = "bisection";
    Heights<T> heights;
    if (range.count > 0) heights = heights_by_bisection(chain, assembled, range, stage);
    for (Index j = 0; j < range.count; ++j) {
        const Height<T>& height = heights[static_cast<std::size_t>(j)];
        set_height(result, j, height.eigenvalue, height.error_bound, chain.units().length_exponent,
                   options.rtol);
    }
    if (range.count > 0 && options.certify)
        certify(result, assembled.pencils(), chain.mode_count());
    ShapesBehind::of(result) = shapes_when_read<T>(
        ShapeFinder<T>{chain, std::move(heights), is_loose(chain, stage), assembled.kept_pencils()},
        options.threads);
    if (range.count > 0) advance(options.progress, 1.0);
    return result;
}

/// Computes modes of a chain of any scalar; for doubles and floats by `in_double(chain, options)`.
template <Real T, class InDouble>
Modes<T> modes_through(const InDouble& in_double, const Chain<T>& chain,
                       const ModesOptions<T>& options) {
    static_assert(
        !std::is_same_v<T, DoubleWord<double>> && !std::is_same_v<T, DoubleWord<long double>>,
        "a double word is the working arithmetic of a narrower scalar; as a scalar of its own take "
        "DoubleDouble");
    check(options);
    const Threads threads("modes", options.threads);
    if constexpr (std::is_same_v<T, double>)
        return in_double(chain, options);
    else if constexpr (std::is_same_v<T, float>)
        return modes_in_double(chain, options, in_double);
    else
        return modes_in_scalar(chain, options);
}

#if defined(REVCHAIN_COMPILED)
/// Computes modes by the cheapest method. The library contains it, so users need not compile the
/// methods.
Modes<double> modes_by_all_methods(const Chain<double>& chain, const ModesOptions<double>& options);
#endif

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
#if defined(REVCHAIN_COMPILED)
    return detail::modes_through(detail::modes_by_all_methods, chain, options);
#else
    if (options.method != ModesMethod::automatic && options.method != ModesMethod::bisection)
        detail::throw_invalid("modes",
                              "this method needs an include: write #include <revchain/methods.hpp> "
                              "and modes(chain, options, revchain::methods::all)");
    return detail::modes_through(detail::modes_in_scalar<double>, chain, options);
#endif
}

}  // namespace revchain
