// SPDX-License-Identifier: GPL-3.0-or-later
// Defines what cord.hpp declares.
#pragma once

#include "revchain/cord.hpp"
#include "revchain/finite/branch/lowest_height.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/held_tension.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/special/chain_arguments.hpp"
#include "revchain/special/heavy_chain.hpp"
#include "revchain/special/tapered_chain.hpp"
#include "revchain/special/taut_cord.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// A mode of a uniform cord without tip weight.
struct HeavyChainMode {
    Index mode;
    double length;

    double conical_height() const { return analytic::heavy_chain::detail::height(mode, length); }
    double shape(double s) const { return analytic::heavy_chain::shape(s, mode, length); }
    double slope(double s) const { return analytic::heavy_chain::slope(s, mode, length); }
    Vector<double> nodes() const { return analytic::heavy_chain::nodes(mode, length); }
    Vector<double> vertical_points() const {
        return analytic::heavy_chain::vertical_points(mode, length);
    }
};

/// A mode of a string without weight. `taut`: its tension as the length of cord that weighs as
/// much.
struct StringMode {
    Index mode;
    double length;
    Wide<double> taut;
    double number = static_cast<double>(mode), waves = number * std::numbers::pi;

    double conical_height() const {
        const Wide<double> one = Wide<double>(length) / (two_word_pi * number);
        return (one / taut * one).high;
    }
    double shape(double s) const {
        analytic::detail::check_place("CordModes::offset", s, length);
        return s < length ? std::sin(waves * s / length) : 0.0;
    }
    double slope(double s) const {
        analytic::detail::check_place("CordModes::slope", s, length);
        return waves / length * std::cos(waves * s / length);
    }
    Vector<double> nodes() const {
        return Vector<double>::LinSpaced(mode + 1, 0, length).segment(1, mode - 1);
    }
    Vector<double> vertical_points() const {
        return Vector<double>::LinSpaced(mode, 0.5, number - 0.5) * (length / number);
    }
};

/// The tension at the lower end as the length of cord that weighs as much.
REVCHAIN_LAZY
Wide<double> lower_length(std::string_view place, const Held<Cord>& of, double gravity) {
    return lower_tension(place, of, gravity).tension / Wide<double>(of.system().weight()) *
           Wide<double>(of.system().length());
}

/// A cord that hangs straight or is held straight.
struct StraightCord {
    const Cord& cord;
    std::optional<HeldBy> held{};
    Wide<double> taut{};  ///< of a held cord: `lower_length`

    StraightCord(const Cord& of) : cord(of) {}
    StraightCord(std::string_view place, const Held<Cord>& of, double gravity)
        : cord(of.system()), held(of.by()), taut(lower_length(place, of, gravity)) {}
    /// Makes a straight cord for shapes. A string has the same shapes under any gravity.
    explicit StraightCord(const CordModes& modes) : cord(modes.cord), held(modes.held) {
        if (held) taut = lower_length("CordModes", {cord, *held}, 1.0);
    }
};

/// The method that finds the modes of a cord, and its accuracy.
struct CordMethod {
    std::string_view name;
    double error_bound;
    bool is_closed;  ///< whether mode k is known without those before it
};

REVCHAIN_LAZY
CordMethod method_for(const StraightCord& straight) {
    const double ulp = epsilon<double>();
    const Cord& cord = straight.cord;
    if (straight.held && straight.held->weightless)
        return {"half waves of a string", 2 * ulp, true};
    if (cord.has_bob()) return {"power series", 4e-15, false};
    if (!straight.held && cord.is_uniform() && cord.tip_weight() == 0)
        return {"zeros of J_0", 3 * ulp, true};
    if (cord.is_uniform()) return {"zeros of a cross product of Bessel functions", 2 * ulp, true};
    if (cord.is_power() && cord.tip_weight() == 0) return {"zeros of J_p", 3 * ulp, true};
    return {"power series", 4e-15, false};
}

/// Returns the result of `f` for one mode in closed form.
template <class F>
auto in_closed_form(const StraightCord& straight, Index mode, const F& f) {
    const Cord& cord = straight.cord;
    const double length = cord.length();
    if (straight.held && straight.held->weightless)
        return f(StringMode{mode, length, straight.taut});
    if (straight.held) return f(analytic::taut_cord::Mode(mode, length, straight.taut));
    if (!cord.is_uniform()) return f(analytic::tapered_chain::Mode(mode, length, *cord.exponent()));
    if (cord.tip_weight() == 0) return f(HeavyChainMode{mode, length});
    return f(analytic::tip_mass::Mode(mode, length, cord.tip_length()));
}

REVCHAIN_LAZY
double closed_height(const StraightCord& straight, Index mode) {
    if (straight.held && !straight.held->weightless)
        return analytic::taut_cord::conical_height(mode, straight.cord.length(), straight.taut);
    return in_closed_form(straight, mode, [](const auto& form) { return form.conical_height(); });
}

