// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The theories that rest on special functions; needs GSL (link revchain::analytic), and makes a
// program GPL.

#include "revchain/cord.hpp"      // IWYU pragma: export
#include "revchain/governor.hpp"  // IWYU pragma: export
#include "revchain/rope.hpp"      // IWYU pragma: export
