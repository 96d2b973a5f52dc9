// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/held/sweep.hpp"
#include "revchain/numeric/arc_step.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A state of a chain or cord held at both ends: the forces at the lower end, and the span.
struct HeldState {
    HeldForces<double> forces;
    double span;
};

/// The number that varies along a curve of states besides the two forces.
enum class Third { span, height, part };

/// A curve of states whose upper end is at its support, in two forces and a third number (`Third`),
/// followed by its arc through folds. Its tangent is the cross product of two gradients. `Shooter`
/// maps forces to the upper end: `HeldEnd<double> operator()(const HeldForces<double>&, bool
/// keep)`. If `keep` is true it stores its state.
template <class Shooter>
class HeldCurve {
   public:
    /// `length` and `weight` scale steps. `symmetric` is true if both ends are on the axis.
    HeldCurve(Shooter& shooter, double length, double weight, bool symmetric = true)
        : shooter_(&shooter), length_(length), weight_(weight), symmetric_(symmetric) {}

    static constexpr int max_steps = 3000;
    static constexpr double at_rest = 1e4;  ///< conical height over length of a chain at rest

    /// Returns the state at the span and height of `state`, by Newton's method, to double accuracy.
    std::optional<HeldState> corrected(HeldState state) {
        detail::check_interrupt();
        const auto sweep = [&](const HeldForces<double>& at) { return (*shooter_)(at, false); };
        if (!find_forces(state.forces, state.span, has_image(state), 1e-13, 1e-7, sweep)) return {};
        (*shooter_)(state.forces, true);
        return state;
    }

    /// Returns the state at a span and a height, by continuation; none if the curve does not lead
    /// there. First the ends of the nearly straight system without gravity approach each other.
    /// Ends that are not firm on the axis then move to their supports. Last, gravity grows. `slack`
    /// is length less span; `nearly_straight(slack)` returns the forces of a small slack.
    template <class NearlyStraight>
    std::optional<HeldState> from_straight(double slack, double span, double height,
                                           const NearlyStraight& nearly_straight) {
        const double first = std::min(slack, 1e-3 * length_);
        auto state = corrected({nearly_straight(first), length_ - first});
        if (state && slack > first) state = follow<Third::span>(*state, span);
        if constexpr (requires { shooter_->vary_part(true); }) {
            if (state && state->forces.part < 1) {
                shooter_->vary_part(true);
                state = follow<Third::part>(*state, 1);
                shooter_->vary_part(false);
            }
        }
        if (state && height > 0) state = follow<Third::height>(*state, height);
        return state;
    }
    /// Visits the states at the height of `from` whose top tension times lambda is `wanted`, both
    /// ways along the curve. Usually there are two, on both sides of the largest tension.
    template <class Visit>
    void under(const HeldState& from, double wanted, Visit&& visit) {
        const auto kept = shooter_->kept();
        for (const bool up : {true, false}) {
            shooter_->keep(kept);
            Tense last = tense(from, wanted), before = last;
            step_along<Third::span>(from, up, [&](const HeldState& state) {
                const Tense here = tense(state, wanted);
                const auto there = shooter_->kept();
                if (here.off * last.off < 0) {
                    between(last, here, wanted, visit);
                } else if (before.off * last.off > 0 && std::abs(last.off) < std::abs(before.off) &&
                           std::abs(last.off) < std::abs(here.off)) {
                    // the nearest state may be beyond the wanted tension; then there are two states
                    if (const auto met = crossed(before, here, wanted)) {
                        between(before, *met, wanted, visit);
                        between(*met, here, wanted, visit);
                    }
                }
                shooter_->keep(there);
                before = last, last = here;
                return state.span > 1e-6 * length_ && length_ - state.span > 1e-12 * length_;
            });
        }
    }

    /// Visits the states of constant span, first to greater heights, until `visit` returns false.
    template <class Visit>
    void along_heights(const HeldState& from, double max_step, Visit&& visit) {
        step_along<Third::height>(from, true, visit, max_step);
    }
    /// Returns the state in the plane across the chord of two states, at a share of the chord.
    std::optional<HeldState> across_chord(const HeldState& from, const HeldState& to,
                                          double share) {
        constexpr Third height = Third::height;
        const Triple scale = scales<height>(from);
        const HeldForces<double>&a = from.forces, &b = to.forces;
        const Triple chord{b.across - a.across, b.along - a.along, b.height - a.height};
        const Triple scaled = chord.cwiseQuotient(scale);
        const double step = share * scaled.norm();
        HeldState at;
        HeldEnd<double> end;
        int rounds = 0;
        if (!correct<height>(from, scale, scaled.normalized(), step, at, end, rounds)) return {};
        (*shooter_)(at.forces, true);
        return at;
    }
    template <class Off>
    std::optional<HeldState> first_where(const HeldState& from, const Off& off) {
        HeldState before = from;
        double was = off(from);
        std::optional<HeldState> met;
        along_heights(from, 0.05, [&](const HeldState& state) {
            const auto there = shooter_->kept();
            const double here = off(state);
            if (here * was < 0) {
                const auto at = [&](double share) { return across_chord(before, state, share); };
                met = detail::state_between(was, here, at, off);
                if (met) return false;
                shooter_->keep(there);
            }
            before = state, was = here;
            return state.forces.height > 0 && state.forces.height < at_rest * length_;
        });
        return met;
    }

