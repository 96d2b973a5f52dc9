// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/dense_reference.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<double> modes_dense(const Chain<double>&, const ModesOptions<double>&);
template Modes<double> modes_recurrence(const Chain<double>&, const ModesOptions<double>&);
}  // namespace revchain
