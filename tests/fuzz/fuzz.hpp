// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "revchain/rig.hpp"

/// Random calls of the library with ordinary, extreme and invalid numbers. A call may return or throw InvalidArgument.
/// A report of a sanitizer, a hung call and any other exception are failures.
namespace fuzz {

using revchain::Chain;
using revchain::Index;

/// Random bits: the bytes of an input, if there is one, then a generator. The bytes also seed the generator.
class Bits {
   public:
    using result_type = std::uint64_t;
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return ~result_type(0); }

    explicit Bits(std::uint64_t seed) : engine_(seed) {}
    explicit Bits(std::span<const std::uint8_t> input) : input_(input) {
        std::seed_seq seeds(input.begin(), input.end());
        engine_.seed(seeds);
    }

    result_type operator()() { return take(sizeof(result_type)); }
    /// Only as many bytes of the input as the count needs: then a change of one byte changes one choice.
    std::uint64_t below(std::uint64_t count) { return take(count <= 256 ? 1 : sizeof(result_type)) % count; }

   private:
    result_type take(std::size_t bytes) {
        if (input_.empty()) return engine_();
        bytes = std::min(bytes, input_.size());
        result_type result = 0;
        std::memcpy(&result, input_.data(), bytes);
        input_ = input_.subspan(bytes);
        return result;
    }

    std::span<const std::uint8_t> input_;
    std::mt19937_64 engine_;
};

class Random {
   public:
    explicit Random(Bits bits) : bits_(bits) {}

    std::uint64_t below(std::uint64_t count) { return bits_.below(count); }
    bool one_in(std::uint64_t count) { return below(count) == 0; }
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits_); }
    double power(double decades) { return std::pow(10.0, between(-decades, decades)); }
    template <class T>
    T pick(std::initializer_list<T> values) {
        return values.begin()[below(values.size())];
    }

    /// Mostly an ordinary positive number; of a `wild` case any at all.
    double number() {
        if (!wild) return one_in(3) ? power(3) : between(0.1, 2);
        switch (below(8)) {
            case 0:
                return power(300);
            case 1:
                return power(30);
            case 2:
                return -power(10);
            case 3:
                return pick({0.0, -0.0, 1.0, 5e-324, 2e-308, 1e308, -1.0, 1e154, 1e-154});
            case 4:
                return one_in(4) ? pick({HUGE_VAL - HUGE_VAL, HUGE_VAL, -HUGE_VAL}) : power(100);
            default:
                return between(0.1, 2);
        }
    }
    std::vector<double> numbers(std::size_t count) {
        std::vector<double> result(count);
        for (double& x : result) x = number();
        return result;
    }
    Index count(Index most) {
        return wild && one_in(20) ? pick({Index(0), Index(-1)}) : Index(1 + below(std::uint64_t(most)));
    }

    Chain<double> chain(Index most) {
        const Index size = Index(1 + below(std::uint64_t(most)));
        const std::uint64_t kind = below(5);
        if (kind == 0) return Chain<double>::uniform_plummets(size, number(), number());
        if (kind == 1) return Chain<double>::uniform_rods(size, number(), number());
        if (kind == 2) return Chain<double>::tapered(size, number(), between(-0.9, 3), number());
        const double unit = one_in(4) ? power(280) : 1, weights = one_in(4) ? power(280) : 1;
        std::vector<revchain::Link<double>> links;
        for (Index m = 0; m < size; ++m) {
            const double a = number() * unit, share = one_in(3) ? 1 : between(-0.3, 1.5);
            const double ratio = one_in(3) ? 0 : one_in(4) ? number() : between(0, 0.5);
            links.push_back({one_in(9) ? 0 : number() * weights, a, a * share, revchain::Wide<double>(ratio)});
        }
        return Chain<double>(links);
    }
    revchain::Rig rig(Index most) {
        Chain<double> hung = chain(most);
        const auto size = static_cast<std::size_t>(hung.size());
        revchain::Rigging with;
        if (one_in(2)) with.support = {number() * 10, one_in(2) ? 0 : number(), one_in(2) ? 0 : number()};
        if (one_in(3))
            for (std::size_t m = 0; m < size; ++m)
                with.posture.push_back(one_in(3) ? revchain::Posture::stands : revchain::Posture::hangs);
        if (one_in(3))
            for (std::size_t m = 0; m < size; ++m) with.flywheels.push_back({number(), one_in(2) ? 0 : number()});
        if (one_in(3))
            for (Index m = 0; m < hung.size(); ++m)
                with.displaced.push_back(revchain::displaced_by(hung.link(m), number() / 4, number() / 4));
        with.fluid = one_in(2) ? revchain::Fluid::still : revchain::Fluid::turning;
        return {std::move(hung), std::move(with)};
    }

    bool wild = false;

   private:
    Bits bits_;
};

/// Results may be infinite, but no silent NaN.
inline void expect_number(double result) {
    if (std::isnan(result)) throw std::runtime_error("a result is NaN");
}

inline constexpr int longest_call = 60;  // seconds of processor time, under sanitizers

/// The case `number % 6`, wild if `number / 6` is even. Returns the message if the library refused the numbers, otherwise
/// an empty text. Throws if a call fails or takes longer than `longest_call`.
std::string run(std::uint64_t number, Random random);

// Each in <name>.cpp.
void linear(Random& random);
void rigs(Random& random);
void shapes(Random& random);
void branches(Random& random);
void held(Random& random);
void analytic(Random& random);

}  // namespace fuzz
