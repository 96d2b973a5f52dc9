// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain.hpp"
#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/pencil/condensed/transfer.hpp"
#include "revchain/simd/pack.hpp"

/// Condenses runs of links of long chains. In a slow mode many neighbouring links move nearly as
/// one link. A run of links is therefore replaced by polynomials in mu = 1/lambda that carry offset
/// and force from its lower to its upper pin (`pencil::Transfer`). Counts and shapes then pass over
/// runs instead of links. A run consists of leaves, which are built link by link and then merged.
/// Errors: docs/theory/blocks.md; a unit is 2^-53 in double.
namespace revchain::inline REVCHAIN_BUILD::detail {

inline constexpr Index runs_at_once = pack_size;  ///< four neighbouring runs, one in each SIMD lane
inline constexpr std::size_t leaf_degree = 4;     ///< number of terms of their polynomials

/// Returns the number of links of a leaf in a run of `length` links. A sixteenth of the run keeps
/// the mass that rounding moves from pin to pin below 1/4 unit. At least 4 links (if the run has as
/// many) keep merges cheap. The number divides powers of 2.
constexpr Index leaf_links(Index length) {
    return std::min(length, std::clamp<Index>(length / 16, 4, 64));
}

/// Returns the number of terms of the leaves of a run. Leaves of runs of up to 63 links have all 4
/// terms. Leaves of longer runs are so short beside them that 3 terms nearly always suffice
/// (`condensed_chain` checks the omitted terms).
constexpr std::size_t leaf_terms(Index length) {
    return length < 64 ? leaf_degree : leaf_degree - 1;
}

/// Returns the number of roundings, of one unit each, in the moment a1 of a leaf.
constexpr Index moment_roundings(Index links) { return 2 * links + 6; }
/// Returns the number of roundings, of one unit each, in the other coefficients of a leaf.
constexpr Index coefficient_roundings(Index links) { return 3 * links + 13; }

/// Neighbouring runs of links, condensed, one in each lane; lengths in `LinkColumns::unit_length`.
/// First coefficients have two words: the weight c0 of a run, its flexibility b1 (sum of f = 1/k),
/// and its moment a1 (sum over masses of weight times the flexibility above it in the run).
template <class V>
struct LaneRuns {
    pencil::Transfer<V, leaf_degree> transfer;
    CompensatedSum<V> weight, flexibility, moment;
    V leaf_phase{};   ///< largest c0 b1 of a leaf
    V leaf_moment{};  ///< largest a1^2 / (c0 b1) of a leaf
    /// Positive if a condition of `condense` is not met; the run is then not valid.
    V worst{};

    /// Joins a leaf to the top of each run.
    template <std::size_t Degree>
    [[gnu::always_inline]] void add_leaf(const pencil::Transfer<V, Degree>& leaf,
                                         const CompensatedSum<V>& mass,
                                         const CompensatedSum<V>& its_flexibility, bool is_first) {
        const V phase = mass.high * its_flexibility.high;
        leaf_phase = max(leaf_phase, phase);
        const V square = leaf.a[0] * leaf.a[0];
        leaf_moment = max(leaf_moment, if_less(V{}, phase, square / phase, V{}));  // avoids 0/0
        moment.add(leaf.a[0] + its_flexibility.high * weight.high);
        moment.low += its_flexibility.high * weight.low + its_flexibility.low * weight.high;
        transfer = is_first ? pencil::extended<leaf_degree>(leaf) : pencil::merged(transfer, leaf);
        weight.add(mass);
        weight.normalise();
        flexibility.add(its_flexibility);
    }
};

/// Reads a column link by link. A column of one number serves all links.
template <class From>
struct ColumnReader {
    const From* data;
    Index stride;

    explicit ColumnReader(const Column<From>& column)
        : data(column.data()), stride(column.is_scalar() ? 0 : 1) {}
    bool is_scalar() const { return stride == 0; }
    /// Returns one number for each lane, from links that are `apart` links from each other.
    template <class V>
    [[gnu::always_inline]] V lanes(Index link, Index apart) const {
        using T = Lane<V>;
        const From* first = data + link * stride;
        const auto at = [&](Index lane) REVCHAIN_INLINED {
            return static_cast<T>(first[lane * apart * stride]);
        };
        return V(at(0), at(1), at(2), at(3));
    }
};

/// The columns of a chain for `condense`.
template <class T>
struct LinkColumns {
    ColumnReader<T> weight, length, centroid;
    ColumnReader<Wide<T>> gyration_ratio;
    bool equal = false;  ///< true if links differ only in weight
    T unit_length;       ///< length of a link if it serves all, else a power of two

