// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/finite/balance/support_end.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A state of a chain held at both ends, given at its lower end: lambda times the force on that end
/// across and along the axis, and lambda = g/n^2 (0 without gravity). `part` scales the supports;
/// at 0 both ends are firm on the axis. The unknowns of a state are three numbers: `across`,
/// `along` and a parameter, which is `height` or `part`.
template <class S>
struct HeldForces {
    S across, along, height;
    S part = S(1);
};

/// Both supports, and the derivatives of their radii and compliances (lower, upper) and of the
/// height by the parameter.
template <class S>
struct HeldEnds {
    SupportEnd<S> lower = firm(), upper = firm();
    std::array<S, 2> radius_change{}, compliance_change{};
    S height_change = S(1);

    static SupportEnd<S> firm(const S& radius = S(0)) {
        return {.radius = radius,
                .compliance = S(0),
                .stiffness = S(0),
                .carriage = S(0),
                .symmetric = radius == S(0),
                .firm = true};
    }
    bool is_symmetric() const { return lower.symmetric && upper.symmetric; }
    bool yields() const { return lower.yields() || upper.yields(); }
};

/// Encloses the supports, but not the derivatives by the parameter: sweeps with the result take
/// derivatives by the two forces only.
template <class T, class S>
HeldEnds<Interval<T>> enclosed(const HeldEnds<S>& ends) {
    return {enclosed<T>(ends.lower), enclosed<T>(ends.upper)};
}

/// Derivatives by the first K of `across`, `along` and the parameter.
template <class S, std::size_t K = 3>
using HeldChange = std::array<S, K>;

/// The sine and cosine of a link's inclination to the axis.
template <class S>
struct Direction {
    S sine, cosine;
};

/// The upper end after a sweep: the distance of the topmost pin from its support (see
/// `SupportEnd::miss`), its distance above the lower end along the axis, and lambda times the force
/// across.
template <class S, std::size_t K = 3>
struct HeldEnd {
    S offset{}, rise{}, across{};
    HeldChange<S, K> offset_change{}, rise_change{}, across_change{};
    bool known = false;  ///< false if a link is slack or its inclination turns over

    /// Returns the changes of the two forces that move the upper end by y across and z along the
    /// axis.
    std::array<S, 2> forces_to_move(const S& y, const S& z) const {
        const S &a = offset_change[0], &b = offset_change[1], &c = rise_change[0],
                &d = rise_change[1];
        const S determinant = a * d - b * c;
        return {(d * y - b * z) / determinant, (a * z - c * y) / determinant};
    }
};

/// Finds the direction of a link with sine s and cosine c. It solves V s + length cross s c - R c =
/// 0 for the loads R = `across` and V = `along`. Of several solutions it finds the one nearest to
/// the given `direction`. Returns the turning stiffness: the derivative of the left side by the
/// inclination, positive at a stable direction; for a plummet it is the pull. Returns 0 if it finds
/// no stable direction.
template <class S>
S find_direction(const Link<S>& link, const S& across, const S& along, Direction<S>& direction) {
    using std::abs;
    using std::sqrt;
    S &s = direction.sine, &c = direction.cosine;
    if (link.cross == S(0)) {
        const S pull = sqrt(across * across + along * along);
        if (!(pull > S(0))) return S(0);
        s = across / pull, c = along / pull;
        return pull;
    }
    const S turning = link.length * link.cross;
    S stiffness(0);
    double last = 1;
    for (int round = 0; round < 60; ++round) {
        stiffness = along * c + turning * (c * c - s * s) + across * s;
        if (!(stiffness > S(0))) return S(0);
        // Newton's step is taken as twice the tangent of half an angle. The link turns by that
        // angle, so its sine and cosine need no square root.
        S half = -(along * s + turning * s * c - across * c) / (S(2) * stiffness);
        const double size = std::abs(as_double(half));
        if (size > 0.3) half = half * S(0.3 / size);
        const S square = half * half, whole = S(1) + square, cosine = (S(1) - square) / whole,
                sine = S(2) * half / whole;
        const S turned = s * cosine + c * sine;
        c = c * cosine - s * sine;
        s = turned;
        if (size < as_double(epsilon<S>()) || (size < 1e-14 && size >= 0.25 * last))
            return stiffness;
        last = size;
    }
    return S(0);
}

