// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/system/line_density.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A state of a path, with lengths over the conical height lambda. sigma is the distance from the
/// free end, eta the offset from the axis and xi the height above the free end. u is the pull
/// across the axis over the weight of a length lambda:
///     u' = -rho eta,   V' = rho,   eta' = u/T,   xi' = V/T,   T = sqrt(u^2 + V^2)   (' by sigma),
/// V is the weight below, rho the line density. Going up, -u/V is the tangent of the inclination.
struct PathState {
    double arc = 0, offset = 1, pull = 0, height = 0;
};

/// The derivative of a path by the offset of its free end.
using PathChange = PathState;

struct PathKind {
    double tip = 0;                        ///< weight at the free end
    double unit = 1;                       ///< conical height in the unit of length of `density`
    double per_length = 1;                 ///< unit of the values of `density`
    const LineDensity* density = nullptr;  ///< null: uniform, rho = 1
    double bend = 1;                       ///< 0: small amplitude, T = V
    double line_weight = 1;                ///< mean weight per length, the unit of tensions
    struct Bob {
        double lever = 0;   ///< centroid + k^2/centroid, of the body at the free end: the length of
                            ///< its equal pendulum
        double beyond = 0;  ///< k^2/centroid
    } bob{};                ///< zero for a particle

    double weight_below(double arc) const {
        return tip +
               (density == nullptr ? arc : density->weight_below(arc * unit) / (unit * per_length));
    }
    /// The weight below a place, without the particles above another one.
    double weight_below(double arc, double with_particles_below) const {
        if (density == nullptr) return tip + arc;
        return tip + (density->cord_below(arc * unit) +
                      density->particles_below(with_particles_below * unit)) /
                         (unit * per_length);
    }
    /// The weight of the particles above one place, at or below another.
    double particles_between(double from, double to) const {
        return density == nullptr
                   ? 0.0
                   : density->particles_between(from * unit, to * unit) / (unit * per_length);
    }
    /// Returns the start of a path. With a bob, which small motions alone may have, `tip_offset` is
    /// its inclination, and moments about its pin give the offset.
    PathState at_tip(double tip_offset) const {
        return {0, (1 - bob.lever) * tip_offset, -tip * (1 - bob.beyond) * tip_offset, 0};
    }
    double density_at(double arc) const {
        return density == nullptr ? 1.0 : density->about(arc * unit)[0] / per_length;
    }
    double tension(double pull, double below) const {
        return bend == 0 ? below : std::hypot(pull, below);
    }
    /// Returns true if the free end, where T = 0, needs a series of its own: `TipSeries`.
    bool is_bare() const { return density == nullptr && tip == 0; }
};

}  // namespace revchain::finite
