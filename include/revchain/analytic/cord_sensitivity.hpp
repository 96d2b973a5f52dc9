// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/analytic/cord.hpp"
#include "revchain/analytic/cord_start.hpp"
#include "revchain/cord.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns d lambda / d(tension) of a cord held at both ends, from the slopes of a mode. It is
/// -lambda times the integral of y'^2 over that of T y'^2, T the tension, from a to b in lengths of
/// cord. Moving end b moves lambda by lambda b y_b'^2 over the second integral (Hadamard). lambda
/// is homogeneous in a and b, so that integral is b^2 y_b'^2 - a^2 y_a'^2. Under a great pull this
/// is a small difference, and Gauss's rule is used.
REVCHAIN_LAZY
double by_tension(const CordModes& modes, Index j, double lower) {
    const double length = modes.cord.length(), upper = lower + length,
                 height = modes.conical_height[j];
    double ratio = 0;  // of the two integrals
    if (lower < length) {
        const double a = modes.slope(j, 0), b = modes.slope(j, length);
        ratio =
            (lower * a * a - upper * b * b) / ((upper * b - lower * a) * (upper * b + lower * a));
    } else {
        const auto rule = gauss_rule(16);
        const Index panels = modes.first + j + 4, nodes = static_cast<Index>(rule.size());
        const auto node = [&](Index i) { return rule[static_cast<std::size_t>(i % nodes)]; };
        Vector<double> arc(panels * nodes);
        for (Index i = 0; i < arc.size(); ++i)
            arc[i] = length * (static_cast<double>(i / nodes) + node(i).first) /
                     static_cast<double>(panels);
        const Vector<double> slope = modes.slope(j, arc);
        double free = 0, pulled = 0;
        for (Index i = 0; i < arc.size(); ++i) {
            const double part = node(i).second * slope[i] * slope[i];
            free += part, pulled += part * (lower + arc[i]);
        }
        ratio = free / pulled;
    }
    return -height * ratio / modes.cord.line_weight();
}

}  // namespace detail

REVCHAIN_DEFINE_ANALYTIC
CordSensitivity sensitivity(const CordModes& modes) {
    const Cord& cord = modes.cord;
    cord.require_no_bob("sensitivity");
    CordSensitivity result;
    result.weights.setZero(modes.size(), static_cast<Index>(cord.weights().size()));
    result.first = modes.first, result.length = modes.conical_height / cord.length();
    for (Vector<double>* v :
         {&result.weight, &result.tip_weight, &result.exponent, &result.tension})
        v->setZero(modes.size());
    if (modes.held) {
        const double tension = modes.held->tension->high;
        const double lower = detail::lower_length("sensitivity", {cord, *modes.held}, 1.0).high;
        for (Index j = 0; j < modes.size(); ++j)
            result.tension[j] = modes.held->weightless ? -modes.conical_height[j] / tension
                                                       : detail::by_tension(modes, j, lower);
        result.weight =
            -tension / cord.weight() * result.tension;  // heights depend on the ratio alone
        return result;
    }
    const auto nodes = detail::nodes_of(cord, {}, nullptr, modes.first + modes.size());
    const Vector<double> at = nodes.arcs();
    Vector<double> places(result.weights.cols()), weights(result.weights.cols());
    for (Index p = 0; const auto& [s, weight] : cord.weights())
        places[p] = s, weights[p++] = weight;
    for (Index j = 0; j < modes.size(); ++j) {
        const Vector<double> offset = modes.offset(j, at), slope = modes.slope(j, at);
        const double height = modes.conical_height[j];
        double whole = 0, tip = 0, exponent = 0;
        for (Index i = 0; i < at.size(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double share = nodes.weight[k] * slope[i];
            const double form = -share * (2 * offset[i] + height * slope[i]);
            const double part = at[i] / cord.length();
            whole += share * slope[i] * nodes.below[k], tip += form;
            for (Index p = 0; p < places.size() && places[p] < at[i]; ++p)
                result.weights(j, p) += form;
            if (cord.exponent())
                exponent += form * std::pow(part, *cord.exponent() + 1) * std::log(part);
        }
        result.weights.row(j) /= whole;
        result.tip_weight[j] = tip / whole, result.exponent[j] = exponent * cord.weight() / whole;
    }
    // heights depend on ratios of the weights alone
    result.weight =
        -(cord.tip_weight() * result.tip_weight + result.weights * weights) / cord.weight();
    if (!cord.exponent()) result.exponent.setConstant(std::numeric_limits<double>::quiet_NaN());
    return result;
}

}  // namespace revchain
