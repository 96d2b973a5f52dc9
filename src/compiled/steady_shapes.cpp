// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/shapes/steady_shapes.hpp"
