// SPDX-License-Identifier: MPL-2.0
// Defines what forced_motion.hpp declares.
#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "revchain/forced_motion.hpp"
#include "revchain/linear/moved_support.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/complex/word.hpp"
#include "revchain/pencil/damped/form.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// The pencil of what moves relative to the support, or with it.
struct Drive {
    Moved moved;
    pencil::DampedPencil pencil;
    Index modes_at_rest;  ///< negative eigenvalues at a speed near 0: no modes
};

REVCHAIN_LAZY
void check_forced(const Rig& rig, const ForcedMotionOptions& options, int given) {
    constexpr std::string_view place = "forced_motion";
    require_positive(place, "gravity", options.gravity);
    require_finite(place, "radius", options.radius, "acceleration", options.acceleration, "force",
                   options.force);
    if (given != 1) throw_invalid(place, "give one of radius, acceleration and force, not", given);
    if (options.force != 0 && rig.support().is_firm())
        throw_invalid(place, "a force does not move a firm support: give a radius; force",
                      options.force);
    if (rig.fluid() == Fluid::turning && rig.is_damped())
        throw_invalid(place, "dashpots and a fluid that turns are not solved together");
    for (const double n : options.angular_speed)
        require_positive(place, "angular speed", rig.has_momentum() ? std::abs(n) : n);
}

/// The steady motion at one speed: offsets of the pins that move, lowest first.
struct Forced {
    std::vector<pencil::ComplexWord> offset;
    pencil::ComplexWord force;  ///< the pull of the chain on its support
    double error = 0;           ///< over the largest offset
    Index slower = 0;
};

/// `amount`: the radius, or the force. The equations are eliminated at `beside` and corrected at n.
REVCHAIN_LAZY
Forced forced_at(const Drive& drive, const Wide<double>& n, const Wide<double>& amount,
                 const Wide<double>& beside) {
    using C = pencil::ComplexWord;
    using S = Wide<double>;
    const pencil::DampedPencil& of = drive.pencil;
    const C unit(S(0.0), S(1.0)), none(S(0.0)), s(S(0.0), n), size{amount};
    const auto factors = pencil::damped_factors(s, unit);
    pencil::JointSolver<C> solver(of, pencil::damped_factors(C(S(0.0), beside), unit));
    for (std::size_t m = 0; m < solver.size(); ++m)
        if (!(size_of(solver.pivot(m)) > 0)) solver.pivot(m) = C(S(0x1p-400));
    const bool by_hand = drive.moved == Moved::support,
               by_spring = drive.moved == Moved::far_end_of_spring;
    std::vector<C> load(solver.size(), none), slope = load;
    if (by_hand) {
        const pencil::MovedTogether<C> together(of, {none, none, s, s * s}),
            derived(of, {none, none, s, s * s + s * s});  // s times the derivative
        for (std::size_t m = 0; m < load.size(); ++m)
            load[m] = -(together.load[m] * size), slope[m] = -(derived.load[m] * size);
    } else {
        load.back() = by_spring ? C(of.elements.back().stiffness) * size : size;
    }
    std::vector<C> q = load;
    solver.solve(q);
    const auto corrected = [&] {
        std::vector<C> left = pencil::applied(of, factors, q);
        for (std::size_t m = 0; m < left.size(); ++m) left[m] = load[m] - left[m];
        solver.solve(left);
        for (std::size_t m = 0; m < left.size(); ++m) q[m] = q[m] + left[m];
        return left;
    };
    const auto number = [](const S& y) { return C(y); };
    const auto largest = [&](const std::vector<C>& all) {
        double most = 0;
        for (const C& each : all) {
            if (!(size_of(each) < 1e300)) return std::numeric_limits<double>::infinity();
            most = std::max(most, size_of(each));
        }
        return most;
    };
    for (int round = 0; round < (beside == n ? 1 : 5); ++round) corrected();
    const std::vector<C> correction = pencil::offsets(of, corrected(), number);
    const auto turned = pencil::applied(of, pencil::damped_factors(s, unit, true), q);
    for (std::size_t m = 0; m < slope.size(); ++m) slope[m] = slope[m] - s * turned[m];
    solver.solve(slope);
    Forced result;
    result.offset = pencil::offsets(of, q, number);
    if (by_hand)
        for (C& y : result.offset) y = y + size;
    const double most = largest(result.offset);
    result.error = largest(correction) / most +
                   0x1p-90 * (1 + largest(pencil::offsets(of, slope, number)) / most) + 0x1.01p-53;
    if (!(result.error < 0.25)) result.error = std::numeric_limits<double>::infinity();
    // The pull is minus the inertia and drag of all links, or that of the spring on what moves it.
    for (std::size_t m = 0; m < of.elements.size(); ++m) {
        const auto& e = of.elements[m];
        if (of.joints[m].lever == S(0.0)) {
            if (by_spring) result.force = C(e.stiffness) * (result.offset[m] - size);
            break;
        }
        const pencil::JointFactors<C> moving{none, none, s, s * s};
        const pencil::Carried<C> part = pencil::carried(e, of.joints[m], moving, number);
        result.force = result.force - ((part.lower + part.cross) * result.offset[m] +
                                       (part.cross + part.upper) * result.offset[m + 1]);
    }
    const pencil::JointFactors<S> steady{S(1.0), n, S(0.0), -(n * n)};
    result.slower = pencil::certified_count(of, steady).above - drive.modes_at_rest;
    return result;
}

}  // namespace detail

