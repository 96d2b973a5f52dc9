// SPDX-License-Identifier: MPL-2.0
#include "revchain/system/column.hpp"

#include "revchain/chain.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_scalar.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::Wide;
using support::quad;
using support::Quad;

namespace {

__extension__ using Integer = __int128;

/// Whole numbers of up to 24 bits times 2^0 ... 2^20: in every scalar exact, and their sums in 128 bits.
template <class T>
struct Weights {
    std::vector<T> weight;
    std::vector<Integer> below{0};
    explicit Weights(Index count, unsigned seed) {
        support::Random random(seed);
        for (Index m = 0; m < count; ++m) {
            const auto digits = static_cast<long>(random.between(1, 0x1p24 - 1));
            const auto exponent = static_cast<int>(random.between(0, 21));
            weight.push_back(static_cast<T>(std::ldexp(static_cast<double>(digits), exponent)));
            below.push_back(below.back() + (static_cast<Integer>(digits) << exponent));
        }
    }
};

template <class T>
Quad to_quad(const T& x) {
    return quad(x);
}
Quad to_quad(const support::QuadScalar& x) { return x.value(); }

}  // namespace

TEMPLATE_TEST_CASE("partial weights are right to a rounding", "[chain]", float, double, long double,
                   support::QuadScalar) {
    using T = TestType;
    double worst = 0;
    for (const Index size : {1, 2, 15, 16, 17, 255, 256, 257, 511, 512, 513, 5000}) {
        const Weights<T> exact(size, static_cast<unsigned>(size));
        const revchain::Chain<T> chain(size, exact.weight, T(1), T(1), Wide<T>(T(0)));
        for (Index m = 0; m <= size; ++m) {
            const Quad truth = static_cast<Quad>(exact.below[static_cast<std::size_t>(m)]);
            const Quad found = to_quad(chain.weight_below(m));
            if (m == 0) CHECK(found == 0);
            if (m > 0) worst = std::max(worst, static_cast<double>(fabsq(found / truth - 1)));
            if (m % revchain::detail::segment_size == 0)
                CHECK(chain.partial_weights()[static_cast<std::size_t>(m / revchain::detail::segment_size)] ==
                      chain.weight_below(m));
        }
        CHECK(chain.partial_weights().size() == static_cast<std::size_t>((size + 255) / 256 + 1));
        CHECK(chain.partial_weights().back() == chain.weight_below(size));
    }
    CHECK(worst == 0);  // these sums fit in two words
}

// Numbers with all their digits, whose sums do not fit: compared with a compensated sum in quadruple precision.
TEMPLATE_TEST_CASE("partial weights that do not fit", "[chain]", float, double) {
    using T = TestType;
    double worst = 0;
    for (const double span : {1.0, 1e3, 1e30}) {
        support::Random random(7);
        std::vector<T> weight;
        const Index size = 100'000;
        for (Index m = 0; m < size; ++m)
            weight.push_back(static_cast<T>(random.log_between(1 / std::sqrt(span), 2 * std::sqrt(span))));
        const revchain::Chain<T> chain(size, weight, T(1), T(1), Wide<T>(T(0)));
        Quad sum = 0, rest = 0;
        for (Index m = 0; m <= size; ++m) {
            if (m > 0 && (m % 256 == 0 || m % 97 == 0 || m == size)) {
                const double error = static_cast<double>(fabsq(((quad(chain.weight_below(m)) - sum) - rest) / sum));
                worst = std::max(worst, error);
            }
            if (m == size) break;
            const Quad x = weight[static_cast<std::size_t>(m)], s = sum + x, v = s - sum;
            rest += (sum - (s - v)) + (x - v);
            sum = s;
        }
    }
    CAPTURE(worst / static_cast<double>(revchain::operation_error<Wide<T>>()));
    CHECK(worst <= (sizeof(T) == 4 ? 1.7 : 0.27) * static_cast<double>(revchain::operation_error<Wide<T>>()));
}

TEST_CASE("one weight for all links is multiplied", "[chain]") {
    const revchain::Chain<double> chain(1'000'000'000'000, 0.1, 0.2, 0.2, Wide<double>(0));
    CHECK(chain.partial_weights().empty());
    CHECK(quad(chain.weight_below(999'999'999'999)) == Quad(0.1) * Quad(999'999'999'999));
    CHECK(revchain::Chain<float>(1'000'000'000, 0.1F, 0.2F, 0.2F, 0.0).weight_below(999'999'999) ==
          static_cast<double>(0.1F) * 999'999'999);
}

TEST_CASE("a summary says what the numbers are", "[chain]") {
    support::Random random(3);
    for (const Index count : {1, 3, 16, 255, 256}) {
        std::vector<double> x;
        for (Index m = 0; m < count; ++m) x.push_back(random.between(-1, 1));
        const auto found = revchain::detail::summary(x.data(), count);
        CHECK(found.least == *std::min_element(x.begin(), x.end()));
        CHECK(found.most == std::max(*std::max_element(x.begin(), x.end()), -found.least));
        for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
            for (std::size_t m = 0; m < x.size(); ++m) {
                auto broken = x;
                broken[m] = bad;
                CHECK_FALSE(isfinite(revchain::detail::summary(broken.data(), count).sum));
            }
    }
}

TEST_CASE("a chain of borrowed numbers is the same chain", "[chain]") {
    const std::vector<double> weight{1, 0.1, 3e-7, 2}, length{0.5, 2, 1, 0.25};
    using Column = revchain::Column<double>;
    const auto borrowed = Column::borrowed(weight.data(), weight.size());
    CHECK(borrowed == Column(weight));
    CHECK(borrowed.data() == weight.data());
    CHECK(borrowed.stored() == 4);
    CHECK_FALSE(borrowed.is_scalar());
    CHECK_FALSE(borrowed == Column(1.0));
    const auto copy = borrowed;
    CHECK(copy[2] == 3e-7);
    const revchain::Wide<double> none(0.0);
    const revchain::Chain<double> lent(4, borrowed, length, length, none), own(4, weight, length, length, none);
    CHECK(lent == own);
    CHECK(lent.total_weight() == own.total_weight());
    CHECK_THROWS_AS(revchain::Chain<double>(5, borrowed, 1.0, 1.0, none), revchain::InvalidArgument);
}
