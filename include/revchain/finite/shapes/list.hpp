// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "revchain/finite/balance/sweep.hpp"
#include "revchain/finite/shapes/described.hpp"
#include "revchain/finite/shapes/isolation.hpp"
#include "revchain/finite/shapes/several_inclinations.hpp"
#include "revchain/finite/shapes/tangent_limit.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/thorough.hpp"

/// Finds the list of all steady shapes at a height; see revchain/steady_shapes.hpp. The unknown is
/// the tangent of the lowest link's inclination. `Means` is `Thorough` or `UsualMeans`
/// (revchain/thorough.hpp). Shapes are computed in `Fine` numbers and proved in `Far` ones
/// (finite/balance/links.hpp).
namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns true if each link but the lowest has one inclination under its load; always if l <= a.
template <class T>
bool single_valued(const EnclosedLinks<T>& links, const Interval<T>& height) {
    return std::all_of(links.begin() + 1, links.end(), [&](const Link<Interval<T>>& link) {
        return grows_fast(height * link.pull, turning_of(link));
    });
}

/// Returns true if all links hang, each at one inclination.
template <class AnyLinks>
bool hangs_at_one_inclination(const AnyLinks& links, const Interval<double>& height) {
    const auto postures = links.postures();
    for (std::size_t m = 0; m < postures.size(); ++m)
        if (postures[m] == Posture::stands || links.turned(m)) return false;
    return single_valued(links.template links_for_sweep<double>(), height);
}

/// Returns true if every shape lies in a plane with the axis. Another shape has a link that leans
/// to any side under no load, lambda pull + length cross cos = 0 (standing: -). The lowest link and
/// the topmost one of a firm support on the axis are in the plane of the others even then.
template <class AnyLinks, class Options>
bool lies_in_a_plane(const AnyLinks& links, const Interval<double>& height,
                     const Options& options) {
    const auto swept = links.template links_for_sweep<double>();
    const auto postures = links.postures();
    const auto& end = links.upper_end();
    const std::size_t last = end.is_symmetric() && !end.yields() ? swept.size() - 1 : swept.size();
    for (std::size_t m = 1; m < last; ++m) {
        const Interval<double> stiffness = height * swept[m].pull, turning = turning_of(swept[m]);
        const bool hangs = postures[m] == Posture::hangs;
        if ((hangs || !options.hanging_only) && !is_positive(stiffness + turning)) return false;
        if ((!hangs || !options.hanging_only) && !is_positive(stiffness - turning)) return false;
    }
    return true;
}

/// Returns brackets of shapes in ranges of tangents for which a proof of completeness failed. There
/// is at least one shape between two tangents at which `sign(tangent)`, the sign of the support's
/// offset, is certain and opposite. The sign is sampled at the ends of the ascending `ranges`, and
/// at those of `points` tangents between 0 and `last` that lie in a range. A third of these points
/// are evenly spaced in the inclination, a third in the tangent, and a third in its logarithm; the
/// last third begins at the tangent 1e-12 times `last`.
template <Real T, class Sign>
std::vector<Bracket<T>> scanned(const std::vector<Bracket<T>>& ranges, double last, long points,
                                const Sign& sign) {
    std::vector<double> tangents;
    const double steepest = std::atan(last), third = as_double(points / 3);
    for (double i = 0.5; i < third; ++i) {
        tangents.push_back(std::tan(steepest * i / third));
        tangents.push_back(last * i / third);
        tangents.push_back(last * std::pow(10.0, -12 * i / third));
    }
    std::sort(tangents.begin(), tangents.end());
    std::vector<Bracket<T>> found;
    auto next = tangents.begin();
    for (const Bracket<T>& range : ranges) {
        next = std::upper_bound(next, tangents.end(), as_double(range.low));
        T seen_at{};
        int seen = 0;
        const auto note = [&](const T& t) {
            detail::check_interrupt();
            const int here = t > T(0) ? sign(t) : 0;
            if (here == 0) return;
            if (here == -seen) found.push_back({seen_at, t});
            seen = here, seen_at = t;
        };
        note(range.low);
        for (; next != tangents.end() && T(*next) < range.high; ++next) note(T(*next));
        note(range.high);
    }
    return found;
}

