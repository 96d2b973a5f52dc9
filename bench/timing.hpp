// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace bench {

/// CPU time of all threads of this process.
inline double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

inline double median(std::vector<double> x) {
    std::sort(x.begin(), x.end());
    return x[x.size() / 2];
}

}  // namespace bench
