// SPDX-License-Identifier: MPL-2.0
// The proof that no branch is missing between two heights.
#pragma once

#include <array>
#include <optional>

#include "revchain/finite/branch/crossing.hpp"
#include "revchain/finite/branch/enclosed_diagram.hpp"
#include "revchain/finite/shapes/isolation.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

struct Rectangle {
    double low, high, height_low, height_high;

    Interval<double> x() const { return {low, high}; }
    Interval<double> height() const { return {height_low, height_high}; }
};

/// Measures x = lambda sinh tau of the lowest link, times `side`; |x| if `side` is 0.
struct XMeasure {
    double wanted;
    int side = 0;
    Measured operator()(const BranchPoint& p) const {
        const double tau = p.state.tau[0], turned = side != 0 ? side : std::copysign(1.0, tau);
        const double height = turned * std::exp(p.state.log_height), x = height * std::sinh(tau);
        return {x - wanted, x * p.tangent.log_height + height * std::cosh(tau) * p.tangent.tau[0]};
    }
};

/// The heights at which every branch is proved to be known.
struct DiagramProof {
    bool complete = true;
    double open_low = 0, open_high = 0;  ///< a loop may be missing between these heights
    long rectangles = 0;                 ///< number of rectangles examined

    void leave_open(double low, double high) {
        open_low = complete ? low : std::min(open_low, low);
        open_high = std::max(open_high, high);
        complete = false;
    }
};

/// Proves that every connected piece of the diagram is known. The diagram consists of the zeros of
/// y(x, lambda), the offset of the support, with x = lambda tan(inclination of the lowest link) >
/// 0. Pieces that reach the lowest height are found by a list there. For a rig, y is the function
/// of EnclosedDiagram, and off the axis each sign of x has its own proof.
///
/// Any other piece reaches the vertical (off the axis: rest) or has a highest point, where y = y_x
/// = 0. Above the highest height there is no shape, or off the axis only the one from rest.
/// Rectangles of (x, lambda) are split until in each
///   y or y_x does not change sign, so that no such point is in it; or
///   y_lambda does not change sign in it and beyond it as far as the slope |y_x/y_lambda| can lead
///   within its width. Then all zeros in it lie on one graph lambda(x) over its width. If there are
///   any, one is at the middle; it is on a known branch, or its branch is followed.
/// Next to x = 0, y = x f(x, lambda). By the mean value theorem f, f_x and f_lambda lie within y_x,
/// y_xx times 0 ... 1, and y_x lambda over 0 ... x. So the graph continues to the vertical.
class DiagramProver {
   public:
    DiagramProver(EnclosedDiagram diagram, long budget)
        : diagram_(std::move(diagram)), budget_(budget / static_cast<long>(diagram_.size())) {}
    DiagramProver(EnclosedLinks<double> chain, long budget)
        : DiagramProver(EnclosedDiagram(std::move(chain)), budget) {}

