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

namespace detail {

/// Distances of the crossings from the free end, along the chain.
template <Real T>
Vector<T> nodes(const Chain<T>& chain, const std::vector<linalg::Crossing<T>>& crossings) {
    Vector<T> found(static_cast<Index>(crossings.size()));
    Wide<T> below(T(0));  // distance of the lower pin of link `m` from the free end
    Index m = 0, i = 0;
    for (const linalg::Crossing<T>& crossing : crossings) {
        for (; m < crossing.element; ++m) below = below + Wide<T>(chain.length()[m]);
        found[i++] = static_cast<T>(below + Wide<T>(crossing.share * chain.length()[m]));
    }
    return found;
}

template <Real T>
void check(const Chain<T>& chain, const ModesOptions<T>& options) {
    if (options.count && *options.count < 1) refuse("modes", "count must be at least 1", *options.count);
    if (options.count && *options.count > chain.mode_count())
        refuse("modes", "count must not exceed the " + std::to_string(chain.mode_count()) + " modes of this chain",
               *options.count);
    if (options.rtol && !(*options.rtol >= T(0))) refuse("modes", "rtol must not be negative or NaN", *options.rtol);
}

/// Room for what the options ask of the chain, nothing computed yet.
template <Real T>
Modes<T> room_for_modes(const Chain<T>& chain, const ModesOptions<T>& options, const char* method) {
    const Index count = options.count.value_or(chain.mode_count());
    Modes<T> result;
    result.method = method;
    result.conical_height.resize(count);
    result.error_bound.resize(count);
    if (!options.shapes) return result;
    result.shape.resize(count, chain.size() + 1);
    result.residual.resize(count);
    result.nodes.resize(static_cast<std::size_t>(count));
    return result;
}

/// Stores height number `j`, given in units of 2^exponent. Where it leaves the normal range of T on the way to the
/// user's unit, the bound takes up what is lost. A bound beyond the tolerance asked is `tolerance_not_met`.
template <Real T>
void set_height(Modes<T>& modes, Index j, const T& height, T bound, int exponent, const ModesOptions<T>& options) {
    using std::abs;
    using std::ldexp;
    const T stored = ldexp(height, exponent);
    const T lost = abs(ldexp(stored, -exponent) - height);
    if (lost > T(0)) bound = stored > T(0) ? bound + T(2) * (lost / height) : std::numeric_limits<T>::infinity();
    modes.conical_height[j] = stored;
    modes.error_bound[j] = bound;
    if (!(bound <= options.rtol.value_or(std::numeric_limits<T>::max()))) modes.status = Status::tolerance_not_met;
}

/// Stores shape and nodes of mode `j`, and its residual in the pencil's scalar; `height` in the pencil's unit.
template <Real T, Real S>
void set_shape(Modes<T>& modes, Index j, const Chain<T>& chain, const linalg::ElementPencil<S>& pencil, const T& height,
               const linalg::Eigenvector<T>& vector) {
    modes.residual[j] = linalg::relative_residual(pencil, height, vector.offset);
    modes.nodes[static_cast<std::size_t>(j)] = nodes(chain, vector.crossings);
    modes.shape.row(j) = vector.offset.transpose();
}

}  // namespace detail
}  // namespace revchain
