// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/assembly.hpp"
#include "revchain/linear/rig_elements.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/interval.hpp"
#include "revchain/pencil/jointed.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Signs of a quadratic form on the motions without inertia.
struct MasslessForm {
    Index size = 0;       ///< independent motions: M has at least this many zero eigenvalues
    Index negative = 0;   ///< negative eigenvalues of the form
    Index zero = 0;       ///< zero eigenvalues of the form
    bool certain = true;  ///< true if every sign is certain
};

/// The small-amplitude theory of a rig as elements. Each link has the stiffness sign
/// (tension + n spin)/length, with sign -1 if it stands, and the mass [lower cross; cross upper].
/// On top is a support that yields: a massless spring, with the carriage at its lower pin. Weights
/// are in units of 2^weight_exponent, lengths of 2^length_exponent. Lowest links without weight,
/// inertia or momentum are omitted. If the lower end is held, too, the ground of the pencil is its
/// spring or, if it is firm, the lowest link.
///
/// Steady motion is Q y = 0. Without momentum Q = lambda K - M and x = lambda. With momentum
/// Q = x^2 K + x (pace G) - M, x = pace/n, pace^2 = g, the same as K + n G - (n^2/g) M.
struct RigPencil {
    using S = Wide<double>;
    pencil::SignedPencil<S> pencil;
    ChainUnits units;
    S pace{1.0};              ///< sqrt(g) in the unit of length; n = pace/x
    bool stiffness_positive;  ///< every stiffness at rest is positive within its error: K > 0
    bool stiffness_certain;   ///< the sign of each stiffness is certain
    Index not_positive;       ///< elements whose stiffness at rest is not positive
    Index neutral = 0;        ///< of these, elements whose stiffness is certainly 0
    Index rigid = 0;          ///< 1 for a free trolley: its motion as a whole is not in `neutral`
    bool mass_not_negative;   ///< every mass is certainly positive or 0: M >= 0
    MasslessForm massless;    ///< K, or with momentum G, on the motions without inertia
    Index idle = 0;           ///< omitted lowest pins: of omitted links, or a firm end
};

