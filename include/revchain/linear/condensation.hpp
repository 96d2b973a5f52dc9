// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain/chain.hpp"
#include "revchain/linalg/block_transfer.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packs never leave a translation unit

namespace revchain::detail {

inline constexpr Index runs_at_once = pack_size;  ///< neighbouring runs, one in each SIMD lane
inline constexpr std::size_t leaf_degree = 4;     ///< of their polynomials

/// Links that are summed plainly; longer runs are merged from such leaves. A sixteenth of the run keeps what their
/// roundings move from pin to pin below 1/4 unit; 32 make the merges cheap.
constexpr Index leaf_links(Index length) { return std::min(length, std::clamp<Index>(length / 16, 4, 64)); }

/// Sum of numbers, or of packs lane by lane: high + low.
template <class V>
struct CompensatedSum {
    V high{}, low{};
    void add(const V& x) {
        const V s = high + x;
        const V v = s - high;
        low += (high - (s - v)) + (x - v);
        high = s;
    }
    /// The same where x is no larger than what there is, or the first.
    void add_smaller(const V& x) {
        const V s = high + x;
        low += x - (s - high);
        high = s;
    }
    void normalise() {
        const V s = high + low;
        low -= s - high;
        high = s;
    }
    void add(const CompensatedSum& x) {
        add(x.high);
        low += x.low;
    }
};

/// Neighbouring runs of links, condensed, one in each lane. Units of length: `unit_length` of the columns.
template <class V>
struct LaneRuns {
    linalg::Transfer<V, leaf_degree> transfer;
    CompensatedSum<V> weight, flexibility, moment;  ///< c0, b1, a1
    V leaf_phase{};                                 ///< largest c0 b1 of a leaf
    V leaf_moment{};                                ///< largest a1^2 / (c0 b1) of a leaf
    V worst{};  ///< positive: the run is not valid (a centroid beyond the pins, an inertia beyond l = a, a weight above
        ///< all below it, a leaf too light to be told from what it carries, a lowest link too long for its spring)
};

/// What the condensation reads of a chain: pointers and strides (0 where one number serves all links).
template <class T>
struct LinkColumns {
    const T* weight;
    Index weight_stride;
    const T* length;
    Index length_stride;
    const T* centroid;
    Index centroid_stride;
    const Wide<T>* gyration_ratio;
    Index gyration_stride;

    explicit LinkColumns(const Chain<T>& chain)
        : weight(chain.weight().data()),
          weight_stride(chain.weight().is_scalar() ? 0 : 1),
          length(chain.length().data()),
          length_stride(chain.length().is_scalar() ? 0 : 1),
          centroid(chain.centroid().data()),
          centroid_stride(chain.centroid().is_scalar() ? 0 : 1),
          gyration_ratio(chain.gyration_ratio().data()),
          gyration_stride(chain.gyration_ratio().is_scalar() ? 0 : 1) {}

