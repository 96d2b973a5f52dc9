// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/finite/balance/link_equation.hpp"

namespace revchain::finite {

/// Lambda times the force at the lower end of a chain held at both ends, across the axis and along it, and the conical
/// height lambda = g/n^2 itself, 0 without gravity.
template <class S>
struct HeldForces {
    S across, along, height;
};

/// How a number changes with the first K of the three.
template <class S, std::size_t K = 3>
using HeldChange = std::array<S, K>;

/// Sine and cosine of a link's inclination.
template <class S>
struct Direction {
    S sine, cosine;
};

/// Where the upper end comes to, and lambda times the force across the axis there.
template <class S, std::size_t K = 3>
struct HeldEnd {
    S offset{}, rise{}, across{};
    HeldChange<S, K> offset_change{}, rise_change{}, across_change{};
    bool known = false;  ///< not where a link is slack, or its inclination turns over

    /// The changes of the forces across and along that move the upper end by (y, z).
    std::array<S, 2> forces_to_move(const S& y, const S& z) const {
        const S &a = offset_change[0], &b = offset_change[1], &c = rise_change[0], &d = rise_change[1];
        const S determinant = a * d - b * c;
        return {(d * y - b * z) / determinant, (a * z - c * y) / determinant};
    }
};

namespace detail {

/// Links turn in the plane of the shape by the pull (R, V) of what they carry, R across the axis and V along it:
///     V s + a X s c - R c = 0.
/// Returns the derivative with the inclination, positive where the link settles: the pull, if the link is a plummet. Of
/// several inclinations of other links the one nearest to the direction given is taken.
template <class S>
S settle(const Link<S>& link, const S& across, const S& along, Direction<S>& direction) {
    using std::abs;
    using std::sqrt;
    S &s = direction.sine, &c = direction.cosine;
    if (link.cross == S(0)) {
        const S pull = sqrt(across * across + along * along);
        if (!(pull > S(0))) return S(0);
        s = across / pull, c = along / pull;
        return pull;
    }
    const S turn = link.length * link.cross;
    S growth(0);
    double last = 1;
    for (int round = 0; round < 60; ++round) {
        growth = along * c + turn * (c * c - s * s) + across * s;
        if (!(growth > S(0))) return S(0);
        // half of Newton's step is the tangent of half an angle
        S half = -(along * s + turn * s * c - across * c) / (S(2) * growth);
        const double size = std::abs(static_cast<double>(half));
        if (size > 0.3) half = half * S(0.3 / size);
        const S square = half * half, whole = S(1) + square, cosine = (S(1) - square) / whole,
                sine = S(2) * half / whole;
        const S turned = s * cosine + c * sine;
        c = c * cosine - s * sine;
        s = turned;
        if (size < static_cast<double>(epsilon<S>()) || (size < 1e-14 && size >= 0.25 * last)) return growth;
        last = size;
    }
    return S(0);
}

struct SeesNothing {
    template <class... Any>
    void operator()(std::size_t, const Any&...) const {}
};

}  // namespace detail

/// From the lower end, on the axis, to the upper: Greenhill (1908) §8 with a force at the lower end,
///     R = H_below + moment y_below,   (lambda pull + tau) t + length cross s = R,
///     y = y_below - length s,         H = R + rest y,
/// H = `across` and tau = `along` at the lower end. Changes with the first K of the forces are exact derivatives.
/// `settle(m, R, V, way)` gives link m its direction under its load and returns the derivative of its moment with the
/// inclination; the sweep ends where that is not positive. `each(m, y, R, H, growth, change of the inclination)` sees
/// every link, y of the lower pin and H of the upper.
template <std::size_t K, class S, class Settle, class Each = detail::SeesNothing>
HeldEnd<S, K> held_sweep(const std::vector<Link<S>>& links, const HeldForces<S>& forces, const Settle& settle,
                         const Each& each = {}) {
    S y(0), z(0), H = forces.across;
    HeldChange<S, K> y_change, z_change, H_change;
    y_change.fill(S(0)), z_change.fill(S(0)), H_change.fill(S(0));
    H_change[0] = S(1);
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<S>& link = links[m];
        const S R = H + link.moment * y, V = forces.height * link.pull + forces.along;
        Direction<S> way;
        const S growth = settle(m, R, V, way);
        if (!is_positive(growth)) return {};
        const auto& [s, c] = way;
        HeldChange<S, K> R_change, turned;
        for (std::size_t i = 0; i < K; ++i) {
            R_change[i] = H_change[i] + link.moment * y_change[i];
            S moment = c * R_change[i];
            if (i == 1) moment = moment - s;
            if (i == 2) moment = moment - s * link.pull;
            turned[i] = moment / growth;
        }
        const S below = y;
        y = y - link.length * s, z = z + link.length * c, H = R + link.rest * y;
        for (std::size_t i = 0; i < K; ++i) {
            y_change[i] = y_change[i] - link.length * c * turned[i];
            z_change[i] = z_change[i] - link.length * s * turned[i];
            H_change[i] = R_change[i] + link.rest * y_change[i];
        }
        each(m, below, R, H, growth, turned);
    }
    return {y, z, H, y_change, z_change, H_change, true};
}

/// The sweep in numbers. A link points where it is pulled, above the horizontal or below: every link is in tension.
/// `direction` holds where to look, and what was found. Cost O(N): 0.1 microseconds a link in double.
template <class S, class Each = detail::SeesNothing>
HeldEnd<S> held_sweep(const std::vector<Link<S>>& links, const HeldForces<S>& forces,
                      std::vector<Direction<S>>& direction, const Each& each = {}) {
    const auto settle = [&](std::size_t m, const S& R, const S& V, Direction<S>& way) {
        const S growth = detail::settle(links[m], R, V, direction[m]);
        way = direction[m];
        return growth;
    };
    return held_sweep<3>(links, forces, settle, each);
}

/// The lowest link of a chain held at both ends, in intervals: lambda times the pull along it, and the tangent of half
/// its angle to the upward vertical, or to the downward one unless `up`. It leads away from the axis.
struct HeldCell {
    std::array<Interval<double>, 2> at;  ///< pull, tangent from 0 to 1
    bool up = true;
};

/// What a chain held at both ends must meet: how far apart they are, or lambda times the tension at the upper one.
struct HeldGoal {
    Interval<double> value;
    bool is_span = true;
};

}  // namespace revchain::finite
