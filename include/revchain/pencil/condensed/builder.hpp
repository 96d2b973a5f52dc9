// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "revchain/pencil/condensed/pencil.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A run of links condensed so far: its transfer in T, and the three most important numbers also in
/// `Wide<T>`. It includes the errors of all roundings and truncations (docs/theory/blocks.md).
template <Real T>
struct CondensedRun {
    using S = Wide<T>;
    Transfer<T, Block<T>::degree> transfer;
    S weight{}, flexibility{}, moment{};  ///< c0, b1, a1
    Index links = 0;
    T stiffness_error{}, mass_error{};  ///< relative, of its spring and of its masses
    S cross{};                          ///< for a link left alone: see Block
    bool alone = false;                 ///< true if it must not be merged
};

/// Merges the runs of a chain, lowest first, into blocks valid for every lambda >= `least_shift`.
template <Real T>
class CondensedPencilBuilder {
   public:
    using Run = CondensedRun<T>;
    using S = Wide<T>;
    static constexpr std::size_t degree = Block<T>::degree;

    explicit CondensedPencilBuilder(const T& least_shift)
        : least_shift_(least_shift), mu_(T(1) / least_shift) {}

    const T& least_shift() const { return least_shift_; }

    /// Returns mu (mass) / (stiffness), which is about the square of a mode's phase across the run.
    T phase(const Run& run) const {
        return mu_ * static_cast<T>(run.weight) * static_cast<T>(run.flexibility);
    }

    /// Returns true if degree 6 omits less than rounding (7th term: 2/14! phase^6) for any weights.
    bool is_short(const Run& run) const { return phase(run) <= T(0.075); }

    /// Returns true if the error of polynomials of `Kept` terms is negligible beside rounding.
    template <std::size_t Kept>
    bool is_complete(const Run& run) const {
        const Error cut = truncation<Kept>(run);
        return cut.stiffness + cut.mass <= epsilon<T>() / T(64);
    }

    /// Returns true if the noted errors are at most `ulp` ulp. `most_ulp` proves heights to 2 ulp.
    bool is_accurate(const Run& run, const T& ulp) const {
        return run.stiffness_error + run.mass_error <= ulp * epsilon<T>();
    }
    static constexpr T most_ulp = T(1.1);

    /// Adds to the errors of `run` the truncation error of polynomials of `Kept` terms.
    template <std::size_t Kept>
    void note_truncation(Run& run) const {
        const Error cut = truncation<Kept>(run);
        run.stiffness_error += cut.stiffness;
        run.mass_error += T(2) * cut.mass;  // all may be at the pin with less mass
    }

    /// The second coefficients of the series, times mu, relative to the first. They show how spring
    /// and masses depend on mu, and the force on two free pins, which merging turns into mass.
    struct SecondTerms {
        T spring{}, mass{}, force{};  ///< b2/b1, (a2 + d2)/(b1 c0), c1/c0: at most 1/4 of the phase
    };

    SecondTerms second_terms(const Run& run) const {
        const auto& t = run.transfer;
        const T by_flexibility = mu_ / static_cast<T>(run.flexibility),
                weight = static_cast<T>(run.weight);
        if (weight == T(0)) return {};
        return {by_flexibility * t.b[1], by_flexibility * (t.a[1] + t.d[1]) / weight,
                mu_ * t.c[1] / weight};
    }

    /// Adds the errors of `roundings` roundings in the coefficients beyond the first.
    void note_roundings(Run& run, const T& roundings, const SecondTerms& terms) const {
        const T each = roundings * epsilon<T>() / T(2) / (T(1) - terms.spring);
        run.stiffness_error += each * terms.spring;
        run.mass_error += T(2) * each * (terms.mass + terms.force);  // twice: see note_truncation
    }

    /// Adds the error of a mass moved from pin to pin by the relative `error` of a1; `square` is
    /// a1^2 / (b1 c0). With e its share of the mass, it changes the elastic energy by at most e
    /// sqrt(phase) of it, and the kinetic energy by at most twice that share.
    void note_moved_mass(Run& run, const T& error, const T& square) const {
        using std::sqrt;
        const T moved = error * sqrt(mu_ * square);
        run.stiffness_error += T(1.1) * moved;
        run.mass_error += T(2) * moved;
    }

