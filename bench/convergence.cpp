// SPDX-License-Identifier: MPL-2.0
// How fast chains of N links tend to the uncut chain, for ten ways of cutting it: relative difference of the conical
// heights, its observed order and coefficient, and the law beside them.
//
//     bench_convergence [--largest N] [--csv FILE] [--flags TEXT]     prints a summary; TEXT is noted in the file
//     python bench/plot_convergence.py FILE                           draws it
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/cuttings.hpp"

namespace {

using revchain::Index;
using Cutting = support::Cutting<double>;
using Zero = support::BesselZero<long double>;

#if defined(__GNUC__) && !defined(__clang__)
constexpr const char* compiler = "g++ " __VERSION__;
#elif defined(__VERSION__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "unknown";
#endif

struct Options {
    Index largest = 100000;
    std::string csv, flags = "not recorded";
};

/// One chain and mode against the uncut chain. Differences are formed in long double, where the uncut height is good to
/// 1e-19: what they lack is the certified bound of the height alone.
struct Row {
    const Cutting* cutting;
    Index links;
    Zero zero;
    double length;       ///< M, in links
    double height;       ///< over the length of the chain
    double difference;   ///< relative
    double bound;        ///< certified, relative
    double law;          ///< coefficient
    double order = NAN;  ///< between this N and the one before
    double extrapolated = NAN;
    double uncertainty = NAN;  ///< of `extrapolated`: rounding, and its change since the N before

    double power() const { return std::pow(length, cutting->order); }
    double coefficient() const { return difference * power(); }
    bool resolved() const { return std::abs(difference) > 10 * bound; }
};

std::vector<Index> sizes(Index largest) {
    std::vector<Index> result;
    for (Index decade = 1; decade <= largest; decade *= 10)
        for (const Index step : {1, 2, 5})
            if (step * decade <= largest) result.push_back(step * decade);
    return result;
}

/// Richardson's step: the term after the leading one is of order 1/M (orders 1 and 3) or 1/M^2 (order 2, but for
/// logarithms) relative to it.
void compare(Row& row, const Row& before) {
    const double ratio = row.length / before.length;
    row.order = -std::log(std::abs(row.difference / before.difference)) / std::log(ratio);
    const double gain = std::pow(ratio, row.cutting->order == 2 ? 2 : 1);
    row.extrapolated = (gain * row.coefficient() - before.coefficient()) / (gain - 1);
    const double rounding = (gain * row.bound * row.power() + before.bound * before.power()) / (gain - 1);
    row.uncertainty = rounding + std::abs(row.extrapolated - before.extrapolated);
}

std::vector<std::vector<Row>> measure(const Cutting& cutting, Index largest) {
    std::vector<std::vector<Row>> curves(support::bessel_zeros<long double>.size());
    for (const Index size : sizes(largest)) {
        if (size < cutting.smallest) continue;
        const auto chain = cutting.make(size);
        const Index count = std::min<Index>(10, chain.mode_count());
        const auto m = revchain::modes(chain, {.count = count}, revchain::methods::all);
        for (std::size_t i = 0; i < curves.size(); ++i) {
            const Zero zero = support::bessel_zeros<long double>[i];
            if (zero.mode > count) continue;
            const long double M = static_cast<long double>(size) + cutting.excess;
            const long double height = m.conical_height[zero.mode - 1] / M;
            Row row{.cutting = &cutting,
                    .links = size,
                    .zero = zero,
                    .length = static_cast<double>(M),
                    .height = static_cast<double>(height),
                    .difference = static_cast<double>(height / support::uncut_height(zero) - 1),
                    .bound = m.error_bound[zero.mode - 1],
                    .law = cutting.law(static_cast<double>(zero.j), static_cast<double>(zero.J))};
            if (!curves[i].empty()) compare(row, curves[i].back());
            curves[i].push_back(row);
        }
    }
    return curves;
}

void write(std::ostream& out, const Row& row) {
    const auto number = [&](double x, int digits) {
        out << ',';
        if (!std::isnan(x)) out << std::setprecision(digits) << x;
    };
    out << '"' << row.cutting->name << "\",\"" << row.cutting->plain << "\"," << row.cutting->order << ','
        << row.zero.mode << ',' << row.links;
    number(row.length, 9);
    number(row.height, 17);
    number(static_cast<double>(support::uncut_height(row.zero)), 17);
    number(row.difference, 9);
    number(row.bound, 3);
    number(row.law / row.power(), 9);
    number(row.order, 6);
    number(row.coefficient(), 9);
    number(row.extrapolated, 9);
    number(row.uncertainty, 3);
    number(row.law, 9);
    out << '\n';
}

void print(const std::vector<Row>& curve) {
    if (curve.empty()) return;
    const Row* best = nullptr;  // extrapolates best
    const Row* last = nullptr;  // last that rounding has not touched
    for (const Row& row : curve) {
        if (!std::isnan(row.uncertainty) && (best == nullptr || row.uncertainty < best->uncertainty)) best = &row;
        if (row.resolved() && !std::isnan(row.order)) last = &row;
    }
    if (best == nullptr || last == nullptr) return;
    std::printf("%-27s %4d %10.4f %8ld %13.7f +- %7.1e %13.7f %9.1e  %s\n", best->cutting->name.c_str(),
                best->zero.mode, last->order, static_cast<long>(last->links), best->extrapolated, best->uncertainty,
                best->law, best->extrapolated / best->law - 1,
                last == &curve.back() ? "not reached" : std::to_string((last + 1)->links).c_str());
}

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; i += 2) {
        const std::string name = argv[i];
        if (i + 1 == argc) throw std::invalid_argument(name + " wants a value");
        if (name == "--largest") {
            options.largest = std::stol(argv[i + 1]);
        } else if (name == "--csv") {
            options.csv = argv[i + 1];
        } else if (name == "--flags") {
            options.flags = argv[i + 1];
        } else {
            throw std::invalid_argument("unknown option " + name);
        }
    }
    return options;
}

