// SPDX-License-Identifier: MPL-2.0
#include "revchain/cord.hpp"
#include "revchain/finite/cord/shapes.hpp"
#include "revchain/finite/stability/cord.hpp"
