// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/interpolated_heights.hpp"
#include "revchain/models/bisection.hpp"

/// The methods for many modes at once, as models. Their bounds are proved.
namespace revchain::inline REVCHAIN_BUILD::models {

/// All modes of a small chain at once in SIMD lanes, for plummets and for links whose pendulum
/// length is less than their length. Other chains, and those for which 1e-14 or the tolerance
/// cannot be proved, are refused at once. The predicted bound holds for most chains; with looser
/// tolerances, up to 3e-11 was proved for links far apart.
struct Aberth {
    static constexpr std::string_view name = "aberth";
    static constexpr bool is_proved = true;
    static constexpr double loose = 1e-14;

    Fit applies(const ChainKind& kind, const Question&) const {
        if (kind.size > 100) return Fit::no("more than 100 links");
        if (!kind.short_pendulums)
            return Fit::no("pendulums as long as their links or longer, or of two kinds");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        // Limits measured with one heavy tip and with weights graded from the tip up, where numbers
        // leave the range of double. For chains of few links, trying costs less time than
        // predicting that.
        if (kind.equal || kind.size < ChainKind::least_sampled) return {};
        const double n = detail::real(kind.size);
        const bool far_apart = kind.point_masses ? kind.range > 19.5 || n * kind.range > 790
                                                 : kind.greatest_pull * std::pow(n, 1.5) > 3e8;
        if (far_apart) return Fit::no("links that weigh too little beside what hangs below them");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const {
        return question.rtol >= loose ? loose : detail::full_accuracy;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double n = detail::real(kind.size),
                     lanes = 8 * std::ceil(detail::real(question.count) / 8);
        return 5e-7 + 3.2e-8 * n + 5e-9 * n * n +
               (question.rtol >= loose ? 0 : 5e-7 + 2e-8 * n + 4.8e-9 * n * lanes);
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind&, const Question& question) const {
        detail::Assembled assembled(chain, question);
        return detail::answered(chain, revchain::detail::heights_by_aberth(
                                           chain, assembled.counter(), detail::range_of(question),
                                           detail::options_for(question)));
    }
};

/// Interpolates the characteristic polynomial, for many modes, to the last digit or 1e-14. As for
/// `Aberth`, the predicted bound holds for most chains.
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
        detail::Assembled assembled(chain, question);
        return detail::answered(chain, revchain::detail::heights_by_interpolation(
                                           assembled.counter(), detail::range_of(question),
                                           kind.mode_count, detail::options_for(question)));
    }
};

}  // namespace revchain::models
