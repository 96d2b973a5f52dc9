// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/continuous_shape.hpp"

namespace revchain {

/// The shapes found, and whether there are more.
struct ContinuousShapes {
    std::vector<ContinuousShape> shapes;  ///< by half waves
    bool complete = false;                ///< a theorem says that there are no others
};

namespace finite {

inline void check(std::string_view place, const ContinuousChain& chain) {
    detail::require_positive(place, "length", chain.length);
    if (!(chain.tip_weight >= 0 && std::isfinite(chain.tip_weight)))
        detail::refuse(place, "tip weight must not be negative, and finite", chain.tip_weight);
    if (chain.density != nullptr && chain.density->length() != chain.length)
        detail::refuse(place, "the line density must be given over the length of the chain, not over",
                       chain.density->length());
}

inline double weight_unit(const ContinuousChain& chain) {
    return chain.density == nullptr ? 1.0 : chain.density->total() / chain.length;
}

inline PathKind kind_of(const ContinuousChain& chain, double height, double bend) {
    const double unit = weight_unit(chain);
    return {chain.tip_weight / unit / height, height, unit, chain.density, bend};
}

/// What is known of how the place s of one crossing depends on the offset eta_0 of the free end: s(0), and elsewhere
/// s - s(0) = c eta_0^2/(1 + b eta_0), which is quadratic and then linear, as the chain is.
struct CrossingLaw {
    double quadratic, bend;

    /// The uniform chain's: c from the shapes of small amplitude, c/b = 2 j - 1 half waves of length eta_0 when the chain is
    /// stretched out. D within 20 percent.
    static CrossingLaw uniform(int crossing) {
        const double c = 0.502 * crossing - 0.15;
        return {c, c / (2 * crossing - 1)};
    }
    /// Through a value and a slope.
    static CrossingLaw through(double tip_offset, double rise, double rate, const CrossingLaw& otherwise) {
        const double power = rate * tip_offset / rise;  // of eta_0 in the rise there: from 2 down to 1
        if (!(power > 1.0001 && power < 2)) return otherwise;
        const double b = (2 - power) / (power - 1);
        return {rise * (1 + b) / (tip_offset * tip_offset), b / tip_offset};
    }
    double tip_offset(double rise) const {
        const double half = 0.5 * bend * rise;
        return (half + std::sqrt(half * half + quadratic * rise)) / quadratic;
    }
};

/// The free end's offset for which crossing number j lies at `length`, between 0 and `most`: its place grows with the
/// offset. The law above is fitted to each path tried, and kept within what the signs leave. What is found is within
/// `near` of the offset, relatively; paths whose step is greater than that are followed no better than they need.
class TipOffset {
   public:
    static constexpr double near = 1e-8;

    TipOffset(const PathKind& kind, int crossing, double place_at_rest, double length, double most, const CrossingLaw& law)
        : law_(law), low_(0), high_(most) {
        const double rise = length - place_at_rest;
        double tip = inside(law_.tip_offset(rise)), last = 0.03;
        for (int round = 0; round < 200; ++round) {
            // The rise is what must be known: near a critical height it is a small part of the place.
            const double tolerance = std::clamp(1e-3 * last * last * rise / length, PathSeries::rounding, 1e-7);
            const Path path(kind, tip, {.crossings = crossing, .tolerance = tolerance});
            ++rounds;
            const Path::Crossing& found = path.crossings().back();
            const double off = found.arc - length;
            (off < 0 ? low_ : high_) = tip;
            law_ = CrossingLaw::through(tip, found.arc - place_at_rest, found.rate, law_);
            const double newton = tip - off / found.rate, fitted = law_.tip_offset(rise);
            const double next = std::abs(fitted - newton) < std::abs(newton - tip) ? fitted : newton;
            last = std::abs(next / tip - 1);
            // Either step leaves less than its square, mostly a tenth of it; and what the tolerance left.
            const bool enough = last * last < near && tolerance * length < near * rise;
            tip = inside(next);
            if (enough || tip == low_ || tip == high_) break;
        }
        value_ = tip;
    }
    double value() const { return value_; }
    const CrossingLaw& law() const { return law_; }
    int rounds = 0;

   private:
    double inside(double tip) const {
        if (tip > low_ && tip < high_) return tip;
        return low_ > 0 ? std::sqrt(low_ * high_) : 0.1 * high_;
    }

    CrossingLaw law_;
    double low_, high_, value_ = 0;
};

/// Places of the crossings of the chain at small amplitude below `farthest`, over the conical height.
inline std::vector<double> crossings_at_rest(const ContinuousChain& chain, double height, double farthest) {
    const Path path(kind_of(chain, height, 0), 1, {.farthest = farthest, .with_change = false});
    std::vector<double> places;
    for (const Path::Crossing& crossing : path.crossings())
        if (crossing.arc <= farthest) places.push_back(crossing.arc);
    return places;
}

inline ContinuousShapes continuous_shapes(const ContinuousChain& chain, double height) {
    const double length = chain.length / height;
    const PathKind kind = kind_of(chain, height, 1);
    const std::vector<double> at_rest = crossings_at_rest(chain, height, length * (1 + 64 * epsilon<double>()));
    ContinuousShapes result;
    const bool theorem = chain.density == nullptr && chain.tip_weight == 0;
    result.complete = theorem || at_rest.size() <= 1;
    CrossingLaw law = CrossingLaw::uniform(static_cast<int>(at_rest.size()));
    for (std::size_t j = at_rest.size(); j-- > 0;) {
        const int crossing = static_cast<int>(j) + 1;
        if (!(at_rest[j] < length * (1 - 16 * epsilon<double>()))) {  // which side of the critical height, nobody can say
            result.complete = false;
            continue;
        }
        const TipOffset tip(kind, crossing, at_rest[j], length, length, law);
        double value = tip.value();
        for (int round = 0; round < 4; ++round) {
            ShapeSamples samples(kind, value);
            const Path path(kind, value, {.crossings = crossing}, samples);
            const Path::Crossing& support = path.crossings().back();
            const double step = (length - support.arc) / support.rate;
            if (std::abs(step) < TipOffset::near * value || round == 3) {
                result.shapes.push_back(samples.finish(path, crossing, chain.length, height));
                break;
            }
            value += step;
        }
        // The next law: the uniform chain's, corrected as this one was.
        const CrossingLaw here = CrossingLaw::uniform(crossing), next = CrossingLaw::uniform(crossing - 1);
        law = {tip.law().quadratic * next.quadratic / here.quadratic, tip.law().bend * next.bend / here.bend};
    }
    std::reverse(result.shapes.begin(), result.shapes.end());
    return result;
}

}  // namespace finite

inline ContinuousShapes continuous_shapes(const ContinuousChain& chain, double height) {
    finite::check("continuous_shapes", chain);
    detail::require_positive("continuous_shapes", "conical height", height);
    return finite::continuous_shapes(chain, height);
}

}  // namespace revchain
