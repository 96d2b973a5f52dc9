// SPDX-License-Identifier: MPL-2.0
// Methods of this library: a line each at the bottom.
#pragma once

#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/questions/dense_reference.hpp"
#include "support/quad_scalar.hpp"
#include "worker/method.hpp"

namespace bench {

template <class T>
revchain::Chain<T> library_chain(const RawChain& raw) {
    const auto n = static_cast<revchain::Index>(raw.size());
    const auto weights = [&]() -> revchain::Column<T> {
        if constexpr (std::is_same_v<T, double>) {
            return revchain::Column<T>::borrowed(raw.weight.data(), raw.size());
        } else {
            std::vector<T> weight;
            weight.reserve(raw.size());
            for (const double w : raw.weight) weight.push_back(static_cast<T>(w));
            return weight;
        }
    };
    const auto [rod_weight, rod_length, rod_centroid, rod_gyration] = revchain::uniform_rod<T>(T(1), T(1));
    return raw.rods ? revchain::Chain<T>(n, weights(), T(1), rod_centroid, rod_gyration)
                    : revchain::Chain<T>(n, weights(), T(1), T(1), revchain::Wide<T>(T(0)));
}

/// `solve(chain, options)` -> Modes<T>, heights alone.
template <class T, class Solve>
void add_library_method(Registry& registry, std::string name, std::string scalar, std::size_t largest,
                        bool has_tolerance, Solve solve) {
    const auto run = [solve](const RawChain& raw, std::size_t count, double rtol, Heights& heights) {
        revchain::ModesOptions<T> options{.count = static_cast<revchain::Index>(count)};
        if (rtol > 0) options.rtol = T(rtol);
        const auto modes = solve(library_chain<T>(raw), options);
        for (const T& height : modes.conical_height) {
            if constexpr (sizeof(T) > sizeof(double)) {
                heights.push_back(height, 3);
            } else {
                heights.push_back(static_cast<double>(height));
            }
        }
    };
    registry.methods.push_back({.name = std::move(name),
                                .family = "revchain",
                                .scalar = std::move(scalar),
                                .kinds = "ABCDER",
                                .largest = largest,
                                .has_tolerance = has_tolerance,
                                .run = run});
}

inline void register_revchain(Registry& registry) {
    const auto modes = [](const auto& chain, const auto& options) { return revchain::modes(chain, options); };
    const auto dense = [](const auto& chain, const auto& options) { return revchain::modes_dense(chain, options); };
    const auto recurrence = [](const auto& c, const auto& options) { return revchain::modes_recurrence(c, options); };
    add_library_method<double>(registry, "modes", "double", 10'000'000, true, modes);
    add_library_method<float>(registry, "modes, float", "float", 10'000'000, true, modes);
    add_library_method<long double>(registry, "modes, long double", "long double", 100'000, true, modes);
    add_library_method<revchain::DoubleDouble>(registry, "modes, double-double", "double-double", 10'000, true, modes);
    add_library_method<support::QuadScalar>(registry, "modes, __float128", "__float128", 100, true, modes);
    add_library_method<double>(registry, "modes_dense", "double", 300, false, dense);
    add_library_method<double>(registry, "modes_recurrence", "double", 100, false, recurrence);
}

}  // namespace bench
