// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cfenv>

namespace revchain {

/// While this lives, nothing raises a floating-point flag or traps: for code whose infinities and NaNs are answers
/// ("nothing proved") and none of the caller's business.
class NoAlarms {
   public:
    NoAlarms() { std::feholdexcept(&before_); }
    NoAlarms(const NoAlarms&) = delete;
    NoAlarms& operator=(const NoAlarms&) = delete;
    ~NoAlarms() { std::fesetenv(&before_); }

   private:
    std::fenv_t before_{};
};

}  // namespace revchain
