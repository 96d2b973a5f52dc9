// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "revchain/finite/stability/pulled_links.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns an orthonormal basis of the complement of the columns.
template <class S>
Matrix<S> complement(const Matrix<S>& columns) {
    const Matrix<S> whole = Eigen::HouseholderQR<Matrix<S>>(columns).householderQ();
    return whole.rightCols(columns.rows() - columns.cols());
}

template <class S>
Matrix<S> congruent(const Matrix<S>& A, const Matrix<S>& X) {
    return pencil::transposed_product(X, pencil::product(A, X));
}

/// Links disturbed from a shape by angles q in its plane and angles b out of it, with time in 1/n:
///     A q'' - 2 B b' + (diag(a P) - X'MX) q = 0,
///     N b'' + 2 B' q' + (diag(a P) - N) b = 0,    N = Y'MY.
/// P is lambda times the pull along each link and M the masses of the pins. X q and Z q are the
/// motions of the pins across and along the axis, Y b those out of the plane. A = X'MX + Z'MZ and B
/// = X'MY - diag(p)/2, with p lambda n times the angular momentum of a link about its own axis. A
/// link moves all pins below it: X = U diag(a cos), Y = U diag(a), with U upper triangular of ones.
/// G = U'MU is computed link by link without cancellation. A support that yields moves by the last
/// q and b, which are lengths. It adds lambda E to both stiffnesses and its carriage to M. So does
/// a lower end on a spring, by the motion of the lowest pin. Angles are scaled so that stiffness
/// and mass add up to 1, for light links too. Damping adds rates of dissipation: F q', H b' at the
/// pins, and drag by length and velocity.
template <class S>
struct DisturbedIn {
    Matrix<S> inertia, coupling, mass;  // A, B, N
    Matrix<S> in_plane, out_of_plane;   // both stiffnesses times lambda
    Matrix<S> turned;                   // decrease of `in_plane` if links turn with the plane
    Matrix<S> bending, swivelling;      // F, H
    Matrix<S> damped_in_plane, damped_across;  // those of the dashpots at pins, if there are any
    Matrix<S> drag_in_plane, drag_coupling, drag_across;
    Matrix<S> ends;               // how the lower end moves with q, across the axis and along it
    Vector<S> lower_end;          // how it moves with b
    Vector<S> stiffness;          // lambda times that of links and support, for q and for b
    Vector<S> offset;             // the shape; as b, it is a rotation
    std::vector<Index> massless;  // pins without mass, lowest first
    double doubt = 0;             // the largest error of a stiffness over that of rounding
    bool turns_freely = true;

    bool is_damped() const { return damped_in_plane.size() != 0; }

