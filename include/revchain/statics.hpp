// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"

/// Force diagrams of steady shapes; weights on a thread between supports, at rest and oscillating.
///
///     Eigen::VectorXd weight(2), position(4);
///     weight << 1, 2;
///     position << 0, 1, 2, 3;  // the first support, both weights, the last support
///     const auto polygon = revchain::funicular_polygon<double>(weight, position, 4.0);
///     polygon.height[1];      // -0.333333, with horizontal tension 4
///     const auto m = revchain::transverse_modes<double>(weight, position, 4.0);
///     m.conical_height[0];    // 0.394338
///
/// Greenhill (1908) §3. Lengths and weights in any units.
namespace revchain::inline REVCHAIN_BUILD {

/// The graphical construction of a steady shape, Figs. 3 and 5, as data. Links are lowest first,
/// pins free end first; a row is a point (x from the axis, z upwards).
///
/// The vertices of the funicular polygon are the pins, its sides the links, its loads `load`. In
/// the diagram of force the ray OQ_m from the pole O is parallel to link m, and its length is the
/// tension along the link. The weight of a plummet is on its pin, and Q_m is also the reaction. A
/// link of another kind divides its load between its pins by balance of moments.
struct ForceDiagram {
    Table<double> pin;       ///< (N + 1, 2) vertices; the support (0, 0) last
    Table<double> load;      ///< (N, 2) on all pins but the support: centrifugal force, -weight
    Table<double> ray;       ///< (N, 2) Q_m from O
    Table<double> reaction;  ///< (N, 2) from O: force at a link's upper pin on all that hangs below
    /// (N) x where the line of each load from O meets the horizontal line lambda below O: the x of
    /// a plummet; infinite for a load without weight, the x of the pin without load
    Vector<double> lifted;
    /// (N, 2) G_m of link m and all below it. With K_m on the axis lambda above the level of G_m,
    /// G_m K_m is parallel to the reaction.
    Table<double> centre_of_gravity;
    Vector<double> crossing;  ///< (N) z of C_m, where link m's line meets the axis; or infinite
    double conical_height = 0;
};

/// The diagram of a steady shape of this chain. Rays are sums of loads, so comparing them with the
/// links checks the shape. They are parallel to 5 ulp of the sum of all loads' magnitudes
/// (tests/cpp/statics.cpp). Cost O(N). Throws InvalidArgument unless the shape has as many links as
/// the chain.
[[nodiscard]] ForceDiagram force_diagram(const Chain<double>& chain, const SteadyShape& shape);

/// The straight chain with the weights of the shape moved to the axis at their levels. Each link's
/// length is the height between its two pins in the shape. Its mode at the shape's conical height
/// has the offsets of the shape. Throws InvalidArgument as `force_diagram`, and for an inverted
/// link.
[[nodiscard]] Chain<double> transferred_to_axis(const Chain<double>& chain,
                                                const SteadyShape& shape);

/// Weights on a thread between two supports, at rest in a vertical plane.
template <Real T>
struct FunicularPolygon {
    Vector<T> position;      ///< (n + 2) x of supports and weights
    Vector<T> height;        ///< (n + 2) z
    Vector<T> rise;          ///< (n + 1) vertical component of each side's tension
    Vector<T> tension;       ///< (n + 1) of each side, the length of its ray
    T horizontal_tension{};  ///< of every side
};

/// The polygon with a given horizontal component of tension: sides are parallel to the rays from
/// the pole (0, 0) to (horizontal_tension, rise) on the line of load. With n values of `weight`,
/// `position` has n + 2, with both supports. Accuracy: heights half an ulp, and 1e-28 of the drop
/// below the chord and of the supports' heights. Cost O(n). Throws InvalidArgument unless weights
/// and tension are positive, positions increase, and numbers and results are finite.
template <Real T>
[[nodiscard]] FunicularPolygon<T> funicular_polygon(const std::type_identity_t<Vector<T>>& weight,
                                                    const std::type_identity_t<Vector<T>>& position,
                                                    const T& horizontal_tension,
                                                    const T& first_height = T(0),
                                                    const T& last_height = T(0));

/// Small transverse oscillations of weights on a string, slowest first.
template <Real T>
struct TransverseModes {
    Vector<T> conical_height;  ///< (n) of the conical pendulum with the same period
    Vector<T> error_bound;     ///< (n) relative
    Table<T> shape;            ///< (n, n + 2) offsets, the largest 1 or -1, the first weight's >= 0

    /// Seconds, 2 pi sqrt(conical_height / g).
    [[nodiscard]] Vector<T> period(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        return conical_height.unaryExpr(
            [&](const T& height) { return conical_pendulum::period(height, gravity); });
    }
};

/// All transverse modes of weights on a thread of uniform tension, held at both ends. `weight` (n);
/// `position` (n + 2) with both supports. Method: an equivalent hanging chain (`modes`). Accuracy:
/// heights 2 ulp (tests/cpp/statics.cpp), within `error_bound`. Throws InvalidArgument unless there
/// are weights, weights and tension are positive, positions increase, and all numbers are finite.
template <Real T>
[[nodiscard]] TransverseModes<T> transverse_modes(const std::type_identity_t<Vector<T>>& weight,
                                                  const std::type_identity_t<Vector<T>>& position,
                                                  const T& tension);

}  // namespace revchain

#include "revchain/questions/statics.hpp"
