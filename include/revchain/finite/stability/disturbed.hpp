// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include "revchain/finite/balance/links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Directions at right angles to the columns of a matrix.
inline Matrix<double> beside(const Matrix<double>& columns) {
    const Matrix<double> whole = Eigen::HouseholderQR<Matrix<double>>(columns).householderQ();
    return whole.rightCols(columns.rows() - columns.cols());
}

/// A shape as its links, their inclinations, lambda times the pull along each, the offsets of their lower pins (and of
/// the upper end, if that moves); and what links turn with about their own axes.
struct PulledLinks {
    std::vector<Link<double>> links;
    std::vector<double> inclination, pull, offset;
    std::vector<double> momentum, axial;  // lambda n times that along the axis, and the moment of inertia about it
    double stiffness = std::numeric_limits<double>::infinity();  // lambda times that of the support
    double carriage = 0;
    double lower_stiffness = std::numeric_limits<double>::infinity();  // of the lower end, if that is held
    double lower_carriage = 0;
    bool held = false;         // the lower end, too
    bool turns_freely = true;  // no torque about the axis
    ChainUnits units;

    explicit PulledLinks(const ChainUnits& of) : units(of) {}

    bool yields() const { return !std::isinf(stiffness); }
    bool lower_yields() const { return held && !std::isinf(lower_stiffness); }

    /// Adds a link; one that meets the last in a pin without mass or load stays in line with it, and is one with it.
    void add(const Link<double>& link, double delta, double pulled, double y, double turning = 0, double about = 0) {
        if (!links.empty()) {
            Link<double>& below = links.back();
            const bool massless = below.rest == 0 && below.cross == 0 && link.moment == 0 && link.cross == 0;
            const bool plain = turning == 0 && about == 0 && momentum.back() == 0 && axial.back() == 0;
            const auto alike = [](double x, double z, double size) { return std::abs(x - z) <= 1e-9 * size; };
            if (massless && plain && alike(delta, inclination.back(), 1) &&
                alike(pulled, pull.back(), std::abs(pulled))) {
                below.length += link.length, below.rest = link.rest;
                return;
            }
        }
        links.push_back(link), inclination.push_back(delta), pull.push_back(pulled), offset.push_back(y);
        momentum.push_back(turning), axial.push_back(about);
    }
};

/// Links disturbed from a shape by angles q in its plane and offsets y of the pins out of it, time in 1/n:
///     A q'' - 2 B y' + (diag(a P) - X'MX) q = 0,
///     M y'' + 2 B' q' + (K(P/a) - M) y = 0,
/// P lambda times the pull along each link, X q and Z q the pins' motions across and along the axis,
/// A = X'MX + Z'MZ, B = X'M - diag(p/a) D/2, D y the differences of y over a link, p lambda n times the angular
/// momentum that a link keeps about its own axis. A support that yields moves by the last q and the last y: to both
/// stiffnesses it adds lambda E, to M its carriage. So does a lower end on a spring, by the motion of the lowest pin.
/// Damping adds rates of dissipation: F q', H y' at the pins, drag in proportion to length and velocity in space.
struct Disturbed {
    Matrix<double> inertia, coupling, mass;  // A, B, M
    Matrix<double> in_plane, out_of_plane;   // both stiffnesses times lambda
    Matrix<double> turned;                   // what is less of the first where links turn with the plane
    Matrix<double> bending, swivelling;      // F, H
    Matrix<double> drag_in_plane, drag_coupling, drag_across;
    Matrix<double> ends;    // how the lower end moves with q, across the axis and along it
    Vector<double> offset;  // the shape: out of plane, a rotation
    bool turns_freely = true;

