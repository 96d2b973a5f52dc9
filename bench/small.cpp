// SPDX-License-Identifier: MPL-2.0
// One small chain, all modes, values only, proved to 1e-14: a new `Chain` and `modes` for every call against LAPACK
// (dsterf for plummets, dsbgv for rods, on the assembled matrices), as CSV: kind, N, share of the chains that were taken all
// together, CPU microseconds a chain for the chain itself, for `modes`, for `modes` by the spectrum method and for
// LAPACK (medians of interleaved rounds), LAPACK's over chain and modes, the worst errors in ulp against quadruple
// precision and the worst bound. A minute; without LAPACK its columns are 0.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "lapack_names.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"
#include "timing.hpp"

namespace {

using bench::cpu_seconds;
using bench::median;
using revchain::Chain;
using revchain::Index;
using revchain::Link;
using Links = std::vector<Link<double>>;

constexpr int most = 100;

std::vector<Links> random_links(bool rods, Index count, Index size) {
    support::Random random(static_cast<std::uint64_t>(size));
    std::vector<Links> all(static_cast<std::size_t>(count));
    for (Links& links : all)
        for (Index m = 0; m < size; ++m) {
            const double weight = random.between(0.5, 2), a = random.between(0.5, 2);
            links.push_back(rods ? revchain::uniform_rod<double>(weight, a) : revchain::plummet<double>(weight, a));
        }
    return all;
}

/// All heights, descending.
void lapack([[maybe_unused]] bool rods, [[maybe_unused]] const Links& links, [[maybe_unused]] double* height) {
#ifdef BENCH_HAS_LAPACK
    const int n = static_cast<int>(links.size()), band = 1, rows = 2;
    int info = 0;
    double hung = 0, k_below = 0, m_below = 0, mu[most];
    if (rods) {
        double stiffness[2 * most], mass[2 * most], work[3 * most], unused = 0;
        for (std::size_t m = 0; m < links.size(); ++m) {
            const double w = links[m].weight, k = (w / 2 + hung) / links[m].length;
            hung += w;
            stiffness[2 * m] = k_below + k;
            stiffness[2 * m + 1] = -k;
            mass[2 * m] = m_below + w / 3;
            mass[2 * m + 1] = w / 6;
            k_below = k;
            m_below = w / 3;
        }
        dsbgv_("N", "L", &n, &band, &band, stiffness, &rows, mass, &rows, mu, &unused, &band, work, &info);
    } else {
        double e[most];
        for (std::size_t m = 0; m < links.size(); ++m) {
            hung += links[m].weight;
            const double k = hung / links[m].length;
            mu[m] = (k_below + k) / links[m].weight;
            if (m + 1 < links.size()) e[m] = -k / std::sqrt(links[m].weight * links[m + 1].weight);
            k_below = k;
        }
        dsterf_(&n, mu, e, &info);
    }
    for (int j = 0; j < n; ++j) height[j] = 1 / mu[j];
#endif
}

double error_in_ulp(const support::Truth& truth, Index j, double height) {
    const support::Quad h = height, reach = 1e-10;
    return support::error_in_ulp(height, truth.height(j, h * (1 - reach), h * (1 + reach), 1e-19));
}

}  // namespace

int main() {
    std::printf("kind,N,together,chain_us,modes_us,spectrum_us,lapack_us,ratio,error_ulp,lapack_error_ulp,bound\n");
    double sink = 0;
    for (const bool rods : {false, true})
        for (const Index n : {2, 3, 5, 8, 10, 16, 30, 100}) {
            constexpr Index count = 200;
            const std::vector<Links> all = random_links(rods, count, n);
            std::vector<Chain<double>> chains(all.begin(), all.end());
            const revchain::ModesOptions<double> options{.count = revchain::all_modes, .rtol = 1e-14};
            auto by_interpolation = options;
            by_interpolation.method = revchain::ModesMethod::interpolated;

            double together = 0, error = 0, peer_error = 0, bound = 0, peer[most]{};
            const std::size_t sample = n > 30 ? 3 : n > 16 ? 20 : 200;
            for (std::size_t i = 0; i < all.size(); ++i) {
                const auto modes = revchain::modes(chains[i], options, revchain::methods::all);
                together += modes.method == "aberth" ? 1.0 / count : 0;
                bound = std::max(bound, modes.error_bound.maxCoeff());
                if (i >= sample) continue;
                const support::Truth truth(chains[i]);
                lapack(rods, all[i], peer);
                for (Index j = 0; j < n; ++j) {
                    error = std::max(error, error_in_ulp(truth, j, modes.conical_height[j]));
#ifdef BENCH_HAS_LAPACK
                    peer_error = std::max(peer_error, error_in_ulp(truth, j, peer[j]));
#endif
                }
            }

            const int repeats = static_cast<int>(std::max<Index>(1, 4000 / (n * n)));
            const auto microseconds = [&](const auto& work) {
                const double start = cpu_seconds();
                for (int r = 0; r < repeats; ++r)
                    for (std::size_t i = 0; i < all.size(); ++i) sink += work(i);
                return 1e6 * (cpu_seconds() - start) / (repeats * static_cast<double>(count));
            };
            std::vector<double> chain, modes, spectrum, other;
            for (int round = 0; round < 11; ++round) {
                chain.push_back(microseconds([&](std::size_t i) { return Chain<double>(all[i]).total_length(); }));
                modes.push_back(microseconds([&](std::size_t i) {
                    return revchain::modes(chains[i], options, revchain::methods::all).conical_height[0];
                }));
                spectrum.push_back(microseconds([&](std::size_t i) {
                    return revchain::modes(chains[i], by_interpolation, revchain::methods::all).conical_height[0];
                }));
                other.push_back(microseconds([&](std::size_t i) {
                    lapack(rods, all[i], peer);
                    return peer[0];
                }));
            }
#ifndef BENCH_HAS_LAPACK
            other.assign(1, 0.0);
#endif
            const double own = median(chain) + median(modes);
            // Two cycles a link and mode at 5 GHz would be faster than the arithmetic allows.
            const bool plausible = median(modes) > 0.0004 * static_cast<double>(n * n);
            std::printf("%s,%ld,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.2f,%.1f,%.1e%s\n", rods ? "rods" : "plummets",
                        static_cast<long>(n), together, median(chain), median(modes), median(spectrum), median(other),
                        median(other) / own, error, peer_error, bound,
                        plausible ? "" : ",broken: faster than the arithmetic");
            std::fflush(stdout);
        }
    return sink == 0 ? 1 : 0;
}
