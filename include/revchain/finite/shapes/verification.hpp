// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/shapes/described.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

struct Verified {
    std::vector<Far> offset;   ///< of the pins, support last, in double-double
    double inclination_error;  ///< exactly one steady shape has all inclinations within this (rad)
    double condition;  ///< largest change of an inclination (rad) per relative change of forces
};

/// lambda times the forces at the pins for offsets in intervals, and the parts of their derivative:
/// a tangent stiffness for each link and a mass for each pin.
struct Forces {
    std::vector<Span> force, stiffness, mass;
    std::vector<double> size, cosine;  ///< sizes of each force's terms; lower bounds of cosines
    bool known = true;

    template <class End>
    Forces(const EnclosedLinks<Far>& links, const Span& height, const std::vector<Span>& y,
           const End& support) {
        const std::size_t n = links.size();
        Span from_below(Far(0)), mass_below(Far(0));
        double size_below = 0;
        const auto largest = [](const Span& x) { return as_double(x.size()); };
        for (std::size_t m = 0; m < n; ++m) {
            const Link<Span>& link = links[m];
            const Span d = y[m] - y[m + 1];
            const Span square = (link.length - d) * (link.length + d);
            if (!square.positive()) {
                known = false;
                return;
            }
            const Span adjacent = sqrt(square), pull = height * link.pull * d / adjacent,
                       turn = link.cross * d, at_lower = link.moment * y[m],
                       at_upper = link.rest * y[m + 1];
            force.push_back(from_below + pull + turn - at_lower);
            stiffness.push_back(height * link.pull * revchain::square(link.length) /
                                    (adjacent * square) +
                                link.cross);
            mass.push_back(mass_below + link.moment);
            size.push_back(size_below + largest(pull) + largest(turn) + largest(at_lower));
            cosine.push_back(as_double((adjacent / link.length).low));
            size_below = largest(pull) + largest(turn) + largest(at_upper);
            from_below = -(pull + turn + at_upper), mass_below = link.rest;
        }
        if constexpr (is_support<End>) {  // a spring is one more link with a fixed upper end
            if (!support.yields()) return;
            const Span pull = support.stiffness * (y[n] - y[n + 1]),
                       at_lower = support.carriage * y[n];
            force.push_back(from_below + pull - at_lower);
            stiffness.push_back(support.stiffness), mass.push_back(mass_below + support.carriage);
            size.push_back(size_below + largest(pull) + largest(at_lower));
        }
    }
    /// Returns row m of the derivative times a vector that is 0 at the support.
    Span row(std::size_t m, const std::vector<Far>& x) const {
        Span result = stiffness[m] * (Span(x[m]) - Span(x[m + 1])) - mass[m] * Span(x[m]);
        if (m > 0) result = result - stiffness[m - 1] * (Span(x[m - 1]) - Span(x[m]));
        return result;
    }
};

/// The inverse of the derivative, p_i q_j / w for i <= j. p solves it upwards, q downwards.
struct Inverse {
    std::vector<Far> p, q;
    Far w;

    explicit Inverse(const Forces& at) : p(at.force.size() + 1, Far(0)), q(p), w(0) {
        const std::size_t n = at.force.size();
        Far pull(0);  // between pin m and the next pin above
        p[0] = Far(1);
        for (std::size_t m = 0; m + 1 < n; ++m) {
            pull = pull + at.mass[m].middle() * p[m];
            p[m + 1] = p[m] - pull / at.stiffness[m].middle();
        }
        q[n - 1] = Far(1);
        pull = -at.stiffness[n - 1].middle();
        for (std::size_t m = n - 1; m > 0; --m) {
            pull = pull + at.mass[m].middle() * q[m];
            q[m - 1] = q[m] - pull / at.stiffness[m - 1].middle();
        }
        w = -(pull + at.mass[0].middle() * q[0]);
    }
    std::vector<Far> step(const std::vector<Span>& force) const {
        const std::size_t n = force.size();
        std::vector<Far> result(n);
        Far sum(0);
        for (std::size_t m = 0; m < n; ++m) {
            result[m] = q[m] * sum;
            sum = sum + p[m] * force[m].middle();
        }
        sum = Far(0);
        for (std::size_t m = n; m-- > 0;) {
            sum = sum + q[m] * force[m].middle();
            result[m] = -(result[m] + p[m] * sum) / w;
        }
        return result;
    }
    /// Returns for each pin |q| times the sum of `of_p` below plus |p| times that of `of_q` above,
    /// over |w|.
    std::vector<double> spread(const std::vector<double>& of_p,
                               const std::vector<double>& of_q) const {
        const std::size_t n = of_p.size();
        std::vector<double> result(n);
        double sum = 0;
        for (std::size_t m = 0; m < n; sum += of_p[m++]) result[m] = size(q[m]) * sum * scale();
        sum = 0;
        for (std::size_t m = n; m-- > 0; sum += of_q[m]) result[m] += size(p[m]) * sum * scale();
        return result;
    }
    /// Returns an upper bound of 1/|w|.
    double scale() const { return 1.0000001 / size(w); }
    static double size(const Far& x) { return std::abs(as_double(x)); }
    static double size(const Span& x) { return as_double(x.size()) * 1.0000001; }
};

