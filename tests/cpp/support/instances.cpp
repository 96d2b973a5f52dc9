// SPDX-License-Identifier: MPL-2.0
#include "support/instances.hpp"

template revchain::Modes<double> revchain::modes(const revchain::Chain<double>&,
                                                 const revchain::ModesOptions<double>&);
template revchain::Modes<long double> revchain::modes(const revchain::Chain<long double>&,
                                                      const revchain::ModesOptions<long double>&);
