// SPDX-License-Identifier: MPL-2.0
// All eigenvalues to the last digit: quotients whose residual is evaluated to twice the digits.
#include "revchain/pencil/spectrum/refinement.hpp"

#include "revchain/linear/assembly.hpp"
#include "revchain/pencil/spectrum/interpolated.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::Quad;
namespace pencil = revchain::pencil;
namespace spectrum = revchain::pencil::spectrum;

namespace {

constexpr double ulp = 0x1p-52;

struct Exact {
    explicit Exact(const revchain::Chain<double>& chain)
        : assembled(revchain::assemble(chain)), truth(chain), unit(std::ldexp(1.0, assembled.units.length_exponent)) {}

    /// Eigenvalue number j, known to lie within `reach` of `value`, relative.
    Quad eigenvalue(Index j, double value, double reach) const {
        const Quad lower = Quad(value) * (1 - Quad(reach)) * unit, upper = Quad(value) * (1 + Quad(reach)) * unit;
        REQUIRE(truth.above(lower) > j);
        REQUIRE(truth.above(upper) <= j);
        return truth.height(j, lower, upper, 1e-26) / unit;
    }

    revchain::AssembledChain<double> assembled;
    support::Truth truth;
    Quad unit;
};

struct Worst {
    double error = 0, bound = 0;  // ulp
    double unrounded = 0;
};

/// Every `step`-th eigenvalue against quadruple precision; each has to lie within its bound.
Worst worst_of(const revchain::Chain<double>& chain, Index step = 1) {
    const Exact exact(chain);
    const Index total = chain.mode_count();
    const auto found = pencil::all_eigenvalues(exact.assembled.pencil, Index(0), total, total, 2 * ulp);
    REQUIRE(static_cast<Index>(found.size()) == total);
    Worst worst;
    for (Index j = 0; j < total; j += step) {
        const auto& c = found[static_cast<std::size_t>(j)];
        CAPTURE(j, c.eigenvalue, c.error_bound);
        REQUIRE(c.unrounded.high == c.eigenvalue);
        const Quad value = exact.eigenvalue(j, c.eigenvalue, 1.01 * c.error_bound);
        const double error = static_cast<double>(fabsq((Quad(c.eigenvalue) - value) / value));
        REQUIRE(error <= c.error_bound);
        worst.error = std::max(worst.error, error / ulp);
        worst.bound = std::max(worst.bound, c.error_bound / ulp);
        const double unrounded = static_cast<double>(fabsq(support::quad(c.unrounded) / value - 1));
        REQUIRE(unrounded <= c.error_bound - 0.4999999 * ulp);  // what the bound says beyond rounding
        worst.unrounded = std::max(worst.unrounded, unrounded);
    }
    return worst;
}

/// Plummets and rods, weights graded by up to 1e12, mixtures, heavy links between light ones, massless ones.
revchain::Chain<double> random_chain(support::Random& random, Index n) {
    const int kind = static_cast<int>(random() * 6);
    const double weights = std::pow(10.0, random.between(0, 12)), lengths = std::pow(10.0, random.between(0, 6));
    const Index period = 2 + static_cast<Index>(random() * 7);
    return support::chain_of(n, [&](Index m) {
        const double a = random.log_between(1, lengths), weight = random.log_between(1, weights);
        switch (kind) {
            case 0:
                return revchain::plummet<double>(weight, a);
            case 1:
                return revchain::uniform_rod<double>(weight, a);
            case 2:
                return revchain::uniform_rod<double>(support::graded(n - 1 - m, n, weights), 1.0);
            case 3:
                return revchain::plummet<double>(m % period == 0 ? weights : 1.0, 1.0);
            case 4:
                return revchain::plummet<double>(m % 3 == 1 ? 0.0 : weight, a);
            default:
                return revchain::compound_pendulum<double>({.weight = weight,
                                                            .length = a,
                                                            .centroid = a * random.between(0.3, 0.7),
                                                            .radius_of_gyration = a * random.between(0.0, 0.4)});
        }
    });
}

}  // namespace

