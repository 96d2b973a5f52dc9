// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Cords, ropes and governors, which rest on special functions. cord.hpp needs GSL: link
// revchain::analytic. A program that includes any of the three is under the GPL.

#include "revchain/cord.hpp"      // IWYU pragma: export
#include "revchain/governor.hpp"  // IWYU pragma: export
#include "revchain/rope.hpp"      // IWYU pragma: export
