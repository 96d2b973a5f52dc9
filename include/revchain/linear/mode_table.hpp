// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <vector>

#include "revchain/count.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain {

// revchain/modes.hpp
template <Real T>
struct ModesOptions;
template <Real T>
struct Modes;

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
