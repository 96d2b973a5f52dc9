// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/condensation.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/condensed/builder.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// Returns link number `index` as a run in `Wide<T>`; alone if the polynomials do not hold for it.
template <Real T>
pencil::CondensedRun<T> single_link(const pencil::CondensedPencilBuilder<T>& builder,
                                    const Link<T>& link, Index index, const T& unit_length,
                                    const Wide<T>& below) {
    using std::abs;
    using S = Wide<T>;
    using E = Narrow<S>;
    pencil::CondensedRun<T> run;
    run.links = 1;
    const int to_unit = -std::ilogb(unit_length);  // lengths first: weights over them may underflow
    const auto scaled = [&](const T& x) { return S(static_cast<E>(std::ldexp(x, to_unit))); };
    const S weight(static_cast<E>(link.weight)), a = scaled(link.length);
    const S p = scaled(link.centroid) / a;
    const S lower = weight * p;
    const S stiffness = (lower + below) / (a / scaled(unit_length));
    const S cross = weight * (p * (S(E(1)) - p) - link.gyration_ratio);
    run.flexibility = S(E(1)) / stiffness;
    run.weight = weight;
    run.moment = run.flexibility * lower;
    const T f = static_cast<T>(run.flexibility), x = static_cast<T>(cross);
    const T at_lower = static_cast<T>(lower), at_upper = static_cast<T>(weight - lower);
    run.stiffness_error = epsilon<T>() / T(64);
    if (at_lower >= T(0) && at_upper >= T(0) && x >= T(0)) {
        pencil::append_mass(run.transfer, at_lower);
        pencil::append_spring(run.transfer, f, x * f);
        pencil::append_mass(run.transfer, at_upper);
        const bool exact =
            builder.is_short(run) && builder.template is_complete<pencil::Block<T>::degree>(run);
        run.alone = x > T(0) && !exact;
    } else {
        run.alone = true;
    }
    if (run.alone) {
        run.cross = cross;
        // These are roundings in `Wide<T>` if W p + S cancels or lumped masses outweigh the link.
        const T unit = T(4) * operation_error<S>(), reach = T(1) + abs(static_cast<T>(p));
        const T amplified = (abs(at_lower) + static_cast<T>(below)) / static_cast<T>(lower + below);
        const T stretch = T(5) * reach * reach * reach;  // of (y_l - y_u)^2: within either energy
        run.stiffness_error += unit * T(index + 8) * amplified;
        const T turned = std::min(builder.phase(run), T(1) / static_cast<T>(link.gyration_ratio));
        run.mass_error += unit * (T(4) * reach + stretch * turned);
    } else {
        // Longer links are exact, because X = 0. They are not merged.
        if (builder.is_short(run)) builder.note_roundings(run, T(9), builder.second_terms(run));
        builder.template note_truncation<pencil::Block<T>::degree>(run);
    }
    return run;
}

template <class T, class V>
pencil::CondensedRun<T> lane_of(const LaneRuns<V>& runs, std::size_t lane, Index links) {
    using S = Wide<T>;
    pencil::CondensedRun<T> run;
    for (std::size_t i = 0; i < leaf_degree; ++i) {
        run.transfer.a[i] = runs.transfer.a[i][lane];
        run.transfer.c[i] = runs.transfer.c[i][lane];
        run.transfer.d[i] = runs.transfer.d[i][lane];
    }
    for (std::size_t i = 0; i <= leaf_degree; ++i) run.transfer.b[i] = runs.transfer.b[i][lane];
    run.weight = S(runs.weight.high[lane]) + S(runs.weight.low[lane]);
    run.flexibility = S(runs.flexibility.high[lane]) + S(runs.flexibility.low[lane]);
    run.moment = S(runs.moment.high[lane]) + S(runs.moment.low[lane]);
    run.transfer.a[0] = static_cast<T>(run.moment);
    run.transfer.b[0] = static_cast<T>(run.flexibility);
    run.transfer.c[0] = static_cast<T>(run.weight);
    run.links = links;
    run.stiffness_error = T(1.1) * epsilon<T>() / T(2);
    run.mass_error = T(0.1) * epsilon<T>() / T(2);
    return run;
}

/// Condenses four runs. Links may be equal, and short runs need leaves of full degree.
template <class T, class V>
LaneRuns<V> condensed(const LinkColumns<T>& links, Index first, Index length,
                      const CompensatedSum<V>& below) {
    const auto of = [&]<bool equal>() {
        return leaf_terms(length) == 4 ? condense<equal, 4, T, V>(links, first, length, below)
                                       : condense<equal, 3, T, V>(links, first, length, below);
    };
    return links.equal ? of.template operator()<true>() : of.template operator()<false>();
}

}  // namespace detail

