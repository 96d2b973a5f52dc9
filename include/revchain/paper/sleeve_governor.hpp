// SPDX-License-Identifier: MPL-2.0
// Defines what sleeve_governor.hpp declares.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "revchain/numeric/interval.hpp"
#include "revchain/numeric/zero_between.hpp"
#include "revchain/sleeve_governor.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// A function of the inclination with its first two derivatives. X is a number or an interval.
template <class X>
struct Jet {
    X value{}, slope{}, bend{};

    Jet() = default;
    Jet(const X& v) : value(v) {}  // NOLINT(google-explicit-constructor): a constant
    Jet(const X& v, const X& s, const X& b) : value(v), slope(s), bend(b) {}

    friend Jet operator+(const Jet& x, const Jet& y) {
        return {x.value + y.value, x.slope + y.slope, x.bend + y.bend};
    }
    friend Jet operator-(const Jet& x, const Jet& y) {
        return {x.value - y.value, x.slope - y.slope, x.bend - y.bend};
    }
    friend Jet operator*(const Jet& x, const Jet& y) {
        return {x.value * y.value, x.slope * y.value + x.value * y.slope,
                x.bend * y.value + X(2.0) * x.slope * y.slope + x.value * y.bend};
    }
    /// Returns the ratio of the slopes or, where both vanish, its limit: that of the bends.
    friend X slope_ratio(const Jet& x, const Jet& y) {
        return x.slope == 0 && y.slope == 0 ? x.bend / y.bend : x.slope / y.slope;
    }
    /// Returns the square root.
    friend Jet root(const Jet& x) {
        using std::sqrt;
        const X r = sqrt(x.value), s = x.slope / (X(2.0) * r);
        return {r, s, (x.bend - X(2.0) * s * s) / (X(2.0) * r)};
    }
};

}  // namespace detail

/// The energies of a governor at an inclination with this sine and cosine.
struct SleeveGovernor::Motion {
    template <class X>
    struct Of {
        detail::Jet<X> radius, ball, sleeve;  ///< of a ball from the axis; heights
        detail::Jet<X> potential, inertia;
    };
    /// Sets what the sine and cosine of the inclination give. The height of the sleeve is measured
    /// from `from`.
    template <class X>
    static Of<X> of(const GovernorData& d, const X& s, const X& c, double from) {
        using J = detail::Jet<X>;
        const J sine(s, c, -s), cosine(c, -s, -c);
        const auto number = [](double x) { return J(X(x)); };
        Of<X> m;
        m.radius = number(d.pivot_offset) + number(d.arm) * sine;
        if (d.sleeve_arm > 0) {
            m.ball = number(d.arm) * cosine, m.sleeve = number(d.sleeve_arm) * sine;
        } else {
            m.ball = number(-d.arm) * cosine;
            if (d.lower_arm > 0) {
                const double joint = d.joint > 0 ? d.joint : d.arm;
                const J out = number(d.pivot_offset - d.sleeve_offset) + number(joint) * sine;
                const J across = (number(d.lower_arm) - out) * (number(d.lower_arm) + out);
                m.sleeve = number(-joint) * cosine - root(across);
            }
        }
        m.sleeve = m.sleeve - number(from);
        const double balls = d.balls * d.ball_mass;
        m.potential = number(balls * d.gravity) * m.ball +
                      (number(d.sleeve_mass * d.gravity + d.spring_force) +
                       number(d.spring_stiffness / 2) * m.sleeve) *
                          m.sleeve;
        m.inertia = number(balls) * m.radius * m.radius;
        return m;
    }
    static double start(const GovernorData& d) { return of<double>(d, 0, 1, 0).sleeve.value; }
    static bool reaches(const GovernorData& d, double sine) {
        return d.lower_arm == 0 || std::abs(across(d, sine)) < d.lower_arm;
    }
    /// Distance of the links' joint beyond the sleeve's pivot, which increases with the sine.
    static double across(const GovernorData& d, double sine) {
        return d.pivot_offset - d.sleeve_offset + (d.joint > 0 ? d.joint : d.arm) * sine;
    }
};

