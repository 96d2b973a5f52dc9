// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/condensed_heights.hpp"
#include "revchain/linear/interpolated_heights.hpp"
#include "revchain/models/model.hpp"

/// The four numerical methods of `modes` (docs/design.md), each as a model. All bounds are proved. `solve` is a
/// template, so that an include alone compiles no method.
/// Costs: fitted to `bench_models` (x86-64, AVX2, 2 cores, GCC 12), flat within a factor of 2.
namespace revchain::inline REVCHAIN_BUILD::models {

namespace detail {
inline revchain::detail::HeightsOptions<double> options_for(const Question& question) {
    revchain::detail::HeightsOptions<double> options{.progress = question.progress};
    if (question.rtol > 2 * std::numeric_limits<double>::epsilon()) options.rtol = question.rtol;
    return options;
}
inline ModeRange range_of(const Question& question) { return {question.first, question.count}; }

/// The heights that a method found, as an answer. Where it found none, no other method does the work.
inline Answer answered(const Chain<double>& chain, const std::optional<revchain::detail::Heights<double>>& found) {
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

/// The tolerance asked for, but at most 1/2: every height is proved at least to a half.
inline double goal(const Question& question) { return std::min(question.rtol, 0.5); }

/// Seconds of bisection without double words: passes over all links for each digit, of `pass` seconds a link, and one
/// proof for each mode. To begin a pass costs as much as six links.
inline double loose_cost(double links, double rtol, Index count, double pass) {
    const double digits = std::max(0.0, -std::log10(rtol));
    const double each = count == 1 ? 1.05 : count == 2 ? 1.6 : 3.3 * std::ceil(real(count) / 8);
    return 3e-7 + 2e-7 * real(count) + (links + 6) * (6e-9 + 2.4e-8 * real(count) + pass * (3 + each * digits));
}
}  // namespace detail

/// Counts until every mode has an interval of its own. Then, where the tolerance makes that cheaper, more counts; else
/// Rayleigh quotients of eight shapes at a time, to 2 ulp. Any chain, any modes.
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
        if (kind.size > most_in_lanes) return 4e-7 + 4e-7 * count + links * (1.6e-7 + 2.9e-7 * count);
        const double beyond_cache = kind.size > 3000 ? 1.35 : 1;
        const double brackets = kind.size >= pencil::least_for_groups * question.last() ? 0 : 7e-8;
        const double eight = kind.point_masses ? 1.15e-7 : 1.45e-7;
        return 1.5e-6 + links * (brackets + eight * std::ceil(count / 8)) * beyond_cache;
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind& kind, const Question& question) const {
        revchain::detail::LazyCounter<double> assembled(chain);
        auto options = detail::options_for(question);
        if (!counts_pay(kind, question)) options.rtol.reset();
        return detail::answered(chain, revchain::detail::heights_by_bisection(
                                           chain, assembled, detail::range_of(question), options));
    }

   private:
    static constexpr Index most_in_lanes = revchain::detail::most_in_lanes;
    /// Whether counts in double prove the tolerance, of nearly all chains, and cost less than full accuracy does.
    static bool counts_pay(const ChainKind& kind, const Question& question) {
        return question.rtol > 4096 * std::numeric_limits<double>::epsilon() * detail::real(kind.size) &&
               loose_cost(kind, question) < full_cost(kind, question);
    }
};

