// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain/chain.hpp"

namespace revchain {

namespace detail {

/// One or two words as another scalar: rounded, or exact where there is room.
template <class To, class From>
To from_words(const From& x) {
    if constexpr (std::is_same_v<To, From>) {
        return x;
    } else if constexpr (is_double_word<From> && std::floating_point<To>) {
        return static_cast<To>(x.high);
    } else if constexpr (is_double_word<From> && is_double_word<To>) {
        return two_sum(static_cast<Narrow<To>>(x.high), static_cast<Narrow<To>>(x.low));
    } else {
        return To(x);
    }
}

template <class To, class From>
Column<To> converted(const Column<From>& column) {
    if (column.is_scalar()) return Column<To>(from_words<To>(column[0]));
    std::vector<To> values;
    values.reserve(column.stored());
    for (std::size_t m = 0; m < column.stored(); ++m) values.push_back(from_words<To>(column.data()[m]));
    return values;
}

}  // namespace detail

/// The chain whose numbers are those of `chain` in another scalar: the same where it is wider, else rounded. Cost O(N).
/// Throws InvalidArgument where rounding leaves no chain, or one with fewer modes.
template <Real To, Real From>
Chain<To> converted(const Chain<From>& chain) {
    Chain<To> result(chain.size(), detail::converted<To>(chain.weight()), detail::converted<To>(chain.length()),
                     detail::converted<To>(chain.centroid()), detail::converted<Wide<To>>(chain.gyration_ratio()));
    if (result.mode_count() != chain.mode_count())
        detail::refuse("Chain",
                       "weights underflow in this precision and leave fewer modes than " +
                           std::to_string(chain.mode_count()) + "; use a wider precision or a smaller unit of weight",
                       result.mode_count());
    return result;
}

}  // namespace revchain
