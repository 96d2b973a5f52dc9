// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/finite/held/cord.hpp"
#include "revchain/finite/stability/disturbed.hpp"
#include "revchain/finite/stability/judged.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"
#include "revchain/stability.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A shape of a cord along its arc, from the lower end, in any units of length and weight.
struct CordProfile {
    double length, tip;
    int half_waves;
    std::vector<double> steps{};   ///< ends of steps, ascending, with a smooth shape between
    std::vector<double> pieces{};  ///< ends of pieces of the density; empty if uniform
    std::vector<std::pair<double, double>> particles{};       ///< arc and weight, ascending
    std::function<std::array<double, 2>(double)> at{};        ///< inclination, lambda times tension
    std::function<double(double)> density{}, weight_below{};  ///< of the arc, without particles
    bool is_held = false;                                     ///< whether the lower end is held too
};

REVCHAIN_LAZY
CordProfile profile_of(const CordShape& shape) {
    CordProfile profile{
        .length = shape.support_arc, .tip = shape.kind.tip, .half_waves = shape.half_waves};
    for (const Path::Step& step : shape.steps) profile.steps.push_back(step.start.arc);
    if (shape.density)
        for (const LineDensity::Piece& piece : shape.density->pieces()) {
            const double unit = shape.kind.unit;
            profile.pieces.push_back(piece.end() / shape.conical_height);
            if (piece.particle > 0)
                profile.particles.push_back(
                    {piece.end() / unit, piece.particle / (unit * shape.kind.per_length)});
        }
    profile.at = [&shape](double arc) {
        const CordPlace place = shape(std::min(arc * shape.conical_height, shape.length));
        return std::array{place.inclination,
                          place.tension / (shape.conical_height * shape.kind.line_weight)};
    };
    profile.density = [&shape](double arc) { return shape.kind.density_at(arc); };
    profile.weight_below = [&shape](double arc) { return shape.kind.weight_below(arc, 0); };
    return profile;
}

REVCHAIN_LAZY
CordProfile profile_of(const HeldCordShape& shape) {
    CordProfile profile{.length = 1, .tip = 0, .half_waves = shape.half_waves, .is_held = true};
    for (const HeldCordState& step : shape.steps) profile.steps.push_back(step.arc);
    profile.at = [&shape](double arc) {
        const HeldCordPlace place = shape(std::min(arc * shape.length, shape.length));
        return std::array{place.inclination,
                          place.height_times_tension / (shape.length * shape.weight)};
    };
    profile.density = [](double) { return 1.0; };
    profile.weight_below = [](double arc) { return arc; };
    return profile;
}

/// A cord disturbed from a shape: its tangent turns by a in the plane of the shape and by b out of
/// it. The displacements are xi across the axis in the plane, eta out of the plane and zeta along
/// the axis. From the support down they satisfy
///     xi' = -a cos(psi),   zeta' = -a sin(psi),   eta' = b    (' by sigma, psi the inclination).
/// With times in 1/n and T lambda times the tension, the Lagrangian of second order in the turning
/// frame is
///     1/2 sum of m (xi'^2 + eta'^2 + zeta'^2) + m (xi eta' - eta xi') + 1/2 m (xi^2 + eta^2)
///     - 1/2 integral of T (a^2 + b^2)    (here ' by time).
/// A held lower end must not move. On panels a and b are polynomials, given at the nodes of Gauss's
/// rule. They need not be continuous (a chain of links has one node a panel). Integrals use Gauss's
/// rule on panels, or on each piece of the density in a panel, since near a free end the density
/// may be a power of the arc. The order is twice the number of nodes for smooth shapes.
template <int = 0>  // a template, so that it is compiled only where it is used
class DisturbedCord {
   public:
    DisturbedCord(const CordProfile& shape, int nodes)
        : shape_(shape), nodes_(nodes), rule_(detail::gauss_rule(nodes)) {
        const std::vector<double> ends = panel_ends();
        const auto panels = static_cast<Index>(ends.size()) - 1, n = panels * nodes;
        for (Vector<double>* v : {&wide_, &cosine_, &sine_}) v->resize(n);
        for (Index p = 0; p < panels; ++p)
            add_panel(p, ends[static_cast<std::size_t>(p)], ends[static_cast<std::size_t>(p) + 1]);
    }

