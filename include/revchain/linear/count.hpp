// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/sturm.hpp"
#include "revchain/linear/assembly.hpp"

namespace revchain {

/// Counts the modes of one chain on either side of a height or a speed, without computing any: assembled once, then
/// one O(N) pass for each question.
///
/// The count is proved, in T (15 ns per link in double) and where rounding leaves that in doubt in `Wide<T>`. A conical
/// height that agrees with the one asked to within 2^20 roundings of `Wide<T>` (4e-25 in double) is held equal to it, so
/// that neither exceeds the other.
template <Real T>
class ModeCounter {
   public:
    explicit ModeCounter(const Chain<T>& chain)
        : assembled_(assemble(chain)),
          pencil_(linalg::rounded<T>(assembled_.pencil)),
          mode_count_(chain.mode_count()) {}

    /// How many conical heights exceed `height`. Throws InvalidArgument unless it is positive and finite.
    Index above_height(const T& height) const {
        detail::require_positive("count_modes", "conical height", height);
        return above(Wide<T>(height), height);
    }

    /// How many whirl speeds lie below `angular_speed`: the comparison is with g / n^2 in `Wide<T>`.
    /// Throws InvalidArgument unless both are positive and finite.
    Index below_speed(const T& angular_speed, const T& gravity) const {
        detail::require_positive("count_modes", "angular speed", angular_speed);
        detail::require_positive("count_modes", "gravity", gravity);
        return above(Wide<T>(gravity) / Wide<T>(angular_speed) / Wide<T>(angular_speed),
                     gravity / angular_speed / angular_speed);
    }

   private:
    /// `rough` is `height` in T: it says where the height has left the range of the scalar.
    Index above(const Wide<T>& height, const T& rough) const {
        using std::ldexp;
        const T scaled = ldexp(rough, -assembled_.units.length_exponent);
        if (!(scaled < std::numeric_limits<T>::max() * epsilon<T>())) return 0;
        if (scaled < std::numeric_limits<T>::min() / epsilon<T>()) return mode_count_;
        const Wide<T> shift = ldexp(height, -assembled_.units.length_exponent);
        if (shift == Wide<T>(static_cast<T>(shift))) {
            const auto quick = linalg::certified_count<T, 1>(pencil_, {static_cast<T>(shift)});
            if (quick[0].proved) return quick[0].above;
        }
        const Wide<T> tie(operation_error<Wide<T>>() * Narrow<Wide<T>>(1 << 20));
        const auto wide = linalg::certified_count<Wide<T>, 2>(assembled_.pencil, {shift, shift + shift * tie});
        return wide[0].proved ? wide[0].above : wide[1].above;
    }

    AssembledChain<T> assembled_;
    linalg::ElementPencil<T> pencil_;
    Index mode_count_;
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
