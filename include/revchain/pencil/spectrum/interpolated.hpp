// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numeric>

#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/spectrum/refinement.hpp"
#include "revchain/pencil/spectrum/window.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace spectrum {

/// An eigenvalue with what is known of it before its neighbours are.
struct Candidate {
    double shift = 0;                                           ///< mu the vector was computed at
    double eigenvalue = 0;                                      ///< Rayleigh quotient, rounded
    double rest = 0;                                            ///< and what rounding left
    double residual = std::numeric_limits<double>::infinity();  ///< some eigenvalue lies within this, relative
    double bound = std::numeric_limits<double>::infinity();     ///< proved, relative to the exact eigenvalue
    double rounding = 0;                                        ///< what rounding has in `residual`
    double error = std::numeric_limits<double>::infinity();     ///< of the quotient, besides the vector's, relative
    double reach = std::numeric_limits<double>::infinity();     ///< residual and rounding of the quotient
    std::size_t place = 0;                                      ///< links below where it lives
    bool counted = false;                                       ///< proved by counts, its number with it
};

/// What rounding adds to a Rayleigh quotient, relative: 16 links to a plain sum, one or two terms each.
inline double rounding_quotient(const LumpedChain& chain, double mu) {
    const double skewed = std::min(chain.skew_against_turn, std::sqrt(mu) * chain.skew_against_stiffness);
    const double terms = static_cast<double>(longest_leg) * (chain.has_cross ? 3 : 2) + 24;
    return (epsilon<double>() / 2 + chain.data_error) * (terms + 8 * skewed);
}

/// Vectors and quotients at the candidates' shifts; walks joined at a pin that `longest` divides.
inline void evaluate(const LumpedChain& chain, std::vector<Candidate>& all, const std::vector<std::size_t>& which,
                     bool placed, std::size_t longest) {
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
        if (!(q.ratio > 0.5 && q.ratio < 2)) continue;  // also a NaN: the vector says nothing of this shift
        c.eigenvalue = q.ratio / c.shift;
        // the residual is least at the quotient; 2^-40 covers its own rounding and the change of scale, |ratio - 1|
        c.residual = q.residual / std::min(q.ratio, 1.0) * (1 + 0x1p-40);
        if (!std::isfinite(c.residual))
            c.residual = std::numeric_limits<double>::infinity();  // no NaN among neighbours
        c.rounding = q.rounding;
        c.error = rounding_quotient(chain, c.shift);
        c.reach = c.residual * (1 + 0x1p-50) + 2 * c.error + 0x1p-50;
        c.place = q.twist;
    }
}

/// Refines the quotients found to twice the digits. Walks are joined at every pin that `longest` divides.
inline void refine(const LumpedChain& chain, std::vector<Candidate>& all, const std::vector<std::size_t>& which,
                   bool placed, std::size_t longest) {
    std::vector<double> shifts;
    std::vector<std::size_t> places;
    for (const std::size_t i : which) {
        shifts.push_back(1 / all[i].eigenvalue);
        if (placed) places.push_back(all[i].place);
    }
    const auto quotients = fine_quotients_all(chain, shifts, places, longest);
    for (std::size_t j = 0; j < which.size(); ++j) {
        Candidate& c = all[which[j]];
        const FineQuotient& q = quotients[j];
        if (!(std::abs(q.excess) < 0x1p-10 && q.residual < 0x1p-10)) continue;
        // 1/mu = high (1 + left) but for squares of roundings
        const double shift = shifts[j], high = 1 / shift;
        const DoubleWord<double> product = two_product(high, shift);
        const double left = (1 - product.high) - product.low;
        const DoubleWord<double> value = fast_two_sum(high, high * (left + q.excess));
        c.shift = shift;
        c.eigenvalue = value.high;
        c.rest = value.low;
        c.residual = q.residual / std::min(1 + q.excess, 1.0) * (1 + 0x1p-40);
        c.error = (epsilon<double>() / 2 + q.error) * (1 + 0x1p-30);
        c.reach = c.residual * (1 + 0x1p-50) + 2 * c.error + 0x1p-50;
        c.place = q.twist;
    }
}

/// Distance of a quotient, `of` one of two neighbours, to the interval of the other, relative to it. Negative where
/// that is not wholly on its own side: each interval below the one before leaves no place for two in one, or one in
/// two.
inline double gap(const Candidate& larger, const Candidate& smaller, const Candidate& of) {
    const Candidate& other = &of == &larger ? smaller : larger;
    return ((larger.eigenvalue - smaller.eigenvalue) - other.reach * other.eigenvalue) / of.eigenvalue;
}

/// Kato and Temple: |lambda - quotient| <= residual^2 / distance to the rest of the spectrum.
inline double temple(const Candidate& c, double distance) { return c.residual * c.residual / distance; }

