// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdint>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/spectrum/lumped_chain.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// The characteristic polynomial at a shift, value * 2^exponent, and the count of lower eigenvalues
/// mu.
struct Sample {
    double value = 0;
    int exponent = 0;
    Index below = 0;
};

inline constexpr std::size_t history_step = 32;
inline std::size_t history_words(std::size_t links) { return links / history_step / 64 + 1; }

inline constexpr std::size_t sample_packs = 6;

/// The offset of the held pin for a free end at 1, as a function of mu = 1/lambda, times the
/// product of s = 1 + mu X/k over the links. It is a polynomial whose zeros are the eigenvalues,
/// without division:
///
///     V' = s V - G/k,     G' = s G + m mu V',     V = 1, G = mu m_0 at the free end.
///
/// With `count` this function also counts eigenvalues below the shift. Without, it stores in
/// `history` the sign of the offset after every `history_step` links from the free end: 64 signs in
/// a word, the first sign in the highest used bit. Cost per shift and link (AVX-512): 0.13 ns
/// without cross masses, 0.23 ns with them.
template <class V, bool has_cross, bool count>
[[gnu::always_inline]] inline void sample(const LumpedChain& chain, const double* shifts,
                                          Sample* samples, std::uint64_t* history) {
    V mu[sample_packs], offset[sample_packs], force[sample_packs];
    typename V::Mask changes[sample_packs], exponents[sample_packs], signs[sample_packs];
    double largest = 0;
    for (std::size_t p = 0; p < sample_packs; ++p) {
        mu[p] = V::load(shifts + p * V::size);
        for (std::size_t i = 0; i < V::size; ++i)
            largest = std::max(largest, shifts[p * V::size + i]);
        offset[p] = V(1.0);
        force[p] = mu[p] * chain.tip_mass;
    }
    const std::size_t n = chain.size(), stretch = links_between_checks(chain, largest, 16);
    [[maybe_unused]] const std::size_t words = history_words(n);
    for (std::size_t begin = 0; begin < n; begin += stretch) {
        const std::size_t end = std::min(begin + stretch, n);
        for (std::size_t m = begin; m < end; ++m) {
            const LumpedLink link = chain.links[m];
#pragma GCC unroll 8
            for (std::size_t p = 0; p < sample_packs; ++p) {
                [[maybe_unused]] const V before = offset[p];
                if constexpr (has_cross) {
                    const V s = 1.0 + mu[p] * link.cross_ratio;
                    offset[p] = s * offset[p] - link.flexibility * force[p];
                    force[p] = s * force[p] + link.mass * (mu[p] * offset[p]);
                } else {
                    offset[p] = offset[p] - link.flexibility * force[p];
                    force[p] = force[p] + link.mass * (mu[p] * offset[p]);
                }
                if constexpr (count) changes[p] += differ_in_sign(before, offset[p]);
            }
        }
        if (!count && end % history_step == 0) {
            for (std::size_t p = 0; p < sample_packs; ++p)
                signs[p] = (signs[p] + signs[p]) + differ_in_sign(offset[p], V(0.0));
            if (end / history_step % 64 == 0 || end + history_step > n) {
                for (std::size_t p = 0; p < sample_packs; ++p)
                    for (std::size_t i = 0; i < V::size; ++i)
                        history[(p * V::size + i) * words + (end / history_step - 1) / 64] =
                            static_cast<std::uint64_t>(signs[p][i]);
            }
        }
        V size[sample_packs], least = std::numeric_limits<double>::infinity(), most;
        for (std::size_t p = 0; p < sample_packs; ++p) {
            size[p] = max(abs(offset[p]), abs(force[p]));
            least = min(least, size[p]), most = max(most, size[p]);
        }
        if (!strays(least, most)) continue;
        for (std::size_t p = 0; p < sample_packs; ++p) {  // powers of two: exact
            exponents[p] += exponent(size[p]);
            const V scale = inverse_power(size[p]);
            offset[p] *= scale;
            force[p] *= scale;
        }
    }
    for (std::size_t p = 0; p < sample_packs; ++p)
        for (std::size_t i = 0; i < V::size; ++i)
            samples[p * V::size + i] = {offset[p][i], static_cast<int>(exponents[p][i]),
                                        static_cast<Index>(changes[p][i])};
}

/// Samples any number of shifts, with counts or, given `history`, with `history_words` for each.
inline std::vector<Sample> sample_all(const LumpedChain& chain, const std::vector<double>& shifts,
                                      std::vector<std::uint64_t>* history = nullptr) {
    std::vector<Sample> samples(shifts.size());
    const std::size_t words = history_words(chain.size());
    if (history != nullptr) history->assign(shifts.size() * words, 0);
    revchain::detail::parallel_for(
        shifts.size(), sample_packs * most_doubles, [&](std::size_t begin, std::size_t end) {
            simd([&](auto registers) REVCHAIN_INLINED {
                using V = Pack<double, registers.doubles>;
                constexpr std::size_t together = sample_packs * V::size;
                double padded[together];
                Sample found[together];
                std::vector<std::uint64_t> signs(history == nullptr ? 0 : together * words);
                for (std::size_t i = begin; i < end; i += together) {
                    revchain::detail::check_interrupt();
                    const std::size_t taken = std::min(together, end - i);
                    for (std::size_t j = 0; j < together; ++j)
                        padded[j] = shifts[i + (j < taken ? j : 0)];
                    if (history == nullptr && chain.has_cross)
                        sample<V, true, true>(chain, padded, found, nullptr);
                    if (history == nullptr && !chain.has_cross)
                        sample<V, false, true>(chain, padded, found, nullptr);
                    if (history != nullptr && chain.has_cross)
                        sample<V, true, false>(chain, padded, found, signs.data());
                    if (history != nullptr && !chain.has_cross)
                        sample<V, false, false>(chain, padded, found, signs.data());
                    for (std::size_t j = 0; j < taken; ++j) samples[i + j] = found[j];
                    if (history != nullptr)
                        for (std::size_t j = 0; j < taken * words; ++j)
                            (*history)[i * words + j] = signs[j];
                }
            });
        });
    return samples;
}

/// Returns the number of links below a mode whose eigenvalue is the only one between two shifts: a
/// guess, because nearby modes interfere. The chain below some pin also has an eigenvalue between
/// the shifts only if it contains the mode. From there on the offsets, given by signs, differ.
inline std::size_t place(const std::uint64_t* one, const std::uint64_t* other, std::size_t links) {
    const std::size_t steps = links / history_step;
    std::ptrdiff_t balance = 0, least = 0;  // differences minus agreements, and the least balance
    std::size_t at = 0;
    for (std::size_t i = 0; i < steps; ++i) {
        const std::size_t word = i / 64, used = std::min<std::size_t>(64, steps - word * 64);
        balance += ((one[word] ^ other[word]) >> (used - 1 - i % 64) & 1) != 0 ? 1 : -1;
        if (balance < least) least = balance, at = i + 1;
    }
    return at * history_step;
}

}  // namespace revchain::pencil::spectrum
