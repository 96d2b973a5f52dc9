// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/moved_support.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/superposed.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/swing.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns the rig for a swing. Links do not turn about their own axes, so axial moments are set to
/// 0. Throws InvalidArgument for a support carried round and for a fluid that turns.
REVCHAIN_LAZY
Rig swinging(std::string_view place, const Rig& rig) {
    require_no_pins(place, "the swing", rig);
    if (rig.support().radius != 0)
        throw_invalid(place,
                      "the support is carried round: it does not let the rig swing; use response",
                      rig.support().radius);
    for (Index m = 0; rig.fluid() == Fluid::turning && m < rig.size(); ++m)
        if (rig.displaced(m).weight != 0)
            throw_invalid(
                place,
                "links[" + std::to_string(m) +
                    "] is in a fluid that turns; a rig swings in a fluid at rest: write \"still\"",
                rig.displaced(m).weight);
    return without_axial_moments(rig);
}

/// Returns the modes of a rig. Throws InvalidArgument if small offsets grow or have no restoring
/// force.
REVCHAIN_LAZY
RigModes stable_modes(std::string_view place, const Rig& rig, const RigPencil& pencil,
                      double gravity, Index count, Progress* progress) {
    if (pencil.idle > 0)
        throw_invalid(place,
                      "lowest links that weigh nothing and move nothing have no motion of their "
                      "own; leave out",
                      pencil.idle);
    RigModes found =
        modes(rig, {.count = std::max<Index>(count, 1), .gravity = gravity, .progress = progress});
    double growth = 0;
    for (const OtherMode& mode : found.other) growth = std::max(growth, mode.growth_rate);
    if (growth > 0)
        throw_invalid(place,
                      "the growth rate of small offsets from the straight rig must be 0, or it "
                      "falls: see `other` of its modes; 1/s",
                      growth);
    if (found.other_available > 0)
        throw_invalid(place,
                      "something must draw every motion of the rig back; `other` of its modes has "
                      "those of which this is not so",
                      found.other_available);
    return found;
}

/// Two lists of offsets: along x and along y.
using PlaneOffsets = std::array<std::vector<Wide<double>>, 2>;

/// Products of offsets with the matrices of a rig's pencil, in double words.
class WhirlForms : public PencilForms<pencil::SignedPencil<Wide<double>>> {
   public:
    using Offsets = std::vector<S>;
    using PencilForms::PencilForms;

    S momentum(const Offsets& u, const Offsets& v) const {  // times the pace
        return sum([&](const Element& e, std::size_t m) {
            return e.spin * (u[m] - u[m + 1]) * (v[m] - v[m + 1]);
        });
    }
    /// Returns the bound that `OscillatingChain::residual` defines, for Q(x) y over x^2.
    double residual(const S& x, const Offsets& y) const {
        S carried(0.0), pin(0.0);
        double size = 0, off = 0, squares = 0, count = 16;
        const double square = (x * x).high, at = std::abs(x.high);
        for (std::size_t m = 0; m + 1 < y.size(); ++m) {
            const Element& e = pencil().elements[m];
            const S lower = e.lower * y[m] + e.cross * y[m + 1];
            const S spring = (x * x * e.stiffness + x * e.spin) * (y[m] - y[m + 1]);
            carried = carried + pin + lower, pin = e.cross * y[m] + e.upper * y[m + 1];
            const double near = std::abs(y[m].high), far = std::abs(y[m + 1].high);
            const double cross = std::abs(e.cross.high), spin = std::abs(e.spin.high);
            size += (e.lower.high + cross) * near + (e.upper.high + cross) * far;
            off += (e.error.lower + e.error.cross) * near + (e.error.upper + e.error.cross) * far;
            const double pulled = (square * e.stiffness.high + at * spin) * (near + far);
            const double rounding = 0x1p-100 * (count += 4) * (size + pulled) + off;
            const double force = std::abs((spring - carried).high) + rounding +
                                 (square * e.error.stiffness + at * e.error.spin) * (near + far);
            squares += force * force / e.stiffness.high;
        }
        return std::sqrt(squares) / square * (1 + 1e-10);
    }
    /// Twice the energy of offsets and velocities; forces and weights are in one unit.
    double energy(const PlaneOffsets& offset, const PlaneOffsets& velocity, const S& pace) const {
        double twice = 0;
        for (const Offsets& y : offset) twice += std::max(0.0, stiffness(y, y).high);
        for (const Offsets& v : velocity)
            twice += std::max(0.0, (inertia(v, v) / (pace * pace)).high);
        return twice * (1 + 1e-10);
    }
};

