// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/finite/branch/lowest_height.hpp"
#include "revchain/finite/shapes/described.hpp"
#include "revchain/held.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/held_tension.hpp"
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

inline void require_half_waves(int most) {
    if (most < 1) throw_invalid("steady_shapes", "max_half_waves must be at least 1", most);
}

/// The conical height of the speed asked for; 0 without gravity.
template <class Options>
Wide<double> height_asked(const HeldBy& by, const Options& options) {
    constexpr std::string_view place = "steady_shapes";
    if (options.angular_speed) require_positive(place, "angular speed", *options.angular_speed);
    if (by.weightless) {
        if (options.conical_height)
            throw_invalid(place, "without gravity there is no conical height; give angular_speed instead of it",
                          *options.conical_height);
        if (by.tension && !options.angular_speed)
            throw_invalid(place, "without gravity the shape under a tension depends on the speed; give angular_speed");
        return Wide<double>(0);
    }
    require_one_speed(place, options);
    if (options.conical_height) {
        require_positive(place, "conical height", *options.conical_height);
        return Wide<double>(*options.conical_height);
    }
    if (options.gravity == 0)
        throw_invalid(place, "gravity must be positive; for none, hold the system with weightless = true");
    require_positive(place, "gravity", options.gravity);
    const Wide<double> height = finite::height_at_speed(*options.angular_speed, options.gravity);
    require_positive(place, "gravity / angular_speed^2", static_cast<double>(height));
    return height;
}

/// The conical height times the tension at the upper end; without gravity, tension over speed squared.
inline Wide<double> height_times_tension(const HeldBy& by, const Wide<double>& height,
                                         const std::optional<double>& angular_speed) {
    const Wide<double> tension = by.tension.value(), speed(angular_speed.value_or(1));
    const Wide<double> product = by.weightless ? tension / speed / speed : height * tension;
    require_positive("steady_shapes", "conical height times tension", product.high);
    return product;
}

/// What holds the ends at a speed; without gravity stiffnesses are divided by the square of the speed.
inline finite::HeldSupports supports_at(const HeldBy& by, const Wide<double>& height,
                                        const std::optional<double>& angular_speed) {
    if (!by.weightless || by.firm()) return {by.lower, by.upper, height};
    if (!angular_speed)
        throw_invalid("steady_shapes",
                      "without gravity shapes between springs depend on the speed; give angular_speed");
    const Wide<double> speed(*angular_speed), unit(1.0);
    return {by.lower, by.upper, Wide<double>(unit / (speed * speed))};
}

/// The straight chain under the tension at its lower end.
inline finite::TautChain taut_chain(std::string_view place, const Held<Chain<double>>& held, double gravity) {
    HeldBy by = held.by();
    const Wide<double> lower = lower_tension(place, held, gravity);
    if (by.weightless)  // in masses times gravity
        for (Support* end : {&by.lower, &by.upper})
            if (!end->is_firm()) end->stiffness = end->stiffness / Wide<double>(gravity);
    return {held.system(), lower, by.weightless, {by.lower, by.upper, {}}};
}

/// The span of what is held, of whose shapes at every speed a question is.
inline double span_asked(std::string_view place, const HeldBy& by) {
    if (!by.span)
        throw_invalid(place, "is for what is held at a span; under a tension use steady_shapes at each speed, or modes",
                      by.tension->high);
    if (by.weightless)
        throw_invalid(place, "without gravity (where firm ends make shapes the same at every speed) use steady_shapes");
    return *by.span;
}

