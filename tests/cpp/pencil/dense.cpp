// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/dense.hpp"

#include "revchain/linear/assembly.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Index;
namespace pencil = revchain::pencil;

TEST_CASE("assembled matrices: definite, symmetric, and of the right sums", "[linalg]") {
    for (const auto& family : support::families()) {
        const auto pencil = pencil::rounded<double>(revchain::assemble(family.make(9)).pencil);
        const auto matrices = pencil::assembled(pencil);
        CAPTURE(family.name);
        CHECK(matrices.K.isApprox(matrices.K.transpose(), 0.0));
        CHECK(matrices.M.isApprox(matrices.M.transpose(), 0.0));
        CHECK(Eigen::LLT<Eigen::MatrixXd>(matrices.K).info() == Eigen::Success);
        // tip row of K sums to 0 (no force in a uniform shift), top row to the stiffness of the top link
        CHECK(std::abs(matrices.K.row(0).sum()) <= 1e-15 * matrices.K.row(0).cwiseAbs().sum());
        CHECK(matrices.K.row(8).sum() ==
              Approx(pencil.elements.back().stiffness).epsilon(1e-12).margin(1e-12 * matrices.K(8, 8)));
    }
}

TEST_CASE("both solvers return pairs, in order", "[linalg]") {
    const auto matrices = pencil::assembled(
        pencil::rounded<double>(revchain::assemble(revchain::Chain<double>::uniform_rods(12)).pencil));
    for (const auto& system :
         {pencil::solve_symmetric_definite(matrices.K, matrices.M), pencil::solve_general(matrices.M, matrices.K)}) {
        for (Index j = 0; j < 12; ++j) {
            const Eigen::VectorXd y = system.vectors.col(j);
            const double size = (matrices.M * y).norm();
            CHECK((matrices.M * y - system.values[j] * (matrices.K * y)).norm() <= 1e-12 * size);
            if (j > 0) CHECK(system.values[j] < system.values[j - 1]);
        }
    }
}
