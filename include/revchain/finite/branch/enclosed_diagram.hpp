// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/taylor.hpp"
#include "revchain/finite/branch/branch_links.hpp"
#include "revchain/finite/branch/state.hpp"
#include "revchain/finite/shapes/list.hpp"
#include "revchain/finite/shapes/tangent_limit.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A point of the diagram: x = lambda times the tangent of the lowest link, and lambda.
struct DiagramPoint {
    double x, height;
};

/// The function of x and lambda whose zeros are the diagram: the distance of the topmost pin from
/// its support. With a spring of stiffness E and a carriage W it is lambda E (y - b) - H - W y,
/// finite at any height. Off the axis x has both signs; `side` -1 is the mirror image.
class EnclosedDiagram {
   public:
    explicit EnclosedDiagram(EnclosedLinks<double> chain) : links_(std::move(chain)) {}
    EnclosedDiagram(const BranchSystem& system, int side)
        : side_(system.links.is_symmetric() ? 0 : side) {
        const auto& from = system.links;
        links_ = enclosed<double>(std::vector<Link<Fine>>(
            from.links.begin(), from.links.begin() + static_cast<std::ptrdiff_t>(from.bodies())));
        for (const Fine& spin : from.spin) kept_.spin.push_back(enclosed<double>(spin));
        kept_.pace = enclosed<double>(from.pace);
        radius_ = enclosed<double>(side < 0 ? -from.radius : from.radius);
        if (!from.spring) return;
        firm_ = false;
        stiffness_ = enclosed<double>(from.links.back().pull / from.links.back().length);
        carriage_ = enclosed<double>(from.links.back().moment);
    }

    std::size_t size() const { return links_.size(); }
    bool is_symmetric() const { return side_ == 0; }
    int side() const { return side_; }

    /// Returns the height at which the spring's stiffness times the height equals the whole moving
    /// weight, so that pins may be at any distance. Returns 0 for a firm support.
    double loosest_height() const {
        if (firm_) return 0;
        Interval<double> moving = carriage_;
        for (const auto& link : links_) moving = moving + link.moment + link.rest;
        return (moving / stiffness_).high;
    }
    /// Returns an upper bound of x at a height and above. The height must exceed `loosest_height`.
    double last(double height) const {
        const Interval<double> lambda(height);
        EnclosedLinks<double> slackest = links_at(lambda);
        for (std::size_t m = 0; m < size(); ++m)
            slackest[m].pull.low = std::min(slackest[m].pull.low, links_[m].pull.low);
        return height * tangent_limit(slackest, lambda, false, held_at(lambda));
    }
    Interval<double> at(double x, double height) const {
        const Interval<double> lambda(height);
        if (kept_.spin.empty()) return offset(links_, x, lambda);
        return offset(links_at(lambda), x, lambda);
    }
    BranchState state_at(const DiagramPoint& at) const {
        const Interval<double> lambda(at.height);
        const double turned = side_ < 0 ? -1 : 1;
        std::vector<Interval<double>> tangents;
        const auto y = support_offset(links_at(lambda), lambda, Interval<double>(at.x) / lambda,
                                      OnAxis{}, &tangents);
        BranchState state;
        double reach = 0;
        for (const auto& t : tangents) state.tau.push_back(turned * std::asinh(t.middle()));
        for (const auto& link : links_) reach += link.length.middle();
        if (!firm_)
            state.tau.push_back(turned * std::asinh((y.middle() - radius_.middle()) / reach));
        state.log_height = std::log(at.height);
        return state;
    }
    /// Returns the function and its derivatives over a cell. T is a number or a pack.
    template <class T>
    [[gnu::always_inline]] Taylor<T, 2> over(const Cell<T, 2>& cell) const {
        return ended(swept_cell<T>(links_, cell), cell);
    }
    bool spins() const { return !kept_.spin.empty(); }
    /// Returns `over` for rigs with flywheels, one cell at a time, not compiled for packs.
    Taylor<double, 2> spinning_over(const Cell<double, 2>& cell) const {
        return ended(swept_cell<double, true>(links_, cell, &kept_), cell);
    }

   private:
    EnclosedLinks<double> links_at(const Interval<double>& height) const {
        EnclosedLinks<double> result = links_;
        if (kept_.spin.empty()) return result;
        const Interval<double> speed = kept_.pace / sqrt(height);
        for (std::size_t m = 0; m < size(); ++m)
            result[m].pull = result[m].pull + speed * kept_.spin[m];
        return result;
    }
    SupportEnd<Interval<double>> held_at(const Interval<double>& height) const {
        const Interval<double> stiffness = height * stiffness_;
        return {radius_,        firm_ ? Interval<double>(0.0) : Interval<double>(1.0) / stiffness,
                stiffness,      carriage_,
                is_symmetric(), firm_};
    }
    Interval<double> offset(const EnclosedLinks<double>& links, double x,
                            const Interval<double>& lambda) const {
        return support_offset(links, lambda, Interval<double>(x) / lambda, held_at(lambda));
    }
    template <class T>
    [[gnu::always_inline]] static Interval<T> spread(const Interval<double>& x) {
        return Interval<T>(T(x.low), T(x.high));
    }
    template <class T, class Sweep>
    [[gnu::always_inline]] Taylor<T, 2> ended(const Sweep& sweep, const Cell<T, 2>& cell) const {
        const Taylor<T, 2> y = sweep.offset();
        if (firm_) return is_symmetric() ? y : y - spread<T>(radius_);
        const Taylor<T, 2> drawn = spread<T>(stiffness_) * (y - spread<T>(radius_));
        Taylor<T, 2> pulled;  // lambda times `drawn`
        const Interval<T>&lambda = cell.range(1), &centre = cell.centre(1);
        pulled.value = lambda * drawn.value, pulled.centre_value = centre * drawn.centre_value;
        pulled.slope = {lambda * drawn.slope[0], drawn.value + lambda * drawn.slope[1]};
        pulled.centre_slope = {centre * drawn.centre_slope[0],
                               drawn.centre_value + centre * drawn.centre_slope[1]};
        pulled.bend = {lambda * drawn.bend[0], drawn.slope[0] + lambda * drawn.bend[1],
                       Interval<T>(T(2)) * drawn.slope[1] + lambda * drawn.bend[2]};
        return cell.centred(pulled - sweep.sum() - spread<T>(carriage_) * y);
    }

    EnclosedLinks<double> links_;
    KeptMomentum<Interval<double>> kept_{{}, Interval<double>(0.0)};
    Interval<double> radius_{0.0}, stiffness_{0.0}, carriage_{0.0};
    bool firm_ = true;
    int side_ = 0;
};

}  // namespace revchain::finite
