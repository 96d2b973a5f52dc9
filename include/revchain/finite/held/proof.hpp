// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/sweep.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

REVCHAIN_LAZY
double largest(const Span& x) { return as_double(x.size()) * 1.0000001; }

/// Encloses the direction of a link near one found. Returns the derivative of the link's moment by
/// the inclination; not positive if the link may be slack or have another inclination.
REVCHAIN_LAZY
Span enclose_direction(const Link<Span>& link, const Span& R, const Span& V,
                       const Direction<Far>& found, Direction<Span>& way) {
    if (is_zero(link.cross)) {
        const Span sum = square(R) + square(V);
        if (!sum.positive()) return Span(Far(0));
        const Span pull = sqrt(sum);
        way = {R / pull, V / pull};
        return pull;
    }
    return enclose_rigid_direction(link, R, V, found, way);
}

/// Encloses the upper end for forces at the lower end within `radius` of those of a state with
/// directions `found`. Also returns the sine of the largest turn of a link from these directions.
REVCHAIN_LAZY
std::pair<HeldEnd<Span, 2>, double> held_box(const EnclosedLinks<Far>& links,
                                             const HeldEnds<Span>& ends, const Span& height,
                                             const std::array<Far, 2>& forces,
                                             const std::array<double, 2>& radius,
                                             const std::vector<Direction<Far>>& found) {
    const auto about = [&](std::size_t i) {
        const Far off(radius[i]);
        return Span(detail::down(Far(forces[i] - off)), detail::up(Far(forces[i] + off)));
    };
    double turned = 0;
    const auto enclose_link = [&](std::size_t m, const Span& R, const Span& V,
                                  Direction<Span>& way) {
        const Span stiffness = enclose_direction(links[m], R, V, found[m], way);
        const double turn =
            largest(way.sine * Span(found[m].cosine) - way.cosine * Span(found[m].sine));
        if (!(turn < 1)) return Span(Far(0));
        turned = std::max(turned, turn);
        return stiffness;
    };
    const auto end =
        held_sweep<2>(links, ends, {about(0), about(1), height, Span(Far(1))}, enclose_link);
    return {end, turned};
}

/// Bounds the angle (rad) between found directions and those of the one steady shape near them at a
/// span, by Krawczyk's test on the two forces at the lower end (doi:10.1007/BF02234767). Infinite
/// if the test decides nothing: intervals grow by about e^pi for each half wave.
REVCHAIN_LAZY
double held_error(const EnclosedLinks<Far>& links, const HeldEnds<Span>& ends, const Span& height,
                  const Span& span, const std::array<Far, 2>& forces,
                  const std::vector<Direction<Far>>& found) {
    constexpr double unproved = std::numeric_limits<double>::infinity();
    const auto centre = held_box(links, ends, height, forces, {0, 0}, found).first;
    if (!centre.known) return unproved;
    const auto slope = [](const Span& x) { return as_double(x.middle()); };
    const double a = slope(centre.offset_change[0]), b = slope(centre.offset_change[1]),
                 c = slope(centre.rise_change[0]), d = slope(centre.rise_change[1]),
                 determinant = a * d - b * c;
    if (!(std::abs(determinant) > 0)) return unproved;
    const auto entry = [&](double x) { return Span(Far(x / determinant)); };
    const std::array<Span, 4> inverse{entry(d), entry(-b), entry(-c), entry(a)};
    const Span missed = centre.rise - span;
    std::array<double, 2> step, radius;
    for (std::size_t i = 0; i < 2; ++i)
        step[i] = largest(inverse[2 * i] * centre.offset + inverse[2 * i + 1] * missed);
    radius = {2 * step[0] + 1e-290, 2 * step[1] + 1e-290};
    for (int round = 0; round < 4; ++round) {
        const auto [end, turned] = held_box(links, ends, height, forces, radius, found);
        if (!end.known) return unproved;
        bool inside = true;
        std::array<double, 2> image;
        for (std::size_t i = 0; i < 2; ++i) {
            image[i] = step[i];
            for (std::size_t j = 0; j < 2; ++j) {
                const Span product =
                    inverse[2 * i] * end.offset_change[j] + inverse[2 * i + 1] * end.rise_change[j];
                image[i] += largest(Span(Far(i == j ? 1.0 : 0.0)) - product) * radius[j];
            }
            inside = inside && image[i] < radius[i];
        }
        if (inside) return std::asin(std::min(1.0, turned)) * 1.0000001;
        for (std::size_t i = 0; i < 2; ++i) radius[i] = 2 * std::max(image[i], radius[i]);
    }
    return unproved;
}

}  // namespace revchain::finite
