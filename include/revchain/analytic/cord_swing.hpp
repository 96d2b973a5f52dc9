// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/analytic/cord.hpp"
#include "revchain/analytic/cord_start.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Small oscillations. With V the weight below, integration by parts gives the part of mode k in a
/// start f: lambda integral of V y_k' f' / N, N = lambda integral of V y_k'^2. The density may
/// jump.
REVCHAIN_DEFINE_ANALYTIC
CordSwing swing(const Cord& cord, const CordSwingOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "swing";
    require_positive(place, "gravity", options.gravity);
    cord.require_no_bob(place);
    if (options.count < 1 || options.count > 10'000)
        throw_invalid(place, "count must be from 1 to 10000", options.count);
    for (const double t : options.time)
        if (!std::isfinite(t)) throw_invalid(place, "times must be finite", t);
    CordSwing result;
    result.arc_length = options.arc_length;
    const double length = cord.length();
    if (result.arc_length.size() == 0)
        result.arc_length = Vector<double>::LinSpaced(101, 0, length);
    const Vector<double>& arc = result.arc_length;
    for (Index i = 0; i < arc.size(); ++i)
        if (!(arc[i] >= 0 && arc[i] <= length && (i == 0 || arc[i] > arc[i - 1])))
            throw_invalid(place, "arc lengths must ascend from the free end, 0, to the length",
                          arc[i]);
    const std::array start{function_of("offset", options.offset, arc, length),
                           function_of("velocity", options.velocity, arc, length)};
    const bool listed = options.offset.index() == 1 || options.velocity.index() == 1;
    const Index count = options.count, all = 2 * count;
    const CordStartNodes nodes = nodes_of(cord, start, listed ? &arc : nullptr, all);
    const CordModes found = modes(cord, {.count = all, .progress = options.progress});
    const Vector<double> at = nodes.arcs();
    const auto sum = [&](const auto& f) {
        double total = 0;
        for (std::size_t i = 0; i < nodes.arc.size(); ++i)
            total += nodes.weight[i] * nodes.below[i] * f(i);
        return total;
    };
    result.angular_frequency = found.angular_speed(options.gravity).head(count);
    result.shape.resize(count, arc.size());
    for (auto* column : {&result.energy, &result.cosine, &result.sine}) column->resize(count);
    Vector<double> before = Vector<double>::Zero(arc.size()), after = before, whole = before;
    double kept = 0;
    for (Index k = 0; k < all; ++k) {
        const Vector<double> slope = found.slope(k, at), shape = found.offset(k, arc);
        const auto part = [&](std::size_t of) {
            return sum([&](std::size_t i) { return slope.data()[i] * nodes.slope[of][i]; });
        };
        const double norm = sum([&](std::size_t i) { return std::pow(slope.data()[i], 2); });
        const double frequency = std::sqrt(options.gravity / found.conical_height[k]);
        const double cosine = start[0] ? part(0) / norm : 0.0;
        const double sine = start[1] ? part(1) / norm / frequency : 0.0;
        const Vector<double> size = std::hypot(cosine, sine) * shape.cwiseAbs();
        (k >= count ? after : k >= count / 2 ? before : whole) += size;
        if (k >= count) continue;
        result.shape.row(k) = shape.transpose();
        result.cosine[k] = cosine, result.sine[k] = sine;
        result.energy[k] = 0.5 * norm * (cosine * cosine + sine * sine);
        kept += result.energy[k];
    }
    const double height = sum([&](std::size_t i) { return std::pow(nodes.slope[0][i], 2); }) / 2;
    const double motion =
        sum([&](std::size_t i) { return nodes.value[1][i] * nodes.slope[1][i]; }) / options.gravity;
    result.energy_left_out = std::max(0.0, height - motion - kept);
    whole += before;
    result.error_estimate = tail_estimate(before, after).array() + 1e-13 * whole.maxCoeff();
    // The sums are in double, because the errors of the modes exceed theirs. `superpose`
    // (questions/superposed.hpp) takes seven times as many instructions for 40 modes at 101 places.
    const auto times = static_cast<Index>(options.time.size());
    result.offset.resize(times, arc.size()), result.velocity.resize(times, arc.size());
    for (Index i = 0; i < times; ++i) {
        const auto speed = result.angular_frequency.array();
        const Eigen::ArrayXd angle = options.time[static_cast<std::size_t>(i)] * speed;
        const Eigen::ArrayXd c = angle.cos(), s = angle.sin();
        const auto a = result.cosine.array(), b = result.sine.array();
        const Vector<double> now = a * c + b * s, rate = (b * c - a * s) * speed;
        result.offset.row(i) = (result.shape.transpose() * now).transpose();
        result.velocity.row(i) = (result.shape.transpose() * rate).transpose();
    }
    return result;
}

}  // namespace revchain
