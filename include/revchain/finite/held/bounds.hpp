// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "revchain/finite/held/sweep.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The goal of a chain held at both ends: its span, or lambda times the tension at the upper end.
struct HeldGoal {
    Interval<double> value;
    bool is_span = true;
};

/// A cell of starts: ranges of two numbers of the lowest link of a chain held at both ends. These
/// are lambda times the pull along the link, and the tangent of half its angle to the axis,
/// positive outwards. The angle is that to the upward axis if the link leads upwards, else to the
/// downward axis. So tangents from -1 to 1 suffice, and from 0 to 1 with mirror images.
struct HeldCell {
    std::array<Interval<double>, 2> at;  ///< pull, tangent
    bool leads_up = true;
};

/// A chain held at both ends, its ends and its goal in intervals, with bounds for all its shapes.
class HeldBounds {
   public:
    using Span = Interval<double>;

    HeldBounds(const EnclosedLinks<double>& links, const HeldEnds<Span>& ends, const Span& height,
               const HeldGoal& goal, int max_half_waves)
        : links_(links),
          lower_(ends.lower),
          upper_(ends.upper),
          height_(height),
          goal_(goal),
          most_(max_half_waves),
          symmetric_(ends.is_symmetric()),
          rest_(links.size() + 1, Span(0.0)) {
        for (std::size_t m = links.size(); m-- > 0;) {
            rest_[m] = rest_[m + 1] + links[m].length,
            weight_ = weight_ + links[m].moment + links[m].rest;
            swung_ = swung_ + Span(links[m].moment.size()) + Span(links[m].rest.size());
            turning_ = std::max(turning_, turning_of(links[m]).size());
        }
        foot_ = lower_.radius;
        if (lower_.yields()) {
            const Span left = Span(1.0) - lower_.compliance * (lower_.carriage + links[0].moment);
            foot_ = lower_.radius / left, gives_ = lower_.compliance / left;
        }
        if (!symmetric_) slope_ = (upper_.radius - lower_.radius) / goal.value;
    }

    bool is_symmetric() const { return symmetric_; }
    /// Returns bounds of the pull along the lowest link. Pulls differ by at most the weights and
    /// centrifugal forces. Under a larger pull every link has nearly one direction. Then the chain
    /// spans too much, or a spring yields farther than an end can move.
    Span pulls() const {
        const Span &length = rest_[0], &goal = goal_.value;
        const Span chord = goal_.is_span ? sqrt(square(length) - square(goal)) : length;
        const Span farthest = reach(chord),
                   change = weight_ * height_ + swung_ * farthest + Span(2 * turning_);
        Span most = goal + change;
        if (goal_.is_span && lower_.firm && upper_.firm) {
            const Span apart = square(goal) + square(upper_.radius - lower_.radius);
            most = change * length / sqrt(square(length) - apart);
        } else if (goal_.is_span) {
            // links are within an angle of the lowest, some steeper than span/length, some flatter
            const auto drawn = [&](const SupportEnd<Span>& end) {
                return end.stiffness * (farthest + Span(end.radius.size())) +
                       end.carriage * farthest;
            };
            const Span own = drawn(lower_) + Span(links_[0].moment.size()) * farthest,
                       other = drawn(upper_) + change;
            const Span load = lower_.firm                            ? other
                              : upper_.firm || own.high < other.high ? own
                                                                     : other;
            most = Span(std::max(change.high, load.high)) /
                   sqrt((Span(1.0) - goal / length) / Span(2.0));
        }
        return {std::min(0.0, turning_of(links_[0]).low), most.high};
    }
    const Span& length() const { return rest_[0]; }

    /// Returns the forces at the lower end for the numbers of a `HeldCell`: lambda times the pull
    /// along the lowest link, the tangent of half its angle, and whether it leads upwards.
    HeldForces<double> forces(double pull, double tangent, bool leads_up) const {
        const auto number = [](const Span& x) { return x.middle(); };
        const double sine = 2 * tangent / (1 + tangent * tangent),
                     cosine =
                         (leads_up ? 1 : -1) * (1 - tangent * tangent) / (1 + tangent * tangent);
        const double load = -pull * sine, foot = lower_.yields()
                                                     ? number(foot_) - number(gives_) * load
                                                     : number(lower_.radius);
        return {lower_.yields() ? load - (number(lower_.carriage) + number(links_[0].moment)) * foot
                                : load - number(links_[0].moment) * foot,
                (pull - number(turning_of(links_[0]))) * cosine -
                    number(height_) * number(links_[0].pull),
                number(height_)};
    }

   protected:
    /// Bounds the offset of every pin; `chord` bounds the distance of two pins across the axis.
    Span reach(const Span& chord) const {
        const Span foot(lower_.radius.size()), head(upper_.radius.size());
        if (lower_.firm && upper_.firm) {
            if (symmetric_) return chord / Span(2.0);
            return Span(std::max(foot.high, head.high)) + rest_[0] / Span(2.0);
        }
        if (lower_.firm) return foot + chord;
        if (upper_.firm) return head + chord;
        // the springs together balance all centrifugal forces
        const Span left =
            lower_.stiffness + upper_.stiffness - lower_.carriage - upper_.carriage - weight_;
        if (left.may_vanish()) return Span(std::numeric_limits<double>::infinity());
        const Span other((upper_.carriage - upper_.stiffness).size());
        return (lower_.stiffness * foot + upper_.stiffness * head + (swung_ + other) * chord) /
                   Span(left.positive() ? left.low : -left.high) +
               chord;
    }

    const EnclosedLinks<double>& links_;
    SupportEnd<Span> lower_, upper_;
    Span height_;
    HeldGoal goal_;
    int most_;
    bool symmetric_;
    Span foot_{0.0}, gives_{0.0};    // of the lower end: offset without load, compliance
    Span slope_{0.0};                // of the line between the rest positions of the ends
    Span weight_{0.0}, swung_{0.0};  // sum of moments and rests of all links, and of their sizes
    double turning_ = 0;             // largest length times cross
    std::vector<Span> rest_;         // length from a pin to the upper end
};

}  // namespace revchain::finite