inline SleeveGovernor::SleeveGovernor(const GovernorData& data) : data_(data) {
    using namespace detail;
    constexpr std::string_view place = "SleeveGovernor";
    const GovernorData& d = data;
    require_positive(place, "ball mass", d.ball_mass, "arm", d.arm, "gravity", d.gravity);
    require_not_negative(place, "lower arm", d.lower_arm, "joint", d.joint, "sleeve arm",
                         d.sleeve_arm, "sleeve mass", d.sleeve_mass, "spring stiffness",
                         d.spring_stiffness, "friction", d.friction);
    require_finite(place, "pivot offset", d.pivot_offset, "sleeve offset", d.sleeve_offset,
                   "spring force", d.spring_force);
    if (d.balls < 1) throw_invalid(place, "balls must be at least 1", d.balls);
    if (!(d.shaft_inertia >= 0))
        throw_invalid(place, "shaft inertia must not be negative", d.shaft_inertia);
    const bool has_sleeve = d.lower_arm > 0 || d.sleeve_arm > 0;
    if (d.lower_arm > 0 && d.sleeve_arm > 0)
        throw_invalid(place, "sleeve arm must be 0: give lower_arm or sleeve_arm, not both",
                      d.sleeve_arm);
    for (const auto& [name, value] :
         {std::pair("sleeve mass", d.sleeve_mass), std::pair("friction", d.friction),
          std::pair("spring stiffness", d.spring_stiffness),
          std::pair("spring force", d.spring_force)})
        if (!has_sleeve && value != 0)
            throw_invalid(
                place, std::string(name) + " needs a sleeve: give lower_arm or sleeve_arm", value);
    if (!Motion::reaches(d, 0))
        throw_invalid(place, "lower arm must be long enough to reach the sleeve at inclination 0",
                      d.lower_arm);
}

inline GovernorPoint SleeveGovernor::at(double inclination, std::optional<double> turned) const {
    using namespace detail;
    constexpr std::string_view place = "SleeveGovernor::at";
    require_finite(place, "inclination", inclination);
    const GovernorData& d = data_;
    const double s = std::sin(inclination), c = std::cos(inclination);
    if (!(std::abs(inclination) < std::numbers::pi / 2) || !Motion::reaches(d, s))
        throw_invalid(place, "the arms cannot reach this inclination", inclination);
    const auto m = Motion::of<double>(d, s, c, Motion::start(d));
    GovernorPoint p;
    p.inclination = inclination, p.ball_radius = m.radius.value, p.lift = m.sleeve.value;
    p.height = d.arm * c + (d.pivot_offset == 0 ? 0 : d.pivot_offset * c / s);
    const auto square_at = [&](double friction) {
        return 2 * slope_ratio(m.potential + Jet<double>(friction) * m.sleeve, m.inertia);
    };
    const auto root = [](double x) {
        return x >= 0 ? std::sqrt(x) : std::numeric_limits<double>::quiet_NaN();
    };
    const double one = square_at(-d.friction), two = square_at(d.friction);
    p.speed = turned.value_or(root(square_at(0)));
    p.high_speed = root(std::max(one, two));
    p.low_speed = p.high_speed >= 0 && std::min(one, two) < 0 ? 0 : root(std::min(one, two));
    const double square = p.speed * p.speed;
    double pull = m.potential.bend - square / 2 * m.inertia.bend;
    p.stable = pull > 0;
    if (std::isfinite(d.shaft_inertia) && m.inertia.slope != 0)
        pull += square * m.inertia.slope * m.inertia.slope / (d.shaft_inertia + m.inertia.value);
    const double moving =
        d.balls * d.ball_mass * (m.radius.slope * m.radius.slope + m.ball.slope * m.ball.slope) +
        d.sleeve_mass * m.sleeve.slope * m.sleeve.slope;
    p.period = pull > 0 ? 2 * std::numbers::pi * std::sqrt(moving / pull)
                        : std::numeric_limits<double>::quiet_NaN();
    return p;
}

