// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>

#include "revchain/core/conical_pendulum.hpp"
#include "revchain/core/progress.hpp"
#include "revchain/linalg/certificate.hpp"
#include "revchain/linalg/twisted.hpp"
#include "revchain/linear/assembly.hpp"

namespace revchain {

/// Whirl modes of a chain, slowest first. Mode k stands at index k - 1.
template <Real T>
struct Modes {
    Vector<T> conical_height;  ///< (k,) lambda, descending, in the chain's unit of length
    Vector<T> error_bound;     ///< (k,) relative to the exact conical height of the stored numbers; proved by counts
    Table<T> shape;            ///< (k, N+1) offsets of the pins, free end first, support last (0); largest |offset| = 1,
                               ///< free end positive; empty without shapes
    Vector<T> residual;        ///< (k,) force left unbalanced at a pin, relative to the forces that meet there
    std::vector<Vector<T>> nodes;  ///< k lists: distances from the free end where the mode crosses the axis
    std::string method;
    Status status = Status::success;

    Index size() const { return conical_height.size(); }
    /// n = sqrt(g / lambda), rad/s; relative error: half of `error_bound` and 2 ulp.
    Vector<T> angular_speed(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::angular_speed<T>);
    }
    /// Seconds for one revolution.
    Vector<T> period(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::period<T>);
    }
    Vector<T> revolutions_per_second(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::revolutions_per_second<T>);
    }

   private:
    Vector<T> each(const T& gravity, T (*function)(const T&, const T&)) const {
        Vector<T> result(size());
        for (Index j = 0; j < size(); ++j) result[j] = function(conical_height[j], gravity);
        return result;
    }
};

/// What to compute.
template <Real T>
struct ModesOptions {
    std::optional<Index> count{};   ///< the slowest so many; absent: all
    std::optional<T> rtol{};        ///< relative tolerance of the conical heights; absent: as accurate as T allows
    bool shapes = true;             ///< also shapes, residuals and nodes
    Progress* progress = nullptr;   ///< watched and stopped from another thread
};

/// The `count` slowest whirl speeds of small amplitude, Greenhill (1908) §8 (21) with sec delta = 1.
///
/// Method: bisection on counts in T, eight shifts to a pass; twisted shapes; a Rayleigh quotient in `Wide<T>`; and two
/// proved counts in `Wide<T>` for every mode. With a loose `rtol` the last two are left out or done in T.
/// Accuracy: conical heights within 1 ulp of the exact ones of the stored numbers (measured, N up to 1e5, any weights
/// and lengths), error bound 2 ulp and proved; a loose `rtol` is kept by the bound. Shapes 1e-13 of the largest offset.
/// Cost: about 0.7 microseconds per link and mode with shapes (double), O(N k) memory.
/// Throws InvalidArgument for count < 1 or above `chain.mode_count()`, and for a tolerance that is negative or NaN; a
/// tolerance out of reach is `Status::tolerance_not_met` with the bounds reached.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

/// How many conical heights exceed `height`: by a proved count, in T and where that is in doubt in `Wide<T>`. A height
/// that agrees with `height` to within the rounding of `Wide<T>` (1e-29 in double) is held equal: it does not exceed.
/// Cost O(N). Throws InvalidArgument unless `height` is positive and finite.
template <Real T>
Index count_modes(const Chain<T>& chain, const T& height);

/// How many whirl speeds lie below `angular_speed`; the comparison is made with g / n^2 in `Wide<T>`.
template <Real T>
Index count_modes(const Chain<T>& chain, const T& angular_speed, const T& gravity);

