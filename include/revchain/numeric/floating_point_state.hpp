// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cfenv>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// While an object of this class exists, no floating-point exception traps. Its destructor restores
/// the flags and traps of before, so flags raised in between are discarded. It is for code in which
/// infinities and NaNs are valid intermediate results: a NaN means that a proof has failed.
class FloatingPointStateGuard {
   public:
    /// If the platform cannot switch traps off, the guard only saves the state: the result of
    /// `feholdexcept` is ignored on purpose.
    FloatingPointStateGuard() { std::feholdexcept(&before_); }
    FloatingPointStateGuard(const FloatingPointStateGuard&) = delete;
    FloatingPointStateGuard& operator=(const FloatingPointStateGuard&) = delete;
    ~FloatingPointStateGuard() { std::fesetenv(&before_); }

   private:
    std::fenv_t before_{};
};

}  // namespace revchain::detail
