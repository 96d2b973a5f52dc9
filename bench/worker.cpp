// SPDX-License-Identifier: MPL-2.0
// Runs one method on one chain at a time, as bench/heights.py asks over standard input: so that all methods, in this
// program and others, take turns. One request a line, words separated by tabs; one line of JSON in reply.
//
//     list                                                      the methods, what is missing, compiler and LAPACK
//     run METHOD KIND N COUNT RTOL SEED CHAINS REPEAT           CPU seconds per chain and the heights of the first
//     truth KIND N SEED J:GUESS...                              heights number J (from 0) near GUESS
//     write KIND N SEED FILE                                    the raw weights, for other programs
//     check                                                     the truth and the direct method against assembled LDL^T
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <tuple>

#include "revchain/methods.hpp"
#include "support/truth.hpp"
#include "timing.hpp"
#include "worker/direct.hpp"
#include "worker/eigen.hpp"
#include "worker/lapack.hpp"
#include "worker/revchain_methods.hpp"
#include "worker/truth.hpp"

namespace {

using bench::cpu_seconds;
using bench::Heights;
using bench::Method;
using bench::RawChain;
using bench::Registry;
using DoubleWord = revchain::DoubleWord<double>;
using Words = std::vector<std::string>;

/// Nanoseconds of a cycle, from a chain of dependent additions of integers, one cycle each.
double nanoseconds_per_cycle() {
    double best = 1e9;
    for (int trial = 0; trial < 20; ++trial) {
        constexpr int count = 1'000'000;
        std::uint64_t x = 1;
        const double start = cpu_seconds();
        for (int i = 0; i < count; ++i) {
            x += 3;
            asm volatile("" : "+r"(x));
        }
        best = std::min(best, (cpu_seconds() - start) * 1e9 / count);
    }
    return best;
}

/// For the check that a method which skips the work is found out: it looks at one link in ten thousand.
void register_canary(Registry& registry) {
    registry.methods.push_back({.name = "canary",
                                .family = "canary",
                                .kinds = "ABCDER",
                                .largest = 10'000'000,
                                .run = [](const RawChain& chain, std::size_t count, double, Heights& heights) {
                                    double sum = 0;
                                    for (std::size_t m = 0; m < chain.size(); m += 10'000) sum += chain.weight[m];
                                    for (std::size_t j = 0; j < count; ++j) heights.push_back(sum);
                                }});
}

Registry make_registry() {
    Registry registry;
    bench::register_revchain(registry);
    bench::register_direct(registry);
    bench::register_lapack(registry);
    bench::register_eigen(registry);
    register_canary(registry);
    return registry;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) (c == '"' || c == '\\') ? result += {'\\', c} : result += c == '\n' ? ' ' : c;
    return result + '"';
}

/// [[high, high, ...], [low, low, ...]]
std::string in_json(const Heights& heights) {
    std::ostringstream out;
    out.precision(17);
    out << '[';
    for (std::size_t i = 0; i < heights.parts.size(); ++i) {
        out << (i > 0 ? "," : "") << '[';
        for (std::size_t j = 0; j < heights.parts[i].size(); ++j) {
            const double x = heights.parts[i][j];
            out << (j > 0 ? "," : "");
            std::isfinite(x) ? out << x : out << "null";
        }
        out << ']';
    }
    out << ']';
    return out.str();
}

const RawChain& raw_chain(char kind, std::size_t size, unsigned seed) {
    static std::map<std::tuple<char, std::size_t, unsigned>, RawChain> kept;
    if (kept.size() > 512) kept.clear();
    const auto key = std::make_tuple(kind, size, seed);
    const auto found = kept.find(key);
    return found != kept.end() ? found->second : kept.emplace(key, bench::make_raw(kind, size, seed)).first->second;
}

std::string list(const Registry& registry) {
    std::ostringstream out;
    out << "{\"methods\":[";
    const char* separator = "";
    for (const Method& m : registry.methods) {
        out << separator << "{\"name\":" << quoted(m.name) << ",\"family\":" << quoted(m.family)
            << ",\"kinds\":" << quoted(m.kinds) << ",\"largest\":" << m.largest << ",\"which\":" << quoted(m.which)
            << ",\"has_tolerance\":" << (m.has_tolerance ? "true" : "false") << '}';
        separator = ",";
    }
    out << "],\"missing\":[";
    separator = "";
    for (const bench::Missing& m : registry.missing) {
        out << separator << "[" << quoted(m.name) << ',' << quoted(m.reason) << ']';
        separator = ",";
    }
    out << "],\"compiler\":" << quoted("g++ " __VERSION__) << ",\"lapack\":" << quoted(bench::lapack_implementation())
        << ",\"ns_per_cycle\":" << nanoseconds_per_cycle() << '}';
    return out.str();
}

/// REPEAT times over CHAINS different chains (seeds SEED, SEED + 1, ...). What a call returns is added up and printed:
/// nothing of it can be left out by the compiler.
std::string run(const Registry& registry, const Words& words) {
    const Method* method = nullptr;
    for (const Method& m : registry.methods)
        if (m.name == words.at(1)) method = &m;
    if (method == nullptr) throw std::invalid_argument("no such method: " + words[1]);
    const char kind = words.at(2).at(0);
    const std::size_t size = std::stoul(words.at(3)), count = std::stoul(words.at(4));
    const double rtol = std::stod(words.at(5));
    const auto seed = static_cast<unsigned>(std::stoul(words.at(6)));
    const auto chains = static_cast<unsigned>(std::stoul(words.at(7)));
    const std::size_t repeat = std::stoul(words.at(8));
    std::vector<RawChain> pool;
    pool.reserve(chains);
    for (unsigned i = 0; i < chains; ++i) pool.push_back(raw_chain(kind, size, seed + i));

    Heights heights, first;
    double sink = 0;
    const double start = cpu_seconds();
    for (std::size_t r = 0; r < repeat; ++r)
        for (unsigned i = 0; i < chains; ++i) {
            heights.clear();
            method->run(pool[i], count, rtol, heights);
            for (const double h : heights.parts[0]) sink += h;
            if (r == 0 && i == 0) first = heights;
        }
    const double seconds = (cpu_seconds() - start) / static_cast<double>(repeat * chains);
    if (first.size() != count) throw std::runtime_error("found " + std::to_string(first.size()) + " modes");
    std::ostringstream out;
    out.precision(9);
    out << "{\"seconds\":" << seconds << ",\"sink\":" << (std::isfinite(sink) ? sink : 0)
        << ",\"heights\":" << in_json(first) << '}';
    return out.str();
}

std::string truth(const Words& words) {
    const bench::Truth<DoubleWord> truth(
        raw_chain(words.at(1).at(0), std::stoul(words.at(2)), static_cast<unsigned>(std::stoul(words.at(3)))));
    Heights heights;
    for (std::size_t i = 4; i < words.size(); ++i) {
        const auto colon = words[i].find(':');
        const DoubleWord height =
            truth.height(std::stoul(words[i].substr(0, colon)), std::stod(words[i].substr(colon + 1)));
        heights.push_back(height.high, height.low);
    }
    return "{\"heights\":" + in_json(heights) + "}";
}

std::string write(const Words& words) {
    const RawChain& chain =
        raw_chain(words.at(1).at(0), std::stoul(words.at(2)), static_cast<unsigned>(std::stoul(words.at(3))));
    std::ofstream file(words.at(4), std::ios::binary);
    file.write(reinterpret_cast<const char*>(chain.weight.data()),
               static_cast<std::streamsize>(chain.size() * sizeof(double)));
    if (!file.flush()) throw std::runtime_error("cannot write " + words[4]);
    return "{}";
}

/// Worst relative error of the truth, and of the direct methods in ulp, against assembled LDL^T in quadruple precision with
/// its own bisection.
std::string check() {
    double worst_pair = 0, worst_direct = 0;
    for (const char kind : std::string("ABCDER"))
        for (const std::size_t size : {1, 2, 3, 10, 40, 300}) {
            const RawChain raw = bench::make_raw(kind, size, 7);
            const support::Truth reference(bench::library_chain(raw));
            const bench::Truth<DoubleWord> pair(raw);
            Heights newton, two_points;
            const std::size_t few = std::min<std::size_t>(size, 10);
            if (kind != 'D' && kind != 'E') bench::Direct(raw).newton(few, newton);
            if (kind != 'D' && kind != 'E') bench::Direct(raw).two_points(few, two_points);
            const auto all =
                revchain::modes(bench::library_chain(raw), {.count = revchain::all_modes}, revchain::methods::all)
                    .conical_height;
            for (std::size_t j = 0; j<size; j += size> 40 && j >= 10 ? 29 : 1) {
                const double guess = all[static_cast<revchain::Index>(j)];
                const support::Quad h = reference.height(static_cast<revchain::Index>(j), support::Quad(guess) / 2,
                                                         support::Quad(guess) * 2, 1e-24);
                const DoubleWord p = pair.height(j, guess);
                const auto off = [&](support::Quad x) { return std::abs(static_cast<double>((x - h) / h)); };
                worst_pair = std::max(worst_pair, off(support::Quad(p.high) + support::Quad(p.low)));
                for (const Heights* direct : {&newton, &two_points})
                    if (j < direct->size()) worst_direct = std::max(worst_direct, off(direct->parts[0][j]) * 0x1p52);
            }
        }
    std::ostringstream out;
    // Measured: 5e-19 (the secant's own error, of a bracket of 1e-10), 3.4 ulp.
    const bool good = worst_pair < 1e-18 && worst_direct < 6;
    out << "{\"good\":" << (good ? "true" : "false") << ",\"pair\":" << worst_pair << ",\"direct_ulp\":" << worst_direct
        << '}';
    return out.str();
}

std::string answer(const Registry& registry, const Words& words) try {
    if (words.at(0) == "list") return list(registry);
    if (words[0] == "run") return run(registry, words);
    if (words[0] == "truth") return truth(words);
    if (words[0] == "write") return write(words);
    if (words[0] == "check") return check();
    throw std::invalid_argument("no such request: " + words[0]);
} catch (const std::exception& error) {
    return "{\"error\":" + quoted(error.what()) + "}";
}

}  // namespace

int main() {
    const Registry registry = make_registry();
    for (std::string line; std::getline(std::cin, line);) {
        Words words;
        std::istringstream in(line);
        for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
        std::cout << answer(registry, words) << std::endl;
    }
}
