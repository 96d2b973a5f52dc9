// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/status.hpp"

#include "revchain/numeric/progress.hpp"
#include "support/catch.hpp"

TEST_CASE("a refusal names function, sentence and value", "[core]") {
    try {
        revchain::detail::require_positive("conical_pendulum::height", "gravity", -9.81);
        FAIL("not refused");
    } catch (const std::invalid_argument& error) {
        CHECK(std::string(error.what()) ==
              "revchain::conical_pendulum::height: gravity must be positive and finite, got -9.81");
    }
    CHECK_THROWS_AS(revchain::detail::require_positive("f", "x", std::nan("")), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::detail::require_positive("f", "x", std::numeric_limits<float>::infinity()),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::detail::require_positive("f", "x", 0.0L), revchain::InvalidArgument);
    CHECK_NOTHROW(revchain::detail::require_positive("f", "x", std::numeric_limits<double>::denorm_min()));
}

TEST_CASE("values are written so that they can be read back", "[core]") {
    CHECK(revchain::detail::in_digits(0.1) == "0.1");
    CHECK(revchain::detail::in_digits(1.0 / 3.0) == "0.3333333333333333");
    CHECK(std::stod(revchain::detail::in_digits(2.0 / 3.0)) == 2.0 / 3.0);
    CHECK(revchain::detail::in_digits(17) == "17");
    CHECK(to_string(revchain::Status::success) == "success");
    CHECK(to_string(revchain::Status::tolerance_not_met) == "tolerance_not_met");
}

TEST_CASE("progress is reported, and cancels", "[core]") {
    revchain::Progress progress;
    revchain::detail::advance(nullptr, 0.5);
    revchain::detail::advance(&progress, 0.5);
    CHECK(progress.fraction() == 0.5);
    progress.cancel();
    CHECK_THROWS_AS(revchain::detail::advance(&progress, 0.6), revchain::Cancelled);
    CHECK(progress.fraction() == 0.5);
}
