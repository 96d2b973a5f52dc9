// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/condensed_chain.hpp"
#include "revchain/linear/heights.hpp"
#include "revchain/pencil/bisection.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns true if condensing pays: for few modes of long chains. Otherwise one mode by bisection
/// costs less than the blocks of all (flat: within 20 % from 150 to 400 links).
template <Real T>
bool condensation_pays(const Chain<T>& chain, const ModeRange& range) {
    return chain.size() >= 256 && range.first - 1 + range.count <= chain.size() / 8;
}

/// Returns the height of mode `number` for like lengths, in the unit of `LinkColumns`, within a few
/// per cent. It is that of uniform rods with the weights of pieces of the chain. For more modes
/// than those rods have it is from the phase integral sqrt(dW df) (WKB). Cost: 5 microseconds.
template <Real T>
T estimated_height(const Chain<T>& chain, Index number) {
    using std::sqrt;
    const Index rods_at_most = std::min<Index>(64, chain.size() / 8);
    const bool slow = 4 * number <= rods_at_most;
    const Index pieces =
        slow ? rods_at_most : std::clamp<Index>(chain.size() / segment_size, 32, 512);
    const T unit_length = LinkColumns<T>(chain).unit_length;
    const T length = chain.total_length() / unit_length / static_cast<T>(pieces);
    pencil::ElementPencil<T> rods;
    T phase(0), below(0);
    const T unit = chain.total_weight();
    for (Index i = 1; i <= pieces; ++i) {
        const Index even = i * chain.size() / pieces / runs_at_once * runs_at_once;
        const Index end = i == pieces ? chain.size() : even;
        const T above = static_cast<T>(chain.weight_below(end)) / unit, weight = above - below;
        if (slow)
            rods.elements.push_back({(below + weight / T(2)) / length, weight / T(3), weight / T(3),
                                     weight / T(6), weight / T(12), weight});
        else
            phase += sqrt(weight / (below + above) * (T(2) * length));
        below = above;
    }
    if (slow) {
        const auto bracket =
            pencil::bisect(rods, number - 1, 1, T(0.02), length * T(pieces)).front();
        return pencil::between(bracket.lower, bracket.upper);
    }
    const T per_phase = phase / (T(number) - T(0.25));
    return per_phase * per_phase / T(9.8696);
}

/// Returns eigenvalues of up to four neighbouring brackets, number `first` on (from 0), or nothing.
/// Two counts prove each to lie within `margin` of the returned value.
template <class T>
std::optional<DoubleWord<Pack<T>>> refined(const pencil::CondensedPencil<T>& pencil, Index first,
                                           const std::vector<pencil::Bracket<T>>& brackets,
                                           std::size_t from, const T& margin) {
    using V = Pack<T>;
    using P = DoubleWord<V>;
    V start, number;
    for (std::size_t lane = 0; lane < pack_size; ++lane) {
        const std::size_t j = std::min(from + lane, brackets.size() - 1);  // repeats the last
        start.set(lane, pencil::between(brackets[j].lower, brackets[j].upper));
        number.set(lane, static_cast<T>(first + 1 + static_cast<Index>(j)));
    }
    P height(pencil::improved<V>(pencil, start).shift);
    for (int round = 0; round < 3; ++round) {
        height = pencil::improved<P>(pencil, height).shift;
        const P reach = height * P(V(margin));
        const auto below = pencil::certified_count(pencil, height - reach);
        const auto above = pencil::certified_count(pencil, height + reach);
        bool proved = true;
        for (std::size_t lane = 0; lane < pack_size; ++lane)
            proved = proved && below.proved[lane] == T(1) && above.proved[lane] == T(1) &&
                     below.above[lane] >= number[lane] && above.above[lane] < number[lane] &&
                     height.high[lane] * (T(1) - T(2) * margin) > pencil.least_shift;
        if (proved) return height;
    }
    return std::nullopt;
}

template <Real T>
struct CondensedHeights {
    Heights<T> found;
    CondensedChain<T> condensed;
};

/// Does stage 1 of `modes` for a few slow modes of a long chain. The result is empty if the bound
/// exceeds the tolerance or a mode is not proved. Method: blocks, their modes bracketed by counts
/// in T, two Newton steps (the last in `Wide<T>`), two proved counts on the blocks. The bound
/// includes the error of condensing, 1.8 ulp: docs/theory/blocks.md. Cost: that of condensing, and
/// 20 us a mode.
template <std::floating_point T>
std::optional<CondensedHeights<T>> heights_by_condensation(const Chain<T>& chain,
                                                           const ModeRange& range,
                                                           const HeightsOptions<T>& options) {
    using std::ldexp;
    using S = Wide<T>;
    if (options.rtol && *options.rtol < T(2) * epsilon<T>()) return std::nullopt;
    const ChainUnits units = chain.units();
    // Products of double words must stay in range.
    if (std::abs(units.weight_exponent) > std::numeric_limits<T>::max_exponent / 2 ||
        !chain.has_one_weight_unit())
        return std::nullopt;

    const Index first = range.first - 1, last = first + range.count;
    T least = T(0.95) * estimated_height(chain, last);
    CondensedChain<T> condensed;
    for (int attempt = 0;; ++attempt) {
        condensed = condensed_chain(chain, least);
        if (pencil::count_above(condensed.pencil, std::array<T, 1>{least})[0] >= last) break;
        if (attempt == 20) return std::nullopt;
        least = least * (attempt < 2 ? T(0.7) : T(0.25));
    }
    const pencil::CondensedPencil<T>& pencil = condensed.pencil;
    const T margin = epsilon<T>() / T(8);
    const T bound = pencil::bound_of_margin<S>(margin + pencil.error) + T(0.51) * epsilon<T>();
    if (!(bound <= options.rtol.value_or(T(2) * epsilon<T>()))) return std::nullopt;

    const auto brackets = [&](Index number, Index count, const T& tolerance) {
        return pencil::bisect(pencil, number, count, tolerance, pencil.least_shift);
    };
    const auto rough = brackets(first, range.count, T(1e-3));
    Heights<T> result(rough.size());
    std::atomic<bool> proved = true;
    parallel_for(rough.size(), pack_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t done = begin; done < end && proved; done += pack_size) {
            const std::size_t count = std::min(pack_size, end - done);
            auto found = refined(pencil, first, rough, done, margin);
            if (!found) {  // neighbours may be too close for steps from 1e-3
                const Index number = first + static_cast<Index>(done);
                found = refined(pencil, number, brackets(number, static_cast<Index>(count), T(0)),
                                0, margin);
            }
            if (!found) proved = false;
            for (std::size_t lane = 0; found && lane < count; ++lane) {
                const S height = S(found->high[lane], found->low[lane]) * S(condensed.unit_length);
                const S scaled = ldexp(height, -units.length_exponent);
                result[done + lane] = {static_cast<T>(scaled), bound, scaled};
            }
            const auto counted = static_cast<double>(done + count);
            advance(options.progress, counted / static_cast<double>(rough.size()));
        }
    });
    if (!proved) return std::nullopt;
    restore_order<T>(result);
    return CondensedHeights<T>{std::move(result), std::move(condensed)};
}

}  // namespace revchain::detail