namespace detail {

/// Distances from the free end at which the polygon of offsets crosses the axis, the support left out.
template <Real T>
Vector<T> nodes(const Chain<T>& chain, const Vector<T>& offset) {
    std::vector<T> found;
    Wide<T> below(T(0));  // distance of the link's lower pin from the free end
    T side(0);            // offset last seen off the axis
    for (Index m = 0; m < chain.size(); ++m) {
        const T lower = offset[m], upper = offset[m + 1];
        if (lower != T(0)) side = lower;
        if (m + 1 < chain.size() && (upper < T(0) ? side > T(0) : upper > T(0) && side < T(0))) {
            const T share = lower == T(0) ? T(0) : lower / (lower - upper);
            found.push_back(static_cast<T>(below + Wide<T>(share * chain.length()[m])));
        }
        below = below + Wide<T>(chain.length()[m]);
    }
    return Eigen::Map<const Vector<T>>(found.data(), static_cast<Index>(found.size()));
}

/// Largest |offset| = 1, free end positive.
template <Real T>
void normalise(Vector<T>& offset) {
    using std::abs;
    T largest(0), sign(0);
    for (Index m = 0; m < offset.size(); ++m) {
        if (abs(offset[m]) > largest) largest = abs(offset[m]);
        if (sign == T(0)) sign = offset[m];
    }
    if (sign < T(0)) largest = -largest;
    for (Index m = 0; m < offset.size(); ++m) offset[m] = offset[m] / largest;
}

template <Real T>
void check(const Chain<T>& chain, const ModesOptions<T>& options) {
    if (options.count && *options.count < 1) refuse("modes", "count must be at least 1", *options.count);
    if (options.count && *options.count > chain.mode_count())
        refuse("modes", "count must not exceed the " + std::to_string(chain.mode_count()) + " modes of this chain",
               *options.count);
    if (options.rtol && !(*options.rtol >= T(0))) refuse("modes", "rtol must not be negative or NaN", *options.rtol);
}

/// Height number `j` to `goal`, from its bracket, and its eigenvector: the cheapest certificate first.
template <Real T>
linalg::Certified<T> polish(const linalg::ElementPencil<Wide<T>>& wide, const linalg::ElementPencil<T>& pencil, Index j,
                            const linalg::Bracket<T>& bracket, const T& goal, bool loose, Vector<T>* offset) {
    using S = Wide<T>;
    T height = linalg::between(bracket.lower, bracket.upper);
    if (loose) {
        const T margin = goal / T(2);
        if (linalg::lies_within<T>(pencil, j, height, margin)) {
            if (offset != nullptr) *offset = linalg::eigenvector(pencil, height);
            return {height, linalg::bound_of_margin<T>(margin)};
        }
    }
    // Two rounds suffice: the quotient's error is the square of the vector's.
    const T margin = T(2) * epsilon<T>();
    Vector<T> scratch;
    Vector<T>& shape = offset != nullptr ? *offset : scratch;
    for (int round = 0; round < 2; ++round) {
        shape = linalg::eigenvector(pencil, height);
        normalise(shape);
        height = static_cast<T>(linalg::rayleigh_quotient<S>(wide, shape));
        if (linalg::lies_within<S>(wide, j, height, static_cast<Narrow<S>>(margin)))
            return {height, linalg::bound_of_margin<S>(margin)};
    }
    const linalg::Certified<T> sure =
        linalg::bisect_certified<S>(wide, j, linalg::between(bracket.lower, bracket.upper));
    shape = linalg::eigenvector(pencil, sure.eigenvalue);
    return sure;
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    using std::ldexp;
    detail::check(chain, options);
    const Index count = options.count.value_or(chain.mode_count());
    const AssembledChain<T> assembled = assemble(chain);
    const linalg::ElementPencil<T> pencil = linalg::rounded<T>(assembled.pencil);

    const T finest = T(2) * epsilon<T>();
    const T goal = options.rtol ? std::min(*options.rtol, T(0.5)) : T(8) * finest;
    // Counts in T are proved down to about an ulp for each link; below that the certificate needs Wide<T>.
    const bool loose = goal > T(64) * epsilon<T>() * T(chain.size());

    const T guess = ldexp(chain.total_length(), -assembled.units.length_exponent);
    const auto brackets =
        linalg::bisect(pencil, count, loose ? goal / T(4) : finest, guess, [&](Index done) {
            detail::advance(options.progress, 0.3 * static_cast<double>(done) / static_cast<double>(count));
        });

    Modes<T> result;
    result.method = "bisection";
    result.conical_height.resize(count);
    result.error_bound.resize(count);
    if (options.shapes) {
        result.shape.resize(count, chain.size() + 1);
        result.residual.resize(count);
        result.nodes.resize(static_cast<std::size_t>(count));
    }
    Vector<T> offset;
    for (Index j = 0; j < count; ++j) {
        const auto sure = detail::polish(assembled.pencil, pencil, j, brackets[static_cast<std::size_t>(j)], goal,
                                         loose, options.shapes ? &offset : nullptr);
        result.conical_height[j] = ldexp(sure.eigenvalue, assembled.units.length_exponent);
        result.error_bound[j] = sure.error_bound;
        if (!(sure.error_bound <= goal)) result.status = Status::tolerance_not_met;
        if (options.shapes) {
            detail::normalise(offset);
            result.residual[j] = linalg::relative_residual(pencil, sure.eigenvalue, offset);
            result.nodes[static_cast<std::size_t>(j)] = detail::nodes(chain, offset);
            result.shape.row(j) = offset.transpose();
        }
        detail::advance(options.progress, 0.3 + 0.7 * static_cast<double>(j + 1) / static_cast<double>(count));
    }
    return result;
}

namespace detail {
template <Real T>
Index count_modes(const Chain<T>& chain, const Wide<T>& height) {
    using std::ldexp;
    const AssembledChain<T> assembled = assemble(chain);
    const Wide<T> shift = ldexp(height, -assembled.units.length_exponent);
    const auto wide = linalg::certified_count<Wide<T>, 1>(assembled.pencil, {shift});
    return wide[0].above;
}
}  // namespace detail

template <Real T>
Index count_modes(const Chain<T>& chain, const T& height) {
    detail::require_positive("count_modes", "conical height", height);
    return detail::count_modes(chain, Wide<T>(height));
}

template <Real T>
Index count_modes(const Chain<T>& chain, const T& angular_speed, const T& gravity) {
    detail::require_positive("count_modes", "angular speed", angular_speed);
    detail::require_positive("count_modes", "gravity", gravity);
    return detail::count_modes<T>(chain, Wide<T>(gravity) / (Wide<T>(angular_speed) * Wide<T>(angular_speed)));
}

}  // namespace revchain