struct Balance {
    std::vector<Far> offset;
    Forces at;
    Inverse inverse;
};

/// Returns the balance by Newton's method to the last digit of double-double; none if an offset is
/// out of reach. It uses the inverse and the enclosed forces that the test below needs.
template <class End>
std::optional<Balance> newton(const EnclosedLinks<Far>& links, const Span& height,
                              std::vector<Far> offset, const End& support) {
    const std::size_t n = offset.size() - 1;
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0;; ++round) {
        Forces at(links, height, {offset.begin(), offset.end()}, support);
        if (!at.known) return std::nullopt;
        Inverse inverse(at);
        const std::vector<Far> step = inverse.step(at.force);
        double largest = 0;
        for (std::size_t m = 0; m < n; ++m)
            if (const double y = Inverse::size(offset[m]); y > 0)
                largest = std::max(largest, Inverse::size(step[m]) / y);
        if (round == 4 || !(largest < 0.1 * last) || largest < 1e-26)
            return Balance{std::move(offset), std::move(at), std::move(inverse)};
        for (std::size_t m = 0; m < n; ++m) offset[m] = offset[m] + step[m];
        last = largest;
    }
}

/// Bounds the error of each offset by Krawczyk's test on all pins at once; none if the test fails.
template <class End>
std::optional<std::vector<double>> proved_radius(const EnclosedLinks<Far>& links,
                                                 const Span& height, const Balance& found,
                                                 const End& support) {
    const auto& [offset, at, inverse] = found;
    const auto& [p, q, w] = inverse;
    const std::size_t n = offset.size() - 1;
    std::vector<double> by_p(n), by_q(n), own(n), radius;
    for (std::size_t m = 0; m < n; ++m) {
        const double left = Inverse::size(at.force[m]);
        by_p[m] = Inverse::size(p[m]) * left, by_q[m] = Inverse::size(q[m]) * left;
    }
    std::vector<double> step = inverse.spread(by_p, by_q);
    for (std::size_t m = 0; m < n; ++m) step[m] += Inverse::size(p[m]) * by_q[m] * inverse.scale();
    std::vector<Span> box;
    for (std::size_t m = 0; m < n; ++m) {
        radius.push_back(2 * step[m]);
        box.push_back(
            {detail::down(offset[m] - Far(radius[m])), detail::up(offset[m] + Far(radius[m]))});
    }
    box.push_back(Span(offset[n]));
    const Forces over(links, height, box, support);
    if (!over.known) return std::nullopt;

    // rows of 1 - inverse times derivative: off the diagonal, p_i or q_i times residuals of p and q
    const Span one(Far(1)), W(w);
    for (std::size_t m = 0; m < n; ++m) {
        const Span rest = over.row(m, q), P(p[m]), Q(q[m]);
        Span product = P * rest;
        if (m > 0)
            product = product +
                      over.stiffness[m - 1] * (P * (Span(q[m - 1]) - Q) + Q * (P - Span(p[m - 1])));
        own[m] = Inverse::size(one - product / W) * radius[m];
        by_q[m] = Inverse::size(rest) * radius[m];
        by_p[m] = m + 1 < n ? Inverse::size(over.row(m, p)) * radius[m] : 0.0;
    }
    const std::vector<double> beside = inverse.spread(by_p, by_q);
    for (std::size_t m = 0; m < n; ++m)
        if (!(step[m] + beside[m] + own[m] < radius[m])) return std::nullopt;
    return radius;
}