inline std::vector<GovernorPoint> SleeveGovernor::equilibria(double speed, bool* complete) const {
    using namespace detail;
    using I = Interval<double>;
    require_not_negative("SleeveGovernor::equilibria", "speed", speed);
    const GovernorData& d = data_;
    const double from = Motion::start(d), square = speed * speed;
    constexpr double fastest = 1e100;  // rad/s: beyond it squares leave the range of double
    if (!(speed <= fastest))
        throw_invalid("SleeveGovernor::equilibria", "speed must be at most 1e100", speed);
    bool all = true;
    std::vector<GovernorPoint> found;
    const auto left = [&](const I& sine) {  // the derivative of the potential at this speed
        const I cosine = sqrt(I(1.0) - revchain::square(sine));
        const auto m = Motion::of<I>(d, sine, cosine, from);
        const I half(square / 2);
        return std::pair(m.potential.slope - half * m.inertia.slope,
                         m.potential.bend - half * m.inertia.bend);
    };
    const auto exact = [&](double angle) {
        const auto m = Motion::of<double>(d, std::sin(angle), std::cos(angle), from);
        return std::pair(m.potential.slope - square / 2 * m.inertia.slope,
                         m.potential.bend - square / 2 * m.inertia.bend);
    };
    // The balls stay on their side of the axis.
    const double least = std::clamp(-d.pivot_offset / d.arm, -1.0, 1.0) + 0.0;
    // Where the arms reach farthest, they or the lower links are straight across. The pull of the
    // links then grows without bound, or the balls move only up: the force turns the arms back.
    const auto add_at_reach = [&](double low, double high) {
        const double a = std::asin(low), far = std::asin(std::min(high, 1.0));
        if (!(exact(a).first < 0)) return;
        const auto side = [&](double angle) {
            return Motion::reaches(d, std::sin(angle)) ? -1 : 1;
        };
        const double end = side(far) < 0 ? far : halved(a, far, side).first;
        if (end > a && exact(end).first > 0)
            found.push_back(at(zero_between(a, end, exact), speed));
        else
            all = false;
    };
    int cells = 0;
    const auto search = [&](const auto& self, double low, double high, int depth) -> void {
        if (++cells > 100'000) {  // the force vanishes almost everywhere
            all = false;
            return;
        }
        const bool reaches_low = Motion::reaches(d, low), reaches_high = Motion::reaches(d, high);
        if (!reaches_low && !reaches_high && depth > 4 &&
            (Motion::across(d, low) > 0) == (Motion::across(d, high) > 0))
            return;  // too far on one side
        const double middle = low + (high - low) / 2;
        const double width = high - low;
        if (depth > 48 || (depth > 30 && !(Motion::reaches(d, low - 2 * width) &&
                                           Motion::reaches(d, high + 2 * width)))) {
            if (depth > 48 && reaches_low && reaches_high) all = false;
            if (reaches_low) add_at_reach(low, high);
            return;
        }
        if (reaches_low && reaches_high) {
            const auto [force, stiffness] = left({low, high});
            if (!force.may_vanish()) return;
            if (!stiffness.may_vanish()) {
                const double a = std::asin(low), b = std::asin(high);
                const double at_low = exact(a).first, at_high = exact(b).first;
                if (at_low * at_high > 0 || (at_high == 0 && high < 1)) return;  // in the next cell
                const double sign = stiffness.positive() ? 1 : -1;
                const auto rising = [&](double x) {
                    const auto [value, slope] = exact(x);
                    return std::pair(sign * value, sign * slope);
                };
                const double angle = at_low == 0 ? a : zero_between(a, b, rising);
                if (std::abs(angle) < std::numbers::pi / 2) found.push_back(at(angle + 0.0, speed));
                return;
            }
        }
        self(self, low, middle, depth + 1), self(self, middle, high, depth + 1);
    };
    search(search, least, 1.0, 0);
    if (complete != nullptr) *complete = all;
    return found;
}

inline GovernorEffort SleeveGovernor::effort(double inclination, double change) const {
    using namespace detail;
    constexpr std::string_view place = "SleeveGovernor::effort";
    require_positive(place, "change", change);
    const GovernorPoint now = at(inclination);
    const GovernorData& d = data_;
    if (d.lower_arm == 0 && d.sleeve_arm == 0)
        throw_invalid(place, "needs a sleeve: give lower arm or sleeve arm; arm", d.arm);
    if (!(now.speed > 0 && std::isfinite(now.speed)))
        throw_invalid(place,
                      "inclination must have an equilibrium at a speed above 0; its speed is",
                      now.speed);
    const auto m =
        Motion::of<double>(d, std::sin(inclination), std::cos(inclination), Motion::start(d));
    GovernorEffort result;
    // The force that holds the sleeve at the new speed; it falls to 0 while the sleeve is lifted.
    result.effort = now.speed * now.speed * (change + change * change / 2) *
                    slope_ratio(m.inertia, m.sleeve) / 2;
    result.lift = result.power = std::numeric_limits<double>::quiet_NaN();
    for (const GovernorPoint& next : equilibria((1 + change) * now.speed))
        if (next.stable && next.inclination > inclination) {
            result.lift = next.lift - now.lift, result.power = result.effort * result.lift;
            break;
        }
    return result;
}

}  // namespace revchain
