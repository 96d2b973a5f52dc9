// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <complex>
#include <optional>

#include "revchain/finite/held/shape.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/finite/stability/damped.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns the verdict from squares of exponents and their errors. A square farther from the
/// negative numbers than its error is unstable. A negative square separated from all others stays
/// imaginary. Squares leave the real axis in pairs, and those of a symmetric matrix never leave it.
REVCHAIN_LAZY
Verdict verdict_by(const std::vector<std::complex<double>>& square,
                   const std::vector<double>& error, bool is_symmetric) {
    bool still = true;
    for (std::size_t j = 0; j < square.size(); ++j) {
        const double off = square[j].real() > 0 ? std::abs(square[j]) : std::abs(square[j].imag());
        if (off > error[j]) return Verdict::unstable;
        still = still && square[j].imag() == 0 && square[j].real() < -error[j];
        for (std::size_t k = 0; k < j && !is_symmetric; ++k)
            still = still && std::abs(square[j] - square[k]) > error[j] + error[k];
    }
    return still ? Verdict::spectrally_stable : Verdict::undecided;
}

/// Returns the verdict on a disturbed shape; none if rounding leaves a mass matrix indefinite. To
/// first order damping c (F, H) changes an exponent by
///     ds = - c (s^2 q'F q - Y'H Y) / (2 (s^2 q'A q - Y'N Y - 2 q'B Y)),    Y = s b,
/// since (q, -b) is the left mode. Drag in space adds -2 q'X'E Y to the numerator, with X'E the
/// `drag_coupling`. Changes of the matrices move s^2 by the same formula. The error of s^2 adds the
/// residual of a mode and its rounding, the error of the eigenvalue solver, and the effect of
/// relative errors of masses and pulls.
template <class S>
std::optional<Judgement> judged_in(StabilityFrame frame, const DisturbedIn<S>& d,
                                   const ChainUnits& units) {
    const Framed<S> framed(frame, d);
    const pencil::GyroscopicPencil<S>& forms = framed.forms;
    const auto found = pencil::gyroscopic_modes(forms);
    if (!found) return std::nullopt;
    const pencil::GyroscopicModes<S>& modes = *found;
    const pencil::ComplexColumns<S>&q = modes.x, &r = modes.y;

    Judgement judgement;
    Stability& result = judgement.stability;
    result.frame = frame;
    const double pins = std::ldexp(1.0, -units.weight_exponent - 2 * units.length_exponent),
                 air = std::ldexp(1.0, units.length_exponent - units.weight_exponent);
    const pencil::ComplexColumns<S> Y = framed.out_of_plane(q, r, d.offset);
    const auto size = [](const Matrix<S>& A) { return as_double(A.norm()); };
    const double in_A = size(forms.A), in_B = size(forms.B), in_M = size(forms.M);
    const double in_K = size(forms.K), in_C = size(forms.C),
                 rounding = as_double(std::numeric_limits<S>::epsilon());
    std::vector<std::complex<double>> square;
    std::vector<double> error;
    std::vector<JudgedMode> list;
    for (Index j = 0; j < modes.square.size(); ++j) {
        const std::complex<S> of = modes.square[j], two(S(2));
        const auto form = [&](const Matrix<S>& A, const Matrix<S>& B, const Matrix<S>& M) {
            return of * bilinear(q, A, q, j) - two * bilinear(q, B, Y, j) - bilinear(Y, M, Y, j);
        };
        const std::complex<double> norm = rounded(two * form(d.inertia, d.coupling, d.mass));
        const std::complex<double> turned =
            rounded(of * bilinear(q, d.bending, q, j) - bilinear(Y, d.swivelling, Y, j));
        const double inner = -pins * (turned / norm).real();
        const std::complex<double> dragged =
            rounded(form(d.drag_in_plane, d.drag_coupling, d.drag_across));
        const double outer = -air * (dragged / norm).real();

        const std::complex<double> s2 = rounded(of);
        const double far = std::abs(s2);
        const auto total = [&](double A, double B, double M, double K, double C) {
            return far * A + K + 4 * B + M + (far > 0 ? C / far : 0.0);
        };
        const std::complex<S> left = of * bilinear(q, forms.A, q, j) + bilinear(q, forms.K, q, j) -
                                     two * two * bilinear(q, forms.B, r, j) -
                                     bilinear(r, forms.M, r, j) - bilinear(r, forms.C, r, j) / of;
        const double x = squared_norm(q, j), y = squared_norm(r, j);
        const double alpha = hermitian(q, forms.A, j), mu = hermitian(r, forms.M, j);
        const double given =
            total(alpha, std::sqrt(alpha * mu), mu, d.doubt * x + alpha, d.doubt * y + mu);
        const double computed =
            total(in_A * x, in_B * std::sqrt(x * y), in_M * y, in_K * x, in_C * y);
        const double missing = far > 0 ? std::abs(rounded(left)) : 0.0;
        const double changed = missing + 4 * 0x1p-52 * given + rounding * computed;
        constexpr double safety = 100;
        square.push_back(s2);
        error.push_back(safety * (modes.error[j] + 2 * far / std::abs(norm) * changed));
        const std::complex<double> s = std::sqrt(s2);
        const double off = error_of_root(far, error.back());
        for (const std::complex<double>& each : {s, 0.0 - s})
            list.push_back({each, inner, outer, off});
        result.growth_rate = std::max(result.growth_rate, std::abs(s.real()));
        result.margin = std::max(result.margin, off);
    }
    double largest = 0;
    for (std::size_t j = 0; j < square.size(); ++j) {
        largest = std::max(largest, std::sqrt(std::abs(square[j])));
        for (std::size_t k = 0; k < square.size(); ++k)  // equal squares have no separate modes
        {
            const double near = 1e-10 * std::abs(square[j]) + 10 * (error[j] + error[k]);
            if (k == j || !(std::abs(square[j] - square[k]) <= near)) continue;
            for (const std::size_t i : {2 * j, 2 * j + 1})
                list[i].internal = list[i].external = std::numeric_limits<double>::quiet_NaN();
        }
    }
    const double lost = 5e-11 * std::max(1.0, as_double(square.size()) / 16);
    for (std::size_t j = 0; j < square.size(); ++j) {
        const double far = std::abs(square[j]),
                     near = std::min(largest, 100 * std::max(1.0, std::sqrt(far)));
        judgement.is_spoilt |= error_of_root(far, error[j]) > lost * near;
    }
    store(result, std::move(list));
    set_verdict(result, framed, d, verdict_by(square, error, modes.is_symmetric));
    return judgement;
}

