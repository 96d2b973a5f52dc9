// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "revchain/finite/held/sweep.hpp"

namespace revchain::finite {

/// A place of a uniform cord held at both ends, lengths over the cord's: arc from the lower end, offset y, height z,
/// and lambda times the force that pulls upwards, over the weight: u across the axis (the way offsets are counted), V
/// along it.
struct CordPlace {
    double arc = 0, offset = 0, rise = 0, across = 0, along = 0;
};
/// How a place at a fixed arc changes with the force at the lower end, as `HeldForces` counts it, and the height.
using CordChange = std::array<CordPlace, 3>;

/// The power series of a cord about one of its places, in a time t that makes the equations polynomials:
///     ds = T dt:   y' = u,   z' = V,   u' = -T y,   V' = lambda T,   T = C + lambda z - y^2/2,
/// lambda 0 without gravity. As in `PathSeries`, a step of this time spans most of a sharp corner.
class CordSeries {
   public:
    static constexpr std::size_t order = 24;
    using Coefficients = std::array<double, order + 1>;

    CordSeries(const CordPlace& place, double height, const CordChange* change = nullptr) {
        arc[0] = place.arc, offset[0] = place.offset, rise[0] = place.rise;
        across[0] = place.across, along[0] = place.along;
        tension[0] = std::hypot(place.across, place.along);
        for (std::size_t n = 0; n < order; ++n) {
            const double inverse = 1 / static_cast<double>(n + 1);
            offset[n + 1] = across[n] * inverse, rise[n + 1] = along[n] * inverse, arc[n + 1] = tension[n] * inverse;
            across[n + 1] = -product(tension, offset, n) * inverse, along[n + 1] = height * tension[n] * inverse;
            tension[n + 1] = height * rise[n + 1] - 0.5 * product(offset, offset, n + 1);
        }
        if (change != nullptr)
            for (std::size_t i = 0; i < 3; ++i) vary(changes[i], (*change)[i], height, i == 2 ? 1.0 : 0.0);
    }

    static double at(const Coefficients& c, double t) {
        double sum = c[order];
        for (std::size_t k = order; k-- > 0;) sum = sum * t + c[k];
        return sum;
    }
    CordPlace place(double t) const { return {at(arc, t), at(offset, t), at(rise, t), at(across, t), at(along, t)}; }
    /// The change at a fixed arc, not time.
    CordChange change(double t, double height) const {
        const CordPlace x = place(t);
        const double pull = std::hypot(x.across, x.along);
        CordChange result;
        for (std::size_t i = 0; i < 3; ++i) {
            const Varied& c = changes[i];
            const double moved = at(c.arc, t);
            result[i] = {0, at(c.offset, t) - x.across / pull * moved, at(c.rise, t) - x.along / pull * moved,
                         at(c.across, t) + x.offset * moved, at(c.along, t) - height * moved};
        }
        return result;
    }
    /// The longest time for which the last terms stay below `tolerance` of the place.
    double reach(double tolerance) const {
        const double size = std::abs(offset[0]) + std::sqrt(tension[0]);
        const auto of = [&](std::size_t k) {
            const double largest = std::max({std::abs(offset[k]) / size, std::abs(tension[k]) / tension[0],
                                             std::abs(rise[k]) / size, std::numeric_limits<double>::min()});
            return std::pow(tolerance / largest, 1.0 / static_cast<double>(k));
        };
        return std::min(of(order), of(order - 1));
    }
    /// The time at which the arc is reached; it grows with the time.
    double time_at(double wanted, double duration) const {
        double low = 0, high = duration, t = duration / 2;
        for (int i = 0; i < 100; ++i) {
            const double off = at(arc, t) - wanted;
            (off < 0 ? low : high) = t;
            double next = t - off / at(tension, t);
            if (std::abs(next - t) <= 0x1p-53 * duration) return next;
            if (!(next > low && next < high)) next = low + (high - low) / 2;
            if (next == low || next == high) break;
            t = next;
        }
        return t;
    }

    Coefficients arc, offset, rise, across, along, tension;

   private:
    struct Varied {
        Coefficients arc, offset, rise, across, along, tension;
    };
    static double product(const Coefficients& x, const Coefficients& y, std::size_t n) {
        double sum = 0;
        for (std::size_t i = 0; i <= n; ++i) sum += x[i] * y[n - i];
        return sum;
    }
    void vary(Varied& x, const CordPlace& start, double height, double with_height) const {
        x.arc[0] = start.arc, x.offset[0] = start.offset, x.rise[0] = start.rise;
        x.across[0] = start.across, x.along[0] = start.along;
        x.tension[0] = (across[0] * start.across + along[0] * start.along) / tension[0];
        for (std::size_t n = 0; n < order; ++n) {
            const double inverse = 1 / static_cast<double>(n + 1);
            x.offset[n + 1] = x.across[n] * inverse, x.rise[n + 1] = x.along[n] * inverse;
            x.arc[n + 1] = x.tension[n] * inverse;
            x.across[n + 1] = -(product(x.tension, offset, n) + product(tension, x.offset, n)) * inverse;
            x.along[n + 1] = (height * x.tension[n] + with_height * tension[n]) * inverse;
            x.tension[n + 1] = height * x.rise[n + 1] + with_height * rise[n + 1] - product(offset, x.offset, n + 1);
        }
    }
    std::array<Varied, 3> changes;
};

/// A cord from its lower end to its upper, for given forces at the lower. `visit(series, duration)` sees every step.
struct CordPath {
    static constexpr int most_steps = 20'000;
    static constexpr double tolerance = 1e-18;

    template <class Visit>
    static HeldEnd<double> end(const HeldForces<double>& forces, Visit&& visit) {
        CordPlace place{0, 0, 0, -forces.across, forces.along};
        CordChange change{};
        change[0].across = -1, change[1].along = 1;
        for (int step = 0; step < most_steps; ++step) {
            // Sharper turns leave no digit of the inclination: the cord is folded along the axis.
            if (!(std::hypot(place.across, place.along) > epsilon<double>() * forces.height)) return {};
            const CordSeries series(place, forces.height, &change);
            double duration = series.reach(tolerance);
            const bool last = CordSeries::at(series.arc, duration) >= 1;
            if (last) duration = series.time_at(1, duration);
            visit(series, duration);
            place = series.place(duration), change = series.change(duration, forces.height);
            if (!last) continue;
            HeldEnd<double> end;
            end.offset = place.offset, end.rise = place.rise, end.across = -place.across;
            for (std::size_t i = 0; i < 3; ++i)
                end.offset_change[i] = change[i].offset, end.rise_change[i] = change[i].rise,
                end.across_change[i] = -change[i].across;
            end.known = std::isfinite(end.offset) && std::isfinite(end.rise);
            return end;
        }
        return {};
    }
};

}  // namespace revchain::finite