/// `at_height(span, height)` and `of_tension(span, tension)` look for the shape that is asked for.
template <class AtHeight, class OfTension>
auto held_shape(const HeldBy& by, const HeldOnBranchOptions& options, const AtHeight& at_height,
                const OfTension& of_tension) {
    constexpr std::string_view place = "steady_shape";
    const double span = span_asked(place, by);
    if (options.mode < 1) throw_invalid(place, "mode must be at least 1", options.mode);
    const int given =
        options.conical_height.has_value() + options.angular_speed.has_value() + options.top_tension.has_value();
    if (given != 1) throw_invalid(place, "give exactly one of conical_height, angular_speed and top_tension");
    if (options.top_tension) {
        require_positive(place, "top_tension", *options.top_tension);
        if (auto shape = of_tension(span, *options.top_tension)) return *shape;
        throw_invalid(place, "no shape of the branch has this tension at its upper end", *options.top_tension);
    }
    const Wide<double> height = height_asked(by, options);
    if (auto shape = at_height(span, height)) return *shape;
    throw_invalid(place, "the branch does not reach this conical height; branches says how far it goes",
                  static_cast<double>(height));
}

}  // namespace detail

REVCHAIN_INLINE HeldShapes steady_shapes(const Held<Chain<double>>& held, const HeldShapesOptions& options) {
    detail::require_half_waves(options.max_half_waves);
    const Wide<double> height = detail::height_asked(held.by(), options);
    const finite::HeldListOptions wanted{options.max_half_waves, options.prove, options.budget};
    const finite::HeldSupports supports = detail::supports_at(held.by(), height, options.angular_speed);
    if (held.by().span) return finite::held_shapes(held.system(), supports, *held.by().span, height, wanted);
    const Wide<double> tension = detail::height_times_tension(held.by(), height, options.angular_speed);
    return finite::held_shapes_under_tension(held.system(), supports, tension, height, wanted);
}

REVCHAIN_INLINE HeldCordShapes steady_shapes(const Held<Cord>& held,
                                             const HeldCordShapesOptions& options) {
    detail::require_half_waves(options.max_half_waves);
    const Wide<double> height = detail::height_asked(held.by(), options);
    const int most = options.max_half_waves;
    if (held.by().span) return finite::held_cord_shapes(held.system(), *held.by().span, height.high, most);
    const Wide<double> tension = detail::height_times_tension(held.by(), height, options.angular_speed);
    return finite::held_cord_shapes_under_tension(held.system(), tension.high, height.high, most);
}

REVCHAIN_INLINE std::vector<HeldBranch> branches(const Held<Chain<double>>& held,
                                                 const HeldDiagramOptions& options) {
    constexpr std::string_view place = "branches";
    const double span = detail::span_asked(place, held.by());
    detail::require_positive(place, "max_step", options.max_step);
    const double least = finite::lowest_height(place, options);
    const finite::HeldSupports supports{held.by().lower, held.by().upper, {}};
    std::vector<HeldBranch> result;
    std::vector<HeldShape> last;  // a branch that comes back ends where another would begin
    const int most = (held.by().on_axis() ? 1 : 2) * static_cast<int>(held.system().size() - 1);
    const int gap = supports.plain() ? 1 : 4;  // arms and springs may end a branch and not the next
    for (int mode = 1, without = 0; mode <= most && without < gap; ++mode) {
        auto branch = finite::held_branch(held.system(), supports, span, least, mode, options.max_step);
        if (!branch) {
            ++without;
            continue;
        }
        without = 0;
        if (branch->shapes.empty() || finite::has(last, branch->shapes.front())) continue;
        if (branch->end == HeldBranchEnd::speed) last.push_back(branch->shapes.back());
        result.push_back(std::move(*branch));
    }
    return result;
}

REVCHAIN_INLINE std::vector<HeldCordBranch> branches(const Held<Cord>& held,
                                                     const HeldDiagramOptions& options) {
    constexpr std::string_view place = "branches";
    const double span = detail::span_asked(place, held.by());
    detail::require_positive(place, "max_step", options.max_step);
    const double least = finite::lowest_height(place, options);
    std::vector<HeldCordBranch> result;
    for (int k = 1; k <= 1000; ++k) {
        auto branch = finite::held_branch(held.system(), span, least, k, options.max_step);
        if (!branch) break;
        result.push_back(std::move(*branch));
    }
    return result;
}

