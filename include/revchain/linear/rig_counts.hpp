// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>

#include "revchain/count.hpp"
#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/proved_roots.hpp"
#include "revchain/pencil/twisted.hpp"

/// The part of `rig_modes` that counts: for rigs whose roots are all real and one count numbers.
namespace revchain::inline REVCHAIN_BUILD::detail {

using RigWord = Wide<double>;

/// A root x > 0, and half the width of the proved interval about what is given out for it, relative to that.
struct FoundRoot {
    RigWord x{};
    double margin = std::numeric_limits<double>::infinity();
};

/// The roots x > 0 of Q(side x), numbered from 0, largest first: base + sign (negative eigenvalues of Q) exceed x.
class CountedRoots {
   public:
    CountedRoots(pencil::SignedPencil<RigWord> pencil, const RigWord& pace, Index base, Index sign, int side)
        : pencil_(std::move(pencil)), pace_(pace), base_(base), sign_(sign), side_(side) {}

    /// Counts in double, for `bisect`.
    struct Counter {
        pencil::SignedPencil<double> rounded;
        Index base, sign;
        double side;

        template <std::size_t N>
        friend std::array<Index, N> count_above(const Counter& counter, std::array<double, N> shifts) {
            for (double& shift : shifts) shift *= counter.side;
            auto above = pencil::count_above(counter.rounded, shifts);
            for (Index& count : above) count = counter.base + counter.sign * count;
            return above;
        }
    };

    const pencil::SignedPencil<RigWord>& pencil() const { return pencil_; }

    struct Available {
        Index count = 0;
        bool proved = false;
    };
    /// How many there are: counted at 0, where M has no zero itself; else where rounding leaves no doubt, at 1e-120 of
    /// the length where what has no mass has none at all.
    Available available() const {
        if (const auto count = counted<1>({RigWord(0.0)}); count[0].proved) return {count[0].above, true};
        const int start = pencil_.quadratic ? -200 : -400;
        Available found{std::max<Index>(0, counted<1>({RigWord(std::ldexp(1.0, start))})[0].above), false};
        for (int exponent = start; exponent < 200; exponent += 20)
            if (const auto count = counted<1>({RigWord(std::ldexp(1.0, exponent))}); count[0].proved)
                return {count[0].above, exponent == start};
        return found;
    }

    /// Brackets of the roots number `first` ..., by counts in double. `finished(done)` is called after every pass.
    std::vector<pencil::Bracket<double>> brackets(Index first, Index count, double start,
                                                  const std::function<void(Index)>& finished) const {
        const Counter counter{pencil::rounded<double>(pencil_), base_, sign_, static_cast<double>(side_)};
        return pencil::bisect(counter, first, count, 2 * epsilon<double>(), start, finished);
    }

    /// Root number j from its bracket: a vector in two words, its quotient, and two proved counts.
    FoundRoot refined(Index j, const pencil::Bracket<double>& bracket) const {
        const double margin = epsilon<double>();
        const RigWord side(static_cast<double>(side_));
        const auto in_pairs = [this](const std::array<RigWord, 2>& shifts) { return counted(shifts); };
        RigWord x(pencil::between(bracket.lower, bracket.upper));
        for (int round = 0; round < 3; ++round) {
            const RigWord root =
                side * pencil::rayleigh_quotient(pencil_, pencil::twisted_vector(pencil_, side * x), side * x);
            if (!(root > RigWord(0.0)) || !isfinite(root)) break;
            x = root;
            if (pencil::root_within(in_pairs, j, given_out(x), margin)) return {x, margin};
        }
        // by proved counts alone, as far as they go
        const RigWord guess(pencil::between(bracket.lower, bracket.upper));
        const auto found = pencil::proved_interval(in_pairs, j, guess, epsilon<double>() / 4);
        if (!found) return {guess};
        return {found->middle(), found->reach(given_out(found->middle()))};
    }

    /// A proved count of the roots above x.
    pencil::CertifiedCount certified(const RigWord& x) const { return counted<1>({x})[0]; }

    /// y with Q y = 0 at a root.
    std::vector<RigWord> vector(const RigWord& x) const {
        return pencil::twisted_vector(pencil_, RigWord(static_cast<double>(side_)) * x);
    }

