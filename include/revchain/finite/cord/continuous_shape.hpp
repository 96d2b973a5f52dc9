// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>

#include "revchain/conical_pendulum.hpp"
#include "revchain/finite/cord/path.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A point of a whirling cord, in the units of the cord.
struct CordPlace {
    double arc_length;   ///< from the free end
    double offset;       ///< from the axis
    double height;       ///< above the support; negative where the cord hangs below
    double inclination;  ///< to the vertical, rad; positive where the cord rises towards the axis
    double tension;
};

/// A steady shape of a whirling cord, with eight points a step: dense where it turns sharply.
struct CordShape {
    Vector<double> arc_length;   ///< (n) from the free end, 0 ... length
    Vector<double> offset;       ///< (n) from the axis; 0 at the support, the last point
    Vector<double> height;       ///< (n) above the support
    Vector<double> inclination;  ///< (n) to the vertical, rad
    Vector<double> tension;      ///< (n)
    int half_waves = 1;          ///< number of crossings of the axis, with the support
    double length = 0;
    double conical_height = 0;  ///< lambda = g/speed^2
    double residual = 0;        ///< of the first integral at the support, over the largest tension
    double error_bound = 0;     ///< of inclinations (rad), and of offsets and heights over length
    double condition = 0;  ///< largest change of an inclination per relative change of the length

    /// Returns the point at an arc length from the free end. Cost: 1 microsecond. Throws
    /// InvalidArgument outside 0 ... length.
    CordPlace operator()(double arc) const;
    double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height, gravity);
    }

    // Data of `operator()`: scaled steps of the path, and the density to which `kind` points.
    std::shared_ptr<const LineDensity> density;
    finite::PathKind kind;
    std::vector<finite::Path::Step> steps;
    double tip_offset = 0, support_arc = 0, support_height = 0;
};

namespace finite {

REVCHAIN_LAZY
CordPlace place_of(const CordShape& shape, const PathState& x) {
    const double below = shape.kind.weight_below(x.arc), lambda = shape.conical_height;
    const double inclination = below == 0 ? std::atan(x.offset) : -std::atan2(x.pull, below);
    return {x.arc * lambda, x.offset * lambda, (x.height - shape.support_height) * lambda,
            inclination, std::hypot(x.pull, below) * lambda * shape.kind.line_weight};
}

/// Returns the state of a path at an arc length, from its steps.
REVCHAIN_LAZY
PathState state_at(const PathKind& kind, const std::vector<Path::Step>& steps, double tip_offset,
                   double arc) {
    const auto after = std::upper_bound(
        steps.begin() + 1, steps.end(), arc,
        [](double x, const Path::Step& step) { return x * (1 + 0x1p-48) < step.start.arc; });
    const Path::Step& step = *(after - 1);
    if (kind.is_bare() && &step == &steps.front())
        return TipSeries(step.start.offset, kind.bend).state(arc);
    if (arc < steps.front().start.arc) return Path::near_tip(kind, tip_offset, arc);
    const PathSeries series(kind, step.start);
    return series.state(time_at(series, std::max(arc, step.start.arc),
                                1.05 * step.duration));  // a moved step may end later
}

/// Collects points, residual, error and condition of a path while it is followed to the support.
class ShapeSamples {
   public:
    static constexpr int per_step = 8;
    static constexpr double close = 1 - 1e-7;  // points nearer to the support are left out

    ShapeSamples(const PathKind& kind, double tip_offset) : kind_(kind), tip_offset_(tip_offset) {}

    template <class Series>
    void operator()(const Series& series, double duration) {
        starts_.push_back(series.change(0));
        if constexpr (std::is_same_v<Series, PathSeries>) {
            sample(series, duration);
            last_ = series, last_duration_ = duration;
        } else {
            for (int i = 0; i < per_step; ++i)
                samples_.push_back({series.state(duration * i / per_step),
                                    series.change(duration * i / per_step)});
        }
    }

    /// Returns the shape: the path, moved to first order so that its last crossing is at the
    /// support. At a fold the crossing does not depend on the free end, and the path is not moved.
    CordShape finish(const Path& path, int half_waves, double length, double conical_height,
                     bool at_fold = false) {
        const Path::Crossing& support = path.crossings().back();
        const double scaled = length / conical_height,
                     by = at_fold ? 0 : (scaled - support.arc) / support.rate;
        add_support();
        drop_repeated();
        for (Sample& sample : samples_) move(sample.place, sample.change, by);
        tip_offset_ += by;
        if (samples_.front().place.arc > 0)
            samples_.insert(samples_.begin(),
                            {Path::near_tip(kind_, tip_offset_, 0), {0, 1, -kind_.tip, 0}});
        CordShape shape;
        shape.kind = kind_, shape.steps = path.steps();
        for (std::size_t i = 0; i < shape.steps.size(); ++i)
            move(shape.steps[i].start, starts_[i], by);
        while (shape.steps.size() > 1 && shape.steps.back().start.arc >= scaled * (1 - 1e-12))
            shape.steps.pop_back();
        shape.tip_offset = tip_offset_;
        shape.half_waves = half_waves, shape.length = length, shape.conical_height = conical_height;
        shape.support_arc = samples_.back().place.arc,
        shape.support_height = samples_.back().place.height;
        const auto count = static_cast<Index>(samples_.size());
        for (Vector<double>* v :
             {&shape.arc_length, &shape.offset, &shape.height, &shape.inclination, &shape.tension})
            v->resize(count);
        for (Index i = 0; i < count; ++i) {
            const CordPlace place = place_of(shape, samples_[static_cast<std::size_t>(i)].place);
            shape.arc_length[i] = place.arc_length, shape.offset[i] = place.offset,
            shape.height[i] = place.height;
            shape.inclination[i] = place.inclination, shape.tension[i] = place.tension;
        }
        shape.arc_length[count - 1] = length, shape.offset[count - 1] = 0;
        shape.residual = kind_.density == nullptr ? first_integral() : path.discrepancy();
        judge(shape, scaled, support.rate);
        if (!(std::abs(by) <= 1e-6 * tip_offset_))
            shape.error_bound = std::numeric_limits<double>::infinity();
        return shape;
    }

