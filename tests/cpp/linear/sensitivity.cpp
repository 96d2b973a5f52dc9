// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/sensitivity.hpp"

#include <iostream>

#include "revchain/core/double_double.hpp"
#include "revchain/linear/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Datum;
using revchain::Index;
using support::Quad;

namespace {

/// Derivatives in quadruple precision and in the links' angles, which share nothing with the library's offsets: with
/// y_m = sum of a s over the links above, y^T M y = sum W (y_G^2 + rho^2 s^2) and y^T K y = sum (W h + a S) s^2, and pins
/// that move when a length does.
struct Angles {
    std::vector<std::array<Quad, 5>> by_link;  // by Datum
    std::vector<std::array<Quad, 5>> size;     // of the terms
};

Angles angles(const Chain<double>& chain, Quad lambda, const std::vector<Quad>& y) {
    const Index n = chain.size();
    std::vector<Quad> s, below{0}, centre, force{0};
    for (Index m = 0; m < n; ++m) {
        const auto link = chain.link(m);
        const auto i = static_cast<std::size_t>(m);
        s.push_back((y[i] - y[i + 1]) / link.length);
        centre.push_back(y[i + 1] + link.centroid * s[i]);
        below.push_back(below[i] + link.weight);
        force.push_back(force[i] + link.weight * centre[i]);
    }
    Quad stiffness = 0, above = 0;
    for (Index m = 0; m < n; ++m) {
        const auto i = static_cast<std::size_t>(m);
        stiffness += (Quad(chain.link(m).weight) * chain.link(m).centroid + chain.link(m).length * below[i]) * s[i] * s[i];
    }
    Angles result{std::vector<std::array<Quad, 5>>(s.size()), std::vector<std::array<Quad, 5>>(s.size())};
    for (Index m = n; m-- > 0;) {
        const auto i = static_cast<std::size_t>(m);
        const auto link = chain.link(m);
        const Quad W = link.weight, a = link.length, h = link.centroid, r2 = support::quad(link.gyration_ratio) * a * a;
        const Quad weight = centre[i] * centre[i] + r2 * s[i] * s[i], bears = lambda * (h * s[i] * s[i] + above);
        const Quad moves = 2 * s[i] * force[i], pulls = lambda * below[i] * s[i] * s[i];
        const Quad by_centre = 2 * W * s[i] * centre[i], by_pull = lambda * W * s[i] * s[i];
        const Quad turns = 2 * W * sqrtq(r2) * s[i] * s[i];
        result.by_link[i] = {weight - bears, moves - pulls, by_centre - by_pull, turns,
                             moves - pulls + (h * (by_centre - by_pull) + sqrtq(r2) * turns) / a};
        for (std::size_t d = 0; d < 5; ++d) result.by_link[i][d] /= stiffness;
        above += a * s[i] * s[i];
    }
    return result;
}

}  // namespace

TEST_CASE("every derivative is within its bound, and rounded once where it is not small", "[linear]") {
    for (const auto& family : support::families())
        for (const Index n : {1, 2, 3, 7, 30, 100}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.shapes = false});
            const auto found = revchain::sensitivity(chain, m);
            const support::Truth truth(chain);
            double worst = 0, slack = 0, wide = 0, largest_bound = 0;
            for (Index j = 0; j < m.size(); j += n > 30 ? 9 : 1) {
                const Quad h = m.conical_height[j];
                const Quad lambda = truth.height(j, h * (1 - Quad(1e-15)), h * (1 + Quad(1e-15)), 1e-32);
                const auto exact = angles(chain, lambda, truth.shape(lambda));
                for (std::size_t d = 0; d < 5; ++d) {
                    const auto& derivatives = found.by_datum[d];
                    Quad largest = 0;
                    for (const auto& link : exact.by_link) largest = fmaxq(largest, fabsq(link[d]));
                    for (Index i = 0; i < n; ++i) {
                        const Quad t = exact.by_link[static_cast<std::size_t>(i)][d];
                        const double off = static_cast<double>(fabsq(derivatives.value(j, i) - t));
                        const double bound = derivatives.error_bound(j, i);
                        if (largest > 0) {
                            wide = std::max(wide, off / static_cast<double>(largest));
                            largest_bound = std::max(largest_bound, (bound - 2.3e-16 * std::abs(derivatives.value(j, i))) / static_cast<double>(largest));
                        }
                        // truth's own rounding
                        const double left = static_cast<double>(largest) * 1e-19;
                        if (bound + left > 0) slack = std::max(slack, off / (bound + left));
                        if (std::abs(static_cast<double>(t)) > 1e-6 * static_cast<double>(largest))
                            worst = std::max(worst, off / std::abs(static_cast<double>(t)) / 0x1p-52);
                    }
                }
            }
            std::cout << family.name << " " << n << " ulp " << worst << " of largest " << wide << " bound " << largest_bound << " used " << slack << "\n";
        }
}
