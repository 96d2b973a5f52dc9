// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>

#include "revchain/rig_modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/rig_truth.hpp"

namespace support::rig_modes {

using namespace revchain;

inline constexpr double g = conical_pendulum::standard_gravity;

inline Link<double> random_body(Random& random, double thin = 1) {
    const double a = random.between(0.3, 2);
    return compound_pendulum<double>({.weight = random.between(0.2, 3),
                                      .length = a,
                                      .centroid = a * random.between(0.2, 1.1),
                                      .radius_of_gyration = a * random.between(0, 0.6) * thin});
}

/// Every height or speed of a sense against counts on the assembled matrices; the worst error in ulp.
inline double worst_error(const RigTruth& truth, const RigModes& m, Index step = 1) {
    double worst = 0;
    for (const WhirlModes* sense : {&m.forward, &m.backward})
        for (Index j = 0; j < sense->size(); j += step) {
            const Quad n = (sense == &m.backward ? -1 : 1) * Quad(sense->angular_speed[j]);
            const Quad h = sense->conical_height[j];
            const double off = m.has_momentum ? RigTruth::off_by(n, [&](Quad x) { return truth.at_speed(x); })
                                              : RigTruth::off_by(h, [&](Quad x) { return truth.at_height(x); });
            const double bound = (m.has_momentum ? sense->speed_error_bound : sense->error_bound)[j] / 0x1p-52;
            CAPTURE(j, static_cast<double>(n), off, bound);
            REQUIRE(off <= bound);
            worst = std::max(worst, off);
            const Quad speed = m.has_momentum ? n : sqrtq(Quad(g) / h);
            REQUIRE(sense->residual()[j] <= 4e-16);
            if (truth.size == static_cast<std::size_t>(sense->shapes().cols()) - 1) {  // a firm support
                REQUIRE(sense->shapes()(j, sense->shapes().cols() - 1) == 0);
            }
            REQUIRE(truth.residual(speed, sense->shapes().row(j)) <= 1e-15);
            REQUIRE(sense->shapes().row(j).cwiseAbs().maxCoeff() == 1);
            REQUIRE(sense->shapes()(j, 0) >= 0);
        }
    return worst;
}

}  // namespace support::rig_modes
