// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/condensed_heights.hpp"
#include "revchain/linear/mode_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Links as mass, spring, mass: lambda stiffness + cross between at_lower and at_upper.
template <class T>
struct LinkChunk {
    static constexpr Index most = 256;
    std::array<T, most> stiffness, cross, at_lower, at_upper;
    Index count = 0;

    /// Computes links first ... first + links - 1, with lengths in `unit`.
    LinkChunk(const Chain<T>& chain, Index first, Index links, const T& unit) : count(links) {
        const Wide<T> hung = chain.weight_below(first);
        CompensatedSum<T> below{hung.high, hung.low};
        for (Index i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const T w = chain.weight()[first + i], a = chain.length()[first + i];
            const T p = chain.centroid()[first + i] / a;
            at_lower[at] = p * w;
            at_upper[at] = w - at_lower[at];
            stiffness[at] = (below.high + (below.low + at_lower[at])) / (a / unit);
            cross[at] = w * (p * (T(1) - p) - static_cast<T>(chain.gyration_ratio()[first + i]));
            below.add(w);
        }
    }
};

/// Offset and transverse force (over lambda) at a pin in each lane, with compensated sums.
template <class V>
struct PinState {
    CompensatedSum<V> offset, force;
};

/// Carries the state down the chunk. `offset[i]` becomes the offset of the lower pin of link i.
template <class T>
void descend(const LinkChunk<T>& links, const Pack<T>& lambda, PinState<Pack<T>>& state,
             Pack<T>* offset) {
    using V = Pack<T>;
    simd([&](auto) REVCHAIN_INLINED {
        for (Index m = links.count; m-- > 0;) {
            const auto i = static_cast<std::size_t>(m);
            state.force.add(-(V(links.at_upper[i]) * state.offset.value()));
            const V spring = lambda * links.stiffness[i] + V(links.cross[i]);
            state.offset.add(state.force.value() / spring);
            const V y = state.offset.value();
            state.force.add(-(V(links.at_lower[i]) * y));
            offset[i] = y;
        }
    });
}

/// Residual forces at all pins but the held one, and the largest sum of sizes of terms at a pin.
template <class V>
struct Balance {
    V force{}, size{};  ///< of the link above, at the current pin
    V worst{}, largest{};
};

template <class T>
void weigh(const LinkChunk<T>& links, const Pack<T>& lambda, const Pack<T>& top, bool held,
           const Pack<T>* offset, Balance<Pack<T>>& balance) {
    using V = Pack<T>;
    simd([&](auto) REVCHAIN_INLINED {
        for (Index m = links.count; m-- > 0;) {
            const auto i = static_cast<std::size_t>(m);
            const V lower = offset[i], upper = m + 1 < links.count ? offset[i + 1] : top;
            const V stiffness = lambda * links.stiffness[i] + V(links.cross[i]);
            const V pull = stiffness * (lower - upper);
            const V at_upper = V(links.at_upper[i]) * upper,
                    at_lower = V(links.at_lower[i]) * lower;
            const V size = abs(stiffness) * (abs(lower) + abs(upper));
            if (!held || m + 1 < links.count) {
                balance.worst = max(balance.worst, abs(balance.force - (pull + at_upper)));
                balance.largest = max(balance.largest, balance.size + size + abs(at_upper));
            }
            balance.force = pull - at_lower;
            balance.size = size + abs(at_lower);
        }
    });
}

/// Four modes, carried down the chain.
template <class T>
struct ShapePack {
    using V = Pack<T>;
    using P = DoubleWord<V>;
    P height;
    std::vector<pencil::LumpedElement<P>> elements;  ///< elements of the blocks
    std::vector<P> between;                          ///< offsets between blocks
    V largest{};                                     ///< largest offset so far
    PinState<V> state;
    V top;  ///< offset of the current pin
    Balance<V> balance;
    std::array<std::vector<pencil::Crossing<T>>, pack_size> crossing;

    /// Finds offsets between blocks. Returns false if one of the first `lanes` leaves the range.
    bool start(const pencil::CondensedPencil<T>& pencil, std::size_t lanes) {
        elements = pencil::elements_at<P>(pencil, height);
        between = pencil::offsets_between(elements);
        V least(std::numeric_limits<T>::max()), most{};
        for (std::size_t b = 0; b < elements.size(); ++b) {
            most = max(most, abs(between[b].high));
            least = if_less(abs(between[b].high), least, abs(between[b].high), least);
        }
        const P tip = between[0], by = P(V(T(1))) / tip;
        bool at_tip = true;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const bool normal = least[lane] > std::numeric_limits<T>::min() / epsilon<T>();
            if (!normal || !(most[lane] < T(1e100))) return false;
            at_tip = at_tip && abs(tip.high)[lane] >= most[lane];
        }
        if (at_tip)  // the usual case: the rows then need no scaling later
            for (P& y : between) y = y * by;
        return true;
    }
    void enter(std::size_t b) {
        const P& upper = between[b + 1];
        const P force = (between[b] - upper) * elements[b].spring + elements[b].upper * upper;
        state = {{upper.high, upper.low}, {force.high, force.low}};
        top = upper.high;
    }
};

/// Stores offsets of a chunk's lower pins in the rows of `shapes`, and the crossings between them.
template <class T>
void store(ModeShapes<T>& shapes, ShapePack<T>& pack, std::size_t first, std::size_t lanes,
           Index link, Index count, const std::vector<Pack<T>>& offset) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        T* row = &shapes.offset(static_cast<Index>(first + lane), link);
        T upper = pack.top[lane];
        for (Index i = count; i-- > 0;) {
            const T y = offset[static_cast<std::size_t>(i)][lane];
            row[i] = y;
            if ((y < T(0)) != (upper < T(0)) && upper != T(0))  // 0 is the held pin
                pack.crossing[lane].push_back({link + i, y / (y - upper)});
            upper = y;
        }
    }
}

