// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/proof.hpp"
#include "revchain/finite/held/shape.hpp"
#include "revchain/finite/held/taut.hpp"

namespace revchain {

/// Shapes of a chain held at both ends, one at the most for each number of half waves.
struct HeldShapes {
    std::vector<HeldShape> shapes;  ///< by the half waves of the branch they were found on
    std::vector<int> missing;       ///< half waves whose branch does not reach the span and height asked
    bool complete = false;          ///< never claimed: there may be others, on branches that are apart
};

namespace finite {

/// Shapes of one chain held at both ends, one after the other.
class HeldChain {
   public:
    using S = Wide<double>;

    explicit HeldChain(const Chain<double>& chain) : wide_(links_of(chain)), links_(rounded<double>(wide_.links)) {
        for (const Link<S>& link : wide_.links)
            length_ = length_ + link.length, weight_ = weight_ + link.moment + link.rest;
        straighten();
    }
    HeldChain(const HeldChain&) = delete;
    HeldChain& operator=(const HeldChain&) = delete;

    const Links<S>& links() const { return wide_; }
    const S& length() const { return length_; }

    /// The end's place for forces, each link from where it was in the state kept last.
    HeldEnd<double> operator()(const HeldForces<double>& forces, bool keep) {
        trial_ = kept_;
        const HeldEnd<double> end = held_sweep(links_, forces, trial_);
        if (end.known && keep) kept_ = trial_;
        return end;
    }

    /// Directions in the state kept last.
    const std::vector<Direction<double>>& kept() const { return kept_; }
    void keep(std::vector<Direction<double>> directions) { kept_ = std::move(directions); }

    HeldCurve<HeldChain> curve() { return {*this, static_cast<double>(length_), static_cast<double>(weight_)}; }

    /// The state with `half_waves` half waves, see `HeldCurve::from_straight`.
    std::optional<HeldState> at_height(int half_waves, const S& span, double height) {
        if (half_waves >= static_cast<Index>(links_.size())) return {};
        const double along = taut_number([&](double x) { return taut_count(links_, 0.0, x); }, half_waves - 1,
                                         static_cast<double>(weight_ * length_));
        if (along == 0) return {};
        const std::vector<double> y = taut_shape(links_, 0.0, along);
        double short_of = 0;  // by how much the shape of unit pull is shorter than the chain
        for (std::size_t m = 0; m < links_.size(); ++m)
            short_of += (y[m] - y[m + 1]) * (y[m] - y[m + 1]) / (2 * links_[m].length);
        straighten();
        return curve().from_straight(static_cast<double>(length_ - span), static_cast<double>(span), height,
                                     [&](double slack) {
                                         return HeldForces<double>{-std::sqrt(slack / short_of), along, 0};
                                     });
    }

    /// Newton's method in double-double at span and height, from a state in double; the shape there.
    std::optional<HeldShape> finished(const HeldState& state, const S& span, const S& height, bool prove) const {
        HeldForces<S> forces{S(state.forces.across), S(state.forces.along), height};
        std::vector<Direction<S>> direction;
        for (const Direction<double>& d : kept_) {  // of unit length, to double-double
            const S sine(d.sine), cosine(d.cosine), size = sqrt(sine * sine + cosine * cosine);
            direction.push_back({sine / size, cosine / size});
        }
        double last = std::numeric_limits<double>::infinity();
        for (int round = 0; round < 30; ++round) {
            const HeldEnd<S> end = held_sweep(wide_.links, forces, direction);
            if (!end.known) return {};
            const auto [across, along] = end.forces_to_move(-end.offset, span - end.rise);
            forces.across = forces.across + across, forces.along = forces.along + along;
            const double size = std::abs(static_cast<double>(across / forces.across)) +
                                std::abs(static_cast<double>(along / forces.across));
            if (!(size < 1)) return {};
            if (size < 1e-29 || (size < 1e-18 && size > 0.25 * last)) break;
            if (round == 29) return {};
            last = size;
        }
        HeldShape shape = described(wide_, forces, span, direction);
        if (prove) {
            std::vector<Direction<Far>> found;
            for (const Direction<S>& d : direction) found.push_back({Far(d.sine), Far(d.cosine)});
            const double error = held_error(enclosed<Far>(wide_.links), enclosed<Far>(height), enclosed<Far>(span),
                                            {Far(forces.across), Far(forces.along)}, found);
            shape.proved = error < 1e-3;
            // and an inclination rounded once
            if (shape.proved) shape.error_bound = error + 1.001 * 0x1p-53 * shape.inclination.cwiseAbs().maxCoeff();
        }
        return shape;
    }

   private:
    void straighten() { kept_.assign(links_.size(), {0.0, 1.0}); }

    Links<S> wide_;
    std::vector<Link<double>> links_;
    S length_{0}, weight_{0};
    std::vector<Direction<double>> kept_, trial_;
};

/// The shape of each number of half waves up to `max_half_waves` at a span and a height; height 0: without gravity.
inline HeldShapes held_shapes(const Chain<double>& chain, double span, const Wide<double>& height, int max_half_waves,
                              bool prove) {
    HeldChain held(chain);
    const int exponent = held.links().units.length_exponent;
    const Wide<double> apart(std::ldexp(span, -exponent)), lambda = ldexp(height, -exponent);
    return each_half_wave<HeldShapes>(max_half_waves, [&](int k, const auto& add) {
        if (const auto state = held.at_height(k, apart, static_cast<double>(lambda)))
            add(held.finished(*state, apart, lambda, prove));
    });
}

/// All shapes on the branch of each number of half waves whose tension at the upper end, times the height, is
/// `height_times_tension`.
inline HeldShapes held_shapes_under_tension(const Chain<double>& chain, double height_times_tension,
                                            double conical_height, int max_half_waves, bool prove) {
    using S = Wide<double>;
    HeldChain held(chain);
    const ChainUnits units = held.links().units;
    const double wanted = std::ldexp(height_times_tension, -units.length_exponent - units.weight_exponent),
                 lambda = std::ldexp(conical_height, -units.length_exponent);
    return each_half_wave<HeldShapes>(max_half_waves, [&](int k, const auto& add) {
        each_under(held, k, lambda, wanted,
                   [&](const HeldState& found) { add(held.finished(found, S(found.span), S(lambda), prove)); });
    });
}

}  // namespace finite
}  // namespace revchain
