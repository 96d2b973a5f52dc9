// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/modes.hpp"
#include "revchain/linear/string_places.hpp"
#include "revchain/linear/two_links.hpp"

/// Transverse oscillation of a string of weights held at both ends, and of a funicular polygon perpendicular to its plane.
namespace revchain {

/// A string of weights as a chain that hangs: its weights and spacings, the last support above, and at the other end
/// instead of the first support a weight 2^(digits + 47) times all others together, which stretches it evenly and does not
/// move, both to less than a rounding of a rounding. Its modes from the second on, heights times `factor`, are those of
/// the string.
template <Real T>
struct StringOfWeights {
    Chain<T> chain;
    T factor{};
};

/// Weights (n) at places (n + 2, both supports among them) on a thread of uniform tension.
///
/// Greenhill (1908) §3: the weights of a funicular polygon between two supports, transferred vertically to one horizontal
/// line and held there on a thread of uniform tension, the horizontal component in the polygon, oscillate as the weights
/// of the polygon do perpendicular to its plane. Exactly so while oscillations are small: a side of length a and tension T
/// resists with T/a, which is the horizontal component over the horizontal length.
/// Throws InvalidArgument unless there are weights, all positive, places increase and all is finite.
template <Real T>
StringOfWeights<T> string_of_weights(const Vector<T>& weight, const Vector<T>& place, const T& tension,
                                     std::string_view where = "string_of_weights") {
    using std::ldexp;
    const Index n = weight.size();
    if (n == 0) detail::refuse(where, "there must be a weight; their number is", n);
    detail::check_string(where, weight, place);
    detail::require_positive(where, "tension", tension);
    const T unit = detail::inverse_power_near(weight.maxCoeff());
    T total(0);
    for (Index j = 0; j < n; ++j) total += weight[j] * unit;
    const T heavy = ldexp(T(1) / detail::inverse_power_near(total), std::numeric_limits<T>::digits + 47);
    std::vector<Link<T>> links{plummet<T>(heavy, place[1] - place[0])};
    for (Index j = 0; j < n; ++j) links.push_back(plummet<T>(weight[j] * unit, place[j + 2] - place[j + 1]));
    return {Chain<T>(links), heavy / (tension * unit)};
}

/// Small transverse oscillations of a string of weights, slowest first.
template <Real T>
struct TransverseModes {
    Vector<T> conical_height;  ///< (n) of the pendulum that keeps time with it: period 2 pi sqrt(height/g)
    Vector<T> error_bound;     ///< (n) relative
    Table<T> shape;            ///< (n, n + 2) of supports and weights; largest 1, the first weight to the positive side

    Vector<T> period(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        Vector<T> seconds(conical_height.size());
        for (Index k = 0; k < seconds.size(); ++k) seconds[k] = conical_pendulum::period(conical_height[k], gravity);
        return seconds;
    }
};

/// All of them, by `modes` of the equivalent chain. Accuracy: heights to 2 ulp (measured;
/// tests/cpp/finite/funicular_polygon.cpp), within `error_bound`, which adds to the proved bound of `modes` the roundings
/// of spacings and factor. Throws as string_of_weights does, and where a height is out of range.
template <Real T>
TransverseModes<T> transverse_modes(const Vector<T>& weight, const Vector<T>& place, const T& tension) {
    using std::isfinite;
    constexpr std::string_view where = "transverse_modes";
    const StringOfWeights<T> string = string_of_weights(weight, place, tension, where);
    const Modes<T> found = modes(string.chain, {.first = 2});
    TransverseModes<T> result{found.conical_height, found.error_bound, found.shape};
    for (Index k = 0; k < found.size(); ++k) {
        result.conical_height[k] = found.conical_height[k] * string.factor;
        if (!isfinite(result.conical_height[k]) || result.conical_height[k] == T(0))
            detail::refuse(where, "the conical heights leave the range of numbers, with a tension of", tension);
        result.error_bound[k] += T(3) * epsilon<T>();
        if (result.shape(k, 1) < T(0)) result.shape.row(k) = -result.shape.row(k);
        result.shape(k, 0) = T(0);  // the heavy weight: less than 2^-digits
        result.shape(k, result.shape.cols() - 1) = T(0);
    }
    return result;
}

}  // namespace revchain
