// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/damped/exponents.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A damped rig's pencil, and what is known of its exponents before they are found.
struct DampedSystem {
    RigPencil rig;
    bool momentum;  ///< the motions of one sense are no conjugates of the other's
    bool
        rests;  ///< a free trolley with a dashpot or drag: it rests anywhere, and one exponent is 0
    bool drifts;  ///< without it the momentum is constant, and its offset follows from the links'
    bool inertia = false;  ///< whether M is regular: there are twice as many exponents as freedoms

    DampedSystem(const Rig& of, double gravity)
        : rig(rig_pencil(of, gravity, {}, true)),
          momentum(of.has_momentum()),
          rests(of.support().is_free() && (of.support().damping.high > 0 || of.has_drag())),
          drifts(pencil::keeps_momentum(rig.pencil)) {}

    const pencil::DampedPencil& pencil() const { return rig.pencil; }
    Index exponents() const { return 2 * (rig.pencil.size() - (drifts ? 1 : 0)); }
};

/// Returns starts of the exponents that are not 0, in double; sets `inertia`.
REVCHAIN_LAZY
std::vector<pencil::Complex> first_exponents(DampedSystem& of) {
    using pencil::Complex;
    pencil::DampedMatrices matrices(of.pencil());
    if (of.drifts) matrices.leave_out_trolley();
    const auto& [K, C, G, M] = matrices;
    const pencil::FirstExponents first =
        of.momentum
            ? pencil::first_exponents<Complex>(
                  K.cast<Complex>(), C.cast<Complex>() - Complex(0, 1) * G.cast<Complex>(), M)
            : pencil::first_exponents<double>(K, C, M);
    of.inertia = first.inertia;
    std::vector<Complex> starts = first.s;
    const auto smaller = [](const Complex& x, const Complex& y) {
        return std::abs(x) < std::abs(y);
    };
    if (of.rests && !starts.empty())
        starts.erase(std::min_element(starts.begin(), starts.end(), smaller));
    return starts;
}

/// Sorts exponents as modes are numbered.
REVCHAIN_LAZY
void sort_by_size(std::vector<pencil::DampedRoot>& roots) {
    std::sort(roots.begin(), roots.end(),
              [](const auto& x, const auto& y) { return size_of(x.s) < size_of(y.s); });
}

/// Returns all exponents but 0, refined, of each conjugate pair one, by size.
REVCHAIN_LAZY
std::vector<pencil::DampedRoot> damped_roots(DampedSystem& of) {
    using pencil::Complex;
    const std::vector<Complex> starts = first_exponents(of);
    std::vector<pencil::DampedRoot> roots;
    std::vector<Complex> known;  // with conjugates
    const auto take = [&](const Complex& start) {
        check_interrupt();
        pencil::DampedRoot root = pencil::refined(of.pencil(), start);
        const auto s = static_cast<Complex>(root.s);
        const bool pair = !of.momentum && !root.real;
        const auto is_near = [&](const Complex& other) {
            return std::abs(other - s) <= 1e-9 * std::abs(s);
        };
        if (!(root.correction < 1e-3) || (pair && !(s.imag() > 0)) ||
            std::any_of(known.begin(), known.end(), is_near))
            return;
        known.push_back(s);
        if (pair) known.push_back(std::conj(s));
        roots.push_back(std::move(root));
    };
    for (const Complex& s : starts)
        if (of.momentum || s.imag() >= 0) take(s);
    // Eigen loses the smallest exponents of a wide range.
    const Index zeros = of.drifts ? 2 : of.rests ? 1 : 0, all = of.exponents() - (of.rests ? 1 : 0);
    for (int attempt = 0; of.inertia && attempt < 12; ++attempt) {
        const Index missing = all - static_cast<Index>(known.size());
        if (missing <= 0) break;
        double least = known.empty() ? 1.0 : std::numeric_limits<double>::infinity();
        for (const Complex& s : known) least = std::min(least, std::abs(s));
        const Complex beside(-1, attempt % 2 == 0 && missing > 1 ? 0.7 : 0);
        Complex s = pencil::further_exponent(of.pencil(), known, zeros,
                                             beside * least * std::pow(10.0, -2.0 * (attempt / 2)));
        if (!of.momentum && std::abs(s.imag()) < 1e-6 * std::abs(s)) s = s.real();
        take(!of.momentum && s.imag() < 0 ? std::conj(s) : s);
    }
    sort_by_size(roots);
    return roots;
}

}  // namespace revchain::detail
