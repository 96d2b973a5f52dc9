// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"
#include "revchain/finite/held/shape.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain {
namespace finite {

/// Directions at right angles to the columns of a matrix.
inline Matrix<double> beside(const Matrix<double>& columns) {
    const Matrix<double> whole = Eigen::HouseholderQR<Matrix<double>>(columns).householderQ();
    return whole.rightCols(columns.rows() - columns.cols());
}

/// A shape as its links, their inclinations, lambda times the pull along each, and the offsets of their lower pins.
struct PulledLinks {
    std::vector<Link<double>> links;
    std::vector<double> inclination, pull, offset;
};

/// The chain disturbed from a shape by angles q of the links in its plane and offsets y of the pins out of it, time in
/// 1/n:
///     A q'' - 2 B y' + (diag(a P) - X'MX) q = 0,
///     M y'' + 2 B' q' + (K(P/a) - M) y = 0,
/// P lambda times the pull along each link, X q and Z q the pins' motions across and along the axis,
/// A = X'MX + Z'MZ, B = X'M.
struct Disturbed {
    Matrix<double> inertia, coupling, mass;  // A, B, M
    Matrix<double> in_plane, out_of_plane;   // both stiffnesses times lambda
    Matrix<double> ends;                     // how the lower end moves with q, across the axis and along it
    Vector<double> offset;                   // the shape: out of plane, a rotation

    explicit Disturbed(const PulledLinks& shape) {
        const auto n = static_cast<Index>(shape.links.size());
        Matrix<double> across = Matrix<double>::Zero(n, n), along = across;
        mass = in_plane = out_of_plane = across;
        offset = Eigen::Map<const Vector<double>>(shape.offset.data(), n);
        for (Index m = 0; m < n; ++m) {
            const auto i = static_cast<std::size_t>(m);
            const Link<double>& link = shape.links[i];
            const double a = link.length, pull = shape.pull[i];
            across.col(m).head(m + 1).setConstant(a * std::cos(shape.inclination[i]));
            along.col(m).head(m + 1).setConstant(a * std::sin(shape.inclination[i]));
            in_plane(m, m) = pull * a;
            const auto element = [&](Matrix<double>& to, double lower, double mixed, double upper) {
                to(m, m) += lower;
                if (m + 1 < n) to(m, m + 1) += mixed, to(m + 1, m) += mixed, to(m + 1, m + 1) += upper;
            };
            const double at_lower = link.moment - link.cross, at_upper = link.rest - link.cross;
            element(mass, at_lower, link.cross, at_upper);
            element(out_of_plane, pull / a - at_lower, -pull / a - link.cross, pull / a - at_upper);
        }
        ends.resize(n, 2);
        ends << across.row(0).transpose(), along.row(0).transpose();
        const Matrix<double> swept = mass * across, centrifugal = across.transpose() * swept;
        coupling = swept.transpose();
        inertia = centrifugal + along.transpose() * mass * along;
        in_plane -= centrifugal;
    }

