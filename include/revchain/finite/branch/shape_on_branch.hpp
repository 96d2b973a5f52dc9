// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>

#include "revchain/finite/branch/crossing.hpp"
#include "revchain/finite/branch/onset.hpp"
#include "revchain/finite/branch/trace.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Searches a branch for states with a wanted number.
template <class Found, class Measure>
class BranchSearch {
   public:
    using End = decltype(Found::end);
    using S = Fine;
    BranchSearch(BranchRoot& root, const Measure& measure, const Condition& condition,
                 double amplitude)
        : root_(root), measure_(measure), condition_(condition), amplitude_(amplitude) {}

    /// Searches down to a log of conical height, for at most `max_shapes` states.
    Found run(double log_end, std::size_t max_shapes, double log_wanted) {
        Found result;
        result.searched_to = root_.height;
        result.from_rest = !root_.onset;
        if (result.from_rest)
            return run_from_rest(std::move(result), log_end, max_shapes, log_wanted);
        const BranchOnset& onset = *root_.onset;
        constexpr double small = 0.02;
        double from = 0.1;
        const bool beside = amplitude_ > 0 || !onset.rises();  // where the branch begins
        if (beside && amplitude_ * onset.steepest < small) {   // the law has errors of 1e-3
            const BranchState near = onset.state(root_.corrector.links(), amplitude_);
            if (auto shape = close(near, amplitude_ * onset.steepest)) {
                result.shapes.push_back(std::move(*shape));
                result.searched_to = result.shapes.back().conical_height;
                if (result.shapes.size() >= max_shapes) return result;
            }
            // start past the state, or, for a number that grows, where double resolves the branch
            from = result.shapes.empty() ? 0.1 * amplitude_ * onset.steepest
                                         : std::max(1e-5, 4 * amplitude_ * onset.steepest);
        } else if (beside) {
            from = std::min(from, 0.25 * amplitude_ * onset.steepest);
        }
        // start closer to the vertical if no step is accepted before a state is found: see `branch`
        for (;; from /= 16) {
            const auto start = onset.start(root_.corrector, from);
            if (!start) {
                result.end = End::stuck;
                return result;
            }
            Found walked = walked_from(*start, start->arc, result, log_end, max_shapes);
            if (walked.end != End::stuck || walked.shapes.size() > result.shapes.size() ||
                !(from > 1e-6))
                return walked;
        }
    }

   private:
    static constexpr int max_steps = 100'000;
    static constexpr double slow = 18.4;  ///< log height above the mode's: 1e-4 of its speed

    /// Starts from a state slower than the wanted one.
    Found run_from_rest(Found result, double log_end, std::size_t max_shapes, double log_wanted) {
        const double top =
            std::log(std::ldexp(root_.height, -root_.system->units.length_exponent)) + slow;
        const auto start = root_.at_rest(std::max(top, log_wanted + 1));
        if (start) return walked_from(*start, 0.5, std::move(result), log_end, max_shapes);
        result.end = End::stuck;
        return result;
    }

    Found walked_from(const BranchPoint& start, double first_step, Found result, double log_end,
                      std::size_t max_shapes) {
        BranchWalk walk(root_.corrector, start, first_step);
        const HeightMeasure to_end{log_end};
        for (int step = 0; step < max_steps; ++step) {
            if (!walk.advance()) return stopped(result, walk, End::stuck);
            if (walk.here().state.log_height > start.state.log_height + 2 * slow)
                return stopped(result, walk, End::slow);
            if (is_loose(root_.corrector.links(), walk.here().state))
                return stopped(result, walk, End::loose);
            const auto last = crossings_of(walk, to_end);
            for (const WithinStep& each : crossings_of(walk, measure_)) {
                if (!last.empty() && each.share > last.front().share + 1e-9) break;
                const double reach = walk.here().arc - walk.before().arc;
                if (auto shape = close(each.point.state, std::min(0.1, reach))) {
                    result.shapes.push_back(std::move(*shape));
                    if (result.shapes.size() >= max_shapes)
                        return stopped(result, walk, End::height);
                }
            }
            if (!last.empty()) return stopped(result, walk, End::height);
        }
        return stopped(result, walk, End::budget);
    }

