// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/forced_motion.hpp"
