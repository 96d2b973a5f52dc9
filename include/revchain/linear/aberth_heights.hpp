// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/linear/heights.hpp"
#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/pencil/spectrum/aberth.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A spring that holds the support sideways, and the weight that moves with it, in `chain.units()`.
struct SpringOnTop {
    double stiffness, carriage;
};

/// Computes a chain as lumped pins and springs in double, in `chain.units()`. Returns false unless
/// all links are plummets, or all have 0 <= h <= a and 0 < (rho/a)^2 < p q (p = h/a, q = 1 - p).
/// With r = (rho/a)^2, lumped masses are W p and W q, and X = W (p q - r). Roundings: S one
/// (compensated), p one, q two, k and 1/k two with plummets, else four; the others:
/// docs/theory/spectrum.md, "Small chains", 1. A support on a spring is one more link, with the
/// mass of the carriage at its lower pin. With plummets and no carriage it joins the top thread:
/// 1/k has three roundings, k four.
REVCHAIN_LAZY
bool lump(pencil::aberth::LumpedLinks& links, const Chain<double>& chain,
          const std::optional<SpringOnTop>& top = std::nullopt) {
    const std::size_t n = static_cast<std::size_t>(chain.size());
    const ChainUnits units = chain.units();
    const double per_weight = std::ldexp(1.0, -units.weight_exponent);
    const double per_length = std::ldexp(1.0, -units.length_exponent);
    links.size = n;
    links.rigid = false;
    for (Index m = 0; m < chain.size() && !links.rigid; ++m)
        links.rigid =
            chain.centroid()[m] != chain.length()[m] || chain.gyration_ratio()[m].high != 0;

    CompensatedSum<double> hung;
    double mass_above = 0;  // mass of the link below at its upper pin
    double trace = 0, greatest = 0;
    double worst_cross = 1, worst_centroid = 0;
    double stiffness_below = 0;
    bool fit = true;
    for (std::size_t m = 0; m < n; ++m) {
        const Index i = static_cast<Index>(m);
        const double weight = chain.weight()[i] * per_weight, a = chain.length()[i] * per_length;
        const double before = hung.value();
        hung.add(weight);
        const double carried = hung.value();
        double share = carried, mass = weight;
        if (links.rigid) {
            const double r = chain.gyration_ratio()[i].high;
            const double h = chain.centroid()[i] * per_length, p = h / a, q = (a - h) / a;
            const double even = p * q;
            share = weight * p + before;
            mass = weight * p + mass_above;
            mass_above = weight * q;
            fit = fit && p >= 0 && q >= 0 && r > 0 && even > r;
            worst_cross = std::max(worst_cross, (even + r) / (even - r));
            links.cross_ratio[m] = weight * (even - r) * (a / share);
            links.weight[m] = weight;
            links.lower_share[m] = p;
            links.upper_share[m] = q;
            links.turn[m] = weight * r;
            if (h + h != a) worst_centroid = std::max(worst_centroid, 4 + 6 * even / std::sqrt(r));
        }
        const double k = share / a, flexibility = a / share;
        links.mass[m] = mass;
        links.stiffness[m] = k;
        links.flexibility[m] = flexibility;
        trace += carried * flexibility;
        greatest =
            std::max(greatest, links.rigid ? k / links.turn[m] : 2 * (stiffness_below + k) / mass);
        stiffness_below = k;
    }
    links.roundings = {2, 0, 6, 0};
    if (links.rigid) links.roundings = {6, 4, 5 * worst_cross + 15, worst_centroid};
    if (top) {
        const double flexibility = 1 / top->stiffness, mass = mass_above + top->carriage;
        trace += (hung.value() + top->carriage) * flexibility;
        if (links.rigid) {  // K y^2 of the top link and the spring over its mass alone
            const double p = links.lower_share[n - 1], turn = links.turn[n - 1];
            const double spring = top->stiffness * (p * p + turn / links.weight[n - 1]);
            greatest = std::max(greatest, (stiffness_below + spring) / turn);
        }
        if (mass > 0) {
            if (!links.rigid)
                greatest = std::max(greatest, 2 * (stiffness_below + top->stiffness) / mass);
            links.mass[n] = mass, links.stiffness[n] = top->stiffness,
            links.flexibility[n] = flexibility;
            links.cross_ratio[n] = links.turn[n] = links.upper_share[n] = 0;
            links.weight[n] = top->carriage, links.lower_share[n] = 1;
            links.size = n + 1;
        } else {
            links.flexibility[n - 1] += flexibility;
            links.stiffness[n - 1] = 1 / links.flexibility[n - 1];
            links.roundings = {4, 0, 8, 0};
        }
    }
    links.least_shift = (1 - 0x1p-30) / trace;
    links.greatest_shift = (1 + 0x1p-30) * greatest;
    return fit && worst_cross < 0x1p20;
}

