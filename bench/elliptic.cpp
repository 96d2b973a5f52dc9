// SPDX-License-Identifier: GPL-3.0-or-later
// Elliptic functions and integrals: error against the tables of 20 digits in tests/data, and CPU time, of this library, of
// GSL and of the C++ standard library, as CSV: function, complementary modulus, rows of the table, then for each of the
// three the worst error (1 and more: not a digit) and nanoseconds a value. Errors are relative, those of Jacobi's
// functions to |f| + |u df/du|: u itself is known to half an ulp only. A failure counts as an error of infinity. Others
// take kappa alone, rounded to double; that is most of their error near kappa = 1. A few seconds.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>
#include <quadmath.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

#include "revchain/special/incomplete_elliptic.hpp"
#include "timing.hpp"

namespace {

namespace analytic = revchain::analytic;
using Quad = __float128;
using Row = std::vector<Quad>;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rows by complementary modulus, the largest first.
std::map<double, std::vector<Row>, std::greater<>> table(const std::string& name) {
    std::map<double, std::vector<Row>, std::greater<>> rows;
    std::ifstream file(BENCH_DATA "/elliptic_" + name + ".csv");
    std::string line, field;
    for (std::getline(file, line); std::getline(file, line);) {
        Row row;
        for (std::istringstream fields(line); std::getline(fields, field, ',');)
            row.push_back(strtoflt128(field.c_str(), nullptr));
        rows[static_cast<double>(row[0])].push_back(row);
    }
    return rows;
}

/// What a library makes of the numbers of a row; nan where it has no such function, or fails.
using Function = std::function<double(const std::vector<double>&)>;
struct Job {
    std::string name, file;
    std::size_t exact;  // column of the truth
    Function ours, gsl, standard;
};

double value(int status, const gsl_sf_result& result) { return status == GSL_SUCCESS ? result.val : infinity; }

/// Size of an error of row j.
Quad size(const Job& job, const Row& row) {
    const Quad exact = fabsq(row[job.exact]);
    if (job.file != "jacobi") return exact;
    const Quad u = fabsq(row[1]), sn = fabsq(row[3]), cn = fabsq(row[4]), dn = fabsq(row[5]);
    const Quad k2 = (1 - row[0]) * (1 + row[0]);
    return exact + u * (job.exact == 3 ? cn * dn : job.exact == 4 ? sn * dn : k2 * sn * cn);
}

void measure(const Job& job) {
    for (const auto& [complement, rows] : table(job.file)) {
        std::printf("%s,%.10g,%zu", job.name.c_str(), complement, rows.size());
        for (const Function* function : {&job.ours, &job.gsl, &job.standard}) {
            if (!*function) {
                std::printf(",,");
                continue;
            }
            std::vector<std::vector<double>> arguments;
            double worst = 0, sum = 0;
            for (const Row& row : rows) {
                arguments.emplace_back(row.begin(), row.end());
                if (isinfq(row[job.exact])) continue;
                double computed = infinity;
                try {
                    computed = (*function)(arguments.back());
                } catch (const std::exception&) {
                }
                const Quad off = fabsq(computed - row[job.exact]), of = size(job, row);
                worst = std::max(worst, off == 0                  ? 0.0
                                        : std::isfinite(computed) ? static_cast<double>(off / of)
                                                                  : infinity);
            }
            std::vector<double> times;
            for (int round = 0; round < 9; ++round) {
                const double start = bench::cpu_seconds();
                int calls = 0;
                for (int repeat = 0; repeat < 200; ++repeat)
                    for (const std::vector<double>& row : arguments) {
                        try {
                            sum += (*function)(row);
                        } catch (const std::exception&) {
                        }
                        ++calls;
                    }
                times.push_back((bench::cpu_seconds() - start) / calls);
            }
            std::printf(",%.2g,%.0f", worst, sum == 0.123 ? -1.0 : 1e9 * bench::median(times));
        }
        std::printf("\n");
    }
}

double modulus(const std::vector<double>& row) { return std::sqrt((1 - row[0]) * (1 + row[0])); }

}  // namespace

