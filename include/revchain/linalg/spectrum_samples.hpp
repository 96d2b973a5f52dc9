// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/spectrum_pins.hpp"

namespace revchain::linalg::spectrum {

/// The characteristic polynomial at a shift, value * 2^exponent, and the number of eigenvalues mu below the shift.
struct Sample {
    double value = 0;
    int exponent = 0;
    Index below = 0;
};

inline constexpr std::size_t sample_packs = 6;
inline constexpr std::size_t sample_lanes = sample_packs * width;

/// Offset of the held pin over that of the free end, as a function of mu = 1/lambda, times the product of 1 + mu X/k over
/// the links: a polynomial whose zeros are the eigenvalues. Division-free: with s = 1 + mu X/k,
///
///     V' = s V - G/k,     G' = s G + m mu V',     V = 1, G = mu m_0 at the free end.
///
/// Cost per shift and link (AVX-512): 0.13 ns without swings (X = 0), 0.23 with.
template <bool swings>
void sample(const PinnedChain& chain, const double* shifts, Sample* samples) {
    Pack mu[sample_packs], offset[sample_packs], force[sample_packs];
    Mask changes[sample_packs], exponent[sample_packs];
    double largest = 0;
    for (std::size_t p = 0; p < sample_packs; ++p) {
        for (std::size_t i = 0; i < width; ++i) mu[p][i] = shifts[p * width + i];
        for (std::size_t i = 0; i < width; ++i) largest = std::max(largest, shifts[p * width + i]);
        offset[p] = filled(1.0);
        force[p] = mu[p] * chain.tip_mass;
        changes[p] = exponent[p] = Mask{};
    }
    const std::size_t n = chain.size(), stretch = stretch_length(chain, largest, 16);
    for (std::size_t begin = 0; begin < n; begin += stretch) {
        const std::size_t end = std::min(begin + stretch, n);
        for (std::size_t m = begin; m < end; ++m) {
            const PinnedLink link = chain.links[m];
#pragma GCC unroll 8
            for (std::size_t p = 0; p < sample_packs; ++p) {
                const Pack before = offset[p];
                if constexpr (swings) {
                    const Pack s = 1.0 + mu[p] * link.swing;
                    offset[p] = s * offset[p] - link.flexibility * force[p];
                    force[p] = s * force[p] + link.mass * (mu[p] * offset[p]);
                } else {
                    offset[p] = offset[p] - link.flexibility * force[p];
                    force[p] = force[p] + link.mass * (mu[p] * offset[p]);
                }
                changes[p] -= ((Mask)before ^ (Mask)offset[p]) >> 63;
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
            samples[p * width + i] = {offset[p][i], static_cast<int>(exponent[p][i]), static_cast<Index>(changes[p][i])};
}

/// The same for any number of shifts.
inline std::vector<Sample> sample_all(const PinnedChain& chain, std::vector<double> shifts) {
    std::vector<Sample> samples(shifts.size());
    Sample last[sample_lanes];
    double padded[sample_lanes];
    for (std::size_t i = 0; i < shifts.size(); i += sample_lanes) {
        const std::size_t taken = std::min(sample_lanes, shifts.size() - i);
        std::copy_n(shifts.begin() + static_cast<std::ptrdiff_t>(i), taken, padded);
        std::fill(padded + taken, padded + sample_lanes, padded[0]);
        chain.swings ? sample<true>(chain, padded, last) : sample<false>(chain, padded, last);
        std::copy_n(last, taken, samples.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return samples;
}

}  // namespace revchain::linalg::spectrum
