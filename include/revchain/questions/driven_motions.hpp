// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "revchain/linear/damped_system.hpp"
#include "revchain/linear/moved_support.hpp"
#include "revchain/pencil/damped/motion.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns offsets of all pins from below the support, and the support's own.
REVCHAIN_LAZY
Vector<pencil::Complex> deflections(Vector<pencil::Complex> offsets) {
    const Index last = offsets.size() - 1;
    offsets.head(last).array() -= pencil::Complex(offsets[last]);
    return offsets;
}

/// A rig's motion relative to its support: loads, start, and the motions q_j exp(s_j t).
template <int = 0>  // compiled where it is used
class DrivenMotions {
   public:
    using C = pencil::ComplexWord;
    using S = Wide<double>;
    using Complex = pencil::Complex;

    /// One motion. Without momentum it stands for its conjugate, too.
    struct Motion {
        C s;
        Complex rate;
        int times;              ///< 2 for a pair of conjugates, of which twice the real part counts
        Vector<Complex> shape;  ///< offsets of all pins
        std::vector<Complex> q;       ///< rotations
        std::array<Complex, 2> load;  ///< q^T times each load
        Complex start;                ///< its amplitude at time 0
    };
    std::vector<Motion> motions;
    std::array<Complex, 2> drift{};  ///< of a trolley that keeps its momentum: offset and velocity
    double whole = 0;                ///< its weight with all links'
    double defect = 0;               ///< how far the motions are from being independent, relative
    /// The response of parts without inertia to each load.
    std::array<Vector<Complex>, 2> at_once;

    DrivenMotions(const Rig& rig, double gravity, Moved moved)
        : system_(rig, gravity),
          moved_(moved),
          pins_(rig.size() + 1),
          roots_(damped_roots(system_)) {
        if (!rig.is_damped())  // what swings does so for ever
            for (auto& root : roots_)
                if (std::abs(root.s.real.high) < 1e-20 * std::abs(root.s.imag.high))
                    root.s.real = S(0.0);
        set_loads();
        for (const auto& e : system_.rig.pencil.elements) whole += static_cast<double>(e.weight);
    }
    const DampedSystem& system() const { return system_; }
    const std::array<std::vector<C>, 2>& loads() const { return loads_; }
    std::size_t size() const { return static_cast<std::size_t>(system_.pencil().size()); }
    bool all_found() const {
        Index known = 0;
        for (const auto& root : roots_) known += system_.momentum || root.real ? 1 : 2;
        return !system_.inertia || known + (system_.rests ? 1 : 0) == system_.exponents();
    }

