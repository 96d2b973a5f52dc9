// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/sensitivity.hpp"

/// The value of one datum of a chain that gives one of its modes a wanted speed.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto t = revchain::tune(chain, {.mode = 1,
///                                           .link = 0,
///                                           .datum = revchain::Datum::length_in_proportion,
///                                           .angular_speed = 3.0});
///     t.value;        // 0.924471 m: the length of the lowest link; t.error_bound is proved
///     t.chain;        // the chain with that length
namespace revchain::inline REVCHAIN_BUILD {

class Rig;   // revchain/rig.hpp
class Cord;  // revchain/cord.hpp
template <class System>
class Held;  // revchain/held.hpp

/// The mode, its wanted height or speed (give one), the datum to change, and its range.
struct TuneOptions {
    Index mode = 1;                                       ///< from 1 for the slowest
    Index link = 0;                                       ///< from 0, the lowest
    Datum datum = Datum::weight;                          ///< of that link
    std::optional<double> conical_height{};               ///< give this or `angular_speed`
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    /// The range searched. Absent: for a weight or length, from 1/1000 to 1000 times the present
    /// value (for a massless link, of the whole chain's weight). For a centroid or radius of
    /// gyration, from 0 to the link's length or the present value, if that is outside.
    std::optional<double> low{}, high{};
};

enum class TuneStatus {
    found,      ///< `value` gives the mode the wanted height
    no_value,   ///< proved: no value between `low` and `high` gives it
    undecided,  ///< no value was found, but it is not proved that there is none
};

[[nodiscard]] inline std::string_view to_string(TuneStatus status) noexcept {
    constexpr std::string_view names[]{"found", "no_value", "undecided"};
    return names[static_cast<std::size_t>(status)];
}

struct Tuned {
    TuneStatus status = TuneStatus::undecided;
    double present{};                                         ///< the datum of the chain given
    double value = std::numeric_limits<double>::quiet_NaN();  ///< nearest to `present`
    /// Absolute error bound of `value`: proved counts at this distance on either side differ.
    double error_bound = std::numeric_limits<double>::infinity();
    std::vector<double> values{};  ///< all values found, ascending
    /// Proved: `values` has every solution between `low` and `high`. False for a weight, whose
    /// nearest solution on each side is searched.
    bool complete = false;
    double low{}, high{};  ///< the range searched, without the part in which a link would stand
    /// Extremes of the mode's height seen in that range, for a weight, and if no value is found.
    double lowest_height = std::numeric_limits<double>::infinity();
    double highest_height = 0;
    std::optional<Chain<double>> chain{};  ///< with `value` in place
};

/// The value of a datum that gives a mode a conical height or whirl speed.
///
/// At a given height the chain below and above a link acts as a spring at each of its pins. A
/// length, a centroid or a radius of gyration with this height is then a root of an equation of
/// degree 1 or 2. Proved counts on each side of a root assign it to a mode and bound its error. For
/// a weight, on each side steps lead to the nearest value or to one within 7 % of it (after 60
/// steps within a factor of 3.5), or the side is given up. Accuracy: `error_bound`, proved.
/// Measured: 1 ulp of the value if its logarithmic derivative exceeds 1e-11. Cost: some counts of
/// modes, O(N) each; for a weight, of heights. Throws InvalidArgument for numbers out of range, for
/// weights more than 1e123 apart, unless exactly one of height and speed is given, and for a range
/// in which a link always stands.
REVCHAIN_DECLARE
[[nodiscard]] Tuned tune(const Chain<double>& chain, const TuneOptions& options);

/// Deleted: `tune` is for chains; the Python function also takes rigs, cords and held systems. For
/// a rig use `momentum_for_speed` or `stiffness_for_speed` (sensitivity.hpp).
Tuned tune(const Rig& rig, const TuneOptions& options) = delete;
Tuned tune(const Cord& cord, const TuneOptions& options) = delete;
template <class System>
Tuned tune(const Held<System>& held, const TuneOptions& options) = delete;

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/tune.hpp"
#endif
