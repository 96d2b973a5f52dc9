// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/cord/continuous_shape.hpp"
#include "revchain/finite/cord/tip_offset.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/system/cord.hpp"

/// Finds all steady shapes of a whirling cord at a speed, its critical heights and its modes of
/// small amplitude; the density is any, with or without a weight at the free end: Greenhill (1908)
/// §4 without small angles. In what follows V is the weight below a place, T the tension, rho the
/// weight per length, u the pull across the axis, tip the length of cord as heavy as the tip, and a
/// prime the derivative by V. A path is followed up from the free end. The offset eta_0 of that end
/// is the one unknown. A shape of j half waves is a path whose crossing j, at s_j(eta_0), is the
/// support (equations at `finite::PathState`). Properties of s_j:
///   - s_j(eta_0) > s_j(0), the value at small amplitude, by Sturm's comparison: as a function of V
///     the pull satisfies u'' = -u/(rho T), u'(tip) = u(tip)/tip, and T > V. So no shape has j half
///     waves at or above the conical height lambda_j of small amplitude.
///   - s_j is unbounded, as s_1 >= eta_0. So at least one shape has j half waves if lambda <
///     lambda_j.
///   - s_1 increases: v = du/deta_0 satisfies v'' = -(V/T)^2 v/(rho T), so (u v' - v u')' > 0 while
///     u and v have one sign. At the crossing, u' = 0 and u v' > 0. So at most one shape has no
///     node.
///   - Every s_j increases if h = sqrt(rho/V) is a convex function of V. Then there is one shape
///     for every critical height above lambda. This holds for a uniform chain with any tip weight.
///     It holds for densities s^p without a tip weight for p > -1, and with a tip weight for p <=
///     0.
///     Proof. Let w = eta_0 v, which starts as u does. By u'' = -u/(rho T) and w'' = -q w,
///     q = V^2/(rho T^3) <= 1/(rho T), the phase of w, tan theta = w/w', lags that of u (Sturm). E
///     = V u' - u is 0 at the free end. E' = -V u/(rho T) and E'' + (ln(rho/V))' E' + q E = 0, so y
///     = h E satisfies y'' = -(q - h''/h) y with h'' >= 0. Hence w has a zero between the free end
///     and the first zero of E, and between any two zeros of E, upper ones included. (Otherwise,
///     where w y < 0 up to the next zero b, W = w y' - w' y has W' = w y h''/h <= 0 but W(b) = w(b)
///     y'(b) > 0. At the free end the monotone W has a limit that is not positive. With a tip
///     weight a positive limit contradicts y > 0 rising from 0. Without one it makes (y/w)' = W/w^2
///     ~ 1/V^2 not integrable, while y/w tends to 0.) E is monotone between zeros of u. At crossing
///     j, where u' = 0, E and E' have the sign of -u, so E has one zero between each zero of u and
///     the next crossing: j - 1 below crossing j. There theta lies between (j - 1) pi, from the
///     zeros of w, and (j - 1/2) pi, the phase of u: w' has the sign of u, and ds_j/deta_0 that of
///     u w'. Only the density up to s_j counts. Extend it beyond the support: s_j(eta_0) is smooth
///     and rises at the support, so it equals the length once.
/// For the uniform chain without a tip weight this is I. I. Kolodner, Heavy rotating string - a
/// nonlinear eigenvalue problem, Comm. Pure Appl. Math. 8 (1955). For densities s^p without a tip
/// weight it is P. Amore, J. P. Boyd, A. Marquez, arXiv:2202.13476. It fails in general: three
/// heavy beads on a light thread have five shapes below three critical heights
/// (tests/cpp/finite/cord/continuous_chain.cpp). So `complete` is true if sqrt(rho/V) is known to
/// be convex, or if at most one critical height is above. Else many eta_0 are sampled, without
/// proof.
namespace revchain::inline REVCHAIN_BUILD {

struct CordShapes {
    std::vector<CordShape> shapes;  ///< by half waves, then the free end's offset
    bool complete = false;          ///< whether a theorem excludes others
};

/// The speed: give either `conical_height` or `angular_speed`.
struct CordShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    int scanned = 200;  ///< sampled offsets of the free end if no theorem counts the shapes
};

namespace finite {

struct ContinuousChain {
    double length, tip;                          ///< tip: length of cord with the weight of the tip
    std::shared_ptr<const LineDensity> density;  ///< null for a uniform cord
    double line_weight;
    PathKind::Bob bob;  ///< of the tip, in the unit of the length
    bool is_counted;    ///< a theorem applies: one shape for each critical height

