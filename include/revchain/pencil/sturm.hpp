// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>

#include "revchain/pencil/element.hpp"
#include "revchain/pencil/jointed.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The number of shifts in one pass over the elements. The recursion waits for one division an
/// element. Eight shifts fill that wait: in packs they cost as much as one shift, 7 ns a link.
inline constexpr std::size_t lanes = 8;

namespace detail {

/// Carries the dynamic stiffness D of everything below a pin up the elements, at several shifts,
/// and counts negative pivots. `Carry` is the method, with or without an error bound.
template <class Carry, class Pencil, class X, std::size_t L>
[[gnu::always_inline]] inline auto carried_up(const Carry& carry, const Pencil& pencil,
                                              const std::array<X, L>& shifts) {
    std::array<typename Carry::Shift, L> at;
    std::array<typename Carry::State, L> state{};
    for (std::size_t i = 0; i < L; ++i) {
        at[i] = carry.at(shifts[i]);
        if constexpr (Pencil::own_errors)
            if (pencil.ground) carry.begin(*pencil.ground, at[i], state[i]);
    }
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const auto& e = pencil.elements[m];
        if constexpr (Carry::in_units)
            if (const int step = pencil.step_down(m); step != 0)
                for (auto& each : state) each.change_unit(step);
        const auto sizes = carry.sizes(e);
        for (std::size_t i = 0; i < L; ++i) carry(e, sizes, at[i], state[i]);
    }
    return state;
}

/// The stiffness D and the number of negative pivots, at one shift or at each shift of a pack.
template <class V>
struct Counted {
    V below{};
    std::conditional_t<IsPack<V>, V, Index> negative{};

    void change_unit(int step) {
        using std::ldexp;
        below = ldexp(below, step);
    }
    [[gnu::always_inline]] void add(const V& pivot) {
        if constexpr (IsPack<V>)
            negative += if_less(pivot, V{}, V(1), V{});
        else
            negative += pivot < V(0) ? 1 : 0;
    }
};

/// The method without an error bound. Loops need only registers, unless `InUnits` (several units).
template <class Pencil, class V, bool InUnits>
struct PlainCarry {
    using Shift = Factors<V>;
    using State = Counted<V>;
    static constexpr bool in_units = InUnits;
    const Pencil& pencil;

    [[gnu::always_inline]] Shift at(const V& x) const { return pencil.factors(x); }
    [[gnu::always_inline]] static int sizes(const auto&) { return 0; }
    [[gnu::always_inline]] static void begin(const auto& ground, const Shift& at, State& state) {
        state.below = ground.stiffness_at(at) - V(ground.upper);
    }
    [[gnu::always_inline]] void operator()(const auto& e, int, const Shift& at,
                                           State& state) const {
        const V stiffness = e.stiffness_at(at);
        const V pivot = not_zero(V(state.below + (stiffness - V(e.lower))), e.size(stiffness));
        state.add(pivot);
        if constexpr (InUnits)
            state.below = propagate(e, stiffness, state.below, V(e.upper), V(1) / pivot);
        else
            state.below = propagate_in_one_unit(e, stiffness, state.below, V(e.upper), pivot);
    }
};

}  // namespace detail

