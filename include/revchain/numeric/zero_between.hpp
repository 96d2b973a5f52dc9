// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/scalar.hpp"

/// This header finds zeros of functions of one number in known brackets. It works for all scalars,
/// unlike other libraries.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// A number of halvings that exceeds the need of any bracket of numbers in T.
template <Real T>
inline constexpr int most_halvings = 2 * (std::numeric_limits<T>::max_exponent -
                                          std::numeric_limits<T>::min_exponent);

/// The last step of Newton's method. The zero is `from - step`, in two words to more digits than T.
template <Real T>
struct NewtonStep {
    T from, step;
};

/// Returns the zero of a function that increases through it once between `low` and `high`, to a
/// relative `enough`: Newton's method from `start`, bracketed by halving. `value_and_slope(x)`
/// returns a pair.
template <Real T, class F>
NewtonStep<T> newton_between(T low, T high, const F& value_and_slope, T start, T enough) {
    using std::abs;
    T x = start, last = high - low;
    for (int round = 0; round < most_halvings<T>; ++round) {
        const auto [value, slope] = value_and_slope(x);
        if (value == T(0)) break;
        (value < T(0) ? low : high) = x;
        const T step = value / slope;
        if (abs(step) <= enough * abs(x)) return {x, step};
        const auto is_within = [&](const T& y) { return y > low && y < high; };
        T next = x - step;
        // A step that does not shrink by half is no better than halving.
        if (!is_within(next) || abs(step) > last / T(2)) next = low + (high - low) / T(2);
        last = abs(next - x);
        x = next;
        if (last <= epsilon<T>() / T(2) * abs(next) || !is_within(next)) break;
    }
    return {x, T(0)};
}

/// Returns the zero that `newton_between` finds from the middle, to the last digit of T or
/// `enough`. Cost: about six evaluations, and one for each halving where Newton's method fails.
template <Real T, class F>
T zero_between(T low, T high, const F& value_and_slope, T enough = epsilon<T>() / T(2)) {
    const T middle = low + (high - low) / T(2);
    const NewtonStep<T> last = newton_between(low, high, value_and_slope, middle, enough);
    return last.from - last.step;
}

/// Returns zeros of a function, one above each of `places` and below the next of them or `end`. The
/// function increases through the first, third, ... zero and decreases through the others.
template <class F>
Vector<double> zeros_between(const Vector<double>& places, double end, const F& value_and_slope) {
    Vector<double> zeros(places.size());
    for (Index i = 0; i < places.size(); ++i) {
        check_interrupt();
        const double sign = i % 2 == 0 ? 1 : -1;
        const double next = i + 1 < places.size() ? places[i + 1] : end;
        zeros[i] = zero_between(places[i], next, [&](double x) {
            const auto [value, slope] = value_and_slope(x);
            return std::pair(sign * value, sign * slope);
        });
    }
    return zeros;
}

template <Real T>
struct ValueAt {
    T x, value;
};

/// Two numbers at which a function has different signs, or is 0 at one of them.
template <Real T>
struct SignChange {
    ValueAt<T> low, high;
};

/// Returns a sign change, from `guess` by factors of 2, of a function that increases through 0
/// above 0.
template <Real T, class F>
SignChange<T> sign_change_near(T guess, const F& value) {
    const auto at = [&](const T& x) { return ValueAt<T>{x, value(x)}; };
    SignChange<T> found{at(guess), {}};
    found.high = found.low;
    for (int i = 0; i < most_halvings<T> && found.high.value < T(0); ++i)
        found = {found.high, at(found.high.x * T(2))};
    for (int i = 0; i < most_halvings<T> && found.low.value > T(0); ++i)
        found = {at(found.low.x / T(2)), found.low};
    return found;
}

/// The width and the value at which a search ends. It always ends at the last digit.
template <Real T>
struct Enough {
    T width{}, value{};
};

/// Returns the zero within a sign change, without a slope: inverse quadratic interpolation, and
/// halving where three points show no suitable curvature. The result is NaN if the signs agree, and
/// as soon as `value(x)` is NaN. Source: T. R. Chandrupatla (1997),
/// doi:10.1016/S0965-9978(96)00051-8, with a first step along the chord. Cost: five to nine
/// evaluations of a smooth function.
template <Real T, class F>
T zero_between(const SignChange<T>& bracket, const F& value, const Enough<T>& enough = {}) {
    using std::abs;
    // a is the last point, b a point on the other side of the zero, c the last replaced point.
    ValueAt<T> a = bracket.high, b = bracket.low, c = b;
    if (a.value != T(0) && b.value != T(0) && (a.value < T(0)) == (b.value < T(0)))
        return std::numeric_limits<T>::quiet_NaN();
    T share = a.value / (a.value - b.value);  // share of the way from a to b
    if (!(share >= T(0))) share = T(0.5);     // for an infinite value
    for (int round = 0; round < most_halvings<T>; ++round) {
        const ValueAt<T>& nearest = abs(a.value) < abs(b.value) ? a : b;
        const T width = b.x - a.x;
        const T least = (enough.width + epsilon<T>() * abs(nearest.x)) / abs(width);
        if (abs(nearest.value) <= enough.value || !(least < T(0.5))) return nearest.x;
        const T x = a.x + std::clamp(share, least, T(1) - least) * width;
        const ValueAt<T> now{x, value(x)};
        if (now.value != now.value) return now.value;
        const bool same_side = (now.value < T(0)) == (a.value < T(0));
        c = same_side ? a : b;
        if (!same_side) b = a;
        a = now;
        const T at_a = a.value, at_b = b.value, at_c = c.value;
        const T along = (a.x - b.x) / (c.x - b.x), part = (at_a - at_b) / (at_c - at_b);
        share = T(0.5);
        if (part * part < along && (T(1) - part) * (T(1) - part) < T(1) - along)
            share = at_a / (at_b - at_a) * (at_c / (at_b - at_c)) +
                    (c.x - a.x) / (b.x - a.x) * (at_a / (at_c - at_a)) * (at_b / (at_c - at_b));
    }
    return a.x;
}

/// Returns the state between two others at which `off(state)` vanishes, to a share of 2e-16 or
/// `enough`. `off` is `at_low` and `at_high` at these two. `at(share)` returns the state at a share
/// of the way, or nothing.
template <class At, class Off>
auto state_between(double at_low, double at_high, const At& at, const Off& off, double enough = 0) {
    decltype(at(0.0)) found;
    const auto value = [&](double share) {
        found = at(share);
        return found ? off(*found) : std::numeric_limits<double>::quiet_NaN();
    };
    const SignChange<double> ends{{0, at_low}, {1, at_high}};
    zero_between(ends, value, {.width = 2e-16, .value = enough});
    return found;
}

/// Returns two numbers of any kind between which something changes, after at most 200 halvings.
/// `side(x)` is negative if x may replace `low`, and positive if it may replace `high`. It is 0,
/// which ends the search, if that cannot be decided.
template <class N, class F>
std::pair<N, N> halved(N low, N high, const F& side) {
    for (int round = 0; round < 200; ++round) {
        const N middle = low + (high - low) / 2;
        if (!(middle > low && middle < high)) break;
        const int found = side(middle);
        if (found == 0) break;
        (found < 0 ? low : high) = middle;
    }
    return {low, high};
}

}  // namespace revchain::detail
