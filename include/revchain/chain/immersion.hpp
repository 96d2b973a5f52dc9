// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain/link.hpp"

namespace revchain {

/// The fluid around a chain: at rest, or turning bodily with it.
enum class Fluid { still, turning };

/// What a link displaces. Its centre of buoyancy and radius of gyration are those of the fluid that would fill it.
struct Displaced {
    double weight = 0;                 ///< B >= 0, of the fluid displaced
    double centroid = 0;               ///< of it, from the upper pin, positive towards the lower
    Wide<double> gyration_ratio{0.0};  ///< (radius of gyration / length of the link)^2, about that centroid
    double added_weight = 0;           ///< of fluid that has to move with the link, in still fluid; spread as B is

    friend bool operator==(const Displaced&, const Displaced&) = default;
};

/// Of a body of one density throughout, whose fluid it displaces has its centre and radius of gyration.
inline Displaced displaced_by(const Link<double>& link, double weight, double added_weight = 0) {
    return {weight, link.centroid, link.gyration_ratio, added_weight};
}

}  // namespace revchain