/// Returns, for each shift x, the number of negative eigenvalues of Q(x). For a hanging chain it is
/// the number of eigenvalues above x. The method is Sylvester's law of inertia on the dynamic
/// stiffness D of everything below a pin, carried up the chain (equation (1) of
/// docs/theory/counts.md):
///
///     p = D + L - A,    D' = [ (L - B) D - (L - c) W ] / p,    negative p are counted.
///
/// Precondition for hanging chains: shifts are positive. Cost: one pass, O(N). Accuracy: exact for
/// a pencil whose entries differ by a few ulp and whose parts below a pin are scaled by a few ulp
/// for each link above. For a proof use `certified_count`.
template <Real T, std::size_t L, bool Spins, bool OwnErrors>
std::array<Index, L> count_above(const ElementPencil<T, Spins, OwnErrors>& pencil,
                                 const std::array<T, L>& shifts) {
    using Pencil = ElementPencil<T, Spins, OwnErrors>;
    std::array<Index, L> above;
    if constexpr (OwnErrors)
        if (pencil.has_joints()) {
            std::transform(shifts.begin(), shifts.end(), above.begin(),
                           [&](const T& x) { return jointed_count(pencil, x); });
            return above;
        }
    const auto counted = [&](const auto& state) {
        for (std::size_t i = 0; i < L; ++i) above[i] = state[i].negative;
        return above;
    };
    if (!pencil.units.empty())
        return counted(
            detail::carried_up(detail::PlainCarry<Pencil, T, true>{pencil}, pencil, shifts));
    if constexpr ((std::same_as<T, double> || std::same_as<T, float>)&&L % 8 == 0) {
        return simd([&](auto registers) REVCHAIN_INLINED {  // in packs, for any compiler
            constexpr std::size_t width = std::min(L, decltype(registers)::bytes / sizeof(T));
            using V = Pack<T, width, L / width>;
            const detail::PlainCarry<Pencil, V, false> carry{pencil};
            const auto state =
                detail::carried_up(carry, pencil, std::array{V::load(shifts.data())});
            for (std::size_t i = 0; i < L; ++i) above[i] = static_cast<Index>(state[0].negative[i]);
            return above;
        });
    } else {
        return counted(
            detail::carried_up(detail::PlainCarry<Pencil, T, false>{pencil}, pencil, shifts));
    }
}

namespace detail {

/// The stiffness D below a pin at one shift, its error bound, and the number of negative pivots.
template <Real S>
struct BoundedStiffness {
    using M = Narrow<S>;  // magnitudes and errors
    S below{};
    M error{};
    CertifiedCount count{0, true};

    /// Returns twice the least pivot, which exceeds the loss by underflow.
    static M tiny() { return M(2) * least_pivot<M>(); }
    void change_unit(int step) {
        using std::ldexp;
        below = ldexp(below, step);
        error = ldexp(error, step) + tiny();
    }
};

template <class Pencil>
class BoundedCarry;

/// The method with a bound for a hanging chain: small relative errors, no negative mass or
/// stiffness. The bound uses the exact derivative dD'/dD = ((L + X)/p)^2; without it the bound
/// would grow exponentially along the chain. D is carried by the equation, (1) or (2), with the
/// smaller bound.
template <Real S>
class BoundedCarry<ElementPencil<S>> {
   public:
    using M = Narrow<S>;  // magnitudes and errors
    using State = BoundedStiffness<S>;
    static constexpr bool in_units = true;
    struct Shift {
        S x;
        M underflow;  // the underflow of a pivot
    };
    struct Sizes {
        M lower, upper, turning, cross;
    };

    explicit BoundedCarry(const ElementPencil<S>& pencil)
        : local_(M(2) * pencil.entry_error + M(6) * unit()),
          stiffness_underflow_(pencil.stiffness_underflow) {}

