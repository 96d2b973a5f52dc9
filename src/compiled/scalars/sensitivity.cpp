// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/sensitivity.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Sensitivity<float> sensitivity(const Chain<float>&, const Modes<float>&);
template Uncertainty<float> uncertainty(const Sensitivity<float>&, const Vector<float>&, const Deviations<float>&);
template Sensitivity<long double> sensitivity(const Chain<long double>&, const Modes<long double>&);
template Uncertainty<long double> uncertainty(const Sensitivity<long double>&, const Vector<long double>&,
                                              const Deviations<long double>&);
}  // namespace revchain