    Found stopped(Found& result, const BranchWalk& walk, End end) const {
        result.end = end;
        const double height = std::exp(walk.here().state.log_height);
        result.searched_to = std::ldexp(height, root_.system->units.length_exponent);
        return std::move(result);
    }
    /// Returns the state that satisfies the condition; none if a link differs by more than 0.3
    /// `farthest` (rad) from `near`.
    std::optional<SteadyShape> close(const BranchState& near, double farthest) const {
        const auto& links = root_.corrector.links();
        auto shape = shape_at(*root_.system, near, condition_);
        // near the vertical the height is rounded to that of the mode, which is itself rounded
        if (!shape) return shape;
        const bool in_reach = shape->conical_height <= root_.height * (1 + 0x1p-50);
        if (links.plain && !in_reach) return std::nullopt;
        const bool kept = root_.corrector.half_waves_are_kept();
        if (kept && shape->half_waves != root_.onset->half_waves) return std::nullopt;
        double same = 0, opposite = 0;  // a symmetric shape has its free end at a positive offset
        for (std::size_t m = 0; m < links.bodies(); ++m) {
            const auto i = static_cast<Index>(m);
            const bool stands = root_.system->stands(m);
            const double inclination = shape->inclination[i],
                         there = std::atan(std::sinh(near.tau[m])),
                         here =
                             stands ? -std::remainder(inclination, std::numbers::pi) : inclination;
            same = std::max(same, std::abs(here - there));
            opposite = std::max(opposite, std::abs(here + there));
        }
        const double off = links.is_symmetric() ? std::min(same, opposite) : same;
        if (!(off <= 0.3 * farthest)) return std::nullopt;
        return shape;
    }

    BranchRoot& root_;
    const Measure& measure_;
    const Condition& condition_;
    double amplitude_;
};

/// Returns the amplitude, to leading order, at which a number proportional to it is `wanted`.
template <class Measure>
double amplitude_of(const BranchRoot& root, Measure measure, double wanted) {
    if (!root.onset) return 0;
    const double small = 1e-4 / root.onset->steepest;
    const BranchState state = root.onset->state(root.corrector.links(), small);
    return small * wanted / std::abs(measure({state, state}).value + wanted);
}

/// Returns the largest possible distance of the free end from the axis.
REVCHAIN_LAZY
double reach_of(const Chain<double>& chain) { return chain.total_length(); }
REVCHAIN_LAZY
double reach_of(const Rig& rig) {
    return rig.support().is_firm() ? rig.support().radius + rig.chain().total_length()
                                   : std::numeric_limits<double>::infinity();
}

template <class Options>
Fine height_given(std::string_view place, const Options& given) {
    using detail::require_positive;
    if (given.conical_height) {
        require_positive(place, "conical height", *given.conical_height);
        return Fine(*given.conical_height);
    }
    require_positive(place, "angular speed", *given.angular_speed);
    require_positive(place, "gravity", given.gravity);
    const Fine height = height_at_speed(*given.angular_speed, given.gravity);
    require_positive(place, "gravity / angular speed^2", as_double(height));
    return height;
}

