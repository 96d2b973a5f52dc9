// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/count.hpp"
#include "revchain/linear/lazy_mode_shapes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/status.hpp"

/// Whirl modes of small amplitude: speeds with error bounds, shapes and nodes.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5),  // the lowest link first
///                                          revchain::uniform_rod(2.0, 0.3)});
///     const auto m = revchain::modes(chain, {.count = 2});
///     m.angular_speed(9.80665)[0];   // 3.80868 rad/s, the slowest mode
///     m.conical_height[0];           // 0.67604 = g/n^2, in the unit of the lengths
///     m.error_bound[0];              // its relative error is at most 4.4e-16: proved
///     m.shape(0)[1];                 // offset of the second pin, free end first
///
/// Greenhill (1908) §8 (21) with sec delta = 1. Whirl speeds of small amplitude are also the
/// natural angular frequencies of the plane swing.
namespace revchain::inline REVCHAIN_BUILD {

/// How conical heights are found. The last three are in methods.hpp.
enum class ModesMethod {
    automatic,     ///< the cheapest available method that meets the tolerance
    bisection,     ///< bisection on counts of modes
    condensed,     ///< for a few of the slowest modes of a long chain, condensed to blocks; 2 ulp
    aberth,        ///< all modes of a small chain at once (Ehrlich and Aberth)
    interpolated,  ///< for many modes: interpolates the characteristic polynomial
};

/// Selects modes by number (`first`, `count`) or by one window, not both, and sets their tolerance.
template <Real T>
struct ModesOptions {
    Index first = 1;                                  ///< from 1 for the slowest
    std::optional<Index> count{};                     ///< or `all_modes`; absent: at most 10
    std::optional<HeightWindow<T>> conical_height{};  ///< window low < conical height <= high
    std::optional<SpeedWindow<T>> angular_speed{};    ///< window low <= whirl speed < high
    std::optional<T> rtol{};  ///< relative tolerance of conical heights; absent: full accuracy
    bool certify = false;     ///< also return `Certificate`
    T gravity = T(conical_pendulum::standard_gravity);  ///< for windows of speed
    Index threads = 1;                                  ///< 0: all processors
    Progress* progress = nullptr;                       ///< read and cancelled from another thread
    /// A method that does not apply is replaced by bisection; `Modes::method` names the one used.
    ModesMethod method = ModesMethod::automatic;
};

/// Intervals lower < exact conical height <= upper of the modes found, and counts that prove them.
/// For mode k, `above_lower` >= k of the exact heights exceed `lower` and `above_upper` < k exceed
/// `upper`. An end is 0 or infinite if no count was proved.
template <Real T>
struct Certificate {
    Vector<T> lower;  ///< (k,) in the chain's unit of length
    Vector<T> upper;
    Vector<Index> above_lower;
    Vector<Index> above_upper;
};

/// Whirl modes of a chain, slowest first. Mode k is at index k - first.
template <Real T>
struct Modes {
    Index first = 1;               ///< number of the slowest mode here
    Vector<T> conical_height{};    ///< (k,) lambda, descending, in the chain's unit of length
    Vector<T> error_bound{};       ///< (k,) relative to the exact height of the stored numbers
    Certificate<T> certificate{};  ///< empty unless asked for
    std::string method{};          ///< the one used
    Status status = Status::success;

    Index size() const noexcept { return conical_height.size(); }
    ModeRange range() const { return {first, size()}; }
    /// (k, N+1) offsets of the pins, free end first, support last (0); in each mode the largest
    /// magnitude is 1 and the free end positive. Computed at the first call; thread-safe.
    const Table<T>& shapes(Progress* progress = nullptr) const {
        return lazy_shapes_.offsets(size(), progress);
    }
    /// (k,) largest unbalanced force at a pin over the largest sum of magnitudes at a pin
    const Vector<T>& residual() const { return details().residual; }
    /// k lists: distances from the free end at which the mode crosses the axis.
    const std::vector<Vector<T>>& nodes() const { return details().nodes; }
    /// (N+1) offsets of the mode at index j, computed alone unless `shapes` has been called.
    [[nodiscard]] Vector<T> shape(Index j) const { return lazy_shapes_.one(size(), j); }
    /// n = sqrt(g / lambda), rad/s; relative error: half of `error_bound`, plus 2.1 ulp.
    Vector<T> angular_speed(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::angular_speed<T>);
    }
    /// Seconds for one revolution.
    [[nodiscard]] Vector<T> period(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::period<T>);
    }
    Vector<T> revolutions_per_second(
        const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return each(gravity, &conical_pendulum::revolutions_per_second<T>);
    }

   private:
    friend detail::ShapesBehind;
    const detail::ModeShapes<T>& details() const { return lazy_shapes_.details(size(), nullptr); }
    Vector<T> each(const T& gravity, T (*function)(const T&, const T&)) const {
        Vector<T> result(size());
        for (Index j = 0; j < size(); ++j) result[j] = function(conical_height[j], gravity);
        return result;
    }

    detail::LazyModeShapes<T> lazy_shapes_{};
};

/// The modes chosen by `options`. Shapes are computed on demand.
///
/// Method: bisection on counts of modes. A twisted factorization gives a shape and its Rayleigh
/// quotient in `Wide<T>`; the residual or two counts prove the bound. A chain of floats is solved
/// in double. methods.hpp adds methods that are faster for long chains, many modes and loose
/// tolerances, and says which bounds are proved. Programs that link `revchain::compiled` have them
/// here. Windows are decided by proved counts. Accuracy without `rtol`: conical heights within
/// 0.501 ulp of the exact ones of the stored numbers (measured, N up to 1e5, ten kinds of chain:
/// tests/cpp/modes.cpp); the bound is at most 2 ulp, proved. With `rtol`: it is at most `rtol`
/// unless the status says otherwise. Shapes are
/// within 5.6e-17 of the largest offset (3.5e-16 / gap if weights need several units; rtol / gap
/// with a looser `rtol`), where gap, at most 1, is the relative distance to the next height. If
/// `Wide<T>` is T itself (DoubleDouble, a scalar of your own), errors and bounds grow with N.
/// Results are bitwise the same for any number of threads. Cost in double: 8 ns per link and mode
/// with AVX-512, 50 with SSE2; 20 and 70 with shapes, 250 for weights that need several units.
/// Memory O(N k) with shapes. Throws InvalidArgument for mode numbers outside 1 ...
/// `chain.mode_count()`, a window unless 0 <= low < high, numbers together with a window, two
/// windows, a method that needs methods.hpp, and as `ModeCounter`. A tolerance out of reach gives
/// `Status::tolerance_not_met` and the bounds reached.
template <Real T>
[[nodiscard]] Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD {
#if !defined(REVCHAIN_COMPILED_DOUBLE)
extern template Modes<float> modes(const Chain<float>&, const ModesOptions<float>&);
#endif
extern template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);
extern template Modes<long double> modes(const Chain<long double>&,
                                         const ModesOptions<long double>&);
extern template Modes<DoubleDouble> modes(const Chain<DoubleDouble>&,
                                          const ModesOptions<DoubleDouble>&);
}  // namespace revchain
#else
#include "revchain/questions/modes.hpp"
#endif
