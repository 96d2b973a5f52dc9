// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/sensitivity.hpp"
#include "revchain/questions/rig_sensitivity.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Sensitivity<float> sensitivity(const Chain<float>&, const Modes<float>&);
template Uncertainty<float> uncertainty(const Sensitivity<float>&, const Vector<float>&, const Deviations<float>&);
template Sensitivity<double> sensitivity(const Chain<double>&, const Modes<double>&);
template Uncertainty<double> uncertainty(const Sensitivity<double>&, const Vector<double>&, const Deviations<double>&);
template Sensitivity<long double> sensitivity(const Chain<long double>&, const Modes<long double>&);
template Uncertainty<long double> uncertainty(const Sensitivity<long double>&, const Vector<long double>&,
                                              const Deviations<long double>&);
}  // namespace revchain
