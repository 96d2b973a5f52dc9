// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/bounds.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Bounds for all chains that begin in a cell. With mirror images, offsets are over the sine of the
/// lowest link's angle, which excludes the chain along the axis.
struct HeldReach {
    bool none = false;           ///< whether no chain meets the goal with the wanted half waves
    bool known = false;          ///< whether the fields below `looked` are known
    long looked = 1;             ///< number of links swept
    Interval<double> side, gap;  ///< of the upper end, at the cell's centre
    std::array<Interval<double>, 2> side_change, gap_change;  ///< over the cell
};

/// Sweeps a cell of starts up the chain, as `held_sweep` sweeps one state.
class HeldCells : public HeldBounds {
   public:
    using HeldBounds::HeldBounds;

    /// Divides directions of a possibly slack link into arcs, for at most `arcs` sweeps.
    HeldReach operator()(const HeldCell& cell, long arcs) const {
        const HeldCell middle{{point(cell.at[0]), point(cell.at[1])}, cell.leads_up};
        Start box(cell, *this), centre(middle, *this);
        HeldReach result;
        if ((box.pull - turning_of(links_[0]) * square(box.sine)).high <= 0)
            return none(result.looked);
        const std::array<Span, 2> off{cell.at[0] - middle.at[0], cell.at[1] - middle.at[1]};
        Slopes slopes;
        slopes.begin(box, links_[0]);
        int waves = 1, sign = 0;
        if (lower_.yields())
            sign = (gives_ * box.pull * (symmetric_ ? Span(1.0) : box.sine) + foot_ - lower_.radius)
                       .sign();
        Direction<Span> last{-box.sine, box.cosine};
        if (misses(box, 0, waves, sign)) return none(result.looked);
        for (std::size_t m = 1; m < links_.size(); ++m) {
            const Link<Span>& link = links_[m];
            const Span load = height_ * (link.pull - links_[0].pull);
            const Hung at = hung(link, centre, load), everywhere = hung(link, box, load);
            result.looked += 2;
            if (!everywhere.known || !at.known) {
                const bool past = sign != 0 && everywhere.past(box.offset, link) == -sign;
                result.none = symmetric_ && past && waves == most_ && m + 1 < links_.size();
                if (result.none || arcs == 0) return result;
                long work = arcs * static_cast<long>(links_.size());
                result.looked += work;
                result.none = !may_meet(m, box, last, waves, sign, work);
                result.looked -= work;
                return result;
            }
            last = {box.unit * everywhere.sine, everywhere.cosine};
            slopes.pass(link, box, everywhere);
            centre.pass(link, at), box.pass(link, everywhere);
            for (Start::Part part : {&Start::offset, &Start::across, &Start::rise}) {
                const auto& change = slopes.of(part);
                box.*part =
                    common(box.*part, centre.*part + change[0] * off[0] + change[1] * off[1]);
            }
            if (misses(box, m, waves, sign)) return none(result.looked);
        }
        result.known = true;
        result.side = side(centre), result.gap = gap(centre);
        result.side_change = slopes.of(&Start::offset), result.gap_change = slopes.of(&Start::rise);
        const std::array<Span, 2>& pulled = slopes.of(&Start::across);
        for (std::size_t i = 0; i < 2 && upper_.yields(); ++i) {
            Span& side = result.side_change[i];
            side = side - upper_.compliance * (pulled[i] + upper_.carriage * side);
        }
        if (goal_.is_span) return result;
        const Span across = box.unit * box.across, along = top(box),
                   force = sqrt(square(across) + square(along));
        const std::array<Span, 2> unit{Span(0.0), box.unit_change},
            push{box.cosine, box.push_change};
        for (std::size_t i = 0; i < 2; ++i) {
            const Span change = box.unit * pulled[i] + box.across * unit[i];
            result.gap_change[i] = (across * change + along * push[i]) / force;
        }
        return result;
    }

   private:
    static Span point(const Span& x) { return Span(x.middle()); }
    static HeldReach none(long looked) {
        HeldReach result;
        result.none = true, result.looked = looked;
        return result;
    }

