// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain {

/// Which modes of a rig, and how.
struct RigModesOptions {
    Index first = 1;               ///< number of the slowest mode wanted, from 1, of each sense
    std::optional<Index> count{};  ///< so many from `first` on; absent: all
    double gravity = conical_pendulum::standard_gravity;
    bool shapes = true;            ///< also shapes and residuals
    bool other = true;             ///< also what is no steady motion
    Progress* progress = nullptr;  ///< watched and stopped from another thread
};

/// Whirl modes of one sense of rotation, slowest first. Mode k of `available` stands at index k - first.
struct WhirlModes {
    Index first = 1;
    Index available = 0;               ///< how many there are, found or not
    Vector<double> conical_height;     ///< (k,) lambda = g/n^2, descending, in the chain's unit of length
    Vector<double> error_bound;        ///< (k,) of it, relative to the exact one of the stored numbers; proved
    Vector<double> angular_speed;      ///< (k,) |n|, rad/s
    Vector<double> speed_error_bound;  ///< (k,) of it, relative; proved
    Table<double> shape;  ///< (k, N+1) offsets of the pins, free end first, support last; largest |offset| = 1, free
                          ///< end positive; empty without shapes
    Vector<double> residual;  ///< (k,) force left unbalanced at a pin, relative to the forces that meet there

    Index size() const { return conical_height.size(); }
};

/// What is no steady motion: a conical height that is negative or complex, or, with momentum, a complex speed; and an
/// infinite one, of what has weight neither way and stays at rest wherever it is put.
struct OtherMode {
    std::complex<double> conical_height;  ///< lambda
    std::complex<double>
        angular_speed;       ///< n with lambda n^2 = g; the root that grows or, with momentum, the one found
    double growth_rate = 0;  ///< |Im n|, 1/s: small offsets grow as exp(growth_rate t)
    double error_bound = std::numeric_limits<double>::infinity();  ///< of the height, relative to its size; proved
};

/// A link whose effective tension, tension + n momentum/length, is 0 at a speed and a thrust beyond it.
struct SlackLink {
    Index link = 0;            ///< from 0, lowest first
    double angular_speed = 0;  ///< n, negative against the sense of a positive momentum
};

/// Whirl modes of a rig.
struct RigModes {
    bool has_momentum = false;
    WhirlModes forward;   ///< n > 0; and all, where no link has momentum of its own: the senses are then alike
    WhirlModes backward;  ///< n < 0; none where no link has momentum of its own
    std::vector<OtherMode> other;
    std::vector<SlackLink> slack;  ///< slowest first: those between 0 and the fastest speed found of their sense
    /// Whether `forward.available`, `backward.available` and `other`, if asked for, are proved to be all there is.
    bool complete = false;
    std::string method;  ///< "modes", "counts", "discs"
    Status status = Status::success;
};

}  // namespace revchain
