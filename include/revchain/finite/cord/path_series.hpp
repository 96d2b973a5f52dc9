// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "revchain/finite/cord/path_kind.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The power series of a path about one of its points, in a time t: the equations are polynomials,
///     dsigma = T dt:  eta' = u,  u' = -rho T eta,  V' = rho T,  xi' = V,  T' = rho (V - u eta).
/// For the uniform chain the last equation has the integral T = C + xi - eta^2/2. At a sharp turn T
/// is like a hyperbolic cosine of t: one step in t spans most of it, one in sigma only its radius.
class PathSeries {
   public:
    static constexpr int order = 24;
    static constexpr double rounding = 1e-17;  ///< a tolerance below rounding
    using Coefficients = std::array<double, order + 1>;

    PathSeries() = default;
    PathSeries(const PathKind& kind, const PathState& state) { start(kind, state); }

    /// Computes the series about `state`; with `change`, also the series of the derivatives.
    void start(const PathKind& kind, const PathState& state, const PathChange* change = nullptr) {
        set(state, kind.weight_below(state.arc), change);
        tension[0] = kind.tension(state.pull, below[0]);
        is_dense_ = kind.density != nullptr, pace = 1;
        latest_ = std::numeric_limits<double>::infinity();
        if (is_dense_)
            dense(kind);
        else
            uniform<true>({kind.bend});
    }
    /// Constants of a uniform chain; `start` takes them with the weight below and its change.
    struct Constants {
        double bend = 1, weight = 1;  ///< V' = weight T,  T' = weight V - bend u eta
        double weight_change = 0;     ///< derivative of `weight`
    };
    void start(const Constants& constants, const PathState& state, double weight_below,
               const PathChange* change, double change_below) {
        set(state, weight_below, change);
        below_change[0] = change_below, tension[0] = std::hypot(state.pull, weight_below);
        uniform<false>(constants);
    }

    /// Returns the longest time for which the last terms stay below `tolerance`.
    double reach(double tolerance) const {
        const double size =
            std::abs(offset[0]) + std::abs(pull[0]) / std::sqrt(is_dense_ ? mass[0] : tension[0]);
        return std::min(latest_, reach(tolerance, [&](std::size_t k) {
                            return std::max(std::abs(offset[k]) / size,
                                            std::abs(tension[k]) / tension[0]);
                        }));
    }
    /// Returns the reach if `largest(k)` is the size of the coefficients k.
    template <class Largest>
    static double reach(double tolerance, const Largest& largest) {
        const auto of = [&](std::size_t k) {
            return std::pow(tolerance / largest(k), 1.0 / static_cast<double>(k));
        };
        return std::min(of(order), of(order - 1));
    }

    static double at(const Coefficients& c, double t) {
        double sum = c[order];
        for (std::size_t k = order; k-- > 0;) sum = sum * t + c[k];
        return sum;
    }
    /// The state at a time, the tension by its own series, and a bound on the Prüfer angle:
    /// dtheta/dt <= pace sqrt(largest rho T).
    struct Reached {
        PathState state;
        double tension, max_phase;
    };
    Reached reached(double t) const {  // one loop: the steps of a single sum wait for each other
        const Coefficients& pulled = is_dense_ ? mass : tension;
        Reached x{{arc[order], offset[order], pull[order], height[order]},
                  tension[order],
                  std::abs(pulled[order])};
        for (std::size_t k = order; k-- > 0;) {
            x.state.arc = x.state.arc * t + arc[k];
            x.state.offset = x.state.offset * t + offset[k];
            x.state.pull = x.state.pull * t + pull[k];
            x.state.height = x.state.height * t + height[k];
            x.tension = x.tension * t + tension[k];
            x.max_phase = x.max_phase * t + std::abs(pulled[k]);
        }
        x.max_phase = pace * t * std::sqrt(x.max_phase);
        return x;
    }
    PathState state(double t) const { return reached(t).state; }
    double density_at(double t) const { return at(density, t); }
    PathChange change(double t) const {
        PathChange x{arc_change[order], offset_change[order], pull_change[order],
                     height_change[order]};
        for (std::size_t k = order; k-- > 0;) {
            x.arc = x.arc * t + arc_change[k];
            x.offset = x.offset * t + offset_change[k];
            x.pull = x.pull * t + pull_change[k];
            x.height = x.height * t + height_change[k];
        }
        return x;
    }

