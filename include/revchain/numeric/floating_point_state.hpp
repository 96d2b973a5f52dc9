// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cfenv>

namespace revchain {

/// While this lives, nothing raises a floating-point flag or traps: for code whose infinities and NaNs are answers
/// ("nothing proved") and none of the caller's business.
class FloatingPointStateGuard {
   public:
    FloatingPointStateGuard() { std::feholdexcept(&before_); }
    FloatingPointStateGuard(const FloatingPointStateGuard&) = delete;
    FloatingPointStateGuard& operator=(const FloatingPointStateGuard&) = delete;
    ~FloatingPointStateGuard() { std::fesetenv(&before_); }

   private:
    std::fenv_t before_{};
};

}  // namespace revchain
