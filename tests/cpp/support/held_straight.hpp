// SPDX-License-Identifier: MPL-2.0
// Small motions of a chain held straight under a tension, assembled in quadruple precision.
#pragma once

#include <algorithm>
#include <vector>

#include "revchain/held.hpp"
#include "support/truth.hpp"

namespace support {

using revchain::Index;

/// Counts of its modes.
class TautCounts {
   public:
    /// `tension` at the upper end; supports on the axis.
    TautCounts(const revchain::Chain<double>& chain, double tension, const revchain::Support& lower = {},
               const revchain::Support& upper = {})
        : first_(lower.is_firm() ? 1 : 0), end_(chain.size() + (upper.is_firm() ? 0 : 1)) {
        const auto pins = static_cast<std::size_t>(chain.size()) + 1;
        for (std::vector<Quad>* numbers : {&stiffness_, &next_stiffness_, &mass_, &next_mass_}) numbers->resize(pins);
        Quad pull = tension;  // at the upper end of a link, from the uppermost on
        for (std::size_t m = pins - 1; m-- > 0;) {
            const auto link = chain.link(static_cast<Index>(m));
            const Quad W = link.weight, a = link.length, p = Quad(link.centroid) / a, q = 1 - p;
            const Quad turn = quad(link.gyration_ratio), k = (pull - W * q) / a;
            pull -= W;
            stiffness_[m] += k, stiffness_[m + 1] += k, next_stiffness_[m] = -k;
            mass_[m] += W * (p * p + turn), mass_[m + 1] += W * (q * q + turn), next_mass_[m] = W * (p * q - turn);
        }
        for (const bool above : {false, true}) {
            const revchain::Support& end = above ? upper : lower;
            if (end.is_firm()) continue;
            stiffness_[above ? pins - 1 : 0] += quad(end.stiffness);
            mass_[above ? pins - 1 : 0] += Quad(end.carriage_weight);
        }
    }

    /// How many heights exceed one: negative pivots of height K - M.
    Index operator()(Quad height) const {
        Index negative = 0;
        Quad pivot = 1, beside = 0;
        for (Index pin = first_; pin < end_; ++pin) {
            const auto m = static_cast<std::size_t>(pin);
            pivot = height * stiffness_[m] - mass_[m] - beside * beside / pivot;
            beside = height * next_stiffness_[m] - next_mass_[m];
            if (pivot < 0) ++negative;
        }
        return negative;
    }

    /// The largest force that offsets of the pins leave unbalanced, over the largest sum of forces at a pin.
    double unbalanced(Quad height, const revchain::Vector<double>& offset) const {
        Quad worst = 0, largest = 0;
        for (Index pin = first_; pin < end_; ++pin) {
            Quad force = 0, size = 0;
            const auto add = [&](Quad k, Quad mass, double y) {
                force += (height * k - mass) * y;
                size += (height * abs(k) + abs(mass)) * Quad(std::abs(y));
            };
            const auto m = static_cast<std::size_t>(pin);
            add(stiffness_[m], mass_[m], offset[pin]);
            if (pin > 0) add(next_stiffness_[m - 1], next_mass_[m - 1], offset[pin - 1]);
            if (pin + 1 < offset.size()) add(next_stiffness_[m], next_mass_[m], offset[pin + 1]);
            worst = std::max(worst, abs(force)), largest = std::max(largest, size);
        }
        return static_cast<double>(worst / largest);
    }

   private:
    static Quad abs(Quad x) { return x < 0 ? -x : x; }

    Index first_, end_;                                                // pins that move
    std::vector<Quad> stiffness_, next_stiffness_, mass_, next_mass_;  // of a pin, and of it and the next
};

}  // namespace support
