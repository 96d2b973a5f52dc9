// SPDX-License-Identifier: MPL-2.0
// `modes` by each of its methods, a chain built for each call, heights alone and with shapes, as CSV: microseconds of CPU
// time (medians of interleaved rounds), and the largest error of a sample of 50 heights against double-double. Two
// minutes.
//
//     bench_engines [MODES [RTOL [SIZE...]]]    MODES 0: all; RTOL 0: none
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/system/converted.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

namespace {

using bench::median;
using revchain::Index;

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
            e.shapes.push_back(1e6 *
                               bench::seconds_of([&] { sink += ask(e, Chain<double>(links)).shapes()(0, 0); }, 1e-3));
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

}  // namespace

int main(int argc, char** argv) {
    const Index asked = argc > 1 ? std::atol(argv[1]) : 0;
    const double rtol = argc > 2 ? std::atof(argv[2]) : 0;
    std::vector<Index> sizes{2, 5, 10, 20, 50, 100, 300, 1000, 3000};
    if (argc > 3) sizes.clear();
    for (int i = 3; i < argc; ++i) sizes.push_back(std::atol(argv[i]));
    std::printf("chain,N,modes,method,used,heights_us,with_shapes_us,worst_error_ulp,worst_bound_ulp\n");
    for (const std::size_t f : {3, 2, 0})  // random rods, random plummets, equal plummets
        for (const Index n : sizes)
            compare_engines(support::families()[f], n, asked, rtol > 0 ? std::optional(rtol) : std::nullopt);
}
