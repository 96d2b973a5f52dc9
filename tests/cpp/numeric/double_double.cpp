// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/double_double.hpp"

#include <sstream>

#include "revchain/conical_pendulum.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::DoubleDouble;
using support::Quad;

namespace {
const Quad pi = strtoflt128("3.14159265358979323846264338327950288419717", nullptr);
Quad quad(const DoubleDouble& x) { return Quad(x.high()) + Quad(x.low()); }
double relative(Quad got, Quad want) { return static_cast<double>(fabsq((got - want) / want)); }
}  // namespace

TEST_CASE("two doubles are a scalar", "[core]") {
    STATIC_REQUIRE(revchain::Real<DoubleDouble>);
    STATIC_REQUIRE(std::is_same_v<revchain::Wide<DoubleDouble>, DoubleDouble>);
    STATIC_REQUIRE(std::is_same_v<revchain::Narrow<DoubleDouble>, DoubleDouble>);
    CHECK(relative(quad(std::numbers::pi_v<DoubleDouble>), pi) <= 2e-32);
    CHECK(relative(quad(revchain::conical_pendulum::period(DoubleDouble(1), DoubleDouble(1))), 2 * pi) <= 2e-32);
}

TEST_CASE("built-in numbers become two doubles without loss", "[core]") {
    for (const std::int64_t x : {std::int64_t(0), std::int64_t(-1), INT64_MAX, INT64_MIN, INT64_MAX - 12345,
                                 (std::int64_t(1) << 53) + 1, -(std::int64_t(1) << 60) - 1})
        CHECK(quad(DoubleDouble(x)) == Quad(x));
    CHECK(quad(DoubleDouble(UINT64_MAX)) == Quad(UINT64_MAX));
    CHECK(quad(DoubleDouble(0.1L)) == Quad(0.1L));
    CHECK(quad(DoubleDouble(-7)) == -7);
    CHECK(DoubleDouble(0.1F).high() == static_cast<double>(0.1F));
    CHECK(DoubleDouble(1e-20, 1.0) == DoubleDouble(1.0, 1e-20));  // any order of size
    CHECK(static_cast<long double>(DoubleDouble(1.0, 0x1p-60)) == 1.0L + 0x1p-60L);
    CHECK_FALSE(isfinite(DoubleDouble(std::numeric_limits<long double>::infinity())));
    CHECK_FALSE(isfinite(DoubleDouble(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("operations keep the bound of double words", "[core]") {
    support::Random random(3);
    double worst = 0;
    const double limit = static_cast<double>(revchain::operation_error<DoubleDouble>());
    for (int i = 0; i < 20000; ++i) {
        const auto word = [&] {
            const double high = random.log_between(1e-6, 1e6);
            return DoubleDouble(random() < 0.5 ? high : -high, high * random.between(-1e-16, 1e-16));
        };
        const DoubleDouble x = word(), y = word();
        DoubleDouble z = x;
        z += y;
        worst = std::max(worst, relative(quad(z), quad(x) + quad(y)));
        z = x;
        z -= y;
        worst = std::max(worst, relative(quad(z), quad(x) - quad(y)));
        z = x;
        z *= y;
        worst = std::max(worst, relative(quad(z), quad(x) * quad(y)));
        z = x;
        z /= y;
        worst = std::max(worst, relative(quad(z), quad(x) / quad(y)));
        worst = std::max(worst, relative(quad(sqrt(abs(x))), sqrtq(fabsq(quad(x)))));
        CHECK((x < y) == (quad(x) < quad(y)));
        int exponent = 0;
        const DoubleDouble fraction = frexp(x, &exponent);
        CHECK(ldexp(fraction, exponent) == x);
        CHECK(quad(-x) == -quad(x));
    }
    CHECK(worst <= limit);
    CHECK(worst <= 1e-31);
}

TEST_CASE("as messages show it", "[core]") {
    std::ostringstream text;
    text.precision(3);
    text << DoubleDouble(1.0 / 3) << " " << 1.0 / 3;
    CHECK(text.str() == "0.33333333333333331 0.333");
}
