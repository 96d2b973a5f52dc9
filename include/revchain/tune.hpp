// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/rig.hpp"
#include "revchain/sensitivity.hpp"

/// The value of one datum of a chain that gives one of its modes a wanted speed.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto t = revchain::tune(chain, {.mode = 1, .link = 1, .datum = revchain::Datum::length_in_proportion,
///                                           .angular_speed = 3.0});
///     t.value;        // the length of the lowest link, m; t.error_bound is proved
///     t.chain;        // the chain with that length
namespace revchain {

/// Mode `mode` is to have this conical height or this whirl speed, by one datum of one link, between `low` and `high`.
struct TuneOptions {
    Index mode = 1;                                       ///< from 1 for the slowest
    Index link = 1;                                       ///< from 1 for the lowest
    Datum datum = Datum::weight;                          ///< of that link
    std::optional<double> conical_height{};               ///< give this or `angular_speed`
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    /// The range searched. Absent: a thousandth and a thousand times the present value of a weight or length (of the
    /// whole chain's weight for a massless link); of a centroid and a radius of gyration 0 and the link's length, or as
    /// far as the present value.
    std::optional<double> low{}, high{};
};

enum class TuneStatus {
    found,      ///< `value`
    no_value,   ///< none does between `low` and `high`
    undecided,  ///< none was found, and that there is none could not be proved
};

inline std::string_view to_string(TuneStatus status) {
    return status == TuneStatus::found ? "found" : status == TuneStatus::no_value ? "no_value" : "undecided";
}

struct Tuned {
    TuneStatus status = TuneStatus::undecided;
    double present{};                                         ///< the datum of the chain given
    double value = std::numeric_limits<double>::quiet_NaN();  ///< nearest to the present one that does; else NaN
    /// Absolute: proved counts on either side that far away differ, so that the exact value lies between.
    double error_bound = std::numeric_limits<double>::infinity();
    std::vector<double> values{};  ///< those found, ascending
    /// `values` are all there are between `low` and `high`: every root of the quadratic is a mode's by proved counts.
    /// Not said of weights, where the nearest on each side of the present value are found.
    bool complete = false;
    double low{}, high{};                                            ///< searched between
    double lowest_height = std::numeric_limits<double>::infinity();  ///< of those reached between, the extremes seen
    double highest_height = 0;
    std::optional<Chain<double>> chain{};  ///< with `value` in place
};

/// Which value of a datum gives a mode a conical height or whirl speed.
///
/// At a given height the chain below and above a link is a spring at each of its pins. For a length, a centroid or a
/// radius of gyration the values wanted are therefore roots of a quadratic at most, of any mode; proved counts on each
/// side tell which of them is this mode's, and how near the exact one. A weight bears on all links above: there the
/// nearest value on each side is approached in steps that provably pass none.
/// Accuracy: `error_bound`, proved; 1 to 4 ulp of the value where its logarithmic derivative is not small, measured
/// (tests/cpp/tune.cpp). Where no value is found, the extremes of the heights are those seen at 33 places.
/// Cost: some 10 to 60 counts of O(N); of a weight some 10 to 100 heights.
/// Throws InvalidArgument for numbers out of range, unless exactly one of height and speed is given, for a range in
/// which the link would stand, and where weights are more than 1e123 apart.
Tuned tune(const Chain<double>& chain, const TuneOptions& options);

/// Throws InvalidArgument: a rig cannot be tuned yet.
Tuned tune(const Rig& rig, const TuneOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/tune.hpp"
#endif