void write_heading(std::ostream& out, const Options& options) {
    const std::time_t now = std::time(nullptr);
    out << "# SPDX-License-Identifier: MPL-2.0\n# bench_convergence, " << std::put_time(std::gmtime(&now), "%Y-%m-%d")
        << "; compiler " << compiler << "; flags " << options.flags
        << "\n# difference = conical_height / uncut_height - 1 (heights over the length of the chain); error_bound is "
           "certified;\n# law = law_coefficient / length_in_links^order; coefficient = difference "
           "length_in_links^order\n"
           "cutting,description,order,mode,links,length_in_links,conical_height,uncut_height,difference,error_bound,"
           "law,"
           "observed_order,coefficient,extrapolated,uncertainty,law_coefficient\n";
}

}  // namespace

int main(int argc, char** argv) try {
    const Options options = parse(argc, argv);
    std::ofstream csv;
    if (!options.csv.empty()) {
        csv.open(options.csv);
        if (!csv) throw std::runtime_error("cannot write " + options.csv);
        write_heading(csv, options);
    }
    std::printf("%-27s %4s %10s %8s %24s %13s %9s  %s\n", "cutting", "mode", "order", "at N",
                "coefficient, extrapolated", "law", "off by", "rounding prevails from N");
    const auto start = std::chrono::steady_clock::now();
    const auto cuttings = support::cuttings<double>();
    for (const Cutting& cutting : cuttings) {
        for (const auto& curve : measure(cutting, options.largest)) {
            print(curve);
            for (const Row& row : curve)
                if (csv) write(csv, row);
        }
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    std::printf(
        "\nDifferences are relative to the uncut chain; rounding prevails where one is below ten times the\n"
        "certified bound of the height. %.1f s.\n",
        taken.count());
    return 0;
} catch (const std::exception& error) {
    std::cerr << "bench_convergence: " << error.what() << '\n';
    return 2;
}
