// SPDX-License-Identifier: MPL-2.0
// The honest strong baselines: what a good programmer writes by hand for the few slowest modes of plummets or uniform
// rods. y(mu), the offset of the support, is found by going once over all links for all modes at once, shifts in SIMD
// lanes; the one division per link is done beforehand, vectorised, and shared by all shifts. Starting values: WKB phase
// with the zeros of J0. Sign changes of y counted along the chain just below and above each result prove its number;
// whatever is not proved is bisected by the same counts.
//
// "direct Newton" carries y and dy/dmu; each of its passes squares the error; a last pass proves.
// "direct, two points" carries y alone, at two points that straddle the guess, in the variable log mu, in which y has
// almost no curvature at its zeros: the order is three, two or three passes do, and the last pair is itself the proof.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "worker/method.hpp"

namespace bench {

class Direct {
   public:
    explicit Direct(const RawChain& chain)
        : rods_(chain.rods), weight_(chain.weight.data()), size_(chain.size()), flexibility_(size_) {
        prepare();
    }

    /// The `count` slowest heights, descending, by Newton's iteration.
    void newton(std::size_t count, Heights& result) const {
        std::vector<Guess> guesses = starts(count);
        for (int pass = 0; pass < 12; ++pass)
            if (newton_step(guesses) < 1e-8) break;  // the square is below rounding
        straddle(guesses, 1e-11, true, false);       // rounding of y stays below it up to 1e7 links
        push(guesses, result);
    }

    /// The same by two points.
    void two_points(std::size_t count, Heights& result) const {
        std::vector<Guess> guesses = starts(count);
        // Random weights leave the start a relative 1/sqrt(N) or so in error.
        double reach = std::min(0.02, 0.5 / std::sqrt(static_cast<double>(size_)));
        for (int pass = 0; pass < 8; ++pass) {
            const bool last = reach < 1e-6;
            const double moved = straddle(guesses, reach, last, true);
            if (last && std::all_of(guesses.begin(), guesses.end(), [](const Guess& g) { return g.proved; })) break;
            reach = std::clamp(200 * moved * moved * moved, 2e-9, reach);
        }
        push(guesses, result);
    }

   private:
    // So many shifts at once as keep their state in registers: for 10 modes, 10 shifts with slopes or 20 without.
#if defined(__AVX512F__)
    static constexpr std::size_t width = 8, offset_vectors = 3, slope_vectors = 2;
#elif defined(__AVX__)
    static constexpr std::size_t width = 4, offset_vectors = 3, slope_vectors = 3;
#else
    static constexpr std::size_t width = 2, offset_vectors = 5, slope_vectors = 3;
#endif
    using Pack = double __attribute__((vector_size(width * sizeof(double))));
    using Mask = std::uint64_t __attribute__((vector_size(width * sizeof(double))));

    /// What is carried up the chain.
    template <std::size_t V>
    struct Lanes {
        std::array<Pack, V> mu, y, force, slope, force_slope;
        std::array<Mask, V> changes;
    };

    struct Guess {
        double log_mu = 0;
        bool proved = false;
    };
    enum class Pass { offsets, slopes, counts };
    struct Ends {
        std::vector<double> offset;
        std::vector<double> slope;         ///< dy/dmu; only where asked
        std::vector<std::uint64_t> below;  ///< heights above 1/mu; only where counted
    };

