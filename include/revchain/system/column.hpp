// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/dispatch.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/product.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A quantity of all links: one number for each link, or a single number stored once for all.
/// Copies share the numbers, which never change.
template <class V>
class Column {
   public:
    Column(V value) : single_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
    Column(std::vector<V> values)
        : count_(values.size()), stride_(1) {  // NOLINT(google-explicit-constructor)
        owned_ = std::make_shared<const std::vector<V>>(std::move(values));
        numbers_ = owned_->data();
    }

    /// A column that refers to the caller's numbers. The caller must not move or change them while
    /// this column, a copy, or a chain made of it is used. For a million links, copying them takes
    /// half as long as computing the ten slowest modes.
    static Column borrowed(const V* numbers, std::size_t count) {
        Column column{V{}};
        column.numbers_ = numbers, column.count_ = count, column.stride_ = 1;
        return column;
    }

    bool is_scalar() const { return stride_ == 0; }
    std::size_t stored() const { return count_; }
    const V* data() const { return is_scalar() ? &single_ : numbers_; }
    const V& operator[](Index m) const { return data()[m * stride_]; }
    friend bool operator==(const Column& x, const Column& y) {
        return x.stride_ == y.stride_ &&
               std::equal(x.data(), x.data() + x.stored(), y.data(), y.data() + y.stored());
    }

   private:
    V single_{};
    std::shared_ptr<const std::vector<V>> owned_;
    const V* numbers_ = nullptr;
    std::size_t count_ = 1;
    Index stride_ = 0;
};

namespace detail {

/// The number of links in a segment. Columns are summed by segments.
inline constexpr Index segment_size = 256;

/// Sum, least number and largest size of some numbers. The sum is not finite if one of the numbers
/// is not.
template <Real T>
struct Summary {
    Wide<T> sum{T(0)};
    T least = std::numeric_limits<T>::infinity();
    T most{};
};

/// The number of lanes summed side by side. Compilers make SIMD code of the loops (0.5 ns a number
/// with SSE2).
inline constexpr std::size_t sum_lanes = 16;

/// Returns the summary of `count` numbers, from 1 number to a whole segment. The relative error of
/// a sum of non-negative numbers is at most 12 operations of `Wide<T>` if that is a double word
/// (measured: 0.27), else 20. For double words the rounding errors of the 20 sums in lanes and tree
/// are added up too. That sum has an error of at most 19 u times 20 u of the sum of sizes.
template <Real T>
Summary<T> summary(const T* x, Index count) {
    constexpr bool compensated = is_double_word<Wide<T>>;
    using S = std::conditional_t<compensated, T, Wide<T>>;
    return simd([&](auto) REVCHAIN_INLINED {
        S sum[sum_lanes]{}, error[sum_lanes]{};  // compilers vectorise plain arrays in one loop
        T least[sum_lanes], most[sum_lanes]{};
        std::fill_n(least, sum_lanes, x[0]);
        const auto take = [&](const T* y, const T* z) REVCHAIN_INLINED {
            for (std::size_t i = 0; i < sum_lanes; ++i) {
                const S s = sum[i] + S(y[i]);
                if constexpr (compensated) {  // two_sum
                    const S v = s - sum[i];
                    error[i] += (sum[i] - (s - v)) + (y[i] - v);
                }
                sum[i] = s;
                least[i] = z[i] < least[i] ? z[i] : least[i];
                const T size = z[i] < T(0) ? -z[i] : z[i];
                most[i] = size > most[i] ? size : most[i];
            }
        };
        const auto lanes = static_cast<Index>(sum_lanes), whole = count - count % lanes;
        for (Index m = 0; m < whole; m += lanes) take(x + m, x + m);
        if (whole < count) {
            T last[sum_lanes]{}, filled[sum_lanes];
            std::fill_n(filled, sum_lanes, x[0]);
            std::copy(x + whole, x + count, last);
            std::copy(x + whole, x + count, filled);
            take(last, filled);
        }
        for (std::size_t half = sum_lanes / 2; half > 0; half /= 2)
            for (std::size_t i = 0; i < half; ++i) {
                const S s = sum[i] + sum[i + half];
                if constexpr (compensated) {
                    const S v = s - sum[i];
                    error[i] += error[i + half] + ((sum[i] - (s - v)) + (sum[i + half] - v));
                }
                sum[i] = s;
            }
        const T lowest = *std::min_element(least, least + sum_lanes);
        const T highest = *std::max_element(most, most + sum_lanes);
        if constexpr (compensated)
            return Summary<T>{two_sum(sum[0], error[0]), lowest, highest};
        else
            return Summary<T>{sum[0], lowest, highest};
    });
}

/// Returns count times x with the error of one operation, whatever the unit of x.
template <Real T>
Wide<T> times(const T& x, Index count) {
    const Wide<T> number(static_cast<Narrow<Wide<T>>>(count));
    return Product<Wide<T>>::of(Wide<T>(x)).times(number).value();
}

/// Returns the summary of a column over `size` links; a single number is multiplied by `size`. If
/// `below` is given, it receives the sum of the numbers below each segment and, last, the sum of
/// all. Their errors are one operation larger.
template <Real T>
Summary<T> summary(const Column<T>& column, Index size, std::vector<Wide<T>>* below = nullptr) {
    using S = Wide<T>;
    if (column.is_scalar())
        return {times(column[0], size), column[0], column[0] < T(0) ? -column[0] : column[0]};
    T least = column[0], most{};
    CompensatedSum<S> sum;
    if (below != nullptr) below->reserve(static_cast<std::size_t>(size / segment_size + 2));
    for (Index m = 0; m < size; m += segment_size) {
        check_interrupt();
        if (below != nullptr) below->push_back(sum.value());
        const Summary<T> segment = summary(column.data() + m, std::min(segment_size, size - m));
        sum.add(segment.sum);
        least = std::min(least, segment.least), most = std::max(most, segment.most);
    }
    if (below != nullptr) below->push_back(sum.value());
    return {sum.value(), least, most};
}

}  // namespace detail
}  // namespace revchain
