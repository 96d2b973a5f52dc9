// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdint>

#include "revchain/linalg/spectrum_pins.hpp"

namespace revchain::linalg::spectrum {

/// The characteristic polynomial at a shift, value * 2^exponent, and the number of eigenvalues mu below the shift.
struct Sample {
    double value = 0;
    int exponent = 0;
    Index below = 0;
};

inline constexpr std::size_t history_step = 32;
inline std::size_t history_words(std::size_t links) { return links / history_step / 64 + 1; }

inline constexpr std::size_t sample_packs = 6;
inline constexpr std::size_t sample_lanes = sample_packs * width;

/// Offset of the held pin over that of the free end, as a function of mu = 1/lambda, times the product of 1 + mu X/k over
/// the links: a polynomial whose zeros are the eigenvalues. Division-free: with s = 1 + mu X/k,
///
///     V' = s V - G/k,     G' = s G + m mu V',     V = 1, G = mu m_0 at the free end.
///
/// Cost per shift and link (AVX-512): 0.13 ns without swings (X = 0), 0.23 with.
///
/// With `count`, also the number of eigenvalues below the shift; else `history`, the sign of the offset after every
/// `history_step` links from the free end, 64 signs to a word, the first in the highest bit used.
template <bool swings, bool count>
void sample(const PinnedChain& chain, const double* shifts, Sample* samples, std::uint64_t* history) {
    Pack mu[sample_packs], offset[sample_packs], force[sample_packs];
    Mask changes[sample_packs], exponent[sample_packs], signs[sample_packs];
    double largest = 0;
    for (std::size_t p = 0; p < sample_packs; ++p) {
        for (std::size_t i = 0; i < width; ++i) mu[p][i] = shifts[p * width + i];
        for (std::size_t i = 0; i < width; ++i) largest = std::max(largest, shifts[p * width + i]);
        offset[p] = filled(1.0);
        force[p] = mu[p] * chain.tip_mass;
        changes[p] = exponent[p] = signs[p] = Mask{};
    }
    const std::size_t n = chain.size(), stretch = stretch_length(chain, largest, 16);
    [[maybe_unused]] const std::size_t words = history_words(n);
    for (std::size_t begin = 0; begin < n; begin += stretch) {
        const std::size_t end = std::min(begin + stretch, n);
        for (std::size_t m = begin; m < end; ++m) {
            const PinnedLink link = chain.links[m];
#pragma GCC unroll 8
            for (std::size_t p = 0; p < sample_packs; ++p) {
                [[maybe_unused]] const Pack before = offset[p];
                if constexpr (swings) {
                    const Pack s = 1.0 + mu[p] * link.swing;
                    offset[p] = s * offset[p] - link.flexibility * force[p];
                    force[p] = s * force[p] + link.mass * (mu[p] * offset[p]);
                } else {
                    offset[p] = offset[p] - link.flexibility * force[p];
                    force[p] = force[p] + link.mass * (mu[p] * offset[p]);
                }
                if constexpr (count) changes[p] -= ((Mask)before ^ (Mask)offset[p]) >> 63;
            }
        }
        if (!count && end % history_step == 0) {
            for (std::size_t p = 0; p < sample_packs; ++p) signs[p] = (signs[p] << 1) - ((Mask)offset[p] >> 63);
            if (end / history_step % 64 == 0 || end + history_step > n) {
                for (std::size_t p = 0; p < sample_packs; ++p)
                    for (std::size_t i = 0; i < width; ++i)
                        history[(p * width + i) * words + (end / history_step - 1) / 64] =
                            static_cast<std::uint64_t>(signs[p][i]);
            }
        }
        for (std::size_t p = 0; p < sample_packs; ++p) {  // powers of two: nothing is rounded
            const Pack size = magnitude(offset[p]) > magnitude(force[p]) ? magnitude(offset[p]) : magnitude(force[p]);
            if (!any((size > 0x1p100) | (size < 0x1p-100))) continue;
            exponent[p] += exponent_of(size);
            const Pack scale = inverse_power(size);
            offset[p] *= scale;
            force[p] *= scale;
        }
    }
    for (std::size_t p = 0; p < sample_packs; ++p)
        for (std::size_t i = 0; i < width; ++i)
            samples[p * width + i] = {offset[p][i], static_cast<int>(exponent[p][i]),
                                      static_cast<Index>(changes[p][i])};
}

/// The same for any number of shifts. Without `history`, counts; with it, histories, `history_words` for each shift.
inline std::vector<Sample> sample_all(const PinnedChain& chain, const std::vector<double>& shifts,
                                      std::vector<std::uint64_t>* history = nullptr) {
    std::vector<Sample> samples(shifts.size() + sample_lanes);
    const std::size_t words = history_words(chain.size());
    if (history != nullptr) history->assign(samples.size() * words, 0);
    double padded[sample_lanes];
    for (std::size_t i = 0; i < shifts.size(); i += sample_lanes) {
        const std::size_t taken = std::min(sample_lanes, shifts.size() - i);
        std::copy_n(shifts.begin() + static_cast<std::ptrdiff_t>(i), taken, padded);
        std::fill(padded + taken, padded + sample_lanes, padded[0]);
        std::uint64_t* signs = history == nullptr ? nullptr : history->data() + i * words;
        const auto pass = history == nullptr ? (chain.swings ? sample<true, true> : sample<false, true>)
                                             : (chain.swings ? sample<true, false> : sample<false, false>);
        pass(chain, padded, &samples[i], signs);
    }
    samples.resize(shifts.size());
    return samples;
}

/// Where along the chain a mode lives whose eigenvalue is the only one between two shifts: the part of the chain below
/// some pin has an eigenvalue between them too only if it holds the mode, so from there on the offsets differ in sign.
/// Returns the number of links below. Only good for a guess: `signs` of modes nearby interfere.
inline std::size_t place(const std::uint64_t* one, const std::uint64_t* other, std::size_t links) {
    const std::size_t steps = links / history_step;
    std::ptrdiff_t balance = 0, least = 0;  // differences minus agreements so far: least where the mode begins
    std::size_t at = 0;
    for (std::size_t i = 0; i < steps; ++i) {
        const std::size_t word = i / 64, used = std::min<std::size_t>(64, steps - word * 64);
        balance += ((one[word] ^ other[word]) >> (used - 1 - i % 64) & 1) != 0 ? 1 : -1;
        if (balance < least) least = balance, at = i + 1;
    }
    return at * history_step;
}

}  // namespace revchain::linalg::spectrum
