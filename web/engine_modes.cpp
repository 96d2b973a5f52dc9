// SPDX-License-Identifier: MPL-2.0
// Modes for the live page: compiled for size, as they take a millisecond at most.
#include <algorithm>

#include "engine.hpp"
#include "revchain/rig_modes.hpp"

namespace web {
namespace {

void put_modes(const revchain::WhirlModes& modes, double sense) {
    for (Index j = 0; j < modes.size(); ++j) {
        put(sense * modes.angular_speed[j]), put(modes.speed_error_bound[j]);
        put(modes.conical_height[j]), put(modes.error_bound[j]);
        const auto& nodes = modes.nodes()[static_cast<std::size_t>(j)];
        put(static_cast<double>(nodes.size())), put_all(nodes);
        for (Index pin = 0; pin <= rig->size(); ++pin) put(modes.shapes()(j, pin));
    }
}

}  // namespace
}  // namespace web

extern "C" {

using namespace web;

/// Numbers of forward and backward modes available, of other solutions, fastest growth of these, whether that is
/// proved to be all, modes that follow; each mode of the forward ones, then of the backward ones.
int find_modes(int count) {
    return answered([&] {
        const auto size = static_cast<Index>(count);
        const revchain::RigModes found = revchain::modes(*rig, {.count = size, .gravity = gravity});
        double growth = 0;
        for (const auto& other : found.other) growth = std::max(growth, other.growth_rate);
        put(static_cast<double>(found.forward.available)), put(static_cast<double>(found.backward.available));
        put(static_cast<double>(found.other_available)), put(growth), put(found.complete);
        put(static_cast<double>(found.forward.size() + found.backward.size()));
        put_modes(found.forward, 1), put_modes(found.backward, -1);
    });
}
}
