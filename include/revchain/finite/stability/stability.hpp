// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/shape.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/finite/stability/disturbed.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"
#include "revchain/rig.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace finite {

/// Whether the mode of a square of an exponent can be told from every other.
inline bool is_simple(const Vector<std::complex<double>>& square, Index j) {
    const double near = 1e-10 * square.cwiseAbs().maxCoeff();
    return ((square.array() - square[j]).abs() <= near).count() == 1;
}

/// The verdict on a disturbed shape of so many links. To first order damping c (F, H) changes an exponent by
///     ds = - c (s^2 q'F q - Y'H Y) / (2 (s^2 q'A q - Y'M Y - 2 q'B Y)),    Y = s y,
/// since (q, -y) is the mode on the left; drag in space has -2 q'X'E Y above besides, X'E the `drag_coupling`.
REVCHAIN_INLINE Stability judged(StabilityFrame frame, const Disturbed& d, const ChainUnits& units) {
    const bool free = frame == StabilityFrame::free, rotates = free && d.turns_freely;
    const Index n = d.in_plane.rows(), links = d.ends.rows();
    Matrix<double> in_plane = d.in_plane,
                   others = Matrix<double>::Identity(d.offset.size(), free ? d.offset.size() : 0);
    Vector<double> b = Vector<double>::Zero(n);
    if (rotates) {
        const Vector<double> momentum = d.mass * d.offset;
        others = beside(momentum);  // offsets at right angles to the rotation, in the masses
        b = d.coupling * d.offset / std::sqrt(d.offset.dot(momentum));
        in_plane += 4 * b * b.transpose();
    } else if (!free) {
        in_plane -= d.turned;
    }
    const Matrix<double> across = others.transpose() * d.out_of_plane * others;
    const pencil::MirroredModes modes = pencil::mirrored_modes(
        {d.inertia, d.coupling * others, others.transpose() * d.mass * others, in_plane, across});

    Stability result;
    result.frame = frame;
    const double pins = std::ldexp(1.0, -units.weight_exponent - 2 * units.length_exponent),
                 air = std::ldexp(1.0, units.length_exponent - units.weight_exponent);
    Matrix<std::complex<double>> y = others * modes.y;
    if (rotates) y -= d.offset / std::sqrt(d.offset.dot(d.mass * d.offset)) * (2 * b.transpose() * modes.x);
    struct Mode {
        std::complex<double> exponent;
        double internal, external;
    };
    std::vector<Mode> list;
    double largest = 0;
    for (Index j = 0; j < modes.square.size(); ++j) {
        const std::complex<double> square = modes.square[j], s = std::sqrt(square);
        const Vector<std::complex<double>> q = modes.x.col(j), Y = y.col(j);
        const auto form = [&](const Matrix<double>& A, const Matrix<double>& M) {
            const std::complex<double> in = (q.transpose() * A * q).value(), out = (Y.transpose() * M * Y).value();
            return square * in - out;
        };
        const auto mixed = [&](const Matrix<double>& B) { return (q.transpose() * B * Y).value(); };
        std::complex<double> norm = 2.0 * (form(d.inertia, d.mass) - 2.0 * mixed(d.coupling));
        if (!is_simple(modes.square, j)) norm = std::numeric_limits<double>::quiet_NaN();
        const double inner = -pins * std::real(form(d.bending, d.swivelling) / norm);
        const double outer =
            -air * std::real((form(d.drag_in_plane, d.drag_across) - 2.0 * mixed(d.drag_coupling)) / norm);
        list.push_back({s, inner, outer}), list.push_back({0.0 - s, inner, outer});
        result.growth_rate = std::max(result.growth_rate, std::abs(s.real()));
        largest = std::max(largest, std::abs(s));
    }
    std::sort(list.begin(), list.end(), [](const Mode& x, const Mode& z) {
        const auto &s = x.exponent, &t = z.exponent;
        return s.imag() != t.imag() ? s.imag() < t.imag() : s.real() < t.real();
    });
    for (const Mode& mode : list) {
        result.exponents.push_back(mode.exponent);
        result.internal_damping.push_back(mode.internal), result.external_damping.push_back(mode.external);
    }
    const pencil::Inertia inside = pencil::inertia(in_plane), outside = pencil::inertia(across);
    const double stiffness =
        std::max(in_plane.cwiseAbs().maxCoeff(), across.size() ? across.cwiseAbs().maxCoeff() : 0.0);
    const double rounding = 1e-14 * static_cast<double>(links) * stiffness;
    const double least = std::min(inside.least, outside.least);
    result.negative_directions = inside.negative + outside.negative;
    result.margin = 1e-7 * largest;  // what two exponents that meet may be torn apart by
    if (least > rounding)
        result.verdict = Verdict::minimum;
    else if (result.growth_rate > result.margin)
        result.verdict = Verdict::unstable;
    else if (result.growth_rate < 1e-4 * result.margin && least < -rounding)
        result.verdict = Verdict::spectrally_stable;
    return result;
}

