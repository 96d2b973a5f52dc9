// SPDX-License-Identifier: MPL-2.0
// Defines what held.hpp declares.
#pragma once

#include "revchain/finite/branch/lowest_height.hpp"
#include "revchain/finite/shapes/described.hpp"
#include "revchain/held.hpp"
#include "revchain/linear/rig_shape.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/held_tension.hpp"
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns the conical height of the requested speed; 0 without gravity.
template <class Options>
Wide<double> height_asked(const HeldBy& by, const Options& options) {
    constexpr std::string_view place = "steady_shapes";
    if constexpr (requires { options.max_half_waves; })
        if (options.max_half_waves < 1)
            throw_invalid(place, "max_half_waves must be at least 1", options.max_half_waves);
    if (options.angular_speed) require_positive(place, "angular speed", *options.angular_speed);
    if (by.weightless) {
        if (options.conical_height)
            throw_invalid(
                place,
                "without gravity there is no conical height; give angular_speed instead of it",
                *options.conical_height);
        if (by.tension && !options.angular_speed)
            throw_invalid(place,
                          "without gravity the shape under a tension depends on the speed; give "
                          "angular_speed");
        return Wide<double>(0);
    }
    require_one_speed(place, options);
    if (options.conical_height) {
        require_positive(place, "conical height", *options.conical_height);
        return Wide<double>(*options.conical_height);
    }
    if (options.gravity == 0)
        throw_invalid(place,
                      "gravity must be positive; for none, hold the system with weightless = true");
    require_positive(place, "gravity", options.gravity);
    const Wide<double> height = finite::height_at_speed(*options.angular_speed, options.gravity);
    require_positive(place, "gravity / angular_speed^2", static_cast<double>(height));
    return height;
}

/// Returns the conical height times the upper tension; without gravity, tension over speed squared.
REVCHAIN_LAZY
Wide<double> height_times_tension(const HeldBy& by, const Wide<double>& height,
                                  const std::optional<double>& angular_speed) {
    const Wide<double> tension = by.tension.value(), speed(angular_speed.value_or(1));
    const Wide<double> product = by.weightless ? tension / speed / speed : height * tension;
    require_positive("steady_shapes", "conical height times tension", product.high);
    return product;
}

/// Returns the supports at a speed. Without gravity, stiffnesses are divided by the square of the
/// speed.
REVCHAIN_LAZY
finite::HeldSupports supports_at(const HeldBy& by, const Wide<double>& height,
                                 const std::optional<double>& angular_speed) {
    if (!by.weightless || by.firm()) return {by.lower, by.upper, height};
    if (!angular_speed)
        throw_invalid(
            "steady_shapes",
            "without gravity shapes between springs depend on the speed; give angular_speed");
    const Wide<double> speed(*angular_speed), unit(1.0);
    return {by.lower, by.upper, Wide<double>(unit / (speed * speed))};
}

/// A straight chain under a tension, and the counts of its modes.
struct TautChain {
    RigPencil pencil;
    CountedSense heights;

    TautChain(std::string_view place, const Held<Chain<double>>& held, double gravity)
        : pencil(rig_pencil({held.system(), {.support = end(held.by(), held.by().upper, gravity)}},
                            conical_pendulum::standard_gravity, lower_end(place, held, gravity))),
          heights(counted_heights(pencil)) {}

    Index mode_count() const { return heights.available.count; }
    Index above(std::string_view place, const Wide<double>& height) const {
        return heights.above(scaled(height), place, height.high);
    }
    Wide<double> scaled(const Wide<double>& height) const {
        return ldexp(height, -pencil.units.length_exponent);
    }

   private:
    /// Without gravity, weights stand for masses: stiffnesses are divided by `gravity`, as tensions
    /// are.
    static Support end(const HeldBy& by, Support support, double gravity) {
        if (by.weightless && !support.is_firm())
            support.stiffness = support.stiffness / Wide<double>(gravity);
        return support;
    }
    static LowerEnd lower_end(std::string_view place, const Held<Chain<double>>& held,
                              double gravity) {
        const auto [tension, error] = lower_tension(place, held, gravity);
        return {end(held.by(), held.by().lower, gravity), tension, error, held.by().weightless};
    }
};