/// Returns the result of `f` for the mode at index j.
template <class F>
auto with_mode(std::string_view place, const CordModes& modes, Index j, const F& f) {
    if (j < 0 || j >= modes.size())
        throw_invalid(place, "the index must be from 0 to " + std::to_string(modes.size() - 1), j);
    const StraightCord straight(modes);
    if (method_for(straight).is_closed) return in_closed_form(straight, modes.first + j, f);
    const finite::ContinuousChain chain(modes.cord);
    return f(finite::CordModeShape(chain, modes.conical_height[j], modes.first + j));
}

/// The number of conical heights that exceed `height`.
REVCHAIN_LAZY
Index modes_above(const StraightCord& straight, double height) {
    if (!method_for(straight).is_closed)
        return finite::critical_heights_above(finite::ContinuousChain(straight.cord), height);
    constexpr Index most = 1'000'000'000'000'000;
    Index above = 0, not_above = 1;  // numbers of modes
    while (closed_height(straight, not_above) > height) {
        above = not_above, not_above = std::min(2 * not_above, most);
        if (above == most)
            throw_invalid("count_modes", "there are more than 1e15 modes above conical height",
                          height);
    }
    const auto side = [&](Index mode) { return closed_height(straight, mode) > height ? -1 : 1; };
    return halved(above, not_above, side).first;
}

/// Returns the modes of a straight cord that the options select.
REVCHAIN_LAZY
CordModes modes_of(const StraightCord& straight, const CordModesOptions& options) {
    if (options.count == all_modes)
        throw_invalid("modes",
                      "a cord has infinitely many modes; give count, or a window that ends");
    double lowest = 1;
    if (options.conical_height) lowest = options.conical_height->low;
    if (options.angular_speed)
        lowest = window_of_heights(*options.angular_speed, options.gravity).low;
    if (!(lowest > 0))
        throw_invalid("modes",
                      "a cord has infinitely many modes; the window must end at a height above 0, "
                      "or at a finite speed; its lowest height is",
                      lowest);
    const auto above = [&](double height) { return modes_above(straight, height); };
    const ModeRange range = chosen(all_modes, options, above, [&](double speed) {
        return above(options.gravity / speed / speed);
    });
    const CordMethod method = method_for(straight);
    CordModes result{straight.cord, range.first, Vector<double>(range.count),
                     Vector<double>::Constant(range.count, method.error_bound),
                     std::string(method.name)};
    result.held = straight.held;
    if (!method.is_closed && range.count > 0) {
        const finite::ContinuousChain chain(straight.cord);
        result.conical_height =
            finite::critical_heights(chain, range.first - 1 + range.count).tail(range.count);
        // The first half wave of a mode is longer than its conical height, so the weight must be
        // accurate from that height up. If the density has no error, heights are within 2e-15.
        for (Index j = 0; j < range.count; ++j) {
            const double height = result.conical_height[j], from = std::min(height, chain.length);
            double& bound = result.error_bound[j];
            if (chain.density != nullptr)
                bound = std::max(bound, 2e-15 + 2 * chain.density->error(from) +
                                            chain.density->rounding_at_jumps(from));
            if (straight.cord.is_plain()) continue;
            bound +=
                3 * epsilon<double>() * finite::condition_of_places(chain, height, range.first + j);
        }
    }
    for (Index j = 0; method.is_closed && j < range.count; ++j) {
        result.conical_height[j] = closed_height(straight, range.first + j);
        advance(options.progress, static_cast<double>(j + 1) / static_cast<double>(range.count));
    }
    if (options.rtol && !(result.error_bound.array() <= *options.rtol).all())
        result.status = Status::tolerance_not_met;
    return result;
}

}  // namespace detail

REVCHAIN_DEFINE_ANALYTIC
CordModes modes(const Cord& cord, const CordModesOptions& options) {
    detail::check(options);
    return detail::modes_of(cord, options);
}

REVCHAIN_DEFINE_ANALYTIC
CordModes modes(const Held<Cord>& held, const CordModesOptions& options) {
    detail::check(options);
    return detail::modes_of({"modes", held, options.gravity}, options);
}

REVCHAIN_DEFINE_ANALYTIC
Index count_modes(const Cord& cord, const CountOptions<double>& options) {
    return detail::modes_above(cord, detail::height_given("count_modes", options));
}

