// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/branch/branches.hpp"
#include "revchain/finite/branch/diagram.hpp"