    /// Leaves angles that keep both ends where they are, and offsets of the free pins.
    void hold_lower_end() {
        const Matrix<double> kept = beside(ends);
        const Index pins = offset.size() - 1;
        inertia = (kept.transpose() * inertia * kept).eval(), in_plane = (kept.transpose() * in_plane * kept).eval();
        coupling = (kept.transpose() * coupling.rightCols(pins)).eval();
        mass = mass.bottomRightCorner(pins, pins).eval(), offset = offset.tail(pins).eval();
        out_of_plane = out_of_plane.bottomRightCorner(pins, pins).eval();
    }
};

/// The verdict on  M x'' + G x' + K x = 0  of a chain of so many links.
inline Stability judged(StabilityFrame frame, Index links, const Matrix<double>& mass, const Matrix<double>& gyroscopic,
                        const Matrix<double>& stiffness) {
    Stability result;
    result.frame = frame;
    result.exponents = pencil::gyroscopic_exponents(mass, gyroscopic, stiffness);
    std::sort(result.exponents.begin(), result.exponents.end(), [](const auto& x, const auto& y) {
        return x.imag() != y.imag() ? x.imag() < y.imag() : x.real() < y.real();
    });
    double largest = 0;
    for (const auto& s : result.exponents) {
        result.growth_rate = std::max(result.growth_rate, s.real());
        largest = std::max(largest, std::abs(s));
    }
    const pencil::Inertia sign = pencil::inertia(stiffness);
    result.negative_directions = sign.negative;
    const double rounding = 1e-14 * static_cast<double>(links) * stiffness.cwiseAbs().maxCoeff();
    result.margin = 1e-7 * largest;  // what two exponents that meet may be torn apart by
    if (sign.least > rounding)
        result.verdict = Verdict::minimum;
    else if (result.growth_rate > result.margin)
        result.verdict = Verdict::unstable;
    else if (result.growth_rate < 1e-4 * result.margin && sign.least < -rounding)
        result.verdict = Verdict::spectrally_stable;
    return result;
}

inline Stability judged(StabilityFrame frame, const Disturbed& d) {
    const Index n = d.in_plane.rows(), links = d.ends.rows(), k = d.offset.size() - 1;
    if (frame == StabilityFrame::driven) return judged(frame, links, d.inertia, Matrix<double>::Zero(n, n), d.in_plane);
    const Vector<double> momentum = d.mass * d.offset, b = d.coupling * d.offset;
    const Matrix<double> others = beside(momentum);  // offsets at right angles to the rotation, in the masses
    Matrix<double> mass = Matrix<double>::Zero(n + k, n + k), stiffness = mass, gyroscopic = mass;
    mass.topLeftCorner(n, n) = d.inertia;
    mass.bottomRightCorner(k, k) = others.transpose() * d.mass * others;
    stiffness.topLeftCorner(n, n) = d.in_plane + 4 / d.offset.dot(momentum) * b * b.transpose();
    stiffness.bottomRightCorner(k, k) = others.transpose() * d.out_of_plane * others;
    gyroscopic.topRightCorner(n, k) = -2 * d.coupling * others;
    gyroscopic.bottomLeftCorner(k, n) = -gyroscopic.topRightCorner(n, k).transpose();
    return judged(frame, links, mass, gyroscopic, stiffness);
}

/// Links and shape without the pins that carry no mass, those of links without weight: the two links that meet in one
/// stay in line, and are one.
inline PulledLinks pulled_links(const Links<Wide<double>>& chain, const SteadyShape& shape) {
    const double unit = std::ldexp(1.0, -chain.units.length_exponent);
    PulledLinks result;
    Index i = -1;
    for (const Link<double>& link : rounded<double>(chain.links)) {
        if (++i > 0) {
            Link<double>& below = result.links.back();
            if (below.rest == 0 && below.cross == 0 && link.moment == 0 && link.cross == 0) {
                below.length += link.length, below.rest = link.rest;
                continue;
            }
        }
        result.links.push_back(link);
        result.inclination.push_back(shape.inclination[i]), result.offset.push_back(shape.offset[i] * unit);
        result.pull.push_back(shape.conical_height * unit * link.pull / std::cos(shape.inclination[i]));
    }
    return result;
}

inline PulledLinks pulled_links(const Links<Wide<double>>& chain, const HeldShape& shape) {
    const auto length = [&](double x) { return std::ldexp(x, -chain.units.length_exponent); };
    const auto moment = [&](double x) { return std::ldexp(length(x), -chain.units.weight_exponent); };
    PulledLinks result{rounded<double>(chain.links), {}, {}, {}};
    double H = moment(-shape.lower_pull[0]);
    const double height = length(shape.conical_height), tau = moment(shape.lower_pull[1]);
    for (Index m = 0; m < shape.inclination.size(); ++m) {
        const Link<double>& link = result.links[static_cast<std::size_t>(m)];
        const double s = std::sin(shape.inclination[m]), c = std::cos(shape.inclination[m]);
        const double R = H + link.moment * length(shape.offset[m]), V = height * link.pull + tau;
        H = R + link.rest * length(shape.offset[m + 1]);
        result.inclination.push_back(shape.inclination[m]), result.offset.push_back(length(shape.offset[m]));
        result.pull.push_back(V * c + (R - link.cross * link.length * s) * s);
    }
    return result;
}

template <class Shape>
Disturbed disturbed(const Chain<double>& chain, const Shape& shape) {
    if (shape.inclination.size() != chain.size())
        revchain::detail::throw_invalid("stability", "the shape is not of this chain; its links number",
                                        shape.inclination.size());
    const double rounding = 1e-12 * chain.total_length();
    for (Index m = 0; m < chain.size(); ++m) {
        const double length = std::hypot(shape.offset[m] - shape.offset[m + 1], shape.height[m] - shape.height[m + 1]);
        if (!(std::abs(length - chain.length()[m]) <= rounding))
            revchain::detail::throw_invalid(
                "stability", "the shape is not of this chain; in it links[" + std::to_string(m) + "] is as long as",
                length);
    }
    return Disturbed(pulled_links(links_of(chain), shape));
}

}  // namespace finite

REVCHAIN_INLINE Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame) {
    return finite::judged(frame, finite::disturbed(chain, shape));
}

REVCHAIN_INLINE Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame) {
    finite::Disturbed d = finite::disturbed(chain, shape);
    d.hold_lower_end();
    for (Index m = 0; m < d.mass.rows(); ++m)
        if (!(d.mass.row(m).cwiseAbs().maxCoeff() > 0))
            detail::throw_invalid("stability", "pins must have mass; one that has none is number", m + 1);
    if (d.in_plane.size() == 0) {  // two links: nothing can move but by rotation
        Stability still;
        still.frame = frame, still.verdict = Verdict::minimum;
        return still;
    }
    return finite::judged(frame, d);
}

}  // namespace revchain
