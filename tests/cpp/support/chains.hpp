// SPDX-License-Identifier: MPL-2.0
// The chains that tests and benchmarks share: ordinary ones and those that break other solvers.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/numeric/compiler.hpp"

namespace support {

using revchain::Chain;
using revchain::Index;
using revchain::Link;

/// Uniform in [0, 1), the same on every platform (std::uniform_real_distribution is not).
class Random {
   public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    /// Product and sum are not fused, so that all builds get the same numbers.
    double between(double low, double high) {
        const double part = (high - low) * (*this)();
        return low + revchain::detail::unfused(part);
    }
    /// Spread evenly in the logarithm.
    double log_between(double low, double high) { return low * std::pow(high / low, (*this)()); }

   private:
    std::mt19937_64 engine_;
};

struct Family {
    std::string name;
    std::function<Chain<double>(Index)> make;
};

inline Chain<double> chain_of(Index size, const std::function<Link<double>(Index)>& link) {
    std::vector<Link<double>> links;
    for (Index m = 0; m < size; ++m) links.push_back(link(m));
    return Chain<double>(links);
}

/// Weights from 1 to `ratio` along the chain, lowest first.
inline double graded(Index m, Index size, double ratio) {
    return size == 1 ? 1.0 : std::pow(ratio, static_cast<double>(m) / static_cast<double>(size - 1));
}

inline std::vector<Family> families() {
    using revchain::compound_pendulum;
    using revchain::plummet;
    using revchain::uniform_rod;
    return {
        {"equal plummets", [](Index n) { return Chain<double>::uniform_plummets(n, 1.0, 1.0); }},
        {"equal rods", [](Index n) { return Chain<double>::uniform_rods(n, 1.0, 1.0); }},
        {"random plummets",
         [](Index n) {
             Random random(11);
             return chain_of(n, [&](Index) {
                 const double weight = random.between(0.5, 1.5);
                 return plummet<double>(weight, random.between(0.5, 1.5));
             });
         }},
        {"random rods",
         [](Index n) {
             Random random(12);
             return chain_of(n, [&](Index) {
                 const double weight = random.between(0.5, 1.5);
                 return uniform_rod<double>(weight, random.between(0.5, 1.5));
             });
         }},
        {"weights 1 ... 1e12 upward",
         [](Index n) { return chain_of(n, [=](Index m) { return plummet<double>(graded(m, n, 1e12), 1.0); }); }},
        {"weights 1e12 ... 1 upward (heavy tip)",
         [](Index n) {
             return chain_of(n, [=](Index m) { return uniform_rod<double>(graded(n - 1 - m, n, 1e12), 1.0); });
         }},
        {"random weights 1e12, lengths 1e6",
         [](Index n) {
             Random random(13);
             return chain_of(n, [&](Index) {
                 const double weight = random.log_between(1.0, 1e12);
                 const double a = random.log_between(1e-3, 1e3);
                 return compound_pendulum<double>({.weight = weight,
                                                   .length = a,
                                                   .centroid = a * random.between(0.05, 1.0),
                                                   .radius_of_gyration = a * random.between(0.0, 0.5)});
             });
         }},
        {"centroids above and below the pin",
         [](Index n) {
             Random random(14);
             return chain_of(n, [&](Index m) {
                 const double a = random.between(0.5, 1.5);
                 // a light bell head on a heavier chain: W h + a S stays positive
                 const double weight = random.between(0.5, 1.5) / (m == 0 ? 1.0 : 4.0);
                 const double h = a * (m == 0 ? 0.5 : random.between(-0.6, 1.8));
                 return compound_pendulum<double>({.weight = weight,
                                                   .length = a,
                                                   .centroid = h,
                                                   .radius_of_gyration = a * random.between(0.01, 1.0)});
             });
         }},
        {"long pendulum lengths (l > a)",
         [](Index n) {
             Random random(15);
             return chain_of(n, [&](Index) {
                 const double weight = random.log_between(1.0, 100.0);
                 const double a = random.between(0.5, 1.5);
                 const double h = a * random.between(0.2, 2.0);
                 return compound_pendulum<double>({.weight = weight,
                                                   .length = a,
                                                   .centroid = h,
                                                   .pendulum_length = h + a * random.between(0.5, 5.0)});
             });
         }},
        {"massless links between",
         [](Index n) {
             Random random(16);
             return chain_of(n, [&](Index m) {
                 const double a = random.between(0.5, 1.5);
                 return m % 3 == 1 ? plummet<double>(0.0, a) : plummet<double>(random.between(0.5, 1.5), a);
             });
         }},
    };
}

}  // namespace support