    explicit ContinuousChain(const Cord& cord)
        : length(cord.length()),
          tip(cord.tip_length()),
          density(cord.line_density()),
          line_weight(cord.line_weight()),
          bob(bob_of(cord)),
          is_counted(cord.is_power() && !cord.has_bob() &&
                     (cord.tip_weight() == 0 || *cord.exponent() <= 0)) {}

   private:
    static PathKind::Bob bob_of(const Cord& cord) {
        if (!cord.has_bob()) return {};
        const double k = cord.tip_radius_of_gyration(), beyond = k * k / cord.tip_centroid();
        return {cord.tip_centroid() + beyond, beyond};
    }
};

/// Returns the chain with lengths over `height`; bend is 0 for small amplitude.
REVCHAIN_LAZY
PathKind kind_of(const ContinuousChain& chain, double height, double bend) {
    const double mean = chain.density == nullptr ? 1.0 : chain.density->mean();
    return {chain.tip / height,
            height,
            mean,
            chain.density.get(),
            bend,
            chain.line_weight,
            {chain.bob.lever / height, chain.bob.beyond / height}};
}

REVCHAIN_LAZY
Path path_at_rest(const ContinuousChain& chain, double height, Path::Options options) {
    options.with_change = false;
    return {kind_of(chain, height, 0), 1, options};
}

/// Returns the shape near an almost exact path; none if no path could be followed that far.
REVCHAIN_LAZY
std::optional<CordShape> finished(const PathKind& kind, double tip_offset, int crossing,
                                  double length, double height) {
    for (int round = 0;; ++round) {
        ShapeSamples samples(kind, tip_offset);
        const Path path(kind, tip_offset, {.crossings = crossing}, samples);
        if (!(tip_offset > 0) || static_cast<int>(path.crossings().size()) < crossing)
            return std::nullopt;
        const Path::Crossing& support = path.crossings().back();
        const double step = (length / height - support.arc) / support.rate;
        if (std::abs(step) < TipOffset::near * tip_offset || round == 3)
            return samples.finish(path, crossing, length, height);
        tip_offset += step;
    }
}

/// Returns for each crossing the ranges of eta_0 with ends on different sides of the support.
REVCHAIN_LAZY
std::vector<std::vector<TipRange>> scanned(const PathKind& kind, std::size_t crossings,
                                           double length, int count) {
    std::vector<std::vector<TipRange>> ranges(crossings);
    std::vector<bool> below(crossings, true);  // at small amplitude crossings lie below the support
    double last = 0;
    for (int i = 1; i <= count; ++i) {
        const double x = static_cast<double>(i) / count,
                     tip = i == count ? length : length * x * x * x;
        const Path path(kind, tip,
                        {.crossings = static_cast<int>(crossings),
                         .farthest = length,
                         .tolerance = 1e-12,
                         .with_change = false});
        for (std::size_t j = 0; j < crossings; ++j) {
            const bool now =
                i < count && j < path.crossings().size() && path.crossings()[j].arc < length;
            if (now != below[j]) ranges[j].push_back({last, tip, below[j]});
            below[j] = now;
        }
        last = tip;
    }
    return ranges;
}

/// Returns length over conical height. Throws InvalidArgument above 1e6, where no path is followed.
REVCHAIN_LAZY
double length_in_heights(std::string_view place, double length, double height) {
    const double heights = length / height;
    if (!(heights <= 1e6))
        detail::throw_invalid(place, "length / conical height must be at most 1e6", heights);
    return heights;
}

/// Throws InvalidArgument for a path that ended before the support.
REVCHAIN_LAZY
void require_followed(std::string_view place, const Path& path, double length, double height) {
    if (!(path.end() > length))
        detail::throw_invalid(place,
                              "the density is too rough, or the tip too heavy, to be followed; the "
                              "series ended at arc length",
                              path.end() * height);
}

REVCHAIN_LAZY
CordShapes continuous_shapes(const ContinuousChain& chain, double height, int most_scanned) {
    const double undecided = 32 * epsilon<double>();  // of a length near a critical height
    const double length = chain.length / height, farthest = length * (1 + undecided);
    const PathKind kind = kind_of(chain, height, 1);
    const Path small = path_at_rest(chain, height, {.farthest = farthest});
    require_followed("steady_shapes", small, length, height);
    std::vector<double> at_rest;
    for (const Path::Crossing& crossing : small.crossings())
        if (crossing.arc <= farthest) at_rest.push_back(crossing.arc);
    std::size_t count = at_rest.size();
    while (count > 0 && !(at_rest[count - 1] < length * (1 - undecided))) --count;
    CordShapes result;
    const bool theorem = chain.is_counted || at_rest.size() <= 1;
    result.complete = theorem && count == at_rest.size();
    std::vector<std::vector<TipRange>> ranges(count, {{0, length, true}});
    if (!theorem && count > 0) ranges = scanned(kind, count, length, most_scanned);
    CrossingLaw law = CrossingLaw::uniform(static_cast<int>(count));
    for (std::size_t j = count; j-- > 0;) {
        const int crossing = static_cast<int>(j) + 1;
        for (std::size_t i = ranges[j].size(); i-- > 0;) {
            const TipOffset tip = tip_offset(kind, crossing, at_rest[j], length, ranges[j][i], law);
            if (auto shape = finished(kind, tip.value, crossing, chain.length, height)) {
                result.shapes.push_back(std::move(*shape));
            } else {
                result.complete = false;
            }
            law = tip.law;
        }
        law = law.of_one_before(crossing);
    }
    std::reverse(result.shapes.begin(), result.shapes.end());
    for (CordShape& shape : result.shapes) shape.density = chain.density;
    return result;
}

/// Returns the `count` greatest critical heights, at which shapes leave the vertical, descending.
/// Method: the series with T = V. On a chain continued beyond its support, crossing j is lower at a
/// lower height. Accuracy: 4e-15 relative. Cost: eight paths each; one path for all if the chain is
/// uniform without a tip weight. Throws InvalidArgument for a count below 1 or above 1e5.
REVCHAIN_LAZY
Vector<double> critical_heights(const ContinuousChain& chain, Index count) {
    constexpr std::string_view place = "modes";
    if (count < 1 || count > 100'000)
        detail::throw_invalid(place, "power series find modes number 1 to 100000", count);
    Vector<double> heights(count);
    const auto place_of = [&](double height, Index crossing) {
        const Path path = path_at_rest(chain, height, {.crossings = static_cast<int>(crossing)});
        if (static_cast<Index>(path.crossings().size()) < crossing)
            detail::throw_invalid(
                place,
                chain.density != nullptr
                    ? "the line density is too rough to follow up to critical height"
                    : "the tip weight is too great beside the chain's to follow up to critical "
                      "height",
                crossing);
        return path.crossings();
    };
    if (kind_of(chain, 1, 0).is_bare()) {
        const auto crossings = place_of(1, count);
        for (Index j = 0; j < count; ++j)
            heights[j] = chain.length / crossings[static_cast<std::size_t>(j)].arc;
        return heights;
    }
    for (Index j = 1; j <= count; ++j) {
        const auto excess = [&](double height) {
            // a bob that is across the axis has crossed it below the cord
            const double arc = place_of(height, j).back().arc;
            return std::log(std::max(arc * height / chain.length, 1e-12));
        };
        const double guess = j == 1 ? chain.length : heights[j - 2];
        heights[j - 1] = detail::zero_between(detail::sign_change_near(guess, excess), excess,
                                              {.value = 2 * epsilon<double>()});
    }
    return heights;
}

/// Returns the largest relative change of a critical height by that of the place of a particle or
/// of the support: V y'^2 s over the integral of V y'^2. It is large where most of the turning is
/// between two that are near each other.
REVCHAIN_LAZY
double condition_of_places(const ContinuousChain& chain, double height, Index mode) {
    double turning = 0, largest = 0;
    const auto visit = [&](const auto& series, double duration) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(series)>, PathSeries>) {
            const auto squared = [&](double part) {
                return std::pow(series.state(duration * part).pull, 2);
            };
            const double first = squared(0), last = squared(1);
            turning += series.pace * duration * (first + 4 * squared(0.5) + last) / 6;
            const PathState end = series.state(duration);
            largest = std::max({largest, first / series.tension[0] * series.arc[0],
                                last / PathSeries::at(series.tension, duration) * end.arc});
        }
    };
    const Path path(kind_of(chain, height, 0), 1,
                    {.crossings = static_cast<int>(mode), .with_change = false}, visit);
    return largest / turning;
}