/// The chain condensed to blocks first: some of the slowest modes of a long chain, 2 ulp. Links that weigh next
/// to nothing beside what hangs below them join one by one.
struct Condensed {
    static constexpr std::string_view name = "condensed";
    static constexpr bool is_proved = true;

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (kind.size < 256) return Fit::no("fewer than 256 links");
        if (question.last() > kind.size / 8) return Fit::no("more than an eighth of the modes");
        return {};
    }
    double error_bound(const ChainKind&, const Question&) const { return detail::full_accuracy; }
    double cost(const ChainKind& kind, const Question& question) const {
        const double count = detail::real(question.count), skipped = detail::real(question.first - 1);
        // Long pendulums are not condensed. Light links above leave little to condense. Light links below, and modes of
        // high number, have short waves, so there are many blocks.
        const double few = kind.growth < -5 && kind.size < 2000 ? 0.35 : 1;
        return 3e-5 + 1.7e-9 * detail::real(kind.size) +
               detail::real(kind.size) * (1e-6 + 2e-7 * count) * kind.long_pendulums + 3e-7 * detail::real(kind.light) +
               2e-5 * std::max(0.0, kind.growth) +
               few *
                   (5e-5 * count * (1 + count / 20) + 7.5e-5 * skipped / (1 + 150 * skipped / detail::real(kind.size)));
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind&, const Question& question) const {
        auto found =
            revchain::detail::heights_by_condensation(chain, detail::range_of(question), detail::options_for(question));
        return found ? detail::answered(chain, std::move(found->found)) : Answer::none();
    }
};

/// All modes of a small chain at once in SIMD lanes, for plummets and for links whose pendulum length is less than
/// their length. Other chains, and those for which 1e-14 or the tolerance cannot be proved, are refused at once. The
/// predicted bound holds for most chains; with looser tolerances, up to 3e-11 was proved for links far apart.
struct Aberth {
    static constexpr std::string_view name = "aberth";
    static constexpr bool is_proved = true;
    static constexpr double loose = 1e-14;

    Fit applies(const ChainKind& kind, const Question&) const {
        if (kind.size > 100) return Fit::no("more than 100 links");
        if (!kind.short_pendulums) return Fit::no("pendulums as long as their links or longer, or of two kinds");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        // Limits measured with one heavy tip and with weights graded from the tip up, where numbers leave the range of
        // double. For chains of few links, trying costs less time than predicting that.
        if (kind.equal || kind.size < ChainKind::least_sampled) return {};
        const double n = detail::real(kind.size);
        const bool far_apart =
            kind.point_masses ? kind.range > 19.5 || n * kind.range > 790 : kind.greatest_pull * std::pow(n, 1.5) > 3e8;
        if (far_apart) return Fit::no("links that weigh too little beside what hangs below them");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const {
        return question.rtol >= loose ? loose : detail::full_accuracy;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double n = detail::real(kind.size), lanes = 8 * std::ceil(detail::real(question.count) / 8);
        return 5e-7 + 3.2e-8 * n + 5e-9 * n * n + (question.rtol >= loose ? 0 : 5e-7 + 2e-8 * n + 4.8e-9 * n * lanes);
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind&, const Question& question) const {
        return detail::answered(chain, revchain::detail::heights_by_aberth(chain, detail::range_of(question),
                                                                           detail::options_for(question)));
    }
};

/// The characteristic polynomial interpolated: many modes, to the last digit or 1e-14. As for `Aberth`, the predicted
/// bound holds for most chains.
struct Interpolated {
    static constexpr std::string_view name = "interpolated";
    static constexpr bool is_proved = true;
    static constexpr double loose = 1e-14;

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (kind.size < 12) return Fit::no("fewer than 12 links");
        if (question.count < 8) return Fit::no("fewer than 8 modes asked for");
        if (kind.negative_pins) return Fit::no("centroids too far below their links");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const {
        return question.rtol >= loose ? loose : detail::full_accuracy;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double n = detail::real(kind.size), count = detail::real(question.count);
        const double full = 1.2e-5 + 3.6e-7 * n + count * (1.4e-6 + 2.9e-9 * n);
        return question.rtol >= loose ? std::min(full, 2.5e-5 + n * (5e-7 + 2.5e-9 * count)) : full;
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind& kind, const Question& question) const {
        revchain::detail::LazyCounter<double> assembled(chain);
        return detail::answered(
            chain, revchain::detail::heights_by_interpolation(assembled, detail::range_of(question), kind.mode_count,
                                                              detail::options_for(question)));
    }
};

}  // namespace revchain::models