namespace detail {

/// The pins that a link's mass holds: none, one combination of its pins' offsets, or both.
enum class HeldPins { nothing, lower, upper, one, both };

REVCHAIN_LAZY
HeldPins held_by(const Rig& rig, Index m) {
    const Link<double> link = rig.chain().link(m);
    const Displaced fluid = rig.displaced(m);
    const bool turning = rig.fluid() == Fluid::turning;
    const double moved = turning ? fluid.weight : fluid.added_weight;
    const Wide<double> none(0.0);
    if (rig.flywheel(m).axial_moment.high > 0) return HeldPins::both;
    if (turning && rig.fills_its_link(m) && link.weight == moved) return HeldPins::nothing;
    if (link.weight > 0 && moved > 0 && fluid.centroid != link.centroid) return HeldPins::both;
    if ((link.weight > 0 && link.gyration_ratio > none) ||
        (moved > 0 && fluid.gyration_ratio > none))
        return HeldPins::both;
    if (!(link.weight > 0) && !(moved > 0)) return HeldPins::nothing;
    const double h = link.weight > 0 ? link.centroid : fluid.centroid;
    return h == 0 ? HeldPins::upper : h == link.length ? HeldPins::lower : HeldPins::one;
}

/// Returns signs of the sum of c (y_m - y_{m+1})^2 on the motions without inertia, eliminated by
/// intervals. c is an element's stiffness or, in a quadratic family, its spin. `free`: the lowest
/// pin moves.
REVCHAIN_LAZY
MasslessForm massless_form(const pencil::SignedPencil<Wide<double>>& pencil,
                           const std::vector<HeldPins>& held, bool free) {
    using S = Wide<double>;
    using I = Interval<S>;
    const auto is_zero = [](const I& x) { return x.low == S(0.0) && x.high == S(0.0); };
    const auto sum = [&](const I& x, const I& y) {
        return is_zero(x) ? y : is_zero(y) ? x : x + y;
    };
    const auto product = [&](const I& x, const I& y) {
        return is_zero(x) || is_zero(y) ? I() : x * y;
    };
    MasslessForm form;
    const auto eliminate = [&](const I& pivot) {
        ++form.size;
        if (is_zero(pivot))
            ++form.zero;
        else if (pivot.negative())
            ++form.negative;
        else
            form.certain = form.certain && pivot.positive();
    };
    I below;  // the form of all lower pins, carried to this one
    // In most cases every pin has inertia, and there is no such motion.
    bool at_liberty = free, plain = true;
    for (const HeldPins each : held) {
        const bool unheld = each == HeldPins::nothing || each == HeldPins::upper;
        plain = plain && each != HeldPins::one && !(at_liberty && unheld);
        at_liberty = each == HeldPins::nothing || each == HeldPins::lower;
    }
    if (plain) return form;
    for (std::size_t m = 0; m < held.size(); ++m) {
        const auto& e = pencil.elements[m];
        const auto& off = e.error;
        const I c =
            pencil.quadratic ? around(e.spin, off.spin) : around(e.stiffness, off.stiffness);
        if (held[m] == HeldPins::one) {  // lower pin = -cross/lower times the upper pin
            const I ratio = -around(e.cross, off.cross) / around(e.lower, off.lower);
            below = sum(product(below, square(ratio)), product(c, square(ratio - I(S(1.0)))));
            continue;
        }
        I carried = c;  // to the upper pin, if the lower one does not move
        if (free && (held[m] == HeldPins::nothing || held[m] == HeldPins::upper)) {
            const I pivot = sum(below, c);
            eliminate(pivot);
            form.certain = form.certain && (!is_zero(pivot) || is_zero(c));
            carried = is_zero(below) || is_zero(c) ? I() : c * below / pivot;
        }
        below = carried;
        free = held[m] == HeldPins::nothing || held[m] == HeldPins::lower;
    }
    return form;
}

/// Returns the joint at the upper pin of link m. `pace` makes a dashpot a stiffness.
REVCHAIN_LAZY
pencil::Joint<Wide<double>> joint(const Rig& rig, Index m, const ChainUnits& units,
                                  const Wide<double>& pace) {
    using S = Wide<double>;
    const Pin pin = rig.pin(m);
    const int unit = units.weight_exponent + units.length_exponent;
    const S lever(std::ldexp(rig.chain().length()[m], -units.length_exponent));
    const S stiffness = ldexp(pin.stiffness, -unit), damping = ldexp(pin.damping, -unit),
            drag = ldexp(rig.drag(m), units.length_exponent - units.weight_exponent);
    for (const S& each : {stiffness, damping, drag})
        if (each.high != 0 && !(each.high > 0x1p-800 && each.high < 0x1p800))
            throw_invalid("Rig",
                          "a pin's stiffness or damping, or the drag of a link, is too far from "
                          "weight and length",
                          each.high);
    return {rig.stands(m) ? -lever : lever, stiffness, damping * pace, drag * pace / S(6.0)};
}

/// Returns the joint of a support that yields: its dashpot.
REVCHAIN_LAZY
pencil::Joint<Wide<double>> support_joint(const Support& support, const ChainUnits& units,
                                          const Wide<double>& pace) {
    using S = Wide<double>;
    const S damping = ldexp(support.damping, units.length_exponent - units.weight_exponent);
    return {S(0.0), S(0.0), damping * pace, S(0.0)};
}

/// Sets the numbers of negative and zero eigenvalues of K, which springs at pins change.
REVCHAIN_LAZY
void count_signs_of_stiffness(RigPencil& rig) {
    const RigPencil::S one(1.0), none(0.0);
    pencil::SignedPencil<RigPencil::S> links = rig.pencil;
    if (rig.rigid == 1) links.elements.pop_back(), links.joints.pop_back();
    const auto count =
        pencil::certified_count(links, pencil::JointFactors<RigPencil::S>{one, none, none, none});
    rig.stiffness_certain = count.proved;
    rig.stiffness_positive = count.proved && count.above == 0;
    rig.not_positive = count.above, rig.neutral = 0;
}

/// Returns true if a mass with these errors is certainly positive or 0.
REVCHAIN_LAZY
bool is_not_negative(const RigElement& e) {
    const pencil::ElementError<double>& off = e.error;
    const auto high = [](const Wide<double>& x) { return static_cast<double>(x); };
    using pencil::vanishes;
    if (vanishes(e.cross, off.cross) && vanishes(e.upper, off.upper))
        return high(e.lower) >= off.lower;
    if (vanishes(e.cross, off.cross) && vanishes(e.lower, off.lower))
        return high(e.upper) >= off.upper;
    const double A = high(e.lower), B = high(e.upper), X = std::abs(high(e.cross));
    const double off_squares = A * off.upper + B * off.lower + 2 * X * off.cross;
    const double error = off_squares * 1.001 + 1e-29 * (A * B + X * X);
    return A > off.lower && B > off.upper && high(e.lower * e.upper - e.cross * e.cross) > error;
}

}  // namespace detail

