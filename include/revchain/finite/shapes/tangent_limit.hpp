// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"
#include "revchain/finite/balance/support_end.hpp"

/// Bounds of the tangent of the lowest link, up to which shapes are searched.
namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns an upper bound of the tangent t of the lowest link in any shape of a chain. Its balance
/// is lambda t + (a X/moment) s = y, with s the sine and y the offset of the free end, which is at
/// most the length of the chain. With `either_posture` the link may also stand.
template <class T>
T tangent_limit(const EnclosedLinks<T>& links, const Interval<T>& height,
                bool either_posture = false, OnAxis = {}) {
    Interval<T> length(T(0));
    for (const Link<Interval<T>>& link : links) length = length + link.length;
    const Interval<T> turning = links[0].length * links[0].cross / links[0].moment;
    const Interval<T> beyond =
        hull(Interval<T>(T(0)), either_posture ? hull(turning, -turning) : -turning);
    return ((length + Interval<T>(beyond.high)) / height).high;
}

/// Returns 1 - W/(lambda E), with W all moving weight: the part of the spring's stiffness E that is
/// left when the spring has balanced the centrifugal force of a chain that moves as a whole.
template <class T>
Interval<T> remaining_stiffness(const EnclosedLinks<T>& links,
                                const SupportEnd<Interval<T>>& support) {
    Interval<T> moving = support.carriage;
    for (const Link<Interval<T>>& link : links) moving = moving + link.moment + link.rest;
    return Interval<T>(T(1)) - support.compliance * moving;
}

/// Returns an upper bound of the tangent t of the lowest link in any shape of a rig, in either
/// posture, from its balance lambda pull t + a X s = moment y. The topmost pin is at most
/// (|b| + sum of sigma a/(lambda E))/|1 - W/(lambda E)| from the axis, with sigma = S + W h/a for
/// each link and S the weight below it. Other pins are at most the length of the links farther out.
/// If the remaining stiffness may be 0 within rounding there is no bound, and the function takes
/// 1e-6 for it. The caller must then not call a list complete (`steady_shapes` in shapes_by.hpp
/// leaves the tangents beyond open).
template <class T>
T tangent_limit(const EnclosedLinks<T>& links, const Interval<T>& height, bool /*either_posture*/,
                const SupportEnd<Interval<T>>& support) {
    Interval<T> length(T(0)), moving(T(0)), drawn(support.radius.size());
    for (const Link<Interval<T>>& link : links) {
        length = length + Interval<T>(link.length.size());
        if (!support.firm)
            drawn = drawn +
                    support.compliance * Interval<T>(((moving + link.moment) * link.length).size());
        moving = moving + link.moment + link.rest;
    }
    if (!support.firm) {
        const Interval<T> remaining = remaining_stiffness(links, support);
        drawn = drawn / (remaining.may_vanish() ? Interval<T>(T(1e-6))
                         : remaining.negative() ? -remaining
                                                : remaining);
    }
    const Interval<T> turning = links[0].length * links[0].cross;
    return ((Interval<T>(links[0].moment.size()) * (length + drawn) + Interval<T>(turning.size())) /
            (height * links[0].pull))
        .high;
}

}  // namespace revchain::finite
