// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/twisted.hpp"
#include "revchain/questions/superposed.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/swing.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// The rig as it swings: links do not turn about their own axes, so that what turns with them plays no part.
inline Rig swinging(std::string_view place, const Rig& rig) {
    if (rig.support().radius != 0)
        throw_invalid(place, "the support is carried round: it does not let the rig swing; use response",
                      rig.support().radius);
    if (rig.fluid() == Fluid::turning)
        for (Index m = 0; m < rig.size(); ++m)
            if (rig.displaced(m).weight != 0)
                throw_invalid(place,
                              "links[" + std::to_string(m) +
                                  "] is in a fluid that turns; a rig swings in a fluid at rest: write \"still\"",
                              rig.displaced(m).weight);
    Rigging with = rig.rigging();
    for (Flywheel& wheel : with.flywheels) wheel.axial_moment = 0.0;
    return {rig.chain(), std::move(with)};
}

/// Throws InvalidArgument where small offsets from the straight rig grow, or nothing draws them back.
inline void require_stable(std::string_view place, const RigModes& found) {
    double growth = 0;
    for (const OtherMode& mode : found.other) growth = std::max(growth, mode.growth_rate);
    if (growth > 0)
        throw_invalid(
            place,
            "the growth rate of small offsets from the straight rig must be 0, or it falls: see `other` of its "
            "modes; 1/s",
            growth);
    if (found.other_available > 0)
        throw_invalid(place,
                      "something must draw every motion of the rig back; `other` of its modes has those of which "
                      "this is not so",
                      found.other_available);
}

/// The modes of a rig all of whose motions are oscillations.
inline RigModes stable_modes(std::string_view place, const Rig& rig, const RigPencil& pencil, double gravity,
                             Index count, Progress* progress) {
    if (pencil.idle > 0)
        throw_invalid(place, "lowest links that weigh nothing and move nothing have no motion of their own; leave out",
                      pencil.idle);
    RigModes found = modes(rig, {.count = std::max<Index>(count, 1), .gravity = gravity, .progress = progress});
    require_stable(place, found);
    return found;
}

/// Two lists of offsets: along x and along y.
using PlaneOffsets = std::array<std::vector<Wide<double>>, 2>;

/// Products of offsets with the matrices of a rig's pencil, in double words.
class WhirlForms {
   public:
    using S = Wide<double>;
    using Offsets = std::vector<S>;

    explicit WhirlForms(const RigPencil& rig) : elements_(rig.pencil.elements) {}

    S inertia(const Offsets& u, const Offsets& v) const {
        return sum([&](const RigElement& e, std::size_t m) {
            return u[m] * (e.lower * v[m] + e.cross * v[m + 1]) + u[m + 1] * (e.cross * v[m] + e.upper * v[m + 1]);
        });
    }
    S momentum(const Offsets& u, const Offsets& v) const {  // times the pace
        return sum([&](const RigElement& e, std::size_t m) { return e.spin * (u[m] - u[m + 1]) * (v[m] - v[m + 1]); });
    }
    S stiffness(const Offsets& u) const {
        return sum(
            [&](const RigElement& e, std::size_t m) { return e.stiffness * (u[m] - u[m + 1]) * (u[m] - u[m + 1]); });
    }
    /// As `OscillatingChain::residual`, of Q(x) y over x^2.
    double residual(const S& x, const Offsets& y) const {
        S carried(0.0), pin(0.0);
        double size = 0, off = 0, squares = 0, count = 16;
        const double square = (x * x).high, at = std::abs(x.high);
        for (std::size_t m = 0; m < elements_.size(); ++m) {
            const RigElement& e = elements_[m];
            const S lower = e.lower * y[m] + e.cross * y[m + 1], upper = e.cross * y[m] + e.upper * y[m + 1];
            const S spring = (x * x * e.stiffness + x * e.spin) * (y[m] - y[m + 1]);
            carried = carried + pin + lower, pin = upper;
            const double near = std::abs(y[m].high), far = std::abs(y[m + 1].high), cross = std::abs(e.cross.high);
            size += (e.lower.high + cross) * near + (e.upper.high + cross) * far;
            off += (e.error.lower + e.error.cross) * near + (e.error.upper + e.error.cross) * far;
            const double pulled = (square * e.stiffness.high + at * std::abs(e.spin.high)) * (near + far);
            const double force = std::abs((spring - carried).high) + 0x1p-100 * (count += 4) * (size + pulled) + off +
                                 (square * e.error.stiffness + at * e.error.spin) * (near + far);
            squares += force * force / e.stiffness.high;
        }
        return std::sqrt(squares) / square * (1 + 1e-10);
    }
    /// |y_m|^2 <= flexibility_m y^T K y, where every stiffness is positive.
    Vector<double> flexibility() const {
        Vector<double> result(static_cast<Index>(elements_.size()) + 1);
        result[result.size() - 1] = 0;
        for (Index m = result.size() - 1; m-- > 0;)
            result[m] = result[m + 1] + (1 + 1e-14) / elements_[static_cast<std::size_t>(m)].stiffness.high;
        return result;
    }
    /// The energy of offsets and velocities, times 2; forces and weights are in one unit.
    double energy(const PlaneOffsets& offset, const PlaneOffsets& velocity, const S& pace) const {
        double sum = 0;
        for (const std::size_t i : {0U, 1U})
            sum += std::max(0.0, stiffness(offset[i]).high) +
                   std::max(0.0, (inertia(velocity[i], velocity[i]) / (pace * pace)).high);
        return sum * (1 + 1e-10);
    }

