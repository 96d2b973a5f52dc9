// SPDX-License-Identifier: MPL-2.0
// Defines what campbell.hpp declares.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "revchain/campbell.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/numeric/zero_between.hpp"
#include "revchain/questions/farthest_out.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Small motion about a shape: the frequencies over the speed, ascending.
struct SmallMotion {
    std::vector<double> ratio{};
    bool exists = false, stable = false;
};

template <class System>
SmallMotion small_motion(const System& system, const CampbellOptions& options, double speed) {
    check_interrupt();
    const SteadyShapes found =
        steady_shapes(system, {.angular_speed = speed, .gravity = options.gravity});
    const SteadyShape* chosen = farthest_out(found, options.half_waves);
    if (chosen == nullptr) return {};
    const Stability s = [&] {
        if constexpr (std::is_same_v<System, Rig>)
            return stability(system, *chosen, {.frame = options.frame, .gravity = options.gravity});
        else
            return stability(system, *chosen, options.frame);
    }();
    SmallMotion motion{{}, true, s.verdict != Verdict::unstable};
    for (std::size_t i = 0; i < s.exponents.size(); ++i)
        if (s.exponents[i].imag() > s.exponent_error[i])
            motion.ratio.push_back(s.exponents[i].imag());
    std::sort(motion.ratio.begin(), motion.ratio.end());
    return motion;
}

inline void check(const CampbellOptions& options) {
    constexpr std::string_view place = "campbell";
    const std::vector<double>& speeds = options.angular_speed;
    if (speeds.size() < 2)
        throw_invalid(place, "angular_speed must have at least two speeds", speeds.size());
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        require_positive(place, "angular_speed", speeds[i]);
        if (i > 0 && !(speeds[i] > speeds[i - 1]))
            throw_invalid(place, "angular_speed must be ascending", speeds[i]);
    }
    if (options.orders.empty()) throw_invalid(place, "orders must have at least one number");
    for (const Index order : options.orders)
        if (order < 1) throw_rule(place, "orders", "at least 1", order);
    if (options.half_waves < 1) throw_rule(place, "half_waves", "at least 1", options.half_waves);
    require_positive(place, "gravity", options.gravity);
}

template <class System>
Campbell campbell_of(const System& system, const CampbellOptions& options) {
    check(options);
    const std::vector<double>& speeds = options.angular_speed;
    std::vector<SmallMotion> motions;
    std::size_t width = 0;
    bool any = false;
    for (const double speed : speeds) {
        motions.push_back(small_motion(system, options, speed));
        width = std::max(width, motions.back().ratio.size());
        any = any || motions.back().exists;
    }
    if (!any)
        throw_invalid("campbell",
                      "at none of the speeds, " + in_digits(speeds.front()) + " to " +
                          in_digits(speeds.back()) +
                          " rad/s, is there a shape with this number of half_waves",
                      options.half_waves);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double continuous = 1e-6;  // at the zero; more where motions begin or end in a jump
    Campbell found{speeds, {}, {}, {}};
    found.frequency.setConstant(static_cast<Index>(speeds.size()), static_cast<Index>(width), nan);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        found.stable.push_back(motions[i].stable);
        for (std::size_t j = 0; j < motions[i].ratio.size(); ++j)
            found.frequency(static_cast<Index>(i), static_cast<Index>(j)) =
                motions[i].ratio[j] * speeds[i];
    }
    for (const Index order : options.orders)
        for (std::size_t i = 0; i + 1 < speeds.size(); ++i)
            for (std::size_t j = 0; j < width; ++j) {
                const auto multiple = static_cast<double>(order);
                const auto off = [&](const SmallMotion& motion) {
                    return j < motion.ratio.size() ? motion.ratio[j] - multiple : nan;
                };
                const double low = off(motions[i]), high = off(motions[i + 1]);
                if (std::isnan(low + high) || (low < 0) == (high < 0)) continue;
                double last = 0;
                const double zero = zero_between<double>(
                    {{speeds[i], low}, {speeds[i + 1], high}},
                    [&](double speed) { return last = off(small_motion(system, options, speed)); },
                    {.width = 1e-14 * speeds[i]});
                if (std::abs(last) <= continuous)
                    found.crossings.push_back({order, static_cast<Index>(j) + 1, zero});
            }
    return found;
}

}  // namespace detail

REVCHAIN_DEFINE
Campbell campbell(const Chain<double>& chain, const CampbellOptions& options) {
    return detail::campbell_of(chain, options);
}
REVCHAIN_DEFINE
Campbell campbell(const Rig& rig, const CampbellOptions& options) {
    return detail::campbell_of(rig, options);
}

}  // namespace revchain
