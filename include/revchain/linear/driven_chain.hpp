// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/assembly.hpp"
#include "revchain/linear/rig_elements.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/forced/lanes.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

using pencil::Driving;

/// A chain or rig as the elements from its free end to the moved end.
struct DrivenChain {
    pencil::SignedPencil<Wide<double>> pencil;  ///< the stiffness L is height k + spin s of a drive
    ChainUnits units;
    bool turning = false;  ///< true if a stiffness depends on the speed
    Index standing = 0;    ///< number of standing elements: their negative pivots are no modes
    Index idle = 0;        ///< number of omitted lowest links: without weight, spin and inertia
    double end = 1;        ///< 1 if the moved end is a pin, 0 if it is the far end of a spring
};

inline const Chain<double>& base_chain(const Chain<double>& chain) { return chain; }
inline const Chain<double>& base_chain(const Rig& rig) { return rig.chain(); }
REVCHAIN_LAZY
bool tells_senses_apart(const Chain<double>&) { return false; }
REVCHAIN_LAZY
bool tells_senses_apart(const Rig& rig) { return rig.has_momentum(); }

REVCHAIN_LAZY
DrivenChain driven_chain(const Chain<double>& chain) {
    const AssembledChain<double> assembled = assemble(chain);
    const auto& pencil = assembled.pencil;
    DrivenChain result{{}, assembled.units};
    result.pencil.units = pencil.units;
    for (const auto& e : pencil.elements)
        result.pencil.elements.push_back(
            with_errors(e, pencil.entry_error, pencil.stiffness_underflow));
    return result;
}

REVCHAIN_LAZY
DrivenChain driven_chain(const Rig& rig) {
    require_no_pins("response", "the response", rig);
    DrivenChain result{{}, rig.chain().units(), rig.has_momentum()};
    auto& elements = result.pencil.elements;
    Index m = 0;
    for (const RigLink& link : rig_links(rig)) {
        const bool stands = rig.stands(m++);
        const RigElement element = rig_element(link, stands);
        if (elements.empty() && is_nothing(element)) {
            ++result.idle;
            continue;
        }
        elements.push_back(element);
        if (stands) ++result.standing;
    }
    if (const auto support = support_element(rig.support(), result.units)) {
        elements.push_back(*support);
        result.end = 0;
    }
    return result;
}

/// Does `driven_lanes` for any number of drives, with sharper bounds if its own are not negligible.
/// Calls `put(row, which, offset)` and then `take(row, found)` for each drive, on several threads.
/// `can_turn` says if links may have spin, as in rigs; without spin half as much is compiled.
template <bool can_turn, class Put, class Take>
void driven_by_lanes(const DrivenChain& chain, const std::vector<Driving>& at,
                     const pencil::DrivenPins& pins, const Put& put, const Take& take,
                     Progress* progress) {
    parallel_for(at.size(), pencil::most_driven_together, [&](std::size_t begin, std::size_t end) {
        simd([&](auto registers) REVCHAIN_INLINED {
            // AVX2 has 16 registers. Four lanes need more, and take twice the time of two lanes.
            using V = Pack<double, registers.bytes == 32 ? 2 : registers.doubles>;
            constexpr bool fused = registers.fused;
            constexpr std::size_t together = pencil::driven_together<V>;
            std::vector<double> scratch;
            Driving padded[together];
            pencil::Driven found[together];
            const auto& elements = chain.pencil.elements;
            pencil::DrivenPins wanted = pins;
            for (std::size_t i = begin; i < end; i += together) {
                const std::size_t taken = std::min(together, end - i);
                for (std::size_t j = 0; j < together; ++j) padded[j] = at[i + (j < taken ? j : 0)];
                const auto offset = [&](std::size_t lane, std::size_t which, const Wide<double>& y)
                                        REVCHAIN_INLINED {
                                            if (lane < taken)
                                                put(static_cast<Index>(i + lane), which, y);
                                        };
                const auto solve = [&]<bool turning>(std::bool_constant<turning>) REVCHAIN_INLINED {
                    pencil::driven_lanes<turning, fused, V>(elements, padded, wanted, found,
                                                            offset);
                    const bool sharp =
                        std::all_of(found, found + taken, [](const pencil::Driven& each) {
                            return !each.decided || each.error_bound <= 0x1p-56;
                        });
                    if (!sharp)
                        pencil::sharpen<turning, fused, V>(elements, padded, found, scratch,
                                                           chain.end);
                };
                if (!can_turn || !chain.turning)
                    solve(std::false_type{});
                else if constexpr (can_turn)
                    solve(std::true_type{});
                for (std::size_t j = 0; j < taken; ++j) take(static_cast<Index>(i + j), found[j]);
                advance(progress, static_cast<double>(i + taken) / static_cast<double>(at.size()));
            }
        });
    });
}

}  // namespace revchain::detail