    Disturbed() = default;
    explicit Disturbed(const PulledLinks& shape) : turns_freely(shape.turns_freely) {
        const auto n = static_cast<Index>(shape.links.size());
        const Index pins = n + shape.yields();
        Matrix<double> across = Matrix<double>::Zero(pins, pins), along = across, spin = across;
        mass = in_plane = out_of_plane = turned = bending = drag_across = across;
        offset = Eigen::Map<const Vector<double>>(shape.offset.data(), pins);
        for (Index m = 0; m < n; ++m) {
            const auto i = static_cast<std::size_t>(m);
            const Link<double>& link = shape.links[i];
            const double a = link.length, pull = shape.pull[i];
            const double c = std::cos(shape.inclination[i]), s = std::sin(shape.inclination[i]);
            across.col(m).head(m + 1).setConstant(a * c);
            along.col(m).head(m + 1).setConstant(a * s);
            in_plane(m, m) = pull * a;
            turned(m, m) = shape.axial[i] * s * s;
            const auto element = [&](Matrix<double>& to, double lower, double mixed, double upper) {
                to(m, m) += lower;
                if (m + 1 < pins) to(m, m + 1) += mixed, to(m + 1, m) += mixed, to(m + 1, m + 1) += upper;
            };
            const double at_lower = link.moment - link.cross, at_upper = link.rest - link.cross;
            element(mass, at_lower, link.cross, at_upper);
            element(out_of_plane, pull / a - at_lower, -pull / a - link.cross, pull / a - at_upper);
            element(drag_across, a / 3, a / 6, a / 3);
            spin(m, m) = shape.momentum[i] / (2 * a);
            if (m + 1 < pins) spin(m, m + 1) = -spin(m, m);
            bending(m, m) += m == 0 && !shape.held ? 1 : 2;
            if (m > 0) bending(m, m - 1) = bending(m - 1, m) = -1;
        }
        if (shape.yields()) {
            across.col(n).setOnes();
            mass(n, n) += shape.carriage, in_plane(n, n) = shape.stiffness;
            out_of_plane(n, n) += shape.stiffness - shape.carriage;
        }
        if (shape.lower_yields()) {
            mass(0, 0) += shape.lower_carriage, out_of_plane(0, 0) += shape.lower_stiffness - shape.lower_carriage;
            in_plane += shape.lower_stiffness * across.row(0).transpose() * across.row(0);
        }
        ends.resize(pins, 2);
        ends << across.row(0).transpose(), along.row(0).transpose();
        const Matrix<double> swept = mass * across, centrifugal = across.transpose() * swept;
        coupling = swept.transpose() - spin;
        inertia = centrifugal + along.transpose() * mass * along;
        in_plane -= centrifugal;
        drag_coupling = across.transpose() * drag_across;
        drag_in_plane = drag_coupling * across + along.transpose() * drag_across * along;
        swivelling = swivelled(shape, pins);
    }

    /// Leaves of q the columns of Q and of y those of Y.
    void keep(const Matrix<double>& Q, const Matrix<double>& Y) {
        const auto within = [](Matrix<double>& of, const Matrix<double>& left, const Matrix<double>& right) {
            of = (left.transpose() * of * right).eval();
        };
        for (Matrix<double>* each : {&inertia, &in_plane, &turned, &bending, &drag_in_plane}) within(*each, Q, Q);
        for (Matrix<double>* each : {&coupling, &drag_coupling}) within(*each, Q, Y);
        for (Matrix<double>* each : {&mass, &out_of_plane, &swivelling, &drag_across}) within(*each, Y, Y);
    }

    /// Leaves angles that keep the lower end where it is, and offsets of the free pins; on a spring it moves across the
    /// axis.
    void hold_lower_end(bool yields) {
        const Index pins = offset.size() - 1;
        if (yields) return keep(beside(ends.col(1)), Matrix<double>::Identity(pins + 1, pins + 1));
        keep(beside(ends), Matrix<double>::Identity(pins + 1, pins + 1).rightCols(pins));
        offset = offset.tail(pins).eval();
    }

   private:
    /// Twice the dissipation of unit damping at the pins by offsets y out of the plane. A link turns across itself at
    /// D y/a; about itself it turns so that least is dissipated, unless it has a moment of inertia there, as does a
    /// support without torque about the axis: what rotation dissipates is 0.
    static Matrix<double> swivelled(const PulledLinks& shape, Index pins) {
        const auto n = static_cast<Index>(shape.links.size());
        const Index joints = n + shape.held;
        Matrix<double> given = Matrix<double>::Zero(2 * joints, pins), left = Matrix<double>::Zero(2 * joints, n + 2);
        const auto between = [&](Index m, auto&& place) {  // the joints of link m, below and above
            if (m > 0 || shape.held) place(m - 1 + shape.held, 1.0);
            place(m + shape.held, -1.0);
        };
        for (Index m = 0; m < n; ++m) {
            const auto i = static_cast<std::size_t>(m);
            const double c = std::cos(shape.inclination[i]), s = std::sin(shape.inclination[i]);
            const Eigen::Vector2d across(c, s), along(s, -c);
            between(m, [&](Index joint, double sign) {
                given.col(m).segment<2>(2 * joint) += sign / shape.links[i].length * across;
                if (m + 1 < pins) given.col(m + 1).segment<2>(2 * joint) -= sign / shape.links[i].length * across;
                if (shape.axial[i] == 0) left.col(m).segment<2>(2 * joint) = sign * along;
            });
        }
        if (shape.turns_freely) left(2 * joints - 1, n) = 1;
        if (shape.turns_freely && shape.held) left(1, n + 1) = 1;
        const Eigen::ColPivHouseholderQR<Matrix<double>> factor(left);
        const Matrix<double> seen = factor.householderQ().transpose() * given;
        const auto rest = seen.bottomRows(seen.rows() - factor.rank());
        return rest.transpose() * rest;
    }
};

}  // namespace revchain::finite