REVCHAIN_DEFINE_ANALYTIC
Index count_modes(const Held<Cord>& held, const CountOptions<double>& options) {
    return detail::modes_above({"count_modes", held, options.gravity},
                               detail::height_given("count_modes", options));
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::offset(Index j, const Vector<double>& s) const {
    return detail::with_mode("CordModes::offset", *this, j, [&](const auto& mode) {
        return analytic::detail::for_numbers(s.size(),
                                             [&](Index i) { return mode.shape(s[i - 1]); });
    });
}

REVCHAIN_INLINE_ANALYTIC double CordModes::offset(Index j, double s) const {
    return detail::with_mode("CordModes::offset", *this, j,
                             [&](const auto& m) { return m.shape(s); });
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::slope(Index j, const Vector<double>& s) const {
    return detail::with_mode("CordModes::slope", *this, j, [&](const auto& mode) {
        return analytic::detail::for_numbers(s.size(),
                                             [&](Index i) { return mode.slope(s[i - 1]); });
    });
}

REVCHAIN_INLINE_ANALYTIC double CordModes::slope(Index j, double s) const {
    return detail::with_mode("CordModes::slope", *this, j,
                             [&](const auto& m) { return m.slope(s); });
}

REVCHAIN_INLINE_ANALYTIC double CordModes::bob_slope(Index j) const {
    if (!cord.has_bob())
        detail::throw_invalid("CordModes::bob_slope", "the cord has no bob: give a tip centroid");
    return detail::with_mode("CordModes::bob_slope", *this, j, [](const auto& mode) {
        if constexpr (requires { mode.bob_slope(); }) return mode.bob_slope();
        return 0.0;  // closed forms have none
    });
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::nodes(Index j) const {
    return detail::with_mode("CordModes::nodes", *this, j,
                             [](const auto& mode) { return mode.nodes(); });
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::vertical_points(Index j) const {
    return detail::with_mode("CordModes::vertical_points", *this, j,
                             [](const auto& mode) { return mode.vertical_points(); });
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::angular_speed(double gravity) const {
    return conical_height.unaryExpr(
        [=](double height) { return conical_pendulum::angular_speed(height, gravity); });
}

REVCHAIN_INLINE_ANALYTIC Vector<double> CordModes::period(double gravity) const {
    return conical_height.unaryExpr(
        [=](double height) { return conical_pendulum::period(height, gravity); });
}

namespace detail {

/// The height at which a mode leaves the vertical.
REVCHAIN_LAZY
double critical_height(std::string_view place, const Cord& cord, Index mode) {
    if (!(mode >= 1 && mode <= 100'000))
        throw_invalid(place, "mode must be from 1 to 100000", mode);
    return modes(cord, {.first = mode, .count = 1}).conical_height[0];
}

}  // namespace detail

REVCHAIN_DEFINE_ANALYTIC
CordBranch branch(const Cord& cord, const BranchOptions& options) {
    const double height = finite::lowest_height("branch", options);
    detail::require_positive("branch", "max_step", options.max_step);
    cord.require_no_bob("branch");
    finite::length_in_heights("branch", cord.length(), height);
    const double critical = detail::critical_height("branch", cord, options.mode);
    if (!(height < critical))
        detail::throw_invalid(
            "branch",
            "mode " + std::to_string(options.mode) + " leaves the vertical at the conical height " +
                detail::in_digits(critical) + ": the height to follow it to must be less",
            height);
    return finite::branch_of_mode(cord, critical, height, options);
}

REVCHAIN_DEFINE_ANALYTIC
CordBranches branches(const Cord& cord, const CordDiagramOptions& options) {
    const double height = finite::lowest_height("branches", options);
    finite::length_in_heights("branches", cord.length(), height);
    detail::require_positive("branches", "max_step", options.max_step);
    cord.require_no_bob("branches");
    if (options.lists < 1)
        detail::throw_invalid("branches", "lists must be at least 1", options.lists);
    Index count = count_modes(cord, {.conical_height = height});
    Vector<double> critical;
    if (count > 0) critical = modes(cord, {.count = count}).conical_height;
    while (count > 0 && !(height < critical[count - 1])) --count;  // rounding
    return finite::CordDiagram(cord, critical.head(count).eval(), height, options).run();
}

REVCHAIN_DEFINE_ANALYTIC
CordShapesOnBranch shapes_on_branch(const Cord& cord, const OnBranchOptions& options,
                                    std::size_t max_shapes) {
    cord.require_no_bob("steady_shape");
    const double critical = detail::critical_height("steady_shape", cord, options.mode);
    return finite::search_branch(cord, critical, options, max_shapes);
}

REVCHAIN_DEFINE_ANALYTIC
CordShape steady_shape(const Cord& cord, const OnBranchOptions& options) {
    CordShapesOnBranch found = shapes_on_branch(cord, options, 1);
    if (found.shapes.empty())
        detail::throw_invalid("steady_shape",
                              "the number is not met on the branch of mode " +
                                  std::to_string(options.mode) +
                                  ", which was followed to the conical height",
                              found.searched_to);
    return std::move(found.shapes.front());
}

}  // namespace revchain
