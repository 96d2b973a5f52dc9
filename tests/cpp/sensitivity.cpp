// SPDX-License-Identifier: MPL-2.0
#include "revchain/sensitivity.hpp"

#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/questions/modes.hpp"  // also for double-double
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
    std::array<Quad, 5> size;                  // the largest sum of the sizes of an entry's terms
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
        stiffness +=
            (Quad(chain.link(m).weight) * chain.link(m).centroid + chain.link(m).length * below[i]) * s[i] * s[i];
    }
    Angles result{std::vector<std::array<Quad, 5>>(s.size()), {}};
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
        const std::array<Quad, 5> size{weight + fabsq(bears), fabsq(moves) + pulls, fabsq(by_centre) + by_pull, turns,
                                       fabsq(moves) + pulls + (fabsq(h * by_centre) + sqrtq(r2) * turns) / a};
        for (std::size_t d = 0; d < 5; ++d) {
            result.by_link[i][d] /= stiffness;
            result.size[d] = fmaxq(result.size[d], size[d] / stiffness);
        }
        above += a * s[i] * s[i];
    }
    return result;
}

/// The exact height number j (from 0) of a chain.
Quad exact_height(const support::Truth& truth, Index j, double near) {
    return truth.height(j, Quad(near) * (1 - Quad(1e-15)), Quad(near) * (1 + Quad(1e-15)), 1e-32);
}

}  // namespace

TEST_CASE("every derivative is within its bound, and rounded once where it is not small", "[linear]") {
    double ulp = 0, beyond = 0;
    for (const auto& family : support::families())
        for (const Index n : {1, 2, 3, 7, 30, 100}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            const auto found = revchain::sensitivity(chain, m);
            const support::Truth truth(chain);
            CAPTURE(family.name, n);
            for (Index j = 0; j<m.size(); j += n> 30 ? 9 : 1) {
                const Quad lambda = exact_height(truth, j, m.conical_height[j]);
                const auto exact = angles(chain, lambda, truth.shape(lambda));
                for (std::size_t d = 0; d < 5; ++d) {
                    const auto& derivatives = found.by_datum[d];
                    const double size = static_cast<double>(exact.size[d]);
                    for (Index i = 0; i < n; ++i) {
                        const Quad t = exact.by_link[static_cast<std::size_t>(i)][d];
                        const double off = static_cast<double>(fabsq(derivatives.value(j, i) - t));
                        const double bound = derivatives.error_bound(j, i), entry = std::abs(derivatives.value(j, i));
                        CAPTURE(j, i, d, entry);
                        CHECK(off <= bound + size * 1e-19);  // the truth's own rounding
                        CHECK(bound <= 1.01 * 0x1p-52 * entry + 1e-12 * size);
                        beyond = std::max(beyond, (bound - 1.01 * 0x1p-52 * entry) / size);
                        if (entry > 1e-3 * size) ulp = std::max(ulp, off / entry / 0x1p-52);
                    }
                }
            }
        }
    CAPTURE(ulp, beyond);
    CHECK(ulp <= 0.51);
    CHECK(beyond <= 4e-15);  // two plummets of weights 1 and 1e12, whose heights are 1e-6 apart
}

TEST_CASE("derivatives are what central differences in double-double say, to 1e-12", "[linear]") {
    using revchain::DoubleDouble;
    const auto chain = support::families()[7].make(9);  // rigid bodies, centroids above their pins among them
    const auto found = revchain::sensitivity(chain, revchain::modes(chain, {.count = revchain::all_modes}));
    std::vector<revchain::Link<DoubleDouble>> links;
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        links.push_back({link.weight, link.length, link.centroid, DoubleDouble(link.gyration_ratio)});
    }
    // A relative step of 1e-10: truncation 1e-20, rounding 1e-28/1e-10.
    const auto moved = [&](Index m, Datum datum, double by) {
        auto some = links;
        auto& link = some[static_cast<std::size_t>(m)];
        const DoubleDouble factor = DoubleDouble(1) + DoubleDouble(by);
        switch (datum) {
            case Datum::weight:
                link.weight *= factor;
                break;
            case Datum::centroid:
                link.centroid *= factor;
                break;
            case Datum::radius_of_gyration:
                link.gyration_ratio *= factor * factor;
                break;
            case Datum::length:
                link.length *= factor, link.gyration_ratio /= factor * factor;
                break;
            case Datum::length_in_proportion:
                link.length *= factor, link.centroid *= factor;
        }
        return revchain::modes(Chain<DoubleDouble>(some), {.count = revchain::all_modes}).conical_height;
    };
    for (std::size_t d = 0; d < 5; ++d)
        for (Index m = 0; m < chain.size(); ++m) {
            const Datum datum = static_cast<Datum>(d);
            const auto up = moved(m, datum, 1e-10), down = moved(m, datum, -1e-10);
            const auto link = chain.link(m);
            const double x = datum == Datum::weight               ? link.weight
                             : datum == Datum::centroid           ? link.centroid
                             : datum == Datum::radius_of_gyration ? revchain::radius_of_gyration(link)
                                                                  : link.length;
            for (Index j = 0; j < chain.size(); ++j) {
                const double difference = static_cast<double>((up[j] - down[j]) / DoubleDouble(2e-10)) / x;
                const double largest = found.by_datum[d].value.row(j).cwiseAbs().maxCoeff();
                CAPTURE(d, m, j);
                CHECK(std::abs(found.by_datum[d].value(j, m) - difference) <= 3e-16 * largest);
            }
        }
}

