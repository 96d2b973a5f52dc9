// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/pencil/sturm.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Bounds on the absolute errors of an element's numbers.
template <Real M>
struct ElementError {
    M stiffness{}, spin{}, lower{}, upper{}, cross{};
};

/// One element between two neighbouring pins of a family of symmetric matrices in one unknown x,
///
///     Q(x) = L(x) [ 1 -1 ; -1 1 ] - [ A X ; X B ],     L = x k,  or with spins  L = x^2 k + x s,
///
/// where every number may have any sign.
template <Real S>
struct SignedElement {
    S stiffness{};  ///< k
    S spin{};       ///< s
    S lower{}, upper{}, cross{};
    ElementError<Narrow<S>> error{};

    S weight() const { return (lower + cross) + (cross + upper); }
    S determinant() const { return lower * upper - cross * cross; }
    /// The dynamic stiffness above the element, D that below it and p = D + L - A.
    S above(const S& L, const S& D, const S& weight, const S& determinant, const S& p) const {
        return ((L - upper) * D - (L * weight - determinant)) / p;
    }
};

/// A family Q(x) kept as its elements, lowest first, never assembled. The last element's upper pin is held.
template <Real S>
struct SignedPencil {
    std::vector<SignedElement<S>> elements;
    bool quadratic = false;  ///< L = x^2 k + x s
    /// The element below the lowest pin, if it holds that pin to one that does not move; else the
    /// lowest pin is free.
    std::optional<SignedElement<S>> ground{};

    Index size() const { return static_cast<Index>(elements.size()); }
    template <class X>
    Factors<X> factors(const X& x) const {
        return quadratic ? Factors<X>{x * x, x} : Factors<X>{x, X(S(Narrow<S>(0)))};
    }
    /// Their derivatives.
    template <class X>
    Factors<X> slopes(const X& x) const {
        const X one(S(Narrow<S>(1)));
        return quadratic ? Factors<X>{x + x, one} : Factors<X>{one, X(S(Narrow<S>(0)))};
    }
    /// Returns the pencil with every spin reversed: its x are those of this pencil with the other sign.
    SignedPencil reversed() const {
        SignedPencil other = *this;
        for (SignedElement<S>& e : other.elements) e.spin = -e.spin;
        if (other.ground) other.ground->spin = -other.ground->spin;
        return other;
    }
};

/// Whether a number of an element is 0 for certain.
template <Real S>
bool vanishes(const S& x, const Narrow<S>& error) {
    return x == S(Narrow<S>(0)) && error == Narrow<S>(0);
}

/// Converts to an `ElementPencil`. Returns nothing if the error of a number exceeds 1e-20 of its
/// size, or the lowest pin is held. Precondition: every stiffness is positive, and no mass is
/// negative.
template <Real S>
std::optional<ElementPencil<S>> positive_elements(const SignedPencil<S>& pencil) {
    using std::abs;
    if (pencil.ground) return std::nullopt;
    using M = Narrow<S>;
    const S zero(M(0));
    ElementPencil<S> result;
    result.elements.reserve(pencil.elements.size());
    M worst(0);
    const auto add = [&](const M& error, const M& size) {
        worst = std::max(worst, error == M(0) ? error : error / size);
    };
    for (const SignedElement<S>& e : pencil.elements) {
        const S weight = e.weight();
        const S turning = weight > zero ? e.determinant() / weight : zero;
        result.elements.push_back(
            {e.stiffness, e.lower, e.upper, e.cross, turning > zero ? turning : zero, static_cast<M>(weight)});
        if (pencil.quadratic) result.spin.push_back(e.spin);
        add(e.error.stiffness, static_cast<M>(e.stiffness)), add(e.error.spin, static_cast<M>(abs(e.spin)));
        add(e.error.lower, static_cast<M>(e.lower)), add(e.error.upper, static_cast<M>(e.upper));
        add(e.error.cross, static_cast<M>(abs(e.cross) + turning + turning));
    }
    result.entry_error = worst;
    if (!(worst < M(1e-20))) return std::nullopt;
    return result;
}

/// Counts in T, up to sign and offset, what `bisect` asks for: the eigenvalues of Q above x.
template <Real T>
class SignedCounter {
   public:
    /// counted = offset + sign * (negative eigenvalues of Q(side * x)).
    template <Real S>
    explicit SignedCounter(const SignedPencil<S>& pencil, Index offset = 0, Index sign = 1, int side = 1)
        : offset_(offset), sign_(sign), side_(side), quadratic_(pencil.quadratic) {
        const auto row = [](const SignedElement<S>& e) {
            return Row{static_cast<T>(e.stiffness), static_cast<T>(e.spin),     static_cast<T>(e.lower),
                       static_cast<T>(e.upper),     static_cast<T>(e.weight()), static_cast<T>(e.determinant())};
        };
        if (pencil.ground) ground_ = row(*pencil.ground);
        rows_.reserve(pencil.elements.size());
        for (const SignedElement<S>& e : pencil.elements) rows_.push_back(row(e));
    }

    /// Dynamic stiffness carried up by equation (1) of docs/theory/counts.md, in which neither k nor M need be
    /// positive: p = D + L - A, D' = [ (L - B) D - (L W - A B + X^2) ] / p. Cost: one pass.
    template <std::size_t N>
    std::array<Index, N> above(const std::array<T, N>& shifts) const {
        using std::abs;
        std::array<T, N> stiffness, spin, below{};
        std::array<Index, N> negative{};
        for (std::size_t i = 0; i < N; ++i) {
            const T x = side_ < 0 ? -shifts[i] : shifts[i];
            stiffness[i] = quadratic_ ? x * x : x;
            spin[i] = quadratic_ ? x : T(0);
            if (ground_) below[i] = stiffness[i] * ground_->stiffness + spin[i] * ground_->spin - ground_->upper;
        }
        const T least = least_pivot<T>();
        for (const Row& e : rows_)
            for (std::size_t i = 0; i < N; ++i) {  // compilers turn this loop into SIMD code
                const T L = stiffness[i] * e.stiffness + spin[i] * e.spin;
                const T p = below[i] + (L - e.lower);
                const T pivot = abs(p) < least ? least : p;
                negative[i] += pivot < T(0) ? 1 : 0;
                below[i] = ((L - e.upper) * below[i] - (L * e.weight - e.determinant)) / pivot;
            }
        for (Index& count : negative) count = offset_ + sign_ * count;
        return negative;
    }

