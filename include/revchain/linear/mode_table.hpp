// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "revchain/count.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain {

/// How heights are found. Bounds are proved whichever way.
enum class ModesMethod {
    automatic,  ///< the cheapest of those below that keeps the tolerance
    bisection,  ///< counts, one by one: any chain, any modes, any tolerance
    blocks,     ///< the chain condensed first: some of the slowest modes of a long chain, to 2 ulp
    together,   ///< of a small chain all modes at once: to some 20 ulp
    spectrum,   ///< the characteristic polynomial interpolated: many modes
};

/// Which modes, and how. Which: numbers `first`, `first + 1`, ..., or those in one window, never both.
template <Real T>
struct ModesOptions {
    Index first = 1;                                  ///< number of the slowest mode wanted, from 1
    std::optional<Index> count{};                     ///< so many from `first` on; absent: all
    std::optional<HeightWindow<T>> conical_height{};  ///< instead: low < conical height <= high
    std::optional<SpeedWindow<T>> angular_speed{};    ///< instead: low <= whirl speed < high
    std::optional<T> rtol{};  ///< relative tolerance of the conical heights; absent: as accurate as T allows
    bool shapes = true;       ///< also shapes, residuals and nodes
    bool certify = false;     ///< also the intervals that are proved to hold the heights, and the counts that prove it
    Progress* progress = nullptr;  ///< watched and stopped from another thread
    /// `blocks`, `together` and `spectrum` where they can: else bisection, and `Modes::method` says so.
    ModesMethod method = ModesMethod::automatic;
};

/// Intervals lower < exact conical height <= upper, and why: of the exact heights of the stored numbers, mode k being
/// one of them, `above_lower` >= k exceed `lower` and `above_upper` < k exceed `upper`. Both counts are proved;
/// `count_modes` gives them too. An end that no count could be proved at is 0 or infinite.
template <Real T>
struct Certificate {
    Vector<T> lower;  ///< (k,) in the chain's unit of length
    Vector<T> upper;
    Vector<Index> above_lower;
    Vector<Index> above_upper;
};

/// Whirl modes of a chain, slowest first. Mode k, the k-th slowest of all, stands at index k - first. None may be there
/// where a window was asked for; `first` is then the number that the next faster mode has.
template <Real T>
struct Modes {
    Index first = 1;           ///< number of the slowest mode here
    Vector<T> conical_height;  ///< (k,) lambda, descending, in the chain's unit of length
    Vector<T> error_bound;     ///< (k,) relative to the exact conical height of the stored numbers; proved by counts
    Table<T> shape;      ///< (k, N+1) offsets of the pins, free end first, support last (0); largest |offset| = 1,
                         ///< free end positive; empty without shapes
    Vector<T> residual;  ///< (k,) force left unbalanced at a pin, relative to the forces that meet there
    std::vector<Vector<T>> nodes;  ///< k lists: distances from the free end where the mode crosses the axis
    Certificate<T> certificate;    ///< empty unless asked for
    std::string method;
    Status status = Status::success;

    Index size() const { return conical_height.size(); }
    ModeRange range() const { return {first, size()}; }
    /// n = sqrt(g / lambda), rad/s; relative error: half of `error_bound` and 2.1 ulp.
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
Vector<T> nodes(const Chain<T>& chain, const std::vector<pencil::Crossing<T>>& crossings) {
    Vector<T> found(static_cast<Index>(crossings.size()));
    Wide<T> below(T(0));  // distance of the lower pin of link `m` from the free end
    Index m = 0, i = 0;
    for (const pencil::Crossing<T>& crossing : crossings) {
        for (; m < crossing.element; ++m) below = below + Wide<T>(chain.length()[m]);
        found[i++] = static_cast<T>(below + Wide<T>(crossing.share * chain.length()[m]));
    }
    return found;
}

template <Real T>
void check(const ModesOptions<T>& options) {
    if (options.rtol && !(*options.rtol >= T(0)))
        throw_invalid("modes", "rtol must not be negative or NaN", *options.rtol);
}

/// The numbers of the modes asked for.
template <Real T>
ModeRange chosen(const Chain<T>& chain, LazyCounter<T>& assembled, const ModesOptions<T>& options) {
    const bool numbered = options.first != 1 || options.count.has_value();
    if (numbered + options.conical_height.has_value() + options.angular_speed.has_value() > 1)
        throw_invalid("modes",
                      "give one of mode numbers (first, count), conical_height and angular_speed, not several");
    if (options.conical_height) return assembled.counter().within(*options.conical_height);
    if (options.angular_speed) return assembled.counter().within(*options.angular_speed);
    const Index all = chain.mode_count();
    const std::string of = std::to_string(all) + " modes of this chain";
    if (options.first < 1) throw_invalid("modes", "first must be at least 1", options.first);
    if (options.first > all) throw_invalid("modes", "first must not exceed the " + of, options.first);
    const Index left = all - options.first + 1;
    const Index count = options.count.value_or(left);
    if (count < 1) throw_invalid("modes", "count must be at least 1", count);
    if (count > left)
        throw_invalid(
            "modes",
            "count must not exceed the " + (left == all ? of
                                                        : std::to_string(left) + " from number " +
                                                              std::to_string(options.first) + " on of the " + of),
            count);
    return {options.first, count};
}

/// Room for what the options ask of these modes, nothing computed yet.
template <Real T>
Modes<T> room_for_modes(const Chain<T>& chain, const ModeRange& range, const ModesOptions<T>& options) {
    Modes<T> result;
    result.first = range.first;
    result.conical_height.resize(range.count);
    result.error_bound.resize(range.count);
    if (options.certify)
        result.certificate = {Vector<T>(range.count), Vector<T>(range.count), Vector<Index>(range.count),
                              Vector<Index>(range.count)};
    if (!options.shapes) return result;
    result.shape.resize(range.count, chain.size() + 1);
    result.residual.resize(range.count);
    result.nodes.resize(static_cast<std::size_t>(range.count));
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
void set_shape(Modes<T>& modes, Index j, const Chain<T>& chain, const pencil::ElementPencil<S>& pencil, const T& height,
               const pencil::Eigenvector<T>& vector) {
    modes.residual[j] = pencil::relative_residual(pencil, height, vector.offset);
    modes.nodes[static_cast<std::size_t>(j)] = nodes(chain, vector.crossings);
    modes.shape.row(j) = vector.offset.transpose();
}

}  // namespace detail
}  // namespace revchain