   private:
    using Triple = Eigen::Vector3d;

    struct Tense {
        HeldState state;
        double off;  ///< lambda times the top tension, minus the wanted value
    };
    Tense tense(const HeldState& x, double wanted) {
        const double across = (*shooter_)(x.forces, false).across,
                     along = x.forces.along + x.forces.height * weight_;
        return {x, std::hypot(across, along) - wanted};
    }
    static HeldState mixed(HeldState a, const HeldState& b, double share) {
        a.span += share * (b.span - a.span);
        a.forces.across += share * (b.forces.across - a.forces.across);
        a.forces.along += share * (b.forces.along - a.forces.along);
        return a;
    }
    std::optional<Tense> at_share(const Tense& a, const Tense& b, double share, double wanted) {
        const auto state = corrected(mixed(a.state, b.state, share));
        if (!state) return {};
        return tense(*state, wanted);
    }
    /// Visits the state between two states with the wanted top tension. There is none if the
    /// tension jumps past it, where the curve is left for another.
    template <class Visit>
    void between(const Tense& a, const Tense& b, double wanted, Visit&& visit) {
        const auto at = [&](double share) { return at_share(a, b, share, wanted); };
        const auto off = [](const Tense& x) { return x.off; };
        const auto best = detail::state_between(a.off, b.off, at, off, 1e-16 * wanted);
        if (best && std::abs(best->off) <= 1e-10 * wanted) visit(best->state);
    }
    /// Returns a state between two that is beyond the wanted tension, searched where it is nearest.
    std::optional<Tense> crossed(Tense a, Tense b, double wanted) {
        for (int round = 0; round < 60; ++round) {
            const auto first = at_share(a, b, 0.4, wanted), second = at_share(a, b, 0.6, wanted);
            if (!first || !second) return {};
            if (first->off * a.off < 0) return first;
            if (second->off * a.off < 0) return second;
            if (std::abs(first->off) < std::abs(second->off))
                b = *second;
            else
                a = *first;
        }
        return {};
    }

    static Triple cross(const Triple& x, const Triple& y) {
        return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
    }

    template <Third third>
    Triple scales(const HeldState& x) const {
        const double along = std::abs(x.forces.along), hung = weight_ * x.forces.height,
                     across =
                         std::abs(x.forces.across) + (has_image(x) ? 0.0 : 0.1 * (along + hung));
        const double pull = along + 0.05 * (across + hung);
        if constexpr (third == Third::span) {
            const double least = x.forces.height == 0 ? along : pull;
            return {across, least,
                    std::min(std::abs(x.span) + 1e-3 * length_, std::abs(length_ - x.span))};
        } else if constexpr (third == Third::height) {
            return {across, pull, x.forces.height + 0.3 * (across + along) / weight_};
        } else {
            return {across, pull, 0.3};
        }
    }
    template <Third third, class State>
    static auto& number(State& x) {
        if constexpr (third == Third::span)
            return x.span;
        else if constexpr (third == Third::height)
            return x.forces.height;
        else
            return x.forces.part;
    }
    /// Returns true if the opposite force across gives a state too; then this force is never 0.
    bool has_image(const HeldState& x) const { return symmetric_ || x.forces.part == 0; }
    template <Third third>
    static HeldState moved(const HeldState& from, const Triple& scale, const Triple& by) {
        HeldState x = from;
        x.forces.across += scale[0] * by[0], x.forces.along += scale[1] * by[1];
        number<third>(x) += scale[2] * by[2];
        return x;
    }
    /// Returns the gradients of the end's offset and of its rise minus the span, by scaled numbers.
    template <Third third>
    std::array<Triple, 2> gradients(const HeldEnd<double>& end, const Triple& scale) const {
        Triple y(end.offset_change.data()), z(end.rise_change.data());
        if constexpr (third == Third::span) y[2] = 0, z[2] = -1;
        return {y.cwiseProduct(scale), z.cwiseProduct(scale)};
    }

    template <Third third>
    Triple along_curve(const HeldEnd<double>& end, const Triple& scale) const {
        const auto [over_y, over_z] = gradients<third>(end, scale);
        return cross(over_y.normalized(), over_z.normalized()).normalized();
    }

