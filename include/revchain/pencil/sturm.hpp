// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>

#include "revchain/pencil/element.hpp"
#include "revchain/simd/pack.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packs never leave a translation unit

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// How many shifts one pass over the elements serves. The recursion waits on one division per element; eight shifts
/// fill that wait: in packs they cost what one costs, 7 ns a link.
inline constexpr std::size_t lanes = 8;

namespace detail {

/// `count_above` where weights span more than one unit. A function of its own, so that the other keeps to registers.
template <Real T, std::size_t L>
std::array<Index, L> count_above_in_units(const ElementPencil<T>& pencil, const std::array<T, L>& shifts) {
    using std::ldexp;
    std::array<T, L> below{};
    std::array<Index, L> negative{};
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const Element<T>& e = pencil.elements[m];
        const int step = pencil.step_down(m);
        for (std::size_t i = 0; i < L; ++i) {
            const T hung = step == 0 ? below[i] : ldexp(below[i], step);
            const T stiffness = shifts[i] * e.stiffness;
            const T pivot = not_zero(hung + (stiffness - e.lower), stiffness);
            negative[i] += pivot < T(0) ? 1 : 0;
            below[i] = propagate(e, stiffness, hung, e.upper, T(1) / pivot);
        }
    }
    return negative;
}

/// `count_above` in packs, whatever the compiler makes of loops.
template <bool spinning, std::floating_point T, std::size_t L>
std::array<Index, L> count_above_in_packs(const ElementPencil<T>& pencil, const std::array<T, L>& shifts) {
    return simd([&](auto registers) REVCHAIN_INLINED {
        constexpr std::size_t width = std::min(L, decltype(registers)::bytes / sizeof(T));
        using Packed = Pack<T, width, L / width>;
        const Packed shift = Packed::load(shifts.data()), least(least_pivot<T>()), square(epsilon<T>() * epsilon<T>());
        Packed below{};
        typename Packed::Mask negative{};
        const Packed factor = spinning ? shift * shift : shift;
        for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
            const Element<T>& e = pencil.elements[m];
            Packed stiffness = factor * Packed(e.stiffness);
            if constexpr (spinning) stiffness += shift * Packed(pencil.spin[m]);
            const Packed sum = below + (stiffness - Packed(e.lower));
            const Packed pivot = if_less(abs(sum), least, abs(stiffness) * square + least, sum);  // `not_zero`
            negative += pivot < Packed{};
            below =
                ((stiffness - Packed(e.upper)) * below - (stiffness - Packed(e.turning)) * Packed(e.weight)) / pivot;
        }
        std::array<Index, L> above;
        for (std::size_t i = 0; i < L; ++i) above[i] = -static_cast<Index>(negative[i]);
        return above;
    });
}

}  // namespace detail

/// For each shift h, the number of eigenvalues of the pencil above h: Sylvester's law of inertia on the dynamic
/// stiffness D of everything below a pin, carried up the chain (equation (1) of docs/theory/counts.md):
///
///     p = D + lambda k - A,    D' = [ (lambda k - B) D - (lambda k - c) W ] / p,    negative p are counted.
///
/// Preconditions: shifts positive; spins, L then being x^2 k + x s, in double and with a multiple of 8 shifts alone.
/// Cost: one pass, O(N). Accuracy: exact for a pencil whose entries differ by a few
/// ulp and whose parts below a pin are scaled by a few ulp for each link above; for a proof see `certified_count`.
template <Real T, std::size_t L>
std::array<Index, L> count_above(const ElementPencil<T>& pencil, const std::array<T, L>& shifts) {
    if (!pencil.units.empty()) return detail::count_above_in_units(pencil, shifts);
    if constexpr ((std::same_as<T, double> || std::same_as<T, float>)&&L % 8 == 0) {
        if (pencil.spin.empty()) return detail::count_above_in_packs<false>(pencil, shifts);
        return detail::count_above_in_packs<true>(pencil, shifts);
    }
    std::array<T, L> below{};
    std::array<Index, L> negative{};
    for (const Element<T>& e : pencil.elements) {
        for (std::size_t i = 0; i < L; ++i) {  // compilers turn this loop into SIMD code
            const T stiffness = shifts[i] * e.stiffness;
            const T pivot = not_zero(below[i] + (stiffness - e.lower), stiffness);
            negative[i] += pivot < T(0) ? 1 : 0;
            below[i] = propagate_in_one_unit(e, stiffness, below[i], e.upper, pivot);
        }
    }
    return negative;
}