TEST_CASE("all eigenvalues of every kind of chain are the nearest doubles", "[linalg]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 5, 17, 64, 200}) {
            const auto chain = family.make(n);
            const bool fit = n > 1 && spectrum::lumped(revchain::assemble(chain).pencil).fit;
            CAPTURE(family.name, n);
            const Worst worst = worst_of(chain, n > 100 ? 7 : 1);
            CHECK(worst.error <= 0.501);
            CHECK(worst.bound <= (fit ? 0.51 : 2.0001));
            CHECK(worst.unrounded <= 1e-20);
        }
    }
}

TEST_CASE("long chains to the last digit", "[linalg]") {
    for (const std::size_t family : {0u, 1u, 2u, 3u, 4u, 5u, 9u}) {
        const Worst worst = worst_of(support::families()[family].make(1500), 61);
        CAPTURE(family);
        CHECK(worst.error <= 0.501);
        CHECK(worst.bound <= 0.51);
        CHECK(worst.unrounded <= 1e-20);
    }
}

TEST_CASE("random chains to the last digit", "[linalg]") {
    support::Random random(1908);
    for (int i = 0; i < 300; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 40);
        CAPTURE(i, n);
        const Worst worst = worst_of(random_chain(random, n), 1 + n / 12);
        CHECK(worst.error <= 0.501);
        CHECK(worst.bound <= 2.0001);
        CHECK(worst.unrounded <= 1e-18);
    }
}

// Found by search: heavy plummets between light ones, where the vector itself is no better than 1e-9. The largest error
// before rounding that is known, 1.70e-18 of 1.84e-18 allowed.
TEST_CASE("a chain that takes the bound at its word", "[linalg]") {
    const std::vector<std::pair<double, double>> weight_and_length{
        {0x1.f03af7cb83d8ep+15, 0x1.18e08cdef6bf3p-30}, {0x1.f63ab82e497cep-37, 0x1.53c3d136dc394p-14},
        {0x1.88ea0b6bce0d8p-37, 0x1.c2f031dfafcdbp-12}, {0x1.7dc860957527p-38, 0x1.2b3e7fc3f73edp-9},
        {0x1.9aec318b061e4p-38, 0x1.8d28a859f9981p-7},  {0x1.407f51fb88b1cp-38, 0x1.078e50bd57dd2p-4},
        {0x1.1955742ef9fd2p+16, 0x1.5dcb0db5e63c9p-2},  {0x1.eeef06bf368c9p-37, 0x1.fd5c9c6d0ac3p-14},
        {0x1.e8a91a710b501p-38, 0x1.3413904e0d7afp3},   {0x1.d604a0a5bc8fap-38, 0x1.98e18ec445436p5},
        {0x1.6a6a070021e74p-38, 0x1.0f55b902b60cbp8},   {0x1.2f7de81a0d135p-37, 0x1.681e1009a5ae8p10},
        {0x1.78bbea8bf1c43p+16, 0x1.ddf34470b4f84p12},  {0x1.ed7de8d231d52p-37, 0x1.3d2b5d44346b1p15},
        {0x1.01bf3ec0fc1ccp-37, 0x1.cddb0cc1d3d29p3},   {0x1.0110a79e65946p-38, 0x1.1757e831e1c35p20},
        {0x1.39afd0a4176b8p-37, 0x1.72bf14ba8d5ddp22},
    };
    const auto chain = support::chain_of(static_cast<Index>(weight_and_length.size()), [&](Index m) {
        const auto& [weight, length] = weight_and_length[static_cast<std::size_t>(m)];
        return revchain::plummet<double>(weight, length);
    });
    // Element by element: assembled, even quadruple precision is 1e-19 off on this chain.
    const auto above = [&](Quad height) {
        Index count = 0;
        Quad below = 0, hung = 0;
        for (const auto& [weight, length] : weight_and_length) {
            hung += weight;
            const Quad spring = height * (hung / length), pulled = below - weight, pivot = pulled + spring;
            count += pivot < 0 ? 1 : 0;
            below = spring * pulled / pivot;
        }
        return count;
    };
    const auto assembled = revchain::assemble(chain);
    const Quad unit = std::ldexp(1.0, assembled.units.length_exponent);
    const Index total = chain.mode_count();
    const auto found = pencil::all_eigenvalues(assembled.pencil, Index(0), total, total, 2 * ulp);
    double worst = 0;
    for (Index j = 0; j < total; ++j) {
        const auto& c = found[static_cast<std::size_t>(j)];
        const Quad value = support::quad(c.unrounded) * unit;
        Quad lower = value * (1 - Quad(1e-15)), upper = value * (1 + Quad(1e-15));
        REQUIRE(above(lower) == j + 1);
        REQUIRE(above(upper) == j);
        while (upper - lower > value * 1e-26) (above((lower + upper) / 2) > j ? lower : upper) = (lower + upper) / 2;
        const double error = static_cast<double>(fabsq(value / lower - 1));
        CAPTURE(j, error);
        CHECK(error <= c.error_bound - 0.4999999 * ulp);
        worst = std::max(worst, error);
    }
    CHECK(worst > 1.7e-18);
    CHECK(worst <= 1.71e-18);
}

