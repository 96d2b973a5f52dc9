// SPDX-License-Identifier: MPL-2.0
// Included by the compiler into every test: `modes` of the built-in scalars, which every test would compile anew, is
// compiled once for each program, in instances.cpp.
#pragma once

#include "revchain/modes.hpp"

extern template revchain::Modes<double> revchain::modes(const revchain::Chain<double>&,
                                                        const revchain::ModesOptions<double>&);
extern template revchain::Modes<long double> revchain::modes(const revchain::Chain<long double>&,
                                                             const revchain::ModesOptions<long double>&);
