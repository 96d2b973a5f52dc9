// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/shape.hpp"
#include "revchain/finite/stability/stability.hpp"

namespace revchain {
namespace finite {

/// The chain disturbed from a shape held at both ends: as `Disturbed`, but for the force at the lower end, angles that
/// keep both ends where they are (`kept`), and offsets out of the plane of the free pins alone.
struct HeldDisturbed {
    Matrix<double> inertia, coupling, mass, in_plane, out_of_plane;
    Vector<double> offset;

    HeldDisturbed(const Links<Wide<double>>& chain, const HeldShape& shape) {
        const auto n = static_cast<Index>(chain.links.size());
        const auto length = [&](double x) { return std::ldexp(x, -chain.units.length_exponent); };
        const auto moment = [&](double x) { return std::ldexp(length(x), -chain.units.weight_exponent); };
        Matrix<double> across = Matrix<double>::Zero(n, n), along = across, M = across, K = across;
        Matrix<double> ends(n, 2);
        Vector<double> turning(n);
        double H = moment(-shape.lower_pull[0]);
        const double height = length(shape.conical_height), tau = moment(shape.lower_pull[1]);
        for (Index m = 0; m < n; ++m) {
            const Link<double> link = rounded<double>(std::vector{chain.links[static_cast<std::size_t>(m)]})[0];
            const double a = link.length, s = std::sin(shape.inclination[m]), c = std::cos(shape.inclination[m]);
            const double R = H + link.moment * length(shape.offset[m]), V = height * link.pull + tau;
            const double pull = V * c + (R - link.cross * a * s) * s;
            H = R + link.rest * length(shape.offset[m + 1]);
            across.col(m).head(m + 1).setConstant(a * c), along.col(m).head(m + 1).setConstant(a * s);
            ends(m, 0) = a * c, ends(m, 1) = a * s;
            turning[m] = pull * a;
            const auto element = [&](Matrix<double>& to, double lower, double mixed, double upper) {
                to(m, m) += lower;
                if (m + 1 < n) to(m, m + 1) += mixed, to(m + 1, m) += mixed, to(m + 1, m + 1) += upper;
            };
            const double at_lower = link.moment - link.cross, at_upper = link.rest - link.cross;
            element(M, at_lower, link.cross, at_upper);
            element(K, pull / a - at_lower, -pull / a - link.cross, pull / a - at_upper);
        }
        const Matrix<double> whole = Eigen::HouseholderQR<Matrix<double>>(ends).householderQ();
        const Matrix<double> kept = whole.rightCols(n - 2);
        const Matrix<double> swept = M * across, centrifugal = across.transpose() * swept;
        const Matrix<double> stiffness = Matrix<double>(turning.asDiagonal()) - centrifugal;
        in_plane = kept.transpose() * stiffness * kept;
        inertia = kept.transpose() * (centrifugal + along.transpose() * M * along) * kept;
        coupling = kept.transpose() * swept.transpose().rightCols(n - 1);
        mass = M.bottomRightCorner(n - 1, n - 1), out_of_plane = K.bottomRightCorner(n - 1, n - 1);
        offset.resize(n - 1);
        for (Index m = 0; m + 1 < n; ++m) offset[m] = length(shape.offset[m + 1]);
    }
};

}  // namespace finite

/// Stability of a shape of `chain` with both ends held, on ball joints without a torque about the axis (free) or in a
/// plane that is made to turn (driven); see `stability` of `SteadyShape`. N links have 4 N - 8 exponents if free, 2 N -
/// 4 if driven, times n, with and without gravity.
///
/// Method: directions that leave both ends on the axis and their distance alone, dense. Accuracy: exponents to 1e-13 of
/// the largest where simple (tests/cpp/finite/stability/held.cpp). Cost (4 N)^3.
/// Throws InvalidArgument for a shape of another chain, and for a pin between links without mass.
inline Stability stability(const Chain<double>& chain, const HeldShape& shape,
                           StabilityFrame frame = StabilityFrame::free) {
    if (shape.inclination.size() != chain.size())
        detail::throw_invalid("stability", "the shape is not of this chain; its links number",
                              shape.inclination.size());
    const auto links = finite::links_of(chain);
    const Index n = chain.size();
    const finite::HeldDisturbed d(links, shape);
    for (Index m = 0; m + 1 < n; ++m)
        if (!(d.mass.row(m).cwiseAbs().maxCoeff() > 0))
            detail::throw_invalid("stability", "pins must have mass; one that has none is number", m + 1);
    const Index in = n - 2, out = n - 2;
    if (in == 0) {  // two links: nothing can move but by rotation
        Stability still;
        still.frame = frame, still.verdict = Verdict::minimum;
        return still;
    }
    if (frame == StabilityFrame::driven)
        return finite::judged(frame, n, d.inertia, Matrix<double>::Zero(in, in), d.in_plane);
    const Matrix<double> others = finite::beside(d.offset, d.mass);
    const Vector<double> b = d.coupling * d.offset;
    Matrix<double> mass = Matrix<double>::Zero(in + out, in + out), stiffness = mass, gyroscopic = mass;
    mass.topLeftCorner(in, in) = d.inertia;
    mass.bottomRightCorner(out, out) = others.transpose() * d.mass * others;
    stiffness.topLeftCorner(in, in) = d.in_plane + 4 / d.offset.dot(d.mass * d.offset) * b * b.transpose();
    stiffness.bottomRightCorner(out, out) = others.transpose() * d.out_of_plane * others;
    gyroscopic.topRightCorner(in, out) = -2 * d.coupling * others;
    gyroscopic.bottomLeftCorner(out, in) = -gyroscopic.topRightCorner(in, out).transpose();
    return finite::judged(frame, n, mass, gyroscopic, stiffness);
}

}  // namespace revchain
