// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <complex>
#include <utility>
#include <vector>

#include "revchain/finite/stability/disturbed.hpp"
#include "revchain/finite/stability/forms.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/stability.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A verdict, and whether an exponent lost digits. It lost digits if its estimated error is above
/// 5e-11 of the largest exponent, or 5e-9 near 1, and in proportion more beyond 16 unknowns. The
/// estimate is usually about 1000 times the error. For almost equal motions, as of a light link in
/// and out of the plane, it is up to 40 times less (tests/python/test_light_links.py).
struct Judgement {
    Stability stability;
    bool is_spoilt = false;
};

/// An exponent, the effect of a unit of damping on it, and its error.
struct JudgedMode {
    std::complex<double> exponent;
    double internal, external, error;
};

/// Fills in the exponents, by imaginary part.
REVCHAIN_LAZY
void store(Stability& result, std::vector<JudgedMode> list) {
    const auto parts = [](const JudgedMode& x) {
        return std::pair(x.exponent.imag(), x.exponent.real());
    };
    std::sort(list.begin(), list.end(),
              [&](const JudgedMode& x, const JudgedMode& y) { return parts(x) < parts(y); });
    for (const JudgedMode& mode : list) {
        result.exponents.push_back(mode.exponent), result.exponent_error.push_back(mode.error);
        result.internal_damping.push_back(mode.internal);
        result.external_damping.push_back(mode.external);
    }
}

/// The forms of a disturbed shape in a frame. Without torque about the axis the angular momentum is
/// constant, which removes the rotation.
template <class S>
struct Framed {
    bool rotates;
    Matrix<S> in_plane, others, beside_shape;
    S turning{1};
    Vector<S> b;  ///< the rotation takes part with -2 (b.q) / turning
    pencil::GyroscopicPencil<S> forms;

    Framed(StabilityFrame frame, const DisturbedIn<S>& d)
        : rotates(frame == StabilityFrame::free && d.turns_freely), in_plane(d.in_plane) {
        using std::sqrt;
        const bool free = frame == StabilityFrame::free;
        others = Matrix<S>::Identity(d.offset.size(), free ? d.offset.size() : 0);
        beside_shape = others;
        b = Vector<S>::Zero(d.in_plane.rows());
        if (rotates) {
            const Vector<S> momentum = d.mass * d.offset;
            others = complement(Matrix<S>(momentum));  // orthogonal to the rotation in the masses
            beside_shape = complement(Matrix<S>(d.offset));
            turning = sqrt(S(d.offset.dot(momentum)));
            b = d.coupling * d.offset / turning;
            in_plane += pencil::product<S>(S(4) * b, b.transpose());
        } else if (!free) {
            in_plane -= d.turned;
        }
        forms = {d.inertia, pencil::product(d.coupling, others), congruent(d.mass, others),
                 in_plane, congruent(d.out_of_plane, others)};
    }
    /// Returns motions out of the plane, with the rotation, of columns q and of those of `others`.
    pencil::ComplexColumns<S> out_of_plane(const pencil::ComplexColumns<S>& q,
                                           const pencil::ComplexColumns<S>& r,
                                           const Vector<S>& offset) const {
        pencil::ComplexColumns<S> Y{pencil::product(others, r.real),
                                    pencil::product(others, r.imag)};
        for (Index j = 0; rotates && j < Y.real.cols(); ++j) {
            const S twice = S(2) / turning;
            Y.real.col(j) -= (twice * b.dot(q.real.col(j))) * offset;
            Y.imag.col(j) -= (twice * b.dot(q.imag.col(j))) * offset;
        }
        return Y;
    }
};

/// Sets the verdict by the energy, or else by the exponents.
template <class S>
void set_verdict(Stability& result, const Framed<S>& framed, const DisturbedIn<S>& d,
                 Verdict by_exponents) {
    const auto narrow = [](const Matrix<S>& A) {
        return Matrix<double>(A.template cast<double>());
    };
    const Matrix<double> inside = narrow(framed.in_plane),
                         across = narrow(congruent(d.out_of_plane, framed.beside_shape));
    const EnergySigns signs = energy_signs(inside, across, d.ends.rows());
    result.negative_directions = signs.negative;
    if (signs.is_minimum)
        result.verdict = Verdict::minimum;
    else if (by_exponents == Verdict::unstable || signs.is_certainly_negative)
        result.verdict = by_exponents;
}

}  // namespace revchain::finite
