// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/branch/branches.hpp"
