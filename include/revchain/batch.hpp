// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"

/// Conical heights of many small chains at once.
///
///     const double weight[] = {1.0, 2.0, 1.0, 1.5, 0.5, 1.0}; // two chains, lowest plummet first
///     const double length = 0.2;                               // m, of every link
///     const revchain::ChainBatch<double> batch{
///         .chains = 2, .size = 3, .weight = {weight, 3, 1}, .length = {&length}};
///     const auto heights = revchain::conical_heights(batch);   // a row for each chain
///     heights(1, 0);                      // 0.518978 m: the slowest mode of the second chain
namespace revchain::inline REVCHAIN_BUILD {

/// One quantity of all links of all chains: link m (lowest first) of chain c has data[c
/// chain_stride + m link_stride]. A stride of 0 repeats a number.
template <Real T>
struct BatchColumn {
    const T* data = nullptr;
    Index chain_stride = 0;
    Index link_stride = 0;

    const T& operator()(Index chain, Index m) const {
        return data[chain * chain_stride + m * link_stride];
    }
};

/// Many chains with equal numbers of links. With `centroid` give either `pendulum_length` or
/// `radius_of_gyration`; without it the links are plummets.
template <Real T>
struct ChainBatch {
    Index chains = 0;
    Index size = 0;  ///< links of each chain
    BatchColumn<T> weight;
    BatchColumn<T> length;
    std::optional<BatchColumn<T>> centroid{};
    std::optional<BatchColumn<T>> pendulum_length{};
    std::optional<BatchColumn<T>> radius_of_gyration{};
    std::vector<Index> shape{};  ///< axes of the array of chains, last fastest; for messages
};

struct BatchOptions {
    std::optional<Index> count{};  ///< number of slowest modes of each chain; absent: all
    Index threads = 1;             ///< 0: all processors
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// The slowest `count` conical heights of every chain, descending: a row for each chain, in its
/// unit of length. Greenhill (1908) §8 (21) with sec delta = 1.
///
/// Method: in float and double, one chain to a SIMD lane (pencil/batch/spectrum.hpp). `modes`
/// solves other chains one by one, such as those with massless links. Accuracy, measured up to N =
/// 100 (tests/cpp/batch.cpp): 4.5 ulp for plummets and rods, 6 for other links, 14 for links with
/// their mass in one point between the pins. Counts verify heights to 16 + N/4 ulp. Results are
/// bitwise the same for any number of threads. Cost: 0.4 microseconds for all modes of ten links.
/// Throws InvalidArgument for a number that `Chain` refuses, naming chain, link and value, and for
/// a count beyond the modes of some chain. Massless links cost modes; chains with different numbers
/// of modes need a count.
template <Real T>
[[nodiscard]] Table<T> conical_heights(const ChainBatch<T>& batch,
                                       const BatchOptions& options = {});

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD {
extern template Table<double> conical_heights(const ChainBatch<double>&, const BatchOptions&);
#if !defined(REVCHAIN_COMPILED_DOUBLE)
extern template Table<float> conical_heights(const ChainBatch<float>&, const BatchOptions&);
extern template Table<long double> conical_heights(const ChainBatch<long double>&,
                                                   const BatchOptions&);
#endif
}  // namespace revchain
#else
#include "revchain/questions/batch.hpp"
#endif
