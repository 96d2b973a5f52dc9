// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/finite/balance/links.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The upper end of a rig. A spring of stiffness E holds the topmost pin, in a carriage of weight
/// W, to a point at radius b that turns with the rig; a firm support holds it there:
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
