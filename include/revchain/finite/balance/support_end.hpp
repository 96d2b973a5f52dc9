// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/finite/balance/links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// What the upward sweep has to end in. A chain: its topmost pin is on the axis. All of it is known when compiling.
struct OnAxis {
    static constexpr bool is_symmetric() { return true; }
    static constexpr bool yields() { return false; }

    /// How far the topmost pin, at offset y under lambda times the pull `sum`, is from where it is held.
    template <class F>
    const F& miss(const F& y, const F&) const {
        return y;
    }
    /// Puts the topmost pin, the last of `offset`, where it is held, if that does not depend on its load.
    template <class S>
    void place(std::vector<S>& offset) const {
        offset.back() = S(0);
    }
};

/// A rig: the topmost pin, in a carriage of weight W, is drawn by a spring of stiffness E to a place carried round the
/// axis at a radius b, or is firm there:
///     y = b + (H + W y)/(lambda E),
/// H/lambda the pull of the chain on it. There is no straight chain but for b = 0, and no symmetry.
template <class S>
struct Held {
    S radius;        ///< b, of any sign; a double
    S compliance;    ///< 1/(lambda E); 0 if firm
    S stiffness;     ///< lambda E, if it yields
    S carriage;      ///< W; a double, 0 if firm
    bool symmetric;  ///< b = 0
    bool firm;

    bool is_symmetric() const { return symmetric; }
    bool yields() const { return !firm; }

    template <class F>
    F miss(const F& y, const F& sum) const {
        return firm ? y - radius : y - radius - compliance * (sum + carriage * y);
    }
    template <class V>
    void place(std::vector<V>& offset) const {
        if (firm) offset.back() = radius;
    }
};

template <class End>
inline constexpr bool is_held = !std::is_same_v<End, OnAxis>;

/// The sweep needs four facts of a system. For a chain they are: the support, the posture in which all links hang, the
/// links, and that not all links can stand, since nothing would bear the load. `RiggedLinks` has the same functions.
inline OnAxis support_of(const Links<Wide<double>>&) { return {}; }
inline std::vector<Posture> posture_of(const Links<Wide<double>>& chain) {
    return std::vector<Posture>(chain.links.size(), Posture::hangs);
}
inline bool may_all_stand(const Links<Wide<double>>&) { return false; }
template <class T>
EnclosedLinks<T> swept_links(const Links<Wide<double>>& chain) {
    return enclosed<T>(chain.links);
}

/// Numbers about a support in which T is certain of them.
template <class T>
OnAxis enclosed(const OnAxis& end) {
    return end;
}
template <class T, class S>
Held<Interval<T>> enclosed(const Held<S>& end) {
    const T b = static_cast<T>(end.radius), W = static_cast<T>(end.carriage);
    return {b, enclosed<T>(end.compliance), enclosed<T>(end.stiffness), W, end.symmetric, end.firm};
}

}  // namespace revchain::finite