    /// A link: its loads, sine over `Start::unit`, cosine, pull and turning stiffness (see
    /// `find_direction`).
    struct Hung {
        Span across, along, sine, cosine, pull, stiffness, most;
        bool known = false;

        /// Returns the certain sign of the offset above a link whose pull may vanish, or 0.
        int past(const Span& offset, const Link<Span>& link) const {
            const int sign = across.sign();
            const Span turning = turning_of(link);
            if (sign == 0 || !(most.high > 0) || turning.low < 0) return 0;
            const Span least = link.length * across / Span((most + turning).high);
            return sign > 0 && offset.high < least.low   ? -1
                   : sign < 0 && offset.low > least.high ? 1
                                                         : 0;
        }
    };

    /// A partly swept chain and its start. The sine is positive if the lowest link leads outwards.
    /// Offset and force across are over `unit`: this sine if shapes have mirror images, else 1.
    struct Start {
        using Part = Span Start::*;
        Span pull, sine, cosine, sine_change, cosine_change, push, push_change;
        Span unit{1.0}, unit_change{0.0};
        Span offset, across, rise;
        std::array<Span, 2> offset_change{Span(0.0), Span(0.0)},
            across_change{Span(-1.0), Span(0.0)};

        Start(const HeldCell& cell, const HeldCells& chain) : pull(cell.at[0]) {
            const Link<Span>& lowest = chain.links_[0];
            const auto low = direction(cell.at[1].low), high = direction(cell.at[1].high);
            sine = hull(low[0], high[0]), cosine = hull(low[1], high[1]);
            if (chain.symmetric_) sine.low = std::max(sine.low, 0.0);
            if (cell.at[1].contains(1.0)) sine.high = std::max(sine.high, 1.0);
            if (cell.at[1].contains(-1.0)) sine.low = std::min(sine.low, -1.0);
            if (cell.at[1].contains(0.0)) cosine.high = std::max(cosine.high, 1.0);
            const Span twice =
                hull(Span(hull(low[2], high[2])), cell.at[1].contains(0.0) ? Span(2.0) : low[2]);
            sine_change = cosine * twice, cosine_change = -(sine * twice);
            if (!cell.leads_up) cosine = -cosine, cosine_change = -cosine_change;
            const Span turning = turning_of(lowest);
            push = (pull - turning) * cosine, push_change = (pull - turning) * cosine_change;
            offset = lowest.length, rise = lowest.length * cosine;
            if (chain.symmetric_) {
                unit = sine, unit_change = sine_change;
                if (chain.lower_.yields()) {
                    offset = offset + chain.gives_ * pull, offset_change[0] = chain.gives_;
                    across_change[0] = lowest.rest * offset_change[0] - Span(1.0);
                }
                across = lowest.rest * offset - pull;
                return;
            }
            Span arm = offset;
            if (chain.lower_.yields()) {
                arm = arm + chain.gives_ * pull, offset_change[0] = chain.gives_ * sine;
            }
            offset = chain.foot_ + arm * sine, offset_change[1] = arm * sine_change;
            across = lowest.rest * offset - pull * sine;
            across_change = {lowest.rest * offset_change[0] - sine,
                             lowest.rest * offset_change[1] - pull * sine_change};
        }
        void pass(const Link<Span>& link, const Hung& hung) {
            offset = offset - link.length * hung.sine;
            rise = rise + link.length * hung.cosine;
            across = hung.across + link.rest * offset;
        }
    };

