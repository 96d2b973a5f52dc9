// SPDX-License-Identifier: MPL-2.0
// Defines what damped_modes.hpp declares.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "revchain/damped_modes.hpp"
#include "revchain/linear/damped_system.hpp"
#include "revchain/pencil/damped/discs.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

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
        rest.q.back() = pencil::ComplexWord(one / sqrt(pencil::damping_together(of.pencil())));
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
        throw_invalid(place, "a rig with dashpots may have at most 1000 links", rig.size());
    if (rig.fluid() == Fluid::turning && rig.is_damped())
        throw_invalid(place, "dashpots and a fluid that turns are not solved together");
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
        sort_by_size(roots);  // two that are nearly alike may have changed places
        radius = damped_radii(system, roots, false);
        if (!all_within(0x1p-60)) radius = damped_radii(system, roots, true);
    }
    DampedModes result;
    result.first = options.first, result.has_momentum = system.momentum;
    result.rigid = system.rig.rigid;
    result.complete = all_within(0.4) && (!roots.empty() || system.exponents() == 0);
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
