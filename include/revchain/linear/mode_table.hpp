// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "revchain/core/conical_pendulum.hpp"
#include "revchain/core/progress.hpp"
#include "revchain/linalg/twisted.hpp"
#include "revchain/linear/assembly.hpp"

namespace revchain {

/// What to compute.
template <Real T>
struct ModesOptions {
    std::optional<Index> count{};  ///< the slowest so many; absent: all
    std::optional<T> rtol{};       ///< relative tolerance of the conical heights; absent: as accurate as T allows
    bool shapes = true;            ///< also shapes, residuals and nodes
    Progress* progress = nullptr;  ///< watched and stopped from another thread
};

/// Whirl modes of a chain, slowest first. Mode k stands at index k - 1.
template <Real T>
struct Modes {
    Vector<T> conical_height;  ///< (k,) lambda, descending, in the chain's unit of length
    Vector<T> error_bound;     ///< (k,) relative to the exact conical height of the stored numbers; proved by counts
    Table<T> shape;      ///< (k, N+1) offsets of the pins, free end first, support last (0); largest |offset| = 1,
                         ///< free end positive; empty without shapes
    Vector<T> residual;  ///< (k,) force left unbalanced at a pin, relative to the forces that meet there
    std::vector<Vector<T>> nodes;  ///< k lists: distances from the free end where the mode crosses the axis
    std::string method;
    Status status = Status::success;

    Modes() = default;
    /// Room for what the options ask of the chain.
    Modes(const Chain<T>& chain, const ModesOptions<T>& options);

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

    /// A bound beyond the tolerance asked, or none at all, is `tolerance_not_met`.
    void note_status(const T& bound, const ModesOptions<T>& options) {
        if (!(bound <= options.rtol.value_or(std::numeric_limits<T>::max()))) status = Status::tolerance_not_met;
    }
    /// Stores the normalised offsets of mode `j`, with nodes and the residual in the pencil's scalar; `height` in its
    /// unit.
    template <Real S>
    void set_shape(Index j, const Chain<T>& chain, const linalg::ElementPencil<S>& pencil, const T& height,
                   Vector<T> offset);

   private:
    Vector<T> each(const T& gravity, T (*function)(const T&, const T&)) const {
        Vector<T> result(size());
        for (Index j = 0; j < size(); ++j) result[j] = function(conical_height[j], gravity);
        return result;
    }
};

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

template <Real T>
void check(const Chain<T>& chain, const ModesOptions<T>& options) {
    if (options.count && *options.count < 1) refuse("modes", "count must be at least 1", *options.count);
    if (options.count && *options.count > chain.mode_count())
        refuse("modes", "count must not exceed the " + std::to_string(chain.mode_count()) + " modes of this chain",
               *options.count);
    if (options.rtol && !(*options.rtol >= T(0))) refuse("modes", "rtol must not be negative or NaN", *options.rtol);
}

}  // namespace detail

template <Real T>
Modes<T>::Modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    const Index count = options.count.value_or(chain.mode_count());
    conical_height.resize(count);
    error_bound.resize(count);
    if (!options.shapes) return;
    shape.resize(count, chain.size() + 1);
    residual.resize(count);
    nodes.resize(static_cast<std::size_t>(count));
}

template <Real T>
template <Real S>
void Modes<T>::set_shape(Index j, const Chain<T>& chain, const linalg::ElementPencil<S>& pencil, const T& height,
                         Vector<T> offset) {
    residual[j] = linalg::relative_residual(pencil, height, offset);
    nodes[static_cast<std::size_t>(j)] = detail::nodes(chain, offset);
    shape.row(j) = offset.transpose();
}

}  // namespace revchain
