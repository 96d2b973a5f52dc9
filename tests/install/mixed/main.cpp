// SPDX-License-Identifier: MPL-2.0
#include <cstdio>

#include "answers.hpp"

int main() {
    revchain::Vector<double> truth = plain();
    bool same = truth.size() > 1000;
    for (auto* build : {newer, linked}) {
        revchain::Vector<double> found = build();
        same = same && found.size() == truth.size() && (found - truth).cwiseAbs().maxCoeff() < 1e-12;
        truth.swap(found);
    }
    std::printf("%d numbers of three builds %s\n", static_cast<int>(truth.size()), same ? "agree" : "differ");
    return same ? 0 : 1;
}