/// lambda times the pull along each link of a shape, from the force (H, tau) on the lowest pin, in the given units: the
/// load resolved along the link. Load over cosine would lose the digits of a link that lies nearly level.
template <class Shape>
std::vector<double> pulls(const std::vector<Link<double>>& links, const Shape& shape, const ChainUnits& units,
                          double H = 0, double tau = 0) {
    const auto length = [&](double x) { return std::ldexp(x, -units.length_exponent); };
    std::vector<double> result;
    for (Index m = 0; m < shape.inclination.size(); ++m) {
        const Link<double>& link = links[static_cast<std::size_t>(m)];
        const double s = std::sin(shape.inclination[m]), c = std::cos(shape.inclination[m]);
        const double R = H + link.moment * length(shape.offset[m]), V = length(shape.conical_height) * link.pull + tau;
        H = R + link.rest * length(shape.offset[m + 1]);
        result.push_back(V * c + (R - link.cross * link.length * s) * s);
    }
    return result;
}

inline PulledLinks pulled_links(const Links<Wide<double>>& chain, const SteadyShape& shape) {
    PulledLinks result(chain.units);
    const std::vector<Link<double>> links = rounded<double>(chain.links);
    const std::vector<double> pull = pulls(links, shape, chain.units);
    for (std::size_t i = 0; i < links.size(); ++i) {
        const auto m = static_cast<Index>(i);
        result.add(links[i], shape.inclination[m], pull[i], std::ldexp(shape.offset[m], -chain.units.length_exponent));
    }
    return result;
}

inline PulledLinks pulled_links(const Links<Wide<double>>& chain, const HeldShape& shape) {
    const auto length = [&](double x) { return std::ldexp(x, -chain.units.length_exponent); };
    const auto weight = [&](double x) { return std::ldexp(x, -chain.units.weight_exponent); };
    PulledLinks result(chain.units);
    result.links = rounded<double>(chain.links), result.held = true;
    const auto& [lower, upper] = shape.ends;
    result.turns_freely = lower.radius == 0 && upper.radius == 0;
    result.stiffness = weight(upper.stiffness), result.carriage = weight(upper.carriage_weight);
    result.lower_stiffness = weight(lower.stiffness), result.lower_carriage = weight(lower.carriage_weight);
    result.momentum.resize(result.links.size()), result.axial.resize(result.links.size());
    result.inclination.assign(shape.inclination.begin(), shape.inclination.end());
    const double H = length(weight(-shape.lower_pull[0])), tau = length(weight(shape.lower_pull[1]));
    result.pull = pulls(result.links, shape, chain.units, H, tau);
    for (Index m = 0; m < shape.inclination.size() + result.yields(); ++m)
        result.offset.push_back(length(shape.offset[m]));
    return result;
}

/// Throws InvalidArgument unless a shape has the links of a chain.
template <class Shape>
void require_shape_of(const Chain<double>& chain, const Shape& shape) {
    if (shape.inclination.size() != chain.size())
        revchain::detail::throw_invalid("stability", "the shape is not of this chain; its links number",
                                        shape.inclination.size());
    const double rounding = 1e-12 * (chain.total_length() + std::abs(shape.offset[chain.size()]));
    for (Index m = 0; m < chain.size(); ++m) {
        const double length = std::hypot(shape.offset[m] - shape.offset[m + 1], shape.height[m] - shape.height[m + 1]);
        if (!(std::abs(length - chain.length()[m]) <= rounding))
            revchain::detail::throw_invalid(
                "stability", "the shape is not of this chain; in it links[" + std::to_string(m) + "] is as long as",
                length);
    }
}

inline void require_mass(const Disturbed& d, Index first) {
    for (Index m = 0; m < d.mass.rows(); ++m)
        if (!(d.mass.row(m).cwiseAbs().maxCoeff() > 0))
            revchain::detail::throw_invalid("stability", "pins must have mass; one that has none is number", m + first);
}

inline void require_inertia(const Disturbed& d) {
    for (const Matrix<double>* inertia : {&d.mass, &d.inertia})
        if (Eigen::LLT<Matrix<double>>(*inertia).info() != Eigen::Success)
            revchain::detail::throw_invalid("stability", "every motion must move some mass; pins that move",
                                            d.mass.rows());
}

}  // namespace finite

