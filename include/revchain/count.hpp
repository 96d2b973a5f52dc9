// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "revchain/conical_pendulum.hpp"
#include "revchain/linear/pencils.hpp"

/// The number of modes slower than a given speed, without computing any mode.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     revchain::count_modes(chain, {.angular_speed = 5.0});   // 1
namespace revchain::inline REVCHAIN_BUILD {

/// low < conical height <= high. `low` may be 0 and `high` infinite.
template <Real T>
struct HeightWindow {
    T low{};
    T high{};
};

/// low <= whirl speed < high, rad/s. `low` may be 0 and `high` infinite.
template <Real T>
struct SpeedWindow {
    T low{};
    T high{};
};

/// As a count of modes it means all.
inline constexpr Index all_modes = std::numeric_limits<Index>::max();

/// The modes number `first` (from 1, slowest first) to `first + count - 1`.
struct ModeRange {
    Index first = 1;
    Index count = 0;
    friend bool operator==(const ModeRange&, const ModeRange&) = default;
};

namespace detail {

template <Real T>
bool is_bounded(const T& x) {
    using std::isfinite;
    return isfinite(x);
}

template <Real T>
void check_window(std::string_view name, const T& low, const T& high) {
    const std::string window = std::string(name) + " window: ";
    if (!is_bounded(low) || low < T(0))
        throw_invalid("modes", window + "its low end must be finite and not negative", low);
    if (!(high > low))
        throw_invalid("modes", window + "its high end must exceed its low end " + in_digits(low),
                      high);
}

/// The modes, out of `all`, in a window of heights; `above(height)` counts modes with larger
/// heights.
template <Real T, class Above>
ModeRange modes_within(const HeightWindow<T>& window, Index all, const Above& above) {
    check_window("conical height", window.low, window.high);
    const Index before = is_bounded(window.high) ? above(window.high) : 0;
    if (window.low > T(0)) all = above(window.low);
    return {before + 1, std::max(all - before, Index(0))};
}

/// The modes, out of `all`, in a window of speeds; `below(speed)` counts slower modes.
template <Real T, class Below>
ModeRange modes_within(const SpeedWindow<T>& window, Index all, const Below& below) {
    check_window("angular speed", window.low, window.high);
    const Index before = window.low > T(0) ? below(window.low) : 0;
    if (is_bounded(window.high)) all = below(window.high);
    return {before + 1, std::max(all - before, Index(0))};
}

/// Converts a window of speeds to a window of heights.
template <Real T>
HeightWindow<T> window_of_heights(const SpeedWindow<T>& window, const T& gravity) {
    check_window("angular speed", window.low, window.high);
    require_positive("modes", "gravity", gravity);
    const auto height = [&](const T& speed) { return gravity / speed / speed; };
    return {is_bounded(window.high) ? height(window.high) : T(0),
            window.low > T(0) ? height(window.low) : std::numeric_limits<T>::infinity()};
}

}  // namespace detail

namespace detail {
template <Real T>
class LazyCounter;
}

/// Counts the modes of one chain above a conical height or below a speed, without computing any
/// mode. The chain is assembled once, and each count is one to three O(N) passes. The count is
/// proved: in T (10 ns per link in double) or, where rounding leaves a doubt, in `Wide<T>`. A
/// conical height within 2^20 roundings of `Wide<T>` (4e-25 in double) of the given one may count
/// as equal to it.
/// Throws InvalidArgument if no count is proved.
template <Real T>
class ModeCounter {
   public:
    explicit ModeCounter(const Chain<T>& chain)
        : mode_count_(chain.mode_count()), pencils_(chain) {}

    /// The number of conical heights above `height`.
    [[nodiscard]] Index above_height(const T& height) const {
        detail::require_positive("count_modes", "conical height", height);
        return above(Wide<T>(height), height, "count_modes: conical height", height);
    }

    /// The number of whirl speeds below `angular_speed`: conical heights are compared with g / n^2
    /// in `Wide<T>`.
    [[nodiscard]] Index below_speed(const T& angular_speed, const T& gravity) const {
        detail::require_positive("count_modes", "angular speed", angular_speed);
        detail::require_positive("count_modes", "gravity", gravity);
        return above(Wide<T>(gravity) / Wide<T>(angular_speed) / Wide<T>(angular_speed),
                     gravity / angular_speed / angular_speed, "count_modes: angular speed",
                     angular_speed);
    }

    /// The modes whose heights lie in the window. Adjacent windows share no mode and miss none.
    /// Throws InvalidArgument unless 0 <= low < high.
    [[nodiscard]] ModeRange within(const HeightWindow<T>& window) const {
        return detail::modes_within(window, mode_count_,
                                    [&](const T& height) { return above_height(height); });
    }

    /// The modes whose speeds lie in the window. Throws InvalidArgument unless 0 <= low < high.
    [[nodiscard]] ModeRange within(const SpeedWindow<T>& window, const T& gravity) const {
        detail::require_positive("modes", "gravity", gravity);
        return detail::modes_within(window, mode_count_,
                                    [&](const T& speed) { return below_speed(speed, gravity); });
    }

   private:
    friend detail::LazyCounter<T>;
    /// `rough` is `height` in T, which may leave the range of T; `given` names what the caller
    /// gave.
    Index above(const Wide<T>& height, const T& rough, std::string_view given,
                const T& value) const;

    Index mode_count_;
    detail::Pencils<T> pencils_;
};

/// The speed below which modes are counted. Give either `conical_height` or `angular_speed`. For a
/// rig a negative speed is backward.
template <Real T>
struct CountOptions {
    std::optional<T> conical_height{};                  ///< modes with a larger one
    std::optional<T> angular_speed{};                   ///< rad/s: modes slower than it
    T gravity = T(conical_pendulum::standard_gravity);  ///< with `angular_speed`, for flywheels
};

/// The number of modes slower than a speed, proved; Greenhill (1908) §8 (21). Accuracy and ties:
/// see `ModeCounter`, which is faster for many counts of one chain. Cost: 40 ns a link. Throws
/// InvalidArgument unless exactly one of height and speed is given, positive and finite.
template <Real T>
[[nodiscard]] Index count_modes(const Chain<T>& chain, const CountOptions<T>& options) {
    detail::require_one_speed("count_modes", options);
    const ModeCounter<T> counter(chain);
    return options.conical_height ? counter.above_height(*options.conical_height)
                                  : counter.below_speed(*options.angular_speed, options.gravity);
}

}  // namespace revchain

#include "revchain/linear/count.hpp"
