// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/counted_roots.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/spectrum.hpp"

/// This header has the roots of a rig's pencil in each sense of rotation, by number.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// The relative error before rounding up to which a root counts as proved.
inline constexpr double worst_unrounded_root = 0.49 * std::numeric_limits<double>::epsilon();

/// The heights of a chain under a support that yields, all found together; nothing for other rigs,
/// for a few of many modes, and where one is not proved. `elements` is the rig's pencil.
REVCHAIN_LAZY
std::optional<std::vector<FoundRoot>> roots_under_a_spring(
    const Rig& rig, const pencil::ElementPencil<RigWord>& elements, const ModeRange& range,
    Index available) {
    const Chain<double>& chain = rig.chain();
    const Rigging& with = rig.rigging();
    if (with.support.is_firm() || !with.posture.empty() || !with.flywheels.empty() ||
        !with.displaced.empty() || chain.mode_count() != chain.size() ||
        !chain.has_one_weight_unit() ||
        chain.size() >= static_cast<Index>(pencil::aberth::most_links) ||
        4 * range.count < available)
        return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto& spring = elements.elements.back();
    pencil::aberth::LumpedLinks links;
    if (!lump(links, chain, SpringOnTop{spring.stiffness.high, spring.lower.high}))
        return std::nullopt;
    pencil::AberthSpectrum all;
    if (static_cast<Index>(links.size) != available ||
        !pencil::aberth_spectrum(links, 0x1p-40, all))
        return std::nullopt;
    return refined(elements, range, available, all, worst_unrounded_root);
}

/// The roots of a range of numbers, from 1, eight at a time, to an ulp of the rounded result;
/// nothing where not proved. K > 0, no mass is negative. `elements` is the pencil of `roots`.
template <bool Spins>
std::optional<std::vector<FoundRoot>> roots_in_lanes(
    const pencil::ElementPencil<RigWord, Spins>& elements, const CountedRoots& roots,
    const ModeRange& range, Index available, double guess,
    const std::function<void(Index)>& finished) {
    if (elements.size() > most_in_lanes) return std::nullopt;
    return roots_in_lanes(
        elements, pencil::rounded<double>(elements),
        [&](double x) { return roots.certified(RigWord(x)); }, range, available, guess,
        worst_unrounded_root, finished,
        [&](Index j, const pencil::Bracket<double>& bracket) { return roots.refined(j, bracket); });
}

/// Heights below 0, under the conditions of `counted_heights`; nothing where there are none.
REVCHAIN_LAZY
std::optional<CountedSense> counted_negative_heights(const RigPencil& rig) {
    const Index size = rig.pencil.size();
    if (rig.stiffness_positive) {
        if (rig.mass_not_negative) return std::nullopt;
        return CountedSense(CountedRoots(rig.pencil, rig.pace, size, -1, -1), std::nullopt);
    }
    const MasslessForm& form = rig.massless;
    const Index falling = rig.not_positive - rig.neutral;
    std::optional<Index> count;
    if (form.certain && form.zero == 0 && !rig.pencil.has_joints()) count = falling - form.negative;
    return CountedSense(CountedRoots(rig.pencil, rig.pace, falling - size, 1, -1), count);
}

/// Returns speeds of one sense of a rig with momentum; K > 0 and M >= 0. Just above x = 0 the form
/// Q is negative where there is inertia; elsewhere it has the signs of G, and is positive where G
/// is 0.
REVCHAIN_LAZY
CountedSense counted_speeds(const RigPencil& rig, bool forward) {
    const MasslessForm& form = rig.massless;
    const Index negative = forward ? form.negative : form.size - form.zero - form.negative;
    std::optional<Index> count;
    if (form.certain && !rig.pencil.has_joints())
        count = rig.pencil.size() - form.size + negative - rig.rigid;
    return {CountedRoots(forward ? rig.pencil : rig.pencil.reversed(), rig.pace, -rig.rigid, 1, 1),
            count};
}

inline constexpr Index most_isolated = 20'000;

