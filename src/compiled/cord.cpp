// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/cord/shapes.hpp"
#include "revchain/finite/stability/cord.hpp"
