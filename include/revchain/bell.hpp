// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <type_traits>

#include "revchain/chain.hpp"

/// When bell and clapper swing as one piece, so that the bell is silent, and how to change that.
///
///     const auto clapper = revchain::compound_pendulum<double>(
///         {.weight = 10, .length = 0.8, .centroid = 0.7, .radius_of_gyration = 0.1});
///     const auto bell = revchain::compound_pendulum<double>(
///         {.weight = 200, .length = 0.2, .centroid = 0.4, .radius_of_gyration = 0.4});
///     const revchain::Chain<double> chain({clapper, bell});
///     const auto b = revchain::bell_and_clapper(chain);
///     b.inclination_ratio[0];                                // 1.9243 times the bell's: it rings
///     revchain::bell_and_clapper_with_ratio(chain, 1.0)[4];  // 0.0855615 m: this joint is silent
///
/// Greenhill (1908) §8 (13)-(16).
namespace revchain::inline REVCHAIN_BUILD {

/// The data of a bell (suffix 2 in the paper) and its clapper (suffix 1). `joint` is a2, the
/// distance from the bell's axle to the clapper's pin.
enum class BellDatum {
    clapper_weight,
    clapper_centroid,
    clapper_radius_of_gyration,
    bell_weight,
    joint,
    bell_centroid,
    bell_radius_of_gyration
};

inline constexpr std::array<std::string_view, 7> bell_datum_names{
    "clapper_weight", "clapper_centroid", "clapper_radius_of_gyration", "bell_weight",
    "joint",          "bell_centroid",    "bell_radius_of_gyration"};

/// One number for each datum, in the order of `BellDatum`.
template <Real T>
using ByBellDatum = std::array<T, bell_datum_names.size()>;

/// The two modes of small motion about a position of rest. If both modes swing, or both fall, bell
/// and clapper lean to the same side in the first and to opposite sides in the second. If both
/// swing, the first is the slower one with the pin of the clapper below the axle, the faster one
/// with the pin above it. If both fall, it is the other way round. A height below 0 is that of a
/// motion that falls; if one mode swings and the other falls, the first is the one that swings.
template <Real T>
struct BellAndClapper {
    std::array<T, 2> conical_height;
    std::array<T, 2> inclination_ratio;  ///< clapper's over bell's; one piece where the first is 1
    T silent_height;  ///< l1 + a2, each negative if inverted: conical height as one piece
    /// h1 - (m + 1) l1 - m (a2 - l2), m = W2 h2/(W1 a2): a length, 0 if one piece, §8 (16). If one
    /// of the two is inverted, it is h1 - (m + 1) l1 + m (a2 - l2)
    T mismatch;
    ByBellDatum<T> present;          ///< the data
    std::array<bool, 2> inverted{};  ///< whether clapper and bell stand on their upper pins
    ByBellDatum<T> derivative;       ///< of the first inclination ratio with respect to each datum
};

/// Both modes of a bell (upper link) and its clapper (lower link). Accuracy: heights and ratios 2
/// ulp, derivatives, each times its datum, 1e-15 of the largest (tests/cpp/bell.cpp). Cost O(1).
/// Throws InvalidArgument unless there are two links, both with weight.
/// `joint`: distance of the clapper's pin below the axle, instead of the bell's length; negative
/// above it. `inverted`: whether clapper and bell stand on their upper pins at rest. A bell with
/// its centroid above the axle is an inverted one: give both distances with the opposite sign.
template <Real T>
[[nodiscard]] BellAndClapper<T> bell_and_clapper(
    const Chain<T>& chain, const std::optional<std::type_identity_t<T>>& joint = {},
    const std::array<bool, 2>& inverted = {});

/// Returns, for each datum, the value nearest to the present one that gives the first mode the
/// inclination ratio `ratio`, with all other data constant; NaN if there is none. The pin stays on
/// its side of the axle, and the position of rest as stable as it is. A ratio of 1 makes bell and
/// clapper one piece. Cost O(1). Throws InvalidArgument as `bell_and_clapper`, for a ratio <= 0 and
/// a joint of 0.
template <Real T>
[[nodiscard]] ByBellDatum<T> bell_and_clapper_with_ratio(
    const Chain<T>& chain, const T& ratio, const std::optional<std::type_identity_t<T>>& joint = {},
    const std::array<bool, 2>& inverted = {});

/// How a swing ends. `turns`: the bell comes to rest before the clapper strikes. `at_rest`: bell
/// and clapper start in balance and do not move. `too_long`: neither in 300 periods of the slower
/// body or 30,000 of the faster one.
enum class StrikeStatus { strikes, turns, at_rest, too_long };

inline constexpr std::array<std::string_view, 4> strike_status_names{"strikes", "turns", "at_rest",
                                                                     "too_long"};

/// How bell and clapper are released, at rest. Angles in rad.
struct StrikeStart {
    double clearance;  ///< angle of the clapper in the bell from the middle to contact, below pi/2
    /// Angle of the bell from its lowest position, 0 to pi. If left out, the bell falls from the
    /// balance, mouth up, in a full circle.
    std::optional<double> amplitude{};
    /// Angle of the clapper in the bell, towards the lower side; at +-clearance it rests on that
    /// side while the bell pushes it. If left out: in a full circle -clearance; else it hangs free
    /// or rests on the lower side.
    std::optional<double> clapper_angle{};
    double gravity = 9.80665;  ///< m/s^2
};

/// The first blow of a clapper; angle, speed and time are NaN if it does not strike.
struct Strike {
    StrikeStatus status;
    bool leading;       ///< the side struck: that ahead in the direction in which the bell moves
    double bell_angle;  ///< of the bell past its lowest position, rad
    double relative_speed;  ///< of the clapper in the bell, rad/s, > 0 towards the leading side
    double time;            ///< after the start, s
    /// Estimated error: of `bell_angle` in rad, of `relative_speed` and `time` as a part of each;
    /// infinite if rounding decides about the blow.
    double error_estimate;
};

/// The first blow of the clapper in a swing of the bell up to its next turn. Angles count from the
/// lowest position of the bell, inverted or not; if one of the two bodies is inverted, the clapper
/// points the other way in the middle of the bell. Throws InvalidArgument for angles out of range,
/// gravity not positive, and without `amplitude` if one of the two bodies is inverted. Cost: 0.1
/// ms.
[[nodiscard]] Strike first_strike(const BellAndClapper<double>& bell, const StrikeStart& start);

}  // namespace revchain

#include "revchain/paper/bell.hpp"
#include "revchain/paper/bell_strike.hpp"