/// Returns a shape with proved errors, by Newton's method and Krawczyk's test (Computing 4 (1969)
/// 187, doi:10.1007/BF02234767) on all pins at once. The inverse of the tridiagonal derivative is
/// two vectors: O(N), 4 microseconds a link. Intervals do not grow from link to link as in a sweep.
template <class End = OnAxis>
Verified verified(const EnclosedLinks<Far>& links, const Span& height, std::vector<Far> offset,
                  const End& support = {}) {
    Verified result{offset, std::numeric_limits<double>::infinity(), 0};
    if constexpr (is_support<End>)
        if (support.yields()) offset.push_back(support.radius.middle());
    const auto found = newton(links, height, std::move(offset), support);
    if (!found) return result;
    const auto& [p, q, w] = found->inverse;
    const std::size_t n = found->offset.size() - 1;
    std::copy_n(found->offset.begin(), links.size() + 1, result.offset.begin());
    const auto radius = proved_radius(links, height, *found, support);
    std::vector<double> below(n + 1, 0.0), above(n + 1, 0.0);
    for (std::size_t m = 0; m < n; ++m)
        below[m + 1] = below[m] + Inverse::size(p[m]) * found->at.size[m];
    for (std::size_t m = n; m-- > 0;)
        above[m] = above[m + 1] + Inverse::size(q[m]) * found->at.size[m];
    double worst = 0;
    for (std::size_t m = 0; m < links.size(); ++m) {
        const double opposite = as_double(links[m].length.low) * found->at.cosine[m];
        if (radius)
            worst =
                std::max(worst, ((*radius)[m] + (m + 1 < n ? (*radius)[m + 1] : 0.0)) / opposite);
        const Far p_above = m + 1 < n ? p[m + 1] : Far(0);
        const double change = Inverse::size(p[m] - p_above) * above[m + 1] +
                              Inverse::size(q[m] - q[m + 1]) * below[m + 1];
        result.condition = std::max(result.condition, change * found->inverse.scale() / opposite);
    }
    if (radius && worst == worst) result.inclination_error = worst;
    return result;
}

/// Mirrors a shape, if its mirror image is a shape too, so that its free end has a positive offset.
template <class End>
void turn_outwards(Balanced<Fine>& shape, const End& support) {
    if (shape.offset[0] < Fine(0) && support.is_symmetric()) shape.mirror();
}

/// Returns a shape found by Newton's method, all links hanging, with error bound and condition of
/// `verified` at heights in `within`. The bound is infinite if nothing is proved. At a given height
/// the digits are those of `verified`. At a found height the given digits stay, since near the
/// vertical the rounding of the height moves the shape; the bound then includes the difference.
template <class Shape = SteadyShape, class AnyLinks>
Shape verified_shape(const AnyLinks& chain, const EnclosedLinks<Far>& enclosed_links,
                     const Fine& height, const Span& within, Balanced<Fine> found,
                     bool height_is_given) {
    std::vector<Fine>& y = found.offset;
    const auto support = enclosed<Far>(chain.upper_end());
    const Verified proved = verified(enclosed_links, within, {y.begin(), y.end()}, support);
    double off = 0;
    if (height_is_given && std::isfinite(proved.inclination_error)) {
        std::transform(proved.offset.begin(), proved.offset.end(), y.begin(),
                       [](const Far& digits) { return digits.word(); });
    } else {
        for (std::size_t m = 0; m < chain.links.size(); ++m) {
            const Fine d = y[m] - y[m + 1],
                       right = (proved.offset[m] - proved.offset[m + 1]).word(),
                       adjacent = chain.links[m].length * cosine_of(chain.links[m].length, d);
            off = std::max(off, 1.01 * std::abs(as_double((d - right) / adjacent)));
        }
    }
    turn_outwards(found, support);
    Shape shape = described<Shape>(chain, height, found);
    const bool stands = std::find(found.posture.begin(), found.posture.end(), Posture::stands) !=
                        found.posture.end();
    // the last term covers two roundings of an angle
    shape.error_bound = proved.inclination_error + off + (stands ? 0x1p-51 : 0x1p-52);
    shape.condition = proved.condition;
    return shape;
}

}  // namespace revchain::finite
