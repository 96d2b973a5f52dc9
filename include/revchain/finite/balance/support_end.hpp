// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/finite/balance/links.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The upper end of a chain whose topmost pin is on the axis, as known at compile time.
struct OnAxis {
    static constexpr bool is_symmetric() { return true; }
    static constexpr bool yields() { return false; }

    /// Returns the distance of the topmost pin from its support. The pin has offset y, and `sum` is
    /// lambda times the pull there.
    template <class F>
    const F& miss(const F& y, const F&) const {
        return y;
    }
    /// Puts the topmost pin, the last of `offset`, on its support if the support is firm.
    template <class S>
    void place(std::vector<S>& offset) const {
        offset.back() = S(0);
    }
};

/// The upper end of a rig. The topmost pin is in a carriage of weight W. A spring of stiffness E,
/// or a firm support, holds the carriage to a point at radius b that turns with the rig:
///     y = b + (H + W y)/(lambda E),
/// with H/lambda the pull of the chain. Unless b = 0 there is no straight shape and no symmetry.
template <class S>
struct SupportEnd {
    S radius;        ///< b, of any sign; a double
    S compliance;    ///< 1/(lambda E); 0 if firm
    S stiffness;     ///< lambda E, if the support yields
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
inline constexpr bool is_support = !std::is_same_v<End, OnAxis>;

/// The sweep of a chain calls these functions. They return its support, the posture of hanging
/// links, and whether all links may stand (never: no link would bear the load). See `RiggedLinks`.
REVCHAIN_LAZY
OnAxis support_of(const Links<Fine>&) { return {}; }
REVCHAIN_LAZY
std::vector<Posture> posture_of(const Links<Fine>& chain) {
    return std::vector<Posture>(chain.links.size(), Posture::hangs);
}
REVCHAIN_LAZY
bool may_all_stand(const Links<Fine>&) { return false; }
template <class T>
EnclosedLinks<T> swept_links(const Links<Fine>& chain) {
    return enclosed<T>(chain.links);
}

template <class T>
OnAxis enclosed(const OnAxis& end) {
    return end;
}
template <class T, class S>
SupportEnd<Interval<T>> enclosed(const SupportEnd<S>& end) {
    const T b = static_cast<T>(end.radius), W = static_cast<T>(end.carriage);
    return {b, enclosed<T>(end.compliance), enclosed<T>(end.stiffness), W, end.symmetric, end.firm};
}

}  // namespace revchain::finite