   private:
    template <class F>
    S sum(const F& f) const {
        S total(0.0);
        for (std::size_t m = 0; m < elements_.size(); ++m) total = total + f(elements_[m], m);
        return total;
    }
    const std::vector<RigElement>& elements_;
};

inline PlaneOffsets in_double_words(const Vector<std::complex<double>>& given, std::size_t pins) {
    PlaneOffsets result{std::vector<Wide<double>>(pins), std::vector<Wide<double>>(pins)};
    for (Index m = 0; m < given.size(); ++m) {
        const auto i = static_cast<std::size_t>(m);
        result[0][i] = given[m].real(), result[1][i] = given[m].imag();
    }
    return result;
}

/// Speeds of either sense, slowest first, with the shapes that belong to them.
struct RoughWhirls {
    std::vector<double> speed;
    std::vector<Vector<double>> shape;
};
inline RoughWhirls merged(const RigModes& found) {
    std::vector<std::pair<double, std::pair<const WhirlModes*, Index>>> all;
    for (const WhirlModes* sense : {&found.forward, &found.backward})
        for (Index j = 0; j < sense->size(); ++j)
            all.push_back({(sense == &found.forward ? 1 : -1) * sense->angular_speed[j], {sense, j}});
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& x, const auto& y) { return std::abs(x.first) < std::abs(y.first); });
    RoughWhirls result;
    for (const auto& [speed, from] : all) {
        result.speed.push_back(speed);
        result.shape.push_back(from.first->shapes().row(from.second).transpose());
    }
    return result;
}

/// Finds the amplitude of each whirl, once more in double words, and takes it from the start; see `whirl_swing`.
inline Superposition split_start(WhirlSwing& result, const RigPencil& rig, const RoughWhirls& rough,
                                 PlaneOffsets& rest, PlaneOffsets& rest_speed, Progress* progress) {
    using S = Wide<double>;
    const WhirlForms forms(rig);
    const Index count = result.shape.rows(), pins = result.shape.cols();
    Superposition whirls{16, 2};
    for (Index k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        std::vector<S> shape(rest[0].size());
        for (Index m = 0; m < pins; ++m) shape[static_cast<std::size_t>(m)] = rough.shape[at][m];
        const S x = pencil::rayleigh_quotient(rig.pencil, shape, rig.pace / S(rough.speed[at])), n = rig.pace / x;
        shape = pencil::twisted_vector(rig.pencil, x);
        const S part = S(2.0) / x * forms.inertia(shape, shape) - forms.momentum(shape, shape);
        // c = [ (1/x) y M u - y s u - i y M u'/pace ] / part
        const auto of = [&](const std::vector<S>& u) { return forms.inertia(shape, u) / x - forms.momentum(shape, u); };
        const auto moved = [&](const std::vector<S>& v) { return forms.inertia(shape, v) / rig.pace; };
        const S c = (of(rest[0]) + moved(rest_speed[1])) / part, d = (of(rest[1]) - moved(rest_speed[0])) / part;
        for (std::size_t m = 0; m < shape.size(); ++m) {
            rest[0][m] = rest[0][m] - c * shape[m], rest[1][m] = rest[1][m] - d * shape[m];
            rest_speed[0][m] = rest_speed[0][m] + n * d * shape[m];
            rest_speed[1][m] = rest_speed[1][m] - n * c * shape[m];
        }
        for (Index m = 0; m < pins; ++m) result.shape(k, m) = shape[static_cast<std::size_t>(m)].high;
        result.angular_speed[k] = n.high;
        result.amplitude[k] = {c.high, d.high};
        result.energy[k] =
            std::ldexp(0.5 * ((c * c + d * d) * part / x).high, rig.units.weight_exponent - rig.units.length_exponent);
        const double residual =
            rig.stiffness_positive ? forms.residual(x, shape) : std::numeric_limits<double>::infinity();
        whirls.add(DoubleDouble(n), result.amplitude[k], residual, result.shape.row(k).transpose());
        advance(progress, 0.5 * static_cast<double>(k + 1) / static_cast<double>(count));
    }
    return whirls;
}

}  // namespace detail