    Coefficients arc{}, offset, pull, height, tension, below;
    double pace = 1;  ///< dsigma = pace T dt
    Coefficients arc_change, offset_change, pull_change, height_change;
    Coefficients tension_change, below_change;

   private:
    void set(const PathState& state, double weight_below, const PathChange* change) {
        arc[0] = state.arc, offset[0] = state.offset, pull[0] = state.pull,
        height[0] = state.height;
        below[0] = weight_below, has_change_ = change != nullptr;
        if (!has_change_) return;
        arc_change[0] = change->arc, offset_change[0] = change->offset;
        pull_change[0] = change->pull, height_change[0] = change->height;
    }
    /// With the unit weight known at compile time, some products are left out.
    template <bool unit_weight>
    void uniform(const Constants& constants) {
        if (has_change_)
            uniform<unit_weight, true>(constants);
        else
            uniform<unit_weight, false>(constants);
    }

    /// Returns coefficient n of a product; `square` returns that of a square.
    static double product(const double* a, const double* b, int n) {
        double even = 0, odd = 0;
        int i = 0;
        for (; i < n; i += 2) even += a[i] * b[n - i], odd += a[i + 1] * b[n - i - 1];
        return i == n ? even + odd + a[n] * b[0] : even + odd;
    }
    static double product(const Coefficients& a, const Coefficients& b, int n) {
        return product(a.data(), b.data(), n);
    }
    static double square(const Coefficients& a, int n) {
        double sum = 0;
        const auto last = static_cast<std::size_t>(n);
        for (std::size_t i = 0; 2 * i < last; ++i) sum += a[i] * a[last - i];
        return 2 * sum + (n % 2 == 0 ? a[last / 2] * a[last / 2] : 0.0);
    }

    /// Adds each new coefficient at once to the later sums that contain it: compilers vectorise
    /// loops without sums across lanes. Unknown coefficients are 0, so no pair counts twice.
    template <bool unit_weight, bool change>
    void uniform(const Constants& constants) {
        const double bend = constants.bend, weight = unit_weight ? 1.0 : constants.weight;
        Coefficients& change_below = unit_weight ? arc_change : below_change;
        constexpr std::size_t size = order + 1, block = 4, room = 2 * order + 2 * block;
        std::array<double, room> e{}, w{}, de{}, dw{};        // eta, T and their changes
        std::array<double, room> eT{}, ee{}, d_eT{}, d_ee{};  // eta T, eta^2/2 and their changes
        const auto spread = [&](std::size_t n, double en, double wn, double den, double dwn) {
            const std::size_t last = std::min(n, order - n);
            w[n] = wn;
            if constexpr (change) dw[n] = dwn;
            for (std::size_t first = 0; first <= last; first += block) {
                for (std::size_t i = first; i < first + block; ++i) {
                    eT[n + i] += en * w[i] + wn * e[i];
                    if constexpr (change)
                        d_eT[n + i] += en * dw[i] + wn * de[i] + den * w[i] + dwn * e[i];
                }
            }
        };
        const auto spread_square = [&](std::size_t n, double en, double den) {
            const std::size_t last = std::min(n, size - n);
            for (std::size_t first = 0; first <= last; first += block) {
                for (std::size_t i = first; i < first + block; ++i) {
                    ee[n + i] += en * e[i];
                    if constexpr (change) d_ee[n + i] += en * de[i] + den * e[i];
                }
            }
            ee[2 * n] += 0.5 * en * en;
            if constexpr (change) d_ee[2 * n] += en * den;
        };
        if constexpr (change)
            tension_change[0] =
                (bend * pull[0] * pull_change[0] + below[0] * change_below[0]) / tension[0];
        double en = offset[0], den = change ? offset_change[0] : 0.0;
        for (std::size_t n = 0; n < order; ++n) {
            const double inverse = 1.0 / static_cast<double>(n + 1);
            const double wn = tension[n], dwn = change ? tension_change[n] : 0.0;
            spread_square(n, en, den);
            spread(n, en, wn, den, dwn);
            e[n] = en;
            if constexpr (change) de[n] = den;
            const double next = pull[n] * inverse,
                         next_change = change ? pull_change[n] * inverse : 0.0;
            offset[n + 1] = next;
            arc[n + 1] = wn * inverse;
            below[n + 1] = weight * arc[n + 1];
            height[n + 1] = below[n] * inverse;
            pull[n + 1] = -eT[n] * inverse;
            // (eta^2/2)_n+1 lacks its pair (n + 1, 0)
            tension[n + 1] = weight * height[n + 1] - bend * (ee[n + 1] + next * e[0]);
            if constexpr (change) {
                offset_change[n + 1] = next_change;
                arc_change[n + 1] = dwn * inverse;
                if constexpr (!unit_weight)
                    below_change[n + 1] =
                        weight * arc_change[n + 1] + constants.weight_change * arc[n + 1];
                height_change[n + 1] = change_below[n] * inverse;
                pull_change[n + 1] = -d_eT[n] * inverse;
                tension_change[n + 1] = weight * height_change[n + 1] -
                                        bend * (d_ee[n + 1] + next * de[0] + next_change * e[0]);
                if constexpr (!unit_weight)
                    tension_change[n + 1] += constants.weight_change * height[n + 1];
            }
            en = next, den = next_change;
        }
    }