    Disturbed disturbed() const {
        Disturbed d;
        const Index n = wide_.size(), m = static_cast<Index>(points_.size());
        const Vector<double> scale = wide_.cwiseSqrt().cwiseInverse();  // orthonormal basis
        Matrix<double> value = Matrix<double>::Zero(m, n);
        Matrix<double> along = Matrix<double>::Zero(m + 1, n);  // integrals upwards; last: whole
        Vector<double> mass(m + 1), length(m + 1), tension(m);
        for (Index i = 0; i < m; ++i) {
            const Point& point = points_[static_cast<std::size_t>(i)];
            const Index first = point.panel * nodes_, above = first + nodes_;
            const auto own = scale.segment(first, nodes_);
            value.row(i).segment(first, nodes_) = lagrange(point.at).cwiseProduct(own);
            along.row(i).segment(first, nodes_) =
                point.panel_width * integrals(point.at).cwiseProduct(own);
            along.row(i).tail(n - above) = wide_.cwiseProduct(scale).tail(n - above);
            mass[i] = point.mass, length[i] = point.wide, tension[i] = point.wide * point.tension;
            d.doubt = std::max(d.doubt, point.tension);
        }
        along.row(m) = wide_.cwiseProduct(scale);
        mass[m] = shape_.tip, length[m] = 0;
        const Matrix<double> X = along * cosine_.asDiagonal(), Z = along * sine_.asDiagonal(),
                             Y = -along;
        const auto weighed = [](const Matrix<double>& left, const Vector<double>& by,
                                const Matrix<double>& right) {
            return Matrix<double>(left.transpose() * by.asDiagonal() * right);
        };
        const Matrix<double> across = weighed(X, mass, X), pulled = weighed(value, tension, value);
        d.inertia = across + weighed(Z, mass, Z);
        d.coupling = weighed(X, mass, Y), d.mass = weighed(Y, mass, Y);
        d.in_plane = pulled - across;
        d.out_of_plane = pulled - d.mass;
        d.turned = d.bending = d.swivelling = Matrix<double>::Zero(n, n);
        d.drag_across = weighed(Y, length, Y), d.drag_coupling = weighed(X, length, Y);
        d.drag_in_plane = weighed(X, length, X) + weighed(Z, length, Z);
        d.ends = Matrix<double>::Zero(n, 2);
        d.offset = -sine_.cwiseQuotient(scale);
        if (shape_.is_held) {
            d.ends << X.row(m).transpose(), Z.row(m).transpose();
            const Matrix<double> out = complement(Matrix<double>(Y.row(m).transpose()));
            d.keep(complement(d.ends), out);
            d.offset = (out.transpose() * d.offset).eval();
        }
        return d;
    }