/// Returns the states on a branch with a given number other than the height.
template <class Search, class System, class Options>
auto search_by_number(std::string_view place, const System& system, const BranchRoot& root,
                      const Options& given, const Search& search) {
    using detail::require_positive, detail::throw_invalid;
    const ChainUnits& units = root.system->units;
    const double unit = std::ldexp(1.0, -units.length_exponent);
    const auto* links = &root.corrector.links();
    if (given.tip_inclination) {
        const bool stands = root.system->stands(0);
        const double angle =
            stands ? std::numbers::pi - *given.tip_inclination : *given.tip_inclination;
        if (!(angle > 0 && angle < 1.5707963267948966))
            throw_invalid(
                place,
                stands
                    ? "tip inclination must lie between pi/2 and pi, since the lowest link stands"
                    : "tip inclination must lie between 0 and pi/2",
                *given.tip_inclination);
        const double tau = std::asinh(std::tan(angle));
        const TipInclinationMeasure measure{tau, links->is_symmetric()};
        return search(measure, GivenTipInclination(angle), amplitude_of(root, measure, tau));
    }
    if (given.tip_radius) {
        require_positive(place, "tip radius", *given.tip_radius);
        if (!(*given.tip_radius < reach_of(system)))
            throw_invalid(
                place,
                root.system->rig
                    ? "tip radius must be less than the radius of the support and the length"
                    : "tip radius must be less than the length of the chain",
                *given.tip_radius);
        const TipRadiusMeasure measure{links, *given.tip_radius * unit};
        return search(measure, GivenTipRadius(Fine(*given.tip_radius * unit)),
                      amplitude_of(root, measure, measure.wanted));
    }
    using std::sqrt;
    const double tension = *given.top_tension;
    const Fine size = ldexp(Fine(tension), -units.weight_exponent), bearing = root.system->bearing;
    if (!(size > bearing && size > -bearing) || !std::isfinite(tension))
        throw_invalid(
            place,
            root.system->rig
                ? "top tension must be finite and more than the weight that the topmost pin bears"
                : "top tension must be finite and more than the weight of the chain",
            tension);
    const Fine pull = sqrt((size - bearing) * (size + bearing));
    const double narrow = as_double(pull);
    const TopPullMeasure measure{links, narrow};
    const double share = std::pow(as_double(size) / narrow, 2);
    return search(measure, GivenTopTension(pull, share), amplitude_of(root, measure, narrow));
}

/// Returns the states on a branch with the given number.
template <class Found, class System, class Options>
Found search_branch(const System& system, const Options& given, std::size_t max_shapes) {
    using detail::in_digits, detail::require_positive, detail::throw_invalid;
    constexpr std::string_view place = "steady_shape";
    const int count = given.conical_height.has_value() + given.angular_speed.has_value() +
                      given.tip_inclination.has_value() + given.tip_radius.has_value() +
                      given.top_tension.has_value();
    if (count != 1)
        throw_invalid(place,
                      "give exactly one of conical height, angular speed, tip inclination, tip "
                      "radius and top tension; given were",
                      count);
    if (given.min_conical_height)
        require_positive(place, "min_conical_height", *given.min_conical_height);
    BranchRoot root = BranchRoot::of(place, system, given);
    const bool falls = root.onset && !root.onset->rises();
    if (falls && given.min_conical_height && !(*given.min_conical_height < root.height))
        throw_invalid(place,
                      "min_conical_height must be less than the conical height of the mode, " +
                          in_digits(root.height),
                      *given.min_conical_height);
    const double unit = std::ldexp(1.0, -root.system->units.length_exponent);
    const auto run = [&](const auto& measure, const auto& condition, double amplitude, double end,
                         double wanted) {
        using Search = BranchSearch<Found, std::decay_t<decltype(measure)>>;
        return Search(root, measure, condition, amplitude).run(end, max_shapes, wanted);
    };
    if (!given.conical_height && !given.angular_speed)
        return search_by_number(
            place, system, root, given,
            [&](const auto& measure, const auto& condition, double amplitude) {
                const double lowest = given.min_conical_height.value_or(1e-6 * root.height);
                return run(measure, condition, amplitude, std::log(lowest * unit), -1e300);
            });
    const Fine height = height_given(place, given);
    const double near = as_double(height);
    if (falls && !(near < root.height))
        detail::throw_too_slow(place, given.mode, root.height, near, given);
    const double wanted = std::log(near * unit);
    return run(HeightMeasure{wanted}, GivenHeight(height * Fine(unit)),
               root.onset ? amplitude_at(*root.system, *root.onset, height * Fine(unit)) : 0.0,
               std::min(wanted, std::log(given.min_conical_height.value_or(near / 2) * unit)),
               wanted);
}

}  // namespace revchain::finite
