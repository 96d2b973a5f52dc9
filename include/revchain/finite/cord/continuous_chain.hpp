// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/cord/continuous_shape.hpp"
#include "revchain/finite/cord/tip_offset.hpp"
#include "revchain/system/cord.hpp"

/// Steady shapes of a whirling chain without links, of any density and with a weight at its free end or none, at any
/// inclination: Greenhill (1908) §4 without its small angles. A path is followed up from the free end, whose offset
/// eta_0 is the one unknown; a shape of j half waves is a path whose crossing number j is at the support. What is known
/// of s_j(eta_0), the place of that crossing (equations at `finite::PathState`):
///   - s_j(eta_0) > s_j(0), that of small amplitude: against V the pull satisfies u'' = -u/(rho T),
///     u'(tip) = u(tip)/tip, and T > V, the T of small amplitude: Sturm's comparison. So no shape has j half waves at
///     or above the conical height lambda_j of small amplitude.
///   - s_j grows beyond any bound, as s_1 >= eta_0: so one at least has j half waves if lambda < lambda_j.
///   - s_1 rises everywhere: v = du/deta_0 satisfies v'' = -(V/T)^2 v/(rho T), so that (u v' - v u')' > 0 as long as
///     u and v have one sign, and at the crossing, where u' = 0, u v' > 0. So one at most has no node.
///   - Every s_j rises where sqrt(rho/V) is a convex function of V, so that there is one shape for every critical
///     height above lambda: for a uniform chain with any tip weight, for densities s^p without a tip, p > -1, and with
///     a tip for p <= 0. Proof (' by V from now on): let w = eta_0 v, which starts as u does. On u'' = -u/(rho T) and
///     w'' = -q w, q = V^2/(rho T^3) <= 1/(rho T), the phase of w, tan theta = w/w', is behind that of u (Sturm). The
///     function E = V u' - u is 0 at the free end, E' = -V u/(rho T), and E'' + (ln(rho/V))' E' + q E = 0, so that y =
///     sqrt(rho/V) E satisfies y'' = -(q - h''/h) y, h = sqrt(rho/V), h'' >= 0: between the free end and the first zero
///     of E, that one included, w has a zero, and so between each two of them, the upper one included. (Sturm: where wy
///     < 0 up to the next zero b, W = w y' - w' y has W' = w y h''/h <= 0, but W(b) = w(b) y'(b) > 0. At the free end W
///     is not positive: it has a limit, as it is monotone. A positive limit contradicts y > 0 rising from 0 where there
///     is a tip, and where there is none makes (y/w)' = W/w^2 ~ 1/V^2, which has no integral, while y/w tends to 0.) E
///     is monotone between zeros of u. At crossing j, where u' = 0, E and E' have the sign of -u: so E has one zero
///     between each zero of u and the next crossing, j - 1 in all below crossing j. There theta lies between (j - 1)
///     pi, as w has so many zeros, and (j - 1/2) pi, the phase of u: w' has the sign of u, and ds_j/deta_0 that of u
///     w'. Only the density up to s_j counts: let it go on beyond the support in any way; s_j(eta_0) is smooth, rises
///     wherever it is at the support, and so is there once. For the
///     uniform chain without a tip: I. I. Kolodner, Heavy rotating string - a nonlinear eigenvalue problem, Comm. Pure
///     Appl. Math. 8 (1955); for densities s^p without a tip: P. Amore, J. P. Boyd, A. Marquez, arXiv:2202.13476.
/// The last is false in general: three heavy beads on a light thread have five shapes where the three heights of small
/// amplitude promise three (tests/cpp/finite/cord/continuous_chain.cpp). So `complete` is true where sqrt(rho/V) is
/// known to be convex, and where no more than one height is above; elsewhere s_j is looked at for many eta_0, and
/// `complete` is false.
namespace revchain::inline REVCHAIN_BUILD {

/// The shapes found, and whether there are more.
struct CordShapes {
    std::vector<CordShape> shapes;  ///< by half waves, then the free end's offset
    bool complete = false;          ///< a theorem says that there are no others
};

/// The speed: give either `conical_height` or `angular_speed`.
struct CordShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    int scanned = 200;  ///< offsets of the free end looked at where no theorem counts the shapes
};

namespace finite {

/// A cord as paths take it.
struct ContinuousChain {
    double length, tip;                          ///< tip: the length of cord that weighs as much as the particle there
    std::shared_ptr<const LineDensity> density;  ///< none: uniform
    double line_weight;
    bool is_counted;  ///< every crossing rises with the offset of the free end: one shape for each critical height

