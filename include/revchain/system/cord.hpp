// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "revchain/system/line_density.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The weight per length of a cord at the distance s from the free end. It is given as the exponent
/// p of s^p, as a function of s, or as polynomials, which several cords may share.
using CordDensity =
    std::variant<double, std::function<double(double)>, std::shared_ptr<const LineDensity>>;

/// The weights of a cord. If `weight` is given, only ratios of `density` matter.
///
/// A tip weight with `tip_centroid` or `tip_radius_of_gyration` is a bob that turns about the end of
/// the cord, as the lowest link of a chain does, instead of a particle.
struct CordOptions {
    std::optional<double>
        weight{};  ///< weight of the cord without the tip; absent: 1, or the integral of a density
                   ///< function
    CordDensity density =
        0.0;  ///< weight per length; exponent 0: uniform, 1: thicker towards the support
    double tip_weight = 0;  ///< of a particle or bob at the free end, in the unit of `weight`
    std::map<double, double> weights{};  ///< of particles on the cord, by the distance from the
                                         ///< free end, in the unit of `weight`
    std::vector<double> breaks{};        ///< distances at which a density function jumps
    double tip_centroid = 0;             ///< distance of the bob's centre of gravity below the end
    double tip_radius_of_gyration = 0;   ///< of the bob, about its centre of gravity
};

/// A perfectly flexible cord hung from one end, the limit of a chain of ever more links.
///
/// Throws InvalidArgument for a length or weight that is not positive and finite, and for a tip
/// weight that is negative or not finite. Also throws for an exponent not above -1 or above 1e4, a
/// density function that is not positive inside the cord or too rough (see `LineDensity`),
/// polynomials over another length, breaks without a function, particles and breaks not inside the
/// cord, and a bob without weight or with a radius of gyration but no centroid: it would turn with
/// nothing to hold it.
/// Cost: at least 1200 calls of a density function if one is given, or of a power if there are
/// particles, else none.
class Cord {
   public:
    explicit Cord(double length, const CordOptions& options = {})
        : length_(length),
          weight_(options.weight.value_or(1)),
          tip_weight_(options.tip_weight),
          tip_centroid_(options.tip_centroid),
          tip_radius_of_gyration_(options.tip_radius_of_gyration) {
        detail::require_positive("Cord", "length", length);
        std::shared_ptr<const LineDensity> given;
        if (const double* exponent = std::get_if<double>(&options.density)) {
            if (!(*exponent > -1 && *exponent <= 1e4))
                detail::throw_invalid(
                    "Cord", "the exponent of the density must be above -1 and at most 1e4",
                    *exponent);
            if (!options.breaks.empty())
                detail::throw_invalid(
                    "Cord", "breaks are for a density function; this density is s^p, p", *exponent);
            exponent_ = *exponent;
        } else {
            given = density_given(options);
        }
        if (given && !options.weight) weight_ = given->total();
        detail::require_positive("Cord", "weight", weight_);
        detail::require_not_negative("Cord", "tip weight", tip_weight_);
        check_bob();
        hang(given, options.weights);
    }