REVCHAIN_INLINE HeldShape steady_shape(const Held<Chain<double>>& held,
                                       const HeldOnBranchOptions& options) {
    const HeldBy& by = held.by();
    const auto at_height = [&](double span, const Wide<double>& height) -> std::optional<HeldShape> {
        finite::HeldChain chain(held.system(), {by.lower, by.upper, height});
        const finite::HeldStart start = finite::HeldStart::of_mode(options.mode, chain.mirrored());
        const int exponent = chain.links().units.length_exponent;
        const Wide<double> apart(std::ldexp(span, -exponent)), lambda = ldexp(height, -exponent);
        const auto state = chain.at_height(start.half_waves, apart, static_cast<double>(lambda), start.outwards);
        if (!state) return {};
        return chain.finished(*state, apart, lambda, true);
    };
    return detail::held_shape(by, options, at_height, [&](double span, double tension) {
        if (!by.firm())
            detail::throw_invalid("steady_shape",
                                  "the speed of a tension between springs is not available: a spring gives way without "
                                  "end as the speed grows; give angular_speed, or read it from branches; top_tension",
                                  tension);
        return finite::held_shape_of_tension(held.system(), {by.lower, by.upper, {}}, span, tension, options.mode);
    });
}

REVCHAIN_INLINE HeldCordShape steady_shape(const Held<Cord>& held,
                                           const HeldOnBranchOptions& options) {
    const auto at_height = [&](double span, const Wide<double>& height) {
        return finite::held_cord_shape(held.system(), span, static_cast<double>(height), options.mode);
    };
    return detail::held_shape(held.by(), options, at_height, [&](double span, double tension) {
        return finite::held_shape_of_tension(held.system(), span, tension, options.mode);
    });
}

REVCHAIN_INLINE Modes<double> modes(const Held<Chain<double>>& held,
                                    const StraightModesOptions& options) {
    detail::check(options);
    const finite::TautChain taut = detail::taut_chain("modes", held, options.gravity);
    const auto within = [&](const HeightWindow<double>& window) {
        return detail::modes_within(window, taut.mode_count(), [&](double height) { return taut.above(height); });
    };
    const ModeRange range = detail::chosen(taut.mode_count(), options, within, [&](const SpeedWindow<double>& window) {
        return within(detail::window_of_heights(window, options.gravity));
    });
    Modes<double> result = detail::room_for_modes<double>(range);
    result.method = "bisection";
    for (Index j = 0; j < range.count; ++j) {
        const double estimate = epsilon<double>();  // of the error: rounding in the counts is not bounded
        detail::set_height(result, j, taut.height(range.first - 1 + j), estimate, 0, options.rtol);
        detail::advance(options.progress, static_cast<double>(j + 1) / static_cast<double>(range.count));
    }
    detail::ShapesBehind::of(result) =
        detail::LazyModeShapes<double>([taut, pins = held.system().size() + 1, heights = result.conical_height](
                                           Index first, Index count, bool, Progress* progress) {
            detail::ModeShapes<double> shapes{Table<double>(count, pins), Vector<double>(count), {}};
            for (Index j = 0; j < count; ++j) {
                const double height = heights[first + j];
                const Vector<double> offset = taut.shape(height);
                shapes.offset.row(j) = offset.transpose();
                shapes.residual[j] = taut.residual(height, offset);
                shapes.nodes.push_back(taut.nodes(offset));
                detail::advance(progress, 1.0);  // may be cancelled
            }
            return shapes;
        });
    return result;
}

REVCHAIN_INLINE Index count_modes(const Held<Chain<double>>& held, const CountOptions<double>& options) {
    return detail::taut_chain("count_modes", held, options.gravity).above(detail::height_given("count_modes", options));
}

}  // namespace revchain