/// Isolates shapes with tangents up to `last` in double, and undecided cells in double-double.
/// Cells that remain undecided are also scanned. `budget` limits the number of link evaluations.
template <class AnyLinks>
Isolation<Far> isolated(const AnyLinks& chain, const Fine& height, double last, long budget) {
    const long most_cells = budget / static_cast<long>(chain.links.size());
    const auto links = chain.template links_for_sweep<double>();
    const Interval<double> lambda = enclosed<double>(height);
    const auto support = enclosed<double>(chain.upper_end());
    const Isolation<double> first =
        isolate<double>(links, lambda, {0.0, last}, 1e-14, most_cells, support);
    Isolation<Far> found;
    found.cells = first.cells;
    for (const Bracket<double>& b : first.shapes) found.shapes.push_back({Far(b.low), Far(b.high)});
    if (first.undecided.empty()) return found;
    const auto far_links = chain.template links_for_sweep<Far>();
    const Span far_lambda = enclosed<Far>(height);
    const auto far_support = enclosed<Far>(chain.upper_end());
    for (const Bracket<double>& open : joined(first.undecided)) {
        const auto again =
            isolate<Far>(far_links, far_lambda, {Far(open.low), Far(open.high)}, Far(1e-26),
                         std::max(0L, most_cells - found.cells), far_support);
        found.cells += again.cells;
        found.shapes.insert(found.shapes.end(), again.shapes.begin(), again.shapes.end());
        found.undecided.insert(found.undecided.end(), again.undecided.begin(),
                               again.undecided.end());
    }
    if (found.undecided.empty()) return found;
    found.undecided = joined(found.undecided);
    const auto more =
        scanned(found.undecided, last, std::min(8192L, most_cells / 4), [&](const Far& t) {
            const int sign = sign_at(links, lambda, as_double(t), support);
            return sign != 0 ? sign : sign_at(far_links, far_lambda, t, far_support);
        });
    found.shapes.insert(found.shapes.end(), more.begin(), more.end());
    return found;
}

/// Returns the shape whose lowest link has a tangent in the bracket, if Newton's method finds it.
template <class AnyLinks>
std::optional<Balanced<Fine>> shape_by_newton(const AnyLinks& chain, const Fine& height,
                                              const Bracket<Far>& bracket) {
    const std::vector<Link<Fine>>& links = chain.links;
    const auto support = chain.upper_end();
    Fine low = bracket.low.word(), high = bracket.high.word();
    const auto falls_short = [&](const Fine& t) {
        return support_offset(links, height, t, support) < Fine(0);
    };
    const bool rises = falls_short(low);
    const auto halve = [&]() {
        const Fine middle = low + (high - low) * Fine(0.5);
        (falls_short(middle) == rises ? low : high) = middle;
        return middle;
    };
    for (int round = 0; round < 16; ++round) {
        auto found = balance(links, height, swept(links, height, halve()), {}, support);
        if (found.converged) {
            const Fine tangent = tangent_in(found, links, 0);
            if (bracket.low.word() < tangent && tangent < bracket.high.word()) return found;
        }
        for (int i = 0; i < 6; ++i) halve();
    }
    return std::nullopt;
}

/// Returns a bound on the error (rad) of inclinations found by Newton's method. The tangent of the
/// lowest link is enclosed by two tangents at which the support's offset has opposite signs: the
/// nearest pair that is proved, or the ends of the bracket. The sweep then encloses all others.
template <class End>
double inclination_error(const EnclosedLinks<Far>& enclosed_links, const Fine& height,
                         const Bracket<Far>& bracket, const Balanced<Fine>& found,
                         const std::vector<Link<Fine>>& links, const End& support) {
    const Span lambda = enclosed<Far>(height);
    const Far tangent(tangent_in(found, links, 0));
    Far margin = abs(tangent) * Far(1e-28) + Far(1e-290);
    for (int round = 0;; ++round, margin = margin * Far(16)) {
        const bool given_up = round == 300;  // the margin has overflowed: the bracket is taken
        const Far low = given_up ? bracket.low : std::max(bracket.low, tangent - margin);
        const Far high = given_up ? bracket.high : std::min(bracket.high, tangent + margin);
        const bool whole = low == bracket.low && high == bracket.high;
        const auto sign = [&](const Far& t) { return sign_at(enclosed_links, lambda, t, support); };
        if (!given_up && !whole && sign(low) * sign(high) != -1) continue;
        std::vector<Span> tangents;
        support_offset(enclosed_links, lambda, Span(low, high), OnAxis{}, &tangents);
        double worst = 0;
        for (std::size_t m = 0; m < tangents.size(); ++m) {
            const Far t(tangent_in(found, links, m));
            const Span both = hull(tangents[m], Span(t));
            const double near =
                both.may_vanish() ? 0.0 : as_double(std::min(abs(both.low), abs(both.high)));
            const double change =
                as_double(std::max(abs(both.high - t), abs(t - both.low))) / (1 + near * near);
            worst = std::max(worst,
                             change == change ? change : std::numeric_limits<double>::infinity());
        }
        return worst * 1.01;
    }
}

