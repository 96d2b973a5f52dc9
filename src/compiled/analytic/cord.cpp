// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/analytic/cord.hpp"
#include "revchain/analytic/cord_sensitivity.hpp"
#include "revchain/analytic/cord_swing.hpp"
