// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/core/inclined_pendulum.hpp"

/// One rigid link, Greenhill (1908) §6. Lengths in any unit. All throw InvalidArgument for a centroid not positive, a
/// radius of gyration negative, or either not finite.
namespace revchain {

/// A compound link: its weight acts at `centroid` from the pin it hangs by, and turns about there with
/// `radius_of_gyration`.
template <Real T>
struct CompoundLink {
    T centroid;            ///< h > 0
    T radius_of_gyration;  ///< k >= 0; 0 is a plummet

    /// l = h + k^2/h, of the equivalent simple pendulum; also the distance of the centre of oscillation from the pin.
    T pendulum_length() const { return centroid + square_over_centroid(); }
    /// k^2/h: the centroid from the centre of oscillation; hung from there the two change places, §6.
    T square_over_centroid() const { return radius_of_gyration / centroid * radius_of_gyration; }
    /// Of Maxwell's two particles that move as the link does, the share of its weight at the centre of oscillation, h/l;
    /// the rest is at the pin. §6.
    T share_at_centre_of_oscillation() const { return centroid / pendulum_length(); }
};

namespace detail {
template <Real T>
void check(std::string_view place, const CompoundLink<T>& link) {
    require_positive(place, "centroid", link.centroid);
    using std::isfinite;
    if (!(link.radius_of_gyration >= T(0)) || !isfinite(link.pendulum_length()))
        refuse(place, "radius of gyration must not be negative, nor its square too large for the centroid",
               link.radius_of_gyration);
}
}  // namespace detail

/// A link that swings round, hung from an axle on the axis.
template <Real T>
struct SwungLink {
    T inclination;           ///< to the vertical, rad, 0 ... pi/2
    T reaction;              ///< at the axle, over the weight
    T reaction_inclination;  ///< of its line, which runs through the point E below the centroid, level with L; rad
};

/// A link turning at the speed whose conical height is `height`: inclined as a plummet at its centre of oscillation,
/// cos(inclination) = height/l, it pulls at its axle with its weight downwards and W (h/height) sin(inclination) outwards.
/// §6 (1), (2). Accuracy: 4 ulp.
template <Real T>
SwungLink<T> swung_link(const CompoundLink<T>& link, const T& height) {
    using std::atan;
    using std::hypot;
    detail::check("swung_link", link);
    const T length = link.pendulum_length();
    const InclinedPendulum<T> pendulum = inclined_pendulum(length, height);
    const T outwards = link.centroid / height * (pendulum.radius / length);
    return {pendulum.inclination, hypot(T(1), outwards), atan(outwards)};
}

}  // namespace revchain
