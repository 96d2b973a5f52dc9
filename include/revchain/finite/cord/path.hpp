// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>
#include <vector>

#include "revchain/finite/cord/path_series.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A path up from the free end at a given offset, with its crossings of the axis and their
/// derivatives by that offset. Between two crossings there is one turn (u = 0), and (eta, u) passes
/// the four quadrants in one order. The quadrants at the ends of a step therefore determine its
/// crossings if the step passes fewer than four. This holds if step times sqrt(largest T) < 3 pi/2
/// (Prüfer angle). Steps are shortened until it holds.
class Path {
   public:
    struct Step {
        PathState start;
        double duration;  ///< in the time of the series; sigma for a first `TipSeries`
    };
    struct Crossing {
        double arc, rate;  ///< rate: derivative of arc by the tip's offset
        double time;       ///< since the start of its step
    };
    static constexpr std::size_t max_steps = 50'000;

    struct Options {
        int crossings = std::numeric_limits<int>::max();
        double farthest = std::numeric_limits<double>::infinity();
        double tolerance = PathSeries::rounding;  ///< error bound of a step
        bool with_change = true;                  ///< compute derivatives by the free end's offset
    };

    /// Follows the path to crossing number `crossings` or the first step that ends beyond
    /// `farthest`. `visit(series, duration)` receives every step.
    template <class Visit>
    Path(const PathKind& kind, double tip_offset, const Options& options, Visit&& visit)
        : kind_(kind) {
        PathState state = kind.at_tip(tip_offset);
        PathChange change{0, 1, -kind.tip, 0};
        if (state.offset < 0 || (state.offset == 0 && state.pull < 0))
            crossings_.push_back({});  // the bob is across the axis
        if (kind.is_bare()) {
            const TipSeries series(tip_offset, kind.bend, options.tolerance);
            steps_.push_back({state, series.reach});
            visit(series, series.reach);
            state = series.state(series.reach), change = series.change(series.reach);
        } else if (kind.density != nullptr) {
            state = near_tip(kind, tip_offset, first_arc(kind));
            // without a tip weight the change is proportional, beyond the first 2^-40 of the length
            change = kind.tip > 0 ? change_near_tip(kind, tip_offset, state.arc)
                                  : PathChange{0, 1, state.pull / tip_offset, 0};
        }
        PathSeries series;
        while (!ended(options, state)) {
            detail::check_interrupt();
            series.start(kind, state, options.with_change ? &change : nullptr);
            double duration = within_piece(series, series.reach(options.tolerance));
            PathSeries::Reached next = series.reached(duration);
            int passed = 0;
            for (int cuts = 0; cuts < 200; ++cuts) {
                passed = quadrants(state, next.state);
                const bool told = next.max_phase < 1.5 * std::numbers::pi;
                if (told && crossings_in(state, passed) <= 1) break;
                duration *= 0.6;
                next = series.reached(duration);
            }
            if (crossings_in(state, passed) == 1)
                note_crossing(series, duration, options.with_change);
            steps_.push_back({state, duration});
            const bool all_crossed = static_cast<int>(crossings_.size()) >= options.crossings;
            visit(series, all_crossed ? crossings_.back().time : duration);
            const double particle = kind.particles_between(state.arc, next.state.arc),
                         below = kind.weight_below(next.state.arc, state.arc),
                         tension = kind.tension(next.state.pull, below);
            largest_tension_ = std::max(largest_tension_, tension);
            discrepancy_ = std::max(discrepancy_, std::abs(next.tension - tension));
            if (options.with_change)
                change =
                    at_place(kind, next.state, below, series.change(duration), series, duration);
            if (!(next.state.arc > state.arc)) break;  // a density too rough to follow
            state = next.state;
            state.pull -= particle * state.offset, change.pull -= particle * change.offset;
        }
        end_ = state.arc;
    }
    Path(const PathKind& kind, double tip_offset, const Options& options)
        : Path(kind, tip_offset, options, [](const auto&, double) {}) {}

    const PathKind& kind() const { return kind_; }
    const std::vector<Crossing>& crossings() const { return crossings_; }
    const std::vector<Step>& steps() const { return steps_; }
    /// Returns the arc length at which the last step ended.
    double end() const { return end_; }
    /// Returns how far the tension's own series is from sqrt(u^2 + V^2), over the largest tension.
    double discrepancy() const { return discrepancy_ / largest_tension_; }

