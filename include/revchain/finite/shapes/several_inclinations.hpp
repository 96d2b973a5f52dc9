// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/newton.hpp"
#include "revchain/finite/shapes/posture_search.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

struct ProvedShape {
    Balanced<Fine> shape;
    double error = 0;      ///< of every inclination, rad
    double condition = 0;  ///< as returned by WholeBalance::condition
};

/// Steady shapes with links that stand or have several inclinations under one load.
struct SeveralInclinations {
    std::vector<ProvedShape> shapes;
    struct Open {
        Posture lowest;
        double low, high;  ///< tangents of the lowest link in that posture
    };
    std::vector<Open> open;
    long cells = 0;
};

/// Returns a box with exactly one zero, known in double, as small as double-double allows.
template <class End>
std::optional<TangentBox<Far>> sharpened(const WholeBalance<Far, End>& balance,
                                         const TangentBox<Far>& near) {
    std::vector<Far> t = middle_of(near);
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 20; ++round) {
        const auto change = balance.improve(t);
        if (!change) return std::nullopt;
        if (*change < 1e-30 || (*change < 1e-20 && !(*change < 0.25 * last))) break;
        last = *change;
    }
    TangentBox<Far> point(t.begin(), t.end());
    const auto first = balance.narrowed(point);
    if (!first) return std::nullopt;
    TangentBox<Far> box(t.size());
    for (Far factor(4); factor < Far(1e20); factor = factor * Far(16)) {
        for (std::size_t m = 0; m < t.size(); ++m) {
            const Far off =
                factor * (std::max(abs((*first)[m].low - t[m]), abs((*first)[m].high - t[m])) +
                          Far(1e-31) * abs(t[m]) + Far(1e-290));
            box[m] = {t[m] - off, t[m] + off};
        }
        const auto narrow = balance.narrowed(box);
        if (narrow && strictly_within(*narrow, box)) return narrow;
    }
    return std::nullopt;
}

/// Returns true if offsets found by Newton's method are those of a box's zero (and its `offset`).
REVCHAIN_LAZY
bool agrees(const std::vector<Link<Fine>>& links, const Balanced<Fine>& found,
            const TangentBox<Far>& box, const std::vector<Fine>& offset) {
    for (std::size_t m = 0; m < offset.size(); ++m) {
        const double off = as_double(abs(found.offset[m] - offset[m]));
        if (!(off <= 1e-18 * as_double(abs(offset[m]) + links[std::min(m, box.size() - 1)].length)))
            return false;
    }
    for (std::size_t m = 0; m < box.size(); ++m) {
        const Far t(tangent_in(found, links, m));
        const double size = std::abs(as_double(t));
        const double off = as_double(std::max(box[m].low - t, t - box[m].high)) / (1 + size * size);
        if (!(off <= 1e-18 * std::min(1.0, size))) return false;
    }
    return true;
}

/// Returns a shape from the tangents of its links, or its mirror image if that is a shape too. The
/// free end (or, if that is on the axis, the lowest inclined link) is at a positive offset.
template <class AnyLinks, class End>
std::optional<ProvedShape> proved_shape(const AnyLinks& chain, const Fine& height,
                                        const WholeBalance<Far, End>& balance,
                                        const TangentBox<Far>& near) {
    const std::vector<Link<Fine>>& links = chain.links;
    auto box = sharpened(balance, near);
    if (!box) return std::nullopt;
    const auto condition = balance.condition(middle_of(*box));
    if (!condition) return std::nullopt;
    const std::size_t n = links.size();
    std::vector<Fine> offset(n + 1, Fine(0));
    if constexpr (is_support<End>) {
        std::vector<Span> sines;
        for (std::size_t m = 0; m < n; ++m) sines.push_back(balance.sine(m, (*box)[m].middle()));
        offset[n] = balance.top(sines).middle().word();
        chain.turn(*box);
    }
    Fine lowest_inclined(0);
    for (std::size_t m = n; m-- > 0;) {
        const Fine sine = balance.sine(m, Span((*box)[m].middle())).middle().word();
        offset[m] = offset[m + 1] + links[m].length * sine;
        if (!(*box)[m].contains(Far(0))) lowest_inclined = sine;
    }
    ProvedShape result;
    result.condition = *condition;
    result.shape = finite::balance(links, height, offset, balance.posture(), chain.upper_end());
    if (!result.shape.converged || !agrees(links, result.shape, *box, offset)) {
        result.shape = {std::move(offset), balance.posture(), true, {}};
        for (const Far& tangent : middle_of(*box)) result.shape.tangent.push_back(tangent.word());
    }
    const Fine tip = result.shape.offset[0];
    const bool inwards =
        abs(tip) > Fine(1e-25) * links[0].length ? tip < Fine(0) : lowest_inclined < Fine(0);
    if (inwards && balance.is_symmetric()) result.shape.mirror();
    for (std::size_t m = 0; m < n; ++m) {
        const double middle = as_double((*box)[m].middle()), width = as_double((*box)[m].width());
        const double rounded = result.shape.stands(m) ? 0x1p-51 : 0x1p-52;
        result.error = std::max(result.error, width * 1.01 / (1 + middle * middle) + rounded);
    }
    return result;
}

