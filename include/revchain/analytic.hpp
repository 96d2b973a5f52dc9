// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The theories that rest on special functions; needs GSL (link revchain::analytic), and makes a program GPL.

#include "revchain/analytic/governor.hpp"       // IWYU pragma: export
#include "revchain/analytic/heavy_chain.hpp"    // IWYU pragma: export
#include "revchain/analytic/skipping_rope.hpp"  // IWYU pragma: export
#include "revchain/analytic/tapered_chain.hpp"  // IWYU pragma: export
#include "revchain/analytic/tip_mass.hpp"       // IWYU pragma: export
#include "revchain/analytic/tortuous_rope.hpp"  // IWYU pragma: export
