// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace bench {

#if !defined(__OPTIMIZE__)
// The build of ./test checks what programs measure, not times.
inline const int warned =
    std::fputs("not optimised: times mean nothing (bench/run builds programs that time)\n", stderr);
#endif

/// CPU time of all threads of this process.
inline double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds of CPU time of one call; short ones many times over, `slice` seconds in all.
template <class F>
double seconds_of(const F& call, double slice = 2e-4) {
    double start = cpu_seconds();
    call();
    const double took = cpu_seconds() - start;
    if (took > slice) return took;
    const int times = static_cast<int>(std::min(1e9 * slice, slice / std::max(took, 1e-9)) + 1);
    start = cpu_seconds();
    for (int i = 0; i < times; ++i) call();
    return (cpu_seconds() - start) / times;
}

inline double median(std::vector<double> x) {
    std::sort(x.begin(), x.end());
    return x[x.size() / 2];
}

}  // namespace bench