TEST_CASE("a range to the last digit", "[linalg]") {
    for (const std::size_t family : {0u, 1u, 2u, 3u}) {
        const auto chain = support::families()[family].make(300);
        const auto assembled = revchain::assemble(chain);
        const auto all = pencil::all_eigenvalues(assembled.pencil, Index(0), Index(300), Index(300), 2 * ulp);
        for (const auto& [first, last] : {std::pair<Index, Index>{0, 1}, {0, 4}, {37, 140}, {250, 300}, {299, 300}}) {
            const auto some = pencil::all_eigenvalues(assembled.pencil, first, last, Index(300), 2 * ulp);
            for (Index j = first; j < last; ++j) {
                CAPTURE(family, first, last, j);
                CHECK(some[static_cast<std::size_t>(j - first)].eigenvalue ==
                      all[static_cast<std::size_t>(j)].eigenvalue);
            }
        }
    }
}

TEST_CASE("what a fine quotient says of its errors is so", "[linalg]") {
    // At shifts at all distances from an eigenvalue, joined anywhere.
    support::Random random(21);
    double largest = 0;
    Index said = 0;
    for (int i = 0; i < 200; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 60);
        const auto chain = random_chain(random, n);
        const Exact exact(chain);
        const auto lumped = spectrum::lumped(exact.assembled.pencil);
        if (!lumped.fit) continue;
        const Index total = chain.mode_count();
        const auto all = pencil::all_eigenvalues(exact.assembled.pencil, Index(0), total, total, 2 * ulp);
        std::vector<double> shifts;
        std::vector<std::size_t> places;
        std::vector<Index> numbers;
        for (int s = 0; s < 16; ++s) {
            numbers.push_back(static_cast<Index>(random() * static_cast<double>(total)));
            const auto& c = all[static_cast<std::size_t>(numbers.back())];
            shifts.push_back((1 + std::pow(10.0, random.between(-17, -5))) / c.eigenvalue);
            places.push_back(static_cast<std::size_t>(random() * static_cast<double>(n)));
        }
        const auto fine = spectrum::fine_quotients_all(lumped, shifts, places, i % 2 == 0 ? 1 : 16);
        const auto rough = spectrum::quotients_all(lumped, shifts, places);
        for (std::size_t s = 0; s < shifts.size(); ++s) {
            const auto& q = fine[s];
            if (!(q.residual < 1)) continue;
            const std::size_t j = static_cast<std::size_t>(numbers[s]);
            const double value = all[j].eigenvalue;
            const double above = j > 0 ? all[j - 1].eigenvalue / value - 1 : 1;
            const double below = j + 1 < all.size() ? 1 - all[j + 1].eigenvalue / value : 1;
            const double gap = std::min(above, below) - 4 * ulp - 2 * q.residual;
            CAPTURE(i, n, s, shifts[s], q.excess, q.error, q.residual, gap);
            if (!(gap > 2 * std::abs(shifts[s] * value - 1))) continue;  // not its own, or hardly
            const Quad truth = exact.eigenvalue(numbers[s], value, 3 * ulp);
            const double error = static_cast<double>(fabsq((1 + Quad(q.excess)) / Quad(shifts[s]) / truth - 1));
            const double distance = static_cast<double>(fabsq(1 / Quad(shifts[s]) / truth - 1));
            CHECK(distance <= q.residual * 1.001 + q.error);
            const double bound = q.residual * q.residual / gap * 1.001 + q.error;
            CHECK(error <= bound + 1e-24);
            largest = std::max(largest, error / bound);
            ++said;
            if (rough[s].residual < 1e-9) {
                // Its vector may be a better one: joined at another pin, where other shifts share its packs.
                const double of_fine = q.residual < 1e-9 ? 0.0 : bound;
                CHECK(std::abs(rough[s].ratio - 1 - q.excess) <=
                      spectrum::rounding_quotient(lumped, shifts[s]) + 1e-18 / gap + of_fine);
            }
        }
    }
    CHECK(said > 2000);
    CHECK(largest > 0.5);  // nor is it said too carefully
}

