// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>

#include "revchain/chain.hpp"
#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/pencil/element.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The small-amplitude pencil of a chain in `Wide<T>`. Weights are in units of
/// 2^units.weight_exponent (and of the pencil's own units), heights in units of
/// 2^units.length_exponent.
template <Real T>
struct AssembledChain {
    pencil::ElementPencil<Wide<T>> pencil;
    ChainUnits units;
};

namespace detail {

/// Sets the bounds of a chain's pencil; |W h| + a S is at most `cancelled` times W h + a S.
template <Real S, class E>
void set_entry_errors(pencil::ElementPencil<S>& pencil, Index size, const E& cancelled,
                      const E& shortest) {
    // S, the weight below a link, is a partial weight plus up to a segment of weights. Others take
    // at most six operations.
    const Index segments = (size - 1) / segment_size;
    const Index sums = segments == 0 ? size : segment_size + segments + 20;
    pencil.entry_error = operation_error<S>() * (E(sums + 4) * cancelled * E(1.01) + E(7));
    using Limits = std::numeric_limits<E>;
    pencil.stiffness_underflow = Limits::min() * Limits::epsilon() * E(4) / shortest;
}

/// The numbers of a link, or of several in lanes; `below` is the weight hung below it.
template <class S>
struct LinkEntries {
    S moment, carried;  ///< W h/a, without and with the weight below
    S stiffness, lower, upper, cross, turning;
};
template <class S, class W>
[[gnu::always_inline]] inline LinkEntries<S> link_entries(const W& weight, const S& a, const S& h,
                                                          const S& r, const S& below) {
    const S p = h / a, q = (a - h) / a, moment = p * weight, carried = moment + below;
    return {moment,
            carried,
            carried / a,
            (p * p + r) * weight,
            (q * q + r) * weight,
            (p * q - r) * weight,
            r * weight};
}

/// Does `assemble` for a chain in one unit whose centroids are not above their pins, several links
/// at a time. Cost: 15 ns a link, 7 ns for plummets; one link at a time takes 150 ns.
template <class Where>
[[gnu::always_inline]] inline void assemble_in_packs(Where, const Chain<double>& chain,
                                                     AssembledChain<double>& result) {
    using V = Pack<double, Where::doubles, lanes_at_once / Where::doubles>;
    using Words = DoubleWord<V>;
    using Numbers = std::array<double, V::size>;
    // Two steps are used: a power of two that scales the largest numbers to 1 may be subnormal.
    struct Scale {
        double first, second;
        explicit Scale(int exponent)
            : first(std::ldexp(1.0, -exponent / 2)),
              second(std::ldexp(1.0, -exponent + exponent / 2)) {}
        double operator()(double x) const { return x * first * second; }
    };
    const Scale weighed(result.units.weight_exponent), measured(result.units.length_exponent);
    const Index size = chain.size();
    auto& elements = result.pencil.elements;
    elements.resize(static_cast<std::size_t>(size));
    CompensatedSum<double> below;
    double shortest = 1;
    for (Index first = 0; first < size; first += static_cast<Index>(V::size)) {
        const std::size_t there = std::min(V::size, static_cast<std::size_t>(size - first));
        if (first % segment_size == 0) {
            const Wide<double> sum = chain.weight_below(first);
            below = {weighed(sum.high), weighed(sum.low)};
        }
        Numbers weight, length, centroid, ratio, ratio_low, hung, hung_low;
        bool lumped = true;
        for (std::size_t i = 0; i < V::size; ++i) {
            const Index m = first + static_cast<Index>(std::min(i, there - 1));
            weight[i] = weighed(chain.weight()[m]);
            length[i] = measured(chain.length()[m]);
            centroid[i] = measured(chain.centroid()[m]);
            ratio[i] = chain.gyration_ratio()[m].high;
            ratio_low[i] = chain.gyration_ratio()[m].low;
            hung[i] = below.high;
            hung_low[i] = below.low;
            below.add(weight[i]);
            lumped = lumped && centroid[i] == length[i] && ratio[i] == 0;
            shortest = std::min(shortest, length[i]);
        }
        below.normalise();
        const auto all = [](const Numbers& x) REVCHAIN_INLINED { return V::load(x.data()); };
        const V W = all(weight);
        const Words a(all(length)), S = fast_two_sum(all(hung), all(hung_low));
        Words entries[5];
        if (lumped) {
            entries[0] = (S + W) / a;
            entries[1] = Words(W);
        } else {
            const Words r(all(ratio), all(ratio_low));
            const auto e = link_entries(W, a, Words(all(centroid)), r, S);
            entries[0] = e.stiffness, entries[1] = e.lower, entries[2] = e.upper,
            entries[3] = e.cross, entries[4] = e.turning;
        }
        Numbers high[5], low[5];
        for (std::size_t e = 0; e < 5; ++e) {
            entries[e].high.store(high[e].data());
            entries[e].low.store(low[e].data());
        }
        for (std::size_t i = 0; i < there; ++i) {
            const auto at = [&](std::size_t e) { return Wide<double>(high[e][i], low[e][i]); };
            elements[static_cast<std::size_t>(first) + i] = {at(0), at(1), at(2),
                                                             at(3), at(4), weight[i]};
        }
    }
    set_entry_errors(result.pencil, size, 1.0, shortest);
}

}  // namespace detail

