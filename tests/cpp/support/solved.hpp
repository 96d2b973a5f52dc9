// SPDX-License-Identifier: MPL-2.0
// Linear equations of small dense matrices in any number type.
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace support {

template <class T>
using Numbers = std::vector<T>;

/// x with A x = b, by elimination with rows exchanged; nothing where A is singular.
template <class T>
std::optional<Numbers<T>> solved(std::vector<Numbers<T>> A, Numbers<T> b) {
    const std::size_t n = b.size();
    const auto size = [](const T& x) { return x < 0 ? -x : x; };
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t best = i;
        for (std::size_t r = i + 1; r < n; ++r)
            if (size(A[r][i]) > size(A[best][i])) best = r;
        if (!(size(A[best][i]) > 0)) return std::nullopt;
        std::swap(A[i], A[best]), std::swap(b[i], b[best]);
        for (std::size_t r = i + 1; r < n; ++r) {
            const T f = A[r][i] / A[i][i];
            for (std::size_t j = i; j < n; ++j) A[r][j] -= f * A[i][j];
            b[r] -= f * b[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t j = i + 1; j < n; ++j) b[i] -= A[i][j] * b[j];
        b[i] /= A[i][i];
    }
    return b;
}

}  // namespace support
