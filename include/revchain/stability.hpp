// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"
#include "revchain/finite/balance/newton.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain {

/// In what a chain is free to move when it is disturbed.
enum class StabilityFrame {
    free,    ///< ball joints, no torque about the axis: in and out of the plane of the shape
    driven,  ///< axles at right angles to a plane that is made to turn: in that plane alone
};

/// What becomes of a small disturbance of a steady shape.
enum class Verdict {
    minimum,  ///< of the energy seen from the turning frame (free: at constant angular momentum): it stays small
    spectrally_stable,  ///< it swings and does not grow, to first order, by gyroscopic forces
    unstable,           ///< it grows
    undecided,          ///< within the error of the exponents
};
inline std::string_view to_string(Verdict verdict) {
    constexpr std::string_view names[]{"minimum", "spectrally stable", "unstable", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

/// Times in units of 1/n, the turning speed.
struct Stability {
    StabilityFrame frame = StabilityFrame::free;
    Verdict verdict = Verdict::undecided;
    std::vector<std::complex<double>>
        exponents;                  ///< s of exp(s n t), by imaginary part; free: without rotation's own 0, 0
    double growth_rate = 0;         ///< largest real part
    double margin = 0;              ///< what of the growth rate rounding may explain
    Index negative_directions = 0;  ///< of the Hessian; free: of the amended one, rotation left out
};

namespace finite {

/// Links and shape without the pins that carry no mass, those of links without weight: the two links that meet in one
/// stay in line, and are one.
struct MassivePins {
    std::vector<Link<Wide<double>>> links;
    std::vector<double> inclination, offset;  ///< of the links; of their lower pins, over the unit of the links

    MassivePins(const std::vector<Link<Wide<double>>>& all, const SteadyShape& shape, double unit) {
        const auto none = [](const Wide<double>& x) { return x == Wide<double>(0); };
        for (std::size_t m = 0; m < all.size(); ++m) {
            const Link<Wide<double>>& link = all[m];
            const auto i = static_cast<Index>(m);
            if (m > 0 && none(links.back().rest) && none(links.back().cross) && none(link.moment) && none(link.cross)) {
                links.back().length = links.back().length + link.length;
                links.back().rest = link.rest;
                continue;
            }
            links.push_back(link);
            inclination.push_back(shape.inclination[i]), offset.push_back(shape.offset[i] * unit);
        }
    }
};

/// The chain disturbed from a shape by angles q of the links in its plane and offsets y of the pins out of it, time in
/// 1/n:
///     A q'' - 2 B y' + lambda (diag(kappa sec) - X'MX/lambda) q = 0,
///     M y'' + 2 B' q' + lambda (K(delta) - M/lambda) y = 0,
/// X q and Z q the pins' motions across and along the axis, A = X'MX + Z'MZ, B = X'M.
struct Disturbed {
    Matrix<double> inertia, coupling, mass;  // A, B, M
    Matrix<double> in_plane, out_of_plane;   // both stiffnesses times lambda
    Vector<double> offset;                   // the shape: out of plane, a rotation

    Disturbed(const MassivePins& chain, double height) {
        const auto& links = chain.links;
        const auto n = static_cast<Index>(links.size());
        Matrix<double> across = Matrix<double>::Zero(n, n), along = across;
        mass = Matrix<double>::Zero(n, n), in_plane = mass, out_of_plane = mass;
        offset = Eigen::Map<const Vector<double>>(chain.offset.data(), n);
        for (Index m = 0; m < n; ++m) {
            const auto& link = links[static_cast<std::size_t>(m)];
            const double a = static_cast<double>(link.length), cross = static_cast<double>(link.cross);
            const double inclination = chain.inclination[static_cast<std::size_t>(m)];
            const double cosine = std::cos(inclination), sine = std::sin(inclination);
            across.col(m).head(m + 1).setConstant(a * cosine), along.col(m).head(m + 1).setConstant(a * sine);
            const double pull = height * static_cast<double>(link.pull);
            in_plane(m, m) = pull * a / cosine;
            const double stiffness = pull / (a * cosine);
            const auto element = [&](Matrix<double>& to, double lower, double mixed, double upper) {
                to(m, m) += lower;
                if (m + 1 < n) to(m, m + 1) += mixed, to(m + 1, m) += mixed, to(m + 1, m + 1) += upper;
            };
            const double at_lower = static_cast<double>(link.moment) - cross,
                         at_upper = static_cast<double>(link.rest) - cross;
            element(mass, at_lower, cross, at_upper);
            element(out_of_plane, stiffness - at_lower, -stiffness - cross, stiffness - at_upper);
        }
        const Matrix<double> swept = mass * across;
        coupling = swept.transpose();
        const Matrix<double> centrifugal = across.transpose() * swept;
        inertia = centrifugal + along.transpose() * mass * along;
        in_plane -= centrifugal;
    }
};

/// Directions at right angles, in the masses, to one of all pins.
inline Matrix<double> beside(const Vector<double>& y, const Matrix<double>& mass) {
    const Vector<double> momentum = mass * y;
    const Eigen::HouseholderQR<Matrix<double>> factor{Matrix<double>(momentum)};
    const Matrix<double> whole = factor.householderQ();
    return whole.rightCols(y.size() - 1);
}

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

}  // namespace finite

/// What becomes of a small disturbance of a steady shape of `chain`.
///
/// Rotation about the axis costs nothing; in the free frame it is taken out by the angular momentum's constancy, which
/// adds 4 b b' / (y0'M y0), b = B y0, y0 the shape, to the stiffness in the plane, so that no double zero blurs the
/// exponents. Links are rods without inertia about their own axes: 4 N - 2 exponents of N links if free, 2 N if driven;
/// fewer where links have no weight, as two that meet in a pin without mass stay in line.
/// Accuracy: exponents to about 1e-13 of the largest where they are simple. Cost (4 N)^3: 1 ms for 10 links, a second
/// for 100. N = 1: omega = n sqrt(1 + 3 cos^2 d) free, n sin d driven (section 7 (6)).
inline Stability stability(const Chain<double>& chain, const SteadyShape& shape,
                           StabilityFrame frame = StabilityFrame::free) {
    if (shape.inclination.size() != chain.size())
        detail::throw_invalid("stability", "the shape is not of this chain; its links number",
                              shape.inclination.size());
    const auto links = finite::links_of(chain);
    const double unit = std::ldexp(1.0, -links.units.length_exponent);
    const finite::Disturbed d(finite::MassivePins(links.links, shape, unit), shape.conical_height * unit);
    const Index n = d.offset.size();
    Matrix<double> mass, gyroscopic, stiffness;
    if (frame == StabilityFrame::driven) {
        mass = d.inertia, stiffness = d.in_plane, gyroscopic = Matrix<double>::Zero(n, n);
    } else {
        const Matrix<double> others = finite::beside(d.offset, d.mass);
        const Index k = n - 1;
        mass = Matrix<double>::Zero(n + k, n + k), stiffness = mass, gyroscopic = mass;
        const Vector<double> b = d.coupling * d.offset;
        mass.topLeftCorner(n, n) = d.inertia;
        mass.bottomRightCorner(k, k) = others.transpose() * d.mass * others;
        stiffness.topLeftCorner(n, n) = d.in_plane + 4 / d.offset.dot(d.mass * d.offset) * b * b.transpose();
        stiffness.bottomRightCorner(k, k) = others.transpose() * d.out_of_plane * others;
        gyroscopic.topRightCorner(n, k) = -2 * d.coupling * others;
        gyroscopic.bottomLeftCorner(k, n) = -gyroscopic.topRightCorner(n, k).transpose();
    }
    return finite::judged(frame, n, mass, gyroscopic, stiffness);
}

}  // namespace revchain
