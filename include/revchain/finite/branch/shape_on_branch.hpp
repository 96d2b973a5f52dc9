// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/crossing.hpp"
#include "revchain/finite/branch/onset.hpp"
#include "revchain/finite/branch/shape_at.hpp"

namespace revchain::finite {

/// Looks along a branch for a number measured there.
template <class Found, class Measure>
class BranchSearch {
   public:
    using End = decltype(Found::end);
    using S = Wide<double>;
    BranchSearch(BranchRoot& root, const Measure& measure, const Condition<S>& condition, double amplitude)
        : root_(root), measure_(measure), condition_(condition), amplitude_(amplitude) {}

    /// Down to a log of conical height; the first state, or all.
    Found run(double log_end, bool all) {
        Found result;
        result.searched_to = root_.height;
        const BranchOnset& onset = root_.onset;
        constexpr double small = 0.02;
        double from = 0.1;
        if (amplitude_ * onset.steepest < small) {  // so near the vertical that the onset is known to 1e-3
            const BranchState near = onset.state(root_.corrector.links(), amplitude_);
            if (auto shape = close(near, amplitude_ * onset.steepest)) {
                result.shapes.push_back(std::move(*shape));
                result.searched_to = result.shapes.back().conical_height;
                if (!all) return result;
            }
            // past the state; farther out where double tells the branch from the vertical, what is wanted growing all
            // along
            from = result.shapes.empty() ? 0.1 * amplitude_ * onset.steepest
                                         : std::max(1e-5, 4 * amplitude_ * onset.steepest);
        } else {
            from = std::min(from, 0.25 * amplitude_ * onset.steepest);
        }
        // from nearer to the vertical where nothing is met before no step passes: see `branch`
        for (;; from /= 16) {
            const auto start = onset.start(root_.corrector, from);
            if (!start) {
                result.end = End::stuck;
                return result;
            }
            Found walked = walked_from(*start, result, log_end, all);
            if (walked.end != End::stuck || walked.shapes.size() > result.shapes.size() || !(from > 1e-6))
                return walked;
        }
    }

   private:
    static constexpr int max_steps = 100'000;

    Found walked_from(const BranchPoint& start, Found result, double log_end, bool all) {
        BranchWalk walk(root_.corrector, start, start.arc);
        const HeightMeasure to_end{log_end};
        for (int step = 0; step < max_steps; ++step) {
            if (!walk.advance()) return stopped(result, walk, End::stuck);
            const auto last = crossings_of(walk, to_end);
            for (const WithinStep& each : crossings_of(walk, measure_)) {
                if (!last.empty() && each.share > last.front().share + 1e-9) break;
                const double reach = walk.here().arc - walk.before().arc;
                if (auto shape = close(each.point.state, std::min(0.1, reach))) {
                    result.shapes.push_back(std::move(*shape));
                    if (!all) return stopped(result, walk, End::height);
                }
            }
            if (!last.empty()) return stopped(result, walk, End::height);
        }
        return stopped(result, walk, End::budget);
    }

    Found stopped(Found& result, const BranchWalk& walk, End end) const {
        result.end = end;
        result.searched_to = std::ldexp(std::exp(walk.here().state.log_height), root_.chain.units.length_exponent);
        return std::move(result);
    }
    /// The state of the condition next to one of the branch: no link farther from it than `farthest`, rad.
    std::optional<SteadyShape> close(const BranchState& near, double farthest) const {
        auto shape = shape_at(root_.chain, near, condition_);
        // next to the vertical the height is rounded to that of the mode, itself rounded
        if (!shape || !(shape->conical_height <= root_.height * (1 + 0x1p-50))) return std::nullopt;
        if (root_.corrector.half_waves_are_kept() && shape->half_waves != root_.onset.half_waves) return std::nullopt;
        double same = 0, mirrored = 0;  // the shape is given with its free end at a positive offset
        for (std::size_t m = 0; m < near.rise.size(); ++m) {
            const double here = shape->inclination[static_cast<Index>(m)], there = std::atan(std::sinh(near.rise[m]));
            same = std::max(same, std::abs(here - there)), mirrored = std::max(mirrored, std::abs(here + there));
        }
        if (!(std::min(same, mirrored) <= 0.3 * farthest)) return std::nullopt;
        return shape;
    }

