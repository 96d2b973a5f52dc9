// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "revchain/numeric/double_double.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

using TwoDoubles = DoubleWord<double>;

inline constexpr TwoDoubles two_word_pi = std::numbers::pi_v<DoubleDouble>.word();

/// Series of modulus and phase: J_order + i Y_order = M exp(i theta) for large z. Here theta = z -
/// (order/2 + 1/4) pi - lag(z) and M^2 = 2 density(z) / (pi z), DLMF 10.18.17-18. theta' = 1 /
/// density gives one series from the other. Accuracy for z >= first(order): lag 1e-15 relative,
/// density 3e-16. Cost: 5 to 30 ns.
class PhaseSeries {
   public:
    explicit PhaseSeries(double order) {
        density_[0] = 1;
        std::array<double, terms + 1> rate{1};
        for (std::size_t m = 1; m <= terms; ++m) {
            const double odd = 2 * static_cast<double>(m) - 1;
            density_[m] =
                density_[m - 1] * odd / (odd + 1) * ((2 * order - odd) * (2 * order + odd)) / 4;
            for (std::size_t i = 1; i <= m; ++i) rate[m] -= density_[i] * rate[m - i];
            lag_[m] = rate[m] / odd;
        }
    }

    /// Returns the least z for which the series are accurate.
    static double first(double order) { return std::max(30.0, 8 * order); }

    double lag(double z) const { return sum(lag_, 1 / z / z) / z; }
    double density(double z) const { return 1 + density_above_one(z); }
    double density_above_one(double z) const { return sum(density_, 1 / z / z) / z / z; }

   private:
    static constexpr std::size_t terms = 14;

    static double sum(const std::array<double, terms + 1>& coefficient, double step) {
        double power = step, total = coefficient[1], before = 1;
        for (std::size_t m = 2; m <= terms; ++m, power *= step) {
            const double term = coefficient[m] * power;
            total += term;
            const double size = std::abs(term);
            if (std::max(size, before) <= 1e-18 * std::abs(total)) break;  // one term may vanish
            before = size;
        }
        return total;
    }

    std::array<double, terms + 1> density_{}, lag_{};  // lag_[0] is not used
};

}  // namespace revchain::detail