/// Returns the number of critical heights above `height`. Throws InvalidArgument for a length above
/// 1e6 heights and for a density or tip weight that the series cannot follow.
REVCHAIN_LAZY
Index critical_heights_above(const ContinuousChain& chain, double height) {
    constexpr std::string_view place = "count_modes";
    const double length = length_in_heights(place, chain.length, height);
    const Path path = path_at_rest(chain, height, {.farthest = length});
    require_followed(place, path, length, height);
    return std::count_if(path.crossings().begin(), path.crossings().end(),
                         [&](const Path::Crossing& crossing) { return crossing.arc < length; });
}

/// A mode of small amplitude. Cost: one path; 1 microsecond a point, 10 with a density.
class CordModeShape {
   public:
    CordModeShape(const ContinuousChain& chain, double height, Index mode)
        : chain_(chain),
          height_(height),
          path_(path_at_rest(chain_, height, {.crossings = static_cast<int>(mode)})),
          tip_(path_.kind().at_tip(1)) {}

    /// Returns the offset at distance s from the free end; 1 at that end.
    double shape(double s) const { return state("CordModes::offset", s).offset / tip_.offset; }
    /// Returns d offset / ds at s; -1 / height at the free end unless a bob hangs there.
    double slope(double s) const { return slope(state("CordModes::slope", s)) / tip_.offset; }
    /// Returns the inclination of the bob, d offset / ds along it.
    double bob_slope() const { return -1 / (height_ * tip_.offset); }
    /// Returns where the cord crosses the axis, ascending, without the support.
    Vector<double> nodes() const { return crossings(tip_.offset < 0 ? 1 : 0); }
    /// Returns where the cord is vertical, once above each node: T y'' = -rho (y / height + y').
    /// Where it turns back at a particle, that is the place. With a bob another can lie below the
    /// lowest node.
    Vector<double> vertical_points() const {
        // a bob across the axis may be across its own vertical point too
        const bool passed = tip_.offset < 0 && tip_.pull > 0;
        const double sign = passed ? -1 : 1;
        return detail::zeros_between(crossings(passed ? 1 : 0), chain_.length, [&](double s) {
            const PathState at = state("CordModes::vertical_points", s);
            const double steep = sign * slope(at),
                         part = path_.kind().density_at(at.arc) / path_.kind().weight_below(at.arc);
            return std::pair(steep, -part * (sign * at.offset / height_ + steep) / height_);
        });
    }

