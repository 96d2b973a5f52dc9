// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/path.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// What is known of how the place s of one crossing depends on the offset eta_0 of the free end: s(0), and elsewhere
/// s - s(0) = c eta_0^2/(1 + b eta_0), which is quadratic and then linear, as the chain is.
struct CrossingLaw {
    double quadratic, bend;

    /// The uniform chain's: c from its shapes of small amplitude, c/b = 2 j - 1 half waves of length eta_0 when it is
    /// stretched out. The rise within 20 percent.
    static CrossingLaw uniform(int crossing) {
        const double c = 0.502 * crossing - 0.15;
        return {c, c / (2 * crossing - 1)};
    }
    /// Through a value and a slope, where they fit.
    static CrossingLaw through(double tip_offset, double rise, double rate, const CrossingLaw& otherwise) {
        const double power = rate * tip_offset / rise;  // of eta_0 in the rise there: from 2 down to 1
        if (!(power > 1.0001 && power < 2)) return otherwise;
        const double b = (2 - power) / (power - 1);
        return {rise * (1 + b) / (tip_offset * tip_offset), b / tip_offset};
    }
    /// The law of the crossing before `crossing`, as far from that of the uniform chain as this one.
    CrossingLaw of_one_before(int crossing) const {
        if (crossing < 2) return *this;
        const CrossingLaw here = uniform(crossing), before = uniform(crossing - 1);
        return {quadratic * before.quadratic / here.quadratic, bend * before.bend / here.bend};
    }
    double tip_offset(double rise) const {
        const double half = 0.5 * bend * rise;
        return (half + std::sqrt(half * half + quadratic * rise)) / quadratic;
    }
};

/// Offsets of the free end between which a crossing comes to the support, from below (`rises`) or above.
struct TipRange {
    double low, high;
    bool rises;
};

/// The free end's offset for which crossing number `crossing` lies at `length`, and the law fitted to the last path
/// tried: Newton's method within the range, or that law. What is found is within `near` of the offset, relatively;
/// paths whose step is greater than that are followed no better than they need. 0 where the path could not be followed
/// that far.
struct TipOffset {
    static constexpr double near = 1e-8;
    double value = 0;
    CrossingLaw law;
};
inline TipOffset tip_offset(const PathKind& kind, int crossing, double place_at_rest, double length, TipRange range,
                            CrossingLaw law) {
    const auto middle = [&] {
        if (range.low == 0) return 0.1 * range.high;
        return std::clamp(std::sqrt(range.low) * std::sqrt(range.high), range.low, range.high);
    };
    const auto inside = [&](double tip) { return tip > range.low && tip < range.high ? tip : middle(); };
    const double rise = length - place_at_rest;
    double tip = inside(std::min(law.tip_offset(rise), 0.999 * range.high)), last = 0.05;
    for (int round = 0; round < 200; ++round) {
        // Fitted, the law leaves a hundredth of the step's square, and more than that need not be known: of the rise,
        // which near a critical height is a small part of the place.
        const double square = last * last;
        const double tolerance = std::clamp(3e-3 * square * square * rise / length, PathSeries::rounding, 1e-7);
        const Path path(kind, tip, {.crossings = crossing, .tolerance = tolerance});
        if (static_cast<int>(path.crossings().size()) < crossing) return {0, law};
        const Path::Crossing& found = path.crossings().back();
        const double off = found.arc - length;
        ((off < 0) == range.rises ? range.low : range.high) = tip;
        law = CrossingLaw::through(tip, found.arc - place_at_rest, found.rate, law);
        const double newton = tip - off / found.rate, fitted = law.tip_offset(rise);
        double next = inside(std::abs(fitted - newton) < std::abs(newton - tip) ? fitted : newton);
        // Steps that do not shrink by half are no better than halving, and may creep.
        if (round > 1 && std::abs(next / tip - 1) > 0.5 * last) next = middle();
        last = std::abs(next / tip - 1);
        tip = next;
        // Either step leaves less than its square, mostly a tenth of it, where the law holds that near; and what the
        // tolerance left.
        if (last * last < TipOffset::near && std::abs(off) < 4e-4 * rise && tolerance * length < TipOffset::near * rise)
            break;
    }
    return {tip, law};
}

/// The height at which a falling or rising function of it is 0: from a height at which it is
/// positive (or above all such) downwards, then secants on the logarithm of the ratio of the two,
/// whatever the unit, within the bracket.
template <class F>
double height_where(const F& excess, double from) {
    const auto value_at = [&](double x) { return excess(from * std::exp(x)); };
    double high = 0, low = high, at_high = value_at(0), at_low = at_high;
    for (int i = 0; i < 1000 && at_high < 0; ++i) low = high, at_low = at_high, high += 0.7, at_high = value_at(high);
    for (int i = 0; i < 1000 && at_low > 0; ++i) high = low, at_high = at_low, low -= 0.7, at_low = value_at(low);
    const auto near = [&](double x) {
        const double value = value_at(x);
        return std::abs(value) <= 2 * epsilon<double>() ? 0.0 : value;
    };
    using revchain::detail::zero_without_slope;
    return from * std::exp(zero_without_slope(low, high, at_low, at_high, near));
}

}  // namespace revchain::finite
