// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "revchain/damped_modes.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/pencil/damped/discs.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// A damped rig's pencil, and what is known of its exponents before they are found.
struct DampedSystem {
    RigPencil rig;
    bool momentum;  ///< the motions of one sense are no conjugates of the other's
    bool rests;     ///< a free trolley with a dashpot: it rests anywhere, and one exponent is 0
    bool drifts;    ///< without it the momentum is constant, and its offset follows from the links'
    bool inertia = false;  ///< whether M is regular: there are twice as many exponents as freedoms

    DampedSystem(const Rig& of, double gravity)
        : rig(rig_pencil(of, gravity, {}, true)),
          momentum(of.has_momentum()),
          rests(of.support().is_free() && of.support().damping.high > 0),
          drifts(pencil::keeps_momentum(rig.pencil)) {}

    const pencil::DampedPencil& pencil() const { return rig.pencil; }
    Index exponents() const { return 2 * (rig.pencil.size() - (drifts ? 1 : 0)); }
};

/// Returns starts of the exponents that are not 0, in double; sets `inertia`.
REVCHAIN_LAZY
std::vector<pencil::Complex> first_exponents(DampedSystem& of) {
    using pencil::Complex;
    pencil::DampedMatrices matrices(of.pencil());
    if (of.drifts) matrices.leave_out_trolley();
    const auto& [K, C, G, M] = matrices;
    const pencil::FirstExponents first =
        of.momentum
            ? pencil::first_exponents<Complex>(
                  K.cast<Complex>(), C.cast<Complex>() - Complex(0, 1) * G.cast<Complex>(), M)
            : pencil::first_exponents<double>(K, C, M);
    of.inertia = first.inertia;
    std::vector<Complex> starts = first.s;
    const auto smaller = [](const Complex& x, const Complex& y) {
        return std::abs(x) < std::abs(y);
    };
    if (of.rests && !starts.empty())
        starts.erase(std::min_element(starts.begin(), starts.end(), smaller));
    return starts;
}

/// Returns all exponents but 0, refined, of each conjugate pair one, by size.
REVCHAIN_LAZY
std::vector<pencil::DampedRoot> damped_roots(DampedSystem& of) {
    using pencil::Complex;
    const std::vector<Complex> starts = first_exponents(of);
    std::vector<pencil::DampedRoot> roots;
    std::vector<Complex> known;  // with conjugates
    const auto take = [&](const Complex& start) {
        check_interrupt();
        pencil::DampedRoot root = pencil::refined(of.pencil(), start);
        const auto s = static_cast<Complex>(root.s);
        const bool pair = !of.momentum && !root.real;
        const auto is_near = [&](const Complex& other) {
            return std::abs(other - s) <= 1e-9 * std::abs(s);
        };
        if (!(root.correction < 1e-3) || (pair && !(s.imag() > 0)) ||
            std::any_of(known.begin(), known.end(), is_near))
            return;
        known.push_back(s);
        if (pair) known.push_back(std::conj(s));
        roots.push_back(std::move(root));
    };
    for (const Complex& s : starts)
        if (of.momentum || s.imag() >= 0) take(s);
    // Eigen loses the smallest exponents of a wide range.
    const Index zeros = of.drifts ? 2 : of.rests ? 1 : 0, all = of.exponents() - (of.rests ? 1 : 0);
    for (int attempt = 0; of.inertia && attempt < 12; ++attempt) {
        const Index missing = all - static_cast<Index>(known.size());
        if (missing <= 0) break;
        double least = known.empty() ? 1.0 : std::numeric_limits<double>::infinity();
        for (const Complex& s : known) least = std::min(least, std::abs(s));
        const Complex beside(-1, attempt % 2 == 0 && missing > 1 ? 0.7 : 0);
        Complex s = pencil::further_exponent(of.pencil(), known, zeros,
                                             beside * least * std::pow(10.0, -2.0 * (attempt / 2)));
        if (!of.momentum && std::abs(s.imag()) < 1e-6 * std::abs(s)) s = s.real();
        take(!of.momentum && s.imag() < 0 ? std::conj(s) : s);
    }
    std::sort(roots.begin(), roots.end(),
              [](const auto& x, const auto& y) { return size_of(x.s) < size_of(y.s); });
    return roots;
}