REVCHAIN_LAZY
Stability judged(StabilityFrame frame, const Disturbed& d, const ChainUnits& units) {
    const auto found = judged_in(frame, d, units);
    return found ? found->stability : Stability();
}

/// Returns disturbed links with the constraints of their ends.
template <class S>
DisturbedIn<S> disturbed_in(const PulledLinks& links) {
    DisturbedIn<S> d(links);
    if (links.top_is_massless()) d.balance_upper_end();
    if (links.held) d.hold_lower_end(links.lower_yields());
    return d;
}

/// Throws InvalidArgument if a moving pin has no mass, except a balanced upper end.
REVCHAIN_LAZY
void require_mass(const PulledLinks& links, const Disturbed& d) {
    constexpr std::string_view place = "stability";
    const auto top = static_cast<Index>(links.links.size());
    for (const Index pin : d.massless)
        if (pin > 0 ? pin < top : !links.held || links.lower_yields())
            detail::throw_invalid(place, "pins must have mass; one that has none is number", pin);
    if (links.top_is_massless() && links.momentum.back() != 0)
        detail::throw_invalid(
            place,
            "a flywheel must not act on a support without mass; give it a carriage weight, now",
            0.0);
    if (links.top_is_massless() && !links.damping.empty())
        detail::throw_invalid(
            place,
            "with dashpots a support must not be without mass; give it a carriage weight, now",
            0.0);
}

/// Returns the verdict on a shape, in double. With thorough means it is in double-double if
/// rounding spoils the result in double.
template <class Means>
Stability judged(StabilityFrame frame, const PulledLinks& links, Means) {
    const Disturbed d = disturbed_in<double>(links);
    require_mass(links, d);
    const auto axial =
        std::find_if(links.axial.begin(), links.axial.end(), [](double each) { return each != 0; });
    if (d.is_damped() && d.turns_freely && frame == StabilityFrame::free &&
        axial != links.axial.end())
        detail::throw_invalid(
            "stability",
            "dashpots and a driven wheel are not solved together in the free frame of a support on "
            "the axis; give it an arm, or ask for the driven frame; link",
            axial - links.axial.begin());
    if (d.in_plane.size() == 0) {  // two links held at both ends can only rotate
        Stability still;
        still.frame = frame, still.verdict = Verdict::minimum;
        return still;
    }
    const auto in = [&]<class S>(const DisturbedIn<S>& disturbed) {
        return disturbed.is_damped() ? judged_damped_in(frame, disturbed, links.units)
                                     : judged_in(frame, disturbed, links.units);
    };
    auto found = in(d);
    constexpr Index most_in_words = 100;  ///< unknowns; so many take half a second
    if constexpr (detail::is_thorough<Means>)
        if ((!found || found->is_spoilt) && d.in_plane.rows() + d.mass.rows() <= most_in_words)
            if (auto finer = in(disturbed_in<detail::CalledWords>(links))) found = std::move(finer);
    if (!found) {
        constexpr std::string_view rule =
            detail::is_thorough<Means> ? "every motion must move some mass; pins that move"
                                       : "every motion must move some mass, and in double that is "
                                         "in doubt; revchain::thorough as the last argument "
                                         "computes with twice the digits; pins that move";
        detail::throw_invalid("stability", rule, d.mass.rows());
    }
    return found->stability;
}
template <class Shape, class Means>
Stability judged(StabilityFrame frame, const Chain<double>& chain, const Shape& shape,
                 Means means) {
    require_shape_of(chain, shape);
    return judged(frame, pulled_links(links_of(chain), shape), means);
}

