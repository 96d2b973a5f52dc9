// SPDX-License-Identifier: MPL-2.0
// A whole chain in balance in quadruple precision, in Greenhill's letters and with nothing in common with the library:
// relation (12) of §8 differenced from link to link, an assembled tridiagonal Jacobian, Newton's method on the angles.
#pragma once

#include "revchain/chain.hpp"
#include "support/truth.hpp"

namespace support {

class QuadChain {
   public:
    explicit QuadChain(const revchain::Chain<double>& chain) {
        Quad below = 0;
        for (revchain::Index m = 0; m < chain.size(); ++m) {
            const auto link = chain.link(m);
            const Quad a = link.length, h = link.centroid, W = link.weight, rho2 = quad(link.gyration_ratio) * a * a;
            links_.push_back({W, a, h, h * h + rho2, W * h / a + below});
            below += W;
        }
    }

    /// The inclinations in balance at a conical height that lie next to some; empty where Newton's method goes astray.
    template <class Inclinations>
    std::vector<Quad> balanced(const Inclinations& start, Quad lambda) const {
        const std::size_t n = links_.size();
        std::vector<Quad> delta(n), y(n + 1), A(n), B(n), left(n), diagonal(n), upper(n);
        for (std::size_t m = 0; m < n; ++m) delta[m] = start[static_cast<revchain::Index>(m)];
        Quad last = 1;
        for (int round = 0; round < 30; ++round) {
            y[n] = 0;
            for (std::size_t m = n; m-- > 0;) y[m] = y[m + 1] + links_[m].a * sinq(delta[m]);
            Quad before = 0, weighed = 0, gain_low = 0, gain_high = 0;  // of the link below
            for (std::size_t m = 0; m < n; ++m) {
                const auto& [W, a, h, hl, sigma] = links_[m];
                const Quad c = cosq(delta[m]), p = h / a;
                const Quad local = W * p * y[m + 1] + W * hl / a * sinq(delta[m]) - lambda * sigma * tanq(delta[m]);
                A[m] = W * hl / (a * a) - lambda * sigma / (a * c * c * c), B[m] = W * p - A[m];
                left[m] = weighed + local - before;
                diagonal[m] = gain_high + A[m] - gain_low, upper[m] = B[m];
                before = local;
                weighed = W * (p * y[m] + (1 - p) * y[m + 1]);
                gain_high = W * (1 - p), gain_low = B[m];
            }
            for (std::size_t m = 1; m < n; ++m) {
                const Quad share = upper[m - 1] / diagonal[m - 1];
                diagonal[m] -= share * upper[m - 1], left[m] -= share * left[m - 1];
            }
            Quad worst = 0, above = 0;
            for (std::size_t m = n; m-- > 0;) {
                const Quad dy = (-left[m] - (m + 1 < n ? upper[m] * above : Quad(0))) / diagonal[m];
                const Quad change = (dy - above) / (links_[m].a * cosq(delta[m]));
                delta[m] += change, above = dy;
                worst = fmaxq(worst, fabsq(change));
            }
            if (!(worst < Quad(0.1))) return {};
            if (worst < 1e-20 || (worst < 1e-17 && worst > last / 4)) return delta;
            last = worst;
        }
        return {};
    }

   private:
    struct Link {
        Quad W, a, h, hl, sigma;
    };
    std::vector<Link> links_;
};

}  // namespace support