REVCHAIN_LAZY
PlaneOffsets in_double_words(const Vector<std::complex<double>>& given, std::size_t pins) {
    PlaneOffsets result;
    for (const auto& y : given) result[0].push_back(y.real()), result[1].push_back(y.imag());
    for (auto& offsets : result) offsets.resize(pins);
    return result;
}

/// A whirl speed, negative backwards, and its shape.
struct RoughWhirl {
    double speed;
    Vector<double> shape;
};
/// The whirls of both senses, slowest first.
REVCHAIN_LAZY
std::vector<RoughWhirl> merged(const RigModes& found) {
    std::vector<RoughWhirl> all;
    for (const WhirlModes* sense : {&found.forward, &found.backward})
        for (Index j = 0; j < sense->size(); ++j)
            all.push_back({(sense == &found.forward ? 1 : -1) * sense->angular_speed[j],
                           sense->shapes().row(j).transpose()});
    std::stable_sort(all.begin(), all.end(), [](const RoughWhirl& x, const RoughWhirl& y) {
        return std::abs(x.speed) < std::abs(y.speed);
    });
    return all;
}

/// Finds the amplitude of each whirl, in double words, and subtracts that whirl from the start.
REVCHAIN_LAZY
Superposition split_start(WhirlSwing& result, const RigPencil& rig, const WhirlForms& forms,
                          const std::vector<RoughWhirl>& rough, PlaneOffsets& rest,
                          PlaneOffsets& rest_speed, Progress* progress) {
    using S = Wide<double>;
    const Index count = result.shape.rows(), pins = result.shape.cols();
    const int unit = rig.units.weight_exponent - rig.units.length_exponent;
    Superposition whirls{16, 2};
    for (Index k = 0; k < count; ++k) {
        const RoughWhirl& whirl = rough[static_cast<std::size_t>(k)];
        std::vector<S> shape(rest[0].size());
        std::copy(whirl.shape.begin(), whirl.shape.end(), shape.begin());
        const S x = pencil::rayleigh_quotient(rig.pencil, shape, rig.pace / S(whirl.speed));
        const S n = rig.pace / x;
        shape = pencil::twisted_vector(rig.pencil, x);
        const S part = S(2.0) / x * forms.inertia(shape, shape) - forms.momentum(shape, shape);
        // c = [ (1/x) y M u - y s u - i y M u'/pace ] / part
        const auto of = [&](const std::vector<S>& u) {
            return forms.inertia(shape, u) / x - forms.momentum(shape, u);
        };
        const auto moved = [&](const std::vector<S>& v) {
            return forms.inertia(shape, v) / rig.pace;
        };
        const S c = (of(rest[0]) + moved(rest_speed[1])) / part;
        const S d = (of(rest[1]) - moved(rest_speed[0])) / part;
        for (std::size_t m = 0; m < shape.size(); ++m) {
            rest[0][m] = rest[0][m] - c * shape[m], rest[1][m] = rest[1][m] - d * shape[m];
            rest_speed[0][m] = rest_speed[0][m] + n * d * shape[m];
            rest_speed[1][m] = rest_speed[1][m] - n * c * shape[m];
        }
        for (Index m = 0; m < pins; ++m)
            result.shape(k, m) = shape[static_cast<std::size_t>(m)].high;
        result.angular_speed[k] = n.high;
        result.amplitude[k] = {c.high, d.high};
        result.energy[k] = std::ldexp(0.5 * ((c * c + d * d) * part / x).high, unit);
        double residual = std::numeric_limits<double>::infinity();
        if (rig.stiffness_positive) residual = forms.residual(x, shape);
        whirls.add(DoubleDouble(n), result.amplitude[k], residual, result.shape.row(k).transpose());
        advance(progress, 0.5 * static_cast<double>(k + 1) / static_cast<double>(count));
    }
    return whirls;
}

}  // namespace detail