   private:
    struct Row {
        T stiffness, spin, lower, upper, weight, determinant;
    };
    std::vector<Row> rows_;
    std::optional<Row> ground_{};
    Index offset_, sign_;
    int side_;
    bool quadratic_;
};

template <Real T, std::size_t N>
std::array<Index, N> count_above(const SignedCounter<T>& counter, const std::array<T, N>& shifts) {
    return counter.above(shifts);
}

/// The number of negative eigenvalues of the exact Q(x) at the exact x, where `proved`.
///
/// The dynamic stiffness D of everything below a pin is carried in S by the equation of `SignedCounter`, which loses
/// nothing where links are stiff beside what they bear, with a running bound on its error: as a function of what D' is
/// made of, D' = L - B - (L + X)^2/p has the slopes q^2 in D and -A, (1 - q)^2 in L, -1 in B, -2q in X, with q = (L +
/// X)/p and 1 - q = (D - A - X)/p; to that come the roundings of numerator, p and quotient.
/// Cost O(N): in double words 80 ns a link and x. Beside the count of an ElementPencil because that one needs positive
/// stiffnesses; this one proves as much of a chain but takes 1.4 times as long, in double 4 times.
template <Real S, std::size_t N>
std::array<CertifiedCount, N> certified_count(const SignedPencil<S>& pencil, const std::array<S, N>& shifts) {
    using std::abs;
    using M = Narrow<S>;
    const M u = operation_error<S>();
    const M slack = M(1) + M(4) * epsilon<M>();     // of magnitudes taken from rounded numbers
    const M inflate = M(1) + M(64) * epsilon<M>();  // the bound's own rounding
    const M tiny = M(2) * least_pivot<M>();
    const M underflow = M(64) * std::numeric_limits<M>::denorm_min();  // of an operation
    const auto size_of = [&](const S& x) { return abs(static_cast<M>(x)) * slack; };
    std::array<Factors<S>, N> factors;
    std::array<S, N> below{};
    std::array<M, N> error{};
    std::array<CertifiedCount, N> result{};
    for (std::size_t i = 0; i < N; ++i) {
        factors[i] = pencil.factors(shifts[i]), result[i].proved = true;
        if (!pencil.ground) continue;
        const SignedElement<S>& e = *pencil.ground;
        const M a = size_of(factors[i].stiffness), b = size_of(factors[i].spin);
        const M size = a * size_of(e.stiffness) + b * size_of(e.spin) + size_of(e.upper);
        below[i] = factors[i].stiffness * e.stiffness + factors[i].spin * e.spin - e.upper;
        error[i] = inflate * (a * e.error.stiffness + b * e.error.spin + e.error.upper + M(5) * u * size + underflow);
    }
    for (const SignedElement<S>& e : pencil.elements) {
        const ElementError<M>& off = e.error;
        const M k = size_of(e.stiffness), s = size_of(e.spin);
        const M lower = size_of(e.lower), upper = size_of(e.upper), cross = size_of(e.cross);
        const S weight = e.weight(), determinant = e.determinant();
        const M weight_size = lower + upper + M(2) * cross, determinant_size = lower * upper + cross * cross;
        for (std::size_t i = 0; i < N; ++i) {
            const M a = size_of(factors[i].stiffness), b = size_of(factors[i].spin);
            const S L = factors[i].stiffness * e.stiffness + factors[i].spin * e.spin;
            const M L_size = a * k + b * s;
            const M L_error = (a * off.stiffness + b * off.spin) + M(4) * u * L_size + underflow;
            const S p = below[i] + (L - e.lower);
            const M D_size = size_of(below[i]), p_size = abs(static_cast<M>(p)) * (M(1) - M(2) * epsilon<M>());
            const M p_rounding = M(3) * u * (D_size + L_size + lower);
            const M least = p_size - inflate * (error[i] + L_error + off.lower + p_rounding);
            // Written so that a NaN anywhere withdraws the proof.
            result[i].proved = result[i].proved && least > tiny;
            result[i].above += p < S(M(0)) ? 1 : 0;

            const S pivot = abs(p) < S(tiny) ? S(tiny) : p;
            const S next = e.above(L, below[i], weight, determinant, pivot);
            if (result[i].proved) {  // else a count is all there is to know
                const M C_size = size_of(L + e.cross) + L_error + off.cross;
                const M q = C_size / least, r = (D_size + error[i] + lower + off.lower + cross + off.cross) / least;
                const M slopes = q * q * (error[i] + off.lower) + r * r * L_error + off.upper + M(2) * q * off.cross;
                const M next_size = size_of(next);
                const M roundings = M(8) * u * ((L_size + upper) * (D_size / least) + L_size * (weight_size / least)) +
                                    M(8) * u * (determinant_size / least) + next_size * (p_rounding / least + M(4) * u);
                const M lost = underflow * (M(1) + L_size + upper + D_size + weight_size) * (M(1) + M(1) / least);
                error[i] = inflate * (slopes + roundings + lost);
            }
            below[i] = next;
        }
    }
    return result;
}

}  // namespace revchain::pencil
