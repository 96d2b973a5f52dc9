// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The size of SIMD registers, and whether products may be fused with sums.
template <std::size_t Bytes, bool Fused>
struct Registers {
    static constexpr bool fused = Fused;
    static constexpr std::size_t bytes = Bytes;
    static constexpr std::size_t doubles = Bytes / sizeof(double);
};

/// The number of doubles in the largest registers. Every multiple fills registers of each size.
inline constexpr std::size_t most_doubles = 8;

namespace detail {

#if defined(__FP_FAST_FMA) || defined(__FMA__)
inline constexpr bool own_fused = true;
#else
inline constexpr bool own_fused = false;
#endif
#if defined(__AVX512F__)
using OwnRegisters = Registers<64, own_fused>;
#elif defined(__AVX__)
using OwnRegisters = Registers<32, own_fused>;
#else
using OwnRegisters = Registers<16, own_fused>;
#endif

/// The number of lanes of long recursions: two registers, or one of AVX-512. More than two
/// registers spill, which takes 1.2 times as long with SSE2, and twice the code.
#if defined(REVCHAIN_SEVERAL_TARGETS)
inline constexpr std::size_t lanes_at_once = most_doubles;
#else
inline constexpr std::size_t lanes_at_once =
    OwnRegisters::doubles == most_doubles ? most_doubles : 2 * OwnRegisters::doubles;
#endif

template <class F>
auto for_own(const F& f) {
    return f(OwnRegisters{});
}

#if defined(REVCHAIN_SEVERAL_TARGETS)
template <class F>
[[gnu::flatten, gnu::target("avx2,fma")]] auto for_avx2(const F& f) {
    return f(Registers<32, true>{});
}
template <class F>
[[gnu::flatten, gnu::target("avx2,fma,avx512f,avx512dq,avx512vl")]] auto for_avx512(const F& f) {
    return f(Registers<64, true>{});
}
enum class Processor { basic, avx2, avx512 };
inline Processor processor() {
    static const Processor found = [] {
        if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
            return Processor::basic;
        const bool large = __builtin_cpu_supports("avx512f") &&
                           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
        return large ? Processor::avx512 : Processor::avx2;
    }();
    return found;
}
#endif

}  // namespace detail

/// Returns f(Registers<...>{}), compiled for the instruction set of the compiler's flags. With
/// REVCHAIN_DISPATCH it is compiled for SSE2, AVX2 and AVX-512, and the best is chosen at run time.
/// A portable build is then a few per cent slower than one for the machine, and compiles in twice
/// the time. The Python module and revchain::compiled are built that way. Another kind of processor
/// may change last digits (products and sums are fused where the compiler may do so). f and all
/// functions it calls that handle packs must be always_inline. Other functions remain code for the
/// oldest processor, and packs must not be passed to them by value.
template <class F>
auto simd(const F& f) {
#if defined(REVCHAIN_SEVERAL_TARGETS)
    const detail::Processor found = detail::processor();
    if (found == detail::Processor::avx512) return detail::for_avx512(f);
    if (found == detail::Processor::avx2) return detail::for_avx2(f);
#endif
    return detail::for_own(f);
}

}  // namespace revchain
