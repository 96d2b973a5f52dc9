// SPDX-License-Identifier: MPL-2.0
// The lists of steady shapes of chains and rigs at a speed or height.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "revchain/finite/shapes/list.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/finite/shapes/tangent_limit.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

template <class Means>
SteadyShapes steady_shapes(const Chain<double>& chain, const Fine& height,
                           const SteadyShapesOptions& options, Means) {
    const auto links = links_of(chain);
    return listed<SteadyShapes, Means>(links, ldexp(height, -links.units.length_exponent), options);
}

REVCHAIN_LAZY
SteadyShape mirror_image(SteadyShape shape) {
    const auto turn = [](Vector<double>& x) {
        for (double& value : x) value = value == std::numbers::pi ? value : 0 - value;
    };
    turn(shape.inclination), turn(shape.reaction_inclination);
    shape.offset = -shape.offset;
    return shape;
}

/// Returns true if two shapes, each unique within its error bound, are the same.
REVCHAIN_LAZY
bool same(const SteadyShape& x, const SteadyShape& y) {
    const double off = x.error_bound + y.error_bound;
    if (!(off < 1e-12)) return false;
    for (Index m = 0; m < x.inclination.size(); ++m) {
        const double apart = x.inclination[m] - y.inclination[m];
        if (!(std::abs(std::remainder(apart, 2 * std::numbers::pi)) <= off)) return false;
    }
    return true;
}

/// Returns all shapes of a rig; off the axis, for both signs of the lowest link's tangent.
template <class Means>
SteadyShapes steady_shapes(const Rig& rig, const Fine& height, const Fine& speed,
                           const RigShapesOptions& options, Means means) {
    if (rig == Rig(rig.chain(), {})) {
        const SteadyShapesOptions plain{.budget = options.budget,
                                        .hanging_only = options.hanging_only};
        return steady_shapes(rig.chain(), height, plain, means);
    }
    const double scaled = std::ldexp(as_double(height), -rig.chain().units().length_exponent);
    SteadyShapes result;
    if (!(scaled > std::numeric_limits<double>::min() / epsilon<double>())) {  // tangents overflow
        const double end =
            options.hanging_only && !rig.stands(0) ? std::numbers::pi / 2 : std::numbers::pi;
        result.undecided = {{rig.support().radius > 0 ? -end : 0, end}};
        return result;
    }
    RiggedLinks links = rigged_links(rig, height, speed);
    const Fine lambda = ldexp(height, -links.units.length_exponent);
    const double last = tangent_limit(links.links_for_sweep<double>(), enclosed<double>(lambda),
                                      !options.hanging_only, enclosed<double>(links.support));
    result = listed<SteadyShapes, Means>(links, lambda, options);
    const bool unbounded =
        !links.support.firm &&
        remaining_stiffness(links.links_for_sweep<double>(), enclosed<double>(links.support))
            .may_vanish();
    const auto leave_beyond = [&](SteadyShapes& found) {
        if (!unbounded) return;
        const double beyond = std::atan(last);
        found.undecided.push_back(
            {beyond, options.hanging_only ? std::numbers::pi / 2 : std::numbers::pi - beyond});
        found.complete = false;
    };
    leave_beyond(result);
    if (links.support.is_symmetric()) return result;
    links.support.radius = -links.support.radius;
    RigShapesOptions rest = options;
    rest.budget -= result.cells * static_cast<long>(rig.size());
    auto other = listed<SteadyShapes, Means>(links, lambda, rest);
    leave_beyond(other);
    const std::size_t count = result.shapes.size();
    for (SteadyShape& shape : other.shapes) {
        shape = mirror_image(std::move(shape));
        // shapes with an almost vertical lowest link are found twice: boxes reach beyond tangent 0
        const auto end = result.shapes.begin() + static_cast<std::ptrdiff_t>(count);
        if (std::none_of(result.shapes.begin(), end,
                         [&](const SteadyShape& known) { return same(known, shape); }))
            result.shapes.push_back(std::move(shape));
    }
    for (const InclinationRange& range : other.undecided)
        result.undecided.push_back({-range.high, -range.low});
    result.cells += other.cells;
    const bool complete = result.complete && other.complete;
    conclude(result);
    result.complete = complete;
    return result;
}

/// Returns true if the speed is given as a conical height.
template <class Options>
bool height_is_given(const Options& options) {
    detail::require_one_speed("steady_shapes", options);
    if (options.conical_height)
        detail::require_positive("steady_shapes", "conical height", *options.conical_height);
    detail::require_positive("steady_shapes", "gravity", options.gravity);
    return options.conical_height.has_value();
}

template <class Means>
SteadyShapes shapes_by(const Chain<double>& chain, const SteadyShapesOptions& options,
                       Means means) {
    const detail::Threads threads("steady_shapes", options.threads);
    if (height_is_given(options))
        return steady_shapes(chain, Wide<double>(*options.conical_height), options, means);
    const double angular_speed = *options.angular_speed, gravity = options.gravity;
    detail::require_positive("steady_shapes", "angular speed", angular_speed);
    constexpr double least = std::numeric_limits<double>::min();
    const double near = gravity / angular_speed / angular_speed;
    if (near > std::numeric_limits<double>::max() / 4) {  // far above any critical height
        SteadyShapes none;
        none.complete = true;
        return none;
    }
    if (near < least / epsilon<double>())
        return steady_shapes(chain, Wide<double>(std::max(near, least)), options, means);
    return steady_shapes(chain, height_at_speed(angular_speed, gravity), options, means);
}

template <class Means>
SteadyShapes shapes_by(const Rig& rig, const RigShapesOptions& options, Means means) {
    const detail::Threads threads("steady_shapes", options.threads);
    if (height_is_given(options)) {
        const Wide<double> height(*options.conical_height),
            speed = sqrt(Wide<double>(options.gravity) / height);
        return steady_shapes(rig, height, options.direction == Rotation::forward ? speed : -speed,
                             options, means);
    }
    const double angular_speed = *options.angular_speed, size = std::abs(angular_speed);
    const Wide<double> height = height_at_speed(size, options.gravity);
    if (!(size > 0) || !std::isfinite(static_cast<double>(height)) || !std::isfinite(size))
        detail::throw_invalid(
            "steady_shapes",
            "angular speed must be finite and not 0, nor so small that g/n^2 overflows",
            angular_speed);
    return steady_shapes(rig, height, Wide<double>(angular_speed), options, means);
}

}  // namespace revchain::finite
