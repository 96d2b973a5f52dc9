// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "revchain/linalg/block_transfer.hpp"
#include "revchain/linalg/sturm.hpp"

namespace revchain::linalg {

/// Dynamic stiffness of a block at one shift, lambda K - M: a spring between its two pins and a mass at each,
///
///     spring [ 1 -1 ; -1 1 ]  -  [ lower 0 ; 0 upper ].
template <Real S>
struct LumpedElement {
    S spring{}, lower{}, upper{};
};

/// A run of links condensed to its two end pins, exactly up to rounding and truncation. Its spring and its two masses
/// depend on mu = 1/lambda; with z = -mu and t = 1 + b1 z + b2 z^2 + ... they are
///
///     lambda k / t + cross,    (lower + a1 z + ...) / t,    (upper + d1 z + ...) / t.
///
/// The leading numbers are kept in S, the rest, smaller by mu (mass)/(stiffness) of the block, in T.
template <Real T>
struct Block {
    static constexpr std::size_t degree = 6;
    using S = Wide<T>;
    S stiffness{}, lower{}, upper{};
    T cross{};  ///< off-diagonal mass of a link that stands alone
    std::array<T, degree> b{};
    std::array<T, degree - 1> a{}, d{};
};

/// A chain of blocks, lowest first; the last one's upper pin is held. Valid for shifts lambda >= `least_shift`.
template <Real T>
struct BlockPencil {
    std::vector<Block<T>> blocks;
    T least_shift{};
    /// Every eigenvalue above `least_shift` is within this (relative) of the exact chain's: docs/accuracy.md.
    T error{};
    Index size() const { return static_cast<Index>(blocks.size()); }
};

namespace detail {
template <class T, std::size_t Count>
inline T horner(const std::array<T, Count>& coefficient, const T& z) {
    T value = coefficient[Count - 1];
    for (std::size_t i = Count - 1; i-- > 0;) value = coefficient[i] + z * value;
    return z * value;
}
}  // namespace detail

/// The block's dynamic stiffness at a shift, in S = T or `Wide<T>`. The corrections are evaluated in T: they are small.
template <Real S, Real T>
LumpedElement<S> element_at(const Block<T>& block, const S& shift) {
    const T z = T(-1) / static_cast<T>(shift);
    const T series = detail::horner(block.b, z);
    const S change(-series / (T(1) + series));  // 1/t - 1
    const S stiffness = shift * S(static_cast<S>(block.stiffness));
    const S lower = S(static_cast<S>(block.lower)) + S(detail::horner(block.a, z));
    const S upper = S(static_cast<S>(block.upper)) + S(detail::horner(block.d, z));
    return {stiffness + stiffness * change + S(block.cross), lower + lower * change, upper + upper * change};
}

/// For each shift the number of eigenvalues above it, as `count_above` of an ElementPencil.
/// Preconditions: shifts >= least_shift. Cost: O(blocks).
template <Real T, std::size_t L>
std::array<Index, L> count_above(const BlockPencil<T>& pencil, const std::array<T, L>& shifts) {
    std::array<T, L> below{}, z;
    std::array<Index, L> negative{};
    for (std::size_t i = 0; i < L; ++i) z[i] = T(-1) / shifts[i];
    for (const Block<T>& block : pencil.blocks) {
        const T k = static_cast<T>(block.stiffness), lower = static_cast<T>(block.lower),
                upper = static_cast<T>(block.upper);
        for (std::size_t i = 0; i < L; ++i) {
            const T t = T(1) + detail::horner(block.b, z[i]);
            const T spring = shifts[i] * k + block.cross * t;  // all three times t
            const T hung = below[i] * t - (lower + detail::horner(block.a, z[i]));
            const T sum = spring + hung;
            const T pivot = sum == T(0) ? spring * epsilon<T>() * epsilon<T>() : sum;
            negative[i] += pivot < T(0) ? 1 : 0;
            below[i] = (spring * hung / pivot - (upper + detail::horner(block.d, z[i]))) / t;
        }
    }
    return negative;
}

/// The count with a running bound on the error of the recursion from rounding in S, for the chain of exactly these
/// elements: `proved` as in sturm.hpp. Cost: 60 ns per block and shift in double words.
template <Real S, Real T, std::size_t L>
std::array<CertifiedCount, L> certified_count(const BlockPencil<T>& pencil, const std::array<S, L>& shifts) {
    using std::abs;
    using M = Narrow<S>;
    const M unit = M(2) * operation_error<S>();
    const M inflate = M(1) + M(16) * epsilon<M>();
    const M underflow = std::numeric_limits<M>::min() * M(4);
    std::array<S, L> below{};
    std::array<M, L> error{};
    std::array<CertifiedCount, L> result{};
    for (auto& r : result) r.proved = true;
    for (const Block<T>& block : pencil.blocks)
        for (std::size_t i = 0; i < L; ++i) {
            const LumpedElement<S> e = element_at<S>(block, shifts[i]);
            const S hung = below[i] - e.lower;
            const S pivot = hung + e.spring;
            const M spring = static_cast<M>(e.spring), size = abs(static_cast<M>(pivot));
            const M hung_error = (error[i] + unit * abs(static_cast<M>(hung))) * inflate + underflow;
            const M least = size * (M(1) - M(4) * epsilon<M>()) - unit * size;
            const M least_with_below = least - hung_error;
            result[i].proved = result[i].proved && spring > M(0) && least_with_below > M(0);
            result[i].above += pivot < S(M(0)) ? 1 : 0;
            const S carried = e.spring * (hung / not_zero(pivot, e.spring));
            below[i] = carried - e.upper;
            error[i] = inflate * ((spring / least) * (spring / least_with_below) * hung_error +
                                  M(3) * unit * abs(static_cast<M>(carried)) + unit * abs(static_cast<M>(below[i]))) +
                       underflow;
        }
    return result;
}

/// One step of Newton's method on  y^T (lambda K - M) y = 0  with y the twisted vector at `shift`: the error is cubed
/// where a single eigenvalue is near. The form is summed in S, so that the result may be as accurate as S.
/// Cost: three passes over the blocks.
template <Real S, Real T>
S improved(const BlockPencil<T>& pencil, const S& shift) {
    using std::abs;
    const std::size_t n = pencil.blocks.size();
    const T at = static_cast<T>(shift);
    std::vector<LumpedElement<T>> element(n);
    std::vector<T> down(n), balance(n);
    T below(0);
    for (std::size_t m = 0; m < n; ++m) {
        element[m] = element_at<T>(pencil.blocks[m], at);
        const T hung = below - element[m].lower;
        const T pivot = not_zero(element[m].spring + hung, element[m].spring);
        balance[m] = below;
        down[m] = element[m].spring / pivot;  // offset of this pin over that of the pin above
        below = down[m] * hung - element[m].upper;
    }
    std::vector<T> up(n);  // offset of the pin above over that of this pin
    std::size_t twist = n - 1;
    T least = std::numeric_limits<T>::infinity(), above(0);
    for (std::size_t m = n; m-- > 0;) {
        const LumpedElement<T>& e = element[m];
        if (m + 1 == n) {
            up[m] = T(0);
            above = e.spring - e.lower;
        } else {
            const T held = above - e.upper;
            const T pivot = not_zero(e.spring + held, e.spring);
            up[m] = e.spring / pivot;
            above = up[m] * held - e.lower;
        }
        const T forces = e.spring + e.lower + (m > 0 ? element[m - 1].spring + element[m - 1].upper : T(0));
        const T unbalanced = abs(balance[m] + above) / forces;
        if (unbalanced < least) {
            least = unbalanced;
            twist = m;
        }
    }
    std::vector<T> offset(n + 1);
    offset[twist] = T(1);
    for (std::size_t m = twist; m-- > 0;) offset[m] = down[m] * offset[m + 1];
    for (std::size_t m = twist; m < n; ++m) offset[m + 1] = up[m] * offset[m];
    // The form at the shift, in S, and its derivative from a second value, in T.
    const T step = at * T(1e-5);
    S form(T(0));
    T ahead(0), here(0);
    for (std::size_t m = 0; m < n; ++m) {
        const S lower(offset[m]), upper(offset[m + 1]), stretch = lower - upper;
        const LumpedElement<S> e = element_at<S>(pencil.blocks[m], shift);
        form = form + (e.spring * stretch * stretch - (e.lower * lower * lower + e.upper * upper * upper));
        const LumpedElement<T> f = element_at<T>(pencil.blocks[m], at + step);
        const T s = static_cast<T>(stretch);
        const T value = f.spring * s * s - (f.lower * offset[m] * offset[m] + f.upper * offset[m + 1] * offset[m + 1]);
        ahead = ahead + value;
    }
    here = static_cast<T>(form);
    return shift - form / S((ahead - here) / step);
}

}  // namespace revchain::linalg
