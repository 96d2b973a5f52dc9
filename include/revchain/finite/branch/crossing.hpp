// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/continuation.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A number at a point of a branch, minus the wanted value, and its slope along the arc.
struct Measured {
    double value, slope;
};

struct HeightMeasure {
    double wanted;
    Measured operator()(const BranchPoint& p) const {
        return {p.state.log_height - wanted, p.tangent.log_height};
    }
};

/// Measures tau of the lowest link; with `either` its absolute value.
struct TipInclinationMeasure {
    double wanted;
    bool either;
    Measured operator()(const BranchPoint& p) const {
        const double sign = either && p.state.tau[0] < 0 ? -1 : 1;
        return {sign * p.state.tau[0] - wanted, sign * p.tangent.tau[0]};
    }
};

struct TipRadiusMeasure {
    const BranchLinks<double>* links;
    double wanted;
    Measured operator()(const BranchPoint& p) const {
        double y = links->radius, slope = 0;
        for (std::size_t m = 0; m < links->size(); ++m) {
            const double a = links->links[m].length;
            const Inclined at = links->inclined(m, p.state.tau[m]);
            y += a * at.sine, slope += a * at.slope * p.tangent.tau[m];
        }
        const double sign = y < 0 ? -1 : 1;
        return {sign * y - wanted, sign * slope};
    }
};

/// Measures the size of the sideways reaction at the topmost pin.
struct TopPullMeasure {
    const BranchLinks<double>* links;
    double wanted;
    Measured operator()(const BranchPoint& p) const {
        double y = links->radius, y_change = 0, sum = 0, slope = 0;
        for (std::size_t m = links->size(); m-- > 0;) {
            const Link<double>& link = links->links[m];
            const Inclined at = links->inclined(m, p.state.tau[m]);
            sum += link.rest * y, slope += link.rest * y_change;
            y += link.length * at.sine, y_change += link.length * at.slope * p.tangent.tau[m];
            if (!links->is_spring(m)) sum += link.moment * y, slope += link.moment * y_change;
        }
        const double height = std::exp(p.state.log_height), sign = sum < 0 ? -1 : 1;
        return {sign * sum / height - wanted, sign * (slope - sum * p.tangent.log_height) / height};
    }
};

struct WithinStep {
    double share;
    BranchPoint point;
};

/// Returns the zero of f(measured) between two points of the step at which its signs differ.
template <class Measure, class F>
std::optional<WithinStep> vanishing(const BranchWalk& walk, const Measure& measure, const F& f,
                                    double low, double high, double at_low, double at_high,
                                    double tolerance) {
    std::optional<WithinStep> best;
    const auto value_at = [&](double share) {
        auto point = walk.within(share);
        if (!point) return std::numeric_limits<double>::quiet_NaN();
        const double value = f(measure(*point));
        best = WithinStep{share, std::move(*point)};
        return value;
    };
    if (at_high == 0)
        value_at(high);
    else
        zero_between(detail::SignChange<double>{{low, at_low}, {high, at_high}}, value_at,
                     {.width = 2e-16, .value = tolerance});
    if (!best) value_at(std::abs(at_low) < std::abs(at_high) ? low : high);  // an end suffices
    return best;
}

/// Returns the extremum of the number in the last step, if its slopes at both ends differ in sign.
template <class Measure>
std::optional<WithinStep> turning_of(const BranchWalk& walk, const Measure& measure) {
    const Measured a = measure(walk.before()), b = measure(walk.here());
    if (!(a.slope * b.slope < 0)) return std::nullopt;
    return vanishing(
        walk, measure, [](const Measured& x) { return x.slope; }, 0, 1, a.slope, b.slope, 1e-10);
}

/// Returns the points of the last step with the wanted number, in order, around at most one
/// extremum.
template <class Measure>
std::vector<WithinStep> crossings_of(const BranchWalk& walk, const Measure& measure) {
    std::vector<WithinStep> found;
    const Measured a = measure(walk.before()), b = measure(walk.here());
    const auto between = [&](double low, double high, double at_low, double at_high) {
        if (!(at_low * at_high < 0) && at_high != 0) return;
        auto point = vanishing(
            walk, measure, [](const Measured& x) { return x.value; }, low, high, at_low, at_high,
            1e-10 * std::max(std::abs(at_low), std::abs(at_high)));
        if (point) found.push_back(std::move(*point));
    };
    // an extremum matters only if the number may reach the wanted value and return
    const double reach = walk.here().arc - walk.before().arc;
    const bool may_return =
        a.value * b.value < 0 || std::min(std::abs(a.value), std::abs(b.value)) <=
                                     reach * std::max(std::abs(a.slope), std::abs(b.slope));
    const auto turn = may_return ? turning_of(walk, measure) : std::nullopt;
    if (turn) {
        const double there = measure(turn->point).value;
        between(0, turn->share, a.value, there);
        between(turn->share, 1, there, b.value);
    } else {
        between(0, 1, a.value, b.value);
    }
    return found;
}

}  // namespace revchain::finite