/// Halves a bracket of a shape by proved signs until rounding leaves a sign undecided.
template <class End>
Bracket<Far> narrowed(const EnclosedLinks<Far>& links, const Span& lambda, const End& support,
                      Bracket<Far> bracket) {
    const int low_sign = sign_at(links, lambda, bracket.low, support);
    for (int round = 0; round < 200; ++round) {
        const Far middle = Span(bracket.low, bracket.high).middle();
        const int sign = sign_at(links, lambda, middle, support);
        if (sign == 0 || !(bracket.low < middle && middle < bracket.high)) break;
        (sign == low_sign ? bracket.low : bracket.high) = middle;
    }
    return bracket;
}

/// Returns a shape with links too near the horizontal for `shape_by_newton`, from the tangents of
/// all links in a `part` of the bracket; none if it cannot be proved.
template <class AnyLinks>
std::optional<ProvedShape> shape_by_tangents(const AnyLinks& chain, const Fine& height,
                                             const Bracket<Far>& bracket,
                                             const Bracket<Far>& part) {
    const auto links = chain.template links_for_sweep<Far>();
    const auto lambda = enclosed<Far>(height);
    const auto support = enclosed<Far>(chain.upper_end());
    TangentBox<Far> near;
    support_offset(links, lambda, Span(part.low, part.high), support, &near);
    const WholeBalance balance(links, lambda, chain.postures(), support);
    auto found = proved_shape(chain, height, balance, near);
    if (!found) return std::nullopt;
    const Far tangent = abs(Far(tangent_in(found->shape, chain.links, 0)));
    const bool inside = abs(bracket.low) <= tangent && tangent <= abs(bracket.high);
    return inside ? std::move(found) : std::nullopt;
}

template <class AnyLinks, class Result>
void add(const AnyLinks& links, const Fine& height, const ProvedShape& proved, Result& result) {
    using Shape = typename decltype(result.shapes)::value_type;
    result.shapes.push_back(described<Shape>(links, height, proved.shape));
    result.shapes.back().error_bound = proved.error,
    result.shapes.back().condition = proved.condition;
}

template <class Result>
void leave_open(const Bracket<Far>& part, Result& result) {
    const auto inclination = [](const Far& t) { return std::atan(as_double(t)); };
    result.undecided.push_back({inclination(part.low), inclination(part.high)});
}

/// Returns true if a link is so near the horizontal that the offset of a support on a spring may be
/// wrong. Offsets in double-double give a tangent t, and with it the force on the spring, with a
/// relative error of 1e-32 t^2. Up to t = 1e8 this is at most 1e-16, a rounding in double.
REVCHAIN_LAZY
bool is_all_but_level(const std::vector<Link<Fine>>& links, const Balanced<Fine>& found) {
    for (std::size_t m = 0; m < links.size(); ++m)
        if (std::abs(as_double(tangent_in(found, links, m))) > 1e8) return true;
    return false;
}

/// Adds the shape in the bracket to an empty `result`, or leaves the bracket open.
template <class Means, class AnyLinks, class Result>
void add_isolated(const AnyLinks& links, const EnclosedLinks<Far>& enclosed_links,
                  const Fine& height, const Bracket<Far>& bracket, Result& result) {
    using Shape = typename decltype(result.shapes)::value_type;
    const auto support = enclosed<Far>(links.upper_end());
    if (auto found = shape_by_newton(links, height, bracket)) {
        Shape& shape = result.shapes.emplace_back(verified_shape<Shape>(
            links, enclosed_links, height, enclosed<Far>(height), *found, true));
        if (shape.error_bound <= 0x1.8p-52) return;
        // with an almost level link, or near a critical height, the sweep may bound it better
        const double error =
            inclination_error(enclosed_links, height, bracket, *found, links.links, support) +
            0x1p-52;
        if (error < shape.error_bound) {
            const double condition = shape.condition;
            turn_outwards(*found, support);
            shape = described<Shape>(links, height, *found);
            shape.error_bound = error, shape.condition = condition;
        }
        if (shape.error_bound < 0x1p-48 &&
            !(support.yields() && is_all_but_level(links.links, *found)))
            return;
    }
    const auto part = narrowed(enclosed_links, enclosed<Far>(height), support, bracket);
    if constexpr (detail::is_thorough<Means>) {
        if (const auto proved = shape_by_tangents(links, height, bracket, part)) {
            result.shapes.clear();
            add(links, height, *proved, result);
        }
    }
    if (result.shapes.empty()) leave_open(part, result);
}

