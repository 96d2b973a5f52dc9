// SPDX-License-Identifier: MPL-2.0
// What errors are measured against. From the free end up, offset y and force F of every pin, with 1/k of each link
// known beforehand and the denominators k + mu X (positive) multiplied away:
//
//     y' = (1 - mu A/k) y - (mu/k) F,      F' = (1 - mu B/k) F + (W - mu C/k) y,       F = 0 at the free end;
//
// y = 0 at the support for the heights 1/mu, and the number of sign changes of y along the chain is the number of
// heights above 1/mu (plummets and uniform rods). In S: double words.
#pragma once

#include <array>
#include <cmath>

#include "revchain/numeric/double_word.hpp"
#include "worker/raw_chain.hpp"

namespace bench {

template <class S>
class Truth {
   public:
    explicit Truth(const RawChain& chain) : rods_(chain.rods), weight_(chain.weight) {
        flexibility_.reserve(weight_.size());
        S below(0.0);
        for (const double w : weight_) {
            const S half = S(w * 0.5);  // exact
            flexibility_.push_back(S(1.0) / (rods_ ? below + half : below + S(w)));
            below = below + S(w);
        }
    }

    /// Height number j (from 0, descending) near `guess`: a bracket that two counts prove, then the secant.
    S height(std::size_t j, double guess) const {
        S low(0.0), high(0.0);
        std::array<End, 2> at;
        const S centre = S(1.0) / S(guess);
        for (double reach = 1e-12;; reach *= 16) {
            low = centre / S(1 + reach), high = centre * S(1 + reach);
            at = evaluate<2>({low, high});
            if (at[0].below <= j && at[1].below > j) break;
            if (reach > 1e30) throw std::runtime_error("truth: no bracket");
        }
        while (at[0].below != j || at[1].below != j + 1 || wide(low, high)) {
            const S middle = high > low * S(4.0) ? sqrt_of(low, high) : (low + high) * S(0.5);
            const End e = evaluate<1>({middle})[0];
            (e.below <= j ? low : high) = middle;
            (e.below <= j ? at[0] : at[1]) = e;
            if (!(low < middle) && !(middle < high)) break;
        }
        return S(1.0) / secant(low, high, at);
    }

   private:
    struct End {
        S y{};
        int exponent = 0;       ///< y 2^exponent is the offset of the support
        std::size_t below = 0;  ///< heights above 1/mu
    };

    static bool wide(const S& low, const S& high) { return high - low > low * S(1e-10); }
    static S sqrt_of(const S& low, const S& high) {
        return S(std::sqrt(static_cast<double>(low)) * std::sqrt(static_cast<double>(high)));
    }
    static S secant(const S& low, const S& high, const std::array<End, 2>& at) {
        const S ratio = at[0].y / at[1].y * S(std::ldexp(1.0, at[0].exponent - at[1].exponent));  // negative
        return low + (high - low) * (ratio / (ratio - S(1.0)));
    }

    template <std::size_t L>
    std::array<End, L> evaluate(const std::array<S, L>& mu) const {
        std::array<End, L> at;
        std::array<S, L> force;
        at.fill({S(1.0), 0, 0});
        force.fill(S(0.0));
        const S third = S(1.0) / S(3.0);
        for (std::size_t m = 0; m < weight_.size(); ++m) {
            const S w(weight_[m]);
            for (std::size_t i = 0; i < L; ++i) {
                const S alpha = mu[i] * flexibility_[m];
                const S& y = at[i].y;
                const S& f = force[i];
                S y_next(0.0), f_next(0.0);
                if (rods_) {
                    const S part = alpha * w * third;
                    const S p = S(1.0) - part;
                    y_next = p * y - alpha * f;
                    f_next = p * f + (w - part * w * S(0.25)) * y;
                } else {
                    f_next = f + w * y;
                    y_next = y - alpha * f_next;
                }
                at[i].below += (y < S(0.0)) != (y_next < S(0.0)) ? 1 : 0;
                at[i].y = y_next;
                force[i] = f_next;
            }
            if (m % 4 == 3)
                for (std::size_t i = 0; i < L; ++i) rescale(at[i], force[i]);
        }
        return at;
    }

    static void rescale(End& end, S& force) {
        constexpr int step = 300;
        const double size = std::abs(static_cast<double>(end.y)) + std::abs(static_cast<double>(force));
        if (size < 0x1p300 && size > 0x1p-300) return;
        const int shift = size > 1 ? -step : step;
        const S factor(std::ldexp(1.0, shift));
        end.y = end.y * factor;
        force = force * factor;
        end.exponent -= shift;
    }

    bool rods_;
    std::vector<double> weight_;
    std::vector<S> flexibility_;
};

}  // namespace bench
