// SPDX-License-Identifier: MPL-2.0
// Counts, offsets and improved shifts of blocks against quadruple precision and against the links they stand for.
#include "revchain/pencil/condensed/pencil.hpp"

#include "revchain/linear/condensed_heights.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using namespace revchain;
using namespace revchain::pencil;
using support::Quad;
using support::quad;
using support::Random;
using V = Pack<double>;
using W = DoubleWord<V>;

namespace {

/// The pencil of blocks itself, in quadruple precision: how many eigenvalues exceed a shift.
Index exact_count(const CondensedPencil<double>& pencil, Quad shift) {
    Index negative = 0;
    Quad below = 0;
    const Quad z = -1 / shift;
    for (const auto& block : pencil.blocks) {
        const auto series = [&](const auto& coefficient) {
            Quad value = 0;
            for (std::size_t i = coefficient.size(); i-- > 0;) value = z * (Quad(coefficient[i]) + value);
            return value;
        };
        const Quad t = 1 + series(block.b);
        const Quad spring = shift * quad(block.stiffness) / t + quad(block.cross);
        const Quad hung = below - (quad(block.lower) + series(block.a)) / t;
        const Quad pivot = hung + spring;
        negative += pivot < 0 ? 1 : 0;
        below = spring * hung / pivot - (quad(block.upper) + series(block.d)) / t;
    }
    return negative;
}

/// Ordinary chains, and links that stand alone.
Chain<double> chain_of_kind(int kind, Index size, Random& random) {
    return support::chain_of(size, [&](Index m) -> Link<double> {
        const double w = random.between(0.5, 2), a = random.between(0.5, 2);
        if (kind == 0) return plummet<double>(w, a);
        if (kind == 1) return uniform_rod<double>(w, a);
        if (kind == 2) return uniform_rod<double>(random.log_between(1, 1e6), a * (m % 50 == 7 ? 1e3 : 1.0));
        return {m == 0 ? 2 * w : w / 4, a, a * (m == 0 ? 0.5 : random.between(-0.5, 1.8)),
                Wide<double>(random.between(0.01, 2))};
    });
}

W pack_of(const std::array<Wide<double>, pack_size>& x) {
    W result;
    for (std::size_t i = 0; i < pack_size; ++i) {
        result.high.set(i, x[i].high);
        result.low.set(i, x[i].low);
    }
    return result;
}

}  // namespace

TEST_CASE("products of packs are exact to 4 u^2, with and without FMA", "[blocks]") {
    Random random(61);
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        std::array<double, 4> x, y;
        V a, b;
        for (std::size_t k = 0; k < 4; ++k) {
            x[k] = random.between(1, 2), y[k] = random.between(1, 2);
            a.set(k, x[k]), b.set(k, y[k]);
        }
        const auto p = two_product(a, b);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(p.high[k] == x[k] * y[k]);
            const Quad exact = Quad(x[k]) * Quad(y[k]);
            worst = std::max(worst, std::abs(static_cast<double>((Quad(p.high[k]) + Quad(p.low[k])) / exact - 1)));
        }
    }
    CHECK(worst <= 0x1p-104);  // the product of the two lower halves is rounded
}

TEST_CASE("a block at a shift, in every kind of number", "[blocks]") {
    Random random(62);
    for (int kind = 0; kind < 4; ++kind) {
        const Chain<double> chain = chain_of_kind(kind, 500, random);
        const auto pencil = condensed_chain(chain, 20.0).pencil;
        for (const auto& block : pencil.blocks) {
            const Wide<double> shift = Wide<double>(random.log_between(20, 1e4)) + Wide<double>(1e-20 * random());
            const auto narrow = element_at(block, shift.high);
            const auto wide = element_at(block, shift);
            const auto pack = element_at(block, V(shift.high));
            const auto both = element_at(block, pack_of({shift, shift, shift, shift}));
            const double size = std::abs(wide.spring.high) + std::abs(block.cross.high);
            const double mass = std::abs(block.lower.high) + std::abs(block.upper.high);
            CHECK(std::abs(narrow.spring - wide.spring.high) <= 0x1p-50 * size);
            CHECK(std::abs(narrow.lower - wide.lower.high) <= 0x1p-51 * mass);
            CHECK(std::abs(narrow.upper - wide.upper.high) <= 0x1p-51 * mass);
            CHECK(std::abs(pack.spring[2] - narrow.spring) <=
                  0x1p-51 * size);  // where one fuses and the other does not
            CHECK(std::abs(pack.lower[2] - narrow.lower) <= 0x1p-52 * mass);
            // The corrections are made in T, alike but for fused sums.
            const auto difference = quad(Wide<double>(both.spring.high[1], both.spring.low[1])) - quad(wide.spring);
            CHECK(std::abs(static_cast<double>(difference)) <= 0x1p-56 * size);
        }
    }
}

