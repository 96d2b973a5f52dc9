// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/transient.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A stretch of time in which the support's acceleration, or the force on it, is a straight line.
struct MotionPiece {
    double begin = 0;
    double value = 0, slope = 0;      ///< of the acceleration or force
    double offset = 0, velocity = 0;  ///< of the support at the beginning

    double acceleration_after(double h) const { return value + h * slope; }
    double velocity_after(double h) const { return velocity + h * (value + h * slope / 2); }
    double offset_after(double h) const {
        return offset + h * (velocity + h * (value / 2 + h * slope / 6));
    }
};

/// Returns the second derivatives of the cubic spline through points, which begins and ends at rest
/// or else whose third derivative does not jump at the second and at the last but one. Cost O(n).
REVCHAIN_LAZY
std::vector<double> spline_curvatures(const std::vector<double>& x, const std::vector<double>& y,
                                      bool rests) {
    const std::size_t n = x.size();
    std::vector<double> h(n - 1), slope(n - 1);
    for (std::size_t k = 0; k + 1 < n; ++k)
        h[k] = x[k + 1] - x[k], slope[k] = (y[k + 1] - y[k]) / h[k];
    if (!rests && n == 2) return {0, 0};
    if (!rests && n == 3) return std::vector<double>(3, 2 * (slope[1] - slope[0]) / (h[0] + h[1]));
    std::vector<double> below(n), at(n), above(n), right(n), curvature(n);
    for (std::size_t k = 1; k + 1 < n; ++k) {
        below[k] = h[k - 1], at[k] = 2 * (h[k - 1] + h[k]), above[k] = h[k];
        right[k] = 6 * (slope[k] - slope[k - 1]);
    }
    const double first = rests ? 0 : h[0] / h[1], last = rests ? 0 : h[n - 2] / h[n - 3];
    if (rests) {
        at[0] = 2 * h[0], above[0] = h[0], right[0] = 6 * slope[0];
        at[n - 1] = 2 * h[n - 2], below[n - 1] = h[n - 2], right[n - 1] = -6 * slope[n - 2];
    } else {  // the outer curvatures are on the lines through their neighbours
        at[1] += h[0] * (1 + first), above[1] -= h[0] * first;
        at[n - 2] += h[n - 2] * (1 + last), below[n - 2] -= h[n - 2] * last;
    }
    const std::size_t begin = rests ? 0 : 1, end = rests ? n : n - 1;
    for (std::size_t k = begin + 1; k < end; ++k) {
        const double share = below[k] / at[k - 1];
        at[k] -= share * above[k - 1], right[k] -= share * right[k - 1];
    }
    for (std::size_t k = end; k-- > begin;)
        curvature[k] = (right[k] - (k + 1 < end ? above[k] * curvature[k + 1] : 0.0)) / at[k];
    if (rests) return curvature;
    curvature[0] = (1 + first) * curvature[1] - first * curvature[2];
    curvature[n - 1] = (1 + last) * curvature[n - 2] - last * curvature[n - 3];
    return curvature;
}

REVCHAIN_LAZY
void check_motion(std::string_view place, const SupportMotion& motion) {
    using Given = SupportMotion::Given;
    const std::vector<double>& time = motion.time;
    if (time.size() != motion.value.size())
        throw_invalid(place, "a motion needs a value for each time; values", motion.value.size());
    if (time.size() == 1) throw_invalid(place, "a motion needs at least two times, not", 1);
    const bool jumps = motion.given == Given::acceleration || motion.given == Given::force;
    for (std::size_t k = 0; k < time.size(); ++k) {
        require_finite(place, "time of the motion", time[k], "value of the motion",
                       motion.value[k]);
        if (time[k] < 0) throw_invalid(place, "times of a motion must not be negative", time[k]);
        if (k == 0) continue;
        if (time[k] < time[k - 1]) throw_invalid(place, "times of a motion must ascend", time[k]);
        if (time[k] == time[k - 1] && !jumps)
            throw_invalid(place,
                          "a support cannot jump, nor its velocity: times must differ; give "
                          "accelerations or forces for jumps; time",
                          time[k]);
    }
}

/// Returns the pieces of a motion; the first begins at time 0, the last never ends.
REVCHAIN_LAZY
std::vector<MotionPiece> motion_pieces(std::string_view place, const SupportMotion& motion) {
    using Given = SupportMotion::Given;
    check_motion(place, motion);
    const std::vector<double>&t = motion.time, &y = motion.value;
    const std::size_t n = t.size();
    if (n == 0) return {MotionPiece{}};
    MotionPiece now{t[0]};
    std::vector<double> curvature;
    if (motion.given == Given::velocity) now.velocity = y[0];
    if (motion.given == Given::offset) {
        curvature = spline_curvatures(t, y, motion.rests);
        const double h = t[1] - t[0];
        now.offset = y[0];
        if (!motion.rests)
            now.velocity = (y[1] - y[0]) / h - h * (2 * curvature[0] + curvature[1]) / 6;
    }
    std::vector<MotionPiece> pieces;
    if (t[0] > 0) pieces.push_back({0, 0, 0, now.offset - t[0] * now.velocity, now.velocity});
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const double h = t[k + 1] - t[k];
        if (!(h > 0)) continue;
        now.begin = t[k];
        const auto between = [&](double from, double to) {
            now.value = from, now.slope = (to - from) / h;
        };
        if (motion.given == Given::velocity)
            now.value = (y[k + 1] - y[k]) / h, now.slope = 0;
        else if (motion.given == Given::offset)
            between(curvature[k], curvature[k + 1]);
        else
            between(y[k], y[k + 1]);
        pieces.push_back(now);
        const MotionPiece whole = now;
        now.offset = whole.offset_after(h), now.velocity = whole.velocity_after(h);
        if (motion.given == Given::offset) now.offset = y[k + 1];
        if (motion.given == Given::velocity) now.velocity = y[k + 1];
    }
    now.begin = t[n - 1], now.value = now.slope = 0;
    if (motion.given == Given::offset && motion.rests) now.velocity = 0;
    if (motion.given == Given::force) {
        for (MotionPiece& each : pieces) each.offset = each.velocity = 0;
        now.offset = now.velocity = 0;
    }
    pieces.push_back(now);
    return pieces;
}

}  // namespace revchain::detail
