// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <string_view>

#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/twisted.hpp"

/// Roots of a `RigPencil` that are all real and that one count numbers, one by one.
namespace revchain::inline REVCHAIN_BUILD::detail {

using RigWord = Wide<double>;

/// A root x > 0, and half the width of the proved interval about what is given out for it, relative
/// to that.
struct FoundRoot {
    RigWord x{};
    double margin = std::numeric_limits<double>::infinity();
};

/// The roots x > 0 of Q(side x), numbered from 0, largest first: base + sign (negative eigenvalues
/// of Q) exceed x.
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
    /// How many there are: counted at 0, where M has no zero itself; else where rounding leaves no
    /// doubt, at 1e-120 of the length where what has no mass has none at all.
    Available available() const {
        if (const auto count = counted<1>({RigWord(0.0)}); count[0].proved) return {count[0].above, true};
        const int start = pencil_.quadratic ? -200 : -400;
        Available found{std::max<Index>(0, counted<1>({RigWord(std::ldexp(1.0, start))})[0].above), false};
        for (int exponent = start; exponent < 200; exponent += 20)
            if (const auto count = counted<1>({RigWord(std::ldexp(1.0, exponent))}); count[0].proved)
                return {count[0].above, exponent == start};
        return found;
    }

    /// Brackets of the roots number `first` ..., by counts in double. `finished(done)` is called
    /// after every pass.
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

    /// The x that belongs to what is given out, rounded: a speed where there is momentum, else a
    /// height.
    RigWord given_out(const RigWord& x) const {
        return pencil_.quadratic ? pace_ / RigWord(static_cast<double>(pace_ / x)) : RigWord(static_cast<double>(x));
    }

    pencil::SignedPencil<RigWord> pencil_;
    RigWord pace_;
    Index base_, sign_;
    int side_;
};

/// The least root that is searched for; the largest is one over it.
inline RigWord least_root(bool quadratic) { return std::ldexp(1.0, quadratic ? -200 : -400); }

/// How many roots exceed x, by the proved counts `count(x)`. A root within 2^20 roundings of x
/// counts as equal to it, not as larger. Numbers beyond `least_root` and one over it are taken as
/// those limits. Throws InvalidArgument where the number is not proved; `place` and `value` are for
/// the message.
template <class Count>
Index number_above(const RigWord& x, bool quadratic, std::string_view place, double value, const Count& count) {
    const RigWord least = least_root(quadratic);
    RigWord at = std::min(std::max(x, least), RigWord(1.0) / least);
    for (const double tie : {0.0, operation_error<RigWord>() * 0x1p20}) {
        at = at + at * RigWord(tie);
        if (const auto found = count(at); found.proved) return found.above;
    }
    throw_invalid(place,
                  "rounding leaves in doubt how many whirl speeds of this system lie below it; use one a little beside "
                  "it",
                  value);
}

/// The roots of one sense: by counts, which are proved without any root being found.
struct CountedSense {
    CountedRoots roots;
    CountedRoots::Available available;

    /// How many roots exceed x, as `number_above` says.
    Index above(const RigWord& x, std::string_view place, double value) const {
        const bool quadratic = roots.pencil().quadratic;
        if (available.proved && !(x > least_root(quadratic))) return available.count;
        return number_above(x, quadratic, place, value, [&](const RigWord& at) { return roots.certified(at); });
    }
};

/// Heights above 0 of a rig without momentum; K > 0 or M >= 0.
inline CountedSense counted_heights(const RigPencil& rig) {
    // Where K > 0, heights above h are the negative eigenvalues of hK - M. Where M >= 0 those of K
    // - mu M, mu = 1/h, are these and besides as many as K has.
    const Index before = rig.stiffness_positive ? 0 : rig.not_positive, size = rig.pencil.size();
    CountedRoots roots(rig.pencil, rig.pace, -before, 1, 1);
    // Just above h = 0 the form hK - M is negative where there is inertia; elsewhere it has the
    // signs of K.
    const MasslessForm& form = rig.massless;
    const bool ranked = rig.mass_not_negative && form.certain && form.zero == 0;
    const auto available =
        ranked ? CountedRoots::Available{size - form.size + form.negative - before, true} : roots.available();
    return {std::move(roots), available};
}

/// The roots number `first` ... of a sense, one by one; `bracketed(done)` and `finished(done)` are
/// told how many are.
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

}  // namespace revchain::detail