    /// Covers heights from the highest to the lowest and x from 0 to `last`. `known(point,
    /// rectangle)` returns true if a branch through the rectangle is known or found.
    template <class Known>
    DiagramProof run(double lowest, double highest, double last, Known&& known) {
        DiagramProof proof;
        const auto spent = [&] { return proof.rectangles >= budget_; };
        const auto open = [&](const Rectangle& part) {
            proof.leave_open(part.height_low, part.height_high);
        };
        const auto visit = [&](const std::vector<Rectangle>& parts, const auto& wait) {
            const auto y = offsets_over(parts);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                if (is_decided(parts[i], y[i], proof, known)) continue;
                if (!split(parts[i], y[i], wait)) open(parts[i]);
            }
        };
        const int slabs =
            std::max(1, static_cast<int>(std::ceil(std::log(highest / lowest) / 0.25)));
        for (int i = 0; i < slabs; ++i) {
            const auto cut = [&](int k) {
                return highest * std::pow(lowest / highest, k * (1.0 / slabs));
            };
            const double high = cut(i), low = i + 1 == slabs ? lowest : cut(i + 1);
            const Rectangle slab{0.0, last, low, i == 0 ? highest : std::nextafter(high, 2 * high)};
            each_cell<batch>(std::deque{slab}, spent, visit, open);
        }
        return proof;
    }

   private:
    static constexpr std::size_t batch = 8;

    /// Returns true if nothing remains to be proved in a part.
    template <class Known>
    bool is_decided(const Rectangle& part, const Taylor<double, 2>& y, DiagramProof& proof,
                    Known&& known) {
        ++proof.rectangles;
        const bool from_zero = goes_to_vertical(part);
        if ((!from_zero && !y.value.may_vanish()) || !y.slope[0].may_vanish()) return true;
        if (const auto graph = graph_over(part, y, proof)) {
            if (from_zero) return true;
            const double x = part.x().middle();
            const auto low = diagram_.at(x, graph->height_low);
            const auto high = diagram_.at(x, graph->height_high);
            const int signs = low.sign() * high.sign();
            if (signs == 1) return true;  // the part has no zero
            if (signs == -1 && known(zero_at(x, *graph, low, high), *graph)) return true;
        }
        return false;
    }
    /// Returns the function over several rectangles, in lanes of the registers that the compiler
    /// flags allow. Code for AVX2 or AVX-512 chosen at run time, not inlined, took 4 times as long.
    std::array<Taylor<double, 2>, batch> offsets_over(const std::vector<Rectangle>& parts) const {
        const std::size_t count = parts.size();
        if (diagram_.spins()) {
            std::array<Taylor<double, 2>, batch> result;
            for (std::size_t i = 0; i < count; ++i)
                result[i] =
                    diagram_.spinning_over(Cell<double, 2>(parts[i].x(), parts[i].height()));
            return result;
        }
        return detail::for_own([&]<class Registers>(Registers) {
            using V = Pack<double, Registers::doubles>;
            std::array<Taylor<double, 2>, batch> result;
            for (std::size_t first = 0; first < count; first += V::size) {
                const auto lanes = [&](double Rectangle::*number) REVCHAIN_INLINED {
                    V x;
                    for (std::size_t i = 0; i < V::size; ++i)
                        x.set(i, parts[std::min(first + i, count - 1)].*number);
                    return x;
                };
                const Interval<V> x(lanes(&Rectangle::low), lanes(&Rectangle::high)),
                    height(lanes(&Rectangle::height_low), lanes(&Rectangle::height_high));
                const auto y = diagram_.over(Cell<V, 2>(x, height));
                for (std::size_t i = 0; i < std::min(V::size, count - first); ++i) {
                    const auto lane = [&](const Interval<V>& of) REVCHAIN_INLINED {
                        return Interval<double>(of.low[i], of.high[i]);
                    };
                    auto& to = result[first + i];
                    to.value = lane(y.value), to.centre_value = lane(y.centre_value);
                    for (std::size_t k = 0; k < 2; ++k)
                        to.slope[k] = lane(y.slope[k]),
                        to.centre_slope[k] = lane(y.centre_slope[k]);
                    for (std::size_t k = 0; k < 3; ++k) to.bend[k] = lane(y.bend[k]);
                }
            }
            return result;
        });
    }
    bool goes_to_vertical(const Rectangle& part) const {
        return part.low == 0 && diagram_.is_symmetric();
    }

    /// Returns the part extended up and down, if its zeros lie on one graph lambda(x) inside.
    std::optional<Rectangle> graph_over(const Rectangle& part, const Taylor<double, 2>& y,
                                        DiagramProof& proof) const {
        const bool from_zero = goes_to_vertical(part);
        const auto rise = [&](const Taylor<double, 2>& f) {
            const Interval<double>& along = from_zero ? f.bend[1] : f.slope[1];
            const Interval<double> most(from_zero ? f.bend[0].size() : f.slope[0].size()),
                width(part.high - part.low);
            if (along.may_vanish()) return std::numeric_limits<double>::infinity();
            const double least = std::min(std::abs(along.low), std::abs(along.high));
            return (width * most / Interval<double>(least)).high * (1 + 1e-12);
        };
        const double reach = 1.5 * rise(y);
        if (!(reach < std::min(part.height_low / 4, 3 * (part.height_high - part.height_low))))
            return std::nullopt;
        const Rectangle beyond{part.low, part.high, part.height_low - reach,
                               part.height_high + reach};
        ++proof.rectangles;
        if (!(rise(offsets_over({beyond}).front()) <
              std::min(part.height_low - beyond.height_low, beyond.height_high - part.height_high)))
            return std::nullopt;
        return beyond;
    }

    /// Returns the zero of the offset on the line through x, to rounding.
    DiagramPoint zero_at(double x, const Rectangle& within, const Interval<double>& at_low,
                         const Interval<double>& at_high) const {
        const auto value = [&](double height) {
            const Interval<double> y = diagram_.at(x, height);
            return y.may_vanish() ? 0.0 : y.middle();
        };
        const detail::SignChange<double> ends{{within.height_low, at_low.middle()},
                                              {within.height_high, at_high.middle()}};
        return {x, zero_between(ends, value)};
    }

    /// Splits across the direction in which y_x varies more. Returns false if a split is useless.
    template <class Wait>
    bool split(const Rectangle& part, const Taylor<double, 2>& y, const Wait& wait) {
        const bool from_zero = goes_to_vertical(part), at_zero = part.low == 0;
        const double width = part.high - part.low, height = part.height_high - part.height_low;
        double by_x = y.bend[0].size() * width, by_height = y.bend[1].size() * height;
        if (!(by_x < 1e300 && by_height < 1e300))
            by_x = at_zero ? 1 : std::log(part.high / part.low),
            by_height = std::log(part.height_high / part.height_low);
        const bool thin = !(width > 1e-13 * part.high), low = !(height > 1e-13 * part.height_high);
        if ((thin && low) || (at_zero && part.high < 1e-30) ||
            rounding_rules(from_zero ? y.slope[0] : y.value,
                           from_zero ? y.centre_slope[0] : y.centre_value))
            return false;
        Rectangle first = part, second = part;
        if (low || (!thin && by_x >= by_height))
            first.high = second.low = cutting_.between(part.low, part.high);
        else
            first.height_high = second.height_low = part.height_low + cutting_.share() * height;
        wait(first);
        wait(second);
        return true;
    }

    EnclosedDiagram diagram_;
    long budget_;
    Cutting<double> cutting_;
};

