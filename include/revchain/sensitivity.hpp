// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"

/// Derivatives of conical heights and whirl speeds with respect to the data, and uncertainties.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto m = revchain::modes(chain);
///     const auto s = revchain::sensitivity(chain, m);
///     s.weight().value(0, 1);       // -0.0347969, d(slowest height)/d(weight of the upper link)
///     s.weight().error_bound(0, 1); // its absolute error, proved
namespace revchain::inline REVCHAIN_BUILD {

/// The data of a link. In a derivative all other data are constant. `length` moves the lower pin
/// alone. `length_in_proportion` changes centroid and radius of gyration in proportion, too, as the
/// length of a plummet's thread or of a rod does.
enum class Datum { weight, length, centroid, radius_of_gyration, length_in_proportion };

inline constexpr std::array<std::string_view, 5> datum_names{
    "weight", "length", "centroid", "radius_of_gyration", "length_in_proportion"};

/// Derivatives of k conical heights with respect to one datum of each of N links, lowest first.
template <Real T>
struct Derivatives {
    Table<T> value;        ///< (k, N)
    Table<T> error_bound;  ///< (k, N), absolute, proved; infinite if a mode cannot be separated
};

/// d(conical height)/d(datum) for modes number `first`, `first + 1`, ... The length of the lowest
/// link has no effect; a radius of gyration never lowers a height.
template <Real T>
struct Sensitivity {
    Index first = 1;
    std::array<Derivatives<T>, datum_names.size()> by_datum;

