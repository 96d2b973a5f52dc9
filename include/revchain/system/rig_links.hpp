// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/rig.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Coefficients of a rigged link at its two pins, in the units of `Rig::chain().units()`, after
/// Greenhill (1908) §8. Each body has two weights: the one that bears (less the buoyancy) and the
/// one that moves (with the added weight of the fluid). The offsets are y, the tangent and sine of
/// the inclination t and s, the speed n, and lambda = g/n^2. R is the moment about the upper pin,
/// as if the link hung vertically, over the distance between the pins:
///     R = H_below + moment y_below,    lambda (tension + n spin) t + length cross s = R,
///     y = y_below - length s,          H = R + rest y.
/// For small inclinations the stiffness is (tension + n spin)/length, negative if the link stands.
/// The mass matrix is [lower cross; cross upper].
struct RigLink {
    using S = Wide<double>;
    S length;   ///< a
    S tension;  ///< (W h + a S)/a of the weights that bear; in a standing link a thrust
    S spin;     ///< momentum over length
    S moment;   ///< W h/a of the weights that move
    S rest;     ///< W (a - h)/a of the weights that move
    S cross;    ///< X
    S lower, upper;
    S hung;  ///< weight of this link and all below that bears on the upper pin
    /// Sums of the sizes of each number's terms; its error is at most `error_part` times the sum.
    struct Sizes {
        double tension, lower, upper, cross, hung;
    } size;
    static constexpr double error_part = 64 * operation_error<S>();
};

/// Returns the coefficients of a rig's links, lowest first. `RigLink::error_part` bounds their
/// errors: three operations for a body's share, a few for the sum of shares, a compensated sum for
/// the weights below, four operations for a caller's momentum or axial moment. Cost O(N). Throws
/// InvalidArgument if the ratio of two weights exceeds 1e123.
inline std::vector<RigLink> rig_links(const Rig& rig) {
    using S = Wide<double>;
    const Chain<double>& chain = rig.chain();
    require_one_weight_unit("Chain", chain);
    const ChainUnits units = chain.units();
    const auto in_weights = [&](double x) { return std::ldexp(x, -units.weight_exponent); };
    const auto in_lengths = [&](double x) { return std::ldexp(x, -units.length_exponent); };
    std::vector<RigLink> links;
    links.reserve(static_cast<std::size_t>(rig.size()));
    CompensatedSum<S> hung;
    double hung_size = 0;
    for (Index m = 0; m < rig.size(); ++m) {
        const Link<double> link = chain.link(m);
        const Displaced fluid = rig.displaced(m);
        const Flywheel wheel = rig.flywheel(m);
        const S a(in_lengths(link.length)), none(0.0), below = hung.value();
        RigLink result{a,    below, none, none,  none,
                       none, none,  none, below, {hung_size, 0, 0, 0, hung_size}};
        /// Adds a body: `bears` is its weight (negative for buoyancy), `moves` the one that moves.
        const auto add = [&](const S& bears, const S& moves, double centroid, const S& gyration) {
            const S h(in_lengths(centroid)), p = h / a, q = (a - h) / a;
            hung.add(bears);
            result.tension = result.tension + bears * p;
            result.moment = result.moment + moves * p, result.rest = result.rest + moves * q;
            result.cross = result.cross + (p * q - gyration) * moves;
            result.lower = result.lower + (p * p + gyration) * moves;
            result.upper = result.upper + (q * q + gyration) * moves;
            const double near = std::abs(p.high), far = std::abs(q.high), turn = gyration.high;
            const double weight = std::abs(bears.high), moved = std::abs(moves.high);
            result.size.tension += weight * near, result.size.hung += weight;
            result.size.lower += moved * (near * near + turn),
                result.size.upper += moved * (far * far + turn);
            result.size.cross += moved * (near * far + turn);
        };
        const S weight(in_weights(link.weight)), borne(in_weights(fluid.weight));
        const S carried =
            rig.fluid() == Fluid::turning ? -borne : S(in_weights(fluid.added_weight));
        if (rig.fills_its_link(m)) {  // one body of the net weight, which may be none at all
            add(weight - borne, weight + carried, link.centroid, link.gyration_ratio);
        } else {
            add(weight, weight, link.centroid, link.gyration_ratio);
            add(-borne, carried, fluid.centroid, fluid.gyration_ratio);
        }
        if (wheel.axial_moment.high !=
            0) {  // turning with the link, it reduces the link's inertia across the axis
            const S turning =
                ldexp(wheel.axial_moment, -units.weight_exponent - 2 * units.length_exponent) /
                (a * a);
            result.cross = result.cross + turning;
            result.lower = result.lower - turning, result.upper = result.upper - turning;
            result.size.lower += turning.high, result.size.upper += turning.high,
                result.size.cross += turning.high;
        }
        result.spin = ldexp(wheel.momentum, -units.weight_exponent - units.length_exponent) / a;
        result.hung = hung.value(), hung_size = result.size.hung;
        links.push_back(result);
    }
    return links;
}

}  // namespace revchain::detail