/// Returns the span, for questions about shapes at all speeds.
REVCHAIN_LAZY
double span_asked(std::string_view place, const HeldBy& by) {
    if (!by.span)
        throw_invalid(place,
                      "is for what is held at a span; under a tension use steady_shapes at each "
                      "speed, or modes",
                      by.tension->high);
    if (by.weightless)
        throw_invalid(place,
                      "without gravity (where firm ends make shapes the same at every speed) use "
                      "steady_shapes");
    return *by.span;
}

REVCHAIN_LAZY
std::pair<double, double> span_and_height(const HeldBy& by, const HeldDiagramOptions& options) {
    constexpr std::string_view place = "branches";
    const double span = span_asked(place, by);
    require_positive(place, "max_step", options.max_step);
    return {span, finite::lowest_height(place, options)};
}

/// `at_height(span, height)` and `of_tension(span, tension)` return the requested shape, if any.
template <class AtHeight, class OfTension>
auto held_shape(const HeldBy& by, const HeldOnBranchOptions& options, const AtHeight& at_height,
                const OfTension& of_tension) {
    constexpr std::string_view place = "steady_shape";
    const double span = span_asked(place, by);
    if (options.mode < 1) throw_invalid(place, "mode must be at least 1", options.mode);
    if (options.conical_height.has_value() + options.angular_speed.has_value() +
            options.top_tension.has_value() !=
        1)
        throw_invalid(place, "give exactly one of conical_height, angular_speed and top_tension");
    if (options.top_tension) {
        require_positive(place, "top_tension", *options.top_tension);
        if (auto shape = of_tension(span, *options.top_tension)) return *shape;
        throw_invalid(place, "no shape of the branch has this tension at its upper end",
                      *options.top_tension);
    }
    const Wide<double> height = height_asked(by, options);
    if (auto shape = at_height(span, height)) return *shape;
    throw_invalid(place,
                  "the branch has no shape at this conical height; steady_shapes lists all there",
                  static_cast<double>(height));
}

}  // namespace detail

REVCHAIN_DEFINE
HeldShapes steady_shapes(const Held<Chain<double>>& held, const HeldShapesOptions& options) {
    const HeldBy& by = held.by();
    const Wide<double> height = detail::height_asked(by, options);
    const finite::HeldListOptions wanted{options.max_half_waves, options.prove, options.budget};
    const finite::HeldSupports supports = detail::supports_at(by, height, options.angular_speed);
    if (by.span) return finite::held_shapes(held.system(), supports, *by.span, height, wanted);
    const auto tension = detail::height_times_tension(by, height, options.angular_speed);
    return finite::held_shapes_under_tension(held.system(), supports, tension, height, wanted);
}

REVCHAIN_DEFINE
HeldCordShapes steady_shapes(const Held<Cord>& held, const HeldCordShapesOptions& options) {
    const HeldBy& by = held.by();
    const double height = detail::height_asked(by, options).high;
    const int most = options.max_half_waves;
    if (by.span) return finite::held_cord_shapes(held.system(), *by.span, height, most);
    const double tension = detail::height_times_tension(by, height, options.angular_speed).high;
    return finite::held_cord_shapes_under_tension(held.system(), tension, height, most);
}

REVCHAIN_DEFINE
std::vector<HeldBranch> branches(const Held<Chain<double>>& held,
                                 const HeldDiagramOptions& options) {
    const auto [span, least] = detail::span_and_height(held.by(), options);
    const finite::HeldSupports supports{held.by().lower, held.by().upper, {}};
    std::vector<HeldBranch> result;
    // a branch that returns ends where another would begin; two ways may lead to one beginning
    std::vector<HeldShape> known;
    const int most = (held.by().on_axis() ? 1 : 2) * static_cast<int>(held.system().size() - 1);
    const int gap = supports.plain() ? 1 : 4;  // with arms or springs a branch may end although the
                                               // next exists
    for (int mode = 1, without = 0; mode <= most && without < gap; ++mode) {
        auto branch =
            finite::held_branch(held.system(), supports, span, least, mode, options.max_step);
        without = branch ? 0 : without + 1;
        if (!branch || branch->shapes.empty() || finite::has(known, branch->shapes.front()))
            continue;
        known.push_back(branch->shapes.front());
        if (branch->end == HeldBranchEnd::speed) known.push_back(branch->shapes.back());
        result.push_back(std::move(*branch));
    }
    return result;
}