    const Derivatives<T>& of(Datum datum) const {
        return by_datum[static_cast<std::size_t>(datum)];
    }
    const Derivatives<T>& weight() const { return of(Datum::weight); }  ///< length over weight
    const Derivatives<T>& length() const { return of(Datum::length); }  ///< no unit, as all below
    const Derivatives<T>& centroid() const { return of(Datum::centroid); }
    const Derivatives<T>& radius_of_gyration() const { return of(Datum::radius_of_gyration); }
    /// (a d/da + h d/dh + rho d/drho)/a, never negative.
    const Derivatives<T>& length_in_proportion() const { return of(Datum::length_in_proportion); }
    Index size() const { return weight().value.rows(); }
};

/// Derivatives of the conical heights of `modes`, which must be those of this chain, with respect
/// to every datum of every link. They are the derivatives of lambda = y^T M y / y^T K y at the
/// exact shape:
///     (y^T dM y - lambda y^T dK y) / y^T K y.
/// Laws: sum of W d/dW = 0; sum of a d/da + h d/dh + rho d/drho = lambda. Accuracy: every entry is
/// within its error bound, which is proved; measured 0.51 ulp of entries above 1e-3 of the largest
/// sum of terms (tests/cpp/sensitivity.cpp). The heights in `modes` need not be accurate. Cost: 0.5
/// microseconds a link and mode; O(N k) memory. Throws InvalidArgument if the chain's weights are
/// more than 1e123 apart.
template <Real T>
[[nodiscard]] Sensitivity<T> sensitivity(const Chain<T>& chain, const Modes<T>& modes);

/// The uncertainty of one datum: one standard deviation for all links, one for each (N), or a
/// covariance (N, N). Deviations of different links are independent unless a covariance is given;
/// those of different data are always independent.
template <Real T>
struct Deviation {
    Vector<T> standard{};  ///< (1) or (N); empty where a covariance is given
    Matrix<T> covariance{};
};

/// One deviation for each `Datum`; absent: the datum is exactly known.
template <Real T>
using Deviations = std::array<std::optional<Deviation<T>>, datum_names.size()>;

/// Standard deviations of k modes, to first order in those of the data.
template <Real T>
struct Uncertainty {
    Vector<T> conical_height;  ///< (k,) standard deviations, in the unit of the heights
    Vector<T> relative;        ///< (k,) over the heights; half as much for speeds and periods
    std::array<Table<T>, datum_names.size()> share;  ///< (k, N) of a mode's variance: sum 1, or 0
    std::vector<Datum> datum;                        ///< (k,) the datum that contributes most
    std::vector<Index> link;                         ///< (k,) the link of that datum, from 0
};

/// Standard deviations of conical heights from those of the data: variance = sum of (d lambda/dx)^2
/// var x, or d^T C d for a datum with a covariance C. The error is of second order in the
/// deviations, and large if a derivative is nearly 0. Cost O(k N), with a covariance O(k N^2).
/// Throws InvalidArgument for lists of another length, deviations negative or not finite, and a
/// covariance that is not N by N, not symmetric or has a negative variance.
template <Real T>
[[nodiscard]] Uncertainty<T> uncertainty(const Sensitivity<T>& sensitivity,
                                         const std::type_identity_t<Vector<T>>& conical_height,
                                         const Deviations<T>& deviations);

/// d(whirl speed)/d(datum) of one mode of a rig with all other data constant. The first five are
/// for the links' own data, as in `Datum`.
struct RigSensitivity {
    Vector<double> weight;                ///< (N,)
    Vector<double> length;                ///< (N,) the lower pin moved; 0 of the lowest link
    Vector<double> centroid;              ///< (N,)
    Vector<double> radius_of_gyration;    ///< (N,)
    Vector<double> length_in_proportion;  ///< (N,) (a d/da + h d/dh + rho d/drho)/a
    Vector<double> momentum;  ///< (N,) of each flywheel's H, per weight times length times time
    Vector<double> displaced_weight;  ///< (N,) of the weight of the fluid displaced
    Vector<double> added_weight;      ///< (N,) of the still fluid that moves with the link
    double stiffness;                 ///< of the support; 0 where it is firm
    double carriage_weight;           ///< 0 where the support is firm
};

/// Derivatives of the whirl speed n of a mode with these offsets (N + 1, free end first, the
/// support's pin last). They follow from y^T (K + n G - n^2 M/g) y = 0, stationary in y:
///     dn/dx = - y^T (dK + n dG - n^2 dM/g) y / y^T (G - 2 n M/g) y.
/// Accuracy: formed in double-double; offsets with errors e of the largest give x dn/dx an error of
/// about
///     4 e (|K| + |n G| + n^2 |M|/g) / |y^T (G - 2 n M/g) y|
/// (spectral norms) if all links hang, and a larger one where two speeds nearly meet.
/// Cost O(N). Throws InvalidArgument for a speed of 0, offsets that are not N + 1 or move no
/// weight, numbers out of range, weights more than 1e123 apart, springs at pins, dashpots and
/// linear drag.
REVCHAIN_DECLARE
[[nodiscard]] RigSensitivity sensitivity(const Rig& rig, double angular_speed,
                                         const Vector<double>& offset,
                                         double gravity = conical_pendulum::standard_gravity);

/// The momentum of the flywheel of the link at index `link` with which `angular_speed` is a whirl
/// speed of some mode, all else constant. It is unique. Accuracy: the speed has a relative error of
/// 1e-14 (tests/cpp/linear/rig_sensitivity.cpp). Cost O(N). Throws InvalidArgument for a speed of
/// 0, numbers out of range, springs at pins, dashpots, linear drag, weights more than 1e123 apart,
/// and if no finite momentum has that effect.
REVCHAIN_DECLARE
[[nodiscard]] double momentum_for_speed(const Rig& rig, Index link, double angular_speed,
                                        double gravity = conical_pendulum::standard_gravity);

/// The stiffness of the support's spring with which `angular_speed` is a whirl speed of some mode,
/// all else constant. Accuracy, cost and errors are those of `momentum_for_speed`. Also throws
/// InvalidArgument if no positive finite stiffness has that effect.
REVCHAIN_DECLARE
[[nodiscard]] double stiffness_for_speed(const Rig& rig, double angular_speed,
                                         double gravity = conical_pendulum::standard_gravity);

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD {
extern template Sensitivity<double> sensitivity(const Chain<double>&, const Modes<double>&);
extern template Uncertainty<double> uncertainty(const Sensitivity<double>&, const Vector<double>&,
                                                const Deviations<double>&);
#if !defined(REVCHAIN_COMPILED_DOUBLE)
extern template Sensitivity<float> sensitivity(const Chain<float>&, const Modes<float>&);
extern template Uncertainty<float> uncertainty(const Sensitivity<float>&, const Vector<float>&,
                                               const Deviations<float>&);
extern template Sensitivity<long double> sensitivity(const Chain<long double>&,
                                                     const Modes<long double>&);
extern template Uncertainty<long double> uncertainty(const Sensitivity<long double>&,
                                                     const Vector<long double>&,
                                                     const Deviations<long double>&);
#endif
}  // namespace revchain
#else
#include "revchain/questions/rig_sensitivity.hpp"
#include "revchain/questions/sensitivity.hpp"
#endif