TEST_CASE("products are exact in packs of every kind", "[linalg]") {
    support::Random random(5);
    for (int i = 0; i < 2000; ++i) {
        std::array<double, 8> x, y, high, low, split_high, split_low;
        for (std::size_t k = 0; k < 8; ++k) {
            x[k] = (random() - 0.5) * std::pow(2.0, random.between(-90, 90));
            y[k] = (random() - 0.5) * std::pow(2.0, random.between(-90, 90));
        }
        revchain::simd([&](auto registers) REVCHAIN_INLINED {
            using V = revchain::Pack<double, registers.doubles>;
            for (std::size_t k = 0; k < 8; k += V::size) {
                const V a = V::load(&x[k]), b = V::load(&y[k]);
                const auto p = revchain::two_product<registers.fused>(a, b);
                const auto q = revchain::two_product<false>(a, b);
                p.high.store(&high[k]), p.low.store(&low[k]);
                q.high.store(&split_high[k]), q.low.store(&split_low[k]);
            }
        });
        for (std::size_t k = 0; k < 8; ++k) {
            const Quad exact = Quad(x[k]) * Quad(y[k]);
            CHECK(Quad(high[k]) + Quad(low[k]) == exact);
            CHECK(fabsq(Quad(split_high[k]) + Quad(split_low[k]) - exact) <= fabsq(exact) * 0x1p-104);
        }
    }
}

TEST_CASE("the same without fused operations, two numbers to a register", "[linalg]") {
    using V = revchain::Pack<double, 2>;
    support::Random random(6);
    for (int i = 0; i < 60; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 60);
        const auto chain = random_chain(random, n);
        const auto assembled = revchain::assemble(chain);
        const auto lumped = spectrum::lumped(assembled.pencil);
        if (!lumped.fit) continue;
        const Index total = chain.mode_count();
        const auto all = pencil::all_eigenvalues(assembled.pencil, Index(0), total, total, 2 * ulp);
        std::array<double, spectrum::fine_packs * V::size> shifts;
        std::array<spectrum::FineQuotient, spectrum::fine_packs * V::size> found;
        std::vector<spectrum::FineWalk<V>> scratch;
        for (double& s : shifts)
            s = (1 + 1e-13 * random()) /
                all[static_cast<std::size_t>(random() * static_cast<double>(total))].eigenvalue;
        const std::size_t size = lumped.size();
        if (lumped.has_cross) {
            spectrum::fine_quotients<true, false>(lumped, shifts.data(), 0, size, 1, found.data(), scratch);
        } else {
            spectrum::fine_quotients<false, false>(lumped, shifts.data(), 0, size, 1, found.data(), scratch);
        }
        const std::vector<double> same(shifts.begin(), shifts.end());
        const auto expected = spectrum::fine_quotients_all(lumped, same, {}, 1);
        for (std::size_t s = 0; s < shifts.size(); ++s) {
            CAPTURE(i, n, s, found[s].excess, expected[s].excess, found[s].error, found[s].residual);
            if (!(expected[s].residual < 1e-9)) continue;
            CHECK(std::abs(found[s].excess - expected[s].excess) <=
                  found[s].error + expected[s].error + 1e-24 + 1e3 * expected[s].residual * expected[s].residual);
        }
    }
}