/// An eigenvalue that counts have proved.
inline Candidate counted(const Certified<double>& sure) {
    Candidate c;
    c.shift = 1 / sure.eigenvalue;
    c.eigenvalue = sure.eigenvalue, c.rest = static_cast<double>(sure.unrounded - Wide<double>(sure.eigenvalue));
    c.residual = c.bound = sure.error_bound;
    c.reach = sure.error_bound * (1 + 0x1p-50) + 0x1p-50;
    c.counted = true;
    return c;
}

/// Below this tolerance quotients in double do not suffice.
inline constexpr double loosest_fine = 40 * 0x1p-52;

/// The candidates of some windows on their way to proved bounds: number `first` ... `last` - 1 of `total` eigenvalues,
/// and those that share their windows.
template <Real S>
class Candidates {
   public:
    Candidates(const ElementPencil<S>& wide, const LumpedChain& chain, double tolerance)
        : wide_(wide),
          pencil_(rounded<double>(wide)),
          chain_(chain),
          tolerance_(tolerance),
          leg_(std::bit_floor(std::clamp(chain.size() / 8, std::size_t(1), longest_leg))) {}

    /// Candidate number j (from 0, descending).
    const Candidate& operator[](Index j) const { return all_[static_cast<std::size_t>(j - begin_)]; }

    /// By windows and quotients; false where these prove too little.
    bool solve(Index first, Index last, Index total) {
        if (!chain_.fit || chain_.size() < 2 || !separate(first, last, total)) return false;
        improve();
        refine_bounds();
        return settle(first, last);
    }

    /// By counts alone.
    void count(Index first, Index last) {
        begin_ = first;
        all_.clear();
        for (const auto& bracket : bisect(pencil_, first, last - first, 2 * epsilon<double>(), 1.0))
            all_.push_back(proved(first + static_cast<Index>(all_.size()), bracket));
    }

   private:
    Candidate proved(Index j, const Bracket<double>& bracket) const {
        return counted(certified_eigenvalue(wide_, pencil_, j, between(bracket.lower, bracket.upper)));
    }

    /// First shifts. With the proved counts at both ends there are as many eigenvalues as candidates.
    bool separate(Index first, Index last, Index total) {
        std::vector<Window> found;
        if (!isolate(chain_, first, last, found, all_)) return false;
        begin_ = found.front().first;
        const Index end = found.back().last;
        const auto is_proved = [&](double mu, Index above) {
            const auto count = certified_count<S, 1>(wide_, {S(1.0) / S(mu)});
            return count[0].proved && count[0].above == above;
        };
        if (begin_ > 0 && !is_proved(found.front().lower, begin_)) return false;
        if (end < total && !is_proved(found.back().upper, end)) return false;
        if (begin_ > 0) top_ = 1 / found.front().lower;
        if (end < total) bottom_ = 1 / found.back().upper;
        for (const Candidate& c : all_) starts_.push_back(c.shift);
        return true;
    }