/// Returns a range of the roots in `all`, to the relative error `worst`; nothing if a proof fails.
REVCHAIN_LAZY
std::optional<Heights<double>> refined(const pencil::ElementPencil<Wide<double>>& pencil,
                                       const ModeRange& range, Index modes,
                                       const pencil::AberthSpectrum& all, double worst) {
    const auto end = [&](Index j, int side) {
        const std::size_t i = static_cast<std::size_t>(j);
        return all.eigenvalue[i] * (1 + side * all.bound[i] * (1 + 0x1p-30));
    };
    const Index first = range.first - 1, last = first + range.count;
    const std::vector<double> starts(all.eigenvalue.begin() + first, all.eigenvalue.begin() + last);
    const double below = last == modes ? 0.0 : end(last, 1);
    const double above = first == 0 ? std::numeric_limits<double>::infinity() : end(first - 1, -1);
    const auto roots =
        pencil::proved_roots(pencil, pencil::is_lumped(pencil), starts, first, below, above, worst,
                             [](double) { return pencil::CertifiedCount{}; });
    if (!roots) return std::nullopt;
    Heights<double> found;
    found.reserve(roots->size());
    for (const auto& root : *roots) {
        if (!std::isfinite(root.off)) return std::nullopt;
        found.push_back({root.root.high, root.bound(), root.root});
    }
    return found;
}

/// Does stage 1 of `modes` for small chains, or returns nothing if `pencil::aberth_spectrum`
/// cannot. Bounds are about 20 ulp, or below 2 ulp with a tolerance below 1e-14. Cost: that of
/// `aberth_spectrum`, 10 ns a link, and 8 ns a link and mode for bounds below 2 ulp.
REVCHAIN_LAZY
std::optional<Heights<double>> heights_by_aberth(const Chain<double>& chain,
                                                 LazyCounter<double>& assembled,
                                                 const ModeRange& range,
                                                 const HeightsOptions<double>& options) {
    constexpr double loose = 1e-14;
    const double goal = std::min(options.rtol.value_or(0.0), 0.5);
    const auto most = static_cast<Index>(pencil::aberth::most_links);
    if (chain.size() > most || chain.mode_count() != chain.size() || !chain.has_one_weight_unit())
        return std::nullopt;
    const FloatingPointStateGuard quiet;
    pencil::aberth::LumpedLinks links;
    if (!lump(links, chain)) return std::nullopt;
    pencil::AberthSpectrum all;
    if (!pencil::aberth_spectrum(links, goal < loose ? 0x1p-40 : goal, all)) return std::nullopt;
    if (goal < loose)
        return refined(assembled.pencils().wide(), range, chain.mode_count(), all, worst_unrounded);
    Heights<double> result;
    result.reserve(static_cast<std::size_t>(range.count));
    const auto first = static_cast<std::size_t>(range.first - 1);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(range.count); ++i)
        result.push_back({all.eigenvalue[i], all.bound[i], all.eigenvalue[i]});
    return result;
}

}  // namespace revchain::detail
