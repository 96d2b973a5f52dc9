// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/path.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A model of the arc s of one crossing as a function of the free end's offset eta_0:
///     s - s(0) = c eta_0^2/(1 + b eta_0).
struct CrossingLaw {
    double quadratic, bend;

    /// Returns the law of the uniform chain: c from small amplitudes; c/b = 2 j - 1, since a
    /// stretched chain has half waves of length eta_0. The rise s - s(0) is right within 20 %.
    static CrossingLaw uniform(int crossing) {
        const double c = 0.502 * crossing - 0.15;
        return {c, c / (2 * crossing - 1)};
    }
    /// Returns the law through a value and a slope, if one fits; `otherwise` if none does.
    static CrossingLaw through(double tip_offset, double rise, double rate,
                               const CrossingLaw& otherwise) {
        const double power = rate * tip_offset / rise;  // local exponent of eta_0, between 2 and 1
        if (!(power > 1.0001 && power < 2)) return otherwise;
        const double b = (2 - power) / (power - 1);
        return {rise * (1 + b) / (tip_offset * tip_offset), b / tip_offset};
    }
    /// Returns the law of the crossing before, corrected from the uniform chain like this one.
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

/// A range of eta_0 in which a crossing passes the support, from below (`rises`) or from above.
struct TipRange {
    double low, high;
    bool rises;
};

/// An eta_0 for which a crossing is at `length`, within `near` relatively, and the law fitted to
/// the last path. Each step is by Newton's method or by that law. Paths far from the solution are
/// followed with lower accuracy. The value is 0 if a path could not be followed that far.
struct TipOffset {
    static constexpr double near = 1e-8;
    double value = 0;
    CrossingLaw law;
};
REVCHAIN_LAZY
TipOffset tip_offset(const PathKind& kind, int crossing, double place_at_rest, double length,
                     TipRange range, CrossingLaw law) {
    const auto middle = [&] {
        if (range.low == 0) return 0.1 * range.high;
        return std::clamp(std::sqrt(range.low) * std::sqrt(range.high), range.low, range.high);
    };
    const auto inside = [&](double tip) {
        return tip > range.low && tip < range.high ? tip : middle();
    };
    const double rise = length - place_at_rest;
    double tip = inside(std::min(law.tip_offset(rise), 0.999 * range.high)), last = 0.05;
    for (int round = 0; round < 200; ++round) {
        // The fitted law leaves 1e-2 of the step's square, relative to the rise. Near a critical
        // height the rise is a small part of the arc. More accuracy is not needed.
        const double square = last * last;
        const double tolerance =
            std::clamp(3e-3 * square * square * rise / length, PathSeries::rounding, 1e-7);
        const Path path(kind, tip, {.crossings = crossing, .tolerance = tolerance});
        if (static_cast<int>(path.crossings().size()) < crossing) return {0, law};
        const Path::Crossing& found = path.crossings().back();
        const double off = found.arc - length;
        ((off < 0) == range.rises ? range.low : range.high) = tip;
        law = CrossingLaw::through(tip, found.arc - place_at_rest, found.rate, law);
        const double newton = tip - off / found.rate, fitted = law.tip_offset(rise);
        double next = inside(std::abs(fitted - newton) < std::abs(newton - tip) ? fitted : newton);
        // steps that do not halve are no better than bisection
        if (round > 1 && std::abs(next / tip - 1) > 0.5 * last) next = middle();
        last = std::abs(next / tip - 1);
        tip = next;
        // the next step would be below the square of this one plus the tolerance
        if (last * last < TipOffset::near && std::abs(off) < 4e-4 * rise &&
            tolerance * length < TipOffset::near * rise)
            break;
    }
    return {tip, law};
}

}  // namespace revchain::finite