REVCHAIN_INLINE Swing swing(const Rig& given, const SwingOptions& options) {
    using S = DoubleDouble;
    constexpr std::string_view place = "swing";
    if (given.has_momentum())
        detail::throw_invalid(place, "momentum of flywheels turns the plane of the swing; use whirl_swing");
    const Rig rig = detail::swinging(place, given);
    const bool yields = !rig.support().is_firm();
    const Vector<double> from = detail::checked_start(place, rig.size(), yields, "offset", options.offset);
    const Vector<double> speed = detail::checked_start(place, rig.size(), yields, "velocity", options.velocity);
    detail::check_times(place, options.time, options.gravity);
    const RigPencil pencil = rig_pencil(rig, options.gravity);
    const auto found = [&](Index first, Index number) {
        if (number == 0) return WhirlModes{};
        return modes(rig, {.first = first, .count = number, .gravity = options.gravity, .progress = options.progress})
            .forward;
    };
    const Index all = detail::stable_modes(place, rig, pencil, options.gravity, 1, nullptr).forward.available;
    const auto elements = pencil::positive_elements<false>(pencil.pencil);
    if (!pencil.stiffness_positive || !pencil.mass_not_negative || !elements)
        detail::throw_invalid(place, "weights cancel but for their last digits, or a link without mass stands");
    AssembledChain<S> assembled{{}, pencil.units};
    const auto wide = [](const Wide<double>& x) { return S(x); };
    for (const auto& e : elements->elements)
        assembled.pencil.elements.push_back({wide(e.stiffness), wide(e.lower), wide(e.upper), wide(e.cross),
                                             wide(e.turning), wide((e.lower + e.cross) + (e.cross + e.upper))});
    assembled.pencil.entry_error = elements->entry_error;
    const Index count = detail::checked_count(place, options.count, all);
    return detail::superposed<Swing>(detail::OscillatingChain(std::move(assembled)), options, from, speed, count, all,
                                     found);
}

REVCHAIN_INLINE WhirlSwing whirl_swing(const Rig& given, const WhirlSwingOptions& options) {
    constexpr std::string_view place = "whirl_swing";
    const Rig rig = detail::swinging(place, given);
    if (!rig.has_momentum())
        detail::throw_invalid(place, "no flywheel has momentum: the two level directions are independent; use swing");
    const bool yields = !rig.support().is_firm();
    const auto from = detail::checked_start(place, rig.size(), yields, "offset", options.offset);
    const auto speed = detail::checked_start(place, rig.size(), yields, "velocity", options.velocity);
    detail::check_times(place, options.time, options.gravity);
    const RigPencil pencil = rig_pencil(rig, options.gravity);
    if (pencil.massless.size > 0)
        detail::throw_invalid(place, "pins without inertia beside flywheels with momentum: give each some; there are",
                              pencil.massless.size);
    const RigModes found =
        detail::stable_modes(place, rig, pencil, options.gravity, options.count.value_or(all_modes), options.progress);
    const Index all = found.forward.available + found.backward.available;
    const Index count = detail::checked_count(place, options.count, all);

    const Index pins = rig.size() + 1;
    WhirlSwing result;
    result.shape.resize(count, pins);
    result.amplitude.resize(count);
    for (auto* column : {&result.angular_speed, &result.energy}) column->resize(count);
    const auto all_pins = static_cast<std::size_t>(pencil.pencil.size() + 1);
    detail::PlaneOffsets rest = detail::in_double_words(from, all_pins),
                         rest_speed = detail::in_double_words(speed, all_pins);
    const detail::Superposition whirls =
        detail::split_start(result, pencil, detail::merged(found), rest, rest_speed, options.progress);

    // The energy bounds what is left where every link hangs in tension.
    const detail::WhirlForms forms(pencil);
    detail::LeftOut left{std::numeric_limits<double>::infinity(), Vector<double>::Ones(pins),
                         pencil.units.weight_exponent - pencil.units.length_exponent};
    if (pencil.stiffness_positive) {
        left.size = std::sqrt(forms.energy(rest, rest_speed, pencil.pace));
        left.flexibility = forms.flexibility();
    }
    detail::superpose(result, whirls, left, options.time, options.progress);
    return result;
}

}  // namespace revchain
