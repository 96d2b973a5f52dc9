// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/link_equation.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A range of tangents in which R is monotone. If stiffness +- turning > 0 there is one range,
/// `whole`. Otherwise R falls in the middle and grows beyond the joints t =
/// +-sqrt((|turning|/stiffness)^(2/3) - 1).
enum class MonotoneBranch { whole, right, middle, left };

/// Returns true if R grows with t everywhere by at least a hundredth of `stiffness`. A flatter R is
/// divided into branches, of which the middle one may have no width.
template <Real T>
bool grows_fast(const Interval<T>& stiffness, const Interval<T>& turning) {
    return turning.low >= T(0) || (Interval<T>(T(0.99)) * stiffness + turning).positive();
}

/// The tangents of a branch under a load R; `smooth` if they are away from joints.
template <Real T>
struct LoadedTangents {
    Interval<T> tangent;
    bool possible = true, smooth = true;
};

/// Returns the first of t, t + step, t + 3 step, t + 7 step, ... to pass a test; NaN after `tries`.
template <class T, class Test>
T first_passing(T t, T step, int tries, const Test& passes) {
    for (int round = 0; round < tries; ++round, step = step * T(2)) {
        if (passes(t)) return t;
        t = t + step;
    }
    return std::numeric_limits<T>::quiet_NaN();
}

/// The tangents of one link in one posture as functions of its load R.
template <Real T>
class Response {
   public:
    Response(const Link<Interval<T>>& link, const Interval<T>& height, Posture posture)
        : stiffness_(height * link.pull), turning_(turning_of(link)) {
        if (posture == Posture::stands) turning_ = -turning_;
        single_ = grows_fast(stiffness_, turning_);
        if (!single_) find_joint();
    }

    const Interval<T>& stiffness() const { return stiffness_; }
    const Interval<T>& turning() const { return turning_; }
    bool is_plummet() const { return is_zero(turning_); }
    bool is_single() const { return single_; }

    Interval<T> load(const Interval<T>& t) const {
        return is_plummet() ? stiffness_ * t : stiffness_ * t + turning_ * sine_at(t);
    }

    LoadedTangents<T> met(MonotoneBranch branch, const Interval<T>& R) const {
        if (branch == MonotoneBranch::whole)
            return {is_plummet() ? R / stiffness_ : tangent_of(stiffness_, turning_, R)};
        if (branch == MonotoneBranch::right) return right_of_joint(R);
        if (branch == MonotoneBranch::middle) return between_joints(R);
        LoadedTangents<T> image = right_of_joint(-R);
        image.tangent = -image.tangent;
        return image;
    }

   private:
    Interval<T> at(const T& t) const { return load(Interval<T>(t)); }
    Interval<T> growth(const T& t) const {
        return stiffness_ + turning_ * Sine<T>(Interval<T>(t)).slope;
    }

    void find_joint() {
        using std::cbrt;
        using std::sqrt;
        const double ratio = as_double(-turning_.low) / as_double(stiffness_.low);
        const double root = cbrt(ratio);
        T near(sqrt(std::max(0.0, root * root - 1)));
        for (int round = 0; round < 3 && near > T(0); ++round) {  // to the accuracy of T
            const T cosine = cosine_at(near), cube = cosine * cosine * cosine;
            near = near + (stiffness_.low / cube + turning_.low) * (T(1) + near * near) /
                              (T(3) * turning_.low * near);
            if (!(near > T(0))) near = T(0);
        }
        constexpr int to_overflow = 2 * std::numeric_limits<T>::max_exponent;
        const T step = T(4) * epsilon<T>() * near + std::numeric_limits<T>::min();
        joint_.high = first_passing(near, step, to_overflow,
                                    [&](const T& t) { return growth(t).positive(); });
        joint_.low = first_passing(near, T(-step), to_overflow,
                                   [&](const T& t) { return !(t > T(0)) || growth(t).negative(); });
        if (!(joint_.low > T(0))) joint_.low = T(0);
        least_ = load(joint_);
    }

    /// Returns t with R(t) = wanted. The method does not overshoot, since R is convex for t > 0.
    T near(const T& start, const T& wanted) const {
        return tangent_from(start, stiffness_.middle(), turning_.middle(), wanted);
    }

    static constexpr int tries = 60;

    LoadedTangents<T> right_of_joint(const Interval<T>& R) const {
        if (least_.low > R.high) return {{}, false, false};
        const T k = stiffness_.low;
        const auto from_right = [&](const T& wanted) {
            return near(T((wanted - turning_.low) / k + joint_.high), wanted);
        };
        LoadedTangents<T> met;
        met.smooth = R.low > least_.high;
        const T high = met.smooth || R.high > least_.high
                           ? std::max(joint_.high, from_right(R.high))
                           : joint_.high;
        met.tangent.high = first_passing(high, rounding_step(high), 2 * tries,
                                         [&](const T& t) { return at(t).low >= R.high; });
        if (!(met.tangent.high == met.tangent.high)) return {met.tangent.high, true, false};
        met.tangent.low = joint_.low;
        if (!met.smooth) return met;
        const T low = from_right(R.low);
        const T passed = first_passing(low, T(-rounding_step(low)), tries, [&](const T& t) {
            return !(t > joint_.high) || at(t).high <= R.low;
        });
        met.smooth = passed > joint_.high;
        if (met.smooth) met.tangent.low = passed;
        return met;
    }

    /// Returns the largest tangent between the joints with a load >= R; false if it is the joint.
    std::pair<T, bool> last_between(const T& R) const {
        if (R <= least_.high) return {joint_.high, false};
        T t =
            R > T(0) ? (R < -least_.high ? T(-near(T(0), T(-R))) : T(-joint_.low)) : near(T(0), R);
        t = first_passing(t, rounding_step(t), tries, [&](const T& x) {
            return !(x < joint_.low) || (x > -joint_.low && at(x).high <= R);
        });
        return t < joint_.low ? std::pair(t, true) : std::pair(joint_.high, false);
    }

    LoadedTangents<T> between_joints(const Interval<T>& R) const {
        if (least_.low > R.high || R.low > -least_.low) return {{}, false, false};
        const auto [high, high_inside] = last_between(R.low);
        const auto [low, low_inside] = last_between(T(-R.high));
        return {{T(-low), high}, true, high_inside && low_inside};
    }

    Interval<T> stiffness_, turning_;
    bool single_;
    Interval<T> joint_, least_;  // the right joint and its load
};

}  // namespace revchain::finite
