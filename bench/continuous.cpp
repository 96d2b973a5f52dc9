// SPDX-License-Identifier: MPL-2.0
// All steady shapes of a uniform chain without links at length / conical height 500, compiled methods: CPU time of one search
// and worst error against tests/data/continuous_shapes.csv, as CSV: method, milliseconds, shapes right, wrong, missing,
// error of inclinations in rad, of offsets over the length. A shape is right with its number of half waves and inclinations
// within 1e-6. One round; bench/continuous_peers.py takes turns with those that are not compiled. Boost.Odeint
// (libboost-dev) where it is installed: its Runge-Kutta-Fehlberg 7(8), tolerance 1e-13, in the arc length; 400 offsets of the
// free end tried at 1e-7, then TOMS 748 on the offset of the support.
#include <cstdio>
#include <cstring>
#include <map>

#include "revchain/finite/cord/continuous_chain.hpp"
#include "support/table.hpp"
#include "timing.hpp"

#if __has_include(<boost/numeric/odeint.hpp>) && __has_include(<boost/math/tools/toms748_solve.hpp>)
#define BENCH_HAS_ODEINT
#pragma GCC diagnostic ignored "-Wuninitialized"  // Odeint copies steppers that hold nothing yet
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint.hpp>
#endif

namespace {

constexpr double length = 500;
constexpr int expected = 14;

struct Place {
    double arc, offset, inclination;
};
using Table = std::map<int, std::vector<Place>>;  // by half waves; or in the order found

Table truth() {
    Table table;
    for (const auto& row : support::table(BENCH_DATA "/continuous_shapes.csv"))
        if (row[0] == "uniform" && row[1] == "500" && row[2] == "0")
            table[std::stoi(row[3])].push_back({std::stod(row[4]), std::stod(row[5]), std::stod(row[6])});
    return table;
}

void report(const char* method, double milliseconds, const Table& exact, const Table& found) {
    int right = 0, wrong = 0;
    double worst = 0, worst_offset = 0;
    for (const auto& [half_waves, places] : found) {
        const auto other = exact.find(half_waves);
        double error = 1, offset_error = 1;
        if (other != exact.end() && other->second.size() == places.size()) {
            error = offset_error = 0;
            for (std::size_t i = 0; i < places.size(); ++i) {
                error = std::max(error, std::abs(places[i].inclination - other->second[i].inclination));
                offset_error = std::max(offset_error, std::abs(places[i].offset - other->second[i].offset) / length);
            }
        }
        if (!(error <= 1e-6)) {
            ++wrong;
            continue;
        }
        ++right;
        worst = std::max(worst, error), worst_offset = std::max(worst_offset, offset_error);
    }
    // 14 shapes have 1000 steps of 600 multiplications at the least.
    const bool broken = milliseconds < 0.1;
    std::printf("%s%s,%.4g,%d,%d,%d,%.2g,%.2g\n", method, broken ? " BROKEN" : "", milliseconds, right, wrong,
                expected - right, worst, worst_offset);
}

void ours(const Table& exact) {
    std::vector<double> times;
    double sink = 0;
    revchain::CordShapes shapes;
    for (int i = 0; i < 25; ++i) {
        const double before = bench::cpu_seconds();
        shapes = revchain::steady_shapes(revchain::Cord(length), {.conical_height = 1.0});
        times.push_back(1e3 * (bench::cpu_seconds() - before));
        for (const auto& shape : shapes.shapes) sink += shape.offset.sum();
    }
    Table found;
    for (const auto& shape : shapes.shapes)
        for (const Place& place : exact.at(shape.half_waves)) {
            const auto at = shape(place.arc);
            found[shape.half_waves].push_back({place.arc, at.offset, at.inclination});
        }
    report(sink == 0.123 ? "" : "revchain", bench::median(times), exact, found);
}

#ifdef BENCH_HAS_ODEINT
namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;  // pull, offset

void derivative(const State& x, State& d, double s) { d = {-x[1], x[0] / std::sqrt(x[0] * x[0] + s * s)}; }

/// From the free end to the places; how often the offset changes sign.
int follow(double tip, double tolerance, const std::vector<double>& stops, std::vector<State>& at) {
    constexpr double start = 1e-8;  // by two terms of the series
    const double slope = -tip / std::sqrt(1 + tip * tip);
    State x{-start * (tip + 0.5 * slope * start), tip + slope * start};
    auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(tolerance, tolerance);
    double s = start, step = 1e-4;
    int changes = 0;
    at.clear();
    for (const double stop : stops) {
        while (s < stop) {
            const double before = x[1];
            double trial = std::min(step, stop - s);
            const bool cut = trial < step;
            if (stepper.try_step(derivative, x, s, trial) == odeint::success) {
                changes += before * x[1] < 0;
                if (!cut) step = trial;
            } else {
                step = trial;
            }
            if (stop - s < 1e-14 * stop) break;
        }
        at.push_back(x);
    }
    return changes;
}

void by_odeint(const Table& exact) {
    const double before = bench::cpu_seconds();
    std::vector<State> at;
    const auto support = [&](double tip, double tolerance) {
        follow(tip, tolerance, {length}, at);
        return at.back()[1];
    };
    std::vector<double> tips;
    double last = 0, last_value = 0;
    for (int i = 1; i <= 400; ++i) {
        const double tip = length * std::pow(i / 400.0, 3), value = support(tip, 1e-7);
        if (i > 1 && value * last_value < 0) {
            std::uintmax_t most = 60;
            const auto found = boost::math::tools::toms748_solve([&](double x) { return support(x, 1e-13); }, last, tip,
                                                                 boost::math::tools::eps_tolerance<double>(50), most);
            tips.push_back(0.5 * (found.first + found.second));
        }
        last = tip, last_value = value;
    }
    Table found;
    const double milliseconds = 1e3 * (bench::cpu_seconds() - before);
    for (const double tip : tips) {
        const int half_waves = follow(tip, 1e-13, {length * (1 - 1e-9)}, at) + 1;
        if (exact.count(half_waves) == 0 || found.count(half_waves) != 0) {
            found[100 + half_waves] = {};
            continue;
        }
        std::vector<double> stops;
        for (const Place& place : exact.at(half_waves)) stops.push_back(std::max(place.arc, 1e-8));
        follow(tip, 1e-13, stops, at);
        for (std::size_t i = 0; i < at.size(); ++i)
            found[half_waves].push_back({stops[i], at[i][1], -std::atan2(at[i][0], stops[i])});
    }
    report("Boost.Odeint + TOMS 748", milliseconds, exact, found);
}
#endif

}  // namespace

int main(int count, char** arguments) {
    const bool with_peers = count < 2 || std::strcmp(arguments[1], "ours") != 0;
    const Table exact = truth();
    std::printf("method,milliseconds,right,wrong,missing,inclination_error,offset_error\n");
    ours(exact);
    if (!with_peers) return 0;
#ifdef BENCH_HAS_ODEINT
    by_odeint(exact);
#else
    std::printf("Boost.Odeint + TOMS 748: not installed (libboost-dev)\n");
#endif
}