    Shift at(const S& x) const {
        using std::abs;
        return {x, tiny() + abs(static_cast<M>(x)) * (M(2) * stiffness_underflow_)};
    }
    static Sizes sizes(const Element<S>& e) {
        using std::abs;
        const M turning(static_cast<M>(e.turning));
        return {static_cast<M>(e.lower), static_cast<M>(e.upper), turning,
                abs(static_cast<M>(e.cross)) + M(2) * turning};
    }
    [[gnu::always_inline]] void operator()(const Element<S>& e, const Sizes& of, const Shift& shift,
                                           State& at) const {
        using std::abs;
        const M inflate = M(1) + M(24) * epsilon<M>();  // the rounding of the bound itself
        const M slack = M(1) + M(4) * epsilon<M>();     // the error of rounded magnitudes
        const S stiffness = shift.x * e.stiffness;
        const S pivot = at.below + (stiffness - e.lower);
        const M size = abs(static_cast<M>(at.below));
        const M k = static_cast<M>(stiffness);
        const M pivot_error = local_ * (k + of.lower + size) + shift.underflow;
        const M least = abs(static_cast<M>(pivot)) * (M(1) - M(2) * epsilon<M>()) - pivot_error;
        const M least_with_below = least - at.error * inflate;
        // The comparison is written so that any NaN withdraws the proof.
        at.count.proved = at.count.proved && least_with_below > M(0);
        at.count.above += pivot < S(M(0)) ? 1 : 0;

        const S coupling = stiffness + e.cross;
        const M coupling_error = local_ * (k + of.cross) + shift.underflow;
        const M gain = abs(static_cast<M>(coupling)) * slack + coupling_error;
        const M inverse = M(1) / least;
        const M push = gain * inverse;
        // Quotients come first: the products of small weights would underflow.
        const M by_weight =
            local_ * ((k + of.upper) * (size * inverse) + (k + of.turning) * (e.weight * inverse));
        const M by_coupling =
            local_ * (k + of.upper) + M(3) * (coupling_error * push) + (push * pivot_error) * push;
        const S one_over = S(M(1)) / not_zero(pivot, stiffness);
        const S by_weight_value = propagate(e, stiffness, at.below, e.upper, one_over);
        const M quotient = abs(static_cast<M>(by_weight_value));
        const bool coupled = by_coupling < by_weight + quotient * (pivot_error * inverse);
        at.below = coupled ? propagate_by_coupling(stiffness, e.upper, coupling, one_over)
                           : by_weight_value;
        const M own = coupled ? by_coupling : by_weight + quotient * (pivot_error * inverse);
        const M rest = shift.underflow * (M(1) + (size + e.weight) * inverse) +
                       tiny() * (k + of.upper + of.turning + gain + (k + of.turning) * inverse);
        at.error = inflate * (((push * at.error) * gain) / least_with_below + own + rest +
                              M(2) * unit() * abs(static_cast<M>(at.below)));
    }

   private:
    static M tiny() { return State::tiny(); }
    static M unit() { return operation_error<S>(); }

    M local_;  // stiffness times weight has the errors of both
    M stiffness_underflow_;
};

/// The method for elements of any sign, each with its own error bounds. D' = L - B - (L + X)^2/p
/// has the slopes q^2 in D and -A, (1 - q)^2 in L, -1 in B, -2q in X. Here q = (L + X)/p and 1 - q
/// = (D - A - X)/p. The roundings of numerator, p and quotient are added. For a hanging chain it
/// proves as much as the other form, in 1.4 times the time (4 times in double).
template <Real S>
class BoundedCarry<SignedPencil<S>> {
   public:
    using M = Narrow<S>;
    using State = BoundedStiffness<S>;
    static constexpr bool in_units = true;
    struct Shift {
        Factors<S> x;
        M stiffness_size, spin_size;
    };
    struct Sizes {
        M stiffness, spin, lower, upper, cross, weight, determinant;
    };

    explicit BoundedCarry(const SignedPencil<S>& pencil) : pencil_(pencil) {}