    DisturbedIn() = default;
    explicit DisturbedIn(const PulledLinks& shape) : turns_freely(shape.turns_freely) {
        using std::abs, std::sqrt;
        const auto n = static_cast<Index>(shape.links.size());
        const Index pins = n + shape.yields();
        const auto link = [&](Index m) -> const Link<Fine>& {
            return shape.links[static_cast<std::size_t>(m)];
        };
        const auto at = [](const std::vector<double>& of, Index m) {
            return of[static_cast<std::size_t>(m)];
        };
        Matrix<S> G(pins, pins), length(pins, pins);
        Fine below(shape.lower_yields() ? shape.lower_carriage : 0.0), long_below(0.0);
        for (Index m = 0; m < pins; ++m) {  // sums of masses, and thirds and halves of lengths
            const bool is_link = m < n;
            const Fine zero(0.0), a = is_link ? link(m).length : zero;
            const Fine own = is_link ? link(m).moment - link(m).cross : Fine(shape.carriage);
            const auto fill = [m](Matrix<S>& of, const Fine& self, const Fine& others) {
                of(m, m) = S(self);
                of.row(m).tail(of.cols() - m - 1).setConstant(S(others));
                of.col(m).tail(of.cols() - m - 1).setConstant(S(others));
            };
            fill(G, below + own, is_link ? below + link(m).moment : zero);
            fill(length, long_below + a / Fine(3.0), long_below + a / Fine(2.0));
            if (is_link) below = below + link(m).moment + link(m).rest, long_below = long_below + a;
        }
        Vector<S> x(pins), y(pins), z(pins), turning = Vector<S>::Zero(pins), unit(pins);
        offset.resize(pins), stiffness.resize(pins);
        turned = Matrix<S>::Zero(pins, pins);
        for (Index m = 0; m < pins; ++m) {
            const bool is_link = m < n;
            const S s(is_link ? std::sin(at(shape.inclination, m)) : 0.0);
            y[m] = is_link ? S(link(m).length) : S(1);
            x[m] = is_link ? y[m] * S(std::cos(at(shape.inclination, m))) : S(1), z[m] = y[m] * s;
            stiffness[m] = is_link ? y[m] * S(at(shape.pull, m)) : S(shape.stiffness);
            offset[m] = is_link ? s : S(shape.upper_offset);
            const S size = abs(stiffness[m]) + y[m] * y[m] * G(m, m);
            unit[m] = size > S(0) ? S(1) / sqrt(size) : S(1);
            x[m] *= unit[m], y[m] *= unit[m], z[m] *= unit[m], stiffness[m] *= unit[m] * unit[m],
                offset[m] /= unit[m];
            const double off = is_link ? at(shape.doubt, m) : shape.stiffness;
            const S lever = is_link ? S(link(m).length) : S(1);
            doubt = std::max(doubt, as_double(lever * S(off) * unit[m] * unit[m]));
            if (!is_link) continue;
            turned(m, m) = S(at(shape.axial, m)) * s * s * unit[m] * unit[m];
            turning[m] = S(at(shape.momentum, m)) * unit[m] * unit[m] / S(2);
        }
        const auto spread = [](const Vector<S>& p, const Matrix<S>& of, const Vector<S>& q) {
            Matrix<S> result = of;
            for (Index j = 0; j < q.size(); ++j)
                result.col(j) = result.col(j).cwiseProduct(p) * q[j];
            return result;
        };
        const Matrix<S> centrifugal = spread(x, G, x);
        inertia = centrifugal + spread(z, G, z), coupling = spread(x, G, y), mass = spread(y, G, y);
        coupling.diagonal() -= turning;
        in_plane = -centrifugal, out_of_plane = -mass;
        in_plane.diagonal() += stiffness, out_of_plane.diagonal() += stiffness;
        if (shape.lower_yields()) {
            in_plane += pencil::product<S>(S(shape.lower_stiffness) * x, x.transpose());
            out_of_plane += pencil::product<S>(S(shape.lower_stiffness) * y, y.transpose());
        }
        drag_in_plane = spread(x, length, x) + spread(z, length, z);
        drag_coupling = spread(x, length, y), drag_across = spread(y, length, y);
        ends.resize(pins, 2), lower_end = y;
        ends << x, z;
        const std::vector<double> one(static_cast<std::size_t>(n + shape.held), 1.0);
        bending = spread(unit, bent(shape, pins, one).template cast<S>(), unit);
        swivelling = spread(unit, swivelled(shape, pins, one).template cast<S>(), unit);
        if (!shape.damping.empty()) {  // of a rig, the lower end of which is free
            damped_in_plane =
                spread(unit, bent(shape, pins, shape.damping).template cast<S>(), unit);
            damped_across =
                spread(unit, swivelled(shape, pins, shape.damping).template cast<S>(), unit);
        }
        for (Index m = 0; m < pins; ++m) {
            const bool lowest = m == 0 && shape.lower_yields() && shape.lower_carriage > 0;
            const bool lower = m < n && !(is_zero(link(m).moment) && is_zero(link(m).cross));
            const bool upper = m > 0 && !(is_zero(link(m - 1).rest) && is_zero(link(m - 1).cross));
            if (!lowest && !lower && !upper && !(m == n && shape.carriage > 0))
                massless.push_back(m);
        }
    }

    /// Restricts q to the columns of Q and b to those of Y.
    void keep(const Matrix<S>& Q, const Matrix<S>& Y) {
        for (Matrix<S>* of : {&inertia, &in_plane, &turned, &bending, &drag_in_plane})
            *of = congruent(*of, Q);
        if (is_damped())
            damped_in_plane = congruent(damped_in_plane, Q),
            damped_across = congruent(damped_across, Y);
        for (Matrix<S>* of : {&coupling, &drag_coupling})
            *of = pencil::transposed_product(Q, pencil::product(*of, Y));
        for (Matrix<S>* of : {&mass, &out_of_plane, &swivelling, &drag_across})
            *of = congruent(*of, Y);
    }