   private:
    /// Returns the ends of panels: ends of steps, except steps along which the cord hardly turns.
    std::vector<double> panel_ends() const {
        const double length = shape_.length, longest = length / (2 * shape_.half_waves + 2);
        std::vector<double> ends{0};
        const auto inclination = [&](double arc) { return shape_.at(arc)[0]; };
        double last = inclination(0);
        const auto add_up_to = [&](double end, double angle) {
            const double from = ends.back(), turn = std::abs(angle - last) / 0.7,
                         wide = (end - from) / longest;
            const int parts =
                std::max(1, static_cast<int>(std::ceil(std::max(wide, std::min(turn, 4.0)) - 0.2)));
            for (int i = 1; i <= parts; ++i)
                ends.push_back(i == parts ? end : from + (end - from) * i / parts);
            last = angle;
        };
        for (const double at : shape_.steps) {
            if (!(at > ends.back()) || !(at < length)) continue;
            const double angle = inclination(at);
            if (at - ends.back() > longest / 2 || std::abs(angle - last) > 0.4)
                add_up_to(at, angle);
        }
        add_up_to(length, inclination(length));
        add_jumps(ends);
        return ends;
    }
    /// Adds the jumps of the density to `ends`, unless there would be too many unknowns.
    void add_jumps(std::vector<double>& ends) const {
        constexpr std::size_t most = 16;
        std::vector<double> jumps;
        for (const double at : shape_.pieces) {
            const double last = jumps.empty() ? 1000 * narrow() : jumps.back() + 4 * narrow();
            if (!(at > last && at < shape_.length - narrow())) continue;
            const double below = shape_.density(at - narrow()),
                         above = shape_.density(at + narrow());
            if (std::abs(above - below) > 0.01 * std::max(above, below)) jumps.push_back(at);
        }
        if (jumps.size() > most) jumps.clear();
        const std::size_t found = jumps.size();
        for (const auto& particle : shape_.particles) {  // where the cord turns
            const double at = particle.first;
            if (std::none_of(jumps.begin(), jumps.begin() + static_cast<std::ptrdiff_t>(found),
                             [&](double x) { return std::abs(x - at) < narrow(); }))
                jumps.push_back(at);
        }
        const auto has_jump = [&](double at) {
            return std::any_of(jumps.begin(), jumps.end(),
                               [&](double x) { return std::abs(x - at) < narrow(); });
        };
        ends.erase(std::remove_if(ends.begin() + 1, ends.end() - 1, has_jump), ends.end() - 1);
        ends.insert(ends.end() - 1, jumps.begin(), jumps.end());
        std::sort(ends.begin(), ends.end());
    }
    /// Returns the Lagrange polynomials of the nodes at x, which goes from 0 to 1 over a panel.
    Vector<double> lagrange(double x) const {
        Vector<double> values = Vector<double>::Ones(nodes_);
        for (Index j = 0; j < nodes_; ++j)
            for (Index k = 0; k < nodes_; ++k)
                if (k != j) values[j] *= (x - node(k)) / (node(j) - node(k));
        return values;
    }
    Vector<double> integrals(double x) const {
        Vector<double> sum = Vector<double>::Zero(nodes_);
        for (const auto& [t, weight] : rule_) sum += weight * (1 - x) * lagrange(x + (1 - x) * t);
        return sum;
    }
    double node(Index i) const { return rule_[static_cast<std::size_t>(i)].first; }

    void add_panel(Index panel, double low, double high) {
        for (Index i = 0; i < nodes_; ++i) {
            const auto& [t, weight] = rule_[static_cast<std::size_t>(i)];
            const double inclination = shape_.at(low + (high - low) * t)[0];
            const Index at = panel * nodes_ + i;
            wide_[at] = weight * (high - low), cosine_[at] = std::cos(inclination),
            sine_[at] = std::sin(inclination);
        }
        double from = low;
        for (const double end : shape_.pieces)
            if (end > from + narrow() && end < high - narrow())
                add_points(panel, low, high, from, end), from = end;
        add_points(panel, low, high, from, high);
        for (const auto& [at, weight] : shape_.particles)
            if (std::abs(at - high) < narrow())
                points_.push_back({panel, high - low, 1, 0, weight, 0});
    }
    /// Adds points in a part of a panel, with the exact weight of that part.
    void add_points(Index panel, double low, double high, double from, double to) {
        const std::size_t first = points_.size();
        double sum = 0;
        for (const auto& [t, weight] : rule_) {
            const double arc = from + (to - from) * t, wide = weight * (to - from);
            points_.push_back({panel, high - low, (arc - low) / (high - low), wide,
                               wide * shape_.density(arc), shape_.at(arc)[1]});
            sum += points_.back().mass;
        }
        const double whole = shape_.weight_below(to) - shape_.weight_below(from);
        for (std::size_t i = first; i < points_.size(); ++i) points_[i].mass *= whole / sum;
    }
    double narrow() const { return 1e-7 * shape_.length; }

