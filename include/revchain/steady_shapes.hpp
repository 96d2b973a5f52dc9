// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>
#include <optional>

#include "revchain/finite/balance/sweep.hpp"
#include "revchain/finite/shapes/scan.hpp"
#include "revchain/finite/shapes/several_inclinations.hpp"
#include "revchain/finite/shapes/steady_shape.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/numeric/double_double.hpp"

namespace revchain {

/// A range of inclinations of the lowest link, rad.
struct InclinationRange {
    double low, high;
};

struct SteadyShapesOptions {
    long budget = 3'000'000;   ///< links to look at, 0.5 microseconds each, 2 where l < a, more in two words
    bool hanging_only = true;  ///< only shapes with every link within a right angle of the downward vertical
};

/// The shapes found, and whether there are more.
struct SteadyShapes {
    std::vector<SteadyShape> shapes;          ///< by half waves, then inclination of the lowest link
    std::vector<InclinationRange> undecided;  ///< where there may be others; empty if the list is complete
    bool complete = false;                    ///< proved: no shape is missing
    long cells = 0;                           ///< looked at
};

namespace finite {

/// An upper end for the tangent of the lowest link: beyond it the free end would be farther from the axis than the chain
/// reaches.  y0 = lambda t + (a X/moment) s.
template <class T>
T farthest_tangent(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, bool either_posture = false,
                   OnAxis = {}) {
    Interval<T> reach(T(0));
    for (const Link<Interval<T>>& link : links) reach = reach + link.length;
    const Interval<T> turning = links[0].length * links[0].cross / links[0].moment;
    const Interval<T> beyond = hull(Interval<T>(T(0)), either_posture ? hull(turning, -turning) : -turning);
    return ((reach + Interval<T>(beyond.high)) / height).high;
}

/// Whether each link but the lowest has one inclination for what hangs below it: always where l <= a.
template <class T>
bool single_valued(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height) {
    return std::all_of(links.begin() + 1, links.end(), [&](const Link<Interval<T>>& link) {
        return grows_fast(height * link.pull, link.length * link.cross);
    });
}

inline bool hangs_at_one_inclination(const Links<Wide<double>>& links, const Interval<double>& height) {
    return single_valued(enclosed<double>(links.links), height);
}

/// Isolated in double, where that leaves cells open in two words; what the proof leaves open is scanned.
template <class AnyLinks>
Isolation<DoubleDouble> isolated(const AnyLinks& chain, const Wide<double>& height, double last,
                                 long links_to_look_at) {
    using Far = DoubleDouble;
    const long budget = links_to_look_at / static_cast<long>(chain.links.size());
    const auto narrow = swept_links<double>(chain);
    const Interval<double> lambda = enclosed<double>(height);
    const auto support = enclosed<double>(support_of(chain));
    const auto sign_at = [&](double t) { return detail::sign_at(narrow, lambda, t, support); };
    const int first_sign = support.is_symmetric() ? 0 : sign_at(0);
    const Isolation<double> first =
        detail::isolate<double>(narrow, lambda, {0.0, last, first_sign, sign_at(last)}, 1e-14, budget, support);
    Isolation<Far> found;
    found.cells = first.cells;
    for (const Bracket<double>& b : first.shapes) found.shapes.push_back({Far(b.low), Far(b.high)});
    if (first.undecided.empty()) return found;
    const auto wide = swept_links<Far>(chain);
    const Interval<Far> height_wide = enclosed<Far>(height);
    const auto support_wide = enclosed<Far>(support_of(chain));
    const auto wide_sign_at = [&](const Far& t) { return detail::sign_at(wide, height_wide, t, support_wide); };
    const std::size_t count = first.undecided.size();
    for (std::size_t i = 0, end = 0; i < count; i = end) {
        for (end = i + 1; end < count && first.undecided[end].low == first.undecided[end - 1].high;) ++end;
        const Far low(first.undecided[i].low), high(first.undecided[end - 1].high);  // cells that touch are one
        const int low_sign = low == Far(0) ? first_sign : wide_sign_at(low);
        const auto again = detail::isolate<Far>(wide, height_wide, {low, high, low_sign, wide_sign_at(high)},
                                                Far(1e-26), std::max(0L, budget - found.cells), support_wide);
        found.cells += again.cells;
        found.shapes.insert(found.shapes.end(), again.shapes.begin(), again.shapes.end());
        for (const Bracket<Far>& b : again.undecided) {
            if (!found.undecided.empty() && found.undecided.back().high == b.low)
                found.undecided.back().high = b.high;
            else
                found.undecided.push_back(b);
        }
    }
    if (found.undecided.empty()) return found;
    const auto more = scanned(found.undecided, last, std::min(8192L, budget / 4), [&](const Far& t) {
        const int sign = sign_at(static_cast<double>(t));
        return sign != 0 ? sign : wide_sign_at(t);
    });
    found.shapes.insert(found.shapes.end(), more.begin(), more.end());
    return found;
}

/// A shape and the tangent of its lowest link.
struct Finished {
    Balanced<Wide<double>> shape;
    Wide<double> tangent;
};

/// The one shape whose lowest tangent lies in the bracket, if Newton's method finds it there.
template <class AnyLinks>
std::optional<Finished> finished(const AnyLinks& chain, const Wide<double>& height,
                                 const Bracket<DoubleDouble>& bracket) {
    using S = Wide<double>;
    const std::vector<Link<S>>& links = chain.links;
    const auto support = support_of(chain);
    S low = bracket.low.word(), high = bracket.high.word();
    const auto falls_short = [&](const S& t) { return missed(links, height, t, support) < S(0); };
    const bool rises = falls_short(low);
    const auto halve = [&]() {
        const S middle = low + (high - low) * S(0.5);
        (falls_short(middle) == rises ? low : high) = middle;
        return middle;
    };
    for (int round = 0; round < 16; ++round) {
        auto found = balance(links, height, swept(links, height, halve()), 60, {}, support);
        if (found.converged) {
            const S tangent = detail::tangent_in(found, links, 0);
            if (bracket.low.word() < tangent && tangent < bracket.high.word())
                return Finished{std::move(found), tangent};
        }
        for (int i = 0; i < 6; ++i) halve();
    }
    return std::nullopt;
}

/// How far the inclinations of what Newton's method found may be from those of the shape in the bracket, rad: signs of the
/// support's offset on both sides of its lowest tangent, as near as two words can tell, and what all links then may do.
template <class End>
double inclination_error(const std::vector<Link<Interval<DoubleDouble>>>& links, const Wide<double>& height,
                         const Bracket<DoubleDouble>& bracket, const Finished& found,
                         const std::vector<Link<Wide<double>>>& middle, const End& support) {
    using Far = DoubleDouble;
    const Interval<Far> lambda = enclosed<Far>(height);
    const Far tangent(found.tangent);
    Far reach = abs(tangent) * Far(1e-28) + Far(1e-290);
    for (int round = 0;; ++round, reach = reach * Far(16)) {
        const bool far = round == 300;  // 16^300 overflows
        const Far low = far ? bracket.low : std::max(bracket.low, tangent - reach);
        const Far high = far ? bracket.high : std::min(bracket.high, tangent + reach);
        const bool whole = low == bracket.low && high == bracket.high;
        const auto sign_at = [&](const Far& t) { return detail::sign_at(links, lambda, t, support); };
        if (!far && !whole && sign_at(low) * sign_at(high) != -1) continue;
        std::vector<Interval<Far>> tangents;
        detail::support_offset(links, lambda, Interval<Far>(low, high), &tangents);
        double worst = 0;
        for (std::size_t m = 0; m < tangents.size(); ++m) {
            const Far t(detail::tangent_in(found.shape, middle, m));
            const Interval<Far> both = hull(tangents[m], Interval<Far>(t));
            const double near = both.may_vanish() ? 0.0 : static_cast<double>(std::min(abs(both.low), abs(both.high)));
            const double change =
                static_cast<double>(std::max(abs(both.high - t), abs(t - both.low))) / (1 + near * near);
            worst = std::max(worst, change == change ? change : std::numeric_limits<double>::infinity());
        }
        return worst * 1.01;
    }
}

/// A bracket of a shape, halved by proved signs until rounding leaves a sign open.
template <class End>
Bracket<DoubleDouble> narrowed(const std::vector<Link<Interval<DoubleDouble>>>& links,
                               const Interval<DoubleDouble>& lambda, const End& support,
                               Bracket<DoubleDouble> bracket) {
    using Far = DoubleDouble;
    const int low_sign = detail::sign_at(links, lambda, bracket.low, support);
    for (int round = 0; round < 200; ++round) {
        const Far middle = Interval<Far>(bracket.low, bracket.high).middle();
        const int sign = detail::sign_at(links, lambda, middle, support);
        if (sign == 0 || !(bracket.low < middle && middle < bracket.high)) break;
        (sign == low_sign ? bracket.low : bracket.high) = middle;
    }
    return bracket;
}

/// A shape whose links are too near the horizontal for `finished`: found from the tangents of all links in a `part` of
/// the bracket. Nothing if it cannot be proved.
template <class AnyLinks>
std::optional<Settled> finished_by_tangents(const AnyLinks& chain, const Wide<double>& height,
                                            const Bracket<DoubleDouble>& bracket, const Bracket<DoubleDouble>& part) {
    using Far = DoubleDouble;
    const auto links = swept_links<Far>(chain);
    const auto lambda = enclosed<Far>(height);
    const auto support = enclosed<Far>(support_of(chain));
    Box<Far> near;
    detail::support_offset(links, lambda, Interval<Far>(part.low, part.high), &near, support);
    const WholeBalance balance(links, lambda, posture_of(chain), support);
    auto found = detail::settled(chain, height, balance, near);
    if (!found) return std::nullopt;
    const Far tangent = abs(Far(detail::tangent_in(found->shape, chain.links, 0)));
    const bool inside = abs(bracket.low) <= tangent && tangent <= abs(bracket.high);
    return inside ? std::move(found) : std::nullopt;
}

template <class AnyLinks>
void add(const AnyLinks& links, const Wide<double>& height, const Settled& settled, SteadyShapes& result) {
    result.shapes.push_back(described(links, height, settled.shape));
    result.shapes.back().error_bound = settled.error, result.shapes.back().condition = settled.condition;
}

/// Of the lists made one link at a time, where each hangs at one inclination.
template <class AnyLinks>
void add_single_valued(const AnyLinks& links, const Wide<double>& height, double last, long budget,
                       SteadyShapes& result) {
    const auto narrow = swept_links<DoubleDouble>(links);
    const auto support = enclosed<DoubleDouble>(support_of(links));
    const auto isolation = isolated(links, height, last, budget);
    result.cells = isolation.cells;
    const auto leave_open = [&](const Bracket<DoubleDouble>& b) {
        const auto inclination = [](const DoubleDouble& t) { return std::atan(static_cast<double>(t)); };
        result.undecided.push_back({inclination(b.low), inclination(b.high)});
    };
    for (const auto& bracket : isolation.undecided) leave_open(bracket);
    for (const auto& bracket : isolation.shapes) {
        const std::size_t before = result.shapes.size();
        if (auto found = finished(links, height, bracket)) {
            SteadyShape& shape = result.shapes.emplace_back(
                verified_shape(links, narrow, height, enclosed<DoubleDouble>(height), found->shape, true));
            if (shape.error_bound <= 0x1.8p-52) continue;
            // all but horizontal, or all but critical: the sweep may say more
            const double error = inclination_error(narrow, height, bracket, *found, links.links, support) + 0x1p-52;
            if (error < shape.error_bound) {
                const double condition = shape.condition;
                turn_outwards(found->shape, support);
                shape = described(links, height, found->shape);
                shape.error_bound = error, shape.condition = condition;
            }
            if (shape.error_bound < 0x1p-48) continue;
        }
        // or the tangents
        const auto part = narrowed(narrow, enclosed<DoubleDouble>(height), support, bracket);
        if (const auto settled = finished_by_tangents(links, height, bracket, part)) {
            result.shapes.resize(before);
            add(links, height, *settled, result);
        } else if (result.shapes.size() == before) {
            leave_open(part);
        }
    }
}

/// And of the others.
template <class AnyLinks>
void add_several_valued(const AnyLinks& links, const Wide<double>& height, double last,
                        const SteadyShapesOptions& options, SteadyShapes& result) {
    const auto found = several_inclinations(links, height, last, options.hanging_only,
                                            options.budget / static_cast<long>(links.links.size()));
    result.cells = found.cells;
    for (const Settled& settled : found.shapes) add(links, height, settled, result);
    for (const auto& part : found.open) {
        const double low = std::atan(part.low), high = std::atan(part.high);
        if (part.lowest == Posture::hangs)
            result.undecided.push_back({low, high});
        else
            result.undecided.push_back({std::numbers::pi - high, std::numbers::pi - low});
    }
}

inline void sort(SteadyShapes& found) {
    std::sort(found.shapes.begin(), found.shapes.end(), [](const SteadyShape& x, const SteadyShape& y) {
        return x.half_waves != y.half_waves ? x.half_waves < y.half_waves : x.inclination[0] < y.inclination[0];
    });
    found.complete = found.undecided.empty();
}

/// All shapes at a height in the units of the links.
template <class AnyLinks>
SteadyShapes listed(const AnyLinks& links, const Wide<double>& scaled, const SteadyShapesOptions& options) {
    SteadyShapes result;
    // A little beyond: a link all but horizontal is at the end itself, to rounding.
    const double last = 1.01 * farthest_tangent(swept_links<double>(links), enclosed<double>(scaled),
                                                !options.hanging_only, enclosed<double>(support_of(links)));
    if (!(static_cast<double>(scaled) >= 0x1p-50 && last < 0x1p960)) {
        result.undecided.push_back({0, options.hanging_only ? std::numbers::pi / 2 : std::numbers::pi});
        return result;
    }
    if (options.hanging_only && hangs_at_one_inclination(links, enclosed<double>(scaled)))
        add_single_valued(links, scaled, last, options.budget, result);
    else
        add_several_valued(links, scaled, last, options, result);
    sort(result);
    return result;
}

inline SteadyShapes steady_shapes(const Chain<double>& chain, const Wide<double>& height,
                                  const SteadyShapesOptions& options) {
    const auto links = links_of(chain);
    return listed(links, ldexp(height, -links.units.length_exponent), options);
}

}  // namespace finite

/// All hanging shapes (every link within a right angle of the downward vertical) of a chain that whirls steadily at the
/// speed of conical height `height`, or all shapes in any posture; straight ones left out, of two mirror images that with
/// the free end at a positive offset (if it is on the axis, the lowest link that is inclined).
///
/// Method: the offset of the support as a function of the lowest link's tangent, Greenhill (1908) §8 (4), (12), in interval
/// arithmetic with first and second derivatives, 0 ... the farthest tangent split until every part holds no zero or one;
/// Newton's method and then Krawczyk's test on all pins in two words. Links that stand, or hang at several inclinations
/// under one load (l > a and lambda <= W h (l - a)/(W h + a S)), are followed along each of them; there a part ends in a
/// box about the tangents of all links that is proved to hold no zero or one (Krawczyk).
/// Accuracy: every inclination within `error_bound`, proved: mostly 2.3e-16 (4.4e-16 of links that stand), and 2 ulp of
/// itself (measured). `complete` is proved too. Where it is false, `undecided` says where shapes may be missing: at exactly
/// a critical speed or a fold, where the budget ends, as it does for chains of 20 links and more at heights of some
/// 1/300 of their length; those that a scan finds there all the same are in the list (where links hang at one inclination).
/// At heights below 2^-50 (9e-16) of the longest length (rounded up to a power of 2) nothing is listed and `complete`
/// is false: a sideways pull is an offset over the height, and two words hold offsets to 2^-104 of that length. Below
/// that, tensions would lose their digits.
/// Cost: 10 to 500 cells for a shape: 84 shapes of eight plummets take 15 ms, 6466 of twelve 1.3 s, the first of 1000
/// plummets 0.02 s. In any posture, heights down to 1e-3 of the length: all shapes of three links 1 to 5 ms, of four (64 of
/// equal plummets) 4 to 70 ms, 868 of six plummets 0.6 s, 11008 of eight 11 s.
/// No shape in any posture exists above the first critical height: with E = +-1 for the postures and D = lambda diag(kappa
/// |sec d|) > G, E D s = G s would give |E w| = |D^-1/2 G D^-1/2 w| < |w|.
/// Throws InvalidArgument for a height not positive and finite.
inline SteadyShapes steady_shapes(const Chain<double>& chain, double height, const SteadyShapesOptions& options = {}) {
    detail::require_positive("steady_shapes", "conical height", height);
    return finite::steady_shapes(chain, Wide<double>(height), options);
}

/// The same at an angular speed n, lambda = g/n^2 in two words.
inline SteadyShapes steady_shapes_at_speed(const Chain<double>& chain, double angular_speed,
                                           double gravity = conical_pendulum::standard_gravity,
                                           const SteadyShapesOptions& options = {}) {
    detail::require_positive("steady_shapes_at_speed", "angular speed", angular_speed);
    detail::require_positive("steady_shapes_at_speed", "gravity", gravity);
    constexpr double least = std::numeric_limits<double>::min();
    const double near = gravity / angular_speed / angular_speed;
    if (near > std::numeric_limits<double>::max() / 4) {  // far above any critical height
        SteadyShapes none;
        none.complete = true;
        return none;
    }
    if (near < least / epsilon<double>()) return steady_shapes(chain, std::max(near, least), options);
    return finite::steady_shapes(chain, finite::height_at_speed(angular_speed, gravity), options);
}

}  // namespace revchain
