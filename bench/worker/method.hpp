// SPDX-License-Identifier: MPL-2.0
// A method is a name, what it is for, and a function from the raw chain to the heights. To add one, append it in the
// register_... function of its header.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "worker/raw_chain.hpp"

namespace bench {

/// Conical heights, slowest mode first; reference values have a second part, the rest beyond double.
struct Heights {
    std::vector<std::vector<double>> parts{1};

    void clear() {
        for (auto& part : parts) part.clear();
    }
    void push_back(double high, double low) {
        parts.resize(2);
        parts[0].push_back(high), parts[1].push_back(low);
    }
    void push_back(double x) { parts[0].push_back(x); }
    std::size_t size() const { return parts[0].size(); }
};

struct Method {
    std::string name;
    std::string family;          ///< revchain, baseline (our own direct method), LAPACK, Eigen, Spectra
    std::string kinds;           ///< letters of make_raw
    std::size_t largest;         ///< N beyond which it takes too long or too much memory to be of interest
    std::string which = "any";   ///< "few": up to ten modes of more links; "all": computes all, whatever is asked
    bool has_tolerance = false;  ///< takes rtol (0: none asked)
    /// (chain, count, rtol, heights): from the raw array to the `count` slowest heights; everything in it is timed.
    std::function<void(const RawChain&, std::size_t, double, Heights&)> run;
};

/// A peer that this build lacks, and why: it is named in the results, never left out silently.
struct Missing {
    std::string name;
    std::string reason;
};

struct Registry {
    std::vector<Method> methods;
    std::vector<Missing> missing;
};

}  // namespace bench