    /// Derivatives of a chain by pull and tangent: those at the centre, and deviations in the basis
    /// of the product of the links' matrices, so that intervals do not grow.
    class Slopes {
       public:
        void pass(const Link<Span>& link, const Start& chain, const Hung& hung) {
            const Span& s = hung.sine;
            const Span bend = square(hung.cosine) / hung.stiffness, turn = link.length * bend;
            const Span with_unit = -(chain.unit * hung.across * square(s) *
                                     (hung.pull - turning_of(link))) /
                                   (hung.stiffness * hung.pull),
                       with_push = -(hung.cosine * s) / hung.stiffness;
            const std::array<Span, 2> unit{Span(0.0), chain.unit_change},
                push{chain.cosine, chain.push_change};
            const std::array<Span, 4> J{Span(1.0) - turn * link.moment, -turn,
                                        link.moment + link.rest * (Span(1.0) - turn * link.moment),
                                        Span(1.0) - link.rest * turn};
            std::array<double, 4> next{};
            for (std::size_t i = 0; i < 4; ++i)
                next[i] = J[i / 2 * 2].middle() * basis_[i % 2] +
                          J[i / 2 * 2 + 1].middle() * basis_[i % 2 + 2];
            const Span p(next[0]), q(next[1]), r(next[2]), t(next[3]), determinant = p * t - q * r;
            const auto solved = [&](const Span& x, const Span& y) {
                return std::array{(t * x - q * y) / determinant, (p * y - r * x) / determinant};
            };
            const auto times = [&](double x, double y) {
                return std::array{J[0] * Span(x) + J[1] * Span(y), J[2] * Span(x) + J[3] * Span(y)};
            };
            const auto first = times(basis_[0], basis_[2]), second = times(basis_[1], basis_[3]);
            const auto one = solved(first[0], first[1]), other = solved(second[0], second[1]);
            for (std::size_t i = 0; i < 2; ++i) {
                const Span direct = -(link.length * (with_unit * unit[i] + with_push * push[i]));
                const Span loaded = across_[i] + link.moment * offset_[i];
                const Span moved = chain.unit * loaded + hung.across * unit[i];
                rise_[i] = rise_[i] - link.length * (chain.unit * s / hung.stiffness) *
                                          (hung.cosine * moved - chain.unit * s * push[i]);
                const auto kept = times(middle_[i][0], middle_[i][1]);
                const Span offset = kept[0] + direct, across = kept[1] + link.rest * direct;
                middle_[i] = {offset.middle(), across.middle()};
                const auto fresh =
                    solved(offset - Span(middle_[i][0]), across - Span(middle_[i][1]));
                const Span a = one[0] * off_[i][0] + other[0] * off_[i][1] + fresh[0],
                           b = one[1] * off_[i][0] + other[1] * off_[i][1] + fresh[1];
                off_[i] = {a, b};
            }
            basis_ = next;
            for (std::size_t i = 0; i < 2; ++i) {
                offset_[i] = Span(middle_[i][0]) + Span(basis_[0]) * off_[i][0] +
                             Span(basis_[1]) * off_[i][1];
                across_[i] = Span(middle_[i][1]) + Span(basis_[2]) * off_[i][0] +
                             Span(basis_[3]) * off_[i][1];
            }
        }
        const std::array<Span, 2>& of(Start::Part part) const {
            return part == &Start::offset ? offset_ : part == &Start::across ? across_ : rise_;
        }
        void begin(const Start& chain, const Link<Span>& lowest) {
            rise_[1] = lowest.length * chain.cosine_change;
            offset_ = chain.offset_change, across_ = chain.across_change;
            for (std::size_t i = 0; i < 2; ++i) {
                middle_[i] = {offset_[i].middle(), across_[i].middle()};
                if (offset_[i].width() > 0 || across_[i].width() > 0)
                    off_[i] = {offset_[i] - Span(middle_[i][0]), across_[i] - Span(middle_[i][1])};
            }
        }

       private:
        std::array<double, 4> basis_{1, 0, 0, 1};
        std::array<std::array<double, 2>, 2> middle_{};
        std::array<std::array<Span, 2>, 2> off_{};
        std::array<Span, 2> offset_{}, across_{}, rise_{};
    };

    Span top(const Start& chain) const { return chain.push + height_ * (weight_ - links_[0].pull); }
    Span gap(const Start& chain) const {
        if (goal_.is_span) return chain.rise - goal_.value;
        return sqrt(square(chain.unit * chain.across) + square(top(chain))) - goal_.value;
    }

