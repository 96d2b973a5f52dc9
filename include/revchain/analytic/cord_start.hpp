// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>
#include <string>
#include <variant>

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// The start of a cord as polynomials of x = sqrt(s / length), given by values at the nodes of
/// Gauss's rule. Panels are halved until a polynomial of degree 15 gives the function to 1e-13 of
/// its largest value, also at the ends and in the middle.
class CordStartOnPanels {
   public:
    static constexpr std::size_t nodes = 16;
    using Values = std::array<double, nodes>;
    static constexpr double narrowest = 0x1p-40, rounding = 1e-13, jump = 1e-8;

    CordStartOnPanels() : rule_(gauss_rule(nodes)) {
        for (std::size_t i = 0; i < nodes; ++i) {  // barycentric weights
            weight_[i] = 1;
            for (std::size_t k = 0; k < nodes; ++k)
                if (k != i) weight_[i] /= rule_[i].first - rule_[k].first;
        }
    }
    const std::vector<std::pair<double, double>>& rule() const { return rule_; }

    /// Returns true if the polynomial through the values at the nodes of a panel gives the
    /// function.
    template <class F>
    bool is_resolved(const F& f, double low, double high, double tolerance) const {
        Values values{};
        for (std::size_t i = 0; i < nodes; ++i) values[i] = f(low + (high - low) * rule_[i].first);
        for (const double t : {0.0, 0.5, 1.0})
            if (!(std::abs(value(values, t) - f(low + (high - low) * t)) <= tolerance))
                return false;
        return true;
    }
    /// Slopes by t, from 0 to 1 over the panel, at its nodes.
    Values slopes(const Values& values) const {
        Values result{};
        for (std::size_t i = 0; i < nodes; ++i)
            for (std::size_t k = 0; k < nodes; ++k)
                if (k != i)
                    result[i] += weight_[k] / weight_[i] * (values[k] - values[i]) /
                                 (rule_[i].first - rule_[k].first);
        return result;
    }

   private:
    double value(const Values& values, double t) const {
        double above = 0, below = 0;
        for (std::size_t i = 0; i < nodes; ++i) {
            const double share = weight_[i] / (t - rule_[i].first);
            above += share * values[i], below += share;
        }
        return above / below;
    }
    std::vector<std::pair<double, double>> rule_;
    Values weight_{};
};

/// Offsets and velocities at the start, and the weights with which sums over nodes are integrals
/// by s.
struct CordStartNodes {
    std::vector<double> arc, weight, below;           // `below`: the weight below, with the tip
    std::array<std::vector<double>, 2> value, slope;  // of offset and velocity, the slope by s

    Vector<double> arcs() const {
        return Eigen::Map<const Vector<double>>(arc.data(), static_cast<Index>(arc.size()));
    }
};

using CordFunction = std::function<double(double)>;

/// Returns the function of a start, empty if there is none. Between values given at points it is
/// linear.
template <class Start>
CordFunction function_of(const std::string& name, const Start& start, const Vector<double>& places,
                         double length) {
    static constexpr std::string_view place = "swing";  // static: Clang 14 captures no constant
    CordFunction given;
    if (const auto* function = std::get_if<CordFunction>(&start)) {
        if (!*function) throw_invalid(place, name + " must be a function, not an empty one");
        given = [f = *function, name](double s) {
            const double y = f(s);
            if (std::isfinite(y)) return y;
            throw_invalid(place, name + " must be finite; at " + in_digits(s) + " it is", y);
        };
    } else if (const auto* values = std::get_if<Vector<double>>(&start)) {
        if (values->size() != places.size())
            throw_invalid(place,
                          name + " must have a number for each of the " +
                              std::to_string(places.size()) + " places",
                          values->size());
        for (const double y : *values)
            if (!std::isfinite(y)) throw_invalid(place, name + " must be finite", y);
        const double last = places[places.size() - 1];
        if (places[0] != 0 || last != length)
            throw_invalid(
                place,
                "places at which offsets are given must begin at 0 and end at the length, not at",
                places[0] != 0 ? places[0] : last);
        given = [v = *values, places](double s) {
            const double* after =
                std::upper_bound(places.data() + 1, places.data() + places.size() - 1, s);
            const Index i = after - places.data();
            const double share = (s - places[i - 1]) / (places[i] - places[i - 1]);
            return v[i - 1] + share * (v[i] - v[i - 1]);
        };
    }
    const double at_support = given ? given(length) : 0;
    if (at_support != 0 && !(std::abs(at_support) <= 1e-12 * std::abs(given(length / 2)) + 1e-300))
        throw_invalid(place, name + " of the support must be 0", at_support);
    return given;
}