    /// Returns x, the part of one motion, plus the part of the conjugate motion if there is one.
    Complex counted(const Motion& each, const Complex& x) const {
        return system_.momentum ? x : Complex(each.times * x.real(), 0.0);
    }
    /// Offsets of all pins of rotations, free end first.
    Vector<Complex> offsets_of(const std::vector<C>& q) const {
        const std::vector<C> found =
            pencil::offsets(system_.pencil(), q, [](const S& lever) { return C(lever); });
        Vector<Complex> result(pins_);
        for (Index m = 0; m < result.size(); ++m)
            result[m] = static_cast<Complex>(
                found[static_cast<std::size_t>(std::max<Index>(0, m - system_.rig.idle))]);
        return result;
    }
    /// The largest offsets of all pins from below the support, and of the support from its resting
    /// place, of free motions with these amplitudes. The sizes of motions that hardly decay are
    /// added: a bound, near which they come if their speeds are in no simple ratio. The sum of the
    /// others is seen at 400 instants, to 1 %.
    Vector<double> largest_deflections(const std::vector<Complex>& amplitude) const {
        Vector<double> result = Vector<double>::Zero(pins_);
        std::vector<std::size_t> others;
        double shortest = std::numeric_limits<double>::infinity(), longest = 0;
        for (std::size_t j = 0; j < motions.size(); ++j) {
            const Motion& each = motions[j];
            const double far = std::abs(each.rate), decay = -each.rate.real();
            if (far == 0) continue;
            const Vector<double> part = deflected(each, amplitude[j]);
            if (decay < -1e-12 * far && part.maxCoeff() > 0)  // it grows
                return Vector<double>::Constant(pins_, std::numeric_limits<double>::infinity());
            if (decay < 0.05 * far) {
                result += part;
                continue;
            }
            others.push_back(j);
            shortest = std::min(shortest, 0.02 / far), longest = std::max(longest, 12 / decay);
        }
        if (others.empty()) return result;
        Vector<double> sum = Vector<double>::Zero(pins_);
        for (int i = -1; i < 400; ++i) {
            const double t = i < 0 ? 0 : shortest * std::pow(longest / shortest, i / 399.0);
            Vector<Complex> y = Vector<Complex>::Zero(pins_);
            for (const std::size_t j : others) {
                const Complex now = amplitude[j] * std::exp(motions[j].rate * t);
                const Vector<Complex> shape = deflections(motions[j].shape);
                for (Index m = 0; m < pins_; ++m) y[m] += counted(motions[j], now * shape[m]);
            }
            sum = sum.cwiseMax(y.cwiseAbs());
        }
        return result + sum;
    }
    /// How many times the largest sum, `sway`, the sizes of free motions are, if they cancel.
    double cancelled(const std::vector<Complex>& amplitude, const Vector<double>& sway) const {
        Vector<double> size = Vector<double>::Zero(pins_);
        for (std::size_t j = 0; j < motions.size(); ++j)
            if (motions[j].rate != Complex(0.0)) size += deflected(motions[j], amplitude[j]);
        const auto times = [](double of, double sum) { return of > sum ? of / sum : 1.0; };
        const Index last = pins_ - 1;  // the support moves by itself
        return std::max(times(size.head(last).maxCoeff(), sway.head(last).maxCoeff()),
                        times(size[last], sway[last]));
    }
    /// Splits a start (rotations and their rates, in pencil units) into motions.
    void split(const std::vector<C>& q, const std::vector<C>& rate) {
        start_ = q, start_rate_ = rate;
        collect();
        if (defect < 0x1p-46) return;
        for (auto& root : roots_) pencil::sharpen(system_.pencil(), root);
        collect();
    }

   private:
    /// The largest deflections of one free motion.
    static Vector<double> deflected(const Motion& of, const Complex& amplitude) {
        return of.times * std::abs(amplitude) * deflections(of.shape).cwiseAbs();
    }

    using Factors = pencil::JointFactors<C>;