    /// Returns the distance of the upper end of a swept chain from its support, over the unit.
    Span side(const Start& chain) const {
        return symmetric_ && upper_.firm ? chain.offset : upper_.miss(chain.offset, chain.across);
    }
    /// Returns the offset of the line between the ends' rest positions at the chain's height.
    Span line(const Start& chain) const {
        return symmetric_ ? Span(0.0) : lower_.radius + slope_ * chain.rise;
    }
    /// Returns true if a chain swept to link m cannot meet the goal. Counts half waves.
    bool misses(Start& chain, std::size_t m, int& waves, int& sign) const {
        const bool last = m + 1 == links_.size();
        const Span y = upper_.firm ? chain.unit * side(chain) : Span(0.0),
                   z = goal_.is_span ? gap(chain) : Span(0.0);
        if ((square(y) + square(z)).low > square(rest_[m + 1]).high) return true;
        if (!goal_.is_span && (chain.rise + rest_[m + 1]).high < 0) return true;  // upside down
        if (last && (!side(chain).may_vanish() || !gap(chain).may_vanish())) return true;
        if (last && upper_.firm) return false;
        const Span aside = symmetric_ ? chain.offset : chain.offset - line(chain);
        const int here = aside.sign();
        if (sign == 0) sign = here;
        if (here == -sign && here != 0) sign = here, ++waves;
        if (waves == most_ && sign != 0) {  // the chain must not cross the line again
            const Span at = line(chain);
            if (sign > 0) chain.offset.low = std::max(chain.offset.low, at.low);
            if (sign < 0) chain.offset.high = std::min(chain.offset.high, at.high);
        }
        return waves > most_;
    }

    /// Returns true if a chain may meet the upper end from link m on, in intervals and arcs.
    bool may_meet(std::size_t m, Start chain, Direction<Span> last, int waves, int sign,
                  long& work) const {
        for (; m < links_.size(); ++m) {
            if (--work < 0) return true;
            const Link<Span>& link = links_[m];
            const Hung at = hung(link, chain, height_ * (link.pull - links_[0].pull));
            if (at.known) {
                last = {chain.unit * at.sine, at.cosine};
                chain.pass(link, at);
                if (misses(chain, m, waves, sign)) return false;
                continue;
            }
            for (std::size_t quarter = 0; quarter < 4; ++quarter)
                if (in_arc(m, chain, last, at, waves, sign, work, quarter, 0, 1)) return true;
            return false;
        }
        return true;
    }