    /// Nothing but the weights differs from link to link: lengths are then counted in that of a link.
    bool equal_but_for_weights() const { return length_stride == 0 && centroid_stride == 0 && gyration_stride == 0; }
    bool plummets() const {
        return equal_but_for_weights() && *centroid == *length && *gyration_ratio == Wide<T>(T(0));
    }
    T unit_length() const { return equal_but_for_weights() ? *length : T(1); }
};

/// One number for each lane, `apart` from one another.
template <class V, class T, class From>
[[gnu::always_inline]] inline V gathered(const From* first, Index apart) {
    return V(static_cast<T>(first[0]), static_cast<T>(first[apart]), static_cast<T>(first[2 * apart]),
             static_cast<T>(first[3 * apart]));
}

enum class LinkKind { equal_plummets, equal_links, any_links };  // equal but for their weights

/// Four neighbouring runs of `length` links from link `first` on; `below` is the weight hung below each.
/// A link is a mass p W at its lower pin, p = h/a, a spring 1/f = (S + p W)/a + mu X and a mass (1 - p) W at its upper
/// pin, X = W (p (1 - p) - rho^2/a^2). Roundings: f 2.25 units (in the last place, halved), weight and flexibility of a run
/// less than 0.01, moment of a leaf 2 leaf_links + 2, other coefficients 4 leaf_links + 4.
/// Cost: 0.9 ns a plummet, 1.5 ns a link in double with AVX-512, twice and three times that with AVX2 and SSE2.
template <LinkKind Kind, std::size_t Degree, class T, class V = Pack<T>>
REVCHAIN_SIMD LaneRuns<V> condense(const LinkColumns<T>& links, Index first, Index length,
                                   const CompensatedSum<V>& below) {
    LaneRuns<V> runs;
    CompensatedSum<V> hung = below;
    V p = V(T(1)), coefficient{}, a = V(T(1));
    const auto set_link = [&](Index m) __attribute__((always_inline)) {
        a = gathered<V, T>(links.length + m * links.length_stride, length * links.length_stride);
        const V inverse = T(1) / a;
        p = inverse * gathered<V, T>(links.centroid + m * links.centroid_stride, length * links.centroid_stride);
        const V square =
            gathered<V, T>(links.gyration_ratio + m * links.gyration_stride, length * links.gyration_stride);
        coefficient = p * (T(1) - p) - square;
        if constexpr (Kind == LinkKind::equal_links) a = V(T(1));
        runs.worst = max(runs.worst, max(max(-p, p - T(1)), -coefficient - T(4) * epsilon<T>()));
        coefficient = max(coefficient, V{});
    };
    if constexpr (Kind == LinkKind::equal_links) set_link(first);
    const Index step = leaf_links(length);
    // hung.low is rounded `step` times at `step` half units of hung.high: that much of the mass of a leaf is lost.
    const T lost = T(16 * step * step) * epsilon<T>();
    for (Index start = 0; start < length; start += step) {
        linalg::Transfer<V, Degree> leaf;
        CompensatedSum<V> flexibility;
        hung.normalise();
        const CompensatedSum<V> at_start = hung;
        V carry{};  // mass at the upper pin of the link before
        for (Index m = start; m < start + step; ++m) {
            if constexpr (Kind == LinkKind::any_links) set_link(first + m);
            const V w = gathered<V, T>(links.weight + (first + m) * links.weight_stride, length * links.weight_stride);
            runs.worst = max(runs.worst, if_less(V{}, hung.high, w - hung.high, V{}));
            if constexpr (Kind == LinkKind::equal_plummets) {
                linalg::append_mass(leaf, w);
                hung.add_smaller(w);
                const V f = T(1) / (hung.high + hung.low);
                linalg::append_spring(leaf, f);
                flexibility.add_smaller(f);  // the weight at a spring grows upwards
            } else {
                const V at_lower = p * w;
                linalg::append_mass(leaf, carry + at_lower);
                carry = w - at_lower;
                const V s = hung.high + (hung.low + at_lower);
                hung.add_smaller(w);
                const V f = a / s;
                linalg::append_spring(leaf, f, coefficient * w * f);
                if constexpr (Kind == LinkKind::equal_links)
                    flexibility.add_smaller(f);
                else
                    flexibility.add(f);
                runs.worst = max(runs.worst, (T(1) - p) * at_lower - T(0.125) * s);
            }
        }
        if constexpr (Kind != LinkKind::equal_plummets) linalg::append_mass(leaf, carry);
        CompensatedSum<V> mass{hung.high, V{}};
        mass.add(-at_start.high);
        mass.add(hung.low - at_start.low);
        runs.worst = max(runs.worst, hung.high * lost - mass.high);
        const V phase = mass.high * flexibility.high;
        runs.leaf_phase = max(runs.leaf_phase, phase);
        runs.leaf_moment = max(runs.leaf_moment, leaf.a[0] * leaf.a[0] / phase);
        runs.moment.add(leaf.a[0] + flexibility.high * runs.weight.high);
        const auto larger_leaf = linalg::extended<leaf_degree>(leaf);
        runs.transfer = start == 0 ? larger_leaf : linalg::merged(runs.transfer, larger_leaf);
        runs.weight.add(mass);
        runs.flexibility.add(flexibility);
    }
    return runs;
}

/// The weight hung below each of four neighbouring runs of `length` links, the first one hung by `below`.
template <class T, class V = Pack<T>>
CompensatedSum<V> weights_below(const Chain<T>& chain, const LinkColumns<T>& links, Index first, Index length,
                                Wide<T>& below) {
    using S = Wide<T>;
    CompensatedSum<V> sum, result;
    const bool in_segments = first % segment_size == 0 && length % segment_size == 0;
    if (!in_segments)
        for (Index m = first; m < first + length; ++m)
            sum.add(gathered<V, T>(links.weight + m * links.weight_stride, length * links.weight_stride));
    for (Index lane = 0; lane < runs_at_once; ++lane) {
        const auto i = static_cast<std::size_t>(lane);
        result.high.set(i, static_cast<T>(below));
        result.low.set(i, static_cast<T>(below - S(result.high[i])));
        below = in_segments ? chain.weight_below(first + (lane + 1) * length) : below + S(sum.high[i]) + S(sum.low[i]);
    }
    return result;
}

}  // namespace revchain::detail

#pragma GCC diagnostic pop
