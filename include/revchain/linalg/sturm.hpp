// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/linalg/element_pencil.hpp"

namespace revchain::linalg {

/// How many shifts one pass over the elements serves. The recursion waits on one division per element; eight shifts
/// fill that wait (measured: they cost what one costs at -O3, twice that at -O2).
inline constexpr std::size_t lanes = 8;

/// For each shift h, the number of eigenvalues of the pencil above h: Sylvester's law of inertia on the dynamic
/// stiffness D of everything below a pin, carried up the chain (equation (F) of docs/accuracy.md):
///
///     p = D + lambda k - A,    D' = [ (lambda k - B) D - lambda k W + C ] / p,    negative p are counted.
///
/// Preconditions: shifts positive. Cost: one pass, O(N). Accuracy: exact for a pencil whose entries differ by a few
/// ulp and whose parts below a pin are scaled by a few ulp for each link above; for a proof see `certified_count`.
template <Real T, std::size_t L>
std::array<Index, L> count_above(const ElementPencil<T>& pencil, const std::array<T, L>& shifts) {
    std::array<T, L> below{};
    std::array<Index, L> negative{};
    for (const Element<T>& e : pencil.elements) {
        for (std::size_t i = 0; i < L; ++i) {  // compilers turn this loop into SIMD code
            const T stiffness = shifts[i] * e.stiffness;
            const T pivot = not_zero(below[i] + (stiffness - e.lower), stiffness);
            negative[i] += pivot < T(0) ? 1 : 0;
            below[i] = carried(e, stiffness, below[i], e.upper, pivot);
        }
    }
    return negative;
}

/// A count with its proof: where `proved`, exactly `above` eigenvalues of the exact pencil exceed the exact shift.
struct CertifiedCount {
    Index above = 0;
    bool proved = false;
};

/// The same count with a running bound on the error of D, from rounding and from the entries' own error: `proved` when
/// no pivot's sign is in doubt. The bound follows the exact derivative dD'/dD = ((lambda k + X)/p)^2, without which it
/// would grow exponentially along the chain. S is usually wider than the scalar of the answer.
/// Cost O(N): two shifts in double words of doubles take 120 ns a link, two in double 15 ns. Derivation: docs/accuracy.md.
template <Real S, std::size_t L>
std::array<CertifiedCount, L> certified_count(const ElementPencil<S>& pencil, const std::array<S, L>& shifts) {
    using std::abs;
    using M = Narrow<S>;  // magnitudes and errors
    const M unit = operation_error<S>();
    const M local = M(2) * pencil.entry_error + M(6) * unit;             // stiffness times weight has both their errors
    const M relative = M(4) * epsilon<M>() + M(2) * pencil.entry_error;  // of magnitudes taken from rounded entries
    const M inflate = M(1) + M(16) * epsilon<M>();                       // the bound's own rounding
    const M underflow = std::numeric_limits<M>::min() * M(4);

    std::array<S, L> below{};
    std::array<M, L> error{};
    std::array<CertifiedCount, L> result{};
    for (auto& r : result) r.proved = true;
    for (const Element<S>& e : pencil.elements) {
        const M lower(static_cast<M>(e.lower)), upper(static_cast<M>(e.upper)), coupling(static_cast<M>(e.coupling));
        const M cross(static_cast<M>(cross_mass(e)));  // X
        const M cross_error = relative * (e.weight + lower + upper);
        for (std::size_t i = 0; i < L; ++i) {
            const S stiffness = shifts[i] * e.stiffness;
            const S pivot = below[i] + (stiffness - e.lower);
            const M size = abs(static_cast<M>(below[i]));
            const M k = static_cast<M>(stiffness);
            const M pivot_error = local * (k + lower + size) + underflow;
            const M pivot_size = abs(static_cast<M>(pivot)) * (M(1) - M(2) * epsilon<M>());
            const M least = pivot_size - pivot_error;
            const M least_with_below = least - error[i] * inflate;
            // Written so that a NaN anywhere withdraws the proof.
            result[i].proved = result[i].proved && least_with_below > M(0);
            result[i].above += pivot < S(M(0)) ? 1 : 0;
            below[i] = carried(e, stiffness, below[i], e.upper, not_zero(pivot, stiffness));

            const M gain = abs(k + cross) + (cross_error + relative * k);
            const M quotient = abs(static_cast<M>(below[i]));
            const M numerator_error =
                local * ((k + upper) * size + k * e.weight + coupling) + underflow * (M(1) + size);
            error[i] = inflate * ((gain / least) * (gain / least_with_below) * error[i] +
                                  (numerator_error + quotient * pivot_error) / least + M(2) * unit * quotient);
        }
    }
    return result;
}

}  // namespace revchain::linalg
