// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns nodes and weights of Gauss's rule with n points on 0 ... 1, exact to degree 2 n - 1
/// (Newton's method).
inline std::vector<std::pair<double, double>> gauss_rule(int n) {
    std::vector<std::pair<double, double>> rule;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int round = 0; round < 100; ++round) {
            double last = 0, value = 1;
            for (int k = 0; k < n; ++k)
                last = std::exchange(value, ((2 * k + 1) * x * value - k * last) / (k + 1));
            slope = n * (x * value - last) / (x * x - 1);
            const double step = value / slope;
            x -= step;
            if (std::abs(step) < 1e-16) break;
        }
        rule.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
    }
    return rule;
}

}  // namespace revchain::detail