REVCHAIN_INLINE Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame) {
    finite::require_shape_of(chain, shape);
    const finite::PulledLinks links = pulled_links(finite::links_of(chain), shape);
    return finite::judged(frame, finite::Disturbed(links), links.units);
}

namespace finite {

/// The shape of a rig. A link's momentum p about its own axis adds p/a to the pull along it.
inline PulledLinks pulled_links(const Rig& rig, const RiggedLinks& given, const SteadyShape& shape, double height) {
    const auto in_lengths = [&](double x) { return std::ldexp(x, -given.units.length_exponent); };
    PulledLinks result(given.units);
    result.turns_freely = given.support.symmetric;
    if (!given.support.firm) {
        result.stiffness = static_cast<double>(given.support.stiffness);
        result.carriage = static_cast<double>(given.support.carriage);
    }
    const std::vector<Link<double>> links = rounded<double>(given.links);
    const std::vector<double> pull = pulls(links, shape, given.units);
    for (Index m = 0; m < rig.size(); ++m) {
        const auto i = static_cast<std::size_t>(m);
        const double delta = shape.inclination[m], c = std::cos(delta), wheel = rig.flywheel(m).axial_moment;
        const double about = in_lengths(in_lengths(std::ldexp(wheel, -given.units.weight_exponent)));
        Link<double> link = links[i];  // as a body: what turns with it lessened what it resists turning with
        link.cross =
            static_cast<double>(given.given[i].cross - Wide<double>(about / link.length) / given.given[i].length);
        const double kept = height * static_cast<double>(given.speed * given.given[i].spin);
        result.add(link, delta, pull[i] + about / link.length, in_lengths(shape.offset[m]),
                   kept * link.length + about * c, about);
    }
    if (result.yields()) result.offset.push_back(in_lengths(shape.offset[rig.size()]));
    return result;
}

inline bool displaces_turning_fluid(const Rig& rig) {
    for (Index m = 0; rig.fluid() == Fluid::turning && m < rig.size(); ++m)
        if (rig.displaced(m).weight > 0) return true;
    return false;
}

/// The verdict where the kinetic energy is not known, but for that it is positive and that 0 is rest in the turning
/// frame: a shape whose potential energy there is least, but for a rotation, is stable; of any other nothing is known.
REVCHAIN_INLINE Stability judged_by_energy(StabilityFrame frame, const Disturbed& d) {
    const bool free = frame == StabilityFrame::free;
    Matrix<double> in_plane = d.in_plane, across(0, 0);
    if (!free) {
        in_plane -= d.turned;
    } else if (d.turns_freely) {
        const Matrix<double> others = beside(d.offset);
        across = others.transpose() * d.out_of_plane * others;
    } else {
        across = d.out_of_plane;
    }
    const pencil::Inertia inside = pencil::inertia(in_plane), outside = pencil::inertia(across);
    const double stiffness =
        std::max(in_plane.cwiseAbs().maxCoeff(), across.size() ? across.cwiseAbs().maxCoeff() : 0.0);
    Stability result;
    result.frame = frame;
    result.negative_directions = inside.negative + outside.negative;
    if (std::min(inside.least, outside.least) > 1e-14 * static_cast<double>(d.ends.rows()) * stiffness)
        result.verdict = Verdict::minimum;
    else
        result.growth_rate = std::numeric_limits<double>::quiet_NaN();
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

REVCHAIN_INLINE Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame) {
    finite::require_shape_of(chain, shape);
    const finite::PulledLinks links = pulled_links(finite::links_of(chain), shape);
    finite::Disturbed d(links);
    if (links.yields()) finite::balance_upper_end(d);
    d.hold_lower_end(links.lower_yields());
    finite::require_mass(d, links.lower_yields() ? 0 : 1);
    if (d.in_plane.size() == 0) {  // two links: nothing can move but by rotation
        Stability still;
        still.frame = frame, still.verdict = Verdict::minimum;
        return still;
    }
    finite::require_inertia(d);
    return finite::judged(frame, d, links.units);
}

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
    const Wide<double> height(shape.conical_height), speed = sqrt(Wide<double>(options.gravity) / height);
    const finite::RiggedLinks given = finite::rigged_links(rig, height, options.direction > 0 ? speed : -speed);
    const finite::PulledLinks links =
        finite::pulled_links(rig, given, shape, std::ldexp(shape.conical_height, -given.units.length_exponent));
    finite::Disturbed d(links);
    if (finite::displaces_turning_fluid(rig)) return finite::judged_by_energy(options.frame, d);
    if (links.yields()) finite::balance_upper_end(d);
    finite::require_mass(d, 0);
    finite::require_inertia(d);
    return finite::judged(options.frame, d, links.units);
}

}  // namespace revchain
