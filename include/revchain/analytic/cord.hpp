// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/cord.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/special/heavy_chain.hpp"
#include "revchain/special/tapered_chain.hpp"
#include "revchain/special/tip_mass.hpp"

namespace revchain {

namespace detail {

/// A mode of a uniform cord without tip weight.
struct HeavyChainMode {
    Index mode;
    double length;

    double conical_height() const { return analytic::heavy_chain::detail::height(mode, length); }
    double shape(double s) const { return analytic::heavy_chain::shape(s, mode, length); }
    double slope(double s) const { return analytic::heavy_chain::slope(s, mode, length); }
    Vector<double> nodes() const { return analytic::heavy_chain::nodes(mode, length); }
    Vector<double> vertical_points() const { return analytic::heavy_chain::vertical_points(mode, length); }
};

/// The method that finds the modes of a cord, and its accuracy.
struct CordMethod {
    std::string_view name;
    double error_bound;
    bool is_closed;  ///< whether mode k is known without those before it
};

inline CordMethod method_for(const Cord& cord) {
    const double ulp = epsilon<double>();
    if (cord.is_uniform() && cord.tip_weight() == 0) return {"zeros of J_0", 3 * ulp, true};
    if (cord.is_uniform()) return {"zeros of a cross product of Bessel functions", 2 * ulp, true};
    if (cord.exponent() && cord.tip_weight() == 0) return {"zeros of J_p", 3 * ulp, true};
    return {"power series", 4e-15, false};
}

/// The result of `f` for one mode in closed form.
template <class F>
auto in_closed_form(const Cord& cord, Index mode, const F& f) {
    namespace forms = analytic;
    if (!cord.is_uniform()) return f(forms::tapered_chain::Mode(mode, cord.length(), *cord.exponent()));
    if (cord.tip_weight() == 0) return f(HeavyChainMode{mode, cord.length()});
    return f(forms::tip_mass::Mode(mode, cord.length(), cord.tip_length()));
}

inline double closed_height(const Cord& cord, Index mode) {
    return in_closed_form(cord, mode, [](const auto& form) { return form.conical_height(); });
}

/// The result of `f` for the mode at index j.
template <class F>
auto with_mode(std::string_view place, const CordModes& modes, Index j, const F& f) {
    if (j < 0 || j >= modes.size())
        throw_invalid(place, "the index must be from 0 to " + std::to_string(modes.size() - 1), j);
    if (method_for(modes.cord).is_closed) return in_closed_form(modes.cord, modes.first + j, f);
    return f(finite::CordModeShape(finite::ContinuousChain(modes.cord), modes.conical_height[j], modes.first + j));
}

/// The number of conical heights that exceed `height`. Heights in closed form fall with the number of the mode.
inline Index modes_above(const Cord& cord, double height) {
    if (!method_for(cord).is_closed) return finite::critical_heights_above(finite::ContinuousChain(cord), height);
    constexpr Index most = 1'000'000'000'000'000;
    Index above = 0, not_above = 1;  // numbers of modes
    while (closed_height(cord, not_above) > height) {
        above = not_above, not_above *= 2;
        if (not_above > most)
            throw_invalid("count_modes", "there are more than 1e15 modes above conical height", height);
    }
    while (not_above - above > 1) {
        const Index middle = above + (not_above - above) / 2;
        (closed_height(cord, middle) > height ? above : not_above) = middle;
    }
    return above;
}

}  // namespace detail

inline CordModes modes(const Cord& cord, const ModesOptions<double>& options) {
    detail::check(options);
    if (options.certify)
        detail::throw_invalid("modes", "certificates of a Cord are not available; count_modes counts at any height");
    if (options.count == all_modes)
        detail::throw_invalid("modes", "a cord has infinitely many modes; give count, or a window that ends");
    const auto within = [&](const HeightWindow<double>& window) {
        if (!(window.low > 0))
            detail::throw_invalid("modes",
                                  "a cord has infinitely many modes; the window must end at a height above 0, "
                                  "or at a finite speed; its lowest height is",
                                  window.low);
        return detail::modes_within(window, 0, [&](double height) { return detail::modes_above(cord, height); });
    };
    const ModeRange range = detail::chosen(all_modes, options, within, [&](const SpeedWindow<double>& window) {
        return within(detail::window_of_heights(window, options.gravity));
    });
    const detail::CordMethod method = detail::method_for(cord);
    CordModes result{cord, range.first, Vector<double>(range.count),
                     Vector<double>::Constant(range.count, method.error_bound), std::string(method.name)};
    if (options.rtol && !(method.error_bound <= *options.rtol)) result.status = Status::tolerance_not_met;
    if (!method.is_closed && range.count > 0)
        result.conical_height =
            finite::critical_heights(finite::ContinuousChain(cord), range.first - 1 + range.count).tail(range.count);
    for (Index j = 0; method.is_closed && j < range.count; ++j) {
        result.conical_height[j] = detail::closed_height(cord, range.first + j);
        detail::advance(options.progress, static_cast<double>(j + 1) / static_cast<double>(range.count));
    }
    return result;
}

inline Index count_modes(const Cord& cord, const CountOptions<double>& options) {
    return detail::modes_above(cord, detail::height_given("count_modes", options));
}

namespace detail {

/// f at each place; it can be interrupted.
template <class F>
Vector<double> at_places(const Vector<double>& places, const F& f) {
    Vector<double> found(places.size());
    for (Index i = 0; i < places.size(); ++i) {
        if (i % 1024 == 0) look();
        found[i] = f(places[i]);
    }
    return found;
}

}  // namespace detail

inline double CordModes::offset(Index j, double s) const {
    return detail::with_mode("CordModes::offset", *this, j, [&](const auto& mode) { return mode.shape(s); });
}

inline Vector<double> CordModes::offset(Index j, const Vector<double>& s) const {
    return detail::with_mode("CordModes::offset", *this, j, [&](const auto& mode) {
        return detail::at_places(s, [&](double at) { return mode.shape(at); });
    });
}

inline double CordModes::slope(Index j, double s) const {
    return detail::with_mode("CordModes::slope", *this, j, [&](const auto& mode) { return mode.slope(s); });
}

inline Vector<double> CordModes::slope(Index j, const Vector<double>& s) const {
    return detail::with_mode("CordModes::slope", *this, j, [&](const auto& mode) {
        return detail::at_places(s, [&](double at) { return mode.slope(at); });
    });
}

inline Vector<double> CordModes::nodes(Index j) const {
    return detail::with_mode("CordModes::nodes", *this, j, [](const auto& mode) { return mode.nodes(); });
}

inline Vector<double> CordModes::vertical_points(Index j) const {
    return detail::with_mode("CordModes::vertical_points", *this, j,
                             [](const auto& mode) { return mode.vertical_points(); });
}

inline Vector<double> CordModes::angular_speed(double gravity) const {
    return conical_height.unaryExpr([=](double height) { return conical_pendulum::angular_speed(height, gravity); });
}

inline Vector<double> CordModes::period(double gravity) const {
    return conical_height.unaryExpr([=](double height) { return conical_pendulum::period(height, gravity); });
}

inline Swing swing(const Cord&, const SwingOptions&) {
    detail::throw_invalid("swing",
                          "a Cord cannot swing yet; cut it into links, as Chain::uniform_rods and "
                          "Chain::tapered do, and ask swing of that chain");
}

inline Tuned tune(const Cord&, const TuneOptions&) {
    detail::throw_invalid("tune",
                          "a Cord cannot be tuned yet; the heights of a cord of one density go with its length, "
                          "so that length times wanted height over modes(cord) gives the length");
}

inline Explanation explain(const Cord&, const ModesOptions<double>&) {
    detail::throw_invalid("explain",
                          "modes of a Cord have one method for each kind of cord; CordModes::method names it");
}

}  // namespace revchain
