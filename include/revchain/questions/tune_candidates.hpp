// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/pencils.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/twisted.hpp"
#include "revchain/questions/sensitivity.hpp"

/// Functions for `tune`: a link with another value of a datum, the range of the datum, and the
/// values at which the chain has a given conical height of any mode.
namespace revchain::inline REVCHAIN_BUILD::detail {

REVCHAIN_LAZY
double datum_of(const Link<double>& link, Datum datum) {
    switch (datum) {
        case Datum::weight:
            return link.weight;
        case Datum::centroid:
            return link.centroid;
        case Datum::radius_of_gyration:
            return radius_of_gyration(link);
        default:
            return link.length;
    }
}

/// Returns the link with another value of a datum; the other data are held as `Datum` says.
REVCHAIN_LAZY
Link<double> with_datum(Link<double> link, Datum datum, double x) {
    using S = Wide<double>;
    constexpr std::string_view place = "tune";
    switch (datum) {
        case Datum::weight:
            link.weight = x;
            return link;
        case Datum::centroid:
            link.centroid = x;
            return link;
        case Datum::radius_of_gyration:
            link.gyration_ratio = gyration_from_radius<double>(place, link.length, x);
            return link;
        default:
            break;
    }
    require_positive(place, "length", x);
    if (datum == Datum::length) {
        const S shrunk = in_lengths<double>(link.length, x);
        link.gyration_ratio = link.gyration_ratio * (shrunk * shrunk);
    } else {
        link.centroid = times_length<double>(in_lengths<double>(link.centroid, link.length), x);
    }
    link.length = x;
    return link;
}

/// Returns a bound of |d ln(height)/d ln(weight)| for the link at index `link`. It holds while its
/// weight W is between `low` and `high` and the height is at least `least`. The bound is the larger
/// of the shares that the weight can have in y^T M y and in y^T K y, or their sum if a centroid of
/// this link or one above is above its pin. Both follow from the ends, because w^2 <= sum of
/// a^2/kappa and s^2 <= 1/kappa times y^T K y, with kappa = W_r h_r + a_r S_r, W included, and
/// W/kappa is monotone in W. The bound is at most 1 if all centroids are at or below their pins,
/// since W dM <= M and W dK <= K. Cost O(N).
REVCHAIN_LAZY
double weight_influence(const Chain<double>& chain, Index link, double low, double high,
                        double least) {
    double below_low = 0, below_high = 0, flexibility = 0, bears = 0, own = 0;
    bool all_hang = true;
    for (Index m = 0; m < chain.size(); ++m) {
        const Link<double> it = chain.link(m);
        const double w_low = m == link ? low : it.weight, w_high = m == link ? high : it.weight;
        if (m >= link) {
            const double h = it.centroid / it.length;
            const double share =  // a W/kappa
                std::max(low / (w_low * h + below_low), high / (w_high * h + below_high));
            if (m == link)
                own = share / it.length;
            else
                flexibility += it.length * share, bears = std::max(bears, share);
            all_hang = all_hang && h >= 0;
        }
        below_low += w_low, below_high += w_high;
    }
    const Link<double> it = chain.link(link);
    const double h = std::abs(it.centroid), rho = radius_of_gyration(it);
    const double centre = std::sqrt(flexibility) + h * std::sqrt(own);
    const double moves = (centre * centre + rho * rho * own) / least;
    bears = std::max(bears, h * own);
    return (all_hang ? std::min(1.0, std::max(moves, bears)) : moves + bears) * (1 + 1e-9);
}

/// The range of a datum. `start` is the present value, or the nearest end if that is 0 or outside.
struct TuneRange {
    double present, start, low, high;
};

/// Returns the range of a datum in which the link still hangs, within the requested limits.
REVCHAIN_LAZY
TuneRange tune_range(std::string_view place, const Chain<double>& chain, Index number, Datum datum,
                     const std::optional<double>& low, const std::optional<double>& high) {
    const Link<double> link = chain.link(number);
    const double below = static_cast<double>(chain.weight_below(number));
    const double present = datum_of(link, datum);
    TuneRange range{present, present, present / 1000, present * 1000};
    if (datum == Datum::weight && !(present > 0))
        range.low = chain.total_weight() / 1000, range.high = chain.total_weight() * 1000;
    if (datum == Datum::centroid || datum == Datum::radius_of_gyration)
        range.low = std::min(0.0, present), range.high = std::max(link.length, present);
    if (low) range.low = *low;
    if (high) range.high = *high;
    const auto refuse = [&](const std::string& rule, double value) {
        throw_invalid(place, "between: " + rule, value);
    };
    if (!std::isfinite(range.low) || !std::isfinite(range.high) || !(range.low < range.high))
        refuse("its high end must exceed its low end " + in_digits(range.low) + ", both finite",
               range.high);
    if (datum != Datum::centroid && range.low < 0)
        refuse("its low end must not be negative for this quantity", range.low);
    if (datum != Datum::centroid && datum != Datum::radius_of_gyration && !(range.low > 0))
        refuse("its low end must be positive for this quantity", range.low);
    // A link hangs if W h + a S > 0. The range ends a part in 1e6 before that limit.
    constexpr double inside = 1e-6;
    const double W = link.weight, a = link.length, h = link.centroid;
    double least = range.low, most = range.high;
    if (datum == Datum::centroid && W > 0)
        least = below > 0 ? -a * below / W * (1 - inside) : a * inside;
    if (datum == Datum::weight && h < 0) most = -a * below / h * (1 - inside);
    if (datum == Datum::length && h < 0) least = -W * h / below * (1 + inside);
    // Links above whose centroids are above their pins need a weight below them.
    for (Index m = number + 1; datum == Datum::weight && m < chain.size(); ++m) {
        const Link<double> above = chain.link(m);
        if (above.centroid >= 0) continue;
        const double needed = -above.weight * above.centroid / above.length * (1 + inside);
        const Wide<double> others = chain.weight_below(m) - Wide<double>(W);
        least = std::max(least, needed - static_cast<double>(others));
    }
    if (!(least < range.high))
        refuse("a link would stand, not hang, up to " + in_digits(least) +
                   "; the high end must exceed that",
               range.high);
    if (!(range.low < most))
        refuse("the link would stand, not hang, from " + in_digits(most) +
                   " on; the low end must be below that",
               range.low);
    range.low = std::max(range.low, least), range.high = std::min(range.high, most);
    if (!(range.low < range.high)) refuse("a link would stand, not hang, everywhere", range.high);
    range.start = std::clamp(present, range.low, range.high);
    return range;
}

/// Returns all values of a datum other than the weight at which `height` is a conical height of the
/// chain, for any mode, unsorted. The parts below and above the link act as springs D and E at its
/// pins, the dynamic stiffnesses at that height. With v the upper pin's offset and s the slope,
/// twice the energy is
///     D (v + a s)^2 + E v^2 + lambda (W h + a S) s^2 - W (v + h s)^2 - W rho^2 s^2.
/// This form must be singular. That condition is linear in rho^2 and in a common factor of a, h and
/// rho, and quadratic in a and in h. At the support v = 0. Cost O(N).
REVCHAIN_LAZY
std::vector<double> tune_candidates(const Chain<double>& chain, Index number, Datum datum,
                                    const Wide<double>& height) {
    using S = Wide<double>;
    const Pencils<double> pencils(chain);
    const auto& elements = pencils.wide().elements;
    const S lambda = pencils.scaled(height);
    const std::size_t at = static_cast<std::size_t>(number), n = elements.size();
    S D(0.0), E(0.0);
    for (std::size_t m = 0; m < at; ++m) {
        const auto& e = elements[m];
        D = pencil::detail::across<S>(e, lambda * e.stiffness, D, e.lower, e.upper).stiffness;
    }
    const bool top = at + 1 == n;
    for (std::size_t m = n; m-- > at + 1;) {
        const auto& e = elements[m];
        const S stiffness = lambda * e.stiffness;
        E = m + 1 == n ? stiffness - e.lower
                       : pencil::detail::across<S>(e, stiffness, E, e.upper, e.lower).stiffness;
    }
    const ScaledLink<S> link = scaled_links(chain)[at];
    const auto& [W, a, h, rho, below] = link;
    const S square = rho * rho, zero(0.0), A = D + E - W, B = a * D - W * h;
    std::vector<S> roots;
    const auto quadratic = [&](const S& two, const S& one, const S& none) {
        if (two == zero) return roots.push_back(-none / one);
        const S half = one / S(-2.0), rest = half * half - two * none;
        if (rest < zero) return;
        const S root = sqrt(rest), sum = half < zero ? half - root : half + root;
        roots.push_back(sum / two);
        if (!(sum == zero)) roots.push_back(none / sum);
    };
    switch (datum) {
        case Datum::radius_of_gyration: {
            const S rest = a * a * D + lambda * link.pull() * a - W * h * h;
            const S found = (top ? rest : rest - B * B / A) / W;
            if (!(found < zero)) roots.push_back(sqrt(found));
            break;
        }
        case Datum::centroid: {
            const S turning = lambda * a * below - W * square;
            if (top)
                quadratic(-W, lambda * W, a * a * D + turning);
            else
                quadratic(W * (D + E), -W * (S(2.0) * a * D + A * lambda),
                          a * a * D * (W - E) - A * turning);
            break;
        }
        case Datum::length: {
            const S own = lambda * W * h - W * (h * h + square);
            if (top)
                quadratic(D, lambda * below, own);
            else
                quadratic(D * (E - W), A * lambda * below + S(2.0) * D * W * h,
                          A * own - W * W * h * h);
            break;
        }
        default: {  // the factor
            const S inertia = a * a * D - W * (h * h + square), pull = lambda * a * link.pull();
            roots.push_back((top ? -pull / inertia : -A * pull / (A * inertia - B * B)) * a);
        }
    }
    std::vector<double> values;
    for (const S& root : roots) values.push_back(std::ldexp(root.high, pencils.length_exponent()));
    return values;
}

}  // namespace revchain::detail
