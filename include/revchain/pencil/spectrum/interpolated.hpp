// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numeric>

#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/proved_roots.hpp"
#include "revchain/pencil/spectrum/refinement.hpp"
#include "revchain/pencil/spectrum/window.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace spectrum {

struct Candidate {
    double shift = 0;           ///< the shift mu of the vector
    ProvedRoot<double> root{};  ///< the Rayleigh quotient and its rounding error
    /// The relative distance from the quotient within which an eigenvalue lies.
    double residual = std::numeric_limits<double>::infinity();
    double rounding = 0;    ///< the part of `residual` due to rounding
    std::size_t place = 0;  ///< links below the mode's largest offsets
};

/// Returns the relative rounding error of a Rayleigh quotient: plain sums of 16 links, 1 or 2 terms
/// each.
inline double rounding_quotient(const LumpedChain& chain, double mu) {
    const double skewed =
        std::min(chain.skew_against_turn, std::sqrt(mu) * chain.skew_against_stiffness);
    const double terms = static_cast<double>(longest_leg) * (chain.has_cross ? 3 : 2) + 24;
    return (epsilon<double>() / 2 + chain.data_error) * (terms + 8 * skewed);
}

/// Computes vectors and quotients at the candidates' shifts. Walks join at multiples of `longest`.
inline void evaluate(const LumpedChain& chain, std::vector<Candidate>& all,
                     const std::vector<std::size_t>& which, bool placed, std::size_t longest) {
    std::vector<double> shifts;
    std::vector<std::size_t> places;
    for (const std::size_t i : which) {
        shifts.push_back(all[i].shift);
        if (placed) places.push_back(all[i].place);
    }
    const auto quotients = quotients_all(chain, shifts, places, longest);
    for (std::size_t j = 0; j < which.size(); ++j) {
        Candidate& c = all[which[j]];
        const Quotient& q = quotients[j];
        if (!(q.ratio > 0.5 && q.ratio < 2)) continue;  // false for a NaN: the vector is useless
        const double value = q.ratio / c.shift;
        c.root = {DoubleWord<double>(value), rounding_quotient(chain, c.shift) * value};
        // The residual is least at the quotient; 2^-40 covers its rounding and the change of scale.
        c.residual = q.residual / std::min(q.ratio, 1.0) * (1 + 0x1p-40);
        if (std::isnan(c.residual)) c.residual = std::numeric_limits<double>::infinity();
        c.rounding = q.rounding;
        c.place = q.twist;
    }
}

/// Refines the found quotients to twice the digits; walks join at pins that `longest` divides.
inline void refine(const LumpedChain& chain, std::vector<Candidate>& all,
                   const std::vector<std::size_t>& which, bool placed, std::size_t longest) {
    std::vector<double> shifts;
    std::vector<std::size_t> places;
    for (const std::size_t i : which) {
        shifts.push_back(1 / all[i].root.root.high);
        if (placed) places.push_back(all[i].place);
    }
    const auto quotients = fine_quotients_all(chain, shifts, places, longest);
    for (std::size_t j = 0; j < which.size(); ++j) {
        Candidate& c = all[which[j]];
        const FineQuotient& q = quotients[j];
        if (!(std::abs(q.excess) < 0x1p-10 && q.residual < 0x1p-10)) continue;
        // 1/mu = high (1 + left), up to squares of roundings
        const double shift = shifts[j], high = 1 / shift;
        const DoubleWord<double> product = two_product(high, shift);
        const double left = (1 - product.high) - product.low;
        c.shift = shift;
        c.root.root = fast_two_sum(high, high * (left + q.excess));
        c.root.off = q.error * (1 + 0x1p-30) * c.root.root.high;
        c.residual = q.residual / std::min(1 + q.excess, 1.0) * (1 + 0x1p-40);
        c.place = q.twist;
    }
}

/// The tolerance below which quotients in double are not accurate enough.
inline constexpr double loosest_fine = 40 * 0x1p-52;

/// Proves eigenvalues number `first` ... `last - 1` of `total`, and all others in their windows.
template <Real S>
class Candidates {
   public:
    Candidates(const ElementPencil<S>& wide, const LumpedChain& chain, double tolerance)
        : wide_(wide),
          pencil_(rounded<double>(wide)),
          chain_(chain),
          fine_(tolerance < loosest_fine),
          worst_(std::min(tolerance, 0x1p-32) * (1 - 0x1p-20) - epsilon<double>() / 2),
          leg_(std::bit_floor(std::clamp(chain.size() / 8, std::size_t(1), longest_leg))) {}

    /// Returns eigenvalues by windows and quotients, or nothing if these prove too little.
    std::optional<std::vector<Certified<double>>> solve(Index first, Index last, Index total) {
        if (!chain_.fit || chain_.size() < 2 || !separate(first, last, total)) return std::nullopt;
        improve();
        refine_roots();
        return proved(first, last);
    }

