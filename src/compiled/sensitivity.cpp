// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/sensitivity.hpp"
#include "revchain/questions/rig_sensitivity.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Sensitivity<double> sensitivity(const Chain<double>&, const Modes<double>&);
template Uncertainty<double> uncertainty(const Sensitivity<double>&, const Vector<double>&, const Deviations<double>&);
}  // namespace revchain
