// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "revchain/system/line_density.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The weight per length of a cord at the distance s from the free end. It is given as the exponent
/// p of s^p, as a function of s, or as polynomials, which several cords may share.
using CordDensity =
    std::variant<double, std::function<double(double)>, std::shared_ptr<const LineDensity>>;

/// The weights of a cord. If `weight` is given, only ratios of `density` matter.
struct CordOptions {
    std::optional<double>
        weight{};  ///< weight of the cord without the tip; absent: 1, or the integral of a density
                   ///< function
    CordDensity density =
        0.0;  ///< weight per length; exponent 0: uniform, 1: thicker towards the support
    double tip_weight = 0;  ///< of a particle at the free end, in the unit of `weight`
};

/// A perfectly flexible cord hung from one end, the limit of a chain of ever more links.
///
/// Throws InvalidArgument for a length or weight that is not positive and finite, and for a tip
/// weight that is negative or not finite. Also throws for an exponent not above -1 or above 1e4, a
/// density function that is not positive inside the cord or too rough (see `LineDensity`), and
/// polynomials over another length.
/// Cost: at least 1200 calls of a density function if one is given, else none.
class Cord {
   public:
    explicit Cord(double length, const CordOptions& options = {})
        : length_(length), weight_(options.weight.value_or(1)), tip_weight_(options.tip_weight) {
        detail::require_positive("Cord", "length", length);
        if (const double* exponent = std::get_if<double>(&options.density)) {
            if (!(*exponent > -1 && *exponent <= 1e4))
                detail::throw_invalid(
                    "Cord", "the exponent of the density must be above -1 and at most 1e4",
                    *exponent);
            exponent_ = *exponent;
        } else {
            if (const auto* function =
                    std::get_if<std::function<double(double)>>(&options.density)) {
                if (!*function)
                    detail::throw_invalid("Cord",
                                          "the density must be a function, not an empty one");
                density_ = std::make_shared<LineDensity>(*function, length);
            } else {
                density_ = std::get<std::shared_ptr<const LineDensity>>(options.density);
            }
            if (!density_ || density_->length() != length)
                detail::throw_invalid(
                    "Cord", "the density must be given over the length of the cord, not over",
                    density_ ? density_->length() : 0.0);
            if (!options.weight) weight_ = density_->total();
        }
        detail::require_positive("Cord", "weight", weight_);
        detail::require_not_negative("Cord", "tip weight", tip_weight_);
    }

    double length() const { return length_; }
    double weight() const { return weight_; }
    double tip_weight() const { return tip_weight_; }
    /// Mean weight per length.
    double line_weight() const { return weight_ / length_; }
    /// The length of cord, at the mean weight per length, that weighs as much as the tip.
    double tip_length() const { return tip_weight_ / line_weight(); }
    /// The exponent of the density; absent if it was given as a function.
    std::optional<double> exponent() const { return exponent_; }
    bool is_uniform() const { return exponent_ == 0.0; }
    /// Returns the density as polynomials, up to a factor; null for a uniform cord. For a power s^p
    /// they are computed at each call. Throws InvalidArgument for an exponent above 20, because s^p
    /// would underflow.
    std::shared_ptr<const LineDensity> line_density() const {
        if (!exponent_ || is_uniform()) return density_;
        if (!(*exponent_ <= 20))
            detail::throw_invalid(
                "Cord", "power series take exponents of the density up to 20 only", *exponent_);
        return std::make_shared<LineDensity>(
            [length = length_, p = *exponent_](double s) { return std::pow(s / length, p); },
            length_);
    }

   private:
    double length_, weight_, tip_weight_;
    std::optional<double> exponent_;
    std::shared_ptr<const LineDensity> density_;
};

}  // namespace revchain