    /// 1/k of every link, and the WKB phase. Weights are added in trees of eight upon a compensated base.
    void prepare() {
        const double half = rods_ ? 0.5 : 0.0;
        double base = 0, rest = 0, phase = 0, root_before = 0;
        const std::size_t block = std::max<std::size_t>(8, size_ / 64 / 8 * 8);
        std::size_t m = 0, noted = 0;
        const auto note_phase = [&](std::size_t end) {
            // the uniform chain between two points: 2 (sqrt(S1) - sqrt(S0)) / sqrt(weight per length)
            const double root = std::sqrt(base);
            const double density = (root - root_before) * (root + root_before) / static_cast<double>(end - noted);
            phase += 2 * (root - root_before) / std::sqrt(density);
            root_before = root;
            noted = end;
        };
        for (; m + 8 <= size_; m += 8) {
            const double* w = weight_ + m;
            const double a = w[0] + w[1], b = w[2] + w[3], c = w[4] + w[5], d = w[6] + w[7], ab = a + b, cd = c + d;
            const std::array<double, 8> sum = {w[0], a, a + w[2], ab, ab + w[4], ab + c, (ab + c) + w[6], ab + cd};
            for (std::size_t i = 0; i < 8; ++i) flexibility_[m + i] = 1 / (base + (sum[i] - half * w[i]));
            const double t = sum[7] + rest, next = base + t;
            rest = t - (next - base);
            base = next;
            if ((m + 8) % block == 0) note_phase(m + 8);
        }
        for (; m < size_; ++m) {
            flexibility_[m] = 1 / (base + weight_[m] * (1 - half));
            base += weight_[m];
        }
        if (noted < size_) note_phase(size_);
        phase_ = phase;
    }

    /// log mu of mode k (from 0): the phase at the support is a zero of J0 (McMahon's expansion).
    double start(std::size_t k) const {
        const double b = (static_cast<double>(k) + 0.75) * std::numbers::pi, e = 1 / (8 * b);
        const double zero = b + e * (1 - e * e * (124.0 / 3 - e * e * 120928.0 / 15));
        return 2 * std::log(zero / phase_);
    }

    std::vector<Guess> starts(std::size_t count) const {
        std::vector<Guess> guesses(count);
        for (std::size_t k = 0; k < count; ++k) guesses[k].log_mu = start(k);
        return guesses;
    }

    void push(const std::vector<Guess>& guesses, Heights& result) const {
        for (std::size_t k = 0; k < guesses.size(); ++k)
            result.push_back(guesses[k].proved ? std::exp(-guesses[k].log_mu) : bisected(k));
    }

    /// Returns the largest relative step.
    double newton_step(std::vector<Guess>& guesses) const {
        std::vector<double> mu;
        for (const Guess& g : guesses) mu.push_back(std::exp(g.log_mu));
        const Ends at = evaluate<Pass::slopes>(mu);
        double moved = 0;
        for (std::size_t k = 0; k < guesses.size(); ++k) {
            const double step = at.offset[k] / (mu[k] * at.slope[k]);
            const double bounded = std::isfinite(step) ? std::clamp(step, -0.2, 0.2) : 0;
            guesses[k].log_mu = std::log(mu[k] * (1 - bounded));
            moved = std::max(moved, std::abs(bounded));
        }
        return moved;
    }

    /// One pass at both sides of every guess; returns the largest step. With `prove` also the numbers.
    double straddle(std::vector<Guess>& guesses, double reach, bool prove, bool move) const {
        std::vector<double> mu;
        for (const Guess& g : guesses)
            for (const double side : {-reach, reach}) mu.push_back(std::exp(g.log_mu + side));
        const Ends at = prove ? evaluate<Pass::counts>(mu) : evaluate<Pass::offsets>(mu);
        double moved = 0;
        for (std::size_t k = 0; k < guesses.size(); ++k) {
            const double low = at.offset[2 * k], high = at.offset[2 * k + 1];
            const double step = reach * (low + high) / (low - high);
            const double bounded = std::isfinite(step) ? std::clamp(step, -0.2, 0.2) : 0;
            if (move) guesses[k].log_mu += bounded;
            guesses[k].proved = prove && at.below[2 * k] == k && at.below[2 * k + 1] == k + 1;
            moved = std::max(moved, std::abs(bounded));
        }
        return moved;
    }

    double bisected(std::size_t k) const {
        double low = 0, high = 1;
        while (evaluate<Pass::counts>({high}).below[0] <= k) low = high, high *= 4;
        while (high - low > 4e-16 * high) {
            std::vector<double> mu;
            constexpr std::size_t lanes = width * offset_vectors;
            for (std::size_t i = 1; i <= lanes; ++i)
                mu.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(lanes + 1));
            const Ends at = evaluate<Pass::counts>(mu);
            const double before = high - low;
            std::size_t i = 0;
            while (i < lanes && at.below[i] <= k) low = mu[i++];
            if (i < lanes) high = mu[i];
            if (high - low >= before) break;
        }
        return 2 / (low + high);
    }

