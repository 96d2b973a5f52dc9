// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/condensed_shapes.hpp"
#include "revchain/models/bisection.hpp"

/// The method for a few of the slowest modes of a long chain, as a model. Its bounds are proved.
namespace revchain::inline REVCHAIN_BUILD::models {

/// Condenses the chain to blocks first, for some of the slowest modes of a long chain, to 2 ulp.
/// Links that weigh almost nothing beside the weight below them are added one by one.
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
        const double count = detail::real(question.count),
                     skipped = detail::real(question.first - 1);
        // Long pendulums are not condensed. Light links above leave little to condense. Light links
        // below and modes of high number have short waves, which need many blocks.
        const double few = kind.growth < -5 && kind.size < 2000 ? 0.35 : 1;
        const double grown = std::clamp(kind.growth, 0.0, detail::real(kind.size) / 40);
        return 3e-5 + 1.7e-9 * detail::real(kind.size) +
               detail::real(kind.size) * (1e-6 + 2e-7 * count) * kind.long_pendulums +
               3e-7 * detail::real(kind.light) + 2e-5 * grown +
               few * (5e-5 * count * (1 + count / 20) +
                      7.5e-5 * skipped / (1 + 150 * skipped / detail::real(kind.size)));
    }
    template <std::same_as<double> T>
    Answer solve(const Chain<T>& chain, const ChainKind&, const Question& question) const {
        auto found = revchain::detail::heights_by_condensation(chain, detail::range_of(question),
                                                               detail::options_for(question));
        return found ? detail::answered(chain, std::move(found->found)) : Answer::none();
    }
};

}  // namespace revchain::models
