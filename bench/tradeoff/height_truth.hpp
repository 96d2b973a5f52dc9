// SPDX-License-Identifier: MPL-2.0
// What heights of small amplitude are measured against: no model, no matrix, nothing of the library but the chain's stored
// numbers. From the free end up, offset y of a link's lower pin and force F from below; with 1/mu the height sought, W, a,
// h, rho of the link, S the weight below it and k = (W h + a S)/a^2, its upper pin lies y + d from the axis,
//
//     d = (F - mu W (h/a) y)/(k + mu W ((h/a)(1 - h/a) - (rho/a)^2)),      F' = F - mu W (y + (1 - h/a) d).
//
// y = 0 at the support for the heights, and the sign changes of y along the chain are as many as there are heights above
// 1/mu: for denominators that are positive, as those of plummets and straight rods are. No number is subtracted from one
// near it, so that N links cost N roundings. In quadruple precision: 1e-34 N and what follows.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>

#include "support/truth.hpp"

namespace bench {

template <class S>
S exactly(const revchain::DoubleWord<double>& x) {
    return S(x.high) + S(x.low);
}

inline support::Quad in_quad(const support::Quad& x) { return x; }
inline support::Quad in_quad(const revchain::DoubleWord<double>& x) { return support::quad(x); }

template <class S>
class HeightTruth {
   public:
    explicit HeightTruth(const revchain::Chain<double>& chain) {
        links_.reserve(static_cast<std::size_t>(chain.size()));
        S below(0.0);
        for (revchain::Index m = 0; m < chain.size(); ++m) {
            const auto link = chain.link(m);
            const S W(link.weight), a(link.length), share = S(link.centroid) / a;
            links_.push_back(
                {W, share, (W * share + below) / a, W * (share * (S(1.0) - share) - exactly<S>(link.gyration_ratio))});
            below = below + W;
        }
    }

    /// Height number j (from 0, descending) near `guess`: between two counts, then twice the secant.
    support::Quad height(std::size_t j, double guess) const {
        const S centre = S(1.0) / S(guess);
        S low(0.0), high(0.0);
        std::array<End, 2> at;
        for (double reach = 0x1p-50;; reach *= 16) {
            if (reach > 0.5) throw std::runtime_error("no height lies there");
            low = centre * S(1 - reach), high = centre * S(1 + reach);
            at = evaluate<2>({low, high});
            if (at[0].below == j && at[1].below == j + 1) break;
        }
        S root = secant(low, high, at);
        const S reach(1e-24);
        low = root - root * reach, high = root + root * reach;
        return in_quad(S(1.0) / secant(low, high, evaluate<2>({low, high})));
    }

   private:
    struct Link {
        S weight, share, stiffness, coupling;
    };
    struct End {
        S y{};
        std::size_t below = 0;
    };

    static S secant(const S& low, const S& high, const std::array<End, 2>& at) {
        return low + (high - low) * (at[0].y / (at[0].y - at[1].y));
    }

    template <std::size_t L>
    std::array<End, L> evaluate(const std::array<S, L>& mu) const {
        std::array<End, L> at;
        std::array<S, L> force;
        at.fill({S(1.0), 0}), force.fill(S(0.0));
        for (const Link& link : links_)
            for (std::size_t i = 0; i < L; ++i) {
                const S inertia = mu[i] * link.weight, y = at[i].y;
                const S d = (force[i] - inertia * link.share * y) / (link.stiffness + mu[i] * link.coupling);
                force[i] = force[i] - inertia * (y + (S(1.0) - link.share) * d);
                at[i].y = y + d;
                at[i].below += (y < S(0.0)) != (at[i].y < S(0.0)) ? 1 : 0;
            }
        return at;
    }

    std::vector<Link> links_;
};

}  // namespace bench
