// SPDX-License-Identifier: MPL-2.0
// All modes of one chain, values only: LAPACK (dlasq1 and dsterf for plummets, dsbgv for rods) and this library in one
// interleaved run, CPU time on one thread, medians, as CSV. Arguments: N (10000), repetitions (3).
// With the argument `engines`: `modes` by each of its methods, a chain built for each call, heights
// alone and with shapes, against double-double (a sample of 50 heights). Further arguments: the modes
// asked for (0: all), rtol (0: none), sizes.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "lapack_names.hpp"
#include "revchain/linear/assembly.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/pencil/spectrum/interpolated.hpp"
#include "revchain/system/converted.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"
#include "timing.hpp"

namespace {

using bench::median;
using revchain::Index;
using support::Quad;

double cpu_ms() { return 1e3 * bench::cpu_seconds(); }

using Pencil = revchain::pencil::ElementPencil<double>;

#if defined(BENCH_HAS_LAPACK)
/// Heights, descending; CPU time in ms.
double dlasq1(const Pencil& p, std::vector<double>& heights) {
    const int n = static_cast<int>(p.size());
    std::vector<double> d(p.elements.size()), e(d.size()), work(4 * d.size());
    const double start = cpu_ms();
    for (std::size_t m = 0; m < d.size(); ++m) {
        d[m] = std::sqrt(p.elements[m].stiffness / p.elements[m].weight);
        if (m + 1 < d.size()) e[m] = std::sqrt(p.elements[m].stiffness / p.elements[m + 1].weight);
    }
    int info = 0;
    dlasq1_(&n, d.data(), e.data(), work.data(), &info);
    const double time = cpu_ms() - start;
    heights.clear();
    for (std::size_t j = d.size(); j-- > 0;) heights.push_back(1 / (d[j] * d[j]));
    return time;
}

double dsterf(const Pencil& p, std::vector<double>& heights) {
    const int n = static_cast<int>(p.size());
    std::vector<double> d(p.elements.size()), e(d.size());
    const double start = cpu_ms();
    for (std::size_t m = 0; m < d.size(); ++m) {
        const double k = p.elements[m].stiffness, weight = p.elements[m].weight;
        d[m] = (k + (m > 0 ? p.elements[m - 1].stiffness : 0)) / weight;
        if (m + 1 < d.size()) e[m] = -k / std::sqrt(weight * p.elements[m + 1].weight);
    }
    int info = 0;
    dsterf_(&n, d.data(), e.data(), &info);
    const double time = cpu_ms() - start;
    heights.clear();
    for (const double mu : d) heights.push_back(1 / mu);
    return time;
}

double dsbgv(const Pencil& p, std::vector<double>& heights) {
    const std::size_t size = p.elements.size();
    const int n = static_cast<int>(size), one = 1, two = 2;
    std::vector<double> a(2 * size), b(2 * size), w(size), z(1), work(3 * size);
    const double start = cpu_ms();
    for (std::size_t m = 0; m < size; ++m) {
        const auto& e = p.elements[m];
        a[2 * m + 1] += e.lower, b[2 * m + 1] += e.stiffness;
        if (m + 1 == size) break;
        a[2 * m + 3] += e.upper, b[2 * m + 3] += e.stiffness;
        a[2 * m + 2] = e.cross, b[2 * m + 2] = -e.stiffness;
    }
    int info = 0;
    dsbgv_("N", "U", &n, &one, &one, a.data(), &two, b.data(), &two, w.data(), z.data(), &one, work.data(), &info);
    const double time = cpu_ms() - start;
    heights.assign(w.rbegin(), w.rend());
    return time;
}

#endif

struct Engine {
    std::string name;
    revchain::ModesMethod method;
    std::vector<double> heights, shapes;  ///< microseconds of a call
};

/// A line for each method that serves this chain.
void compare_engines(const support::Family& family, Index n, Index asked, std::optional<double> rtol) {
    using revchain::Chain;
    using revchain::DoubleDouble;
    using revchain::ModesMethod;
    const Index count = asked == 0 ? n : std::min(asked, n);
    const Chain<double> chain = family.make(n);
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < n; ++m) links.push_back(chain.link(m));
    std::vector<Engine> engines{{"automatic", ModesMethod::automatic, {}, {}},
                                {"bisection", ModesMethod::bisection, {}, {}},
                                {"aberth", ModesMethod::aberth, {}, {}},
                                {"interpolated", ModesMethod::interpolated, {}, {}},
                                {"condensed", ModesMethod::condensed, {}, {}}};
    const auto ask = [&](const Engine& e, const Chain<double>& of) {
        return revchain::modes(of, {.count = count, .rtol = rtol, .method = e.method}, revchain::methods::all);
    };
    std::erase_if(engines, [&](const Engine& e) {
        if (e.method == ModesMethod::automatic) return false;
        if (e.method == ModesMethod::condensed && count > n / 8) return true;
        return ask(e, chain).method != e.name;
    });
    double sink = 0;
    for (int round = 0; round < 5; ++round)
        for (Engine& e : engines) {
            e.heights.push_back(
                1e6 * bench::seconds_of([&] { sink += ask(e, Chain<double>(links)).conical_height[0]; }, 1e-3));
            e.shapes.push_back(
                1e6 * bench::seconds_of([&] { sink += ask(e, Chain<double>(links)).shapes()(0, 0); }, 1e-3));
        }
    if (sink == 0) return;
    const Chain<DoubleDouble> exact = revchain::detail::converted<DoubleDouble>(chain);
    std::vector<revchain::Modes<double>> found;
    for (const Engine& e : engines) found.push_back(ask(e, chain));
    std::vector<double> worst(engines.size());
    for (Index j = 0; j < count; j += std::max<Index>(1, count / 50)) {  // a sample where there are many
        const DoubleDouble height = revchain::modes(exact, {.first = j + 1, .count = 1}).conical_height[0];
        for (std::size_t i = 0; i < engines.size(); ++i) {
            const DoubleDouble off = (DoubleDouble(found[i].conical_height[j]) - height) / height;
            worst[i] = std::max(worst[i], std::abs(static_cast<double>(off)) / 0x1p-52);
        }
    }
    for (std::size_t i = 0; i < engines.size(); ++i) {
        const Engine& e = engines[i];
        std::printf("%s,%ld,%ld,%s,%s,%.3f,%.3f,%.3f,%.2f\n", family.name.c_str(), static_cast<long>(n),
                    static_cast<long>(count), e.name.c_str(), found[i].method.c_str(), median(e.heights),
                    median(e.shapes), worst[i], found[i].error_bound.maxCoeff() / 0x1p-52);
    }
    std::fflush(stdout);
}