/// Encloses the direction of a link other than a plummet for loads R across and V along the axis,
/// by Newton's method in intervals. `found` is the direction for one of these loads. Returns the
/// turning stiffness as `find_direction` does. It is not positive if the link may be slack or have
/// another inclination.
template <Real T, class Span = Interval<T>>
Span enclose_rigid_direction(const Link<Span>& link, const Span& R, const Span& V,
                             const Direction<T>& found, Direction<Span>& direction) {
    const Span turning = link.length * link.cross, sine(found.sine), cosine(found.cosine);
    const Span size = sqrt(square(sine) + square(cosine)), s = sine / size, c = cosine / size;
    const Span unbalanced = V * s + turning * s * c - R * c;
    const auto stiffness_at = [&](const Direction<Span>& way) {
        return V * way.cosine + turning * (square(way.cosine) - square(way.sine)) + R * way.sine;
    };
    Span stiffness = stiffness_at({s, c});
    T margin = T(1.1) * unbalanced.size() / stiffness.low + T(4) * epsilon<T>();
    for (; stiffness.positive() && margin < T(0.5); margin = T(1.5) * margin) {
        direction = {s + Span(-margin, margin), c + Span(-margin, margin)};
        stiffness = stiffness_at(direction);
        if (stiffness.positive() && (unbalanced / stiffness).size() < margin) return stiffness;
    }
    return Span(T(0));
}

/// A receiver of links that ignores them.
struct SeesNothing {
    template <class... Any>
    void operator()(std::size_t, const Any&...) const {}
};

/// Sweeps from the lower to the upper end: Greenhill (1908) §8 with a force at the lower end. Let a
/// link have the inclination of tangent t and sine s, its lower pin the offset y_below and its
/// upper pin the offset y. Then
///     R = H_below + moment y_below,   V t + length cross s = R,   V = lambda pull + along,
///     y = y_below - length s,         H = R + rest y.
/// A firm lower end is at its radius y, with H = across. A lower end of radius b on a spring of
/// stiffness E, in a carriage of weight W, is at y = b - across/(lambda E), with H = across + W y.
/// Derivatives by the first K of `across`, `along` and the parameter are exact.
/// `solve(m, R, V, way)` sets the direction of link m and returns its turning stiffness (see
/// `find_direction`). The sweep ends if that is not positive.
/// `each(m, y, R, H, stiffness, change)` receives every link: y_below, R, H, the turning stiffness
/// and the change of its inclination.
template <std::size_t K, class S, class Solve, class Each = SeesNothing>
HeldEnd<S, K> held_sweep(const std::vector<Link<S>>& links, const HeldEnds<S>& ends,
                         const HeldForces<S>& forces, const Solve& solve, const Each& each = {}) {
    const SupportEnd<S>&lower = ends.lower, &upper = ends.upper;
    S y = lower.radius, z(0), H = forces.across;
    HeldChange<S, K> y_change, z_change, H_change;
    y_change.fill(S(0)), z_change.fill(S(0)), H_change.fill(S(0));
    H_change[0] = S(1);
    if constexpr (K > 2) y_change[2] = ends.radius_change[0];
    if (lower.yields()) {
        y = y - lower.compliance * forces.across, H = H + lower.carriage * y;
        y_change[0] = -lower.compliance;
        if constexpr (K > 2) y_change[2] = y_change[2] - ends.compliance_change[0] * forces.across;
        for (std::size_t i = 0; i < K; ++i)
            H_change[i] = H_change[i] + lower.carriage * y_change[i];
    }
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<S>& link = links[m];
        const S R = H + link.moment * y, V = forces.height * link.pull + forces.along;
        Direction<S> way;
        const S stiffness = solve(m, R, V, way);
        if (!is_positive(stiffness)) return {};
        const auto& [s, c] = way;
        HeldChange<S, K> R_change, turned;
        for (std::size_t i = 0; i < K; ++i) {
            R_change[i] = H_change[i] + link.moment * y_change[i];
            S moment = c * R_change[i];
            if (i == 1) moment = moment - s;
            if (i == 2) moment = moment - s * link.pull * ends.height_change;
            turned[i] = moment / stiffness;
        }
        const S below = y;
        y = y - link.length * s, z = z + link.length * c, H = R + link.rest * y;
        for (std::size_t i = 0; i < K; ++i) {
            y_change[i] = y_change[i] - link.length * c * turned[i];
            z_change[i] = z_change[i] - link.length * s * turned[i];
            H_change[i] = R_change[i] + link.rest * y_change[i];
        }
        each(m, below, R, H, stiffness, turned);
    }
    HeldEnd<S, K> end{upper.miss(y, H), z, H, y_change, z_change, H_change, true};
    if constexpr (K > 2) end.offset_change[2] = end.offset_change[2] - ends.radius_change[1];
    if (upper.yields()) {
        for (std::size_t i = 0; i < K; ++i)
            end.offset_change[i] = end.offset_change[i] -
                                   upper.compliance * (H_change[i] + upper.carriage * y_change[i]);
        if constexpr (K > 2)
            end.offset_change[2] =
                end.offset_change[2] - ends.compliance_change[1] * (H + upper.carriage * y);
    }
    return end;
}

