// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/sturm.hpp"
#include "revchain/linear/assembly.hpp"

namespace revchain {

/// Counts the modes of one chain on either side of a height or a speed, without computing any: assembled once, then
/// one O(N) pass for each question.
///
/// The count is proved, in T (15 ns per link in double) and where rounding leaves that in doubt in `Wide<T>`. A conical
/// height that agrees with the one asked to within the rounding of `Wide<T>` (1e-29 or so in double, for moderate N)
/// is held equal to it, so that neither exceeds the other.
template <Real T>
class ModeCounter {
   public:
    explicit ModeCounter(const Chain<T>& chain)
        : assembled_(assemble(chain)), pencil_(linalg::rounded<T>(assembled_.pencil)) {}

    /// How many conical heights exceed `height`. Throws InvalidArgument unless it is positive and finite.
    Index above_height(const T& height) const {
        detail::require_positive("count_modes", "conical height", height);
        return above(Wide<T>(height));
    }

    /// How many whirl speeds lie below `angular_speed`: the comparison is with g / n^2 in `Wide<T>`.
    /// Throws InvalidArgument unless both are positive and finite.
    Index below_speed(const T& angular_speed, const T& gravity) const {
        detail::require_positive("count_modes", "angular speed", angular_speed);
        detail::require_positive("count_modes", "gravity", gravity);
        return above(Wide<T>(gravity) / Wide<T>(angular_speed) / Wide<T>(angular_speed));
    }

   private:
    Index above(const Wide<T>& height) const {
        using std::ldexp;
        const Wide<T> shift = ldexp(height, -assembled_.units.length_exponent);
        const T rounded = static_cast<T>(shift);
        if (Wide<T>(rounded) == shift) {
            const auto quick = linalg::certified_count<T, 1>(pencil_, {rounded});
            if (quick[0].proved) return quick[0].above;
        }
        return linalg::certified_count<Wide<T>, 1>(assembled_.pencil, {shift})[0].above;
    }

    AssembledChain<T> assembled_;
    linalg::ElementPencil<T> pencil_;
};

/// How many conical heights of the chain exceed `height`. See ModeCounter.
template <Real T>
Index count_modes(const Chain<T>& chain, const T& height) {
    return ModeCounter<T>(chain).above_height(height);
}

/// How many whirl speeds of the chain lie below `angular_speed`. See ModeCounter.
template <Real T>
Index count_modes(const Chain<T>& chain, const T& angular_speed, const T& gravity) {
    return ModeCounter<T>(chain).below_speed(angular_speed, gravity);
}

}  // namespace revchain