void compare_engines(int argc, char** argv) {
    const Index asked = argc > 2 ? std::atol(argv[2]) : 0;
    const double rtol = argc > 3 ? std::atof(argv[3]) : 0;
    std::vector<Index> sizes{2, 5, 10, 20, 50, 100, 300, 1000, 3000};
    if (argc > 4) sizes.clear();
    for (int i = 4; i < argc; ++i) sizes.push_back(std::atol(argv[i]));
    std::printf("chain,N,modes,method,used,heights_us,with_shapes_us,worst_error_ulp,worst_bound_ulp\n");
    for (const std::size_t f : {3, 2, 0})  // random rods, random plummets, equal plummets
        for (const Index n : sizes)
            compare_engines(support::families()[f], n, asked, rtol > 0 ? std::optional(rtol) : std::nullopt);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "engines") {
        compare_engines(argc, argv);
        return 0;
    }
    const Index n = argc > 1 ? std::atol(argv[1]) : 10'000;
    const int repetitions = argc > 2 ? std::atoi(argv[2]) : 3;
    std::printf(
        "chain,N,method,cpu_ms,ns_per_mode_and_link,times_faster,worst_error_ulp,median_bound_ulp,worst_bound_ulp\n");
    for (std::size_t f = 0; f < 4; ++f) {  // equal and random, plummets and rods
        const auto family = support::families()[f];
        const auto chain = family.make(n);
        const auto assembled = revchain::assemble(chain);
        const auto pencil = revchain::pencil::rounded<double>(assembled.pencil);
        const bool plummets = f % 2 == 0;
        std::vector<std::vector<double>> times(3), heights(3);
        std::vector<revchain::pencil::Certified<double>> ours;
        for (int r = 0; r < repetitions; ++r) {
#if defined(BENCH_HAS_LAPACK)
            times[0].push_back(plummets ? dlasq1(pencil, heights[0]) : dsbgv(pencil, heights[0]));
            if (plummets) times[1].push_back(dsterf(pencil, heights[1]));
#endif
            const double start = cpu_ms();
            ours = revchain::pencil::all_eigenvalues(revchain::assemble(chain).pencil, Index(0), n, n, 1e-11);
            times[2].push_back(cpu_ms() - start);
        }
        heights[2].clear();
        std::vector<double> bounds;
        for (const auto& c : ours) heights[2].push_back(c.eigenvalue), bounds.push_back(c.error_bound);
        const support::Truth truth(chain);
        const Quad unit = std::ldexp(1.0, assembled.units.length_exponent);
        std::vector<double> worst(3, 0.0);
        for (Index j = 0; j < n; j += std::max<Index>(1, n / 60)) {
            const Quad near = Quad(heights[2][static_cast<std::size_t>(j)]) * unit;
            const Quad exact = truth.height(j, near * (1 - Quad(1e-8)), near * (1 + Quad(1e-8)), 1e-19) / unit;
            for (std::size_t i = 0; i < 3; ++i)
                if (!times[i].empty())
                    worst[i] =
                        std::max(worst[i], support::error_in_ulp(heights[i][static_cast<std::size_t>(j)], exact));
        }
        const char* names[] = {plummets ? "dlasq1" : "dsbgv", "dsterf", "revchain"};
        for (std::size_t i = 0; i < 3; ++i) {
            if (times[i].empty()) continue;
            const double time = median(times[i]), links = static_cast<double>(n);
            std::printf("\"%s\",%ld,%s,%.2f,%.3f,%.2f,%.3g,%.3g,%.3g\n", family.name.c_str(), static_cast<long>(n),
                        names[i], time, 1e6 * time / links / links, times[0].empty() ? 0.0 : median(times[0]) / time,
                        worst[i], i == 2 ? median(bounds) / 0x1p-52 : 0.0,
                        i == 2 ? *std::max_element(bounds.begin(), bounds.end()) / 0x1p-52 : 0.0);
        }
        std::fflush(stdout);
    }
}
