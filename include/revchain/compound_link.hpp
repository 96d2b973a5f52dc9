// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/product.hpp"
#include "revchain/numeric/status.hpp"

/// One rigid link that hangs by a pin, and its whirl round the vertical axis through the pin. It
/// has no inertia about the line from the pin to the centroid.
///
///     const revchain::CompoundLink<double> bar{0.5, 0.2887};  // a uniform bar of length 1
///     bar.pendulum_length();                                  // 0.666695
///     const auto s = revchain::swung_link(bar, 0.4);          // conical height 0.4
///     s.inclination;                                          // 0.927328 rad
///
/// Greenhill (1908) §6. Lengths in any unit, angles in rad.
namespace revchain::inline REVCHAIN_BUILD {

template <Real T>
struct CompoundLink;

namespace detail {
/// k^2/h in two words, as a product that does not overflow.
template <Real T>
Product<Wide<T>> squares_over_centroid(const CompoundLink<T>& link) {
    const Wide<T> k(link.radius_of_gyration);
    return Product<Wide<T>>{}.times(k).times(k).over(link.centroid);
}
}  // namespace detail

/// A rigid link.
template <Real T>
struct CompoundLink {
    T centroid;            ///< h > 0, distance of the centre of gravity from the pin
    T radius_of_gyration;  ///< k >= 0, about the centre of gravity; 0 for a plummet

    /// l = h + k^2/h, the length of the equivalent simple pendulum and the distance of the centre
    /// of oscillation from the pin. Accuracy: 1.5 ulp.
    [[nodiscard]] T pendulum_length() const {
        using std::isfinite;
        const T length =
            static_cast<T>(Wide<T>(centroid) + detail::squares_over_centroid(*this).value());
        return isfinite(length) ? length : centroid + square_over_centroid();  // overflow
    }
    /// k^2/h, the distance from the centre of gravity to the centre of oscillation, §6.
    T square_over_centroid() const {
        return static_cast<T>(detail::squares_over_centroid(*this).value());
    }
    /// h/l, the share of the weight at the centre of oscillation if two particles replace the link
    /// (Maxwell), the other at the pin. §6. Accuracy: 2 ulp.
    [[nodiscard]] T share_at_centre_of_oscillation() const { return centroid / pendulum_length(); }
};

namespace detail {
template <Real T>
void check(std::string_view place, const CompoundLink<T>& link) {
    require_positive(place, "centroid", link.centroid);
    using std::isfinite;
    if (!(link.radius_of_gyration >= T(0)) || !isfinite(link.pendulum_length()))
        throw_invalid(
            place,
            "radius of gyration must not be negative, nor its square too large for the centroid",
            link.radius_of_gyration);
}
}  // namespace detail

/// A link at a steady inclination, hung from an axle on the axis.
template <Real T>
struct SwungLink {
    T inclination;  ///< to the vertical, 0 ... pi/2
    T reaction;     ///< force at the axle over the weight
    /// Inclination of that force to the vertical.
    T reaction_inclination;
    T condition;  ///< relative change of inclination per relative change of data; 0 if vertical
};

/// The link at the speed with conical height `height`: cos(inclination) = height / l. The axle
/// carries the weight W downwards and W (h / height) sin(inclination) outwards. §6 (1), (2).
/// Accuracy: 4 ulp for the data as given, also where height and l nearly agree; condition: 1e-13.
/// It is cot d / d (1 + (|h - k^2/h| + 2 k^2/h)/l) with d the inclination. O(1). Throws
/// InvalidArgument unless centroid and height are positive, the radius of gyration not negative,
/// and all finite.
template <Real T>
[[nodiscard]] SwungLink<T> swung_link(const CompoundLink<T>& link, const T& height);

}  // namespace revchain

#include "revchain/paper/compound_link.hpp"
