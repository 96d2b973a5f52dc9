// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "revchain/modes.hpp"
#include "revchain/rig.hpp"

/// Derivatives of conical heights and whirl speeds with respect to the data, and uncertainties that follow from them.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto m = revchain::modes(chain);
///     const auto s = revchain::sensitivity(chain, m);
///     s.weight().value(0, 1);       // d(height of the slowest mode)/d(weight of the upper link)
///     s.weight().error_bound(0, 1); // its absolute error, proved
namespace revchain {

/// The data of a link. While one of them changes, all the others are held, of this link and of all. `length` moves the
/// lower pin: centre of gravity and radius of gyration stay where they are, in units of length. `length_in_proportion`
/// takes both with it, as a plummet's thread and a rod's length do.
enum class Datum { weight, length, centroid, radius_of_gyration, length_in_proportion };

inline constexpr std::array<std::string_view, 5> datum_names{"weight", "length", "centroid", "radius_of_gyration",
                                                             "length_in_proportion"};

/// Derivatives of k conical heights with respect to one datum of each of N links, lowest first.
template <Real T>
struct Derivatives {
    Table<T> value;        ///< (k, N)
    Table<T> error_bound;  ///< (k, N), absolute; proved. Infinite where a mode could not be told from its neighbour
};

/// d(conical height)/d(datum) for modes number `first`, `first + 1`, ...
template <Real T>
struct Sensitivity {
    Index first = 1;
    std::array<Derivatives<T>, datum_names.size()> by_datum;