    std::vector<Certified<double>> counted(Index first, Index last, double guess) const {
        std::vector<Certified<double>> result;
        const double width = 2 * epsilon<double>();
        for (const auto& bracket : bisect(pencil_, first, last - first, width, guess)) {
            const Index j = first + static_cast<Index>(result.size());
            const double start = between(bracket.lower, bracket.upper);
            result.push_back(certified_eigenvalue(wide_, pencil_, j, start));
        }
        return result;
    }

   private:
    /// Sets the first shifts. Proved counts at both ends show that there are as many eigenvalues.
    bool separate(Index first, Index last, Index total) {
        std::vector<Window> found;
        if (!isolate_eigenvalues(chain_, first, last, found, all_)) return false;
        begin_ = found.front().first;
        const Index end = found.back().last;
        const auto is_proved = [&](double mu, Index above) {
            const auto count = certified_count<S, 1>(wide_, {S(1.0) / S(mu)});
            return count[0].proved && count[0].above == above;
        };
        if (begin_ > 0 && !is_proved(found.front().lower, begin_)) return false;
        if (end < total && !is_proved(found.back().upper, end)) return false;
        if (begin_ > 0) top_ = 1 / found.front().lower * (1 - 0x1p-50);
        if (end < total) bottom_ = 1 / found.back().upper * (1 + 0x1p-50);
        for (Candidate& c : all_) {
            starts_.push_back(c.shift);
            c.root.root = DoubleWord<double>(1 / c.shift);
        }
        return true;
    }

    /// Repeats quotients until their error, the square of the vector's, is below rounding.
    void improve() {
        std::vector<std::size_t> which(all_.size()), astray;
        std::iota(which.begin(), which.end(), std::size_t(0));
        for (int round = 0; round < 4 && !(which.empty() && astray.empty()); ++round) {
            evaluate(chain_, all_, which, true, leg_);
            evaluate(chain_, all_, astray, false, chain_.size() < 4096 ? 1 : leg_);
            which.insert(which.end(), astray.begin(), astray.end());
            astray.clear();
            std::vector<std::size_t> again;
            for (const std::size_t i : which) {
                Candidate& c = all_[i];
                if (!(c.rounding < 0x1p-10)) continue;  // double cannot improve it
                const double next = 1 / c.root.root.high, apart = room(i);
                const bool rough = c.residual > 4 * c.rounding;
                if (!rough || c.residual * c.residual < 0x1p-57 * apart / starts_[i]) continue;
                // Continue at the quotient, unless a vector joined at a bad pin gave a wrong one.
                const bool near =
                    std::isfinite(c.residual) && std::abs(next - starts_[i]) < 0.4 * apart;
                c.shift = near ? next : starts_[i];
                (near && (round > 0 || c.residual * starts_[i] < 0.01 * apart) ? again : astray)
                    .push_back(i);
            }
            which = std::move(again);
        }
    }

    /// Refines once, and again where the vector's error is still relevant: at the better shift or,
    /// if that was wrong, at the first shift, joined at any pin near the mode, at last at any pin.
    void refine_roots() {
        for (int round = 0; round < 3; ++round) {
            // These are the bounds of `proved` if counts between intervals are as expected.
            const double infinity = std::numeric_limits<double>::infinity();
            const auto predicted = roots_between(-infinity, infinity, [&](double x) {
                const auto below = std::lower_bound(starts_.begin(), starts_.end(), 1 / x);
                return CertifiedCount{begin_ + (below - starts_.begin()), true};
            });
            std::vector<std::size_t> some;
            for (std::size_t i = 0; i < all_.size(); ++i) {
                Candidate& c = all_[i];
                const double value = c.root.root.high;
                const double off = predicted ? (*predicted)[i].off : infinity;
                const double ulp = epsilon<double>() * value;
                const bool done = std::isfinite(off) && c.root.off <= 64 * ulp;
                if (done && (!fine_ || (round > 0 && off < 0.01 * ulp))) continue;
                if (!(std::abs(1 / value - starts_[i]) < 0.4 * room(i))) {
                    if (round == 0) continue;
                    c.root.root = DoubleWord<double>(1 / starts_[i]);
                    c.residual = infinity;  // nothing is proved for this root
                }
                some.push_back(i);
            }
            refine(chain_, all_, some, round < 2,
                   round == 1 || (round == 2 && chain_.size() < 4096) ? 1 : leg_);
        }
    }

