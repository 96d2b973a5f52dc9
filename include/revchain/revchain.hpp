// SPDX-License-Identifier: MPL-2.0
#pragma once

// Chains, rigs, closed forms and the functions used most; needs Eigen only. These headers are left
// out, because they take long to compile: batch.hpp, branches.hpp, campbell.hpp, damped_modes.hpp,
// drag.hpp, explain.hpp, forced_motion.hpp, held.hpp, methods.hpp, rig_modes.hpp, stability.hpp,
// stability_windows.hpp, swing.hpp, transient.hpp and tune.hpp. Include the one that you need.
// Cords, ropes and the motion of governors are in revchain/analytic.hpp, which needs GSL.

#include "revchain/bell.hpp"                   // IWYU pragma: export
#include "revchain/buffer.hpp"                 // IWYU pragma: export
#include "revchain/chain.hpp"                  // IWYU pragma: export
#include "revchain/compound_link.hpp"          // IWYU pragma: export
#include "revchain/conical_pendulum.hpp"       // IWYU pragma: export
#include "revchain/count.hpp"                  // IWYU pragma: export
#include "revchain/gyrostatic_string.hpp"      // IWYU pragma: export
#include "revchain/hoop.hpp"                   // IWYU pragma: export
#include "revchain/modes.hpp"                  // IWYU pragma: export
#include "revchain/numeric/double_double.hpp"  // IWYU pragma: export
#include "revchain/recurrence.hpp"             // IWYU pragma: export
#include "revchain/response.hpp"               // IWYU pragma: export
#include "revchain/rig.hpp"                    // IWYU pragma: export
#include "revchain/sensitivity.hpp"            // IWYU pragma: export
#include "revchain/sleeve_governor.hpp"        // IWYU pragma: export
#include "revchain/statics.hpp"                // IWYU pragma: export
#include "revchain/steady_shapes.hpp"          // IWYU pragma: export
#include "revchain/two_links.hpp"              // IWYU pragma: export