/// Sweeps in numbers, with every link in tension, above or below the horizontal. `direction` holds
/// starting values, then results. Cost O(N): 0.1 microseconds a link in double.
template <class S, class Each = SeesNothing>
HeldEnd<S> held_sweep(const std::vector<Link<S>>& links, const HeldEnds<S>& ends,
                      const HeldForces<S>& forces, std::vector<Direction<S>>& direction,
                      const Each& each = {}) {
    const auto at_pull = [&](std::size_t m, const S& R, const S& V, Direction<S>& way) {
        const S stiffness = find_direction(links[m], R, V, direction[m]);
        way = direction[m];
        return stiffness;
    };
    return held_sweep<3>(links, ends, forces, at_pull, each);
}

/// Finds the forces at the lower end for which the topmost pin is at its support and at the given
/// rise, by Newton's method. `sweep(forces)` returns the upper end. Returns false if the method
/// does not converge. The size of a step is measured relative to the larger of the forces before
/// and after it. The change across is measured relative to the forces across alone if the shape has
/// a mirror image (`symmetric`): the force across is then never 0. The method ends after a step
/// smaller than `enough`, or smaller than `rounding` but larger than a quarter of the step before.
template <class S, class Sweep>
bool find_forces(HeldForces<S>& forces, const S& rise, bool symmetric, double enough,
                 double rounding, const Sweep& sweep) {
    const auto size_of = [](const S& x) { return std::abs(as_double(x)); };
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 30; ++round) {
        const HeldEnd<S> end = sweep(forces);
        if (!end.known) return false;
        const auto [across, along] = end.forces_to_move(-end.offset, rise - end.rise);
        const HeldForces<S> before = forces;
        forces.across = forces.across + across, forces.along = forces.along + along;
        const double own = std::max(size_of(before.across), size_of(forces.across)),
                     whole = own + std::max(size_of(before.along), size_of(forces.along));
        const double size = size_of(across) / (symmetric ? own : whole) + size_of(along) / whole;
        if (!(size < 1)) return false;
        if (size < enough || (size < rounding && size > 0.25 * last)) return true;
        last = size;
    }
    return false;
}

}  // namespace revchain::finite