TEST_CASE("weights act by their ratios, lengths by their unit, and no link made longer as a whole lowers a height",
          "[linear]") {
    for (const auto& family : support::families())
        for (const Index n : {1, 5, 300}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            const auto found = revchain::sensitivity(chain, m);
            CAPTURE(family.name, n);
            for (Index j = 0; j<m.size(); j += n> 100 ? 37 : 1) {
                double weights = 0, weight_sizes = 0, lengths = 0, length_sizes = 0, shares = 0;
                for (Index i = 0; i < n; ++i) {
                    const auto link = chain.link(i);
                    const double w = link.weight * found.weight().value(j, i);
                    weights += w, weight_sizes += std::abs(w);
                    for (const double x :
                         {link.length * found.length().value(j, i), link.centroid * found.centroid().value(j, i),
                          revchain::radius_of_gyration(link) * found.radius_of_gyration().value(j, i)})
                        lengths += x, length_sizes += std::abs(x);
                    shares += link.length * found.length_in_proportion().value(j, i);
                    CHECK(found.length_in_proportion().value(j, i) >= 0);
                    CHECK(found.radius_of_gyration().value(j, i) >= 0);
                }
                CHECK(std::abs(weights) <=
                      4e-16 * (1 + 0.02 * static_cast<double>(n)) * (weight_sizes + 1e-15 * m.conical_height[j]));
                CHECK(std::abs(lengths - m.conical_height[j]) <=
                      4e-16 * (1 + 0.02 * static_cast<double>(n)) * length_sizes);
                CHECK(std::abs(shares / m.conical_height[j] - 1) <= 4e-16 * (1 + 0.02 * static_cast<double>(n)));
                CHECK(found.length().value(j, 0) == 0);
            }
        }
}

TEST_CASE("heights given in few digits, in any unit, for some modes: the same derivatives", "[linear]") {
    const auto chain = support::families()[6].make(12);
    const auto all = revchain::modes(chain, {.count = revchain::all_modes});
    const auto found = revchain::sensitivity(chain, all);
    auto some = revchain::modes(chain, {.first = 3, .count = 1, .rtol = 1e-5});
    some.conical_height[0] *= 1 + 1e-6;
    const auto alone = revchain::sensitivity(chain, some);
    for (std::size_t d = 0; d < 5; ++d)
        for (Index m = 0; m < chain.size(); ++m)
            CHECK(std::abs(alone.by_datum[d].value(0, m) - found.by_datum[d].value(2, m)) <=
                  alone.by_datum[d].error_bound(0, m) + found.by_datum[d].error_bound(2, m));
    // units: lengths times 2^300, weights over 2^400
    const auto scaled = support::chain_of(12, [&](Index m) {
        auto link = chain.link(m);
        link.weight = std::ldexp(link.weight, -400);
        link.length = std::ldexp(link.length, 300), link.centroid = std::ldexp(link.centroid, 300);
        return link;
    });
    const auto other = revchain::sensitivity(scaled, revchain::modes(scaled, {.count = revchain::all_modes}));
    for (Index j = 0; j < 12; ++j)
        for (Index m = 0; m < 12; ++m) {
            CHECK(other.weight().value(j, m) == std::ldexp(found.weight().value(j, m), 700));
            CHECK(other.length().value(j, m) == found.length().value(j, m));
        }
}

TEST_CASE("what no derivative can be told of says so", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(3);
    auto m = revchain::modes(chain, {.count = revchain::all_modes});
    m.conical_height[1] *= 3;  // near no height
    const auto found = revchain::sensitivity(chain, m);
    CHECK(std::isinf(found.weight().error_bound(1, 0)));
    CHECK(std::isfinite(found.weight().error_bound(0, 0)));
    const auto apart =
        support::chain_of(2, [](Index i) { return revchain::plummet<double>(i == 0 ? 1e-80 : 1e80, 1.0); });
    CHECK_THROWS_AS(revchain::sensitivity(apart, revchain::modes(apart, {.count = revchain::all_modes})),
                    revchain::InvalidArgument);
    CHECK(revchain::sensitivity(chain, revchain::modes(chain, {.conical_height = {{100, 200}}})).size() == 0);
}