/// Adds all shapes with tangents up to `last` if each link has one inclination under its load.
/// `budget` limits the number of link evaluations.
template <class Means, class AnyLinks, class Result>
void add_single_valued(const AnyLinks& links, const Fine& height, double last, long budget,
                       Result& result) {
    const auto enclosed_links = links.template links_for_sweep<Far>();
    const auto isolation = isolated(links, height, last, budget);
    result.cells = isolation.cells;
    for (const auto& bracket : isolation.undecided) leave_open(bracket, result);
    std::vector<Result> each(isolation.shapes.size());
    detail::parallel_for(each.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            detail::check_interrupt();
            add_isolated<Means>(links, enclosed_links, height, isolation.shapes[i], each[i]);
        }
    });
    for (Result& one : each) {
        std::move(one.shapes.begin(), one.shapes.end(), std::back_inserter(result.shapes));
        result.undecided.insert(result.undecided.end(), one.undecided.begin(), one.undecided.end());
    }
}

/// Adds all shapes with tangents up to `last` if links may have several inclinations.
template <class AnyLinks, class Options, class Result>
void add_several_valued(const AnyLinks& links, const Fine& height, double last,
                        const Options& options, Result& result) {
    const auto found = several_inclinations(links, height, last, options.hanging_only,
                                            options.budget / static_cast<long>(links.links.size()));
    result.cells = found.cells;
    for (const ProvedShape& proved : found.shapes) add(links, height, proved, result);
    for (const auto& part : found.open) {
        const double low = std::atan(part.low), high = std::atan(part.high);
        if (part.lowest == Posture::hangs)
            result.undecided.push_back({low, high});
        else
            result.undecided.push_back({std::numbers::pi - high, std::numbers::pi - low});
    }
}

template <int = 0>
[[noreturn]] void throw_not_thorough(std::string_view where, double height) {
    detail::throw_invalid(
        where,
        "each link must hang, at one inclination under its load, unless revchain::thorough is the "
        "last argument; at this conical height one may not",
        height);
}

template <class Result>
void conclude(Result& found) {
    const auto order = [](const auto& x) { return std::pair(x.half_waves, x.inclination[0]); };
    const auto before = [&](const auto& x, const auto& y) { return order(x) < order(y); };
    std::sort(found.shapes.begin(), found.shapes.end(), before);
    found.complete = found.undecided.empty();
}

/// Returns all shapes at a height `scaled` to the unit of the links. Throws InvalidArgument where
/// links stand or have several inclinations, unless the means are `Thorough`.
template <class Result, class Means, class AnyLinks, class Options>
Result listed(const AnyLinks& links, const Fine& scaled, const Options& options) {
    Result result;
    // The range ends slightly beyond the limit: an almost horizontal link is at the limit, to
    // rounding.
    const double last =
        1.01 * tangent_limit(links.template links_for_sweep<double>(), enclosed<double>(scaled),
                             !options.hanging_only, enclosed<double>(links.upper_end()));
    if (!(as_double(scaled) >= 0x1p-50 && last < 0x1p960)) {
        result.undecided.push_back(
            {0, options.hanging_only ? std::numbers::pi / 2 : std::numbers::pi});
        return result;
    }
    if (options.hanging_only && hangs_at_one_inclination(links, enclosed<double>(scaled)))
        add_single_valued<Means>(links, scaled, last, options.budget, result);
    else if constexpr (detail::is_thorough<Means>)
        add_several_valued(links, scaled, last, options, result);
    else
        throw_not_thorough("steady_shapes",
                           std::ldexp(as_double(scaled), links.units.length_exponent));
    conclude(result);
    result.complete &= lies_in_a_plane(links, enclosed<double>(scaled), options);
    return result;
}

}  // namespace revchain::finite