/// Returns a proved bound of the error of each exponent, or infinity. Conjugates, and the exponent
/// 0 of a trolley that rests anywhere, take part in the proof.
REVCHAIN_LAZY
std::vector<double> damped_radii(const DampedSystem& of,
                                 const std::vector<pencil::DampedRoot>& roots, bool in_two_words) {
    std::vector<pencil::DampedRoot> all;
    std::vector<std::size_t> at;
    for (const pencil::DampedRoot& root : roots) {
        at.push_back(all.size());
        all.push_back(root);
        if (of.momentum || root.real) continue;
        pencil::DampedRoot& other = all.emplace_back(root);
        other.s.imag = -other.s.imag;
        for (pencil::ComplexWord& each : other.q) each.imag = -each.imag;
        for (pencil::Complex& each : other.off) each = std::conj(each);
    }
    if (of.rests) {
        pencil::DampedRoot& rest = all.emplace_back();
        rest.q.resize(static_cast<std::size_t>(of.pencil().size()));
        rest.off.resize(rest.q.size());
        const Wide<double> one(1.0);
        rest.q.back() = pencil::ComplexWord(one / sqrt(of.pencil().joints.back().damping));
    }
    std::vector<double> radius(roots.size(), std::numeric_limits<double>::infinity());
    if (!of.inertia || static_cast<Index>(all.size()) != of.exponents()) return radius;
    const std::vector<double> found = pencil::disc_radii(of.pencil(), all, in_two_words);
    for (std::size_t k = 0; k < roots.size(); ++k) radius[k] = found[at[k]];
    return radius;
}

/// Returns the offsets of all pins of a rig for the rotations of a mode; the largest is 1.
REVCHAIN_LAZY
std::vector<pencil::Complex> damped_shape(const DampedSystem& of, const pencil::DampedRoot& root) {
    using pencil::Complex;
    const std::vector<Complex> q = pencil::in_double(root.q);
    std::vector<Complex> offset = pencil::offsets(
        of.pencil(), q, [](const Wide<double>& lever) { return static_cast<double>(lever); });
    offset.insert(offset.begin(), static_cast<std::size_t>(of.rig.idle), offset.front());
    Complex largest = offset[0];
    for (const Complex& y : offset)
        if (std::abs(y) > std::abs(largest) * (1 + 8 * epsilon<double>())) largest = y;
    for (Complex& y : offset) y /= largest;
    return offset;
}

}  // namespace detail

REVCHAIN_DEFINE
DampedModes damped_modes(const Rig& rig, const DampedModesOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "damped_modes";
    require_positive(place, "gravity", options.gravity);
    if (options.first < 1) throw_invalid(place, "first must be at least 1", options.first);
    if (options.count && *options.count < 1)
        throw_invalid(place, "count must be at least 1", *options.count);
    if (rig.size() > 1000)
        throw_invalid(place, "a rig with dashpots may have at most 1000 links, not", rig.size());
    if (rig.fluid() == Fluid::turning && rig.is_damped())
        throw_invalid(place, "dashpots and a fluid that turns are not solved together; links",
                      rig.size());
    DampedSystem system(rig, options.gravity);
    std::vector<pencil::DampedRoot> roots = damped_roots(system);
    advance(options.progress, 0.6);
    std::vector<double> radius = damped_radii(system, roots, false);
    const auto all_within = [&](double share) {
        for (std::size_t k = 0; k < roots.size(); ++k)
            if (!(radius[k] <= share * size_of(roots[k].s))) return false;
        return true;
    };
    if (system.inertia && !all_within(0x1p-60)) {
        for (pencil::DampedRoot& root : roots) pencil::sharpen(system.pencil(), root);
        radius = damped_radii(system, roots, false);
        if (!all_within(0x1p-60)) radius = damped_radii(system, roots, true);
    }
    DampedModes result;
    result.first = options.first, result.has_momentum = system.momentum;
    result.rigid = system.rig.rigid;
    result.complete = all_within(0.4);
    if (!result.complete) result.status = Status::tolerance_not_met;
    result.available = static_cast<Index>(roots.size());
    const Index count = std::clamp<Index>(result.available - options.first + 1, 0,
                                          options.count.value_or(result.available));
    result.exponent.resize(count), result.error_bound.resize(count);
    result.error_estimate.resize(count), result.shapes.resize(count, rig.size() + 1);
    for (Index j = 0; j < count; ++j) {
        const auto k = static_cast<std::size_t>(options.first - 1 + j);
        const pencil::DampedRoot& root = roots[k];
        const pencil::ComplexWord s = root.s * pencil::ComplexWord(system.rig.pace);
        result.exponent[j] = static_cast<pencil::Complex>(s);
        const double rounded = size_of(s - pencil::ComplexWord(result.exponent[j])) / size_of(s);
        const double bound = (radius[k] / size_of(root.s) + rounded + 0x1p-95) * (1 + 1e-15);
        const bool proved = bound < 0.5;
        result.error_bound[j] = proved ? bound : std::numeric_limits<double>::infinity();
        result.error_estimate[j] = proved ? bound : rounded + root.correction;
        const std::vector<pencil::Complex> offset = damped_shape(system, root);
        for (Index m = 0; m <= rig.size(); ++m)
            result.shapes(j, m) = offset[static_cast<std::size_t>(m)];
    }
    advance(options.progress, 1);
    return result;
}

}  // namespace revchain
