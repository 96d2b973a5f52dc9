// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/rig_swing.hpp"
#include "revchain/questions/swing.hpp"