    struct Point {
        Index panel;
        double panel_width, at;  ///< at: 0 to 1 over the panel
        double wide, mass, tension;
    };

    const CordProfile& shape_;
    Index nodes_;
    std::vector<std::pair<double, double>> rule_;
    Vector<double> wide_, cosine_, sine_;  // at the nodes
    std::vector<Point> points_;            // points of integration
};

/// Returns the stability on which two discretisations agree.
template <class Shape>
Stability judged(StabilityFrame frame, const Cord& cord, const Shape& shape) {
    if (!(std::abs(shape.length - cord.length()) <= 1e-14 * cord.length()))
        detail::throw_invalid("stability", "the shape is not of this cord; it is as long as",
                              shape.length);
    const CordProfile profile = profile_of(shape);
    const auto found = [&](int nodes) {
        return judged(frame, DisturbedCord(profile, nodes).disturbed(), ChainUnits{});
    };
    const Stability coarse = found(8);
    detail::check_interrupt();
    Stability result = found(10);
    if (coarse.exponents.empty() || result.exponents.empty()) {  // as of a cord folded on the axis
        Stability unknown;
        unknown.frame = frame;
        unknown.growth_rate = std::numeric_limits<double>::quiet_NaN();
        return unknown;
    }
    const double apart = std::abs(result.growth_rate - coarse.growth_rate);
    result.margin = std::max({1e-7, 2 * apart, 1e-13 * std::abs(result.exponents.back())});
    if (result.verdict != Verdict::minimum) {
        const bool grows = result.growth_rate > result.margin;
        result.verdict = grows                                       ? Verdict::unstable
                         : result.growth_rate < 1e-2 * result.margin ? Verdict::spectrally_stable
                                                                     : Verdict::undecided;
    }
    if (result.negative_directions != coarse.negative_directions)
        result.verdict = Verdict::undecided;
    // keep the slowest exponents, up to the first that only one discretisation has
    const auto unconfirmed = [](const Stability& of, const Stability& by) {
        double slowest = std::numeric_limits<double>::infinity();
        for (const std::complex<double>& s : of.exponents) {
            const auto alike = [&](const std::complex<double>& x) {
                return std::abs(x - s) <= 1e-6 * std::abs(s) + 1e-9 ||
                       std::abs(x * x - s * s) <= 1e-9;
            };
            if (std::none_of(by.exponents.begin(), by.exponents.end(), alike))
                slowest = std::min(slowest, std::abs(s));
        }
        return slowest;
    };
    const double limit =
        (1 - 1e-6) * std::min(unconfirmed(result, coarse), unconfirmed(coarse, result));
    std::vector<std::complex<double>> kept;
    std::vector<double> external, error;
    for (std::size_t i = 0; i < result.exponents.size(); ++i) {
        const std::complex<double> s = result.exponents[i];
        if (!(std::abs(s) < limit)) continue;
        double off = std::numeric_limits<double>::infinity();
        for (const std::complex<double>& x : coarse.exponents) off = std::min(off, std::abs(x - s));
        kept.push_back(s), external.push_back(result.external_damping[i] / cord.line_weight());
        error.push_back(std::max(off, result.exponent_error[i]));
    }
    result.exponents = std::move(kept), result.external_damping = std::move(external);
    result.exponent_error = std::move(error);
    result.internal_damping.assign(result.exponents.size(),
                                   std::numeric_limits<double>::quiet_NaN());
    return result;
}

}  // namespace revchain::finite

namespace revchain::inline REVCHAIN_BUILD {

REVCHAIN_DEFINE
Stability stability(const Cord& cord, const CordShape& shape, StabilityFrame frame) {
    return finite::judged(frame, cord, shape);
}

REVCHAIN_DEFINE
Stability stability(const Cord& cord, const HeldCordShape& shape, StabilityFrame frame) {
    return finite::judged(frame, cord, shape);
}

}  // namespace revchain
