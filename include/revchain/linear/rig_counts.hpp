// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/count.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/pencil/bisection.hpp"
#include "revchain/pencil/signed_twisted.hpp"

/// The part of `rig_modes` that counts: for rigs whose roots are all real and one count numbers.
namespace revchain::detail {

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
        : pencil_(std::move(pencil)),
          counter_(pencil_, base, sign, side),
          pace_(pace),
          base_(base),
          sign_(sign),
          side_(side) {}

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
    template <class Finished>
    std::vector<pencil::Bracket<double>> brackets(Index first, Index count, double start, Finished finished) const {
        return pencil::bisect(counter_, first, count, 2 * epsilon<double>(), start, finished);
    }

    /// Root number j from its bracket: a vector in two words, its quotient, and two proved counts.
    FoundRoot refined(Index j, const pencil::Bracket<double>& bracket) const {
        const double margin = epsilon<double>();
        const RigWord side(static_cast<double>(side_));
        RigWord x(pencil::between(bracket.lower, bracket.upper));
        for (int round = 0; round < 3; ++round) {
            const RigWord root =
                side * pencil::rayleigh_root(pencil_, pencil::twisted_vector(pencil_, side * x), side * x);
            if (!(root > RigWord(0.0)) || !isfinite(root)) break;
            x = root;
            const RigWord out = given_out(x), reach = out * RigWord(margin);
            const auto count = counted<2>({out - reach, out + reach});
            if (count[0].proved && count[1].proved && count[0].above > j && count[1].above <= j) return {x, margin};
        }
        return bisected(j, pencil::between(bracket.lower, bracket.upper));
    }

    /// y with Q y = 0 at a root.
    std::vector<RigWord> vector(const RigWord& x) const {
        return pencil::twisted_vector(pencil_, RigWord(static_cast<double>(side_)) * x);
    }

   private:
    template <std::size_t N>
    std::array<pencil::CertifiedCount, N> counted(std::array<RigWord, N> x) const {
        for (RigWord& one : x) one = RigWord(static_cast<double>(side_)) * one;
        auto result = pencil::certified_count<RigWord, N>(pencil_, x);
        for (auto& one : result) one.above = base_ + sign_ * one.above;
        return result;
    }

    /// The x that belongs to what is given out, rounded: a speed where there is momentum, else a height.
    RigWord given_out(const RigWord& x) const {
        return pencil_.quadratic ? pace_ / RigWord(static_cast<double>(pace_ / x)) : RigWord(static_cast<double>(x));
    }

    /// By proved counts alone, as far as they go.
    FoundRoot bisected(Index j, double guess) const {
        const RigWord centre(guess);
        RigWord lower = centre, upper = centre;
        bool has_lower = false, has_upper = false;
        for (double margin = 8 * epsilon<double>(); !(has_lower && has_upper); margin *= 16) {
            if (margin > 1e6) return {centre};
            const RigWord stretch(1 + margin);
            const auto count = counted<2>({centre / stretch, centre * stretch});
            if (!has_lower && count[0].proved && count[0].above > j) lower = centre / stretch, has_lower = true;
            if (!has_upper && count[1].proved && count[1].above <= j) upper = centre * stretch, has_upper = true;
        }
        for (int round = 0; round < 200; ++round) {
            if (static_cast<double>(upper - lower) < epsilon<double>() / 4 * static_cast<double>(lower)) break;
            const RigWord third = (upper - lower) / RigWord(3.0);
            const std::array<RigWord, 2> shifts{lower + third, upper - third};
            const auto count = counted<2>(shifts);
            bool moved = false;
            for (std::size_t i = 0; i < 2; ++i) {
                if (!count[i].proved) continue;
                if (count[i].above > j && shifts[i] > lower) lower = shifts[i], moved = true;
                if (count[i].above <= j && shifts[i] < upper) upper = shifts[i], moved = true;
            }
            if (!moved) break;
        }
        const RigWord x = lower + (upper - lower) / RigWord(2.0), out = given_out(x);
        const double worst = std::max(static_cast<double>(out - lower), static_cast<double>(upper - out));
        return {x, worst / static_cast<double>(lower) * (1 + 8 * epsilon<double>())};
    }

    pencil::SignedPencil<RigWord> pencil_;
    pencil::SignedCounter<double> counter_;
    RigWord pace_;
    Index base_, sign_;
    int side_;
};

}  // namespace revchain::detail
