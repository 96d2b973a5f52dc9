// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/count.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/status.hpp"

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

/// Whirl speeds of small amplitude, Greenhill (1908) §8 (21) with sec delta = 1: the slowest, any range of mode numbers
/// without the ones before, or those in a window of heights or speeds (which modes lie in it is decided by
/// `ModeCounter::within`, by proved counts, not by the heights returned: a height just above `low` may round to it).
///
/// Method: bisection on counts in T, eight shifts to a pass; a twisted shape and its Rayleigh quotient in `Wide<T>`;
/// two proved counts for every mode; and the shape in `Wide<T>`. With a loose `rtol` the quotient is left out and the
/// rest done in T. In double faster ways to the same heights where they pay: `ModesMethod`; a chain of floats is solved
/// in double and the result rounded, its bound half an ulp of float.
/// Accuracy: conical heights within 0.501 ulp of the exact ones of the stored numbers (measured, N up to 1e5, ten kinds
/// of chain: tests/cpp/modes.cpp), error bound 2 ulp and proved; a loose `rtol` is kept by the bound. Shapes
/// 3.5e-16 of the largest offset; with a loose `rtol` as good as their height, rtol / (gap to the next height). Where
/// `Wide<T>` is T itself (DoubleDouble, a user's own scalar) errors and bounds grow with N: tests/cpp/modes.cpp.
/// Cost: about 0.55 microseconds per link and mode with shapes, 0.3 without (double), for many modes 0.25 and 0.005;
/// O(N k) memory.
/// Throws InvalidArgument for numbers outside 1 ... `chain.mode_count()`, for a window that is none, for numbers and a
/// window together, and for a tolerance that is negative or NaN. An empty window gives no modes. A tolerance out of
/// reach is `Status::tolerance_not_met` with the bounds reached.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain {
extern template Modes<float> modes(const Chain<float>&, const ModesOptions<float>&);
extern template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);
extern template Modes<long double> modes(const Chain<long double>&, const ModesOptions<long double>&);
}  // namespace revchain
#else
#include "revchain/linear/modes.hpp"
#endif
