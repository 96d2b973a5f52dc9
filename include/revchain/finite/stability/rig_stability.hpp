// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/finite/stability/stability.hpp"
#include "revchain/rig.hpp"

namespace revchain {
namespace finite {

/// The shape of a rig. The pull along a link is lambda tension/cos d + p/a, p its momentum about its own axis.
inline PulledLinks pulled_links(const Rig& rig, const RiggedLinks& given, const SteadyShape& shape, double height) {
    const auto in_lengths = [&](double x) { return std::ldexp(x, -given.units.length_exponent); };
    PulledLinks result(given.units);
    result.turns_freely = given.support.symmetric;
    if (!given.support.firm) {
        result.stiffness = static_cast<double>(given.support.stiffness);
        result.carriage = static_cast<double>(given.support.carriage);
    }
    const std::vector<Link<double>> links = rounded<double>(given.links);
    for (Index m = 0; m < rig.size(); ++m) {
        const auto i = static_cast<std::size_t>(m);
        const double delta = shape.inclination[m], c = std::cos(delta), wheel = rig.flywheel(m).axial_moment;
        const double about = in_lengths(in_lengths(std::ldexp(wheel, -given.units.weight_exponent)));
        Link<double> link = links[i];  // as a body: what turns with it lessened what it resists turning with
        link.cross =
            static_cast<double>(given.given[i].cross - Wide<double>(about / link.length) / given.given[i].length);
        const double kept = height * static_cast<double>(given.speed * given.given[i].spin);
        result.add(link, delta, height * link.pull / c + about / link.length, in_lengths(shape.offset[m]),
                   kept * link.length + about * c, about);
    }
    if (result.yields()) result.offset.push_back(in_lengths(shape.offset[rig.size()]));
    return result;
}

/// Leaves out the upper end of a support that yields, where that carries no mass: its spring balances the pull on it.
inline void balance_upper_end(Disturbed& d) {
    const Index pins = d.mass.rows() - 1;
    if (d.mass.row(pins).cwiseAbs().maxCoeff() > 0) return;
    if (d.coupling.col(pins).cwiseAbs().maxCoeff() > 0)
        revchain::detail::throw_invalid(
            "stability", "a flywheel must not act on a support without mass; give it a carriage weight, now", 0.0);
    Matrix<double> kept = Matrix<double>::Identity(pins + 1, pins);
    kept.row(pins) = -d.out_of_plane.row(pins).head(pins) / d.out_of_plane(pins, pins);
    d.keep(Matrix<double>::Identity(pins + 1, pins + 1), kept);
    d.offset = d.offset.head(pins).eval();
}

}  // namespace finite

REVCHAIN_INLINE Stability stability(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options) {
    constexpr std::string_view place = "stability";
    detail::require_positive(place, "gravity", options.gravity, "conical height of the shape", shape.conical_height);
    if (options.direction != 1 && options.direction != -1)
        detail::throw_invalid(place, "direction must be 1 or -1", options.direction);
    finite::require_shape_of(rig.chain(), shape);
    const Support& support = rig.support();
    const double end = shape.offset[rig.size()];
    if (support.is_firm() && !(std::abs(end - support.radius) <= 1e-12 * (support.radius + rig.chain().total_length())))
        detail::throw_invalid(place, "the shape is not of this rig; its upper end is at", end);
    for (Index m = 0; rig.fluid() == Fluid::turning && m < rig.size(); ++m)
        if (rig.displaced(m).weight > 0)
            detail::throw_invalid(place,
                                  "how a fluid that turns moves around a disturbed link is not modelled: take "
                                  "Fluid::still, or no fluid; weight displaced by links[" +
                                      std::to_string(m) + "]",
                                  rig.displaced(m).weight);
    const Wide<double> height(shape.conical_height), speed = sqrt(Wide<double>(options.gravity) / height);
    const finite::RiggedLinks given = finite::rigged_links(rig, height, options.direction > 0 ? speed : -speed);
    const finite::PulledLinks links =
        finite::pulled_links(rig, given, shape, std::ldexp(shape.conical_height, -given.units.length_exponent));
    finite::Disturbed d(links);
    if (links.yields()) finite::balance_upper_end(d);
    finite::require_mass(d, 0);
    for (const Matrix<double>* inertia : {&d.mass, &d.inertia})
        if (Eigen::LLT<Matrix<double>>(*inertia).info() != Eigen::Success)
            detail::throw_invalid(place, "every motion must move some mass; pins that move", d.mass.rows());
    return finite::judged(options.frame, d, links.units);
}

}  // namespace revchain
