// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cfenv>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// While an object of this class exists, no floating-point flag is raised and nothing traps. It is
/// for code in which infinities and NaNs are valid results (no proof).
class FloatingPointStateGuard {
   public:
    FloatingPointStateGuard() { std::feholdexcept(&before_); }
    FloatingPointStateGuard(const FloatingPointStateGuard&) = delete;
    FloatingPointStateGuard& operator=(const FloatingPointStateGuard&) = delete;
    ~FloatingPointStateGuard() { std::fesetenv(&before_); }

   private:
    std::fenv_t before_{};
};

}  // namespace revchain::detail
