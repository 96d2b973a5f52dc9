// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/drag.hpp"