/// Returns the nodes of panels that are fine enough for modes up to number `modes`, and for a
/// start.
REVCHAIN_LAZY
CordStartNodes nodes_of(const Cord& cord, const std::array<CordFunction, 2>& start,
                        const Vector<double>* places, Index modes) {
    const CordStartOnPanels panels;
    const double length = cord.length();
    std::vector<double> ends{0, 1};
    const Index even = 8 + modes / 2;
    for (Index i = 1; i < even; ++i)
        ends.push_back(static_cast<double>(i) / static_cast<double>(even));
    if (places != nullptr)
        for (const double s : *places) ends.push_back(std::sqrt(s / length));
    if (!cord.is_uniform() || (!start[0] && !start[1]))  // powers and logarithms at the free end
        for (int i = 1; i < 40; ++i)
            ends.push_back(std::ldexp(1.0, -i) / static_cast<double>(even));
    if (!cord.is_uniform()) {
        const auto density = cord.line_density();
        for (const auto& piece : density->pieces())
            ends.push_back(std::sqrt((piece.middle + piece.half) / length));
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> kept{0};
    for (const double x : ends)
        if (x > kept.back() + 1e-7 || (x > 0 && kept.size() == 1)) kept.push_back(std::min(x, 1.0));
    kept.back() = 1;
    const finite::ContinuousChain chain(cord);  // keeps the density
    const finite::PathKind kind = finite::kind_of(chain, 1, 1);
    CordStartNodes result;
    std::array<double, 2> largest{};
    for (std::size_t i = 0; i < 2; ++i)
        for (int k = 0; start[i] && k <= 1000; ++k)
            largest[i] = std::max(largest[i], std::abs(start[i](length * k / 1000)));
    const std::function<void(double, double)> divide = [&](double low, double high) {
        for (std::size_t i = 0; i < 2; ++i) {
            if (!start[i]) continue;
            const auto f = [&](double x) { return start[i](std::min(length * x * x, length)); };
            if (panels.is_resolved(f, low, high, CordStartOnPanels::rounding * largest[i]))
                continue;
            const double middle = low + (high - low) / 2;
            if (high - low > CordStartOnPanels::narrowest)
                return divide(low, middle), divide(middle, high);
            const std::string name = i == 0 ? "offset" : "velocity";
            if (!panels.is_resolved(f, low, high, CordStartOnPanels::jump * largest[i]))
                throw_invalid("swing", name + " must be continuous; it is not at arc length",
                              length * low * low);
        }
        const double wide = high - low;
        std::array<CordStartOnPanels::Values, 2> values{};
        std::vector<double> x;
        for (const auto& [t, weight] : panels.rule()) {
            const double at = low + wide * t, s = length * at * at;
            x.push_back(at), result.arc.push_back(s);
            result.weight.push_back(weight * wide * 2 * length * at);
            result.below.push_back(kind.weight_below(s) * cord.line_weight());
            for (std::size_t i = 0; i < 2; ++i)
                values[i][x.size() - 1] = start[i] ? start[i](s) : 0.0;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            const auto slopes = panels.slopes(values[i]);
            for (std::size_t k = 0; k < x.size(); ++k) {
                result.value[i].push_back(values[i][k]);
                result.slope[i].push_back(slopes[k] / (wide * 2 * length * x[k]));
            }
        }
    };
    for (std::size_t i = 1; i < kept.size(); ++i) divide(kept[i - 1], kept[i]);
    return result;
}

/// Returns twice the estimated sum of the modes left out. It is found from the sums of amplitude
/// times shape over modes K/2 ... K and K ... 2K at each point; their ratio shows how fast they
/// fall.
REVCHAIN_LAZY
Vector<double> tail_estimate(const Vector<double>& before, const Vector<double>& after) {
    Vector<double> result(before.size());
    for (Index i = 0; i < before.size(); ++i) {
        const double ratio = before[i] > 0 ? after[i] / before[i] : 0.0;
        result[i] = 2 * after[i] / (1 - std::min(ratio, 0.9));
    }
    return result;
}

}  // namespace revchain::detail