    /// Keeps the lower end fixed; if it is on a spring it may move across the axis.
    void hold_lower_end(bool yields) {
        const Index count = offset.size();
        if (yields)
            return keep(complement(Matrix<S>(ends.col(1))), Matrix<S>::Identity(count, count));
        const Matrix<S> held = complement(Matrix<S>(lower_end));
        keep(complement(ends), held);
        offset = (held.transpose() * offset).eval();
    }

    /// Eliminates an upper end on a spring and without mass: spring and top link are in series.
    void balance_upper_end() {
        const Index top = offset.size() - 1;
        Matrix<S> kept = Matrix<S>::Identity(top + 1, top);
        kept(top, top - 1) =
            stiffness(top - 1) * lower_end(top) / (lower_end(top - 1) * stiffness(top));
        keep(Matrix<S>::Identity(top + 1, top + 1), kept);
        offset = offset.head(top).eval();
        lower_end = (kept.transpose() * lower_end).eval();
    }

   private:
    /// Returns twice the dissipation by angles q of dashpots at the joints, lowest first.
    static Matrix<double> bent(const PulledLinks& shape, Index pins,
                               const std::vector<double>& damping) {
        const auto n = static_cast<Index>(shape.links.size());
        Matrix<double> result = Matrix<double>::Zero(pins, pins);
        const auto add = [&](Index joint, Index below, Index above) {
            const double c = damping[static_cast<std::size_t>(joint)];
            for (const Index m : {below, above})
                if (m >= 0 && m < n) result(m, m) += c;
            if (below < 0 || above >= n) return;
            result(below, above) -= c, result(above, below) -= c;
        };
        if (shape.held) add(0, -1, 0);
        for (Index m = 0; m < n; ++m) add(m + shape.held, m, m + 1);
        return result;
    }
    /// Returns twice the dissipation by angles b of dashpots at the joints. A link turns across
    /// itself at the rate b. Without a moment of inertia about itself it also turns so that it
    /// dissipates least. So does a support without torque about the axis. A rotation dissipates
    /// nothing.
    static Matrix<double> swivelled(const PulledLinks& shape, Index pins,
                                    const std::vector<double>& damping) {
        const auto n = static_cast<Index>(shape.links.size());
        const Index joints = n + shape.held;
        Matrix<double> given = Matrix<double>::Zero(2 * joints, pins),
                       left = Matrix<double>::Zero(2 * joints, n + 2);
        const auto between = [&](Index m, auto&& place) {  // calls place for both joints of m
            if (m > 0 || shape.held) place(m - 1 + shape.held, 1.0);
            place(m + shape.held, -1.0);
        };
        for (Index m = 0; m < n; ++m) {
            const auto i = static_cast<std::size_t>(m);
            const double c = std::cos(shape.inclination[i]), s = std::sin(shape.inclination[i]);
            const Eigen::Vector2d across(c, s), along(s, -c);
            between(m, [&](Index joint, double sign) {
                given.col(m).segment<2>(2 * joint) += sign * across;
                if (shape.axial[i] == 0) left.col(m).segment<2>(2 * joint) = sign * along;
            });
        }
        if (shape.turns_freely) left(2 * joints - 1, n) = 1;
        if (shape.turns_freely && shape.held) left(1, n + 1) = 1;
        for (Index joint = 0; joint < joints; ++joint) {
            const double root = std::sqrt(damping[static_cast<std::size_t>(joint)]);
            given.middleRows(2 * joint, 2) *= root, left.middleRows(2 * joint, 2) *= root;
        }
        const Eigen::ColPivHouseholderQR<Matrix<double>> factor(left);
        const Matrix<double> seen = factor.householderQ().transpose() * given;
        const auto rest = seen.bottomRows(seen.rows() - factor.rank());
        return rest.transpose() * rest;
    }
};

using Disturbed = DisturbedIn<double>;

}  // namespace revchain::finite
