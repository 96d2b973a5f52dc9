// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/swing.hpp"
#include "revchain/questions/rig_swing.hpp"
