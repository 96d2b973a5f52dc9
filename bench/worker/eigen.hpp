// SPDX-License-Identifier: MPL-2.0
// Eigen's own solvers, and Spectra's Lanczos iteration on the inverse.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <stdexcept>

#include "worker/matrices.hpp"
#include "worker/method.hpp"

#ifdef BENCH_HAS_SPECTRA
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SparseSymShiftSolve.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymEigsShiftSolver.h>
#include <Spectra/SymGEigsShiftSolver.h>
#endif

namespace bench {

namespace detail {

inline Eigen::MatrixXd dense(const Tridiagonal& t) {
    const auto n = static_cast<Eigen::Index>(t.diagonal.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    a.diagonal() = Eigen::Map<const Eigen::VectorXd>(t.diagonal.data(), n);
    if (n > 1) a.diagonal(1) = a.diagonal(-1) = Eigen::Map<const Eigen::VectorXd>(t.off.data(), n - 1);
    return a;
}

inline Eigen::SparseMatrix<double> sparse(const Tridiagonal& t) {
    const auto n = static_cast<Eigen::Index>(t.diagonal.size());
    Eigen::SparseMatrix<double> a(n, n);
    a.reserve(Eigen::VectorXi::Constant(n, 3));
    for (Eigen::Index m = 0; m < n; ++m) {
        const auto i = static_cast<std::size_t>(m);
        if (m > 0) a.insert(m - 1, m) = t.off[i - 1];
        a.insert(m, m) = t.diagonal[i];
        if (m + 1 < n) a.insert(m + 1, m) = t.off[i];
    }
    a.makeCompressed();
    return a;
}

template <class Solver>
void push_eigenvalues(const Solver& solver, std::size_t count, Heights& heights) {
    if (solver.info() != Eigen::Success) throw std::runtime_error("Eigen: no convergence");
    for (std::size_t j = 0; j < count; ++j) heights.push_back(1 / solver.eigenvalues()[static_cast<Eigen::Index>(j)]);
}

#ifdef BENCH_HAS_SPECTRA
template <class Solver>
void push_spectra(Solver& solver, Heights& heights) {
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn);
    if (solver.info() != Spectra::CompInfo::Successful) throw std::runtime_error("Spectra: no convergence");
    const Eigen::VectorXd mu = solver.eigenvalues().reverse();  // descending -> ascending
    for (const double x : mu) heights.push_back(1 / x);
}
#endif

}  // namespace detail

inline void register_eigen(Registry& registry) {
    using C = const RawChain&;
    using H = Heights&;
    using N = std::size_t;
    const auto add = [&](const char* name, const char* family, const char* kinds, std::size_t largest,
                         const char* which, auto f) {
        registry.methods.push_back({.name = name,
                                    .family = family,
                                    .kinds = kinds,
                                    .largest = largest,
                                    .which = which,
                                    .run = [f](C c, N n, double, H h) { f(c, n, h); }});
    };
    add("Eigen SelfAdjoint, dense", "Eigen", "ACDE", 300, "all", [](C c, N n, H h) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> s(detail::dense(standard_form(c)), Eigen::EigenvaluesOnly);
        detail::push_eigenvalues(s, n, h);
    });
    add("Eigen computeFromTridiagonal", "Eigen", "ACDE", 20'000, "all", [](C c, N n, H h) {
        const Tridiagonal t = standard_form(c);
        const auto size = static_cast<Eigen::Index>(c.size());
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> s;
        s.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(t.diagonal.data(), size),
                                 Eigen::Map<const Eigen::VectorXd>(t.off.data(), size - 1), Eigen::EigenvaluesOnly);
        detail::push_eigenvalues(s, n, h);
    });
    add("Eigen GeneralizedSelfAdjoint", "Eigen", "BR", 300, "all", [](C c, N n, H h) {
        const Pencil p = assembled(c);
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> s(
            detail::dense(p.stiffness), detail::dense(p.mass), Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
        detail::push_eigenvalues(s, n, h);
    });
#ifdef BENCH_HAS_SPECTRA
    const auto basis = [](C c, N n) {
        return static_cast<Eigen::Index>(std::min(c.size(), std::max<N>(2 * n + 1, 20)));
    };
    add("Spectra shift-invert", "Spectra", "ACDE", 1'000'000, "few", [basis](C c, N n, H h) {
        const Eigen::SparseMatrix<double> T = detail::sparse(standard_form(c));  // kept by reference
        Spectra::SparseSymShiftSolve<double> op(T);
        Spectra::SymEigsShiftSolver<Spectra::SparseSymShiftSolve<double>> s(op, static_cast<Eigen::Index>(n),
                                                                            basis(c, n), 0.0);
        detail::push_spectra(s, h);
    });
    add("Spectra shift-invert, pencil", "Spectra", "BR", 1'000'000, "few", [basis](C c, N n, H h) {
        using Solve = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
        using Product = Spectra::SparseSymMatProd<double>;
        const Pencil p = assembled(c);
        const Eigen::SparseMatrix<double> K = detail::sparse(p.stiffness), M = detail::sparse(p.mass);
        Solve solve(K, M);
        Product product(M);
        Spectra::SymGEigsShiftSolver<Solve, Product, Spectra::GEigsMode::ShiftInvert> s(
            solve, product, static_cast<Eigen::Index>(n), basis(c, n), 0.0);
        detail::push_spectra(s, h);
    });
#else
    registry.missing.push_back({"Spectra", "not found when this was configured; apt-get install libspectra-dev"});
#endif
}

}  // namespace bench
