// SPDX-License-Identifier: MPL-2.0
// Equal plummets: the heights are the thread's length over the zeros of a Laguerre polynomial, the offsets of the pins
// its neighbours' values, y_j = L_j(x).
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

namespace {

using revchain::Index;
using support::Quad;

/// Zeros of L_N by N, ascending: tests/data/make_laguerre_zeros.py.
std::map<Index, std::vector<Quad>> laguerre_zeros() {
    std::ifstream file(REVCHAIN_TEST_DATA "/laguerre_zeros.csv");
    std::map<Index, std::vector<Quad>> zeros;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        std::string size, k, zero;
        std::getline(fields, size, ',');
        std::getline(fields, k, ',');
        std::getline(fields, zero, ',');
        zeros[std::stol(size)].push_back(strtoflt128(zero.c_str(), nullptr));
    }
    return zeros;
}

}  // namespace

TEMPLATE_TEST_CASE("equal plummets: every height within its bound of Laguerre's zeros", "[sweep][laguerre]", float,
                   double, long double) {
    using T = TestType;
    const auto zeros = laguerre_zeros();
    REQUIRE(zeros.size() == 19);
    double worst = 0;
    for (const auto& [size, zero] : zeros) {
        REQUIRE(static_cast<Index>(zero.size()) == size);
        const auto m =
            revchain::modes(revchain::Chain<T>::uniform_plummets(size, T(size)), {.count = revchain::all_modes});
        REQUIRE(m.size() == size);
        for (Index k = 0; k < size; ++k) {
            const Quad truth = 1 / zero[static_cast<std::size_t>(k)];
            const double error = support::error_in_ulp(m.conical_height[k], truth);
            const double bound = static_cast<double>(m.error_bound[k] / revchain::epsilon<T>());
            INFO("N = " << size << ", mode " << k + 1 << ": error " << error << " ulp, bound " << bound << " ulp");
            // 25 printed digits: half a unit in the last of them
            CHECK(error <= bound + 5e-25 / static_cast<double>(revchain::epsilon<T>()));
            CHECK(bound <= 2.1);  // measured 2.0
            worst = std::max(worst, error);
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.48);  // measured 0.473: every one correctly rounded
}

TEST_CASE("equal plummets: the offsets are L_j(x)", "[sweep][laguerre]") {
    double worst = 0;
    for (const auto& [size, zero] : laguerre_zeros()) {
        const auto m = revchain::modes(revchain::Chain<double>::uniform_plummets(size, static_cast<double>(size)),
                                       {.count = revchain::all_modes});
        for (Index k = 0; k < size; ++k) {
            const Quad x = zero[static_cast<std::size_t>(k)];
            std::vector<Quad> y{1, 1 - x};  // pin 0 (free end), pin 1, ...
            for (Index j = 1; j < size; ++j) {
                const std::size_t i = static_cast<std::size_t>(j);
                y.push_back(((2 * j + 1 - x) * y[i] - j * y[i - 1]) / (j + 1));
            }
            Quad largest = 0;
            for (const Quad& offset : y) largest = fmaxq(largest, fabsq(offset));
            for (Index j = 0; j <= size; ++j) {
                const Quad difference = m.shapes()(k, j) - y[static_cast<std::size_t>(j)] / largest;
                worst = std::max(worst, static_cast<double>(fabsq(difference) / revchain::epsilon<double>()));
            }
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.8);  // ulp of the largest offset; measured 0.72
}
