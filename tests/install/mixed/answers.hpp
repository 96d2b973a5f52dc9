// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <revchain/numeric/scalar.hpp>

/// Answers of the library to some questions, by three builds of it. The vectors are made by one and freed by another.
revchain::Vector<double> newer(), plain(), linked();
