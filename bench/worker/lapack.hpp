// SPDX-License-Identifier: MPL-2.0
// LAPACK, through its Fortran names: whatever implementation the linker found (see `lapack_implementation`).
#pragma once

#include "lapack_names.hpp"
#include "worker/matrices.hpp"
#include "worker/method.hpp"

#ifdef BENCH_HAS_LAPACK
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace bench {

/// The file that the symbols come from.
inline std::string lapack_implementation() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&dstebz_), &info) == 0 || info.dli_fname == nullptr) return "unknown";
    char* path = realpath(info.dli_fname, nullptr);
    const std::string result = path == nullptr ? info.dli_fname : path;
    std::free(path);
    return result;
}

namespace detail {

inline void check_lapack(const char* name, int info) {
    if (info != 0) throw std::runtime_error(std::string(name) + ": info = " + std::to_string(info));
}

/// Eigenvalues 1/lambda ascending -> the first `count` heights.
inline void push_reciprocals(const double* mu, std::size_t count, Heights& heights) {
    for (std::size_t j = 0; j < count; ++j) heights.push_back(1 / mu[j]);
}

inline void stebz(const RawChain& chain, std::size_t count, Heights& heights) {
    const Tridiagonal t = standard_form(chain);
    const int n = static_cast<int>(chain.size()), first = 1, last = static_cast<int>(count);
    std::vector<double> w(chain.size()), work(4 * chain.size());
    std::vector<int> block(chain.size()), split(chain.size()), iwork(3 * chain.size());
    const double unused = 0, abstol = 0;
    int found = 0, blocks = 0, info = 0;
    dstebz_("I", "E", &n, &unused, &unused, &first, &last, &abstol, t.diagonal.data(), t.off.data(), &found, &blocks,
            w.data(), block.data(), split.data(), work.data(), iwork.data(), &info);
    check_lapack("dstebz", info);
    push_reciprocals(w.data(), static_cast<std::size_t>(found), heights);
}

inline void stemr(const RawChain& chain, std::size_t count, Heights& heights) {
    Tridiagonal t = standard_form(chain);
    const int n = static_cast<int>(chain.size()), first = 1, last = static_cast<int>(count), one = 1;
    std::vector<double> w(chain.size()), work(12 * chain.size());
    std::vector<int> support(2 * chain.size()), iwork(8 * chain.size());
    const int lwork = static_cast<int>(work.size()), liwork = static_cast<int>(iwork.size());
    const double unused = 0;
    double z = 0;
    int found = 0, high_relative_accuracy = 1, info = 0;
    dstemr_("N", "I", &n, t.diagonal.data(), t.off.data(), &unused, &unused, &first, &last, &found, w.data(), &z, &one,
            &one, support.data(), &high_relative_accuracy, work.data(), &lwork, iwork.data(), &liwork, &info);
    check_lapack("dstemr", info);
    push_reciprocals(w.data(), static_cast<std::size_t>(found), heights);
}

inline void sterf(const RawChain& chain, std::size_t count, Heights& heights) {
    Tridiagonal t = standard_form(chain);
    const int n = static_cast<int>(chain.size());
    int info = 0;
    dsterf_(&n, t.diagonal.data(), t.off.data(), &info);
    check_lapack("dsterf", info);
    push_reciprocals(t.diagonal.data(), count, heights);
}

/// Singular values of the exact factor, to high relative accuracy; they come descending.
inline void lasq1(const RawChain& chain, std::size_t count, Heights& heights) {
    Tridiagonal b = cholesky_factor(chain);
    const int n = static_cast<int>(chain.size());
    std::vector<double> work(4 * chain.size());
    int info = 0;
    dlasq1_(&n, b.diagonal.data(), b.off.data(), work.data(), &info);
    check_lapack("dlasq1", info);
    for (std::size_t j = 0; j < count; ++j) {
        const double sigma = b.diagonal[chain.size() - 1 - j];
        heights.push_back(1 / (sigma * sigma));
    }
}

/// `mass_first`: M y = lambda K y, which is kinder to the slow modes, else K y = mu M y, the textbook's order.
inline void sbgv(const RawChain& chain, std::size_t count, bool mass_first, Heights& heights) {
    const Pencil p = assembled(chain);
    const std::size_t size = chain.size();
    const int n = static_cast<int>(size), band = size > 1 ? 1 : 0, rows = band + 1, one = 1;
    const auto banded = [&](const Tridiagonal& t) {  // lower storage: diagonal, then what is below it
        std::vector<double> a(size * static_cast<std::size_t>(rows));
        for (std::size_t m = 0; m < size; ++m) {
            a[m * static_cast<std::size_t>(rows)] = t.diagonal[m];
            if (band == 1) a[2 * m + 1] = t.off[m];
        }
        return a;
    };
    std::vector<double> a = banded(mass_first ? p.mass : p.stiffness), b = banded(mass_first ? p.stiffness : p.mass);
    std::vector<double> w(size), work(3 * size);
    double z = 0;
    int info = 0;
    dsbgv_("N", "L", &n, &band, &band, a.data(), &rows, b.data(), &rows, w.data(), &z, &one, work.data(), &info);
    check_lapack("dsbgv", info);
    if (!mass_first) return push_reciprocals(w.data(), count, heights);
    for (std::size_t j = 0; j < count; ++j) heights.push_back(w[size - 1 - j]);
}

}  // namespace detail

inline void register_lapack(Registry& registry) {
    const auto add = [&](const char* name, const char* kinds, std::size_t largest, const char* which, auto run) {
        registry.methods.push_back(
            {.name = name,
             .family = "LAPACK",
             .kinds = kinds,
             .largest = largest,
             .which = which,
             .run = [run](const RawChain& c, std::size_t n, double, Heights& h) { run(c, n, h); }});
    };
    using C = const RawChain&;
    using H = Heights&;
    using N = std::size_t;
    add("dstebz", "ACDE", 1'000'000, "any", [](C c, N n, H h) { detail::stebz(c, n, h); });
    add("dstemr", "ACDE", 1'000'000, "any", [](C c, N n, H h) { detail::stemr(c, n, h); });
    add("dsterf", "ACDE", 20'000, "all", [](C c, N n, H h) { detail::sterf(c, n, h); });
    add("dlasq1", "ACDE", 20'000, "all", [](C c, N n, H h) { detail::lasq1(c, n, h); });
    add("dsbgv", "BR", 20'000, "all", [](C c, N n, H h) { detail::sbgv(c, n, false, h); });
    add("dsbgv, M first", "BR", 20'000, "all", [](C c, N n, H h) { detail::sbgv(c, n, true, h); });
}

}  // namespace bench
#else
namespace bench {
inline std::string lapack_implementation() { return "none"; }
inline void register_lapack(Registry& registry) {
    registry.missing.push_back({"LAPACK (dstebz, dstemr, dsterf, dlasq1, dsbgv)",
                                "not found when this was configured; apt-get install libopenblas-dev"});
}
}  // namespace bench
#endif