    explicit LinkColumns(const Chain<T>& chain)
        : weight(chain.weight()),
          length(chain.length()),
          centroid(chain.centroid()),
          gyration_ratio(chain.gyration_ratio()),
          unit_length(std::ldexp(T(1), chain.units().length_exponent)) {
        equal = length.is_scalar() && centroid.is_scalar() && gyration_ratio.is_scalar();
        if (equal) unit_length = *length.data;
    }
};

/// Condenses four neighbouring runs of `length` links, from link `first` on, with leaves of
/// `Degree` terms. `below` is the weight hung below each run. A link is a mass p W at its lower
/// pin, p = h/a, a spring 1/f = (S + p W)/a + mu X and a mass (1 - p) W at its upper pin, with S
/// the weight below it and X = W (p (1 - p) - rho^2/a^2). `LaneRuns::worst` is positive in the lane
/// of a run for which
///     a centroid is beyond the pins of its link (p < 0 or p > 1), or X < 0 (l > a),
///     a link, or in long runs a leaf, outweighs everything below it,
///     p W is more than 1/32 of S + p W, or
///     a leaf is too light beside the weight that it carries.
/// `Equal`: links differ only in weight; reading the other data link by link would cost 1.4 times
/// as much (ten modes of 1,000,000 rods). Four terms in every leaf would cost 1.3 times as much.
/// Roundings: 0.1 units in the weight of a run, 1.1 in its flexibility, and those of
/// `moment_roundings` and `coefficient_roundings` in each leaf.
/// Precondition: `leaf_links(length)` divides `length`, as it does if `length` is a power of 2.
/// Cost: 1.5 ns a link in double with AVX-512, 3 ns with AVX2, 4.5 ns with SSE2.
template <bool Equal, std::size_t Degree, class T, class V = Pack<T>>
LaneRuns<V> condense(const LinkColumns<T>& links, Index first, Index length,
                     const CompensatedSum<V>& below) {
    return simd([&](auto) REVCHAIN_INLINED {
        LaneRuns<V> runs;
        CompensatedSum<V> hung = below;
        V p(T(1)), coefficient{}, a(T(1)), per_length(T(1));
        const T per_unit = T(1) / links.unit_length;
        const auto set_link = [&](Index m) REVCHAIN_INLINED {
            a = links.length.template lanes<V>(m, length) * per_unit;
            per_length = T(1) / a;
            if constexpr (Equal)
                p = links.centroid.template lanes<V>(m, length) /
                    links.length.template lanes<V>(m, length);
            else
                p = links.centroid.template lanes<V>(m, length) * per_unit * per_length;
            coefficient = p * (T(1) - p) - links.gyration_ratio.template lanes<V>(m, length);
            // p < 0, p > 1, or X/W below 0 by more than rounding
            runs.worst =
                max(runs.worst, max(max(-p, p - T(1)), -coefficient - T(4) * epsilon<T>()));
            coefficient = max(coefficient, V{});
        };
        if constexpr (Equal) {
            set_link(first);
            a = per_length = V(T(1));
        }
        const Index step = leaf_links(length);
        // `add_smaller` needs links that do not outweigh everything below them. In long runs this
        // is checked once a leaf: then none of its links does.
        constexpr bool check_leaves = Degree < leaf_degree;
        // The weight of a leaf is a difference of two values of `hung`. The second word of `hung`,
        // at most `step` units of the first, is rounded once a link: in all by at most 1/32 unit of
        // the weight of a leaf that passes the check below.
        const T lost = T(16 * step * step) * epsilon<T>();
        for (Index start = 0; start < length; start += step) {
            pencil::Transfer<V, Degree> leaf;
            CompensatedSum<V> flexibility;
            hung.normalise();
            const CompensatedSum<V> at_start = hung;
            V carry{};  // mass at the upper pin of the link before
            for (Index m = start; m < start + step; ++m) {
                if constexpr (!Equal) set_link(first + m);
                const V w = links.weight.template lanes<V>(first + m, length);
                if constexpr (!check_leaves)  // the link outweighs all below it
                    runs.worst = max(runs.worst, if_less(V{}, hung.high, w - hung.high, V{}));
                const V at_lower = p * w;
                pencil::append_mass(leaf, carry + at_lower);
                carry = w - at_lower;
                CompensatedSum<V> s = hung;
                s.add_smaller(at_lower);
                hung.add_smaller(w);
                const V f = a / s.high;
                pencil::append_spring(leaf, f, coefficient * w * f);
                if constexpr (Equal)
                    flexibility.add_smaller(f);  // the weight at a spring grows upwards
                else
                    flexibility.add(f);
                flexibility.low -= f * f * per_length * s.low;
                // p W is a rounded product: its error must be small beside s
                runs.worst = max(runs.worst, at_lower - T(0x1p-5) * s.high);
            }
            pencil::append_mass(leaf, carry);
            CompensatedSum<V> mass{hung.high, V{}};
            mass.add(-at_start.high);
            mass.add(hung.low - at_start.low);
            // the leaf is too light, or outweighs all below it
            runs.worst = max(runs.worst, hung.high * lost - mass.high);
            if constexpr (check_leaves) runs.worst = max(runs.worst, mass.high - at_start.high);
            flexibility.normalise();
            runs.add_leaf(leaf, mass, flexibility, start == 0);
        }
        return runs;
    });
}

/// Returns the weights below four neighbouring runs of `length` links. Link `first` begins them.
/// `below` is the weight below the first run; it becomes the weight below the link after the last
/// run.
template <class T, class V = Pack<T>>
CompensatedSum<V> weights_below(const Chain<T>& chain, const LinkColumns<T>& links, Index first,
                                Index length, Wide<T>& below) {
    using S = Wide<T>;
    CompensatedSum<V> sum, result;
    const bool in_segments = first % segment_size == 0 && length % segment_size == 0;
    if (!in_segments)
        for (Index m = first; m < first + length; ++m)
            sum.add(links.weight.template lanes<V>(m, length));
    for (Index lane = 0; lane < runs_at_once; ++lane) {
        const auto i = static_cast<std::size_t>(lane);
        result.high.set(i, static_cast<T>(below));
        result.low.set(i, static_cast<T>(below - S(result.high[i])));
        below = in_segments ? chain.weight_below(first + (lane + 1) * length)
                            : below + S(sum.high[i]) + S(sum.low[i]);
    }
    return result;
}

}  // namespace revchain::detail
