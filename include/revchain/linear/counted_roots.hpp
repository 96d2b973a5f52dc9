// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <string_view>

#include "revchain/linear/count.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/twisted.hpp"

/// This header has roots of a `RigPencil` that are all real and that one count numbers, one by one.
namespace revchain::inline REVCHAIN_BUILD::detail {

using RigWord = Wide<double>;

/// A root x > 0 before it was rounded, and a bound of its relative error. Some bounds cover the
/// rounding of the height or speed that is returned; `set_mode` adds what they leave out.
using FoundRoot = pencil::Certified<double>;

/// Roots x > 0 of Q(side x), 0 the largest: base + sign (number of negative eigenvalues of Q)
/// exceed x.
class CountedRoots {
   public:
    CountedRoots(pencil::SignedPencil<RigWord> pencil, const RigWord& pace, Index base, Index sign,
                 int side)
        : pencil_(std::move(pencil)), pace_(pace), base_(base), sign_(sign), side_(side) {}

    /// Counts in double, for `bisect`.
    struct Counter {
        pencil::SignedPencil<double> rounded;
        Index base, sign;
        double side;

        template <std::size_t N>
        friend std::array<Index, N> count_above(const Counter& counter,
                                                std::array<double, N> shifts) {
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
    /// Returns the number of roots. It is counted at 0 if M is not singular. Otherwise it is
    /// counted at the least x from 1e-120 of the length on without doubt from rounding, and proved
    /// only at that start.
    Available available() const {
        if (const auto count = certified(RigWord(0.0)); count.proved) return {count.above, true};
        const int start = pencil_.quadratic ? -200 : -400;
        for (int exponent = start; exponent < 200; exponent += 20)
            if (const auto count = certified(std::ldexp(1.0, exponent)); count.proved)
                return {count.above, exponent == start};
        return {std::max<Index>(0, certified(std::ldexp(1.0, start)).above), false};
    }

    /// Returns brackets of the roots from number `first` on, by counts in double; see `bisect`.
    std::vector<pencil::Bracket<double>> brackets(
        Index first, Index count, double start, const std::function<void(Index)>& finished) const {
        const Counter counter{pencil::rounded<double>(pencil_), base_, sign_,
                              static_cast<double>(side_)};
        return pencil::bisect(counter, first, count, 2 * epsilon<double>(), start, finished);
    }

    /// Returns root number j from its bracket: by a vector in two words, its quotient and two
    /// counts.
    FoundRoot refined(Index j, const pencil::Bracket<double>& bracket) const {
        const double margin = epsilon<double>();
        const RigWord side(static_cast<double>(side_));
        const auto in_pairs = [this](const std::array<RigWord, 2>& shifts) {
            return counted(shifts);
        };
        const RigWord guess(pencil::between(bracket.lower, bracket.upper));
        RigWord x = guess;
        for (int round = 0; round < 3; ++round) {
            const auto vector = pencil::twisted_vector(pencil_, side * x);
            const RigWord root = side * pencil::rayleigh_quotient(pencil_, vector, side * x);
            if (!(root > RigWord(0.0)) || !isfinite(root)) break;
            x = root;
            if (pencil::root_within(in_pairs, j, given_out(x), margin))
                return {static_cast<double>(x), margin, x};
        }
        // The last resort is proved counts alone.
        const auto found = pencil::proved_interval(in_pairs, j, guess, epsilon<double>() / 4);
        constexpr double unproved = std::numeric_limits<double>::infinity();
        x = found ? found->middle() : guess;
        return {static_cast<double>(x), found ? found->reach(given_out(x)) : unproved, x};
    }

    pencil::CertifiedCount certified(const RigWord& x) const { return counted<1>({x})[0]; }

    /// Returns the vector y with Q y = 0 at a root.
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

    /// Returns x after rounding of the result: of a speed if there is momentum, else of a height.
    RigWord given_out(const RigWord& x) const {
        return pencil_.quadratic ? pace_ / RigWord(static_cast<double>(pace_ / x))
                                 : RigWord(static_cast<double>(x));
    }

    pencil::SignedPencil<RigWord> pencil_;
    RigWord pace_;
    Index base_, sign_;
    int side_;
};

/// Returns the least root that is searched for; the largest is its reciprocal.
REVCHAIN_LAZY
RigWord least_root(bool quadratic) { return std::ldexp(1.0, quadratic ? -200 : -400); }

/// Returns the number of roots above x as `number_above` does, with x limited to `least_root` and
/// its reciprocal.
template <class Count>
Index number_above(const RigWord& x, bool quadratic, std::string_view place, double value,
                   const Count& count) {
    const RigWord least = least_root(quadratic);
    return number_above(std::min(std::max(x, least), RigWord(1.0) / least), place, value, count);
}

/// The roots of one sense of rotation, counted without finding them.
struct CountedSense {
    CountedRoots roots;
    CountedRoots::Available available;

    /// `count` is the proved number of roots, or nothing if it must be counted.
    CountedSense(CountedRoots counted, std::optional<Index> count)
        : roots(std::move(counted)),
          available(count ? CountedRoots::Available{*count, true} : roots.available()) {}

    Index above(const RigWord& x, std::string_view place, double value) const {
        const bool quadratic = roots.pencil().quadratic;
        if (available.proved && !(x > least_root(quadratic))) return available.count;
        const auto count = [&](const RigWord& at) { return roots.certified(at); };
        return number_above(x, quadratic, place, value, count);
    }
};

/// Returns the heights above 0 of a rig without momentum; K > 0 or M >= 0. If K > 0, heights above
/// h are negative eigenvalues of hK - M. If M >= 0, negative eigenvalues of K - M/h are those
/// heights and the negative eigenvalues of K. Just above h = 0, hK - M is negative on motions with
/// inertia, and has the signs of K on the others. A free trolley moves as a whole: K is 0 there, and
/// Q is negative at every h.
REVCHAIN_LAZY
CountedSense counted_heights(const RigPencil& rig) {
    const Index before = (rig.stiffness_positive ? 0 : rig.not_positive) + rig.rigid;
    const MasslessForm& form = rig.massless;
    std::optional<Index> count;
    if (rig.mass_not_negative && form.certain && form.zero == 0 && !rig.pencil.has_joints())
        count = rig.pencil.size() - form.size + form.negative - before;
    return {CountedRoots(rig.pencil, rig.pace, -before, 1, 1), count};
}

/// Returns roots from number `first` on. `bracketed` and `finished` receive the number done.
REVCHAIN_LAZY
std::vector<FoundRoot> refined_roots(const CountedRoots& roots, Index first, Index count,
                                     double guess, const std::function<void(Index)>& bracketed,
                                     const std::function<void(Index)>& finished) {
    const auto brackets = roots.brackets(first, count, guess, bracketed);
    std::vector<FoundRoot> found(brackets.size());
    std::atomic<Index> done = 0;
    parallel_for(count, 1, [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            check_interrupt();
            found[static_cast<std::size_t>(j)] =
                roots.refined(first + j, brackets[static_cast<std::size_t>(j)]);
            if (finished) finished(++done);
        }
    });
    return found;
}

}  // namespace revchain::detail