    double length() const { return length_; }
    double weight() const { return weight_; }
    double tip_weight() const { return tip_weight_; }
    double tip_centroid() const { return tip_centroid_; }
    double tip_radius_of_gyration() const { return tip_radius_of_gyration_; }
    /// Whether the tip is a body that turns, not a particle.
    bool has_bob() const { return tip_centroid_ > 0; }
    /// Throws InvalidArgument for a bob, whose motion `place` does not know.
    void require_no_bob(std::string_view place) const {
        if (has_bob())
            detail::throw_invalid(place,
                                  "a cord with a bob has small motions only (modes, count_modes): "
                                  "cut it into links, the lowest of them the bob; tip centroid",
                                  tip_centroid_);
    }
    /// Whether there is neither a bob nor a particle on the cord.
    bool is_plain() const { return weights_.empty() && !has_bob(); }
    /// Weights of the particles on the cord, by their distances from the free end.
    const std::map<double, double>& weights() const { return weights_; }
    /// Mean weight per length, with the particles.
    double line_weight() const { return (weight_ + particles_) / length_; }
    /// The length of cord, at the mean weight per length, that weighs as much as the tip.
    double tip_length() const { return tip_weight_ / line_weight(); }
    /// The exponent of the density; absent if it was given as a function.
    std::optional<double> exponent() const { return exponent_; }
    /// Whether the weight is spread evenly, without particles.
    bool is_uniform() const { return exponent_ == 0.0 && weights_.empty(); }
    /// Whether the density is a power of s, without particles.
    bool is_power() const { return exponent_ && weights_.empty(); }
    /// Returns the density with the particles as polynomials, up to a factor; null for a uniform
    /// cord. For a power s^p they are computed at each call. Throws InvalidArgument for an exponent
    /// above 20, because s^p would underflow.
    std::shared_ptr<const LineDensity> line_density() const {
        return !is_power() || is_uniform() ? density_ : power();
    }

   private:
    std::shared_ptr<const LineDensity> density_given(const CordOptions& options) const {
        if (const auto* made = std::get_if<std::shared_ptr<const LineDensity>>(&options.density)) {
            if (!*made || (*made)->length() != length_)
                detail::throw_invalid(
                    "Cord", "the density must be given over the length of the cord, not over",
                    *made ? (*made)->length() : 0.0);
            if (!options.breaks.empty())
                detail::throw_invalid("Cord", "breaks are for a density function, not polynomials");
            return *made;
        }
        const auto& function = std::get<std::function<double(double)>>(options.density);
        if (!function)
            detail::throw_invalid("Cord", "the density must be a function, not an empty one");
        return std::make_shared<LineDensity>(function, length_, options.breaks);
    }
    std::shared_ptr<const LineDensity> power() const {
        if (!(*exponent_ <= 20))
            detail::throw_invalid(
                "Cord", "power series take exponents of the density up to 20 only", *exponent_);
        return std::make_shared<LineDensity>(
            [length = length_, p = *exponent_](double s) { return std::pow(s / length, p); },
            length_);
    }
    void check_bob() const {
        detail::require_not_negative("Cord", "tip centroid", tip_centroid_);
        detail::require_not_negative("Cord", "tip radius of gyration", tip_radius_of_gyration_);
        if (tip_centroid_ == 0 && tip_radius_of_gyration_ > 0)
            detail::throw_invalid("Cord",
                                  "a bob with a radius of gyration needs a tip centroid above 0: "
                                  "hung at its centre of gravity it would turn with nothing to "
                                  "hold it; tip radius of gyration",
                                  tip_radius_of_gyration_);
        if (tip_centroid_ > 0 && tip_weight_ == 0)
            detail::throw_invalid("Cord", "a bob needs a tip weight above 0, not", tip_weight_);
    }
    /// Stores the density, with the particles at the weight of the cord.
    void hang(std::shared_ptr<const LineDensity> given, const std::map<double, double>& weights) {
        for (const auto& [s, weight] : weights) {
            detail::require_not_negative("Cord", "weight of a particle", weight);
            if (weight > 0) weights_[s] = weight, particles_ += weight;
        }
        density_ = std::move(given);
        if (weights_.empty()) return;
        if (!density_)
            density_ = exponent_ == 0.0
                           ? std::make_shared<const LineDensity>(
                                 length_,
                                 std::vector<LineDensity::Piece>{{length_ / 2, length_ / 2, {1.0}}})
                           : power();
        density_ = std::make_shared<const LineDensity>(
            density_->with_particles(weight_ / density_->total(), weights_));
    }
    double length_, weight_, tip_weight_, tip_centroid_, tip_radius_of_gyration_, particles_ = 0;
    std::map<double, double> weights_;
    std::optional<double> exponent_;
    std::shared_ptr<const LineDensity> density_;
};

}  // namespace revchain
