// SPDX-License-Identifier: MPL-2.0
// Methods of this library: a line each at the bottom.
#pragma once

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/questions/dense_reference.hpp"
#include "worker/method.hpp"

namespace bench {

inline revchain::Chain<double> library_chain(const RawChain& raw) {
    const auto n = static_cast<revchain::Index>(raw.size());
    const auto weights = revchain::Column<double>::borrowed(raw.weight.data(), raw.size());
    const auto rod = revchain::uniform_rod<double>(1.0, 1.0);
    return raw.rods ? revchain::Chain<double>(n, weights, 1.0, rod.centroid, rod.gyration_ratio)
                    : revchain::Chain<double>(n, weights, 1.0, 1.0, revchain::Wide<double>(0.0));
}

/// `solve(chain, options)` -> Modes<double>, heights alone.
template <class Solve>
void add_library_method(Registry& registry, std::string name, std::size_t largest, bool has_tolerance, Solve solve) {
    const auto run = [solve](const RawChain& raw, std::size_t count, double rtol, Heights& heights) {
        revchain::ModesOptions<double> options{.count = static_cast<revchain::Index>(count)};
        if (rtol > 0) options.rtol = rtol;
        for (const double height : solve(library_chain(raw), options).conical_height) heights.push_back(height);
    };
    registry.methods.push_back({.name = std::move(name),
                                .family = "revchain",
                                .kinds = "ABCDER",
                                .largest = largest,
                                .has_tolerance = has_tolerance,
                                .run = run});
}

inline void register_revchain(Registry& registry) {
    const auto modes = [](const auto& c, const auto& options) {  // as from Python
        return revchain::modes(c, options, revchain::methods::all);
    };
    const auto dense = [](const auto& chain, const auto& options) { return revchain::modes_dense(chain, options); };
    const auto recurrence = [](const auto& c, const auto& options) { return revchain::modes_recurrence(c, options); };
    add_library_method(registry, "modes", 10'000'000, true, modes);
    add_library_method(registry, "modes_dense", 300, false, dense);
    add_library_method(registry, "modes_recurrence", 100, false, recurrence);
}

}  // namespace bench
