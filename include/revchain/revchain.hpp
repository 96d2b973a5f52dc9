// SPDX-License-Identifier: MPL-2.0
#pragma once

// Everything that needs Eigen alone, but for what solves dense eigenproblems, which costs seconds of compile time:
// revchain/linear/reference.hpp, rig_modes.hpp and revchain/finite/stability.hpp, stability_windows.hpp,
// held_stability.hpp, revchain/scene/models/with_dense.hpp. What needs GSL is in revchain/analytic.hpp.

#include "revchain/chain/attached.hpp"            // IWYU pragma: export
#include "revchain/chain/chain.hpp"               // IWYU pragma: export
#include "revchain/chain/rig.hpp"                 // IWYU pragma: export
#include "revchain/core/carried_support.hpp"      // IWYU pragma: export
#include "revchain/core/conical_pendulum.hpp"     // IWYU pragma: export
#include "revchain/core/double_double.hpp"        // IWYU pragma: export
#include "revchain/core/hoop.hpp"                 // IWYU pragma: export
#include "revchain/core/inclined_pendulum.hpp"    // IWYU pragma: export
#include "revchain/finite/branches.hpp"           // IWYU pragma: export
#include "revchain/finite/continuous_chain.hpp"   // IWYU pragma: export
#include "revchain/finite/force_diagram.hpp"      // IWYU pragma: export
#include "revchain/finite/funicular_polygon.hpp"  // IWYU pragma: export
#include "revchain/finite/held_chain.hpp"         // IWYU pragma: export
#include "revchain/finite/held_cord.hpp"          // IWYU pragma: export
#include "revchain/finite/jointed_links.hpp"      // IWYU pragma: export
#include "revchain/finite/rig_shapes.hpp"         // IWYU pragma: export
#include "revchain/finite/shape_on_branch.hpp"    // IWYU pragma: export
#include "revchain/finite/steady_shapes.hpp"      // IWYU pragma: export
#include "revchain/finite/two_links.hpp"          // IWYU pragma: export
#include "revchain/linear/bell_and_clapper.hpp"   // IWYU pragma: export
#include "revchain/linear/buffer_impact.hpp"      // IWYU pragma: export
#include "revchain/linear/count.hpp"              // IWYU pragma: export
#include "revchain/linear/jointed_links.hpp"      // IWYU pragma: export
#include "revchain/linear/modes.hpp"              // IWYU pragma: export
#include "revchain/linear/recurrence.hpp"         // IWYU pragma: export
#include "revchain/linear/response.hpp"           // IWYU pragma: export
#include "revchain/linear/rig_sensitivity.hpp"    // IWYU pragma: export
#include "revchain/linear/sensitivity.hpp"        // IWYU pragma: export
#include "revchain/linear/small_oscillation.hpp"  // IWYU pragma: export
#include "revchain/linear/string_of_weights.hpp"  // IWYU pragma: export
#include "revchain/linear/tune.hpp"               // IWYU pragma: export
#include "revchain/linear/two_links.hpp"          // IWYU pragma: export
#include "revchain/linear/uncertainty.hpp"        // IWYU pragma: export
#include "revchain/scene/explain.hpp"             // IWYU pragma: export
#include "revchain/scene/models/heights.hpp"      // IWYU pragma: export