   private:
    struct Sample {
        PathState place;
        PathChange change;
    };
    using Row = std::array<double, per_step>;
    static Row at(const PathSeries::Coefficients& c, const Row& t) {
        Row sum;
        sum.fill(c[PathSeries::order]);
        for (std::size_t k = PathSeries::order; k-- > 0;)
            for (std::size_t i = 0; i < per_step; ++i) sum[i] = sum[i] * t[i] + c[k];
        return sum;
    }
    void sample(const PathSeries& series, double duration) {
        Row t;
        for (std::size_t i = 0; i < per_step; ++i)
            t[i] = duration * static_cast<double>(i) / per_step;
        const Row arc = at(series.arc, t), offset = at(series.offset, t), pull = at(series.pull, t);
        const Row height = at(series.height, t), arc_change = at(series.arc_change, t);
        const Row offset_change = at(series.offset_change, t),
                  pull_change = at(series.pull_change, t);
        const Row height_change = at(series.height_change, t);
        for (std::size_t i = 0; i < per_step; ++i)
            samples_.push_back(
                {{arc[i], offset[i], pull[i], height[i]},
                 {arc_change[i], offset_change[i], pull_change[i], height_change[i]}});
    }
    static void move(PathState& x, const PathChange& change, double by) {
        x.arc += change.arc * by, x.offset += change.offset * by;
        x.pull += change.pull * by, x.height += change.height * by;
    }
    /// Adds the support. As the path moves, it stays on the axis, later by -offset change/u.
    void add_support() {
        PathState x = last_.state(last_duration_);
        PathChange change = last_.change(last_duration_);
        const double below = kind_.weight_below(x.arc), later = -change.offset / x.pull;
        change.arc += kind_.tension(x.pull, below) * later, change.height += below * later,
            change.offset = 0;
        x.offset = 0;
        samples_.push_back({x, change});
    }
    /// Drops a step beyond the support. A piece of the density may end there, except for rounding.
    void drop_repeated() {
        const double last = samples_.back().place.arc * close;
        auto from = samples_.end() - 1;
        while (from - samples_.begin() > 1 && (from - 1)->place.arc >= last) --from;
        samples_.erase(from, samples_.end() - 1);
    }
    /// Returns |T - tip - xi + (eta^2 - eta_0^2)/2| at the support, over the largest tension.
    double first_integral() const {
        const PathState& end = samples_.back().place;
        const double tension = kind_.tension(end.pull, kind_.weight_below(end.arc));
        const double sum =
            kind_.tip * std::hypot(1.0, tip_offset_) + end.height + 0.5 * tip_offset_ * tip_offset_;
        return std::abs(tension - sum) / std::max(tension, sum);
    }
    /// Sets error bound and condition, from derivatives of inclinations and offsets.
    void judge(CordShape& shape, double length, double rate) const {
        double turned = 0, moved = 0, steepest = 0;
        for (const auto& [x, change] : samples_) {
            const double below = kind_.weight_below(x.arc),
                         squared = x.pull * x.pull + below * below;
            if (squared == 0) {  // the free end: tan psi = eta_0
                turned = std::max(turned, 1 / (1 + x.offset * x.offset)),
                moved = std::max(moved, 1.0);
                continue;
            }
            // derivatives at fixed arc
            const double density = kind_.density_at(x.arc);
            turned = std::max(
                turned, std::abs(change.pull + density * x.offset * change.arc) * below / squared);
            moved =
                std::max(moved, std::abs(change.offset - x.pull / std::sqrt(squared) * change.arc));
            steepest = std::max(steepest, density * std::abs(x.offset * below + x.pull) / squared);
        }
        shape.condition = turned * length / rate;
        // Points and length are rounded once or twice; polynomials approximate a density.
        // Calibrated in tests/cpp/finite/cord/continuous_chain.cpp: errors reach 0.6 of this.
        double data = epsilon<double>();
        if (kind_.density != nullptr)
            data = std::max(4 * data, 2 * kind_.density->error(std::min(1.0, length) * kind_.unit));
        shape.error_bound =
            data * (1.5 + 2 * std::max(shape.condition, moved / rate) + steepest * length);
    }

    PathKind kind_;
    double tip_offset_;
    std::vector<Sample> samples_;
    std::vector<PathChange> starts_;
    PathSeries last_;
    double last_duration_ = 0;
};

}  // namespace finite

}  // namespace revchain