    void set_loads() {
        const auto& pencil = system_.pencil();
        const C none(S(0.0)), one(S(1.0));
        if (moved_ == Moved::by_force) {
            for (auto& load : loads_) load.assign(size(), none);
            loads_[0].back() = one;
            return;
        }
        const pencil::MovedTogether<C> mass(pencil, {none, none, none, -one}),
            damping(pencil, {none, none, -one, none});
        loads_ = {mass.load, damping.load};
    }
    /// Sets motions, amplitudes of the start, and the defect.
    void collect() {
        const auto& pencil = system_.pencil();
        const C none(S(0.0)), one(S(1.0)), unit(S(0.0), S(1.0));
        const std::vector<C> damped =
            pencil::applied(pencil, Factors{none, -unit, one, none}, start_);
        const Factors mass_factors{none, none, none, one};
        const std::vector<C> heavy = pencil::applied(pencil, mass_factors, start_),
                             momentum = pencil::applied(pencil, mass_factors, start_rate_);
        motions.clear();
        const auto take = [&](const pencil::DampedRoot& root, bool real) {
            Motion& each = motions.emplace_back();
            each.s = root.s, each.rate = static_cast<Complex>(root.s);
            each.times = system_.momentum || real ? 1 : 2;
            each.q = pencil::in_double(root.q);
            each.shape = offsets_of(root.q);
            each.start =
                static_cast<Complex>(pencil::dot(root.q, damped) + pencil::dot(root.q, momentum) +
                                     root.s * pencil::dot(root.q, heavy));
            for (std::size_t c = 0; c < 2; ++c)
                each.load[c] = static_cast<Complex>(pencil::dot(root.q, loads_[c]));
        };
        for (const auto& root : roots_) take(root, root.real);
        if (system_.rests) {  // a motion that does not decay: all moved together
            pencil::DampedRoot rest;
            rest.q.assign(size(), none);
            rest.q.back() = C(S(1.0) / sqrt(pencil::damping_together(pencil)));
            take(rest, true);
        }
        if (system_.drifts) {
            const C weight{S(whole)};
            drift = {static_cast<Complex>(heavy.back() / weight),
                     static_cast<Complex>(momentum.back() / weight)};
        }
        measure_defect();
        if (!system_.inertia) set_at_once();
    }
    /// Sets `defect`. The motions add up to the start, and the sum of s_j q_j q_j^T load is M^-1 load
    /// for torques on the links.
    void measure_defect() {
        defect = 0;
        if (!system_.inertia) return;
        const C none(S(0.0)), one(S(1.0));
        const Factors mass{none, none, none, one};
        const std::size_t torques = size() - (system_.drifts ? 1 : 0);
        std::vector<C> load = loads_[0];
        if (torques < size()) load.back() = none;
        std::array<std::vector<C>, 3> sums;
        for (auto& sum : sums) sum.assign(size(), none);
        sums[0].back() = C(drift[0]), sums[1].back() = C(drift[1]);
        for (const Motion& each : motions) {
            Complex part = 0.0;
            for (std::size_t m = 0; m < torques; ++m)
                part += each.q[m] * static_cast<Complex>(load[m]);
            for (std::size_t m = 0; m < size(); ++m) {
                const std::array<Complex, 3> shares{each.q[m] * each.start,
                                                    each.q[m] * each.start * each.rate,
                                                    each.q[m] * part * each.rate};
                for (std::size_t c = 0; c < 3; ++c)
                    sums[c][m] = sums[c][m] + C(counted(each, shares[c]));
            }
        }
        const auto between = [&](const std::vector<C>& found, const std::vector<C>& wanted) {
            double off = 0, largest = 0;
            for (std::size_t m = 0; m < torques; ++m) {
                off = std::max(off, size_of(found[m] - wanted[m]));
                largest = std::max(largest, size_of(wanted[m]));
            }
            return largest > 0 ? off / largest : 0;
        };
        defect = std::max({between(sums[0], start_), between(sums[1], start_rate_),
                           between(pencil::applied(system_.pencil(), mass, sums[2]), load)});
    }
    /// Sets the response of parts without inertia: the whole response less that of the motions, both
    /// at a real s beyond all exponents, where K + s C + s^2 M is regular.
    void set_at_once() {
        const auto& pencil = system_.pencil();
        double beyond = 1;
        for (const Motion& each : motions) beyond = std::max(beyond, 2 * std::abs(each.rate));
        const C s{S(beyond)}, unit(S(0.0), S(1.0));
        const pencil::JointSolver<C> solver(pencil, pencil::damped_factors(s, unit));
        for (std::size_t c = 0; c < 2; ++c) {
            std::vector<C> all = loads_[c];
            solver.solve(all);
            if (system_.drifts) all.back() = all.back() - loads_[c].back() / (C(S(whole)) * s * s);
            Vector<Complex> rest = offsets_of(all);
            for (const Motion& each : motions)
                for (Index m = 0; m < rest.size(); ++m)
                    rest[m] -= counted(each, each.shape[m] * each.load[c] / (beyond - each.rate));
            at_once[c] = rest;
        }
    }

    DampedSystem system_;
    Moved moved_;
    Index pins_;
    std::vector<pencil::DampedRoot> roots_;
    std::array<std::vector<C>, 2> loads_;
    std::vector<C> start_, start_rate_;
};

/// A piece of the motion in the pencil's units of time and length, or of force.
struct ScaledPiece {
    std::array<pencil::Polynomial<double>, 2> load;  ///< what multiplies each load
    Wide<double> begin;

    /// Returns the same polynomials in the time since `from`.
    std::vector<pencil::Polynomial<double>> shifted(double from) const {
        std::vector<pencil::Polynomial<double>> result;
        for (const auto& p : load)
            result.push_back({p[0] + from * (p[1] + from * p[2]), p[1] + 2 * from * p[2], p[2]});
        return result;
    }
};

}  // namespace revchain::detail