/// Adds all shapes in one posture, found in double and, for open parts, in double-double.
template <class AnyLinks>
void search_posture(const AnyLinks& chain, const Fine& height, const std::vector<Posture>& posture,
                    double last, long budget, SeveralInclinations& result) {
    const std::size_t n = posture.size();
    const auto cube = static_cast<long>(n * n * n);
    result.cells += cube / 256;
    if (cube >= 256 && result.cells >= budget) {  // the budget is below one test of the chain
        result.open.push_back({posture[0], 0.0, last});
        return;
    }
    const auto narrow = chain.template links_for_sweep<double>();
    const auto wide = chain.template links_for_sweep<Far>();
    const auto support = chain.upper_end();
    PostureSearch first(narrow, enclosed<double>(height), posture, enclosed<double>(support));
    auto choice = first.first_choice();
    do {
        result.cells += first.search({choice, 0.0, last}, last, 1e-14, budget - result.cells);
    } while (result.cells < budget && first.next_choice(choice));
    if (result.cells >= budget) result.open.push_back({posture[0], 0.0, last});
    PostureSearch second(wide, enclosed<Far>(height), posture, enclosed<Far>(support), first);
    for (const auto& part : joined(first.open()))
        result.cells += second.search({part.choice, Far(part.low), Far(part.high)}, Far(last),
                                      Far(1e-26), budget - result.cells);
    const auto leave_open = [&](const Far& low, const Far& high) {
        result.open.push_back({posture[0], as_double(low), as_double(high)});
    };
    for (const auto& part : second.open()) leave_open(part.low, part.high);
    for (const auto& zero : second.zeros()) {
        if (zero.straight) continue;
        if (auto shape = proved_shape(chain, height, second.balance(), zero.near))
            result.shapes.push_back(std::move(*shape));
        else
            leave_open(zero.near[0].low, zero.near[0].high);
    }
}

/// Returns shapes with all links hanging (a rig: in its own posture) or also with any of them
/// standing.
template <class AnyLinks>
SeveralInclinations several_inclinations(const AnyLinks& chain, const Fine& height, double last,
                                         bool hanging_only, long budget) {
    const std::size_t n = chain.links.size();
    SeveralInclinations result;
    std::vector<Posture> posture =
        hanging_only ? chain.postures() : std::vector<Posture>(n, Posture::hangs);
    const auto next = [&] {
        std::size_t m = 0;
        while (m < n && posture[m] == Posture::stands) posture[m++] = Posture::hangs;
        if (m < n) posture[m] = Posture::stands;
        return m < n && (chain.may_all_stand() ||
                         std::any_of(posture.begin(), posture.end(),
                                     [](Posture p) { return p == Posture::hangs; }));
    };
    do {
        search_posture(chain, height, posture, last, budget, result);
    } while (!hanging_only && result.cells < budget && next());
    return result;
}

}  // namespace revchain::finite
