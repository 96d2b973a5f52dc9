// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/finite/held/cord.hpp"
#include "revchain/finite/stability/disturbed.hpp"
#include "revchain/numeric/gauss_rule.hpp"
#include "revchain/stability.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

Stability judged(StabilityFrame frame, const Disturbed& d, const ChainUnits& units);  // finite/stability/stability.hpp

/// A shape of a cord along its arc, from the lower end: lengths over any one unit, weights over any one.
struct CordProfile {
    double length, tip;
    int half_waves;
    std::vector<double> steps;  ///< arcs between which inclination and tension are smooth, ascending
    std::function<std::array<double, 2>(double)> at;      ///< arc to inclination and lambda times the tension
    std::function<double(double)> density, weight_below;  ///< of the arc
    bool is_held = false;                                 ///< the lower end, too, on the axis
};

inline CordProfile profile_of(const CordShape& shape) {
    CordProfile profile{shape.support_arc, shape.kind.tip, shape.half_waves, {}, {}, {}, {}};
    for (const Path::Step& step : shape.steps) profile.steps.push_back(step.start.arc);
    profile.at = [&shape](double arc) {
        const CordPlace place = shape(std::min(arc * shape.conical_height, shape.length));
        return std::array{place.inclination, place.tension / (shape.conical_height * shape.kind.line_weight)};
    };
    profile.density = [&shape](double arc) { return shape.kind.density_at(arc); };
    profile.weight_below = [&shape](double arc) { return shape.kind.weight_below(arc); };
    return profile;
}

inline CordProfile profile_of(const HeldCordShape& shape) {
    CordProfile profile{1, 0, shape.half_waves, {}, {}, {}, {}, true};
    for (const HeldCordState& step : shape.steps) profile.steps.push_back(step.arc);
    profile.at = [&shape](double arc) {
        const HeldCordPlace place = shape(std::min(arc * shape.length, shape.length));
        return std::array{place.inclination, place.height_times_tension / (shape.length * shape.weight)};
    };
    profile.density = [](double) { return 1.0; };
    profile.weight_below = [](double arc) { return arc; };
    return profile;
}

/// A cord disturbed from a shape: its tangent turns by a in the plane of the shape and by b out of it. With the offsets
/// xi, eta, zeta (across the axis in the plane, out of the plane, along the axis) from the support down,
///     xi' = -a cos(psi),   zeta' = -a sin(psi),   eta' = b    (' by sigma, psi the inclination),
/// the Lagrangian of second order in the turning frame, times in 1/n, T lambda times the tension, is
///     1/2 sum of m (xi'^2 + eta'^2 + zeta'^2) + m (xi eta' - eta xi') + 1/2 m (xi^2 + eta^2)
///     - 1/2 integral of T (a^2 + b^2)    (here ' by time).
/// A lower end that is held allows those a and b only that leave it where it is.
/// a and b are polynomials on panels, given at the nodes of Gauss's rule, and need not be continuous, as no derivative
/// of them occurs: a chain of links is the case of one node a panel. Integrals by Gauss's rule: the order is twice the
/// number of nodes where the shape is smooth.
class DisturbedCord {
   public:
    DisturbedCord(const CordProfile& shape, int nodes)
        : shape_(shape), rule_(revchain::detail::gauss_rule(nodes)), inner_(nodes, nodes) {
        const std::vector<double> ends = panel_ends();
        integrate_polynomials();
        const auto panels = static_cast<Index>(ends.size()) - 1, n = panels * nodes;
        arc_.resize(n), wide_.resize(n), cosine_.resize(n), sine_.resize(n), tension_.resize(n), mass_.resize(n);
        for (Index p = 0; p < panels; ++p)
            add_panel(p, ends[static_cast<std::size_t>(p)], ends[static_cast<std::size_t>(p) + 1]);
    }

    Disturbed disturbed() const {
        const Index n = arc_.size();
        const Vector<double> scale = wide_.cwiseSqrt().cwiseInverse();  // so that the basis is orthonormal
        Matrix<double> along = Matrix<double>::Zero(n + 1, n);  // integral from a node to the support; last: all
        const Index nodes = inner_.rows();
        for (Index j = 0; j < n; ++j) {
            const Index panel = j / nodes;
            along.col(j).head(panel * nodes).setConstant(wide_[j] * scale[j]);
            along(n, j) = wide_[j] * scale[j];
            const double width = wide_[j] / rule_[static_cast<std::size_t>(j % nodes)].second;
            along.col(j).segment(panel * nodes, nodes) = width * scale[j] * inner_.col(j % nodes);
        }
        Vector<double> mass(n + 1), length(n + 1);
        mass << mass_, shape_.tip;
        length << wide_, 0;
        const Matrix<double> X = along * cosine_.asDiagonal(), Z = along * sine_.asDiagonal(), Y = -along;
        Disturbed d;
        d.doubt = tension_.maxCoeff();
        const auto weighed = [](const Matrix<double>& left, const Vector<double>& by, const Matrix<double>& right) {
            return Matrix<double>(left.transpose() * by.asDiagonal() * right);
        };
        const Matrix<double> across = weighed(X, mass, X);
        d.inertia = across + weighed(Z, mass, Z);
        d.coupling = weighed(X, mass, Y), d.mass = weighed(Y, mass, Y);
        d.in_plane = Matrix<double>(tension_.asDiagonal()) - across;
        d.out_of_plane = Matrix<double>(tension_.asDiagonal()) - d.mass;
        d.turned = d.bending = d.swivelling = Matrix<double>::Zero(n, n);
        d.drag_across = weighed(Y, length, Y), d.drag_coupling = weighed(X, length, Y);
        d.drag_in_plane = weighed(X, length, X) + weighed(Z, length, Z);
        d.ends = Matrix<double>::Zero(n, 2);
        d.offset = -sine_.cwiseQuotient(scale);
        if (shape_.is_held) {
            d.ends << X.row(n).transpose(), Z.row(n).transpose();
            const Matrix<double> out = beside(Y.row(n).transpose());
            d.keep(beside(d.ends), out);
            d.offset = (out.transpose() * d.offset).eval();
        }
        return d;
    }

