// SPDX-License-Identifier: MPL-2.0
#include "revchain/recurrence.hpp"

#include "revchain/linear/assembly.hpp"
#include "revchain/pencil/dense.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Index;

// (21) is the element pencil, its rows summed from the tip up (with the sign changed): equations (18)-(19) generalised.
TEST_CASE("relation (21) is the running sum of the assembled rows", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 4, 8}) {
            const auto chain = family.make(n);
            const auto assembled = revchain::assemble(chain);
            const auto matrices = revchain::pencil::assembled(revchain::pencil::rounded<double>(assembled.pencil));
            const double weight = std::ldexp(1.0, assembled.units.weight_exponent);
            const double length = std::ldexp(1.0, assembled.units.length_exponent);
            const auto pencil = revchain::recurrence_matrices(chain);
            REQUIRE(pencil.A.rows() == n);
            REQUIRE(pencil.B.cols() == n);
            Eigen::RowVectorXd mass = Eigen::RowVectorXd::Zero(n), stiffness = mass, stiffness_size = mass;
            Eigen::RowVectorXd mass_size =
                mass;  // of the terms of column c: everything the two links at pin c enter with
            for (Index c = 0; c < n; ++c)
                for (Index link = std::max(c - 1, Index(0)); link <= c; ++link) {
                    const auto& e = assembled.pencil.elements[static_cast<std::size_t>(link)];
                    mass_size[c] += (static_cast<double>(e.lower) + static_cast<double>(e.upper) + e.weight) * weight;
                }
            for (Index row = 0; row < n; ++row) {
                mass += matrices.M.row(row) * weight;
                stiffness += matrices.K.row(row) * weight / length;
                stiffness_size += matrices.K.row(row).cwiseAbs() * weight / length;
                CAPTURE(family.name, n, row);
                for (Index c = 0; c < n; ++c) {
                    CHECK(std::abs(pencil.A(row, c) - mass[c]) <= 4 * 0x1p-52 * mass_size[c]);
                    CHECK(std::abs(pencil.B(row, c) - stiffness[c]) <= 4 * 0x1p-52 * stiffness_size[c]);
                }
            }
        }
    }
}

TEST_CASE("units of the pencil", "[linear]") {
    const revchain::Chain<double> chain(std::vector{revchain::plummet(3.0, 0.5)});
    const auto pencil = revchain::recurrence_matrices(chain);
    CHECK(pencil.A(0, 0) == 3.0);        // W h l / a^2
    CHECK(pencil.B(0, 0) == 3.0 / 0.5);  // kappa / a^2: A / B = lambda = 0.5
}
