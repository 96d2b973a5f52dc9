// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/numeric/arc_step.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The moment of inertia and potential energy of a path, integrated by parts. At the support the
/// path is on the axis:
///     sum of weight eta^2 = integral of u^2/T,   sum of weight height = - integral of V^2/T.
class PathEnergies {
   public:
    explicit PathEnergies(const PathKind& kind, double tip_offset) : kind_(kind) {
        if (kind.density == nullptr) return;
        // below the start of the path the inclination equals that of the free end
        const double s = Path::first_arc(kind), below = kind.weight_below(s);
        const double moment = kind.density->first_moment(s * kind.unit),
                     cosine = 1 / std::hypot(1.0, tip_offset);
        const double carried = s * below - moment * (below - kind.tip) * s;
        add(carried / cosine * (1 - cosine * cosine), carried * cosine);
    }
    template <class Series>
    void operator()(const Series& series, double duration) {
        static const auto rule = detail::gauss_rule(16);
        for (const auto& [t, weight] : rule) {
            const PathState x = series.state(duration * t);
            const double below = kind_.weight_below(x.arc), step = duration * weight;
            if constexpr (std::is_same_v<Series, PathSeries>) {
                add(series.pace * step * x.pull * x.pull, series.pace * step * below * below);
            } else {
                const double tension = kind_.tension(x.pull, below);
                add(step * x.pull * x.pull / tension, step * below * below / tension);
            }
        }
    }
    double inertia() const { return inertia_; }
    double potential() const { return potential_; }

   private:
    void add(double turning, double hanging) { inertia_ += turning, potential_ -= hanging; }

    PathKind kind_;
    double inertia_ = 0, potential_ = 0;
};

/// A point in the plane of branches of a cord. `bend` is tau, where sinh(tau) is the tangent of the
/// inclination of the free end. The other coordinate is the logarithm of the conical height.
struct BranchPlace {
    double bend = 0, log_height = 0;
};
inline BranchPlace operator+(const BranchPlace& x, const BranchPlace& y) {
    return {x.bend + y.bend, x.log_height + y.log_height};
}
inline BranchPlace operator-(const BranchPlace& x, const BranchPlace& y) {
    return {x.bend - y.bend, x.log_height - y.log_height};
}
inline BranchPlace operator*(double s, const BranchPlace& x) {
    return {s * x.bend, s * x.log_height};
}
REVCHAIN_LAZY
double dot(const BranchPlace& x, const BranchPlace& y) {
    return x.bend * y.bend + x.log_height * y.log_height;
}
REVCHAIN_LAZY
double size(const BranchPlace& x) { return std::hypot(x.bend, x.log_height); }

/// The line on which crossing number `crossing` of the paths of a cord is at the support: f =
/// log(arc lambda / length) = 0. A branch of j half waves lies on the line of crossing j.
class BranchLine {
   public:
    /// A point on the line, its unit direction, the derivative of f by the bend, and f.
    struct Point {
        BranchPlace at, direction;
        double rate = 0, off = 0;
    };

    BranchLine(const Cord& cord, int crossing) : chain_(cord), crossing_(crossing) {}

    const ContinuousChain& chain() const { return chain_; }
    int crossing() const { return crossing_; }
    PathKind kind(double log_height) const { return kind_of(chain_, std::exp(log_height), 1); }