/// A count with its proof: where `proved`, exactly `above` eigenvalues of the exact pencil exceed the exact shift.
struct CertifiedCount {
    Index above = 0;
    bool proved = false;
};

/// Counts with a running bound on the error of D, from rounding and from the entries' own error: `proved` when
/// no pivot's sign is in doubt. The bound follows the exact derivative dD'/dD = ((lambda k + X)/p)^2, without which it
/// would grow exponentially along the chain. D is carried by whichever of equations (1) and (2) has the smaller bound.
/// S is usually wider than the scalar of the answer.
/// Cost O(N): two shifts in double words of doubles take 140 ns a link, two in double 20 ns. Derivation:
/// docs/theory/counts.md, "Proved counts".
template <Real S, std::size_t L>
std::array<CertifiedCount, L> certified_count(const ElementPencil<S>& pencil, const std::array<S, L>& shifts) {
    using std::abs;
    using std::ldexp;
    using M = Narrow<S>;  // magnitudes and errors
    const M unit = operation_error<S>();
    const M local = M(2) * pencil.entry_error + M(6) * unit;  // stiffness times weight has both their errors
    const M slack = M(1) + M(4) * epsilon<M>();               // of magnitudes taken from rounded numbers
    const M inflate = M(1) + M(24) * epsilon<M>();            // the bound's own rounding
    const M tiny = M(2) * least_pivot<M>();
    std::array<M, L> underflow;  // of a pivot
    for (std::size_t i = 0; i < L; ++i)
        underflow[i] = tiny + abs(static_cast<M>(shifts[i])) * (M(2) * pencil.stiffness_underflow);

    std::array<S, L> below{};
    std::array<M, L> error{};
    std::array<CertifiedCount, L> result{};
    for (auto& r : result) r.proved = true;
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const Element<S>& e = pencil.elements[m];
        if (const int step = pencil.step_down(m); step != 0)
            for (std::size_t i = 0; i < L; ++i) {
                below[i] = ldexp(below[i], step);
                error[i] = ldexp(error[i], step) + tiny;
            }
        const M lower(static_cast<M>(e.lower)), upper(static_cast<M>(e.upper)), turning(static_cast<M>(e.turning));
        const M cross_size = abs(static_cast<M>(e.cross)) + M(2) * turning;
        for (std::size_t i = 0; i < L; ++i) {
            const S stiffness = shifts[i] * e.stiffness;
            const S pivot = below[i] + (stiffness - e.lower);
            const M size = abs(static_cast<M>(below[i]));
            const M k = static_cast<M>(stiffness);
            const M pivot_error = local * (k + lower + size) + underflow[i];
            const M least = abs(static_cast<M>(pivot)) * (M(1) - M(2) * epsilon<M>()) - pivot_error;
            const M least_with_below = least - error[i] * inflate;
            // Written so that a NaN anywhere withdraws the proof.
            result[i].proved = result[i].proved && least_with_below > M(0);
            result[i].above += pivot < S(M(0)) ? 1 : 0;

            const S coupling = stiffness + e.cross;
            const M coupling_error = local * (k + cross_size) + underflow[i];
            const M gain = abs(static_cast<M>(coupling)) * slack + coupling_error;
            const M inverse = M(1) / least;
            const M push = gain * inverse;
            // Quotients first: the products of small weights would underflow.
            const M by_weight = local * ((k + upper) * (size * inverse) + (k + turning) * (e.weight * inverse));
            const M by_coupling = local * (k + upper) + M(3) * (coupling_error * push) + (push * pivot_error) * push;
            const S one_over = S(M(1)) / not_zero(pivot, stiffness);
            const S by_weight_value = propagate(e, stiffness, below[i], e.upper, one_over);
            const M quotient = abs(static_cast<M>(by_weight_value));
            const bool coupled = by_coupling < by_weight + quotient * (pivot_error * inverse);
            below[i] = coupled ? propagate_by_coupling(stiffness, e.upper, coupling, one_over) : by_weight_value;
            const M own = coupled ? by_coupling : by_weight + quotient * (pivot_error * inverse);
            const M rest = underflow[i] * (M(1) + (size + e.weight) * inverse) +
                           tiny * (k + upper + turning + gain + (k + turning) * inverse);
            error[i] = inflate * (((push * error[i]) * gain) / least_with_below + own + rest +
                                  M(2) * unit * abs(static_cast<M>(below[i])));
        }
    }
    return result;
}

}  // namespace revchain::pencil

#pragma GCC diagnostic pop
