// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/core/scalar.hpp"
#include "revchain/core/status.hpp"

namespace revchain::detail {

/// Refuses weights on a string that are not positive, and places, both supports among them, that do not increase.
template <Real T>
void check_string(std::string_view where, const Vector<T>& weight, const Vector<T>& place) {
    using std::isfinite;
    if (place.size() != weight.size() + 2)
        refuse(where, "places must be two more than weights: both supports and every weight", place.size());
    for (Index j = 0; j < weight.size(); ++j) require_positive(where, "weight", weight[j]);
    for (Index j = 0; j < place.size(); ++j)
        if (!isfinite(place[j]) || (j > 0 && !(place[j - 1] < place[j])))
            refuse(where, "places must be finite and increase, place " + std::to_string(j) + " too", place[j]);
}

}  // namespace revchain::detail