    /// Sets the series for a density: rho(sigma(t)) by Horner's rule on series, one coefficient of
    /// all lines at a time. dsigma = pace T dt, with `pace` such that coefficients stay in range.
    void dense(const PathKind& kind) {
        constexpr int degree = LineDensity::degree;
        const double at = arc[0] * kind.unit;
        std::array<double, degree + 1> c = kind.density->about(at);
        double scale = 1 / kind.per_length;
        for (double& x : c) x *= scale, scale *= kind.unit;
        std::array<Coefficients, degree + 1> line{};  // line[i] = c_i + sigma line[i + 1]
        pace = 1 / (c[0] * (1 + kind.bend * std::abs(offset[0])));
        Coefficients slope{}, density_change{}, mass_change{}, drive{}, drive_change{};
        std::size_t last = degree;  // powers above `last` are negligible within the piece
        const double span = std::min(kind.density->end_of_piece(at) / kind.unit - arc[0], 1e300);
        if (pace * tension[0] > 1e3 * span) pace = span / tension[0], latest_ = 4;  // a heavy tip
        while (last > 0 && std::abs(c[last]) * std::pow(span, last) < 1e-17 * c[0]) --last;
        const auto extend = [&](int n) {
            const auto k = static_cast<std::size_t>(n);
            line[last][k] = n == 0 ? c[last] : 0.0;
            for (std::size_t i = last; i-- > 0;)
                line[i][k] = n == 0 ? c[i] : product(arc.data() + 1, line[i + 1].data(), n - 1);
            density[k] = line[0][k];
        };
        extend(0);
        for (int n = 0; n < order; ++n) {
            const auto k = static_cast<std::size_t>(n);
            const double inverse = pace / (n + 1);
            offset[k + 1] = pull[k] * inverse;
            arc[k + 1] = tension[k] * inverse;
            height[k + 1] = below[k] * inverse;
            mass[k] = product(density, tension, n);
            below[k + 1] = mass[k] * inverse;
            pull[k + 1] = -product(offset, mass, n) * inverse;
            drive[k] = below[k] - 0.5 * kind.bend / inverse * square(offset, n + 1);  // V - u eta
            tension[k + 1] = product(density, drive, n) * inverse;
            extend(n + 1);
            if (!has_change_) continue;
            // density' (by sigma) = (density along t)' / (pace T)
            double of_slope = density[k + 1] / inverse;
            for (std::size_t i = 1; i <= k; ++i) of_slope -= tension[i] * slope[k - i];
            slope[k] = of_slope / tension[0];
            density_change[k] = product(slope, arc_change, n);
            below_change[k] = product(density, arc_change, n);
            if (n == 0)
                tension_change[0] =
                    (kind.bend * pull[0] * pull_change[0] + below[0] * below_change[0]) /
                    tension[0];
            offset_change[k + 1] = pull_change[k] * inverse;
            arc_change[k + 1] = tension_change[k] * inverse;
            height_change[k + 1] = below_change[k] * inverse;
            mass_change[k] =
                product(density_change, tension, n) + product(density, tension_change, n);
            pull_change[k + 1] =
                -(product(offset_change, mass, n) + product(offset, mass_change, n)) * inverse;
            drive_change[k] =
                below_change[k] - kind.bend / inverse * product(offset, offset_change, n + 1);
            tension_change[k + 1] =
                (product(density_change, drive, n) + product(density, drive_change, n)) * inverse;
        }
        mass[order] = product(density, tension, order);
    }
    Coefficients density{}, mass{};  // rho, rho T: with a density
    bool has_change_ = false, is_dense_ = false;
    double latest_ = std::numeric_limits<double>::infinity();  ///< latest time within a short piece
};