/// A chain condensed into blocks for heights above `least_height`, in units of `unit_length`.
template <Real T>
struct CondensedChain {
    pencil::CondensedPencil<T> pencil;
    T unit_length{};
};

/// Returns the chain condensed into blocks. Runs are doubled while they are small beside the
/// wavelength, otherwise halved. Links that fit no run stay alone. Cost O(N), see `condense`.
template <std::floating_point T>
CondensedChain<T> condensed_chain(const Chain<T>& chain, const T& least_height) {
    using namespace detail;
    using V = Pack<T>;
    const LinkColumns<T> links(chain);
    const T unit_length = links.unit_length;
    pencil::CondensedPencilBuilder<T> builder(least_height);
    // This is the phase up to which degree 4 is complete for a uniform run. It is less for the
    // shortest runs, whose roundings move more mass (bounds then stay below 2 ulp).
    const auto reach = [](Index length) { return length < 16 ? T(4e-4) : T(1.6e-3); };
    Wide<T> below(Narrow<Wide<T>>(0));
    const auto add_singles = [&](Index first, Index last) {
        for (Index m = first; m < last; ++m) {
            builder.add(single_link(builder, chain.link(m), m, unit_length, below));
            below = below + Wide<T>(static_cast<Narrow<Wide<T>>>(chain.weight()[m]));
        }
    };
    Index length = 1;
    for (Index m = 0; m < chain.size();) {
        check_interrupt();
        const Index left = chain.size() - m;
        if (left < runs_at_once) {
            add_singles(m, chain.size());
            break;
        }
        while (length * runs_at_once > left) length /= 2;
        Wide<T> above = below;
        const auto hung = weights_below<T, V>(chain, links, m, length, above);
        const auto runs = condensed<T, V>(links, m, length, hung);
        std::array<pencil::CondensedRun<T>, runs_at_once> run;
        bool fits = true;
        T largest(0);
        for (std::size_t lane = 0; lane < pack_size && fits; ++lane) {
            auto& one = run[lane];
            one = lane_of<T>(runs, lane, length);
            const T phase = builder.phase(one);
            largest = std::max(largest, phase);
            if (length == 1) continue;  // lanes of length 1 are not used
            fits = !(runs.worst[lane] > T(0)) && phase < reach(length) &&
                   builder.template is_complete<leaf_degree>(one);
            if (!fits) break;
            const T leaf = runs.leaf_phase[lane] / builder.least_shift();
            if (leaf_terms(length) < leaf_degree) {  // a4 + d4, b1 c3: at most leaf^4/64, doubled
                const T cut = leaf * leaf * leaf / T(31);
                fits = cut <= epsilon<T>() / T(16);
                if (!fits) break;
                one.mass_error += cut;
            }
            const auto roundings = static_cast<T>(coefficient_roundings(leaf_links(length)));
            const T half = epsilon<T>() / T(2);
            builder.note_roundings(one, roundings, {leaf / T(4), leaf / T(4), leaf / T(4)});
            const T moves = static_cast<T>(moment_roundings(leaf_links(length)));
            builder.note_moved_mass(one, moves * half, runs.leaf_moment[lane]);
            if (length > leaf_links(length)) {
                const T moment = static_cast<T>(one.moment);
                const T mass = static_cast<T>(one.weight) * static_cast<T>(one.flexibility);
                const auto merges = static_cast<T>(length / leaf_links(length));
                builder.note_roundings(one, roundings + T(5) * merges, builder.second_terms(one));
                builder.note_moved_mass(one, T(2) * half, moment * moment / mass);
                builder.template note_truncation<leaf_degree>(one);
            }
            fits = builder.is_accurate(one, T(1));  // leaves room for merging
            if (!fits) break;
        }
        if (!fits && length > 1) {
            length /= 2;
            continue;
        }
        if (length == 1) {
            add_singles(m, m + runs_at_once);  // exact
        } else {
            for (const auto& one : run) builder.add(one);
            below = above;
        }
        m += runs_at_once * length;
        if (fits && largest < T(0.2) * reach(2 * length) && m % (2 * runs_at_once * length) == 0)
            length *= 2;
    }
    return {builder.finish(), unit_length};
}

}  // namespace revchain
