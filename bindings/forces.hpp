// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/rig.hpp"

/// Forces of systems given by mass. The core's unit of force is that of the weights; newtons are divided by gravity in
/// double words, so that error bounds hold for the numbers given.

/// A number over the unit of force.
inline revchain::Wide<double> quotient(double number, double force) {
    if (std::isinf(number)) return number;
    return revchain::Wide<double>(number) / revchain::Wide<double>(force);
}

/// A tension and the unit in which it is given, over that of the weights.
using Tension = std::optional<std::pair<double, double>>;
inline std::optional<revchain::Wide<double>> tension(const Tension& given) {
    if (!given) return {};
    return quotient(given->first, given->second);
}

/// Stiffness, the unit of its force, carriage weight and radius of what holds an end.
using End = std::array<double, 4>;
inline revchain::Support support(const End& end) { return {quotient(end[0], end[1]), end[2], end[3]}; }

/// No flywheels where none has momentum or an axial moment.
inline void without_idle(std::vector<revchain::Flywheel>& wheels) {
    if (std::all_of(wheels.begin(), wheels.end(), [](const auto& x) { return x == revchain::Flywheel{}; }))
        wheels.clear();
}

inline revchain::Flywheel wheel(double weight, double radius_of_gyration, double spin, bool driven, double gravity) {
    return driven ? revchain::driven_flywheel(weight, radius_of_gyration, spin, gravity)
                  : revchain::free_flywheel(weight, radius_of_gyration, spin, gravity);
}
