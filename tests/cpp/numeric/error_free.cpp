// SPDX-License-Identifier: MPL-2.0
// Error-free transformations against whole numbers, inside a function compiled for each kind of processor at hand. GCC
// fuses products with sums there. Every input is a whole number of 128 bits at most, so each check is exact.
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/interval.hpp"
#include "revchain/simd/pack.hpp"
#include "support/catch.hpp"

using revchain::DoubleWord;
using revchain::Pack;

namespace {

__extension__ using Whole = __int128;

/// Three numbers with all their digits, and a product that was rounded in memory.
template <class T>
struct Case {
    T a, b, c;
    T ab;  ///< a b, rounded
};

template <class T>
std::vector<Case<T>> cases(std::size_t count) {
    std::mt19937_64 random(7);
    constexpr int digits = std::numeric_limits<T>::digits;
    // so many random digits, or a few ones: powers of two and halves that round up
    const auto number = [&](int wanted) {
        std::uint64_t bits = random();
        if (random() % 4 == 0) bits |= random();
        if (random() % 4 == 0) bits &= random() & random();
        const T x = static_cast<T>(bits >> (64 - wanted) | 1);
        return random() % 2 ? x : -x;
    };
    std::vector<Case<T>> all(count);
    for (Case<T>& one : all) {
        one.a = number(digits), one.b = number(std::min(digits, 61));  // 2 a b has to fit
        one.c = std::ldexp(number(digits), static_cast<int>(random() % 61));
        volatile T product = one.a * one.b;
        one.ab = product;
    }
    return all;
}

template <class T>
Whole whole(T x) {
    return static_cast<Whole>(x);
}

/// `size` numbers of T side by side: a number, or a pack.
template <class V>
[[gnu::always_inline]] inline V gathered(const Case<revchain::Lane<V>>* from,
                                         revchain::Lane<V> Case<revchain::Lane<V>>::*which) {
    if constexpr (revchain::IsPack<V>) {
        V x;
        for (std::size_t i = 0; i < V::size; ++i) x.set(i, from[i].*which);
        return x;
    } else {
        return from->*which;
    }
}
template <class V>
[[gnu::always_inline]] inline revchain::Lane<V> lane(const V& x, [[maybe_unused]] std::size_t i) {
    if constexpr (revchain::IsPack<V>)
        return x[i];
    else
        return x;
}

/// How many results differ from whole numbers.
template <class V, bool fused>
[[gnu::always_inline]] inline int wrong_transformations(const std::vector<Case<revchain::Lane<V>>>& all) {
    using T = revchain::Lane<V>;
    using C = Case<T>;
    using revchain::two_sum, revchain::fast_two_sum, revchain::two_product;
    std::size_t size = 1;
    if constexpr (revchain::IsPack<V>) size = V::size;
    int wrong = 0;
    for (std::size_t begin = 0; begin + size <= all.size(); begin += size) {
        const V a = gathered<V>(&all[begin], &C::a), b = gathered<V>(&all[begin], &C::b);
        const V c = gathered<V>(&all[begin], &C::c);
        const DoubleWord<V> product = two_product(a, b), chosen = two_product<fused>(a, b);
        const DoubleWord<V> sum = two_sum(a, c), of_product = two_sum(a * b, c), on_product = two_sum(c, a * b);
        const DoubleWord<V> difference = two_sum(a * b, -(b * a)), doubled = two_sum(a * b, a * b);
        const DoubleWord<V> ordered = fast_two_sum(a * b, a);
        revchain::CompensatedSum<V> total, products;
        total.add(a), total.add(c), total.add(b);
        products.add(a * b), products.add(c), products.add(-(a * b));
        for (std::size_t i = 0; i < size; ++i) {
            const C& one = all[begin + i];
            const Whole x = whole(one.a), y = whole(one.b), z = whole(one.c), xy = whole(one.ab);
            const auto exact = [&](const DoubleWord<V>& got, Whole want) REVCHAIN_INLINED {
                return whole(lane(got.high, i)) + whole(lane(got.low, i)) == want;
            };
            wrong += !exact(product, x * y) + !exact(chosen, x * y);
            wrong += !(lane(product.high, i) == one.ab) + !(lane(chosen.high, i) == one.ab);
            wrong += !exact(sum, x + z) + !exact(of_product, xy + z) + !exact(on_product, xy + z);
            wrong += !exact(difference, 0) + !exact(doubled, 2 * xy) + !exact(ordered, xy + x);
            wrong += !exact({total.high, total.low}, x + y + z) + !exact({products.high, products.low}, z);
        }
    }
    return wrong;
}

/// How many results in double words are off by more than their theorems say, and how many intervals miss.
template <class V>
[[gnu::always_inline]] inline int wrong_words(const std::vector<Case<double>>& all) {
    using C = Case<double>;
    std::size_t size = 1;
    if constexpr (revchain::IsPack<V>) size = V::size;
    int wrong = 0;
    for (std::size_t begin = 0; begin + size <= all.size(); begin += size) {
        const V a = gathered<V>(&all[begin], &C::a), b = gathered<V>(&all[begin], &C::b);
        // 63 bits: the first word of 53, the second of 9
        V low;
        const auto rest = [&](std::size_t i) { return std::ldexp(all[begin + i].b, -44); };
        if constexpr (revchain::IsPack<V>)
            for (std::size_t i = 0; i < size; ++i) low.set(i, std::rint(rest(i)));
        else
            low = std::rint(rest(0));
        const V thousand(1024.0);
        const DoubleWord<V> x = revchain::fast_two_sum(a * thousand, low),
                            y = revchain::fast_two_sum(b * thousand, -low);
        const DoubleWord<V> product = x * y, scaled = x * b, sum = x + y, difference = x - y, more = x + a * b;
        for (std::size_t i = 0; i < size; ++i) {
            const auto value = [&](const DoubleWord<V>& w)
                                   REVCHAIN_INLINED { return whole(lane(w.high, i)) + whole(lane(w.low, i)); };
            const auto off = [&](const DoubleWord<V>& got, Whole want, int bound) REVCHAIN_INLINED {
                const Whole error = value(got) - want, size_of_want = want < 0 ? -want : want;
                // u^2 = 2^-106; one more for what the cast to a whole number cuts off
                return (error < 0 ? -error : error) > bound * (size_of_want >> 106) + bound + 1;
            };
            wrong += off(product, value(x) * value(y), 5) + off(scaled, value(x) * whole(lane(b, i)), 5);
            wrong += off(sum, value(x) + value(y), 3) + off(difference, value(x) - value(y), 3);
            wrong += off(more, value(x) + whole(all[begin + i].ab), 3);
        }
        using Interval = revchain::Interval<double>;
        for (std::size_t i = 0; i < size; ++i) {
            const C& one = all[begin + i];
            const auto holds = [](const Interval& z, Whole want) {
                return whole(std::floor(z.low)) <= want && want <= whole(std::ceil(z.high));
            };
            const Interval p(one.a), q(one.b);
            wrong += !holds(p * q, whole(one.a) * whole(one.b));
            wrong += !holds(p * q + p, whole(one.a) * whole(one.b) + whole(one.a));
            wrong += !holds(p * q - q * q, whole(one.a) * whole(one.b) - whole(one.b) * whole(one.b));
            wrong += !holds(square(p - q), (whole(one.a) - whole(one.b)) * (whole(one.a) - whole(one.b)));
        }
    }
    return wrong;
}

/// `f(registers)`, compiled for each kind of processor, on those that this one can stand in for.
template <class F>
void in_each_kind(const F& f) {
    {
        INFO("registers of this program");
        CHECK(revchain::detail::for_own(f) == 0);
    }
#if defined(REVCHAIN_SEVERAL_TARGETS)
    const auto processor = revchain::detail::processor();
    if (processor != revchain::detail::Processor::basic) {
        INFO("avx2, fma");
        CHECK(revchain::detail::for_avx2(f) == 0);
    }
    if (processor == revchain::detail::Processor::avx512) {
        INFO("avx512");
        CHECK(revchain::detail::for_avx512(f) == 0);
    }
#endif
}

template <class T>
void check_numbers() {
    const auto all = cases<T>(400'000);
    in_each_kind([&](auto registers) REVCHAIN_INLINED {
        return wrong_transformations < T, std::floating_point<T> && registers.fused && sizeof(T) <= 8 > (all);
    });
}

}  // namespace

TEST_CASE("error-free transformations of numbers are exact in every target", "[core]") {
    check_numbers<float>();
    check_numbers<double>();
    check_numbers<long double>();
}

TEST_CASE("error-free transformations of packs are exact in every target", "[core]") {
    const auto all = cases<double>(400'000);
    in_each_kind([&](auto registers) REVCHAIN_INLINED {
        return wrong_transformations<Pack<double, registers.doubles>, registers.fused>(all);
    });
    in_each_kind([&](auto registers) REVCHAIN_INLINED {
        return wrong_transformations<Pack<double, registers.doubles, 2>, registers.fused>(all);
    });
    const auto few = cases<float>(400'000);
    in_each_kind([&](auto registers) REVCHAIN_INLINED {
        return wrong_transformations<Pack<float, 2 * registers.doubles>, registers.fused>(few);
    });
}

TEST_CASE("double words and intervals keep their bounds in every target", "[core]") {
    const auto all = cases<double>(200'000);
    in_each_kind([&](auto) REVCHAIN_INLINED { return wrong_words<double>(all); });
    in_each_kind([&](auto registers) REVCHAIN_INLINED { return wrong_words<Pack<double, registers.doubles>>(all); });
}