    template <Pass What>
    Ends evaluate(const std::vector<double>& mu) const {
        constexpr std::size_t vectors = What == Pass::slopes ? slope_vectors : offset_vectors;
        constexpr std::size_t lanes = width * vectors;
        Ends at{std::vector<double>(mu.size()), std::vector<double>(What == Pass::slopes ? mu.size() : 0),
                std::vector<std::uint64_t>(What == Pass::counts ? mu.size() : 0)};
        for (std::size_t first = 0; first < mu.size(); first += lanes) {
            Lanes<vectors> state;
            for (std::size_t i = 0; i < lanes; ++i)
                state.mu[i / width][i % width] = mu[std::min(first + i, mu.size() - 1)];
            rods_ ? over_links<What, true>(state) : over_links<What, false>(state);
            for (std::size_t i = 0; i < lanes && first + i < mu.size(); ++i) {
                at.offset[first + i] = state.y[i / width][i % width];
                if (What == Pass::slopes) at.slope[first + i] = state.slope[i / width][i % width];
                if (What == Pass::counts) at.below[first + i] = state.changes[i / width][i % width];
            }
        }
        return at;
    }

    /// The recursion of truth.hpp.
    template <Pass What, bool Rods, std::size_t V>
    void over_links(Lanes<V>& result) const {
        Lanes<V> s = result;  // in registers
        for (std::size_t v = 0; v < V; ++v) {
            s.y[v] = Pack{} + 1.0;
            s.force[v] = s.slope[v] = s.force_slope[v] = Pack{};
            s.changes[v] = Mask{};
        }
        const double* const weight = weight_;
        const double* const flexibility = flexibility_.data();
        for (std::size_t m = 0; m < size_; ++m) {
            const double w = weight[m], c = flexibility[m], wc = w * c * (1.0 / 3), wwc = wc * (w * 0.25);
            for (std::size_t v = 0; v < V; ++v) {
                const Pack alpha = c * s.mu[v];
                Pack next;
                if constexpr (Rods) {
                    const Pack p = 1.0 - wc * s.mu[v], q = w - wwc * s.mu[v];
                    next = p * s.y[v] - alpha * s.force[v];
                    if constexpr (What == Pass::slopes) {
                        const Pack slope = p * s.slope[v] - alpha * s.force_slope[v] - (wc * s.y[v] + c * s.force[v]);
                        s.force_slope[v] = p * s.force_slope[v] + q * s.slope[v] - (wc * s.force[v] + wwc * s.y[v]);
                        s.slope[v] = slope;
                    }
                    s.force[v] = p * s.force[v] + q * s.y[v];
                } else {
                    s.force[v] = s.force[v] + w * s.y[v];
                    next = s.y[v] - alpha * s.force[v];
                    if constexpr (What == Pass::slopes) {
                        s.force_slope[v] = s.force_slope[v] + w * s.slope[v];
                        s.slope[v] = s.slope[v] - c * s.force[v] - alpha * s.force_slope[v];
                    }
                }
                if constexpr (What == Pass::counts) s.changes[v] += (Mask(next) ^ Mask(s.y[v])) >> 63;
                s.y[v] = next;
            }
        }
        result = s;
    }

    bool rods_;
    const double* weight_;
    std::size_t size_;
    std::vector<double> flexibility_;
    double phase_ = 0;
};

inline void register_direct(Registry& registry) {
    const auto add = [&](const char* name, auto solve) {
        registry.methods.push_back({.name = name,
                                    .family = "baseline",
                                    .kinds = "ABCR",
                                    .largest = 10'000'000,
                                    .which = "few",
                                    .run = [solve](const RawChain& c, std::size_t count, double, Heights& heights) {
                                        solve(Direct(c), count, heights);
                                    }});
    };
    add("direct Newton", [](const Direct& d, std::size_t count, Heights& h) { d.newton(count, h); });
    add("direct, two points", [](const Direct& d, std::size_t count, Heights& h) { d.two_points(count, h); });
}

}  // namespace bench