    explicit ContinuousChain(const Cord& cord)
        : length(cord.length()),
          tip(cord.tip_length()),
          density(cord.line_density()),
          line_weight(cord.line_weight()),
          is_counted(cord.exponent() && (cord.tip_weight() == 0 || *cord.exponent() <= 0)) {}
};

/// The chain over lengths of `height`; bend 0: at small amplitude.
inline PathKind kind_of(const ContinuousChain& chain, double height, double bend) {
    const double mean = chain.density == nullptr ? 1.0 : chain.density->mean();
    return {chain.tip / height, height, mean, chain.density.get(), bend, chain.line_weight};
}

/// The path of small amplitude, without its change.
inline Path path_at_rest(const ContinuousChain& chain, double height, Path::Options options) {
    options.with_change = false;
    return {kind_of(chain, height, 0), 1, options};
}

/// The shape next to a path all but right; none where no path could be followed that far.
inline std::optional<CordShape> finished(const PathKind& kind, double tip_offset, int crossing, double length,
                                         double height) {
    for (int round = 0;; ++round) {
        ShapeSamples samples(kind, tip_offset);
        const Path path(kind, tip_offset, {.crossings = crossing}, samples);
        if (!(tip_offset > 0) || static_cast<int>(path.crossings().size()) < crossing) return std::nullopt;
        const Path::Crossing& support = path.crossings().back();
        const double step = (length / height - support.arc) / support.rate;  // smaller each time
        if (std::abs(step) < TipOffset::near * tip_offset || round == 3)
            return samples.finish(path, crossing, length, height);
        tip_offset += step;
    }
}

/// For each crossing, ranges of the free end's offset at whose ends it lies on different sides of the support.
inline std::vector<std::vector<TipRange>> scanned(const PathKind& kind, std::size_t crossings, double length,
                                                  int count) {
    std::vector<std::vector<TipRange>> ranges(crossings);
    std::vector<bool> below(crossings, true);  // at rest, the crossing lies below the support
    double last = 0;
    for (int i = 1; i <= count; ++i) {
        const double x = static_cast<double>(i) / count, tip = i == count ? length : length * x * x * x;
        const Path path(
            kind, tip,
            {.crossings = static_cast<int>(crossings), .farthest = length, .tolerance = 1e-12, .with_change = false});
        for (std::size_t j = 0; j < crossings; ++j) {
            const bool now = i < count && j < path.crossings().size() && path.crossings()[j].arc < length;
            if (now != below[j]) ranges[j].push_back({last, tip, below[j]});
            below[j] = now;
        }
        last = tip;
    }
    return ranges;
}

/// Length over conical height. Throws InvalidArgument above 1e6: so far no path is followed.
inline double length_in_heights(std::string_view place, double length, double height) {
    const double heights = length / height;
    if (!(heights <= 1e6)) detail::throw_invalid(place, "length / conical height must be at most 1e6", heights);
    return heights;
}

/// Throws InvalidArgument for a path that ended before the support.
inline void require_followed(std::string_view place, const Path& path, double length, double height) {
    if (!(path.end() > length))
        detail::throw_invalid(place,
                              "the density is too rough, or the tip too heavy, to be followed; the "
                              "series ended at arc length",
                              path.end() * height);
}

inline CordShapes continuous_shapes(const ContinuousChain& chain, double height, int most_scanned) {
    const double undecided = 32 * epsilon<double>();  // of a length: on which side of a critical height, nobody can say
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

/// The `count` greatest conical heights at which shapes leave the vertical, descending: those of small amplitude, by
/// the same series with T = V. Method: the place of crossing j of a chain that goes on beyond its support falls as the
/// height does. Accuracy: 4e-15 relative.
/// Cost: eight paths each, but one for all where the chain is uniform without tip weight.
/// Throws InvalidArgument for a count below 1 or above 1e5.
inline Vector<double> critical_heights(const ContinuousChain& chain, Index count) {
    constexpr std::string_view place = "modes";
    if (count < 1 || count > 100'000) detail::throw_invalid(place, "power series find modes number 1 to 100000", count);
    Vector<double> heights(count);
    const auto place_of = [&](double height, Index crossing) {
        const Path path = path_at_rest(chain, height, {.crossings = static_cast<int>(crossing)});
        if (static_cast<Index>(path.crossings().size()) < crossing)
            detail::throw_invalid(
                place,
                chain.density != nullptr
                    ? "the line density is too rough to follow up to critical height"
                    : "the tip weight is too great beside the chain's to follow up to critical height",
                crossing);
        return path.crossings();
    };
    if (kind_of(chain, 1, 0).is_bare()) {
        const auto crossings = place_of(1, count);
        for (Index j = 0; j < count; ++j) heights[j] = chain.length / crossings[static_cast<std::size_t>(j)].arc;
        return heights;
    }
    for (Index j = 1; j <= count; ++j) {
        const auto excess = [&](double height) {
            return std::log(place_of(height, j).back().arc * height / chain.length);
        };
        const double guess = j == 1 ? chain.length : heights[j - 2];
        heights[j - 1] =
            detail::zero_between(detail::sign_change_near(guess, excess), excess, {.value = 2 * epsilon<double>()});
    }
    return heights;
}

/// How many critical heights exceed `height`, by the same series. Throws InvalidArgument for a length above 1e6 heights
/// and for a density or a tip that the series cannot follow.
inline Index critical_heights_above(const ContinuousChain& chain, double height) {
    constexpr std::string_view place = "count_modes";
    const double length = length_in_heights(place, chain.length, height);
    const Path path = path_at_rest(chain, height, {.farthest = length});
    require_followed(place, path, length, height);
    return std::count_if(path.crossings().begin(), path.crossings().end(),
                         [&](const Path::Crossing& crossing) { return crossing.arc < length; });
}

/// One mode of small amplitude, by the same series. Cost: one path; of a place 1 microsecond, 10 with a density.
class CordModeShape {
   public:
    CordModeShape(const ContinuousChain& chain, double height, Index mode)
        : chain_(chain), height_(height), path_(path_at_rest(chain_, height, {.crossings = static_cast<int>(mode)})) {}

    /// Offset at a distance from the free end, where it is 1.
    double shape(double s) const { return state("CordModes::offset", s).offset; }
    /// d offset / ds, -1 / height at the free end.
    double slope(double s) const { return slope(state("CordModes::slope", s)); }
    /// Where the cord crosses the axis, ascending, the support left out.
    Vector<double> nodes() const {
        Vector<double> points(static_cast<Index>(path_.crossings().size()) - 1);
        for (Index i = 0; i < points.size(); ++i)
            points[i] = path_.crossings()[static_cast<std::size_t>(i)].arc * height_;
        return points;
    }
    /// Where it is vertical, one above each node: T y'' = -rho (y / height + y').
    Vector<double> vertical_points() const {
        return detail::zeros_between(nodes(), chain_.length, [&](double s) {
            const PathState at = state("CordModes::vertical_points", s);
            const double steep = slope(at), part = path_.kind().density_at(at.arc) / path_.kind().weight_below(at.arc);
            return std::pair(steep, -part * (at.offset / height_ + steep) / height_);
        });
    }

   private:
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
};

}  // namespace finite

/// All steady shapes of a cord at a speed, at any inclination. The straight one is left out, and of two mirror images
/// the one whose free end is at a negative offset. Where `complete` is false there may be more (see above).
///
/// Method: power series of order 24 in the time that makes the equations polynomials (`finite::PathSeries`), Newton's
/// method on the place of crossing j, its derivative by the series of the change; crossings told by quadrants within
/// every step.
/// Accuracy: inclinations, and offsets and heights over the length, within `error_bound`: measured against 22 digits
/// for length/height from 1.4458 to 1e4, tip weights to 1e3 and five densities, never above 0.6 of it. The bound is an
/// estimate, from how much the shape changes with its length and along it: 1.3e-13 at length/height 500 (measured
/// 3.4e-14, and 3e-16 for offsets), where the sharpest corner turns over a radian in a thousandth of the length; 3e-12
/// at 1e4 (7e-13). It grows near a critical height, where the amplitude is ill determined. `residual`: of the first
/// integral of the uniform chain, of the tension carried by its own series against that of its parts with a density.
/// Cost: a microsecond a step, four and more a half wave: 1.8 ms for the fourteen shapes at length/height 500
/// (bench/continuous.cpp); ten times that with a density, and `scanned` paths more.
/// Throws InvalidArgument unless exactly one of height and speed is given, positive and finite, for a length above 1e6
/// heights, for `scanned` below 1, for an exponent of the density above 20, and where the series cannot follow the cord
/// (tried: an exponent of 16 without a tip; a tip of 1e30 times the cord's weight).
CordShapes steady_shapes(const Cord& cord, const CordShapesOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/cord/steady_shapes.hpp"
#endif
