// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <type_traits>

#include "revchain/numeric/scalar.hpp"
#include "revchain/simd/pack.hpp"

/// This header has the steps from link to link for all eigenvalues of small pencils of lumped
/// links, four to a pack. The walks of quotient.hpp cut long chains into legs and use the heap. All
/// modes of 10 plummets take 0.7 microseconds here and 19 there, of 40 11 and 44, of 100 49 and
/// 134.
namespace revchain::inline REVCHAIN_BUILD::pencil::aberth {

/// The largest number of links of a chain; its numbers are on the stack.
inline constexpr std::size_t most_links = 128;
/// The number of links between two checks of sizes and sums.
inline constexpr std::size_t leg = 16;

/// Bounds on the relative rounding errors in `LumpedLinks`, in units of u = 2^-53.
struct Roundings {
    double energies = 0;  ///< y^T M y and y^T K y together
    double mass = 0;      ///< lumped masses
    double drop = 0;      ///< a computed force over k + mu X, with its division and product
    double centroid = 0;  ///< in y^T M y, of centroids that are not in the middle
};

/// A chain as lumped masses at the pins, springs between them, and the mass -X on the difference of
/// a link's two offsets (see `spectrum::LumpedLink`), rounded as `roundings` says.
struct LumpedLinks {
    using Numbers = std::array<double, most_links>;
    std::size_t size = 0;
    bool rigid = false;      ///< true if `cross_ratio` ... `turn` are set; else X = 0
    Numbers mass;            ///< of the lower pin of link m
    Numbers stiffness;       ///< k
    Numbers flexibility;     ///< 1/k
    Numbers cross_ratio;     ///< X/k >= 0
    Numbers weight;          ///< W
    Numbers lower_share;     ///< h/a: the share of the lower pin's offset in the centroid's
    Numbers upper_share;     ///< 1 - h/a
    Numbers turn;            ///< W rho^2/a^2
    double least_shift = 0;  ///< all eigenvalues mu = 1/lambda lie from here to `greatest_shift`
    double greatest_shift = 0;
    Roundings roundings;
};

using Four = Pack<double>;

/// The number of packs walked side by side: they share loads, and one runs while another waits.
inline constexpr std::size_t packs_at_once = 3;
/// True if there is also code for one and two packs, and for chains of one leg. It is 20 to 40 %
/// faster up to 16 links (10 plummets: 0.86 us, else 1.05), but compiles six times as much. So only
/// builds that choose the instruction set at run time have it, and not for the oldest processors.
template <class Registers>
inline constexpr bool any_packs =
#if defined(REVCHAIN_DISPATCH)
    (Registers::bytes > 16);
#else
    false;
#endif

/// Returns the number of shifts computed for `count` shifts, which fills whole packs.
template <bool several>
constexpr std::size_t walked(std::size_t count) {
    constexpr std::size_t together = several ? 4 : 4 * packs_at_once;
    return (count + together - 1) / together * together;
}
inline constexpr std::size_t most_walked = walked<false>(most_links);

/// Calls f(P packs, first lane) for all packs.
template <bool several, class F>
[[gnu::always_inline]] inline void for_packs(std::size_t count, const F& f) {
    std::size_t i = 0;
    if constexpr (several) {
        for (; i + 8 < count; i += 12) f(std::integral_constant<std::size_t, 3>(), i);
        if (i + 4 < count)
            f(std::integral_constant<std::size_t, 2>(), i);
        else if (i < count)
            f(std::integral_constant<std::size_t, 1>(), i);
    } else {
        for (; i < count; i += 4 * packs_at_once)
            f(std::integral_constant<std::size_t, packs_at_once>(), i);
    }
}

/// The offset at the support, with free end at 1, without division: a polynomial in mu with zeros
/// at eigenvalues.
template <bool rigid>
struct Offset {
    Four value{1.0}, force{0.0};

    [[gnu::always_inline]] void rise(const LumpedLinks& links, std::size_t m, const Four& mu) {
        force += (Four(links.mass[m]) * mu) * value;
        if constexpr (rigid) {
            const Four stretch = Four(1.0) + mu * Four(links.cross_ratio[m]);
            value = stretch * value - Four(links.flexibility[m]) * force;
            force = stretch * force;
        } else {
            value -= Four(links.flexibility[m]) * force;
        }
    }
};

template <bool rigid>
struct OffsetAndSlope {
    Four value{1.0}, force{0.0}, slope{0.0}, force_slope{0.0};

    [[gnu::always_inline]] void rise(const LumpedLinks& links, std::size_t m, const Four& mu) {
        const Four mass(links.mass[m]), flexibility(links.flexibility[m]), pull = mass * mu;
        force += pull * value;
        force_slope = (force_slope + mass * value) + pull * slope;  // `slope` is ready last
        if constexpr (rigid) {
            const Four cross_ratio(links.cross_ratio[m]), stretch = Four(1.0) + mu * cross_ratio;
            slope = (stretch * slope + cross_ratio * value) - flexibility * force_slope;
            value = stretch * value - flexibility * force;
            force_slope = stretch * force_slope + cross_ratio * force;
            force = stretch * force;
        } else {
            slope -= flexibility * force_slope;
            value -= flexibility * force;
        }
    }
};

/// A vector from one end, link by link: offset y, spring force G of the next link, mu y^T M y and
/// y^T K y so far. The sums belong to the stored offsets and their differences, however rounded.
template <bool rigid, bool tall>
struct Walk {
    Four offset{0.0}, force{0.0}, inertia{0.0}, stiffness{0.0}, earlier_inertia{0.0},
        earlier_stiffness{0.0};