    /// Rounds of quotients until their error, the square of the vector's, is below rounding.
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
                if (!(c.rounding < 0x1p-10)) continue;  // double has no more to say
                const double next = 1 / c.eigenvalue, apart = room(i);
                const bool rough = c.residual > 4 * c.rounding;
                if (!rough || temple(c, 0.5 * apart / starts_[i]) < 0x1p-56) continue;
                // On to the quotient, unless a vector joined at a bad place led astray.
                const bool near = std::isfinite(c.residual) && std::abs(next - starts_[i]) < 0.4 * apart;
                c.shift = near ? next : starts_[i];
                (near && (round > 0 || c.residual * starts_[i] < 0.01 * apart) ? again : astray).push_back(i);
            }
            which = std::move(again);
        }
    }

    /// Once, and where that leaves the vector's error in sight again: at the better shift, or where that went astray
    /// at the first one, joined at any pin near where the mode seems to live, at last anywhere.
    void refine_bounds() {
        const bool fine = tolerance_ < loosest_fine;
        for (int round = 0; round < 3; ++round) {
            std::vector<std::size_t> some;
            for (std::size_t i = 0; i < all_.size(); ++i) {
                Candidate& c = all_[i];
                if (set_bound(i) && (!fine || (round > 0 && c.bound < 0.51 * epsilon<double>()))) continue;
                if (!(std::abs(1 / c.eigenvalue - starts_[i]) < 0.4 * room(i))) {
                    if (round == 0) continue;
                    c.eigenvalue = 1 / starts_[i];
                    c.residual = c.reach = std::numeric_limits<double>::infinity();  // of this nothing is known
                }
                some.push_back(i);
            }
            refine(chain_, all_, some, round < 2, round == 1 || (round == 2 && chain_.size() < 4096) ? 1 : leg_);
        }
    }

    /// What is not apart from its neighbours is left to counts, and what then is not apart from those.
    bool settle(Index first, Index last) {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < all_.size(); ++i) {
                Candidate& c = all_[i];
                if (c.counted || set_bound(i)) continue;
                const Index j = begin_ + static_cast<Index>(i);
                if ((j < first || j >= last) && distance(i) - c.reach > 0) continue;  // a neighbour only
                const double guess = std::isfinite(c.residual) ? c.eigenvalue : 1 / c.shift;
                c = proved(j, bisect(pencil_, j, Index(1), 2 * epsilon<double>(), guess).front());
                changed = true;
                if (!std::isfinite(c.bound)) return false;
            }
        }
        return true;
    }

    bool set_bound(std::size_t i) {
        Candidate& c = all_[i];
        const double apart = distance(i) - c.reach;
        const double b = apart > 0 ? temple(c, apart) + c.error : std::numeric_limits<double>::infinity();
        c.bound = b < 0.5 ? b / (1 - b) * (1 + 0x1p-30) : std::numeric_limits<double>::infinity();
        return c.bound <= tolerance_ && c.error <= 64 * epsilon<double>();
    }
    /// To the interval of the next candidate, or the end of the windows; NaN where a neighbour is not known.
    double distance(std::size_t i) const {
        const Candidate& c = all_[i];
        const double above = i > 0 ? gap(all_[i - 1], c, c) : (top_ * (1 - 0x1p-50) - c.eigenvalue) / c.eigenvalue;
        const double below =
            i + 1 < all_.size() ? gap(c, all_[i + 1], c) : (c.eigenvalue - bottom_ * (1 + 0x1p-50)) / c.eigenvalue;
        return std::isnan(above) ? above : std::min(below, above);
    }
    /// To the next start.
    double room(std::size_t i) const {
        const double below = i > 0 ? starts_[i] - starts_[i - 1] : starts_[i];
        const double above = i + 1 < starts_.size() ? starts_[i + 1] - starts_[i] : starts_[i];
        return std::min(below, above);
    }

    const ElementPencil<S>& wide_;
    ElementPencil<double> pencil_;
    const LumpedChain& chain_;
    double tolerance_;
    std::size_t leg_;
    Index begin_ = 0;  // number of all_.front()
    std::vector<Candidate> all_;
    std::vector<double> starts_;                                         // first shifts
    double top_ = std::numeric_limits<double>::infinity(), bottom_ = 0;  // ends of the windows
};

}  // namespace spectrum

/// All eigenvalues number `first` ... `last - 1` (descending, from 0) of a pencil with `total` positive ones, each with
/// a bound that is proved: as theorems and counts say (docs/theory/spectrum.md), no larger than `tolerance` (2
/// ulp or more) or what two words can prove. For several eigenvalues of a dozen links or more.
///
/// Method: windows of some 60 eigenvalues by counts; the characteristic polynomial, without division, at 2.4 shifts per
/// eigenvalue and its Chebyshev interpolant's zeros; at each the Rayleigh quotient of a twisted vector, its residual
/// and those of its neighbours. All in SIMD lanes, one shift to a lane. What cannot be proved this way (clusters,
/// negative cross masses) is left to bisection and counts in two words.
/// Accuracy as measured: with a tolerance below 40 ulp the nearest double, bound 0.51 ulp, unrounded mostly 1e-20
/// (2e-18 proved); else within 4 ulp for the chains of the tests (N up to 10,000, there a sample of the modes); random
/// compound pendulums up to 45 ulp with a tolerance of 1e-11, 6 with one of 128 ulp. Proved: 28 ulp plummets, 36 rods,
/// more where neighbours nearly coincide. Cost (AVX-512, N = 10,000): 0.85 ns per mode and link for equal plummets, 1.3
/// for random ones, 1.5 and 2.0 for rods, portable build (bench_all_modes); to the last digit 1.3 to 2 more.
/// Preconditions: 0 <= first, last <= total <= size.
template <Real S>
std::vector<Certified<double>> all_eigenvalues(const ElementPencil<S>& wide, const spectrum::LumpedChain& chain,
                                               Index first, Index last, Index total, double tolerance) {
    std::vector<Certified<double>> result;
    if (first >= last) return result;
    spectrum::Candidates<S> found(wide, chain, tolerance);
    if (!found.solve(first, last, total)) found.count(first, last);
    for (Index j = first; j < last; ++j)
        result.push_back({found[j].eigenvalue, found[j].bound, {found[j].eigenvalue, found[j].rest}});
    return result;
}

template <Real S>
std::vector<Certified<double>> all_eigenvalues(const ElementPencil<S>& wide, Index first, Index last, Index total,
                                               double tolerance) {
    return all_eigenvalues(wide, spectrum::lumped(wide), first, last, total, tolerance);
}

}  // namespace revchain::pencil