REVCHAIN_DEFINE
ForcedMotion forced_motion(const Rig& rig, const ForcedMotionOptions& options) {
    using namespace detail;
    using S = Wide<double>;
    const Threads threads("forced_motion", options.threads);
    const int given = (options.radius != 0) + (options.acceleration != 0) + (options.force != 0);
    const double radius = given == 0 ? rig.support().radius : options.radius;
    check_forced(rig, options, given == 0 && radius != 0 ? 1 : given);
    const Moved moved = moved_part(rig, options.force != 0);
    const RigPencil of = rig_pencil(relative_rig(rig, moved), options.gravity, {}, true);
    const Drive at{moved, of.pencil, of.not_positive + of.rigid};
    const int weight = of.units.weight_exponent, length = of.units.length_exponent;
    const auto rows = static_cast<Index>(options.angular_speed.size());
    const Index pins = rig.size() + 1;
    ForcedMotion result{Table<std::complex<double>>(rows, pins), Vector<double>(rows),
                        Vector<Index>(rows), std::vector<char>(options.angular_speed.size()),
                        Vector<std::complex<double>>(rows)};
    parallel_for(rows, 16, [&](Index begin, Index end) {
        for (Index row = begin; row < end; ++row) {
            const S n(options.angular_speed[static_cast<std::size_t>(row)]);
            const S amount = options.force != 0 ? ldexp(S(options.force), -weight)
                                                : ldexp(options.acceleration != 0
                                                            ? -(S(options.acceleration) / n / n)
                                                            : S(radius),
                                                        -length);
            const double pace = std::abs((n / of.pace).high);
            if (!(pace > 0x1p-250 && pace < 0x1p250))
                throw_invalid("forced_motion", "speeds must not be that far from the rig's own",
                              n.high);
            if (!(std::abs(amount.high) < 0x1p500))
                throw_invalid("forced_motion", "the drive is too large for its unit; it has",
                              amount.high);
            const S turn = n / of.pace;
            Forced found = forced_at(at, turn, amount, turn);
            if (!(found.error < 0.25)) {
                // A part below a pin may be at its own speed although the whole is at none.
                Forced again = forced_at(at, turn, amount, turn * S(1 + 0x1p-45));
                if (again.error < 0x1p-40) found = std::move(again);
            }
            const bool resonant = !(found.error < 0.25);
            result.resonant[static_cast<std::size_t>(row)] = resonant ? 1 : 0;
            result.error_estimate[row] = found.error;
            result.modes_below[row] = found.slower;
            const std::complex<double> unknown(std::numeric_limits<double>::quiet_NaN(), 0.0);
            for (Index m = 0; m < pins; ++m) {
                const auto pin = static_cast<std::size_t>(std::max<Index>(0, m - of.idle));
                const auto y = static_cast<std::complex<double>>(found.offset[pin]);
                result.offset(row, m) = resonant ? unknown : y * std::ldexp(1.0, length);
            }
            result.support_force[row] =
                resonant ? unknown
                         : static_cast<std::complex<double>>(found.force) * std::ldexp(1.0, weight);
            advance(options.progress, double(row + 1) / double(rows));
        }
    });
    return result;
}

}  // namespace revchain