/// Does `shapes_by_condensation` for the modes begin ... end - 1; packs start at `begin`.
template <std::floating_point T>
bool shapes_in_packs(ModeShapes<T>& shapes, const Chain<T>& chain,
                     const CondensedChain<T>& condensed, const Heights<T>& heights,
                     std::size_t begin, std::size_t end, Progress* progress) {
    using std::ldexp;
    using V = Pack<T>;
    using S = Wide<T>;
    const auto& blocks = condensed.pencil.blocks;
    const Index size = chain.size();
    const auto first_of = [&](std::size_t pack) { return begin + pack * pack_size; };
    const auto lanes_of = [&](std::size_t pack) {
        return std::min(pack_size, end - first_of(pack));
    };
    std::vector<ShapePack<T>> packs((end - begin + pack_size - 1) / pack_size);
    for (std::size_t k = 0; k < packs.size(); ++k) {
        const std::size_t first = first_of(k), lanes = lanes_of(k);
        for (std::size_t lane = 0; lane < pack_size; ++lane) {
            const S unrounded = heights[first + std::min(lane, lanes - 1)].unrounded;
            const S height =
                ldexp(unrounded, chain.units().length_exponent) / S(condensed.unit_length);
            packs[k].height.high.set(lane, height.high);
            packs[k].height.low.set(lane, height.low);
        }
        if (!packs[k].start(condensed.pencil, lanes)) return false;
    }
    std::vector<V> offset(LinkChunk<T>::most);
    Index above = size;
    for (std::size_t b = blocks.size(); b-- > 0;) {
        for (ShapePack<T>& pack : packs) pack.enter(b);
        const Index bottom = above - blocks[b].links;
        while (above > bottom) {
            const Index count = std::min(above - bottom, LinkChunk<T>::most);
            above -= count;
            const LinkChunk<T> chunk(chain, above, count, condensed.unit_length);
            for (std::size_t k = 0; k < packs.size(); ++k) {
                ShapePack<T>& pack = packs[k];
                descend(chunk, pack.height.high, pack.state, offset.data());
                if (above == bottom) offset[0] = pack.between[b].high + pack.between[b].low;
                for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
                    pack.largest = max(pack.largest, abs(offset[i]));
                weigh(chunk, pack.height.high, pack.top, above + count == size, offset.data(),
                      pack.balance);
                store(shapes, pack, first_of(k), lanes_of(k), above, count, offset);
                pack.top = offset[0];
            }
        }
        advance(progress, 1 - static_cast<double>(above) / static_cast<double>(size));
    }
    const std::vector<S> places = pin_places(chain);
    for (std::size_t k = 0; k < packs.size(); ++k)
        for (std::size_t lane = 0; lane < lanes_of(k); ++lane) {
            const auto j = static_cast<Index>(first_of(k) + lane);
            auto& crossing = packs[k].crossing[lane];
            shapes.offset(j, size) = T(0);
            const T scale = (shapes.offset(j, 0) < T(0) ? T(-1) : T(1)) / packs[k].largest[lane];
            if (scale != T(1)) shapes.offset.row(j) *= scale;
            const auto& balance = packs[k].balance;
            shapes.residual[j] =
                max(balance.worst, abs(balance.force))[lane] / balance.largest[lane];
            std::reverse(crossing.begin(), crossing.end());
            shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain, places, crossing);
        }
    return true;
}

/// Does stage 2 of `modes` for a condensed chain: shapes, residuals and nodes. Twisted recursions
/// in double words give offsets between blocks. Compensated sums carry them from each block's upper
/// pin down. Returns false, with incomplete shapes, if offsets leave the range of T. Accuracy,
/// measured: 2e-16 / (gap to the next height) of the largest offset, and as good relative to itself
/// at the top pin (tests/cpp/linear/condensed_heights.cpp). Cost: 10 ns per link and mode.
template <std::floating_point T>
bool shapes_by_condensation(ModeShapes<T>& shapes, const Chain<T>& chain,
                            const CondensedChain<T>& condensed, const Heights<T>& heights,
                            Progress* progress) {
    std::atomic<bool> in_range = true;
    parallel_for(heights.size(), pack_size, [&](std::size_t begin, std::size_t end) {
        if (!shapes_in_packs(shapes, chain, condensed, heights, begin, end, progress))
            in_range = false;
    });
    return in_range;
}

/// Returns shapes at `heights` (in the units of the chain's pencils) of the modes from number
/// `first` on, by condensation. The result is empty if blocks do not pay, if weights need several
/// units, or if offsets leave the range of T.
template <std::floating_point T>
std::optional<ModeShapes<T>> condensed_shapes(const Chain<T>& chain, Index first,
                                              const Heights<T>& heights, Progress* progress) {
    constexpr auto most_for_lanes =
        static_cast<Index>(pencil::most_kept_links);  // up to here lanes are faster than blocks
    const auto count = static_cast<Index>(heights.size());
    if (chain.size() <= most_for_lanes || !condensation_pays(chain, {first, count}) ||
        !chain.has_one_weight_unit() ||
        std::abs(chain.units().weight_exponent) > std::numeric_limits<T>::max_exponent / 2)
        return std::nullopt;
    const T unit =
        std::ldexp(T(1), chain.units().length_exponent) / LinkColumns<T>(chain).unit_length;
    const auto condensed = condensed_chain(chain, T(0.95) * heights.back().eigenvalue * unit);
    ModeShapes<T> shapes = room_for_shapes(chain, count);
    if (!shapes_by_condensation(shapes, chain, condensed, heights, progress)) return std::nullopt;
    return shapes;
}

}  // namespace revchain::detail
