// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/bisection.hpp"
#include "revchain/linear/compression.hpp"
#include "revchain/linear/heights.hpp"

namespace revchain::detail {

/// Where compressed chains pay: long ones of which few modes are wanted. Below, one mode by bisection costs less than the
/// blocks of all (flat: within 20 % from 150 to 400 links).
template <Real T>
bool compression_pays(const Chain<T>& chain, const ModeRange& range) {
    return chain.size() >= 256 && range.first - 1 + range.count <= chain.size() / 8;
}

/// The height of mode `number` of a smooth chain, from the phase  integral sqrt(dW df)  that its waves go through (WKB):
/// a few per cent for like links, anything for unlike ones.
template <Real T>
T estimated_height(const Chain<T>& chain, Index number) {
    using std::sqrt;
    const Index pieces = std::clamp<Index>(chain.size() / segment_size, 32, 512);
    const T length = chain.total_length() / T(pieces);
    T phase(0), below(0);
    for (Index i = 1; i <= pieces; ++i) {
        const Index end = i == pieces ? chain.size() : i * chain.size() / pieces / runs_at_once * runs_at_once;
        const T above = static_cast<T>(chain.weight_below(end));
        phase += sqrt((above - below) / (below + above) * (T(2) * length));
        below = above;
    }
    const T per_phase = phase / (T(number) - T(0.25));
    return per_phase * per_phase / T(9.8696);
}

/// Stage 1 of `modes` for `compression_pays`; nothing where the bound would miss the tolerance asked or a mode could not
/// be proved, so that the sure way is left.
///
/// Blocks, their modes bracketed by counts in T, one or two Newton steps (the last in `Wide<T>`), two proved counts on
/// the blocks. The bound adds what condensing has changed, 1.8 ulp: docs/accuracy.md, "Blocks".
/// Cost: `compress`, and 40 microseconds a mode.
template <std::floating_point T>
std::optional<Heights<T>> heights_by_compression(const Chain<T>& chain, const ModeRange& range,
                                                 const ModesOptions<T>& options, double share) {
    using std::abs;
    using std::ldexp;
    using S = Wide<T>;
    if (options.rtol && *options.rtol < T(4) * epsilon<T>()) return std::nullopt;
    const ChainUnits units = chain.units();
    constexpr int range_limit = std::numeric_limits<T>::max_exponent / 3;  // products of the recursions stay inside
    if (std::abs(units.length_exponent) > range_limit || std::abs(units.weight_exponent) > range_limit)
        return std::nullopt;

    const Index last = range.first - 1 + range.count;
    T least = estimated_height(chain, last) * T(0.9);
    CompressedChain<T> compressed;
    for (int attempt = 0;; ++attempt) {
        compressed = compress(chain, least);
        const T end = compressed.pencil.least_shift;
        if (linalg::count_above(compressed.pencil, std::array<T, 1>{end})[0] >= last) break;
        if (attempt == 20) return std::nullopt;
        least = least * (attempt < 2 ? T(0.7) : T(0.25));
    }
    const linalg::BlockPencil<T>& pencil = compressed.pencil;
    const S unit(compressed.unit_length);
    const auto brackets =
        linalg::bisect(pencil, range.first - 1, range.count, T(1e-3), pencil.least_shift, [](Index) {});
    Heights<T> result{{}, "block compression"};
    result.height.reserve(brackets.size());
    const T margin = epsilon<T>() / T(8);
    const T bound = linalg::bound_of_margin<S>(margin + pencil.error) + epsilon<T>() * T(0.51);
    if (!(bound <= options.rtol.value_or(T(4) * epsilon<T>()))) return std::nullopt;
    using V = Pack<T>;
    using P = DoubleWord<V>;
    for (Index done = 0; done < range.count; done += pack_size) {
        V start, number;  // of four modes at a time; the last one repeated
        for (std::size_t lane = 0; lane < pack_size; ++lane) {
            const Index j = std::min(done + static_cast<Index>(lane), range.count - 1);
            const auto& bracket = brackets[static_cast<std::size_t>(j)];
            start.set(lane, linalg::between(bracket.lower, bracket.upper));
            number.set(lane, static_cast<T>(range.first + j));
        }
        P height(linalg::improved<V>(pencil, start).shift);
        bool proved = false;
        for (int round = 0; round < 3 && !proved; ++round) {
            height = linalg::improved<P>(pencil, height).shift;
            const P reach = height * P(V(margin));
            const auto below = linalg::certified_count(pencil, height - reach);
            const auto above = linalg::certified_count(pencil, height + reach);
            proved = true;
            for (std::size_t lane = 0; lane < pack_size; ++lane)
                proved = proved && below.proved[lane] == T(1) && above.proved[lane] == T(1) &&
                         below.above[lane] >= number[lane] && above.above[lane] < number[lane];
        }
        if (!proved) return std::nullopt;
        for (std::size_t lane = 0; lane < pack_size && done + static_cast<Index>(lane) < range.count; ++lane) {
            const S scaled = ldexp(S(height.high[lane], height.low[lane]) * unit, -units.length_exponent);
            result.height.push_back({static_cast<T>(scaled), bound, scaled});
        }
        advance(options.progress, share * static_cast<double>(result.height.size()) / static_cast<double>(range.count));
    }
    restore_order(result.height);
    return result;
}

}  // namespace revchain::detail