    /// Adds the next run, and merges it with those below while the result is small enough.
    void add(const Run& run) {
        runs_.push_back(run);
        for (std::size_t top = runs_.size() - 1;
             top > 0 && runs_[top - 1].links <= runs_[top].links &&
             merge(runs_[top - 1], runs_[top]);
             --top)
            runs_.pop_back();
    }

    CondensedPencil<T> finish() const {
        CondensedPencil<T> pencil;
        pencil.least_shift = least_shift_;
        std::vector<Run> runs;  // `add` keeps neighbours separate if the lower one is longer
        for (const Run& run : runs_)
            if (runs.empty() || !merge(runs.back(), run)) runs.push_back(run);
        T stiffness_error(0), mass_error(0), evaluation(0), largest(0);
        pencil.blocks.reserve(runs.size());
        for (const Run& run : runs) {
            Block<T> block;
            block.stiffness = S(T(1)) / run.flexibility;
            block.lower = run.moment * block.stiffness;
            block.upper = run.weight - block.lower;
            block.cross = run.cross;
            block.links = run.links;
            const T f = static_cast<T>(run.flexibility);
            if (!run.alone) {
                for (std::size_t i = 0; i < degree; ++i) block.b[i] = run.transfer.b[i + 1] / f;
                for (std::size_t i = 0; i + 1 < degree; ++i) {
                    block.a[i] = run.transfer.a[i + 1] / f;
                    block.d[i] = run.transfer.d[i + 1] / f;
                }
                const SecondTerms terms = second_terms(run);
                if (terms.spring > T(0)) largest = std::max(largest, phase(run));
                // `element_at` makes seven roundings in its corrections
                evaluation =
                    std::max(evaluation, (terms.spring + terms.mass) * T(7) * epsilon<T>());
            }
            pencil.blocks.push_back(block);
            stiffness_error = std::max(stiffness_error, run.stiffness_error);
            mass_error = std::max(mass_error, run.mass_error);
        }
        pencil.error = (stiffness_error + mass_error + evaluation) / (T(1) - largest);
        return pencil;
    }

   private:
    struct Error {
        T stiffness{}, mass{};
    };

    /// Returns the sum of a series, log-concave coefficients, beyond its terms `before` and `last`.
    static T tail(const T& last, const T& before) {
        if (!(last > T(0))) return T(0);
        const T ratio = last / before;
        return ratio < T(0.5) ? T(1.1) * last * ratio / (T(1) - ratio)
                              : std::numeric_limits<T>::infinity();
    }

    template <std::size_t Kept>
    Error truncation(const Run& run) const {
        const auto& t = run.transfer;
        T power(1);  // mu^(Kept - 2)
        for (std::size_t i = 2; i < Kept; ++i) power *= mu_;
        const T flexibility = static_cast<T>(run.flexibility), weight = static_cast<T>(run.weight);
        const T moved = tail(t.a[Kept - 1] * power * mu_, t.a[Kept - 2] * power) +
                        tail(t.d[Kept - 1] * power * mu_, t.d[Kept - 2] * power);
        return {tail(t.b[Kept] * power * mu_ * mu_, t.b[Kept - 1] * power * mu_) / flexibility,
                weight == T(0) ? T(0) : moved / (flexibility * weight)};  // no term is omitted
    }

    /// Puts `upper` on top of `lower` and returns true, if the result is still small enough.
    bool merge(Run& lower, const Run& upper) const {
        if (lower.alone || upper.alone) return false;
        Run both;
        both.weight = lower.weight + upper.weight;
        both.flexibility = lower.flexibility + upper.flexibility;
        if (!is_short(both)) return false;
        both.moment = lower.moment + upper.moment + upper.flexibility * lower.weight;
        both.transfer = pencil::merged(lower.transfer, upper.transfer);
        both.transfer.a[0] = static_cast<T>(both.moment);
        both.transfer.b[0] = static_cast<T>(both.flexibility);
        both.transfer.c[0] = static_cast<T>(both.weight);
        if (!is_complete<degree>(both)) return false;
        both.links = lower.links + upper.links;
        both.stiffness_error = std::max(lower.stiffness_error, upper.stiffness_error);
        both.mass_error = std::max(lower.mass_error, upper.mass_error);
        note_truncation<degree>(both);
        note_roundings(both, T(5), second_terms(both));
        if (!is_accurate(both, most_ulp)) return false;
        lower = both;
        return true;
    }

    T least_shift_, mu_;
    std::vector<Run> runs_;
};

}  // namespace revchain::pencil
