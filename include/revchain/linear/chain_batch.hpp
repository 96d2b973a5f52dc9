// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/chain/chain.hpp"
#include "revchain/linear/modes.hpp"

namespace revchain {

/// One quantity of all links of all chains: that of link m (lowest first) of chain c at data[c chain_stride + m
/// link_stride]. A stride of 0 repeats a number.
template <Real T>
struct BatchColumn {
    const T* data = nullptr;
    Index chain_stride = 0;
    Index link_stride = 0;

    const T& operator()(Index chain, Index link) const { return data[chain * chain_stride + link * link_stride]; }
};

/// Many chains of equally many links. Without a centroid plummets; with one exactly one of the two that follow it.
template <Real T>
struct ChainBatch {
    Index chains = 0;
    Index size = 0;  ///< links of each chain
    BatchColumn<T> weight;
    BatchColumn<T> length;
    std::optional<BatchColumn<T>> centroid{};
    std::optional<BatchColumn<T>> pendulum_length{};
    std::optional<BatchColumn<T>> radius_of_gyration{};
    std::vector<Index> shape{};  ///< axes over which the chains are spread, last fastest; only to name a chain
};

struct BatchOptions {
    std::optional<Index> count{};  ///< the slowest so many modes of each chain; absent: all
    Index threads = 1;
    Progress* progress = nullptr;  ///< watched and stopped from another thread
};

namespace detail {

/// "chain 17" (counted from 0), "chain (4, 2)" where the batch has several axes.
template <Real T>
std::string name_of_chain(const ChainBatch<T>& batch, Index chain) {
    if (batch.shape.size() < 2) return "chain " + std::to_string(chain);
    std::string name;
    for (std::size_t axis = batch.shape.size(); axis-- > 0; chain /= batch.shape[axis])
        name = std::to_string(chain % batch.shape[axis]) + (name.empty() ? "" : ", ") + name;
    return "chain (" + name + ")";
}

template <Real T>
Link<T> link_of(const ChainBatch<T>& batch, Index c, Index m) {
    Link<T> link = plummet(batch.weight(c, m), batch.length(c, m));
    if (!batch.centroid) return link;
    const std::string place = "Chain: link " + std::to_string(m + 1);
    link.centroid = (*batch.centroid)(c, m);
    link.gyration_ratio =
        batch.pendulum_length
            ? gyration_from_pendulum_length<T>(place, link.length, link.centroid, (*batch.pendulum_length)(c, m))
            : gyration_from_radius<T>(place, link.length, (*batch.radius_of_gyration)(c, m));
    return link;
}

/// Chain number c, checked as every Chain is; what is wrong with it is told with its number.
template <Real T>
Chain<T> chain_of(const ChainBatch<T>& batch, Index c) {
    try {
        std::vector<Link<T>> links;
        links.reserve(static_cast<std::size_t>(batch.size));
        for (Index m = 0; m < batch.size; ++m) links.push_back(link_of(batch, c, m));
        return Chain<T>(links);
    } catch (const InvalidArgument& wrong) {
        const std::string_view sentence(wrong.what());
        const std::string_view prefix("revchain::Chain: ");
        refuse("conical_heights", name_of_chain(batch, c) + ": " +
                                      std::string(sentence.substr(sentence.starts_with(prefix) ? prefix.size() : 0)));
    }
}

}  // namespace detail

}  // namespace revchain
