// SPDX-License-Identifier: MPL-2.0
// Packs against plain numbers, number by number and bit by bit, in the registers of every kind of processor at hand.
#include "revchain/simd/pack.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "support/catch.hpp"

using revchain::Pack;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Numbers of all sizes, both signs, zeros, infinities, NaN.
template <class T>
std::vector<T> numbers() {
    std::vector<T> all{T(0), T(-0.0), T(1), T(-1), T(1.5), T(-2.75), T(1) / T(3), T(nan), T(infinity), T(-infinity)};
    for (const int e : {std::numeric_limits<T>::min_exponent - 3, -30, -1, 2, 17, std::numeric_limits<T>::max_exponent})
        for (const T x : {T(0.5), T(-0.7)}) all.push_back(std::ldexp(x, e));
    return all;
}

template <class T>
bool same(T x, T y) {
    return std::memcmp(&x, &y, sizeof(T)) == 0 || (std::isnan(x) && std::isnan(y));
}

/// Of all pairs of numbers, `V::size` at a time: how often a pack and a number disagree.
template <class V>
[[gnu::always_inline]] inline int disagreements() {
    using T = revchain::Lane<V>;
    using std::abs, std::max;
    const auto all = numbers<T>();
    int wrong = 0;
    for (std::size_t begin = 0; begin < all.size() * all.size(); begin += V::size) {
        std::vector<T> a(V::size), b(V::size), stored(V::size);
        for (std::size_t i = 0; i < V::size; ++i) {
            const std::size_t pair = std::min(begin + i, all.size() * all.size() - 1);
            a[i] = all[pair / all.size()], b[i] = all[pair % all.size()];
        }
        const V x = V::load(a.data());
        V y;
        for (std::size_t i = 0; i < V::size; ++i) y.set(i, b[i]);
        const V sum = x + y, difference = x - y, product = x * y, quotient = x / y, minus = -x;
        V added = x, taken = x, times = x;
        added += y, taken -= y, times *= y;
        const V less = if_less(x, y, V(T(2)), minus), same_as = if_equal(x, y, V(T(2)), minus);
        const V size = abs(x), larger = max(x, y), smaller = min(x, y), half = upper_half(x);
        const auto below = x < y;
        const auto above = x > y;
        const auto alike = equal(x, y), differ = differ_in_sign(x, y);
        auto count = differ + differ;
        count += differ;
        const auto more = count > typename V::Mask(2), three = count == typename V::Mask(3);
        const auto either = below | above, neither = ~either, back = bits(y) - bits(x);
        const bool some = any(below), none = any(below & above);
        x.store(stored.data());
        bool expected = false;
        for (std::size_t i = 0; i < V::size; ++i) {
            const T p = a[i], q = b[i];
            const bool change = std::signbit(p) != std::signbit(q);
            wrong += !same(stored[i], p) + !same(sum[i], p + q) + !same(difference[i], p - q);
            wrong += !same(product[i], p * q) + !same(quotient[i], p / q) + !same(minus[i], -p);
            wrong += !same(added[i], p + q) + !same(taken[i], p - q) + !same(times[i], p * q);
            wrong += !same(less[i], p < q ? T(2) : -p) + !same(same_as[i], p == q ? T(2) : -p);
            wrong += !same(size[i], abs(p)) + !same(larger[i], q < p ? p : q) + !same(smaller[i], p < q ? p : q);
            wrong += (below[i] != -(p < q)) + (above[i] != -(p > q)) + (alike[i] != -(p == q));
            wrong += (differ[i] != change) + (more[i] != -change) + (three[i] != -change);
            wrong += (either[i] != -(p < q || p > q)) + (neither[i] != -!(p < q || p > q));
            if (!change)
                wrong +=
                    (back[i] < 0) != (std::bit_cast<typename V::Integer>(q) < std::bit_cast<typename V::Integer>(p));
            if (std::isfinite(p)) {
                const T rest = p - half[i];  // as many bits as are cut off, so that products of halves are exact
                wrong += !same(half[i], revchain::upper_half(p)) + !(abs(rest) * 2 <= abs(p)) + (half[i] + rest != p);
                wrong += std::isnormal(p) && half[i] * half[i] != 0 && std::isfinite(p * p) &&
                         std::fma(half[i], half[i], -(half[i] * half[i])) != 0;
            }
            expected = expected || p < q;
        }
        wrong += some != expected;
        wrong += none;
        V positive;
        for (std::size_t i = 0; i < V::size; ++i) positive.set(i, std::isnormal(a[i]) ? abs(a[i]) : T(1));
        const auto e = exponent(positive);
        const V inverse = inverse_power(positive);
        for (std::size_t i = 0; i < V::size; ++i) {
            const int sure = std::ilogb(positive[i]);
            wrong += e[i] != sure;
            if (sure < std::numeric_limits<T>::max_exponent - 1) wrong += inverse[i] != std::ldexp(T(1), -sure);
        }
    }
    return wrong;
}

}  // namespace

TEST_CASE("packs do to each number what is done to a number") {
    CHECK(disagreements<Pack<double>>() == 0);
    CHECK(disagreements<Pack<float>>() == 0);
    CHECK(disagreements<Pack<double, 2>>() == 0);
#if !defined(REVCHAIN_MASK_INSTRUCTIONS)  // else where the processor has such registers: the next test
    CHECK(disagreements<Pack<double, 8>>() == 0);
#endif
    CHECK(disagreements<Pack<double, 2, 4>>() == 0);
    CHECK(disagreements<Pack<double, 4, 4>>() == 0);
    CHECK(disagreements<Pack<float, 8, 2>>() == 0);
    const Pack<double> four(1.0, 2.0, 3.0, 4.0);
    for (std::size_t i = 0; i < 4; ++i) CHECK(four[i] == static_cast<double>(i + 1));
}

TEST_CASE("packs in the registers of this processor, once") {
    int calls = 0, wrong = 0;
    std::size_t bytes = 0;
    revchain::simd([&](auto registers) REVCHAIN_INLINED {
        ++calls;
        bytes = registers.bytes;
        wrong += disagreements<Pack<double, registers.doubles>>();
        wrong += disagreements<Pack<double, registers.doubles, 4>>();
    });
    CHECK(calls == 1);
    CHECK(wrong == 0);
    CHECK(std::set<std::size_t>{16, 32, 64}.count(bytes) == 1);
#if defined(REVCHAIN_SEVERAL_TARGETS) || defined(__AVX2__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) CHECK(bytes >= 32);
#endif
}

TEST_CASE("masks wrap, as bits do") {
    using Mask = Pack<double>::Mask;
    const Mask least(std::numeric_limits<std::int64_t>::min());
    CHECK((Mask(0) - least)[0] == std::numeric_limits<std::int64_t>::min());
    CHECK((least + least)[3] == 0);
    CHECK((Mask(5) - Mask(7))[1] == -2);
}
