// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/model.hpp"
#include "revchain/two_links.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// Heights of one link, a length, or of two links, the roots of a quadratic. Greenhill (1908) §1,
/// §2 (5), §6 (11), §8 (12), (14). Error bound 8 ulp, measured 2.6 (tests/cpp/models/models.cpp).
/// Cost 0.2 microseconds.
struct ClosedForms {
    static constexpr std::string_view name = "closed forms";
    static constexpr double bound = 8 * std::numeric_limits<double>::epsilon();

    Fit applies(const ChainKind& kind, const Question&) const {
        if (kind.size > 2) return Fit::no("more than two links");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        if (!kind.centroids_below)
            return Fit::no("a centroid above its pin");  // a sum would cancel
        return {};
    }
    double error_bound(const ChainKind&, const Question&) const { return bound; }
    double cost(const ChainKind&, const Question&) const { return 1.7e-7; }

    Answer solve(const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) const {
        const int exponent =
            chain.units().length_exponent;  // squares and products of lengths stay in range
        const Link<double> lower = link_in_unit(chain, 0);
        const double turning = turning_of(lower), l = turning / lower.centroid;
        HeightPair<double> heights{l, 0};
        if (kind.size == 2) {
            const Link<double> upper = link_in_unit(chain, 1);
            const double unit = lower.weight + upper.weight, w1 = lower.weight / unit,
                         w2 = upper.weight / unit;
            const double a = upper.length, second = turning_of(upper);
            const double kappa = w2 * upper.centroid + w1 * a;
            const double q = (w2 * second + w1 * a * a) / kappa,
                         coupling = w1 * lower.centroid * a * a / kappa;
            const double beyond =
                turning_ratio(lower) * lower.length * lower.length / lower.centroid;  // l - h
            const double rest = (l * w2 * second + w1 * a * a * beyond) / kappa;
            heights = revchain::detail::coupled_roots(l, q, coupling, rest);
        }
        Answer answer{Vector<double>(question.count),
                      Vector<double>::Constant(question.count, bound)};
        for (Index j = 0; j < question.count; ++j) {
            answer.conical_height[j] =
                std::ldexp(heights[static_cast<std::size_t>(question.first - 1 + j)], exponent);
            answer.found = answer.found && std::isnormal(answer.conical_height[j]);
        }
        return answer;
    }

    /// Returns link m with its lengths in the unit of the chain, a power of two.
    static Link<double> link_in_unit(const Chain<double>& chain, Index m) {
        Link<double> link = chain.link(m);
        const int to_unit = -chain.units().length_exponent;
        link.length = std::ldexp(link.length, to_unit),
        link.centroid = std::ldexp(link.centroid, to_unit);
        return link;
    }
    /// Returns h l = h^2 + rho^2.
    static double turning_of(const Link<double>& link) {
        return link.centroid * link.centroid + turning_ratio(link) * link.length * link.length;
    }

   private:
    static double turning_ratio(const Link<double>& link) {
        return static_cast<double>(link.gyration_ratio);
    }
};

/// The height of one link at any inclination: lambda = l cos delta. Greenhill (1908) §1, §6. Error
/// bound and cost are those of `ClosedForms`.
struct ConicalPendulum {
    static constexpr std::string_view name = "conical pendulum";
    static constexpr bool is_linear = false;

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (kind.size > 1) return Fit::no("more than one link");
        if (!(question.inclination > 0)) return Fit::no("no inclination given");
        return {};
    }
    double error_bound(const ChainKind&, const Question&) const { return ClosedForms::bound; }
    double cost(const ChainKind&, const Question&) const { return 1.7e-7; }

    Answer solve(const Chain<double>& chain, const ChainKind&, const Question& question) const {
        const Link<double> link = ClosedForms::link_in_unit(chain, 0);
        const double height = std::ldexp(
            ClosedForms::turning_of(link) / link.centroid * std::cos(question.inclination),
            chain.units().length_exponent);
        return {Vector<double>::Constant(1, height),
                Vector<double>::Constant(1, ClosedForms::bound), std::isnormal(height)};
    }
};

}  // namespace revchain::models