   private:
    /// Where panels meet: at steps of the path, those left out along which the cord hardly turns.
    std::vector<double> panel_ends() const {
        const double length = shape_.length, longest = length / (2 * shape_.half_waves + 2);
        std::vector<double> ends{0};
        const auto inclination = [&](double arc) { return shape_.at(arc)[0]; };
        double last = inclination(0);
        const auto add_up_to = [&](double end, double angle) {
            const double from = ends.back(), turn = std::abs(angle - last) / 0.7, wide = (end - from) / longest;
            const int parts = std::max(1, static_cast<int>(std::ceil(std::max(wide, std::min(turn, 4.0)) - 0.2)));
            for (int i = 1; i <= parts; ++i) ends.push_back(i == parts ? end : from + (end - from) * i / parts);
            last = angle;
        };
        for (const double at : shape_.steps) {
            if (!(at > ends.back()) || !(at < length)) continue;
            const double angle = inclination(at);
            if (at - ends.back() > longest / 2 || std::abs(angle - last) > 0.4) add_up_to(at, angle);
        }
        add_up_to(length, inclination(length));
        return ends;
    }
    /// inner(m, j): integral of the j-th Lagrange polynomial of the nodes from node m to 1.
    void integrate_polynomials() {
        const Index n = inner_.rows();
        const auto node = [&](Index i) { return rule_[static_cast<std::size_t>(i)].first; };
        for (Index m = 0; m < n; ++m)
            for (Index j = 0; j < n; ++j) {
                double sum = 0;
                for (const auto& [t, weight] : rule_) {
                    const double x = node(m) + (1 - node(m)) * t;
                    double value = 1;
                    for (Index k = 0; k < n; ++k)
                        if (k != j) value *= (x - node(k)) / (node(j) - node(k));
                    sum += weight * value;
                }
                inner_(m, j) = sum * (1 - node(m));
            }
    }
    void add_panel(Index panel, double low, double high) {
        const Index nodes = inner_.rows();
        double sum = 0;
        for (Index i = 0; i < nodes; ++i) {
            const auto& [t, weight] = rule_[static_cast<std::size_t>(i)];
            const Index at = panel * nodes + i;
            const double arc = low + (high - low) * t;
            const auto [inclination, tension] = shape_.at(arc);
            arc_[at] = arc, wide_[at] = weight * (high - low);
            cosine_[at] = std::cos(inclination), sine_[at] = std::sin(inclination), tension_[at] = tension;
            mass_[at] = wide_[at] * shape_.density(arc);
            sum += mass_[at];
        }
        // the weight of the panel as it is, however the density varies
        const double whole = shape_.weight_below(high) - shape_.weight_below(low);
        mass_.segment(panel * nodes, nodes) *= whole / sum;
    }

    const CordProfile& shape_;
    std::vector<std::pair<double, double>> rule_;
    Matrix<double> inner_;
    Vector<double> arc_, wide_, cosine_, sine_, tension_, mass_;
};

/// What two discretisations agree on.
template <class Shape>
Stability judged(StabilityFrame frame, const Cord& cord, const Shape& shape) {
    if (!(std::abs(shape.length - cord.length()) <= 1e-14 * cord.length()))
        revchain::detail::throw_invalid("stability", "the shape is not of this cord; it is as long as", shape.length);
    const CordProfile profile = profile_of(shape);
    const auto found = [&](int nodes) {
        return judged(frame, DisturbedCord(profile, nodes).disturbed(), ChainUnits{});
    };
    const Stability coarse = found(8);
    Stability result = found(10);
    const double apart = std::abs(result.growth_rate - coarse.growth_rate);
    result.margin = std::max({1e-7, 2 * apart, 1e-13 * std::abs(result.exponents.back())});
    if (result.verdict != Verdict::minimum) {
        const bool grows = result.growth_rate > result.margin;
        result.verdict = grows                                       ? Verdict::unstable
                         : result.growth_rate < 1e-2 * result.margin ? Verdict::spectrally_stable
                                                                     : Verdict::undecided;
    }
    if (result.negative_directions != coarse.negative_directions) result.verdict = Verdict::undecided;
    std::vector<std::complex<double>> kept;
    std::vector<double> external, error;
    for (std::size_t i = 0; i < result.exponents.size(); ++i) {
        const std::complex<double> s = result.exponents[i];
        double off = std::numeric_limits<double>::infinity();
        for (const auto& x : coarse.exponents) off = std::min(off, std::abs(x - s));
        if (off > 1e-6 * std::abs(s) + 1e-9) continue;
        kept.push_back(s), external.push_back(result.external_damping[i] / cord.line_weight());
        error.push_back(std::max(off, result.exponent_error[i]));
    }
    result.exponents = std::move(kept), result.external_damping = std::move(external);
    result.exponent_error = std::move(error);
    result.internal_damping.assign(result.exponents.size(), std::numeric_limits<double>::quiet_NaN());
    return result;
}

}  // namespace revchain::finite

namespace revchain::inline REVCHAIN_BUILD {

inline Stability stability(const Cord& cord, const CordShape& shape, StabilityFrame frame) {
    return finite::judged(frame, cord, shape);
}

inline Stability stability(const Cord& cord, const HeldCordShape& shape, StabilityFrame frame) {
    return finite::judged(frame, cord, shape);
}

}  // namespace revchain
