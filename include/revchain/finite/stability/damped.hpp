// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "revchain/finite/stability/framed.hpp"
#include "revchain/pencil/complex/damped_gyroscopic.hpp"

/// Stability of shapes with dashpots at their pins.
namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns what `judged_in` returns, of a shape with dashpots. (x, -y) is the left vector of the
/// same s, so every change of the matrices moves s by a quotient of two products without
/// conjugation. Each exponent is corrected once by its quotient. Its error is that correction, and
/// the effect of roundings and of the doubt in masses and pulls.
template <class S>
std::optional<Judgement> judged_damped_in(StabilityFrame frame, const DisturbedIn<S>& d,
                                          const ChainUnits& units) {
    using Complex = std::complex<double>;
    const Framed<S> framed(frame, d);
    const Matrix<S> F = d.damped_in_plane, H = congruent(d.damped_across, framed.others);
    const auto modes = pencil::damped_gyroscopic_modes(framed.forms, F, H);
    if (!modes) return std::nullopt;
    const auto& [A, B, M, K, C] = framed.forms;
    const auto &x = modes->x, &y = modes->y;
    Judgement judgement;
    Stability& result = judgement.stability;
    result.frame = frame;
    const double pins = std::ldexp(1.0, -units.weight_exponent - 2 * units.length_exponent),
                 air = std::ldexp(1.0, units.length_exponent - units.weight_exponent);
    const double rounding = as_double(std::numeric_limits<S>::epsilon());
    const auto size = [](const Matrix<S>& of) { return as_double(of.norm()); };
    std::vector<JudgedMode> list;
    const Index count = modes->s.size();
    pencil::ComplexColumns<S> r = y;  // s y
    for (Index j = 0; j < count; ++j) {
        const std::complex<S> s = modes->s[j];
        r.real.col(j) = s.real() * y.real.col(j) - s.imag() * y.imag.col(j);
        r.imag.col(j) = s.real() * y.imag.col(j) + s.imag() * y.real.col(j);
    }
    const pencil::ComplexColumns<S> Y = framed.out_of_plane(x, r, d.offset);
    double largest = 0;
    for (Index j = 0; j < count; ++j) {
        using Z = std::complex<S>;
        const Z s = modes->s[j], two(S(2)), four(S(4));
        const Z masses = bilinear(x, A, x, j) - bilinear(y, M, y, j),
                rates = bilinear(x, F, x, j) - bilinear(y, H, y, j) - four * bilinear(x, B, y, j),
                pulls = bilinear(x, K, x, j) - bilinear(y, C, y, j);
        const Complex slope = rounded(two * s * masses + rates);
        const Complex off = rounded(s * (s * masses + rates) + pulls), start = rounded(s);
        Complex step = off / slope;
        if (!(std::abs(step) < 1e-3 * std::abs(start))) step = 0;
        const Complex now = start - step;
        const double far = std::abs(start), in_x = squared_norm(x, j), in_y = squared_norm(y, j);
        const double computed = far * far * (size(A) * in_x + size(M) * in_y) +
                                far * (size(F) * in_x + size(H) * in_y) +
                                4 * far * size(B) * std::sqrt(in_x * in_y) + size(K) * in_x +
                                size(C) * in_y;
        const double given =
            far * far * (hermitian(x, A, j) + hermitian(y, M, j)) + d.doubt * (in_x + in_y);
        constexpr double safety = 100;
        const double error =
            std::abs(step) + safety * (4 * 0x1p-52 * given + rounding * computed) / std::abs(slope);
        const auto turned =
            rounded(s * (bilinear(x, d.bending, x, j)) * s - bilinear(Y, d.swivelling, Y, j));
        const auto dragged =
            rounded(s * s * bilinear(x, d.drag_in_plane, x, j) -
                    two * bilinear(x, d.drag_coupling, Y, j) - bilinear(Y, d.drag_across, Y, j));
        const Complex over = slope * start;
        list.push_back(
            {now, -pins * (turned / over).real(), -air * (dragged / over).real(), error});
        result.growth_rate = std::max(result.growth_rate, now.real());
        result.margin = std::max(result.margin, error);
        largest = std::max(largest, far);
    }
    bool grows = false;
    const double lost = 5e-11 * std::max(1.0, as_double(count) / 32);
    for (const JudgedMode& mode : list) {
        grows = grows || mode.exponent.real() > mode.error;
        judgement.is_spoilt |=
            mode.error > lost * std::min(largest, 100 * std::max(1.0, std::abs(mode.exponent)));
    }
    store(result, std::move(list));
    set_verdict(result, framed, d, grows ? Verdict::unstable : Verdict::undecided);
    return judgement;
}

}  // namespace revchain::finite