TEST_CASE("counts on blocks are those on links, and those in quadruple precision", "[blocks]") {
    Random random(63);
    Index proved = 0, all = 0;
    for (int kind = 0; kind < 4; ++kind)
        for (int i = 0; i < 12; ++i) {
            const Chain<double> chain = chain_of_kind(kind, 260 + 30 * i, random);
            const auto condensed = condensed_chain(chain, random.log_between(1.0, 20.0));
            const auto& pencil = condensed.pencil;
            const support::Truth truth(chain);
            CAPTURE(kind, i, pencil.blocks.size());
            for (int k = 0; k < 10; ++k) {
                std::array<double, 5> shifts;
                std::array<Wide<double>, 4> first;
                for (double& shift : shifts) shift = pencil.least_shift * random.log_between(1.0, 1e3);
                std::copy_n(shifts.begin(), 4, first.begin());
                const auto quick = count_above(pencil, shifts);
                const auto sure = certified_count(pencil, pack_of(first));
                for (std::size_t j = 0; j < 5; ++j) {
                    const Index on_links = truth.above(Quad(shifts[j]) * Quad(condensed.unit_length));
                    CHECK(exact_count(pencil, shifts[j]) == on_links);
                    CHECK(quick[j] == on_links);
                    if (j == 4) continue;
                    ++all;
                    if (sure.proved[j] != 1) continue;
                    ++proved;
                    CHECK(static_cast<Index>(sure.above[j]) == on_links);
                }
            }
        }
    CHECK(proved * 100 >= all * 99);
}

// Right up to an eigenvalue of the blocks a count is proved to be that of quadruple precision, or not proved.
TEST_CASE("proved counts beside an eigenvalue", "[blocks]") {
    Random random(64);
    double nearest = 1;
    for (int kind = 0; kind < 4; ++kind)
        for (int i = 0; i < 4; ++i) {
            const Chain<double> chain = chain_of_kind(kind, 300, random);
            const auto condensed = condensed_chain(chain, 8.0);
            // Kept from corrections that each shift rounds anew: lumps alone, which are a chain as well.
            auto pencil = condensed.pencil;
            for (auto& block : pencil.blocks) block.a = {}, block.b = {}, block.d = {};
            const Index before = exact_count(pencil, 8.0);
            if (before == 0) continue;
            Quad lower = 8, upper = 1e6;
            while (upper - lower > 1e-31 * lower) {
                const Quad middle = (lower + upper) / 2;
                (exact_count(pencil, middle) >= before ? lower : upper) = middle;
            }
            for (double distance = 1e-31; distance < 1e-8; distance *= 10) {
                std::array<Wide<double>, 4> shifts;
                for (std::size_t j = 0; j < 4; ++j) {
                    const Quad at = lower * (1 + (j % 2 ? 1 : -1) * Quad(distance) * static_cast<double>(1 + j));
                    const double high = static_cast<double>(at);
                    shifts[j] = {high, static_cast<double>(at - Quad(high))};
                }
                const auto counts = certified_count(pencil, pack_of(shifts));
                for (std::size_t j = 0; j < 4; ++j) {
                    CAPTURE(kind, i, distance, j);
                    if (counts.proved[j] != 1) continue;
                    CHECK(static_cast<Index>(counts.above[j]) == exact_count(pencil, quad(shifts[j])));
                    nearest = std::min(nearest, distance);
                }
            }
        }
    CHECK(nearest < 1e-25);
    CHECK(nearest > 1e-31);
    WARN("proved as near as " << nearest);
}

TEST_CASE("improved shifts and offsets at the pins between blocks", "[blocks]") {
    Random random(65);
    double worst = 0, worst_offset = 0;
    for (int kind = 0; kind < 4; ++kind) {
        const Chain<double> chain = chain_of_kind(kind, 2000, random);
        const double least = revchain::detail::estimated_height(chain, 6);
        const auto condensed = condensed_chain(chain, least);
        const auto& pencil = condensed.pencil;
        const support::Truth truth(chain);
        const Quad unit = condensed.unit_length;
        const Index modes = std::min<Index>(truth.above(Quad(least) * unit), 4);
        REQUIRE(modes >= 1);
        for (Index j = 0; j < modes; ++j) {
            const Quad height = truth.height(j, Quad(least) * unit, Quad(chain.total_length()) * 1e3, 1e-27) / unit;
            V start(static_cast<double>(height) * (1 + 1e-6));
            auto shift = improved<V>(pencil, start).shift;
            auto fine = improved<W>(pencil, W(shift)).shift;
            fine = improved<W>(pencil, fine).shift;
            const double error = std::abs(static_cast<double>((Quad(fine.high[3]) + Quad(fine.low[3])) / height - 1));
            CAPTURE(kind, j, static_cast<double>(height));
            CHECK(error <= pencil.error + 1e-20);
            worst = std::max(worst, error / pencil.error);
            const auto offset = offsets_between(elements_at(pencil, fine));
            const auto shape = truth.shape(height * unit);
            CHECK(offset.size() == pencil.blocks.size() + 1);
            CHECK(offset.back().high[0] == 0);
            // Both scaled at the pin where the blocks' offsets are largest.
            std::size_t largest = 0;
            std::vector<Index> pin{0};
            for (const auto& block : pencil.blocks) pin.push_back(pin.back() + block.links);
            for (std::size_t b = 0; b < offset.size(); ++b)
                if (std::abs(offset[b].high[0]) > std::abs(offset[largest].high[0])) largest = b;
            const auto at = [&](std::size_t b) { return shape[static_cast<std::size_t>(pin[b])]; };
            for (std::size_t b = 0; b < offset.size(); ++b) {
                const Quad scaled = Quad(offset[b].high[0]) / Quad(offset[largest].high[0]) * at(largest);
                worst_offset = std::max(worst_offset, std::abs(static_cast<double>((scaled - at(b)) / at(largest))));
            }
        }
    }
    CHECK(worst <= 0.3);           // of the blocks' error
    CHECK(worst_offset <= 4e-16);  // of the largest
    WARN("heights " << worst << " of the blocks' error, offsets " << worst_offset);
}