    [[gnu::always_inline]] Four all_inertia() const {
        return tall ? inertia + earlier_inertia : inertia;
    }
    [[gnu::always_inline]] Four all_stiffness() const {
        return tall ? stiffness + earlier_stiffness : stiffness;
    }

    [[gnu::always_inline]] void pass_pin(const LumpedLinks& links, std::size_t m, const Four& mu,
                                         bool up) {
        const Four pull = Four(links.mass[m]) * (mu * offset);
        force = up ? force + pull : force - pull;
        if constexpr (!rigid) inertia += pull * offset;
    }
    /// Passes a link; `yield` is 1/(k + mu X).
    [[gnu::always_inline]] void pass_link(const LumpedLinks& links, std::size_t m,
                                          const Four& yield, bool up) {
        const Four before = offset;
        Four d = yield * force;
        offset = up ? before - d : before + d;
        d = up ? before - offset : offset - before;
        const Four square = d * d;
        stiffness += Four(links.stiffness[m]) * square;
        if constexpr (rigid) {
            const Four lower(links.lower_share[m]), upper(links.upper_share[m]);
            const Four centroid = lower * (up ? before : offset) + upper * (up ? offset : before);
            inertia += Four(links.weight[m]) * (centroid * centroid) + Four(links.turn[m]) * square;
        }
    }
    /// Adds up the sums of a leg, and scales the larger number to 1 ... 2 by a power of two.
    [[gnu::always_inline]] void tidy() {
        earlier_inertia += inertia;
        earlier_stiffness += stiffness;
        inertia = stiffness = Four(0.0);
        const Four by = inverse_power(max(abs(offset), abs(force)));
        offset = offset * by;
        force = force * by;
        earlier_inertia = (earlier_inertia * by) * by;  // by * by may overflow or underflow
        earlier_stiffness = (earlier_stiffness * by) * by;
    }
};

/// The results of a twisted vector at a shift mu.
struct Quotients {
    Four ratio;   ///< Rayleigh quotient times mu: 1 at an eigenvalue
    Four square;  ///< squared residual in the norm of K^-1 over that of K, without rounding errors
    Four energy;  ///< y^T K y
    Four scale;   ///< the smaller of the two factors that joined the energies of the walks
};

/// Returns, for some packs of shifts, the quotients of vectors from both ends, joined at the pin
/// where the residual is least. `flexibility_above[t]` is the sum of 1/k from link t up.
template <bool rigid, bool tall, std::size_t P>
[[gnu::always_inline]] inline std::array<Quotients, P> quotients(const LumpedLinks& links,
                                                                 const double* flexibility_above,
                                                                 const std::array<Four, P>& mu) {
    constexpr std::size_t kept = rigid ? 5 : 4;
    alignas(Four) std::byte memory[kept * P * most_links * sizeof(Four)];  // not initialised
    Four* const at_pins = reinterpret_cast<Four*>(memory);
    std::array<Walk<rigid, tall>, P> walk;
#pragma GCC unroll 3
    for (std::size_t p = 0; p < P; ++p) walk[p].offset = Four(1.0);
    for (std::size_t m = 0; m < links.size; ++m) {
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) {
            Walk<rigid, tall>& up = walk[p];
            Four* const here = at_pins + kept * (P * m + p);
            up.pass_pin(links, m, mu[p], true);
            here[0] = up.offset;
            here[1] = up.force;
            here[2] = up.all_inertia();
            here[3] = up.all_stiffness();
            Four yield(links.flexibility[m]);
            if constexpr (rigid)
                here[4] = yield = yield / (Four(1.0) + mu[p] * Four(links.cross_ratio[m]));
            up.pass_link(links, m, yield, true);
            if (tall && m % leg == leg - 1) up.tidy();
        }
    }
    std::array<Quotients, P> best;
#pragma GCC unroll 3
    for (std::size_t p = 0; p < P; ++p) {
        walk[p] = {};
        walk[p].force = Four(1.0);
        best[p] = {Four(0.0), Four(1.0), Four(0.0), Four(0.0)};
    }
    for (std::size_t m = links.size; m-- > 0;) {
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) {
            Walk<rigid, tall>& down = walk[p];
            Quotients& joined = best[p];
            const Four* const here = at_pins + kept * (P * m + p);
            down.pass_link(links, m, rigid ? here[kept - 1] : Four(links.flexibility[m]), false);
            // Each vector is scaled by the other's offset, so that they meet.
            const Four scale_up = down.offset * down.offset, scale_down = here[0] * here[0];
            const Four gap = here[1] * down.offset - down.force * here[0];
            const Four energy = here[3] * scale_up + down.all_stiffness() * scale_down;
            const Four inertia = here[2] * scale_up + down.all_inertia() * scale_down;
            const Four square = gap * gap * Four(flexibility_above[m]);
            const Four other = joined.square * energy,
                       own = square * joined.energy;  // comparisons with NaN are false
            joined.ratio = if_less(own, other, inertia, joined.ratio);
            joined.square = if_less(own, other, square, joined.square);
            joined.energy = if_less(own, other, energy, joined.energy);
            joined.scale = if_less(own, other, min(scale_up, scale_down), joined.scale);
            down.pass_pin(links, m, mu[p], false);
            if (tall && m % leg == 0) down.tidy();
        }
    }
#pragma GCC unroll 3
    for (std::size_t p = 0; p < P; ++p) {
        const Four inertia = rigid ? mu[p] * best[p].ratio : best[p].ratio;
        best[p] = {inertia / best[p].energy, best[p].square / best[p].energy, best[p].energy,
                   best[p].scale};
    }
    return best;
}

}  // namespace revchain::pencil::aberth