    /// Returns the arc at which a path with a density begins. Below it `near_tip` applies.
    static double first_arc(const PathKind& kind) {
        const double power = kind.density->end_of_power() / kind.unit;
        // a bob need not be in line with the cord, which then bends at once
        if (kind.bob.lever > 0) return power;
        return std::max(power, 0x1p-28 * std::min(1.0, kind.density->length() / kind.unit));
    }
    /// Returns the state near the free end for a density like s^p, with errors of order s^2.
    static PathState near_tip(const PathKind& kind, double tip_offset, double s) {
        const PathState tip = kind.at_tip(tip_offset);
        if (s == 0) return tip;
        const double secant = std::sqrt(1 + kind.bend * tip_offset * tip_offset);
        const double below = kind.weight_below(s) - kind.tip,
                     moment = kind.density->first_moment(s * kind.unit);
        // with a tip the slope at the free end is u/V there
        const double slope = kind.tip > 0 ? tip.pull / kind.tip : -tip_offset;
        return {s, tip.offset + slope * s / secant,
                tip.pull - below * (tip.offset + slope * s * moment / secant), s / secant};
    }

    /// Returns the derivative of the state `near_tip` by the offset of the free end.
    static PathChange change_near_tip(const PathKind& kind, double tip_offset, double s) {
        const double secant = std::sqrt(1 + kind.bend * tip_offset * tip_offset),
                     turn = s / (secant * secant * secant);
        const double below = kind.weight_below(s) - kind.tip,
                     moment = kind.density->first_moment(s * kind.unit);
        return {0, 1 - turn, -kind.tip - below * (1 - turn * moment),
                -kind.bend * tip_offset * turn};
    }

   private:
    /// Returns the derivative at fixed arc, not time. A jump of the density does not change it.
    static PathChange at_place(const PathKind& kind, const PathState& x, double below,
                               const PathChange& change, const PathSeries& series,
                               double duration) {
        const double tension = kind.tension(x.pull, below);
        const double density = kind.density == nullptr ? 1.0 : series.density_at(duration);
        return {0, change.offset - x.pull / tension * change.arc,
                change.pull + density * x.offset * change.arc,
                change.height - below / tension * change.arc};
    }
    double within_piece(const PathSeries& series, double duration) const {
        if (kind_.density == nullptr) return duration;
        const double end = kind_.density->end_of_piece(series.arc[0] * kind_.unit) / kind_.unit;
        if (PathSeries::at(series.arc, duration) <= end) return duration;
        return time_at(series, end, duration);
    }
    bool ended(const Options& options, const PathState& state) const {
        return static_cast<int>(crossings_.size()) >= options.crossings ||
               state.arc > options.farthest || steps_.size() >= max_steps;
    }
    /// Returns the quadrant of (eta, u): 0 for eta > 0 > u, then in the order of passage.
    static int quadrant(const PathState& x) {
        if (x.offset > 0) return x.pull <= 0 ? 0 : 3;
        if (x.offset < 0) return x.pull >= 0 ? 2 : 1;
        return x.pull <= 0 ? 1 : 3;
    }
    static int quadrants(const PathState& from, const PathState& to) {
        return (quadrant(to) - quadrant(from) + 4) % 4;
    }
    /// Returns the number of crossings: a path enters quadrants 1 and 3 through the axis.
    static int crossings_in(const PathState& from, int passed) {
        const int first = quadrant(from);
        int count = 0;
        for (int i = 1; i <= passed; ++i) count += (first + i) % 2;
        return count;
    }
    void note_crossing(const PathSeries& series, double duration, bool with_change) {
        const double sign = series.offset[0] > 0 ? -1 : 1;
        const double t = time_of_zero(duration, [&](double time) {
            double value = series.offset[PathSeries::order], slope = 0;
            for (std::size_t k = PathSeries::order; k-- > 0;) {
                slope = slope * time + value;
                value = value * time + series.offset[k];
            }
            return std::pair(sign * value, sign * slope);
        });
        Crossing crossing{PathSeries::at(series.arc, t), 0, t};
        if (with_change) {
            const PathChange change = series.change(t);
            crossing.rate = change.arc - PathSeries::at(series.tension, t) * change.offset /
                                             PathSeries::at(series.pull, t);
        }
        crossings_.push_back(crossing);
    }

    PathKind kind_;
    std::vector<Step> steps_;
    std::vector<Crossing> crossings_;
    double largest_tension_ = 0, discrepancy_ = 0, end_ = 0;
};

}  // namespace revchain::finite
