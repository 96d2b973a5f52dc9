// SPDX-License-Identifier: MPL-2.0
// What heights at an inclination are measured against: relation (12) of Greenhill (1908) §8 shot from the free end up in
// quadruple precision, which shares nothing with the library but the chain's stored numbers. The lowest link's inclination
// is given, and a height lambda: then its own moments put it at a distance from the axis, and every next link's inclination,
// t its tangent, is the one root of
//
//     lambda sigma t + W h (1 - l/a) t/sqrt(1 + t^2) = W (h/a) y + sum of W x below,     sigma = W h/a + weight below,
//
// y the offset of its lower pin, x that of a link's centre of gravity, l its equivalent pendulum length (l <= a here: one
// root, which Newton's method meets from one side). lambda is right where the support then lies on the axis. From the height
// of the mode at no inclination it is followed in small steps, and its nodes are counted.
#pragma once

#include <optional>

#include "support/truth.hpp"

namespace bench {

inline long double root_of(long double x) { return std::sqrt(x); }
inline support::Quad root_of(support::Quad x) { return sqrtq(x); }

class InclinedTruth {
   public:
    explicit InclinedTruth(const revchain::Chain<double>& chain) : rough_(chain), fine_(chain) {}

    /// The height of mode `mode` (from 1) at which the lowest link leans `inclination`, followed from `height` at none;
    /// nothing where that leads astray.
    std::optional<support::Quad> height(revchain::Index mode, support::Quad height, double inclination) const {
        for (int steps = 32; steps <= 2048; steps *= 4) {
            long double before = static_cast<long double>(height), now = before;
            bool found = true;
            for (int step = 1; step <= steps && found; ++step) {
                const long double t = std::tan(static_cast<long double>(inclination) * step / steps);
                const long double next = rough_.root(2 * now - before, t, 1e-15L);
                found = next > 0 && rough_.shot(next, t).nodes == mode - 1;
                before = now, now = next;
            }
            if (!found) continue;
            const support::Quad t = tanq(support::Quad(inclination)), root = fine_.root(now, t, support::Quad(1e-26));
            if (root > 0 && fine_.shot(root, t).nodes == mode - 1) return root;
        }
        return std::nullopt;
    }

   private:
    template <class S>
    struct Links {
        struct Link {
            S weight, length, share, sigma, excess;
        };
        struct Shot {
            S support{};
            revchain::Index nodes = 0;  ///< between the free end and the highest link's lower pin
        };
        std::vector<Link> links;

        explicit Links(const revchain::Chain<double>& chain) {
            S below = 0;
            for (revchain::Index m = 0; m < chain.size(); ++m) {
                const auto link = chain.link(m);
                const S W = link.weight, a = link.length, share = S(link.centroid) / a;
                const S ratio = S(link.gyration_ratio.high) + S(link.gyration_ratio.low);
                links.push_back({W, a, share, W * share + below, W * a * (share - share * share - ratio)});
                below += W;
            }
        }

        Shot shot(S lambda, S tangent) const {
            Shot result;
            S y = 0, pull = 0;
            for (std::size_t m = 0; m < links.size(); ++m) {
                const Link& link = links[m];
                const S held = lambda * link.sigma;
                S t = tangent;
                if (m == 0) {
                    y = (held * t + link.excess * t / root_of(1 + t * t)) / (link.weight * link.share);
                } else {
                    const S right = link.weight * link.share * y + pull;
                    t = right / (held + link.excess);
                    for (int i = 0; i < 60 && link.excess != 0; ++i) {
                        const S root = root_of(1 + t * t);
                        const S step =
                            (right - held * t - link.excess * t / root) / (held + link.excess / (root * root * root));
                        t += step;
                        if (step * step <= S(1e-34) * t * t) break;  // the next one would be 1e-34
                    }
                }
                const S above = y - link.length * t / root_of(1 + t * t);
                if (m + 1 < links.size() && (y < 0) != (above < 0)) ++result.nodes;
                pull += link.weight * (link.share * y + (1 - link.share) * above);
                y = above;
            }
            result.support = y;
            return result;
        }

        /// The secant method from two heights close to each other; 0 where it does not converge.
        S root(S near, S tangent, S tolerance) const {
            S x = near * (1 + S(1e-7)), fx = shot(x, tangent).support, y = near, fy = shot(y, tangent).support;
            for (int i = 0; i < 60; ++i) {
                if (fx == fy) return y;
                const S z = y - fy * (y - x) / (fy - fx), step = z > y ? z - y : y - z;
                x = y, fx = fy, y = z, fy = shot(y, tangent).support;
                if (step <= tolerance * y) return y;
            }
            return 0;
        }
    };

    Links<long double> rough_;
    Links<support::Quad> fine_;
};

}  // namespace bench