/// Returns the zero, between 0 and `latest`, of an increasing function within a step of a series,
/// to 2^-51: the rounding of 25 terms spoils the last digit. `value_and_slope(t)` returns a pair.
template <class F>
double time_of_zero(double latest, const F& value_and_slope) {
    return detail::zero_between(0.0, latest, value_and_slope, 0x1p-51);
}

/// Returns the time before `latest` at which a series reaches an arc length: arc' = pace T > 0.
REVCHAIN_LAZY
double time_at(const PathSeries& series, double arc, double latest) {
    return time_of_zero(latest, [&](double t) {
        return std::pair(PathSeries::at(series.arc, t) - arc,
                         series.pace * PathSeries::at(series.tension, t));
    });
}

/// The series of a uniform chain about a bare free end, where T = 0, in sigma, with u = sigma q:
///     (sigma q)' = -eta,   eta' = q/sqrt(1 + q^2),   xi' = 1/sqrt(1 + q^2),   q(0) = -eta(0).
class TipSeries {
   public:
    static constexpr int order = PathSeries::order;
    using Coefficients = PathSeries::Coefficients;

    TipSeries(double tip_offset, double bend, double tolerance = PathSeries::rounding) {
        offset[0] = tip_offset, offset_change[0] = 1, height[0] = 0;
        Coefficients size{}, cosine{}, cube{}, turn{};  // 1 + q^2, its powers -1/2, -3/2
        height_change[0] = 0;
        for (std::size_t n = 0; n <= order; ++n) {
            const double inverse = 1.0 / static_cast<double>(n + 1);
            tangent[n] = -offset[n] * inverse;
            tangent_change[n] = -offset_change[n] * inverse;
            size[n] = n == 0 ? 1.0 : 0.0;
            for (std::size_t i = 0; i <= n; ++i) size[n] += bend * tangent[i] * tangent[n - i];
            cosine[n] = power(size, cosine, n, -0.5);
            cube[n] = power(size, cube, n, -1.5);
            if (n == order) break;
            turn[n] = 0;
            for (std::size_t i = 0; i <= n; ++i) turn[n] += tangent_change[i] * cube[n - i];
            double slope = 0, sink = 0;
            for (std::size_t i = 0; i <= n; ++i)
                slope += tangent[i] * cosine[n - i], sink -= bend * tangent[i] * turn[n - i];
            offset[n + 1] = slope * inverse;
            offset_change[n + 1] = turn[n] * inverse;
            height_change[n + 1] = sink * inverse;
            height[n + 1] = cosine[n] * inverse;
        }
        // eta has no zero before max(1.4458, eta_0): the path bends less than at small amplitude
        const double within = PathSeries::reach(tolerance, [&](std::size_t k) {
            return std::max(std::abs(offset[k]) / tip_offset, std::abs(height[k]));
        });
        reach = std::min(0.9 * std::max(1.4458, tip_offset), within);
    }

    PathState state(double arc) const {
        return {arc, PathSeries::at(offset, arc), arc * PathSeries::at(tangent, arc),
                PathSeries::at(height, arc)};
    }
    PathChange change(double arc) const {
        return {0, PathSeries::at(offset_change, arc), arc * PathSeries::at(tangent_change, arc),
                PathSeries::at(height_change, arc)};
    }

    Coefficients offset, tangent, height, offset_change, tangent_change, height_change;
    double reach;

   private:
    /// Returns coefficient n of a power of a series by J. C. P. Miller's recurrence.
    static double power(const Coefficients& of, const Coefficients& result, std::size_t n,
                        double exponent) {
        if (n == 0) return std::pow(of[0], exponent);
        double sum = 0;
        const auto whole = static_cast<double>(n);
        for (std::size_t i = 1; i <= n; ++i) {
            const auto k = static_cast<double>(i);
            sum += (exponent * k - (whole - k)) * of[i] * result[n - i];
        }
        return sum / (whole * of[0]);
    }
};

}  // namespace revchain::finite
