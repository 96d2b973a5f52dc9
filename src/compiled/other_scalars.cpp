// SPDX-License-Identifier: MPL-2.0
// Scalars in which the Python module does not compute.
#include "revchain/questions/batch.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/questions/sensitivity.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Table<float> conical_heights(const ChainBatch<float>&, const BatchOptions&);
template Table<long double> conical_heights(const ChainBatch<long double>&, const BatchOptions&);
template Modes<float> modes(const Chain<float>&, const ModesOptions<float>&);
template Sensitivity<float> sensitivity(const Chain<float>&, const Modes<float>&);
template Uncertainty<float> uncertainty(const Sensitivity<float>&, const Vector<float>&, const Deviations<float>&);
template Sensitivity<long double> sensitivity(const Chain<long double>&, const Modes<long double>&);
template Uncertainty<long double> uncertainty(const Sensitivity<long double>&, const Vector<long double>&,
                                              const Deviations<long double>&);
}  // namespace revchain