/// Returns the elements of a chain, Greenhill (1908) §8 with sec delta = 1. Let p = h/a, q = (a -
/// h)/a and r = rho^2/a^2. The stiffness is k = (W p + S)/a. The mass of a rigid body about its two
/// pins is A = W (p^2 + r), B = W (q^2 + r), X = W (p q - r), c = W r. Entries are within the
/// relative `entry_error` of exact functions of the stored numbers. In double it is 4e-31 (N + 11)
/// up to 256 links, then 4e-31 (N/256 + 290). It is more where a centroid above the pin makes
/// W h + a S cancel. If one unit does not suffice, units are upper pins' weights within
/// 2^(max_exponent/8). Cost O(N).
template <Real T>
AssembledChain<T> assemble(const Chain<T>& chain) {
    using std::abs, std::frexp, std::ldexp;
    using S = Wide<T>;
    using E = Narrow<S>;
    constexpr int stride = std::numeric_limits<T>::max_exponent / 8;
    const bool one_unit = chain.has_one_weight_unit();
    AssembledChain<T> result;
    result.units = chain.units();
    if constexpr (std::same_as<T, double>)
        if (one_unit && chain.centroids_below()) {
            simd([&](auto where)
                     REVCHAIN_INLINED { detail::assemble_in_packs(where, chain, result); });
            return result;
        }
    result.pencil.elements.reserve(static_cast<std::size_t>(chain.size()));
    const int to_length = -result.units.length_exponent;
    S below(T(0));   // S, in the unit of the chain
    E shortest(1);   // length, in the unit of the chain
    E cancelled(1);  // worst (|W h| + a S) / (W h + a S)
    for (Index m = 0; m < chain.size(); ++m) {
        if (m % detail::segment_size == 0) below = chain.weight_below(m);
        const Link<T> link = chain.link(m);
        const S above = below + S(link.weight);
        int unit = result.units.weight_exponent;
        if (!one_unit) {
            int exponent = 0;
            frexp(static_cast<T>(above), &exponent);
            const int lower = (unit - exponent) / stride * stride;
            unit -= lower;
            result.pencil.units.push_back(-lower);
        }
        const E weight(ldexp(link.weight, -unit));
        const S hung = ldexp(below, -unit);
        const S a(ldexp(link.length, to_length)), h(ldexp(link.centroid, to_length));
        const auto e = detail::link_entries(S(weight), a, h, link.gyration_ratio, hung);
        result.pencil.elements.push_back(
            {e.stiffness, e.lower, e.upper, e.cross, e.turning, weight});
        shortest = std::min(shortest, static_cast<E>(a));
        const E sizes = abs(static_cast<E>(e.moment)) + static_cast<E>(hung);
        cancelled = std::max(cancelled, sizes / static_cast<E>(e.carried));
        below = above;
    }
    detail::set_entry_errors(result.pencil, chain.size(), cancelled, shortest);
    return result;
}

}  // namespace revchain