REVCHAIN_DEFINE
std::vector<HeldCordBranch> branches(const Held<Cord>& held, const HeldDiagramOptions& options) {
    const auto [span, least] = detail::span_and_height(held.by(), options);
    std::vector<HeldCordBranch> result;
    for (int k = 1; k <= 1000; ++k) {
        auto branch = finite::held_branch(held.system(), span, least, k, options.max_step);
        if (!branch) break;
        result.push_back(std::move(*branch));
    }
    return result;
}

REVCHAIN_DEFINE
HeldShape steady_shape(const Held<Chain<double>>& held, const HeldOnBranchOptions& options) {
    const HeldBy& by = held.by();
    const auto at_height = [&](double span,
                               const Wide<double>& height) -> std::optional<HeldShape> {
        finite::HeldChain chain(held.system(), {by.lower, by.upper, height});
        const auto start = finite::HeldStart::of_mode(options.mode, chain.is_symmetric());
        const int exponent = chain.links().units.length_exponent;
        const Wide<double> apart(std::ldexp(span, -exponent)), lambda = ldexp(height, -exponent);
        const auto state = chain.at_height(start.half_waves, apart, lambda.high, start.outwards);
        if (!state) return {};
        return chain.finished(*state, apart, lambda, true);
    };
    return detail::held_shape(by, options, at_height, [&](double span, double tension) {
        if (!by.firm())
            detail::throw_invalid("steady_shape",
                                  "the speed of a tension between springs is not available: a "
                                  "spring gives way without end as the speed grows; give "
                                  "angular_speed, or read it from branches; top_tension",
                                  tension);
        return finite::held_shape_of_tension(held.system(), {by.lower, by.upper, {}}, span, tension,
                                             options.mode);
    });
}

REVCHAIN_DEFINE
HeldCordShape steady_shape(const Held<Cord>& held, const HeldOnBranchOptions& options) {
    const auto at_height = [&](double span, const Wide<double>& height) {
        return finite::held_cord_shape(held.system(), span, height.high, options.mode);
    };
    return detail::held_shape(held.by(), options, at_height, [&](double span, double tension) {
        return finite::held_shape_of_tension(held.system(), span, tension, options.mode);
    });
}

REVCHAIN_DEFINE
Modes<double> modes(const Held<Chain<double>>& held, const HeldModesOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "modes";
    check(options);
    const Threads used(place, options.threads);
    const TautChain taut(place, held, options.gravity);
    const CountedRoots& roots = taut.heights.roots;
    const Index available = taut.mode_count();
    const ModeRange range = chosen(
        available, options, [&](double height) { return taut.above(place, height); },
        [&](double speed) {
            return taut.above(place, finite::height_at_speed(speed, options.gravity));
        });
    Modes<double> result = room_for_modes<double>(range);
    result.method = "bisection";
    std::vector<RigWord> found;
    if (range.count > 0) {
        const double length = taut.scaled(held.system().total_length()).high;
        const auto finished = [&](Index done) {
            advance(options.progress, static_cast<double>(done) / static_cast<double>(range.count));
        };
        for (const auto& root :
             refined_roots(roots, range.first - 1, range.count, length, {}, finished)) {
            set_height(result, static_cast<Index>(found.size()), root.eigenvalue,
                       pencil::bound_of_margin<RigWord>(root.error_bound),
                       taut.pencil.units.length_exponent, options.rtol);
            found.push_back(root.unrounded);
        }
    }
    if (options.certify)
        certify(result, available, [&](double lower, double upper) {
            return std::array{roots.certified(taut.scaled(lower)),
                              roots.certified(taut.scaled(upper))};
        });
    ShapesBehind::of(result) = shapes_when_read<double>(
        RigShapeFinder<>{held.system(), taut.pencil.idle, roots.pencil(), std::move(found)},
        options.threads);
    return result;
}

REVCHAIN_DEFINE
Index count_modes(const Held<Chain<double>>& held, const CountOptions<double>& options) {
    constexpr std::string_view place = "count_modes";
    Wide<double> height = detail::height_given(place, options);
    if (options.angular_speed)
        height = finite::height_at_speed(*options.angular_speed, options.gravity);
    return detail::TautChain(place, held, options.gravity).above(place, height);
}

}  // namespace revchain