    Shift at(const S& x) const {
        const Factors<S> f = pencil_.factors(x);
        return {f, size_of(f.stiffness), size_of(f.spin)};
    }
    static Sizes sizes(const SignedElement<S>& e) {
        const M lower = size_of(e.lower), upper = size_of(e.upper), cross = size_of(e.cross);
        return {size_of(e.stiffness),
                size_of(e.spin),
                lower,
                upper,
                cross,
                lower + upper + M(2) * cross,
                lower * upper + cross * cross};
    }
    static void begin(const SignedElement<S>& ground, const Shift& shift, State& at) {
        const M a = shift.stiffness_size, b = shift.spin_size;
        const M size =
            a * size_of(ground.stiffness) + b * size_of(ground.spin) + size_of(ground.upper);
        const ElementError<M>& off = ground.error;
        at.below = ground.stiffness_at(shift.x) - ground.upper;
        at.error =
            (M(1) + M(64) * epsilon<M>()) * (a * off.stiffness + b * off.spin + off.upper +
                                             M(5) * operation_error<S>() * size + underflow());
    }
    [[gnu::always_inline]] void operator()(const SignedElement<S>& e, const Sizes& of,
                                           const Shift& shift, State& at) const {
        using std::abs;
        const M u = operation_error<S>();
        const M inflate = M(1) + M(64) * epsilon<M>();  // the rounding of the bound itself
        const M tiny = State::tiny();
        const ElementError<M>& off = e.error;
        const S L = e.stiffness_at(shift.x);
        const M a = shift.stiffness_size, b = shift.spin_size,
                L_size = a * of.stiffness + b * of.spin;
        const M L_error = (a * off.stiffness + b * off.spin) + M(4) * u * L_size + underflow();
        const S p = at.below + (L - e.lower);
        const M D_size = size_of(at.below),
                p_size = abs(static_cast<M>(p)) * (M(1) - M(2) * epsilon<M>());
        const M p_rounding = M(3) * u * (D_size + L_size + of.lower);
        const M least = p_size - inflate * (at.error + L_error + off.lower + p_rounding);
        // The comparison is written so that any NaN withdraws the proof.
        at.count.proved = at.count.proved && least > tiny;
        at.count.above += p < S(M(0)) ? 1 : 0;

        const S pivot = abs(p) < S(tiny) ? S(tiny) : p;
        const S next = propagate_in_one_unit(e, L, at.below, e.upper, pivot);
        if (at.count.proved) {  // the bound is needed only for a proof
            const M C_size = size_of(L + e.cross) + L_error + off.cross;
            const M q = C_size / least;
            const M r = (D_size + at.error + of.lower + off.lower + of.cross + off.cross) / least;
            const M slopes =
                q * q * (at.error + off.lower) + r * r * L_error + off.upper + M(2) * q * off.cross;
            const M roundings =
                M(8) * u * ((L_size + of.upper) * (D_size / least) + L_size * (of.weight / least)) +
                M(8) * u * (of.determinant / least) +
                size_of(next) * (p_rounding / least + M(4) * u);
            const M lost = underflow() * (M(1) + L_size + of.upper + D_size + of.weight) *
                           (M(1) + M(1) / least);
            at.error = inflate * (slopes + roundings + lost);
        }
        at.below = next;
    }

   private:
    static M underflow() { return M(64) * std::numeric_limits<M>::denorm_min(); }
    static M size_of(const S& x) {
        using std::abs;
        return abs(static_cast<M>(x)) * (M(1) + M(4) * epsilon<M>());  // x is rounded
    }
    const SignedPencil<S>& pencil_;
};

}  // namespace detail

/// Returns the number of negative eigenvalues of the exact Q at each exact shift. A running bound
/// covers the error of D from rounding and from the entries. `proved` is true if every pivot's sign
/// is certain. S is usually wider than the scalar of the result. Cost O(N): two shifts take 140 ns
/// a link in double words, 20 ns in double. Derivation: docs/theory/counts.md, "Proved counts".
template <Real S, std::size_t L, bool Spins, bool OwnErrors>
std::array<CertifiedCount, L> certified_count(const ElementPencil<S, Spins, OwnErrors>& pencil,
                                              const std::array<S, L>& shifts) {
    std::array<CertifiedCount, L> result;
    if constexpr (OwnErrors)
        if (pencil.has_joints()) {
            std::transform(shifts.begin(), shifts.end(), result.begin(), [&](const S& x) {
                return certified_count(pencil, steady_factors(pencil, x));
            });
            return result;
        }
    const detail::BoundedCarry<ElementPencil<S, Spins, OwnErrors>> carry(pencil);
    const auto state = detail::carried_up(carry, pencil, shifts);
    for (std::size_t i = 0; i < L; ++i) result[i] = state[i].count;
    return result;
}

}  // namespace revchain::pencil