   private:
    template <std::size_t N>
    std::array<pencil::CertifiedCount, N> counted(std::array<RigWord, N> x) const {
        for (RigWord& one : x) one = RigWord(static_cast<double>(side_)) * one;
        auto result = pencil::certified_count(pencil_, x);
        for (auto& one : result) one.above = base_ + sign_ * one.above;
        return result;
    }

    /// The x that belongs to what is given out, rounded: a speed where there is momentum, else a height.
    RigWord given_out(const RigWord& x) const {
        return pencil_.quadratic ? pace_ / RigWord(static_cast<double>(pace_ / x)) : RigWord(static_cast<double>(x));
    }

    pencil::SignedPencil<RigWord> pencil_;
    RigWord pace_;
    Index base_, sign_;
    int side_;
};

/// The roots number `first` ... of a sense, one by one; `bracketed(done)` and `finished(done)` are told how many are.
inline std::vector<FoundRoot> refined_roots(const CountedRoots& roots, Index first, Index count, double guess,
                                            const std::function<void(Index)>& bracketed,
                                            const std::function<void(Index)>& finished) {
    const auto brackets = roots.brackets(first, count, guess, bracketed);
    std::vector<FoundRoot> found(brackets.size());
    std::atomic<Index> done = 0;
    parallel_for(count, 1, [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            look();
            found[static_cast<std::size_t>(j)] = roots.refined(first + j, brackets[static_cast<std::size_t>(j)]);
            if (finished) finished(++done);
        }
    });
    return found;
}

/// A root as it is given out.
inline FoundRoot given_out(const pencil::ProvedRoot<double>& proved) {
    return {proved.root, (proved.off / proved.root.high + epsilon<double>() / 2) * (1 + 0x1p-30)};
}
/// How far a root may be from the exact one, relative, before it is rounded.
inline constexpr double worst_unrounded_root = 0.49 * std::numeric_limits<double>::epsilon();

/// The heights of a chain under a support that yields, from all of them at once; nothing for other rigs, where a few of
/// many are asked for, and where one is not proved. `elements` is the rig's pencil.
inline std::optional<std::vector<FoundRoot>> roots_under_a_spring(const Rig& rig,
                                                                  const pencil::ElementPencil<RigWord>& elements,
                                                                  const ModeRange& range, Index available) {
    const Chain<double>& chain = rig.chain();
    const Rigging& with = rig.rigging();
    if (with.support.is_firm() || !with.posture.empty() || !with.flywheels.empty() || !with.displaced.empty() ||
        chain.mode_count() != chain.size() || !chain.has_one_weight_unit() ||
        chain.size() >= static_cast<Index>(pencil::aberth::most_links) || 4 * range.count < available)
        return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto& spring = elements.elements.back();
    pencil::aberth::LumpedLinks links;
    if (!lump(links, chain, SpringOnTop{spring.stiffness.high, spring.lower.high})) return std::nullopt;
    pencil::AberthSpectrum all;
    if (static_cast<Index>(links.size) != available || !pencil::aberth_spectrum(links, 0x1p-40, all))
        return std::nullopt;
    const auto roots = refined(elements, range, available, all, worst_unrounded_root);
    if (!roots) return std::nullopt;
    std::vector<FoundRoot> found;
    for (const auto& root : *roots) found.push_back(given_out(root));
    return found;
}

/// The roots of a range of numbers, from 1, where every stiffness is positive and no mass negative: eight at a time, to
/// an ulp of what is given out. Nothing where that is not proved. `elements` is the pencil of `roots`.
template <bool Spins>
std::optional<std::vector<FoundRoot>> roots_in_lanes(const pencil::ElementPencil<RigWord, Spins>& elements,
                                                            const CountedRoots& roots, const ModeRange& range,
                                                            Index available, double guess,
                                                            const std::function<void(Index)>& finished) {
    if (elements.size() > most_in_lanes) return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto counter = pencil::rounded<double>(elements);
    const auto certified = [&](double x) { return roots.certified(RigWord(x)); };
    const auto proved = pencil::proved_range(elements, counter, certified, range.first - 1, range.count, available,
                                             guess, worst_unrounded_root, finished);
    if (!proved) return std::nullopt;
    std::vector<FoundRoot> found;
    found.reserve(proved->size());
    for (const auto& root : *proved) {
        const Index j = range.first - 1 + static_cast<Index>(found.size());
        found.push_back(std::isfinite(root.off) ? given_out(root)
                                                : roots.refined(j, roots.brackets(j, 1, guess, {}).front()));
    }
    return found;
}

}  // namespace revchain::detail