    BranchRoot& root_;
    const Measure& measure_;
    const Condition<S>& condition_;
    double amplitude_;
};

/// The amplitude at which, to leading order, a number that grows with it in proportion is as wanted.
template <class Measure>
double amplitude_of(const BranchRoot& root, Measure measure, double wanted) {
    const double small = 1e-4 / root.onset.steepest;
    const BranchState state = root.onset.state(root.corrector.links(), small);
    return small * wanted / std::abs(measure({state, state}).value + wanted);
}

/// The first state on the branch at which the number given is met, or all states.
template <class Found, class Options>
Found search_branch(const Chain<double>& chain, const Options& given, bool all) {
    using revchain::detail::in_digits, revchain::detail::require_positive, revchain::detail::throw_invalid;
    constexpr std::string_view place = "steady_shape";
    const Index mode = given.mode;
    using S = Wide<double>;
    const int count = given.conical_height.has_value() + given.angular_speed.has_value() +
                      given.tip_inclination.has_value() + given.tip_radius.has_value() + given.top_tension.has_value();
    if (count != 1)
        throw_invalid(place,
                      "give exactly one of conical height, angular speed, tip inclination, tip radius and top "
                      "tension; given were",
                      count);
    if (given.min_conical_height) require_positive(place, "min_conical_height", *given.min_conical_height);
    BranchRoot root = BranchRoot::of(place, chain, mode);
    if (given.min_conical_height && !(*given.min_conical_height < root.height))
        throw_invalid(place,
                      "min_conical_height must be less than the conical height of the mode, " + in_digits(root.height),
                      *given.min_conical_height);
    const double unit = std::ldexp(1.0, -root.chain.units.length_exponent);
    const double lowest = given.min_conical_height.value_or(1e-6 * root.height) * unit;
    const auto* links = &root.corrector.links();
    const auto search = [&](const auto& measure, const auto& condition, double amplitude, double log_end) {
        using Search = BranchSearch<Found, std::decay_t<decltype(measure)>>;
        return Search(root, measure, condition, amplitude).run(log_end, all);
    };
    if (given.conical_height || given.angular_speed) {
        S height;
        if (given.conical_height) {
            require_positive(place, "conical height", *given.conical_height);
            height = S(*given.conical_height);
        } else {
            require_positive(place, "angular speed", *given.angular_speed);
            require_positive(place, "gravity", given.gravity);
            height = height_at_speed(*given.angular_speed, given.gravity);
            require_positive(place, "gravity / angular speed^2", static_cast<double>(height));
        }
        const double near = static_cast<double>(height);
        if (!(near < root.height))
            throw_invalid(place,
                          "mode " + std::to_string(mode) + " leaves the vertical at the conical height " +
                              in_digits(root.height) +
                              " and has no shape at one that is not less (it turns too slowly)",
                          near);
        const double log_wanted = std::log(near * unit);
        return search(HeightMeasure{log_wanted}, GivenHeight<S>(height * S(unit)),
                      amplitude_at(root.chain, root.onset, height * S(unit)),
                      std::min(log_wanted, std::log(given.min_conical_height.value_or(near / 2) * unit)));
    }
    const double log_end = std::log(lowest);
    if (given.tip_inclination) {
        if (!(*given.tip_inclination > 0 && *given.tip_inclination < 1.5707963267948966))
            throw_invalid(place, "tip inclination must lie between 0 and pi/2", *given.tip_inclination);
        const double rise = std::asinh(std::tan(*given.tip_inclination));
        const TipInclinationMeasure measure{rise};
        return search(measure, GivenTipInclination<S>(*given.tip_inclination), amplitude_of(root, measure, rise),
                      log_end);
    }
    if (given.tip_radius) {
        require_positive(place, "tip radius", *given.tip_radius);
        if (!(*given.tip_radius < chain.total_length()))
            throw_invalid(place, "tip radius must be less than the length of the chain", *given.tip_radius);
        const TipRadiusMeasure measure{links, *given.tip_radius * unit};
        return search(measure, GivenTipRadius<S>(S(*given.tip_radius * unit)),
                      amplitude_of(root, measure, measure.wanted), log_end);
    }
    const double tension = *given.top_tension;
    const S weight = chain.weight_below(chain.size());
    if (!(S(tension) > weight) || !std::isfinite(tension))
        throw_invalid(place, "top tension must be finite and more than the weight of the chain", tension);
    using std::sqrt;
    const S pull = ldexp(sqrt((S(tension) - weight) * (S(tension) + weight)), -root.chain.units.weight_exponent);
    const double narrow = static_cast<double>(pull);
    const TopPullMeasure measure{links, narrow};
    const double share = std::pow(std::ldexp(tension, -root.chain.units.weight_exponent) / narrow, 2);
    return search(measure, GivenTopTension<S>(pull, share), amplitude_of(root, measure, narrow), log_end);
}

}  // namespace revchain::finite