int main() {
    gsl_set_error_handler_off();
    constexpr gsl_mode_t mode = GSL_PREC_DOUBLE;
    const auto of = [](const std::vector<double>& row) { return analytic::EllipticModulus::of_complement(row[0]); };
    std::vector<Job> jobs;
    for (const std::size_t which : {3, 4, 5}) {
        const char* names[]{"sn", "cn", "dn"};
        jobs.push_back({names[which - 3], "jacobi", which,
                        [=](const std::vector<double>& row) {
                            const analytic::JacobiValues f = analytic::JacobiFunctions(of(row))(row[1]);
                            return which == 3 ? f.sn : which == 4 ? f.cn : f.dn;
                        },
                        [=](const std::vector<double>& row) {
                            double f[3];
                            const double k = modulus(row);
                            return gsl_sf_elljac_e(row[1], k * k, f, f + 1, f + 2) == GSL_SUCCESS ? f[which - 3]
                                                                                                  : infinity;
                        },
                        nullptr});
    }
    gsl_sf_result r;
    jobs.push_back({"K", "complete", 2, [&](const auto& row) { return analytic::complete_integrals(of(row)).K; },
                    [&](const auto& row) { return value(gsl_sf_ellint_Kcomp_e(modulus(row), mode, &r), r); },
                    [](const auto& row) { return std::comp_ellint_1(modulus(row)); }});
    jobs.push_back({"E", "complete", 3, [&](const auto& row) { return analytic::complete_integrals(of(row)).E; },
                    [&](const auto& row) { return value(gsl_sf_ellint_Ecomp_e(modulus(row), mode, &r), r); },
                    [](const auto& row) { return std::comp_ellint_2(modulus(row)); }});
    jobs.push_back({"D", "complete", 4, [&](const auto& row) { return analytic::complete_integrals(of(row)).D; },
                    [&](const auto& row) { return value(gsl_sf_ellint_Dcomp_e(modulus(row), mode, &r), r); }, nullptr});
    jobs.push_back({"Pi", "complete", 6, [&](const auto& row) { return analytic::complete_pi(row[1], of(row)); },
                    [&](const auto& row) { return value(gsl_sf_ellint_Pcomp_e(modulus(row), -row[1], mode, &r), r); },
                    [](const auto& row) { return std::comp_ellint_3(modulus(row), row[1]); }});
    jobs.push_back({"F(phi)", "incomplete", 3,
                    [&](const auto& row) { return analytic::incomplete_integrals(row[1], of(row)).F; },
                    [&](const auto& row) { return value(gsl_sf_ellint_F_e(row[1], modulus(row), mode, &r), r); },
                    [](const auto& row) { return std::ellint_1(modulus(row), row[1]); }});
    jobs.push_back({"E(phi)", "incomplete", 4,
                    [&](const auto& row) { return analytic::incomplete_integrals(row[1], of(row)).E; },
                    [&](const auto& row) { return value(gsl_sf_ellint_E_e(row[1], modulus(row), mode, &r), r); },
                    [](const auto& row) { return std::ellint_2(modulus(row), row[1]); }});
    jobs.push_back(
        {"Pi(phi)", "incomplete", 6, [&](const auto& row) { return analytic::incomplete_pi(row[2], row[1], of(row)); },
         [&](const auto& row) { return value(gsl_sf_ellint_P_e(row[1], modulus(row), -row[2], mode, &r), r); },
         [](const auto& row) { return std::ellint_3(modulus(row), row[2], row[1]); }});
    std::printf("function,complementary_modulus,rows,error,ns,gsl_error,gsl_ns,std_error,std_ns\n");
    for (const Job& job : jobs) measure(job);
}
