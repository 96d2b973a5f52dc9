// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <vector>

#include "digits.hpp"
#include "revchain/rig.hpp"

/// What the files of the engine share: the system asked about, and the numbers that go in and out.
namespace web {

using revchain::Index;

extern std::vector<double> numbers;
extern std::optional<revchain::Rig> rig;
extern double gravity;

inline void put(double x) { numbers.push_back(x); }
template <class List>
void put_all(const List& list) {
    for (Index i = 0; i < static_cast<Index>(list.size()); ++i) put(static_cast<double>(list[i]));
}

/// The number of numbers in the answer that `ask` gives.
template <class Ask>
int answered(const Ask& ask) {
    numbers.clear();
    ask();
    return static_cast<int>(numbers.size());
}

}  // namespace web