    /// Returns `may_meet` for directions of link m in part of a quarter circle.
    bool in_arc(std::size_t m, const Start& chain, const Direction<Span>& last, const Hung& at,
                int waves, int sign, long& work, std::size_t quarter, double from,
                double to) const {
        if (--work < 0) return true;
        const Link<Span>& link = links_[m];
        auto [sine, cosine] = arc(quarter, from, to);
        const Span R = chain.unit * at.across, turning = turning_of(link);
        if (!(at.along * sine + turning * sine * cosine - R * cosine).may_vanish()) return false;
        if (!((at.along * cosine + turning * (square(cosine) - square(sine)) + R * sine).high > 0))
            return false;
        if (at.across.sign() * sine.sign() < 0 && turning.low >= 0) return false;
        if (is_zero(turning) && is_zero(turning_of(links_[m - 1]))) {
            // the pull is that of the link below plus the load of the pin between them
            const Span weight = height_ * (link.pull - links_[m - 1].pull),
                       out = chain.unit * chain.offset * (links_[m - 1].rest + link.moment);
            const int aside = (sine * last.cosine - cosine * last.sine).sign(),
                      added = (sine * weight - cosine * out).sign();
            if (aside * added > 0) return false;
        }
        const auto in_halves = [&] {
            const double middle = (from + to) / 2;
            return in_arc(m, chain, last, at, waves, sign, work, quarter, from, middle) ||
                   in_arc(m, chain, last, at, waves, sign, work, quarter, middle, to);
        };
        if (to - from > 0.07) return in_halves();
        for (int round = 0; round < 3; ++round) {  // Newton's method in intervals about the middle
            const Span at_s(sine.middle()), at_c(cosine.middle()),
                size = sqrt(square(at_s) + square(at_c));
            const Span s = at_s / size, c = at_c / size, near_s = hull(sine, s),
                       near_c = hull(cosine, c);
            const Span stiffness =
                at.along * near_c + turning * (square(near_c) - square(near_s)) + R * near_s;
            if (!stiffness.positive()) break;
            const Span turn = (R * c - at.along * s - turning * s * c) / stiffness;
            sine = common(sine, s + near_c * turn), cosine = common(cosine, c - near_s * turn);
            if (!(sine.low <= sine.high && cosine.low <= cosine.high)) return false;
        }
        Start next = chain;
        next.rise = chain.rise + link.length * cosine;
        const Span pulled = sqrt(square(at.along + turning * cosine) + square(R));
        if (chain.unit.positive() || pulled.positive()) {
            Span across = pulled.positive() ? at.across / pulled : sine / chain.unit;
            if (chain.unit.positive()) across = common(across, sine / chain.unit);
            if (!(across.low <= across.high)) return false;
            next.offset = chain.offset - link.length * across;
            next.across = at.across + link.rest * next.offset;
        } else {  // the pull along the link may vanish: the offset above it becomes the unit
            const int side = chain.offset.sign(), drawn = at.across.sign();
            if (side == 0 || drawn == 0 || turning.low < 0) return true;
            const bool away = drawn != side;
            const Span offset = side > 0 ? chain.offset : -chain.offset,
                       across = drawn > 0 ? at.across : -at.across;
            const Span most(pulled.high),
                share = away ? Span(1.0) : Span(1.0) - offset * most / (link.length * across);
            if (!share.positive()) return true;
            const Span moved = link.length * (drawn > 0 ? sine : -sine), was = chain.unit * offset;
            next.unit = away ? moved + was : moved - was;
            next.unit.low = std::max(next.unit.low, 0.0);
            next.offset = Span(drawn > 0 ? -1.0 : 1.0);
            const Span added = Span(0.0, (most / (link.length * share)).high);
            next.across = link.rest * next.offset + (drawn > 0 ? added : -added);
        }
        int more = waves, way = sign;
        if (misses(next, m, more, way) || !may_meet(m + 1, next, {sine, cosine}, more, way, work))
            return false;
        return to - from < 1e-3 || in_halves();
    }
    static std::array<Span, 2> arc(std::size_t quarter, double from, double to) {
        const auto low = direction(from), high = direction(to);
        const Span s = hull(low[0], high[0]), c = hull(low[1], high[1]);
        const std::array<Span, 5> turned{s, c, -s, -c, s};
        return {turned[quarter], turned[quarter + 1]};
    }
    static std::array<Span, 3> direction(double t) {
        const Span tangent(t), whole = Span(1.0) + square(tangent);
        return {Span(2.0) * tangent / whole, (Span(1.0) - square(tangent)) / whole,
                Span(2.0) / whole};
    }

    static Hung hung(const Link<Span>& link, const Start& chain, const Span& load) {
        Hung result;
        const Span r = chain.across + link.moment * chain.offset, R = chain.unit * r,
                   V = chain.push + load;
        result.across = r, result.along = V;
        const Span sum = square(R) + square(V);
        result.most = sqrt(sum);
        const Span turning = turning_of(link);
        if (is_zero(link.cross)) {
            if (!sum.positive()) return result;
            result.pull = result.stiffness = result.most;
            result.cosine = common(V / result.pull, Span(-1.0, 1.0));
        } else {
            if (!(sum.low > square(turning).high * (1 + 1e-9))) return result;
            Direction<double> way{R.middle() / std::hypot(R.middle(), V.middle()),
                                  V.middle() / std::hypot(R.middle(), V.middle())};
            const Link<double> near{link.length.middle(), 0, link.cross.middle(), 0, 0};
            if (!(find_direction(near, R.middle(), V.middle(), way) > 0)) return result;
            Direction<Span> all;  // by Newton's method in intervals about the middle's inclination
            const Span stiffness = enclose_rigid_direction(link, R, V, way, all);
            if (!stiffness.positive()) return result;
            result.cosine = common(all.cosine, Span(-1.0, 1.0));
            result.pull = sqrt(square(V + turning * result.cosine) + square(R));
            result.stiffness = common(stiffness, result.pull - turning * square(all.sine));
            if (!result.pull.positive() || !result.stiffness.positive()) return result;
        }
        result.sine = r / result.pull;
        result.known = true;
        return result;
    }
};

}  // namespace revchain::finite
