// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/stability/cord.hpp"
#include "revchain/finite/cord/branch_shapes.hpp"
#include "revchain/finite/cord/steady_shapes.hpp"