    /// Returns the point of the line near `from`, searched across `direction`, with its direction
    /// on the same side. Returns none if Newton's method does not converge at once.
    std::optional<Point> next_to(BranchPlace from, const BranchPlace& direction,
                                 double reach) const {
        BranchPlace at = from;
        double last = std::numeric_limits<double>::infinity();
        Point found;
        for (int round = 0; round < 12; ++round) {
            if (!(at.bend > 0) || at.bend > 700 || std::exp(-at.log_height) * chain_.length > 1e6)
                return std::nullopt;
            const auto value = value_at(at, round > 0);
            if (!value) return std::nullopt;
            const BranchPlace& slope = value->second;
            const double across =
                slope.bend * direction.log_height - slope.log_height * direction.bend;
            found = {at, {-slope.log_height, slope.bend}, slope.bend, value->first};
            found.direction = (1 / size(found.direction)) * found.direction;
            if (dot(found.direction, direction) < 0) found.direction = -1.0 * found.direction;
            const BranchPlace step{-value->first * direction.log_height / across,
                                   value->first * direction.bend / across};
            const double moved = size(step);
            if (!std::isfinite(moved) || size(at + step - from) > reach) return std::nullopt;
            if (moved < 4e-16 * (1 + size(at)) ||
                (round > 1 && moved < 1e-12 && moved > 0.3 * last))
                return found;
            if (round > 2 && moved > 0.5 * last) return std::nullopt;
            at = at + step, last = moved;
        }
        return found;
    }
    /// Returns f and its slopes. The slope by log(height) is 1 for a uniform cord without a tip
    /// weight. Else it is a difference of two paths, accurate to 1e-7; only directions and steps
    /// use it.
    std::optional<std::pair<double, BranchPlace>> value_at(const BranchPlace& at,
                                                           bool fine = true) const {
        const double tolerance = fine ? PathSeries::rounding : 1e-13;
        const auto path = [&](double log_height, bool with_change) {
            return Path(
                kind(log_height), std::sinh(at.bend),
                {.crossings = crossing_, .tolerance = tolerance, .with_change = with_change});
        };
        const auto enough = [&](const Path& x) {
            return static_cast<int>(x.crossings().size()) >= crossing_;
        };
        const Path here = path(at.log_height, true);
        if (!enough(here)) return std::nullopt;
        const Path::Crossing& support = here.crossings().back();
        double by_height = 1;
        if (!here.kind().is_bare()) {
            constexpr double little = 1e-4;
            const Path above = path(at.log_height + little, false),
                       below = path(at.log_height - little, false);
            if (!enough(above) || !enough(below)) return std::nullopt;
            by_height = 1 + std::log(above.crossings().back().arc / below.crossings().back().arc) /
                                (2 * little);
        }
        return std::pair(std::log(support.arc * std::exp(at.log_height) / chain_.length),
                         BranchPlace{support.rate / support.arc * std::cosh(at.bend), by_height});
    }
    /// Returns the point between a and b, where `value` has different signs, at which it is 0.
    template <class F>
    std::optional<Point> between(const Point& a, const Point& b, const F& value) const {
        const BranchPlace chord = b.at - a.at, direction = (1 / size(chord)) * chord;
        const detail::SignChange<double> ends{{0, value(a)}, {1, value(b)}};
        double least = std::min(std::abs(ends.low.value), std::abs(ends.high.value));
        std::optional<Point> best = std::abs(ends.low.value) == least ? a : b;
        const auto at = [&](double along) {
            const auto point = next_to(a.at + along * chord, direction, 2 * size(chord));
            if (!point) return std::numeric_limits<double>::quiet_NaN();
            const double now = value(*point);
            if (std::abs(now) <= least) least = std::abs(now), best = point;
            return now;
        };
        const double share = detail::zero_between(ends, at, {.width = 4e-16});
        if (std::isnan(share)) return std::nullopt;
        return best;
    }

   private:
    ContinuousChain chain_;
    int crossing_;
};

/// Follows a line: predictor along the direction, corrector across it. Accepts a step if Newton's
/// method contracts, the direction turns by at most 0.2 and the correction is at most step/3.
class BranchLineWalk {
   public:
    BranchLineWalk(const BranchLine& line, const BranchLine::Point& start, double longest)
        : line_(line), at_(start), step_(std::min(0.02, longest)), longest_(longest) {}

    const BranchLine::Point& at() const { return at_; }
    bool advance() {
        return detail::arc_step(step_, longest_, 0.5, [&](double step) -> std::optional<double> {
            const BranchPlace guess = at_.at + step * at_.direction;
            const auto next = line_.next_to(guess, at_.direction, step);
            if (!next) return {};
            const double turned =
                std::acos(std::clamp(dot(next->direction, at_.direction), -1.0, 1.0));
            if (turned > 0.2 || size(next->at - guess) > step / 3) return {};
            at_ = *next;
            return turned < 0.05 ? 2 : 1;
        });
    }

   private:
    const BranchLine& line_;
    BranchLine::Point at_;
    double step_, longest_;
};

}  // namespace revchain::finite