    /// Returns the candidates' roots with the bounds of `prove`.
    template <class Count>
    std::optional<std::vector<ProvedRoot<double>>> roots_between(double below, double above,
                                                                 const Count& count) const {
        std::vector<ProvedRoot<double>> roots;
        std::vector<double> reach;
        for (const Candidate& c : all_) {
            roots.push_back(c.root);
            reach.push_back(std::min(c.residual, 0x1p500) * c.root.root.high);
        }
        if (!prove(roots, reach, begin_, below, above, worst_, count)) return std::nullopt;
        return roots;
    }

    /// Proves the roots, by counts where vectors are useless or intervals meet others.
    std::optional<std::vector<Certified<double>>> proved(Index first, Index last) {
        std::vector<std::optional<Certified<double>>> sure(all_.size());
        for (std::size_t i = 0; i < all_.size(); ++i) {
            Candidate& c = all_[i];
            if (std::isfinite(c.residual)) continue;
            const Index j = begin_ + static_cast<Index>(i);
            sure[i] = counted(j, j + 1, c.root.root.high).front();
            const double bound = sure[i]->error_bound;  // relative to the exact eigenvalue
            c.root = {sure[i]->unrounded,
                      bound < 1 ? bound / (1 - bound) * sure[i]->eigenvalue : bound};
            c.residual = 0;
        }
        const auto roots = roots_between(
            bottom_, top_, [&](double x) { return certified_count<S, 1>(wide_, {S(x)})[0]; });
        if (!roots) return std::nullopt;
        std::vector<Certified<double>> result;
        for (Index j = first; j < last; ++j) {
            const auto i = static_cast<std::size_t>(j - begin_);
            const ProvedRoot<double>& found = (*roots)[i];
            const double rounded = fine_ || found.root.low != 0 ? epsilon<double>() / 2 : 0.0;
            if (std::isfinite(found.off))
                result.push_back({found.root.high, found.bound(rounded), found.root});
            else
                result.push_back(sure[i] ? *sure[i] : counted(j, j + 1, found.root.high).front());
        }
        return result;
    }

    double room(std::size_t i) const {
        const double below = i > 0 ? starts_[i] - starts_[i - 1] : starts_[i];
        const double above = i + 1 < starts_.size() ? starts_[i + 1] - starts_[i] : starts_[i];
        return std::min(below, above);
    }

    const ElementPencil<S>& wide_;
    ElementPencil<double> pencil_;
    const LumpedChain& chain_;
    bool fine_;
    double worst_;  // largest relative error of a root before rounding
    std::size_t leg_;
    Index begin_ = 0;  // number of all_.front()
    std::vector<Candidate> all_;
    std::vector<double> starts_;                                         // first shifts
    double top_ = std::numeric_limits<double>::infinity(), bottom_ = 0;  // ends of the windows
};

}  // namespace spectrum

/// Returns the eigenvalues number `first` ... `last - 1` (descending, from 0) of a pencil with
/// `total` positive eigenvalues. Each has a bound proved by theorems and counts
/// (docs/theory/spectrum.md), at most `tolerance` (2 ulp or more) or the least that two words can
/// prove. Use it for several eigenvalues of a dozen links or more.
///
/// Method: counts give windows of up to 48 eigenvalues. The characteristic polynomial, without
/// division, is computed at 2.7 shifts per eigenvalue or more, and its Chebyshev interpolant gives
/// the zeros. Bounds follow from the Rayleigh quotient of a twisted vector at each zero, its
/// residual and those of its neighbours, one shift in a SIMD lane. Clusters and negative cross
/// masses are solved by bisection and counts in two words. Accuracy, measured: with a tolerance
/// below 40 ulp the nearest double, bound 0.51 ulp, unrounded mostly 1e-20 (2e-18 proved).
/// Otherwise within 4 ulp for the chains of the tests (N up to 10,000, there a sample of the
/// modes), and random compound pendulums up to 45 ulp with a tolerance of 1e-11, 6 with 128 ulp.
/// Proved: 28 ulp plummets, 36 rods, more where neighbours nearly coincide. Cost: bench_engines.
/// Preconditions: 0 <= first, last <= total <= size.
template <Real S>
std::vector<Certified<double>> all_eigenvalues(const ElementPencil<S>& wide,
                                               const spectrum::LumpedChain& chain, Index first,
                                               Index last, Index total, double tolerance) {
    if (first >= last) return {};
    spectrum::Candidates<S> candidates(wide, chain, tolerance);
    if (auto found = candidates.solve(first, last, total)) return *found;
    return candidates.counted(first, last, 1.0);
}

template <Real S>
std::vector<Certified<double>> all_eigenvalues(const ElementPencil<S>& wide, Index first,
                                               Index last, Index total, double tolerance) {
    return all_eigenvalues(wide, spectrum::lumped(wide), first, last, total, tolerance);
}

}  // namespace revchain::pencil
