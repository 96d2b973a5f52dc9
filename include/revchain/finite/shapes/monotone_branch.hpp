// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/jet.hpp"

namespace revchain::finite {

/// A stretch of tangents along which R grows or falls throughout. Where stiffness +- turning > 0 there is but one, the
/// whole; else R falls in the middle and grows to its right and left, and meets at the joints
/// t = +-sqrt((|turning|/stiffness)^(2/3) - 1).
enum class Piece { whole, right, middle, left };

/// Whether R grows with t, and nowhere at less than a hundredth of `stiffness`. Where it is flatter about t = 0 than
/// that, it is taken by pieces, the middle one of them without width.
template <Real T>
bool grows_fast(const Interval<T>& stiffness, const Interval<T>& turning) {
    return turning.low >= T(0) || (Interval<T>(T(0.99)) * stiffness + turning).positive();
}

/// Tangents of a piece under a load R; `smooth` where all of R is met away from the joints, so that derivatives exist.
template <Real T>
struct Met {
    Interval<T> tangent;
    bool possible = true, smooth = true;
};

/// One link in one posture: which tangents carry which R.
template <Real T>
class Response {
   public:
    Response(const Link<Interval<T>>& link, const Interval<T>& height, Posture posture)
        : stiffness_(height * link.pull), turning_(link.length * link.cross) {
        if (posture == Posture::stands) turning_ = -turning_;
        plummet_ = turning_.low == T(0) && turning_.high == T(0);
        single_ = grows_fast(stiffness_, turning_);
        if (!single_) find_joint();
    }

    const Interval<T>& stiffness() const { return stiffness_; }
    const Interval<T>& turning() const { return turning_; }
    bool is_plummet() const { return plummet_; }
    bool is_single() const { return single_; }

    Interval<T> load(const Interval<T>& t) const {
        return plummet_ ? stiffness_ * t : stiffness_ * t + turning_ * detail::Sine<T>(t).value;
    }

    Met<T> met(Piece piece, const Interval<T>& R) const {
        if (piece == Piece::whole)
            return {plummet_ ? R / stiffness_ : detail::tangent(stiffness_, turning_, R), true, true};
        if (piece == Piece::right) return right_of_joint(R);
        if (piece == Piece::middle) return between_joints(R);
        Met<T> mirrored = right_of_joint(-R);
        mirrored.tangent = -mirrored.tangent;
        return mirrored;
    }

   private:
    Interval<T> at(const T& t) const { return load(Interval<T>(t)); }
    Interval<T> growth(const T& t) const { return stiffness_ + turning_ * detail::Sine<T>(Interval<T>(t)).slope; }

    /// The first of the numbers t, t + step, t + 5 step, ... that passes a test; NaN if none does before they overflow.
    template <class Test>
    static T first(T t, T step, const Test& passes) {
        for (int round = 0; round < std::numeric_limits<T>::max_exponent; ++round, step = step * T(4)) {
            if (passes(t)) return t;
            t = t + step;
        }
        return std::numeric_limits<T>::quiet_NaN();
    }

    void find_joint() {
        using std::cbrt;
        using std::sqrt;
        const double ratio = static_cast<double>(-turning_.low) / static_cast<double>(stiffness_.low);
        const double root = cbrt(ratio);
        T near(sqrt(std::max(0.0, root * root - 1)));
        for (int round = 0; round < 3 && near > T(0); ++round) {  // to the digits of T
            const T secant_squared = T(1) + near * near, secant = sqrt(secant_squared);
            const T slope = stiffness_.low + turning_.low / (secant * secant_squared);
            near = near + slope * secant * secant_squared * secant_squared / (T(3) * turning_.low * near);
            if (!(near > T(0))) near = T(0);
        }
        const T step = T(4) * epsilon<T>() * near + std::numeric_limits<T>::min();
        joint_.high = first(near, step, [&](const T& t) { return growth(t).positive(); });
        joint_.low = first(near, T(-step), [&](const T& t) { return !(t > T(0)) || growth(t).negative(); });
        if (!(joint_.low > T(0))) joint_.low = T(0);
        least_ = load(joint_);
    }

    /// Where R(t) = wanted, by Newton's method from a side from which it does not overshoot: R bends upwards for t > 0.
    T near(T t, const T& wanted) const {
        using std::abs;
        const T k = stiffness_.middle(), c = turning_.middle();
        for (int round = 0; round < 100; ++round) {
            const T cosine = detail::cosine_at(t);
            const T slope = k + c * cosine * cosine * cosine;
            const T step = (wanted - k * t - c * t * cosine) / slope;
            if (!(abs(step) > T(4) * epsilon<T>() * abs(t)) || !(abs(step) <= std::numeric_limits<T>::max())) break;
            t = t + step;
        }
        return t;
    }

    static constexpr int tries = 60;
    static T first_step(const T& t) {
        using std::abs;
        return T(2) * epsilon<T>() * abs(t) + std::numeric_limits<T>::denorm_min();
    }

    Met<T> right_of_joint(const Interval<T>& R) const {
        if (least_.low > R.high) return {{}, false, false};
        const T k = stiffness_.low;
        const auto from_right = [&](const T& wanted) {
            return near(T((wanted - turning_.low) / k + joint_.high), wanted);
        };
        Met<T> met;
        met.smooth = R.low > least_.high;
        T& high = met.tangent.high;
        high = std::max(joint_.high, met.smooth || R.high > least_.high ? from_right(R.high) : joint_.high);
        T step = first_step(high);
        for (int round = 0; !(at(high).low >= R.high); ++round, step = step * T(2)) {
            high = high + step;
            if (round == tries + 60) return nothing_known();
        }
        T& low = met.tangent.low;
        low = met.smooth ? from_right(R.low) : joint_.low;
        step = first_step(low);
        for (int round = 0; met.smooth && !(low > joint_.high && at(low).high <= R.low); ++round, step = step * T(2)) {
            low = low - step;
            if (round == tries || !(low > joint_.high)) met.smooth = false, low = joint_.low;
        }
        return met;
    }

    /// The largest tangent between the joints under a load of at least R; false where that is the joint.
    std::pair<T, bool> last_between(const T& R) const {
        if (R <= least_.high) return {joint_.high, false};
        T t = R > T(0) ? (R < -least_.high ? T(-near(T(0), T(-R))) : T(-joint_.low)) : near(T(0), R);
        T step = first_step(t);
        for (int round = 0; round < tries; ++round, step = step * T(2)) {
            if (!(t < joint_.low)) break;
            if (t > -joint_.low && at(t).high <= R) return {t, true};
            t = t + step;
        }
        return {joint_.high, false};
    }

    Met<T> between_joints(const Interval<T>& R) const {
        if (least_.low > R.high || R.low > -least_.low) return {{}, false, false};
        const auto [high, high_inside] = last_between(R.low);
        const auto [low, low_inside] = last_between(T(-R.high));
        return {{T(-low), high}, true, high_inside && low_inside};
    }

    static Met<T> nothing_known() {
        const T nan = std::numeric_limits<T>::quiet_NaN();
        return {{nan, nan}, true, false};
    }

    Interval<T> stiffness_, turning_;
    bool plummet_ = false, single_ = true;
    Interval<T> joint_, least_;  // the right joint, and R there
};

}  // namespace revchain::finite
