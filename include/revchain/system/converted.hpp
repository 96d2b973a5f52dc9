// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Converts a number of one or two words to another scalar, rounded if that is narrower.
template <class To, class From>
To from_words(const From& x) {
    if constexpr (is_double_word<From> && is_double_word<To>)
        return two_sum(static_cast<Narrow<To>>(x.high), static_cast<Narrow<To>>(x.low));
    else if constexpr (is_double_word<From> && std::floating_point<To>)
        return static_cast<To>(x.high);
    else
        return To(x);
}

/// Converts a column to another scalar. Throws InvalidArgument if a non-zero number becomes 0 or a
/// finite number becomes infinite.
template <class To, class From>
Column<To> converted(std::string_view name, const Column<From>& column) {
    using std::isfinite;
    std::vector<To> values;
    values.reserve(column.stored());
    for (std::size_t m = 0; m < column.stored(); ++m) {
        const From& x = column.data()[m];
        values.push_back(from_words<To>(x));
        if ((values.back() == To(0)) != (x == From(0)) || !isfinite(values.back()))
            throw_invalid(
                "Chain",
                "links[" + std::to_string(m) + "]: " + std::string(name) +
                    " must lie in the range of the precision; use a wider one, or another unit",
                static_cast<double>(x));
    }
    if (column.is_scalar()) return Column<To>(values[0]);
    return values;
}

/// Converts a chain to another scalar. The numbers are unchanged if that is wider, else rounded.
/// Cost O(N). Throws InvalidArgument if a number leaves the range of `To`.
template <Real To, Real From>
Chain<To> converted(const Chain<From>& chain) {
    // in this order, so that the error names the first column at fault
    const auto weight = converted<To>("weight", chain.weight());
    const auto length = converted<To>("length", chain.length());
    const auto centroid = converted<To>("centroid", chain.centroid());
    return Chain<To>(
        chain.size(), weight, length, centroid,
        converted<Wide<To>>("(radius of gyration / length)^2", chain.gyration_ratio()));
}

}  // namespace revchain::detail