/// Returns the elements of a rig's links, lowest first, with the signs of those that stand.
REVCHAIN_LAZY
std::vector<RigElement> rig_elements(const Rig& rig) {
    std::vector<RigElement> elements;
    elements.reserve(static_cast<std::size_t>(rig.size()));
    const Rigging& with = rig.rigging();
    const bool plain =
        with.posture.empty() && with.displaced.empty() &&
        std::all_of(with.flywheels.begin(), with.flywheels.end(),
                    [](const Flywheel& wheel) { return wheel.axial_moment.high == 0; });
    if (!plain || !rig.chain().has_one_weight_unit()) {
        const std::vector<detail::RigLink> links = detail::rig_links(rig);
        for (Index m = 0; m < rig.size(); ++m)
            elements.push_back(rig_element(links[static_cast<std::size_t>(m)], rig.stands(m)));
        return elements;
    }
    // Links are as in a chain, except for momentum.
    using S = Wide<double>;
    const AssembledChain<double> assembled = assemble(rig.chain());
    for (const auto& e : assembled.pencil.elements)
        elements.push_back(detail::with_errors(e, assembled.pencil.entry_error));
    if (rig.has_momentum())
        for (Index m = 0; m < rig.size(); ++m) {
            RigElement& e = elements[static_cast<std::size_t>(m)];
            const S length(std::ldexp(rig.chain().length()[m], -assembled.units.length_exponent));
            const int unit = assembled.units.weight_exponent + assembled.units.length_exponent;
            e.spin = ldexp(rig.flywheel(m).momentum, -unit) / (length * length);
            e.error.spin = detail::RigLink::error_part * std::abs(e.spin.high);
        }
    return elements;
}

/// Returns the pencil of a rig, or with `lower_end` of one whose lower end is held, too: then no
/// link stands, spins or is in a fluid. With springs or dashpots at pins, and `with_joints`, the
/// pencil has joints. Every number has an error bound. Cost O(N). Throws
/// InvalidArgument as rig_links does, unless gravity > 0, and for stiffness or tension out of
/// range.
REVCHAIN_LAZY
RigPencil rig_pencil(const Rig& rig, double gravity = conical_pendulum::standard_gravity,
                     const std::optional<detail::LowerEnd>& lower_end = {},
                     bool with_joints = false) {
    using S = RigPencil::S;
    using detail::HeldPins;
    detail::require_positive("rig_pencil", "gravity", gravity);
    const std::vector<RigElement> links = rig_elements(rig);
    RigPencil result;
    result.units = rig.chain().units();
    result.pencil.quadratic = rig.has_momentum();
    result.pace = sqrt(S(std::ldexp(gravity, -result.units.length_exponent)));
    result.stiffness_positive = result.stiffness_certain = result.mass_not_negative = true;
    result.not_positive = 0;
    std::vector<HeldPins> held;
    const bool jointed = with_joints || rig.has_pin_springs() || rig.is_damped();
    const auto add = [&](const RigElement& e, HeldPins pins, bool mass_not_negative) {
        result.pencil.elements.push_back(e);
        held.push_back(pins);
        const double k = static_cast<double>(e.stiffness), off = e.error.stiffness;
        const bool neutral = k == 0 && off == 0;
        result.stiffness_positive = result.stiffness_positive && k > off;
        result.stiffness_certain = result.stiffness_certain && (neutral || std::abs(k) > off);
        result.not_positive += k > 0 ? 0 : 1, result.neutral += neutral ? 1 : 0;
        result.mass_not_negative = result.mass_not_negative && mass_not_negative;
    };
    if (lower_end)
        if (auto spring = support_element(lower_end->support, result.units)) {
            std::swap(spring->lower, spring->upper);
            add(*spring,
                lower_end->support.carriage_weight > 0 ? HeldPins::upper : HeldPins::nothing, true);
        }
    for (Index m = 0; m < rig.size(); ++m) {
        RigElement e = links[static_cast<std::size_t>(m)];
        if (lower_end) e = lower_end->pulled(e, rig.chain().length()[m], result.units);
        if (result.pencil.elements.empty() && detail::is_nothing(e) && rig.pin(m) == Pin{} &&
            rig.drag(m) == S(0.0)) {
            ++result.idle;
            continue;
        }
        e.spin = e.spin * result.pace, e.error.spin *= result.pace.high;
        if (jointed)
            result.pencil.joints.push_back(detail::joint(rig, m, result.units, result.pace));
        const bool dry = rig.fluid() == Fluid::still || rig.displaced(m).weight == 0;
        const bool plain = rig.flywheel(m).axial_moment.high == 0 && dry;
        add(e, detail::held_by(rig, m), plain || detail::is_not_negative(e));
    }
    const Support& support = rig.support();
    if (const auto spring = support_element(support, result.units)) {
        const bool positive = result.stiffness_positive;
        add(*spring, support.carriage_weight > 0 ? HeldPins::lower : HeldPins::nothing, true);
        if (support.is_free()) {
            result.rigid = 1, --result.neutral, --result.not_positive;
            result.stiffness_positive = positive;
        }
        if (jointed)
            result.pencil.joints.push_back(
                detail::support_joint(support, result.units, result.pace));
    }
    if (jointed) detail::count_signs_of_stiffness(result);
    result.massless = detail::massless_form(result.pencil, held, !lower_end);
    if (lower_end) {
        result.pencil.ground = result.pencil.elements.front();
        result.pencil.elements.erase(result.pencil.elements.begin());
        result.idle = lower_end->support.is_firm() ? 1 : 0;
    }
    return result;
}

}  // namespace revchain