REVCHAIN_DEFINE
Swing swing(const Rig& given, const SwingOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "swing";
    if (given.has_momentum())
        throw_invalid(place, "momentum of flywheels turns the plane of the swing; use whirl_swing");
    const Rig rig = swinging(place, given);
    const auto [from, speed] = checked_start(place, rig.size(), !rig.support().is_firm(), options);
    const RigPencil pencil = rig_pencil(rig, options.gravity);
    const auto found = [&](Index first, Index number) {
        if (number == 0) return WhirlModes{};
        RigModesOptions asked{.first = first, .count = number};
        asked.gravity = options.gravity, asked.progress = options.progress;
        return modes(rig, asked).forward;
    };
    const Index all =
        stable_modes(place, rig, pencil, options.gravity, 1, nullptr).forward.available;
    const auto elements = pencil::positive_elements<false>(pencil.pencil);
    if (!pencil.stiffness_positive || !pencil.mass_not_negative || !elements)
        throw_invalid(place,
                      "weights cancel but for their last digits, or a link without mass stands");
    using S = DoubleDouble;
    AssembledChain<S> assembled{{}, pencil.units};
    for (const auto& e : elements->elements)
        assembled.pencil.elements.push_back({S(e.stiffness), S(e.lower), S(e.upper), S(e.cross),
                                             S(e.turning),
                                             S((e.lower + e.cross) + (e.cross + e.upper))});
    assembled.pencil.entry_error = elements->entry_error;
    const OscillatingChain system(std::move(assembled));
    return superposed<Swing>(place, system, options, from, speed, all, found);
}

REVCHAIN_DEFINE
WhirlSwing whirl_swing(const Rig& given, const WhirlSwingOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "whirl_swing";
    const Rig rig = swinging(place, given);
    if (!rig.has_momentum())
        throw_invalid(
            place, "no flywheel has momentum: the two level directions are independent; use swing");
    const auto [from, speed] = checked_start(place, rig.size(), !rig.support().is_firm(), options);
    const RigPencil pencil = rig_pencil(rig, options.gravity);
    if (pencil.massless.size > 0)
        throw_invalid(
            place, "pins without inertia beside flywheels with momentum: give each some; there are",
            pencil.massless.size);
    const RigModes found = stable_modes(place, rig, pencil, options.gravity,
                                        options.count.value_or(all_modes), options.progress);
    const Index all = found.forward.available + found.backward.available;
    const Index count = checked_count(place, options.count, all);

    const Index pins = rig.size() + 1;
    WhirlSwing result;
    result.shape.resize(count, pins);
    result.amplitude.resize(count);
    for (auto* column : {&result.angular_speed, &result.energy}) column->resize(count);
    const auto all_pins = static_cast<std::size_t>(pencil.pencil.size() + 1);
    PlaneOffsets rest = in_double_words(from, all_pins);
    PlaneOffsets rest_speed = in_double_words(speed, all_pins);
    const WhirlForms forms(pencil.pencil);
    const Superposition whirls =
        split_start(result, pencil, forms, merged(found), rest, rest_speed, options.progress);

    // If every link is in tension, the energy bounds what is left.
    LeftOut left{std::numeric_limits<double>::infinity(), Vector<double>::Ones(pins),
                 pencil.units.weight_exponent - pencil.units.length_exponent};
    if (pencil.stiffness_positive) {
        left.size = std::sqrt(forms.energy(rest, rest_speed, pencil.pace));
        left.flexibility = forms.flexibility();
    }
    superpose(result, whirls, left, options);
    return result;
}

}  // namespace revchain