    const Derivatives<T>& of(Datum datum) const { return by_datum[static_cast<std::size_t>(datum)]; }
    const Derivatives<T>& weight() const { return of(Datum::weight); }  ///< unit of length over unit of weight
    const Derivatives<T>& length() const { return of(Datum::length); }  ///< no unit, as all below; 0 of the lowest link
    const Derivatives<T>& centroid() const { return of(Datum::centroid); }
    const Derivatives<T>& radius_of_gyration() const { return of(Datum::radius_of_gyration); }  ///< never negative
    /// (a d/da + h d/dh + rho d/drho)/a, never negative.
    const Derivatives<T>& length_in_proportion() const { return of(Datum::length_in_proportion); }
    Index size() const { return weight().value.rows(); }
};

/// How every datum of every link moves conical heights of `modes`, which has to be of this chain: the derivative of
/// lambda = y^T M y / y^T K y at the exact shape, where the shape's own change does not matter,
///     (y^T dM y - lambda y^T dK y) / y^T K y,
/// link by link from offset and slope, and of weights the sum of a s^2 over the links above, on which they bear.
/// Laws: sum of W d/dW = 0; sum of a d/da + h d/dh + rho d/drho = lambda; of it a link's part, a times
/// `length_in_proportion`, is its share of y^T K y, so that no link made longer as a whole lowers a height.
/// Accuracy: every entry within its error bound, which is proved; measured 0.51 ulp of the entry, but of entries small
/// beside the largest 1e-28 of that (tests/cpp/sensitivity.cpp). The heights in `modes` need not be accurate.
/// Cost: 1.5 microseconds a link and mode; O(N k) memory.
/// Throws InvalidArgument where the chain's weights are more than 1e123 apart.
template <Real T>
Sensitivity<T> sensitivity(const Chain<T>& chain, const Modes<T>& modes);

/// How uncertain one datum is: one standard deviation for every link, one for each (N), or a covariance (N, N).
/// Deviations of different links are independent unless a covariance says otherwise; those of different data always.
template <Real T>
struct Deviation {
    Vector<T> standard{};  ///< (1) or (N); empty where a covariance is given
    Matrix<T> covariance{};
};

/// One for each `Datum`; absent: exactly known.
template <Real T>
using Deviations = std::array<std::optional<Deviation<T>>, datum_names.size()>;

/// Standard deviations of k modes, to first order: deviations of the heights are taken as linear in those of the data.
template <Real T>
struct Uncertainty {
    Vector<T> conical_height;                        ///< (k,) standard deviations, in the unit of the heights
    Vector<T> relative;                              ///< (k,) over the heights; of speeds and periods half as much
    std::array<Table<T>, datum_names.size()> share;  ///< (k, N) each, of the variance; all of a mode add up to 1
    std::vector<Datum> datum;                        ///< (k,) what contributes most, and of which link (from 0)
    std::vector<Index> link;
};

/// Standard deviations of conical heights from those of the data: variance = sum of (d lambda/dx)^2 var x, with a
/// covariance C of one datum d^T C d. What is left out is of second order: the variance's relative error is some
/// (sigma_x d^2 lambda/dx^2 / (d lambda/dx))^2, large where a derivative is all but 0.
/// Cost O(k N), with a covariance O(k N^2). Throws InvalidArgument for lists that are neither of one number nor of N,
/// deviations negative or not finite, a covariance not N by N, not symmetric or with a negative variance, and heights
/// not as many as the sensitivity's.
template <Real T>
Uncertainty<T> uncertainty(const Sensitivity<T>& sensitivity, const Vector<T>& conical_height,
                           const Deviations<T>& deviations);

/// d(whirl speed)/d(datum) of one mode of a rig; everything else held. Speeds may have either sign. The first five are
/// of the links' own data as `Datum` has them: flywheels keep their momentum, what is displaced its place and size.
struct RigSensitivity {
    Vector<double> weight;                ///< (N,)
    Vector<double> length;                ///< (N,) the lower pin moved; 0 of the lowest link
    Vector<double> centroid;              ///< (N,)
    Vector<double> radius_of_gyration;    ///< (N,)
    Vector<double> length_in_proportion;  ///< (N,) (a d/da + h d/dh + rho d/drho)/a
    Vector<double> momentum;              ///< (N,) of each flywheel's H, per weight times length times time
    Vector<double> displaced_weight;      ///< (N,) of the weight of the fluid displaced
    Vector<double> added_weight;          ///< (N,) of what has to move with the link in still fluid
    double stiffness;                     ///< of the support; 0 where it is firm
    double carriage_weight;               ///< 0 where the support is firm
};

/// How what a chain is rigged with moves whirl speed n of a mode whose pins have these offsets (free end first, N + 1;
/// the last that of the support's pin). From y^T (K + n G - n^2 M/g) y = 0, quadratic in n and stationary in y,
///     dn/dx = - y^T (dK + n dG - n^2 dM/g) y / y^T (G - 2 n M/g) y.
/// With s a link's slope, dG of H is s^2 over links that hang, -s^2 over those that stand. Formed in double-double: the
/// error is that of the offsets, some 4 e (|K| + |n G| + n^2 |M|/g) over the denominator for offsets within e of the
/// largest.
/// Cost O(N). Throws InvalidArgument for a speed that is 0 or not finite, gravity not positive, offsets not N + 1.
RigSensitivity sensitivity(const Rig& rig, double angular_speed, const Vector<double>& offset,
                           double gravity = conical_pendulum::standard_gravity);

/// The momentum of the flywheel of the link at index `link`, all else held, with which
/// `angular_speed` is a whirl speed, of whichever mode. There is one: momentum adds to the tension, and what hangs
/// below and what holds above are springs at the link's pins at that speed. Formed in double-double:
/// relative error 1e-15 beside the tension (tests/cpp/linear/rig_sensitivity.cpp). Cost O(N).
/// Throws InvalidArgument for a speed that is 0 or not finite, gravity not positive, a link that is none, and where no
/// finite momentum has that effect.
double momentum_for_speed(const Rig& rig, Index link, double angular_speed,
                          double gravity = conical_pendulum::standard_gravity);

/// The stiffness of the support's spring, all else held, with which `angular_speed` is a whirl speed, of any mode: the
/// chain and what moves with its support act on the spring as one more spring at that speed. Formed in
/// double-double, as `momentum_for_speed` is. Cost O(N).
/// Throws InvalidArgument for a speed that is 0 or not finite, gravity not positive, and where no positive finite
/// stiffness has that effect.
double stiffness_for_speed(const Rig& rig, double angular_speed,
                           double gravity = conical_pendulum::standard_gravity);

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain {
extern template Sensitivity<float> sensitivity(const Chain<float>&, const Modes<float>&);
extern template Uncertainty<float> uncertainty(const Sensitivity<float>&, const Vector<float>&,
                                               const Deviations<float>&);
extern template Sensitivity<double> sensitivity(const Chain<double>&, const Modes<double>&);
extern template Uncertainty<double> uncertainty(const Sensitivity<double>&, const Vector<double>&,
                                                const Deviations<double>&);
extern template Sensitivity<long double> sensitivity(const Chain<long double>&, const Modes<long double>&);
extern template Uncertainty<long double> uncertainty(const Sensitivity<long double>&, const Vector<long double>&,
                                                     const Deviations<long double>&);
}  // namespace revchain
#else
#include "revchain/questions/rig_sensitivity.hpp"
#include "revchain/questions/sensitivity.hpp"
#endif