/// Returns the shape of a rig as pulled links, at a height and speed n > 0. Momentum p of a link
/// about itself adds p over its horizontal length, p/(a cos), to the pull.
REVCHAIN_LAZY
PulledLinks pulled_links(const Rig& rig, const RiggedLinks& given, const SteadyShape& shape,
                         double height, double speed) {
    const auto in_lengths = [&](double x) { return std::ldexp(x, -given.units.length_exponent); };
    PulledLinks result(given.units);
    result.turns_freely = given.support.symmetric;
    if (!given.support.firm) {
        result.stiffness = as_double(given.support.stiffness);
        result.carriage = as_double(given.support.carriage);
    }
    const std::vector<Link<double>> links = rounded<double>(given.links);
    const auto [pull, doubt] = pulls(links, shape, given.units);
    for (Index m = 0; m < rig.size(); ++m) {
        const auto i = static_cast<std::size_t>(m);
        const double delta = shape.inclination[m], c = std::cos(delta),
                     wheel = rig.flywheel(m).axial_moment.high;
        const double about =
            in_lengths(in_lengths(std::ldexp(wheel, -given.units.weight_exponent)));
        Link<Fine> link = given.links[i];
        // as a body: in `given`, inertia that turns with the link lessens its resistance
        link.cross = given.given[i].cross - Fine(about) / (link.length * given.given[i].length);
        const double kept = height * as_double(given.speed * given.given[i].spin),
                     a = links[i].length;
        result.add(link, delta, pull[i] + about / a, doubt[i] + std::abs(about / a),
                   kept * a + about * c, about);
        if (!rig.is_damped()) continue;
        const double damping = std::ldexp(rig.pin(m).damping.high, -given.units.weight_exponent);
        result.damping.resize(result.links.size());
        result.damping.back() = height * speed * in_lengths(damping);
    }
    result.upper_offset = in_lengths(shape.offset[rig.size()]);
    return result;
}

REVCHAIN_LAZY
bool displaces_turning_fluid(const Rig& rig) {
    for (Index m = 0; rig.fluid() == Fluid::turning && m < rig.size(); ++m)
        if (rig.displaced(m).weight > 0) return true;
    return false;
}

/// Returns the verdict if the kinetic energy is unknown, but positive and 0 at rest in the turning
/// frame. A shape with minimal potential energy, apart from a rotation, is stable.
REVCHAIN_LAZY
Stability judged_by_energy(StabilityFrame frame, const Disturbed& d) {
    const bool free = frame == StabilityFrame::free;
    Matrix<double> in_plane = d.in_plane, across(0, 0);
    if (!free) {
        in_plane -= d.turned;
    } else if (d.turns_freely) {
        const Matrix<double> others = complement(Matrix<double>(d.offset));
        across = congruent(d.out_of_plane, others);
    } else {
        across = d.out_of_plane;
    }
    const EnergySigns signs = energy_signs(in_plane, across, d.ends.rows());
    Stability result;
    result.frame = frame;
    result.negative_directions = signs.negative;
    if (signs.is_minimum)
        result.verdict = Verdict::minimum;
    else
        result.growth_rate = std::numeric_limits<double>::quiet_NaN();
    return result;
}

template <class Means>
Stability judged(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options,
                 Means means) {
    constexpr std::string_view place = "stability";
    detail::require_positive(place, "gravity", options.gravity, "conical height of the shape",
                             shape.conical_height);
    require_shape_of(rig.chain(), shape);
    detail::require_no_pins(place, "stability", rig, false);
    const Support& support = rig.support();
    const double end = shape.offset[rig.size()];
    if (support.is_firm() &&
        !(std::abs(end - support.radius) <= 1e-12 * (support.radius + rig.chain().total_length())))
        detail::throw_invalid(place, "the shape is not of this rig; its upper end is at", end);
    const Wide<double> height(shape.conical_height),
        speed = sqrt(Wide<double>(options.gravity) / height);
    const bool forward = options.direction == Rotation::forward;
    const RiggedLinks given = rigged_links(rig, height, forward ? speed : -speed);
    const PulledLinks links =
        pulled_links(rig, given, shape,
                     std::ldexp(shape.conical_height, -given.units.length_exponent), speed.high);
    if (displaces_turning_fluid(rig)) return judged_by_energy(options.frame, Disturbed(links));
    return judged(options.frame, links, means);
}

}  // namespace revchain::finite