    template <Third third, class Visit>
    void step_along(HeldState state, bool up, Visit&& visit, double max_step = 0.3) {
        double step = 0.05;
        HeldEnd<double> end = (*shooter_)(state.forces, true);
        if (!end.known) return;
        Triple last{0, 0, up ? 1.0 : -1.0}, scale = scales<third>(state);
        for (int count = 0; count < max_steps; ++count) {
            Triple tangent = along_curve<third>(end, scale);
            if (!(tangent.norm() > 0.5)) return;
            if (tangent.dot(last) < 0) tangent = -tangent;
            HeldState next;
            HeldEnd<double> there;
            const auto attempt = [&](double reach) -> std::optional<double> {
                int rounds = 0;
                if (!correct<third>(state, scale, tangent, reach, next, there, rounds)) return {};
                // A curve that turns by more than 26 degrees may be another one. (Both ways along
                // it are taken: where two curves cross, the products change sign.)
                if (!(std::abs(along_curve<third>(there, scale).dot(tangent)) > 0.9)) return {};
                return rounds <= 3 ? 1.7 : rounds > 5 ? 0.6 : 1.0;
            };
            if (!detail::arc_step(step, max_step, 0.4, attempt)) return;
            (*shooter_)(next.forces, true);
            if (!visit(next)) return;
            const Triple before = scale;
            state = next, end = there, scale = scales<third>(state);
            last = tangent.cwiseProduct(before).cwiseQuotient(scale);
        }
    }

    /// Returns to the curve by Newton's method in the plane across the tangent; false on failure.
    template <Third third>
    bool correct(const HeldState& from, const Triple& scale, const Triple& tangent, double step,
                 HeldState& x, HeldEnd<double>& end, int& rounds) {
        Triple at = tangent * step;
        double last = 1;
        for (rounds = 0; rounds < 8; ++rounds) {
            x = moved<third>(from, scale, at);
            if (has_image(from) && x.forces.across * from.forces.across <= 0) return false;
            if (x.forces.height < 0 || x.forces.part < 0 || x.span >= length_) return false;
            end = (*shooter_)(x.forces, false);
            if (!end.known) return false;
            const auto [over_y, over_z] = gradients<third>(end, scale);
            // three equations: the end's two gaps and the plane
            const double y = end.offset, z = end.rise - x.span, p = tangent.dot(at) - step;
            const Triple a = cross(over_z, tangent), b = cross(tangent, over_y),
                         c = cross(over_y, over_z);
            const Triple change = -(y * a + z * b + p * c) / over_y.dot(a);
            const double size = change.norm();
            if (!(size < 2 * step + 1e-9)) return false;
            if (rounds > 0 && size > 0.9 * last && size > 1e-9) return false;
            at += change;
            if (size < 1e-8) {
                x = moved<third>(from, scale, at);
                end = (*shooter_)(x.forces, false);
                return end.known;
            }
            last = size;
        }
        return false;
    }

    /// Returns the state at a value of the third number; none if the curve does not lead there.
    template <Third third>
    std::optional<HeldState> follow(const HeldState& from, double wanted) {
        const auto off = [&](const HeldState& x) { return number<third>(x) - wanted; };
        const double start = off(from);
        if (start == 0) return corrected(from);
        std::optional<HeldState> result;
        HeldState before = from;
        step_along<third>(from, start < 0, [&](const HeldState& x) {
            const double here = off(x);
            if (here * start > 0) {
                before = x;
                return true;
            }
            HeldState guess = mixed(before, x, off(before) / (off(before) - here));
            number<third>(guess) = wanted;
            result = corrected(guess);
            return false;
        });
        return result;
    }

    Shooter* shooter_;
    double length_, weight_;
    bool symmetric_;
};

/// Visits the states of a height whose tension at the upper end times height is `wanted`, on the
/// branch through the first of a few spans that has a state.
template <class System, class Visit>
void each_under(System& held, int half_waves, double height, double wanted, const Visit& visit) {
    for (const double share : {0.9, 0.5, 0.99, 0.1})
        if (const auto state =
                held.at_height(half_waves, held.length() * typename System::S(share), height))
            return held.curve().under(*state, wanted, visit);
}

/// Error bounds of at least this mean that the cord hangs folded along the axis.
inline constexpr double folded = 1e-3;

/// Collects shapes of 1 ... `most` half waves. `find(k, add)` calls `add` with each shape.
template <class Shapes, class Find>
Shapes each_half_wave(int most, const Find& find) {
    Shapes result;
    for (int k = 1; k <= most; ++k) {
        const std::size_t before = result.shapes.size();
        find(k, [&](auto&& shape) {
            if (shape && shape->error_bound < folded) result.shapes.push_back(std::move(*shape));
        });
        if (result.shapes.size() == before) result.missing.push_back(k);
    }
    return result;
}

}  // namespace revchain::finite