/// Returns true if a branch goes through a rectangle in which all shapes lie on one graph lambda(x)
/// through `at`: it has a point in the rectangle, or crosses the x of `at` there.
template <class Branch>
bool goes_through(const Branch& branch, Corrector& corrector, const DiagramPoint& at,
                  const Rectangle& within, int side = 0) {
    const auto turned = [&](double tau) { return side == 0 ? std::abs(tau) : side * tau; };
    const auto inside = [&](const BranchState& state) {  // by a margin above the error of points
        const double height = std::exp(state.log_height),
                     x = height * std::sinh(turned(state.tau[0]));
        constexpr double off = 1e-10;
        const double low = within.height_low * (1 + off), high = within.height_high * (1 - off);
        return within.low * (1 + off) < x && x < within.high * (1 - off) && low < height &&
               height < high;
    };
    const auto& points = trace_of(branch).points;
    for (const BranchPoint& point : points)
        if (inside(point.state)) return true;
    const double tau = std::asinh(at.x / at.height), log_height = std::log(at.height),
                 links = as_double(corrector.size());
    for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
        const BranchPoint &before = points[i], &here = points[i + 1];
        const double reach = 2 * (here.arc - before.arc);
        if (std::abs(here.state.log_height - log_height) > reach ||
            std::abs(turned(here.state.tau[0]) - tau) > reach * std::sqrt(links))
            continue;
        const auto crossings =
            crossings_of(BranchWalk::between(corrector, before, here), XMeasure{at.x, side});
        for (const WithinStep& each : crossings) {
            const double height = std::exp(each.point.state.log_height);
            if (within.height_low < height && height < within.height_high) return true;
        }
    }
    return false;
}

}  // namespace revchain::finite