/// The roots of a rig's pencil: counted in each sense or, if that fails, all isolated in discs.
class RigRoots {
   public:
    /// Throws what `rig_pencil` throws, and InvalidArgument for more than `most_isolated` elements
    /// whose roots must be isolated. `advance(share)` is as in `complex_spectrum`.
    RigRoots(std::string_view place, const Rig& rig, double gravity,
             const std::function<void(double)>& advance)
        : rig_(rig_pencil(rig, gravity)), gravity_(gravity) {
        const bool quadratic = rig_.pencil.quadratic;
        if (rig_.pencil.size() == 0) return;
        if (quadratic ? rig_.stiffness_positive && rig_.mass_not_negative
                      : rig_.stiffness_positive || rig_.mass_not_negative) {
            senses_.push_back(quadratic ? counted_speeds(rig_, true) : counted_heights(rig_));
            if (quadratic) senses_.push_back(counted_speeds(rig_, false));
            return;
        }
        if (rig_.pencil.has_joints())
            throw_invalid(place,
                          "with springs at pins every speed must be real: standing or floating "
                          "links with momentum, driven wheels and floats in a fluid that turns "
                          "with them are solved without such springs");
        if (rig_.pencil.size() > most_isolated)
            throw_invalid(place,
                          "a rig whose speeds may be complex (standing or floating links with "
                          "momentum, driven wheels, floats in a fluid that turns with them) is "
                          "solved for at most " +
                              std::to_string(most_isolated) + " links and supports that yield",
                          rig_.pencil.size());
        // A massless coordinate has one root x = 0, and two if no momentum acts on it.
        const Index zeros = rig_.massless.size + (quadratic ? rig_.massless.zero : 0);
        spectrum_ = pencil::complex_spectrum(rig_.pencil, zeros, advance);
    }

    const RigPencil& rig() const { return rig_; }
    bool has_momentum() const { return rig_.pencil.quadratic; }
    /// Returns counted senses, backward second (with momentum); none if roots are isolated or
    /// absent.
    const std::vector<CountedSense>& senses() const { return senses_; }
    const std::optional<pencil::ComplexSpectrum>& spectrum() const { return spectrum_; }

    /// These return x of a conical height, or of a speed. The sign of a speed only gives the sense.
    RigWord at_height(double height) const {
        const RigWord scaled(std::ldexp(height, -rig_.units.length_exponent));
        return has_momentum() ? sqrt(scaled) : scaled;
    }
    RigWord at_speed(double speed) const {
        const RigWord n(std::abs(speed));
        const RigWord x =
            has_momentum() ? rig_.pace / n
                           : RigWord(std::ldexp(gravity_, -rig_.units.length_exponent)) / n / n;
        return x < RigWord(1e290) ? x : RigWord(1e290);  // an overflow too: beyond all roots
    }

    /// Returns the number of modes of a sense with a larger x, if `proved`.
    pencil::CertifiedCount count(const RigWord& x, bool forward) const {
        return spectrum_ ? isolated(x, forward) : senses_[forward ? 0 : 1].roots.certified(x);
    }

    /// Returns the number of modes of a sense with a larger x, see `number_above`.
    Index above(const RigWord& x, bool forward, std::string_view place, double value) const {
        if (rig_.pencil.size() == 0) return 0;
        if (!spectrum_) return senses_[forward ? 0 : 1].above(x, place, value);
        const auto counted = [&](const RigWord& at) { return isolated(at, forward); };
        return number_above(x, has_momentum(), place, value, counted);
    }

   private:
    /// Counts discs beyond x, and the disc around x if det Q changes sign between x and its end.
    pencil::CertifiedCount isolated(const RigWord& x, bool forward) const {
        pencil::CertifiedCount result{0, spectrum_->proved};
        if (!result.proved) return result;
        const RigWord side(forward ? 1.0 : -1.0);
        for (const pencil::EnclosedRoot& root : spectrum_->roots) {
            if (!root.is_real) continue;
            const RigWord value = side * RigWord(root.value.real()), radius(root.radius);
            if (value < RigWord(0.0) || value + radius < x) continue;
            if (!(value - radius > x)) {
                const std::array<RigWord, 2> ends{side * x, side * (value + radius)};
                const auto at = pencil::certified_count(rig_.pencil, ends);
                result.proved = result.proved && at[0].proved && at[1].proved;
                if ((at[0].above - at[1].above) % 2 == 0) continue;
            }
            ++result.above;
        }
        return result;
    }

    RigPencil rig_;
    double gravity_;
    std::vector<CountedSense> senses_;
    std::optional<pencil::ComplexSpectrum> spectrum_;
};

}  // namespace revchain::detail
