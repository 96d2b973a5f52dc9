// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "revchain/linear/rig_counts.hpp"
#include "revchain/pencil/complex/spectrum.hpp"

/// The roots of a rig's pencil in each sense of rotation, by number.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Heights below 0, under the same conditions; nothing where there are none.
inline std::optional<CountedSense> counted_negative_heights(const RigPencil& rig) {
    const Index size = rig.pencil.size();
    if (rig.stiffness_positive) {
        if (rig.mass_not_negative) return std::nullopt;
        CountedRoots roots(rig.pencil, rig.pace, size, -1, -1);
        const auto available = roots.available();
        return CountedSense{std::move(roots), available};
    }
    const MasslessForm& form = rig.massless;
    const Index falling = rig.not_positive - rig.neutral;
    CountedRoots roots(rig.pencil, rig.pace, falling - size, 1, -1);
    const auto available =
        form.certain && form.zero == 0 ? CountedRoots::Available{falling - form.negative, true} : roots.available();
    return CountedSense{std::move(roots), available};
}

/// Speeds of one sense of a rig with momentum; K > 0 and M >= 0.
inline CountedSense counted_speeds(const RigPencil& rig, bool forward) {
    CountedRoots roots(forward ? rig.pencil : rig.pencil.reversed(), rig.pace, 0, 1, 1);
    // Just above x = 0 the form Q is negative where there is inertia; elsewhere it has the signs of G, and where
    // that is 0, too, those of K > 0 and of a square.
    const MasslessForm& form = rig.massless;
    const Index negative = forward ? form.negative : form.size - form.zero - form.negative;
    const auto available =
        form.certain ? CountedRoots::Available{rig.pencil.size() - form.size + negative, true} : roots.available();
    return {std::move(roots), available};
}

/// Largest number of elements whose roots are isolated in discs.
inline constexpr Index most_isolated = 20'000;

/// The roots of a rig's pencil. They are counted in each sense or, where counts do not number them, all isolated in
/// discs.
class RigRoots {
   public:
    /// Throws what `rig_pencil` throws, and InvalidArgument for more than `most_isolated` elements whose roots have to
    /// be isolated. `advance(share)` as in `complex_spectrum`.
    RigRoots(std::string_view place, const Rig& rig, double gravity, const std::function<void(double)>& advance)
        : rig_(rig_pencil(rig, gravity)), gravity_(gravity) {
        const bool quadratic = rig_.pencil.quadratic;
        if (rig_.pencil.size() == 0) return;
        if (quadratic ? rig_.stiffness_positive && rig_.mass_not_negative
                      : rig_.stiffness_positive || rig_.mass_not_negative) {
            senses_.push_back(quadratic ? counted_speeds(rig_, true) : counted_heights(rig_));
            if (quadratic) senses_.push_back(counted_speeds(rig_, false));
            return;
        }
        if (rig_.pencil.size() > most_isolated)
            throw_invalid(place,
                          "a rig whose speeds may be complex (standing links with momentum, driven wheels, floats in a "
                          "fluid that turns with them) is solved for at most " +
                              std::to_string(most_isolated) + " links and supports that yield",
                          rig_.pencil.size());
        // A massless coordinate has a root x = 0, and two where no momentum acts on it.
        const Index zeros = rig_.massless.size + (quadratic ? rig_.massless.zero : 0);
        spectrum_ = pencil::complex_spectrum(rig_.pencil, zeros, advance);
    }

    const RigPencil& rig() const { return rig_; }
    bool has_momentum() const { return rig_.pencil.quadratic; }
    /// By counts; empty where roots are isolated or there are none. With momentum the second is backward.
    const std::vector<CountedSense>& senses() const { return senses_; }
    const std::optional<pencil::ComplexSpectrum>& spectrum() const { return spectrum_; }

    /// x of a conical height, or of a speed of either sign, which tells the sense.
    RigWord at_height(double height) const {
        const RigWord scaled(std::ldexp(height, -rig_.units.length_exponent));
        return has_momentum() ? sqrt(scaled) : scaled;
    }
    RigWord at_speed(double speed) const {
        const RigWord n(std::abs(speed));
        return has_momentum() ? rig_.pace / n : RigWord(std::ldexp(gravity_, -rig_.units.length_exponent)) / n / n;
    }

    /// How many modes of a sense have a larger x, where `proved`.
    pencil::CertifiedCount count(const RigWord& x, bool forward) const {
        if (spectrum_) return isolated(x, forward);
        const CountedSense& sense = senses_[forward ? 0 : 1];
        return sense.roots.certified(x);
    }

    /// How many modes of a sense have a larger x, as `number_above` says.
    Index above(const RigWord& x, bool forward, std::string_view place, double value) const {
        if (rig_.pencil.size() == 0) return 0;
        if (!spectrum_) return senses_[forward ? 0 : 1].above(x, place, value);
        return number_above(x, has_momentum(), place, value, [&](const RigWord& at) { return count(at, forward); });
    }

   private:
    /// Discs that lie beyond x, and that which holds x if the sign of det Q has changed between x and its outer end.
    pencil::CertifiedCount isolated(const RigWord& x, bool forward) const {
        pencil::CertifiedCount result{0, spectrum_->proved};
        if (!result.proved) return result;
        const RigWord side(forward ? 1.0 : -1.0);
        for (const pencil::EnclosedRoot& root : spectrum_->roots) {
            if (!root.is_real) continue;
            const RigWord value = side * RigWord(root.value.real()), radius(root.radius);
            if (value < RigWord(0.0) || value + radius < x) continue;
            if (!(value - radius > x)) {
                const auto at = pencil::certified_count<RigWord, 2>(rig_.pencil, {side * x, side * (value + radius)});
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
