// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/path_series.hpp"
#include "revchain/finite/held/sweep.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A point of a uniform cord held at both ends, with lengths over the cord's: arc from the lower
/// end, offset y, height z, and lambda times the upward force over the weight, u across, V along.
struct HeldCordState {
    double arc = 0, offset = 0, rise = 0, across = 0, along = 0;
};
/// Derivatives of a point at fixed arc by the numbers of `HeldForces`.
using CordChange = std::array<HeldCordState, 3>;

/// The power series of a cord about a point, in the time of `PathSeries`, ds = T dt:
///     y' = u,   z' = V,   u' = -T y,   V' = lambda T,   T = C + lambda z - y^2/2,
/// with lambda = 0 without gravity. There is one series for each of the three derivatives.
class CordSeries {
   public:
    CordSeries(const HeldCordState& place, double height, const CordChange* change = nullptr) {
        const PathState state{place.arc, place.offset, place.across, place.rise};
        for (std::size_t i = 0; i < (change == nullptr ? 1 : 3); ++i) {
            const HeldCordState d = change == nullptr ? HeldCordState{} : (*change)[i];
            const PathChange varied{d.arc, d.offset, d.across, d.rise},
                *given = change == nullptr ? nullptr : &varied;
            series_[i].start({1, height, i == 2 ? 1.0 : 0.0}, state, place.along, given, d.along);
        }
    }

    HeldCordState place(double t) const {
        const PathState x = series_[0].state(t);
        return {x.arc, x.offset, x.height, x.pull, PathSeries::at(series_[0].below, t)};
    }
    /// Returns the derivatives at a fixed arc, not at a fixed time.
    CordChange change(double t, double height) const {
        const HeldCordState x = place(t);
        const double pull = std::hypot(x.across, x.along);
        CordChange result;
        for (std::size_t i = 0; i < 3; ++i) {
            const PathChange c = series_[i].change(t);
            result[i] = {0, c.offset - x.across / pull * c.arc, c.height - x.along / pull * c.arc,
                         c.pull + x.offset * c.arc,
                         PathSeries::at(series_[i].below_change, t) - height * c.arc};
        }
        return result;
    }
    /// Returns the longest time for which the last terms are below 1e-18 of the values.
    double reach() const {
        const PathSeries& x = series_[0];
        const double size = std::abs(x.offset[0]) + std::sqrt(x.tension[0]);
        return PathSeries::reach(1e-18, [&](std::size_t k) {
            return std::max({std::abs(x.offset[k]) / size, std::abs(x.tension[k]) / x.tension[0],
                             std::abs(x.height[k]) / size, std::numeric_limits<double>::min()});
        });
    }
    double time_at(double wanted, double duration) const {
        return finite::time_at(series_[0], wanted, duration);
    }

   private:
    std::array<PathSeries, 3> series_;
};

/// Follows a cord from its lower to its upper end. `visit(series, duration)` receives every step.
template <class Visit>
HeldEnd<double> cord_end(const HeldForces<double>& forces, Visit&& visit) {
    constexpr int max_steps = 20'000;
    HeldCordState place{0, 0, 0, -forces.across, forces.along};
    CordChange change{};
    change[0].across = -1, change[1].along = 1;
    for (int step = 0; step < max_steps; ++step) {
        // a sharper turn leaves no digit: the cord is folded along the axis
        if (!(std::hypot(place.across, place.along) > epsilon<double>() * forces.height)) return {};
        const CordSeries series(place, forces.height, &change);
        double duration = series.reach();
        const bool last = series.place(duration).arc >= 1;
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

}  // namespace revchain::finite
