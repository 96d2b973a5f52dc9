// SPDX-License-Identifier: MPL-2.0
// Many small chains, all modes: `conical_heights` against a loop over LAPACK (dsterf for plummets, dsbgv for rods, on the
// assembled matrices), as CSV: kind, N, chains, CPU microseconds a chain of each (medians of interleaved rounds), ratio,
// and the worst errors in ulp of a sample against quadruple precision. Half a minute; without LAPACK its columns
// are 0. Argument: the most chains (100000).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "lapack_names.hpp"
#include "revchain/batch.hpp"
#include "revchain/linear/batch_plan.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"
#include "timing.hpp"

namespace {

using bench::cpu_seconds;
using bench::median;
using revchain::BatchColumn;
using revchain::Index;
using Heights = revchain::Table<double>;

struct Chains {
    Index chains, size;
    bool rods;
    std::vector<double> weight, length, centroid, radius;

    revchain::ChainBatch<double> batch() const {
        revchain::ChainBatch<double> b{chains, size, {weight.data(), size, 1}, {length.data(), size, 1}};
        if (!rods) return b;
        b.centroid = BatchColumn<double>{centroid.data(), size, 1};
        b.radius_of_gyration = BatchColumn<double>{radius.data(), size, 1};
        return b;
    }
};

Chains random_chains(bool rods, Index chains, Index size) {
    support::Random random(static_cast<std::uint64_t>(size));
    Chains all{chains, size, rods, {}, {}, {}, {}};
    for (Index i = 0; i < chains * size; ++i) {
        all.weight.push_back(random.between(0.5, 2));
        all.length.push_back(random.between(0.5, 2));
        if (!rods) continue;
        all.centroid.push_back(all.length.back() / 2);
        all.radius.push_back(all.length.back() / std::sqrt(12.0));
    }
    return all;
}

#ifdef BENCH_HAS_LAPACK
void lapack_plummets(const Chains& all, Heights& heights) {
    const int n = static_cast<int>(all.size);
    std::vector<double> d(static_cast<std::size_t>(n)), e(static_cast<std::size_t>(n));
    for (Index c = 0; c < all.chains; ++c) {
        const double* const w = all.weight.data() + c * n;
        const double* const a = all.length.data() + c * n;
        double hung = 0, below = 0;
        for (std::size_t m = 0; m < d.size(); ++m) {
            hung += w[m];
            const double k = hung / a[m];
            d[m] = (below + k) / w[m];
            if (m + 1 < d.size()) e[m] = -k / std::sqrt(w[m] * w[m + 1]);
            below = k;
        }
        int info = 0;
        dsterf_(&n, d.data(), e.data(), &info);
        for (Index j = 0; j < n; ++j) heights(c, j) = 1 / d[static_cast<std::size_t>(j)];
    }
}

void lapack_rods(const Chains& all, Heights& heights) {
    const int n = static_cast<int>(all.size), band = 1, rows = 2;
    const std::size_t size = static_cast<std::size_t>(n);
    std::vector<double> stiffness(2 * size), mass(2 * size), mu(size), work(3 * size);
    double unused = 0;
    for (Index c = 0; c < all.chains; ++c) {
        const double* const w = all.weight.data() + c * n;
        const double* const a = all.length.data() + c * n;
        double hung = 0, k_below = 0, m_below = 0;
        for (std::size_t m = 0; m < size; ++m) {
            const double k = (w[m] / 2 + hung) / a[m];
            hung += w[m];
            stiffness[2 * m] = k_below + k;
            stiffness[2 * m + 1] = -k;
            mass[2 * m] = m_below + w[m] / 3;
            mass[2 * m + 1] = w[m] / 6;
            k_below = k;
            m_below = w[m] / 3;
        }
        int info = 0;
        dsbgv_("N", "L", &n, &band, &band, stiffness.data(), &rows, mass.data(), &rows, mu.data(), &unused, &band,
               work.data(), &info);
        for (Index j = 0; j < n; ++j) heights(c, j) = 1 / mu[static_cast<std::size_t>(j)];
    }
}
#endif

double worst_error(const Chains& all, const Heights& heights) {
    double worst = 0;
    const Index sample = std::min<Index>(all.chains, std::max<Index>(1, 20'000 / (all.size * all.size)));
    for (Index c = 0; c < sample; ++c) {
        const support::Truth truth(revchain::detail::chain_of(all.batch(), c));
        for (Index j = 0; j < all.size; ++j) {
            const support::Quad h = heights(c, j);
            const support::Quad exact =
                truth.height(j, h * (1 - support::Quad(1e-10)), h * (1 + support::Quad(1e-10)), 1e-19);
            worst = std::max(worst, support::error_in_ulp(heights(c, j), exact));
        }
    }
    return worst;
}

}  // namespace

int main(int argc, char** argv) {
    const Index most = argc > 1 ? std::atol(argv[1]) : 100'000;
    int broken = 0;
    std::printf("kind,N,chains,us,lapack_us,ratio,error_ulp,lapack_error_ulp\n");
    for (const bool rods : {false, true}) {
        for (const Index n : {2, 5, 10, 16, 30, 100}) {
            const Index chains = std::min<Index>(most, n <= 10 ? 100'000 : 10'000'000 / (n * n * n));
            const Chains all = random_chains(rods, chains, n);
            Heights ours(chains, n), peer = Heights::Constant(chains, n, 1.0);
            std::vector<double> own_time, peer_time;
            for (int round = 0; round < 7; ++round) {
                const double start = cpu_seconds();
                ours = revchain::conical_heights(all.batch());
                const double middle = cpu_seconds();
#ifdef BENCH_HAS_LAPACK
                rods ? lapack_rods(all, peer) : lapack_plummets(all, peer);
#endif
                const double end = cpu_seconds();
                own_time.push_back(1e6 * (middle - start) / static_cast<double>(chains));
                peer_time.push_back(1e6 * (end - middle) / static_cast<double>(chains));
            }
            double peer_error = 0;
#ifdef BENCH_HAS_LAPACK
            peer_error = worst_error(all, peer);
#else
            peer_time.assign(7, 0.0);
#endif
            // Two cycles a link and mode at 5 GHz would be faster than the arithmetic allows.
            const bool plausible = median(own_time) > 0.0004 * static_cast<double>(n * n);
            std::printf("%s,%ld,%ld,%.4f,%.4f,%.2f,%.2f,%.1f%s\n", rods ? "rods" : "plummets", static_cast<long>(n),
                        static_cast<long>(chains), median(own_time), median(peer_time),
                        median(peer_time) / median(own_time), worst_error(all, ours), peer_error,
                        plausible ? "" : ",broken: faster than the arithmetic");
            std::fflush(stdout);
            broken += !plausible;
        }
    }
    return broken > 0;
}
