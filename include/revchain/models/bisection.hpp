// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/heights.hpp"
#include "revchain/models/model.hpp"
#include "revchain/numeric/compiled.hpp"

/// Bisection on counts as a model, the last of every list, and functions that numerical models
/// share.
namespace revchain::inline REVCHAIN_BUILD::models {

namespace detail {
REVCHAIN_LAZY
revchain::detail::HeightsOptions<double> options_for(const Question& question) {
    revchain::detail::HeightsOptions<double> options{.progress = question.progress};
    if (question.rtol > 2 * std::numeric_limits<double>::epsilon()) options.rtol = question.rtol;
    return options;
}
REVCHAIN_LAZY
ModeRange range_of(const Question& question) { return {question.first, question.count}; }

/// Returns the heights that a method found as an answer. If it found none, the answer is
/// `Answer::none()`; no other method is tried here.
REVCHAIN_LAZY
Answer answered(const Chain<double>& chain,
                const std::optional<revchain::detail::Heights<double>>& found) {
    if (!found) return Answer::none();
    const Index count = static_cast<Index>(found->size());
    const int exponent = chain.units().length_exponent;
    Answer answer{Vector<double>(count), Vector<double>(count)};
    answer.unrounded.reserve(found->size());
    for (Index j = 0; j < count; ++j) {
        const auto& height = (*found)[static_cast<std::size_t>(j)];
        answer.conical_height[j] = std::ldexp(height.eigenvalue, exponent);
        answer.error_bound[j] = height.error_bound;
        answer.unrounded.push_back(height.unrounded);
    }
    return answer;
}

/// The pencils of a chain: those of the question if it is about this chain, else its own.
class Assembled {
   public:
    Assembled(const Chain<double>& chain, const Question& question)
        : own_(chain), given_(question.assembled) {
        if (given_ && !given_->is_of(chain)) given_ = nullptr;
    }
    revchain::detail::LazyCounter<double>& counter() { return given_ ? *given_ : own_; }

   private:
    revchain::detail::LazyCounter<double> own_, *given_;
};

/// Returns the tolerance to meet: the requested one, but at most 1/2.
REVCHAIN_LAZY
double goal(const Question& question) { return std::min(question.rtol, 0.5); }

/// Predicts the seconds of bisection without double words. It makes passes over all links for each
/// digit, at `pass` seconds a link, and one proof for each mode. Starting a pass costs as much as
/// six links.
REVCHAIN_LAZY
double loose_cost(double links, double rtol, Index count, double pass) {
    const double digits = std::max(0.0, -std::log10(rtol));
    const double each = count == 1 ? 1.05 : count == 2 ? 1.6 : 3.3 * std::ceil(real(count) / 8);
    return 3e-7 + 2e-7 * real(count) +
           (links + 6) * (6e-9 + 2.4e-8 * real(count) + pass * (3 + each * digits));
}
}  // namespace detail

/// Bisection by counts, for any chain and any modes. Counts give every mode an interval of its own.
/// Then more counts follow if the tolerance makes that cheaper, else Rayleigh quotients of eight
/// shapes at a time, to 2 ulp.
struct Bisection {
    static constexpr std::string_view name = "bisection";
    static constexpr bool is_proved = true;

    Fit applies(const ChainKind&, const Question&) const { return {}; }
    double error_bound(const ChainKind& kind, const Question& question) const {
        return counts_pay(kind, question) ? detail::goal(question) : detail::full_accuracy;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        return counts_pay(kind, question) ? loose_cost(kind, question) : full_cost(kind, question);
    }
    static double loose_cost(const ChainKind& kind, const Question& question) {
        return detail::loose_cost(detail::real(kind.size), question.rtol, question.count, 8.5e-9);
    }
    static double full_cost(const ChainKind& kind, const Question& question) {
        const double count = detail::real(question.count), links = detail::real(kind.size);
        if (kind.size > most_in_lanes)
            return 4e-7 + 4e-7 * count + links * (1.6e-7 + 2.9e-7 * count);
        const double brackets = kind.size >= pencil::least_for_groups * question.last() ? 0 : 7e-8;
        const double eight = kind.point_masses ? 1.15e-7 : 1.45e-7;
        return 1.5e-6 + links * (brackets + eight * std::ceil(count / 8));
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind& kind, const Question& question) const {
        auto options = detail::options_for(question);
        if (!counts_pay(kind, question)) options.rtol.reset();
        detail::Assembled assembled(chain, question);
        return detail::answered(
            chain, revchain::detail::heights_by_bisection(chain, assembled.counter(),
                                                          detail::range_of(question), options));
    }

   private:
    static constexpr Index most_in_lanes = revchain::detail::most_in_lanes;
    /// Returns true if counts in double prove the tolerance for nearly all chains and cost less
    /// than full accuracy.
    static bool counts_pay(const ChainKind& kind, const Question& question) {
        return question.rtol >
                   4096 * std::numeric_limits<double>::epsilon() * detail::real(kind.size) &&
               loose_cost(kind, question) < full_cost(kind, question);
    }
};

}  // namespace revchain::models
