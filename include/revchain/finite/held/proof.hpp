// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/sweep.hpp"
#include "revchain/numeric/double_double.hpp"

namespace revchain::finite {

/// Forces at the lower end within intervals: what is proved of the upper end and of all inclinations.
class HeldBox {
   public:
    using Far = DoubleDouble;
    using Span = Interval<Far>;

    /// A box of forces about a state, `radius` wide to either side in each; `found` the directions there. Nothing is
    /// `known` where a link may be slack or settle elsewhere.
    HeldBox(const std::vector<Link<Span>>& links, const Span& height, const std::array<Far, 2>& forces,
            const std::array<double, 2>& radius, const std::vector<Direction<Far>>& found) {
        const auto about = [](const Far& x, double r) {
            return Span(revchain::detail::down(Far(x - Far(r))), revchain::detail::up(Far(x + Far(r))));
        };
        Span H = about(forces[0], radius[0]), y(Far(0));
        const Span along = about(forces[1], radius[1]);
        std::array<Span, 2> H_change{Span(Far(1)), Span(Far(0))}, y_change{Span(Far(0)), Span(Far(0))},
            z_change = y_change;
        rise = Span(Far(0));
        for (std::size_t m = 0; m < links.size(); ++m) {
            const Link<Span>& link = links[m];
            const Span R = H + link.moment * y, V = height * link.pull + along;
            Direction<Span> way;
            Span growth;
            if (!settled(link, R, V, found[m], way, growth)) return;
            const Direction<Span> there{Span(found[m].sine), Span(found[m].cosine)};
            const Span off = way.sine * there.cosine - way.cosine * there.sine;
            const double turn_here = largest(off);
            if (!(turn_here < 1)) return;
            turned = std::max(turned, turn_here);
            y = y - link.length * way.sine, rise = rise + link.length * way.cosine;
            for (std::size_t i = 0; i < 2; ++i) {
                const Span R_change = H_change[i] + link.moment * y_change[i];
                const Span moment = i == 0 ? way.cosine * R_change : way.cosine * R_change - way.sine;
                const Span turn = moment / growth;
                y_change[i] = y_change[i] - link.length * way.cosine * turn;
                z_change[i] = z_change[i] - link.length * way.sine * turn;
                H_change[i] = R_change + link.rest * y_change[i];
            }
            H = R + link.rest * y;
        }
        offset = y;
        change = {y_change[0], y_change[1], z_change[0], z_change[1]};
        known = true;
    }

    Span offset, rise;
    std::array<Span, 4> change;  ///< of the end's offset, then of its rise, with either force
    double turned = 0;           ///< sine of the largest turn of a link away from the directions given
    bool known = false;

    static double largest(const Span& x) { return static_cast<double>(x.size()) * 1.0000001; }

   private:
    static bool settled(const Link<Span>& link, const Span& R, const Span& V, const Direction<Far>& found,
                        Direction<Span>& way, Span& growth) {
        if (link.cross.low == Far(0) && link.cross.high == Far(0)) {
            const Span sum = square(R) + square(V);
            if (!sum.positive()) return false;
            growth = sqrt(sum);
            way = {R / growth, V / growth};
            return true;
        }
        // Newton's method in intervals, the inclination within `reach` of that found
        const Span size = sqrt(square(Span(found.sine)) + square(Span(found.cosine)));
        const Span s = Span(found.sine) / size, c = Span(found.cosine) / size, turn = link.length * link.cross;
        const Span left = V * s + turn * s * c - R * c;
        double reach = 1e-28;
        for (int round = 0; round < 60; ++round, reach *= 8) {
            const Span within(Far(-reach), Far(reach));
            way = {s + within, c + within};
            growth = V * way.cosine + turn * (square(way.cosine) - square(way.sine)) + R * way.sine;
            if (!growth.positive()) return false;
            if (largest(left / growth) < reach) return true;
        }
        return false;
    }
};

/// The largest turn of a link, rad, that separates directions found from those of a steady shape with its upper end on
/// the axis, `span` up, there being one and one alone so near: Krawczyk's test on the two forces at the lower end
/// (doi:10.1007/ BF02234767). Infinite where it decides nothing: intervals grow along the chain by e^pi, about, for
/// each half wave.
inline double held_error(const std::vector<Link<Interval<DoubleDouble>>>& links, const Interval<DoubleDouble>& height,
                         const Interval<DoubleDouble>& span, const std::array<DoubleDouble, 2>& forces,
                         const std::vector<Direction<DoubleDouble>>& found) {
    using Span = HeldBox::Span;
    constexpr double unproved = std::numeric_limits<double>::infinity();
    const HeldBox centre(links, height, forces, {0, 0}, found);
    if (!centre.known) return unproved;
    std::array<double, 4> J;
    for (std::size_t i = 0; i < 4; ++i) J[i] = static_cast<double>(centre.change[i].middle());
    const double determinant = J[0] * J[3] - J[1] * J[2];
    if (!(std::abs(determinant) > 0)) return unproved;
    const std::array<DoubleDouble, 4> inverse{DoubleDouble(J[3] / determinant), DoubleDouble(-J[1] / determinant),
                                              DoubleDouble(-J[2] / determinant), DoubleDouble(J[0] / determinant)};
    const Span missed = centre.rise - span;
    std::array<double, 2> step, radius;
    for (std::size_t i = 0; i < 2; ++i)
        step[i] = HeldBox::largest(Span(inverse[2 * i]) * centre.offset + Span(inverse[2 * i + 1]) * missed);
    radius = {2 * step[0] + 1e-290, 2 * step[1] + 1e-290};
    for (int round = 0; round < 4; ++round) {
        const HeldBox box(links, height, forces, radius, found);
        if (!box.known) return unproved;
        bool inside = true;
        std::array<double, 2> image;
        for (std::size_t i = 0; i < 2; ++i) {
            image[i] = step[i];
            for (std::size_t j = 0; j < 2; ++j) {
                const Span product =
                    Span(inverse[2 * i]) * box.change[j] + Span(inverse[2 * i + 1]) * box.change[2 + j];
                image[i] += HeldBox::largest(Span(DoubleDouble(i == j ? 1.0 : 0.0)) - product) * radius[j];
            }
            inside = inside && image[i] < radius[i];
        }
        if (inside) return std::asin(std::min(1.0, box.turned)) * 1.0000001;
        for (std::size_t i = 0; i < 2; ++i) radius[i] = 2 * std::max(image[i], radius[i]);
    }
    return unproved;
}

}  // namespace revchain::finite
