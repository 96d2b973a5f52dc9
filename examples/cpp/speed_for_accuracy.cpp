// SPDX-License-Identifier: MPL-2.0
// What a looser tolerance saves: all modes of 1000 rods, tolerance by tolerance.
#include <revchain/methods.hpp>
#include <revchain/revchain.hpp>

#include <cmath>
#include <cstdio>
#include <ctime>

int main() {
    const auto chain = revchain::Chain<double>::uniform_rods(1000, 10.0);
    const auto exact = revchain::modes(chain, {.count = revchain::all_modes});
    std::printf("asked     proved    true error  CPU ms   method\n");
    for (const double rtol : {1e-2, 1e-6, 1e-10, 1e-12, 1e-13, 1e-14, 1e-15}) {
        const std::clock_t start = std::clock();
        const auto modes = revchain::modes(chain, {.count = revchain::all_modes, .rtol = rtol}, revchain::methods::all);
        const double ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        const double error =
            ((modes.conical_height - exact.conical_height).array() / exact.conical_height.array()).abs().maxCoeff();
        std::printf("%.0e     %.1e   %.1e     %6.1f   %s\n", rtol, modes.error_bound.maxCoeff(), error, ms,
                    modes.method.c_str());
        if (modes.status != revchain::Status::success || error > modes.error_bound.maxCoeff()) return 1;
    }
}