   private:
    Vector<double> crossings(std::size_t first) const {
        Vector<double> points(static_cast<Index>(path_.crossings().size() - 1 - first));
        for (Index i = 0; i < points.size(); ++i)
            points[i] = path_.crossings()[first + static_cast<std::size_t>(i)].arc * height_;
        return points;
    }
    PathState state(std::string_view place, double s) const {
        if (!(s >= 0 && s <= chain_.length))
            detail::throw_invalid(place, "s must lie between 0 (free end) and the length", s);
        return state_at(path_.kind(), path_.steps(), 1, s / height_);
    }
    double slope(const PathState& at) const {
        const double below = path_.kind().weight_below(at.arc);
        return (below == 0 ? -1 : at.pull / below) / height_;
    }

    ContinuousChain chain_;
    double height_;
    Path path_;
    PathState tip_;
};

}  // namespace finite

/// Returns all steady shapes of a cord at a speed, at any inclination, without the straight one. Of
/// two mirror images it returns the one whose free end has a positive offset. If `complete` is
/// false there may be more shapes (see above).
///
/// Method: power series of order 24 in a time that makes the equations polynomials
/// (`finite::PathSeries`), and Newton's method on crossing j, with its derivative from the series.
/// Quadrants within every step determine the crossings. Accuracy: inclinations, and offsets and
/// heights over the length, are within `error_bound`. Errors are at most 0.6 of it, measured
/// against 22 digits for length/height from 1.4458 to 1e4, tip weights to 1e3 and five densities.
/// The bound is an estimate from the change of the shape with its length and along it. It is
/// 1.3e-13 at length/height 500 (measured 3.4e-14; 3e-16 for offsets), where the sharpest corner
/// turns over a radian in a thousandth of the length. It is 3e-12 at 1e4 (measured 7e-13). It grows
/// near a critical height, where the amplitude is ill determined. `residual` is that of the first
/// integral of the uniform chain; with a density, of the tension's own series against its
/// components. Cost: a microsecond a step, at least four steps a half wave. Fourteen shapes at
/// length/height 500 take 1.8 ms (bench/continuous.cpp); with a density ten times that, plus
/// `scanned` paths. Throws InvalidArgument unless exactly one of height and speed is given,
/// positive and finite. Throws it too for a length above 1e6 heights, `scanned` below 1, an
/// exponent of the density above 20, and a cord that the series cannot follow. Examples are an
/// exponent of 17 without a tip weight, or a tip of 1e30 times the cord's weight.
REVCHAIN_DECLARE
[[nodiscard]] CordShapes steady_shapes(const Cord& cord, const CordShapesOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/cord/steady_shapes.hpp"
#endif
