// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "revchain/system/line_density.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Weight per length of a cord, s the distance from the free end: the exponent p of s^p; a function
/// of s; or such a function as polynomials, which several cords may share.
using CordDensity =
    std::variant<double, std::function<double(double)>, std::shared_ptr<const LineDensity>>;

/// The weights of a cord. Where `weight` is given, only the proportions of `density` count.
struct CordOptions {
    std::optional<double>
        weight{};  ///< of the cord without the tip; absent: 1, or the total of a density function
    CordDensity density =
        0.0;  ///< weight per length; exponent 0: uniform, 1: thicker towards the support
    double tip_weight = 0;  ///< of a particle at the free end, in the unit of `weight`
};

/// A perfectly flexible cord hung from one end, the limit of a chain of ever more links.
///
/// Throws InvalidArgument for a length or weight that is not positive and finite, a tip weight that
/// is negative or not finite, an exponent not above -1 or above 1e4, a density function that is not
/// positive inside the cord or too rough (see `LineDensity`), and polynomials over another length.
/// Cost: 1200 calls of a density function or more, else none.
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
    /// The length of cord of that mean weight that weighs as much as the tip.
    double tip_length() const { return tip_weight_ / line_weight(); }
    /// The exponent of the density; absent where it was given as a function.
    std::optional<double> exponent() const { return exponent_; }
    bool is_uniform() const { return exponent_ == 0.0; }
    /// The density as polynomials up to a factor, for a power computed at each call; null for a
    /// uniform cord. Throws InvalidArgument for an exponent above 20: s^p would underflow.
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
