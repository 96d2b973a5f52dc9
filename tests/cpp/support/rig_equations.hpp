// SPDX-License-Identifier: MPL-2.0
// The truth about rigs in quadruple precision, from bodies one by one: K, G and M of small offsets, moments of steady
// shapes, Lagrange's function of small motions. It shares nothing with the library but the data.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include "revchain/rig.hpp"
#include "support/solved.hpp"
#include "support/truth.hpp"

namespace support {

using revchain::Index;
using revchain::Rig;

inline Quad sine(Quad x) { return sinq(x); }
inline Quad cosine(Quad x) { return cosq(x); }
inline double sine(double x) { return std::sin(x); }
inline double cosine(double x) { return std::cos(x); }

/// A body: the link it belongs to, the weights that bear and move, its centre and radius of gyration squared.
template <class T>
struct Body {
    std::size_t link;
    T bears, moves, depth, turn;
};

/// The numbers of a rig.
template <class T>
struct RigData {
    Numbers<T> a, momentum, axial;
    std::vector<Body<T>> bodies;
    T stiffness, carriage, radius;
    bool yields;

    explicit RigData(const Rig& rig) {
        const auto number = [](const auto& x) { return static_cast<T>(quad(x)); };
        for (Index m = 0; m < rig.size(); ++m) {
            const auto link = rig.chain().link(m);
            const auto fluid = rig.displaced(m);
            const auto i = static_cast<std::size_t>(m);
            const T length = number(link.length), square = length * length;
            a.push_back(length);
            bodies.push_back({i, number(link.weight), number(link.weight), number(link.centroid),
                              number(link.gyration_ratio) * square});
            const T lent = number(rig.fluid() == revchain::Fluid::turning ? -fluid.weight : fluid.added_weight);
            bodies.push_back(
                {i, -number(fluid.weight), lent, number(fluid.centroid), number(fluid.gyration_ratio) * square});
            momentum.push_back(number(rig.flywheel(m).momentum)), axial.push_back(number(rig.flywheel(m).axial_moment));
        }
        yields = !rig.support().is_firm();
        stiffness = number(yields ? rig.support().stiffness : revchain::Wide<double>(0.0));
        carriage = number(rig.support().carriage_weight), radius = number(rig.support().radius);
    }
    std::size_t size() const { return a.size(); }
    std::size_t unknowns() const { return size() + yields; }
};

/// K + n G - (n^2/g) M of small offsets, tridiagonal.
class QuadPencil {
   public:
    explicit QuadPencil(const Rig& rig, Quad gravity = 9.80665) : gravity_(gravity) {
        const RigData<Quad> data(rig);
        const std::size_t n = data.unknowns(), links = data.size();
        for (auto* matrix : {&K_, &G_, &M_}) matrix->fill(Numbers<Quad>(n + 1, 0));
        const auto add = [&](auto& to, std::size_t m, Quad factor, Quad low, Quad high) {  // factor (low y + high y')^2
            to[0][m] += factor * low * low, to[1][m] += factor * low * high;
            to[0][m + 1] += factor * high * high;
        };
        Quad below = 0;
        for (std::size_t m = 0; m < links; ++m) {
            const Quad a = data.a[m], sign = rig.stands(static_cast<Index>(m)) ? -1 : 1;
            Quad kappa = a * below;
            for (const auto& body : data.bodies) {
                if (body.link != m) continue;
                kappa += body.bears * body.depth, below += body.bears;
                add(M_, m, body.moves, body.depth / a, (a - body.depth) / a);
                add(M_, m, body.moves * body.turn, 1 / a, -1 / a);
            }
            add(M_, m, -data.axial[m], 1 / a, -1 / a);
            add(K_, m, sign * kappa, 1 / a, -1 / a);
            add(G_, m, sign * data.momentum[m], 1 / a, -1 / a);
        }
        if (data.yields) K_[0][n - 1] += data.stiffness, M_[0][n - 1] += data.carriage;
        for (auto* matrix : {&K_, &G_, &M_}) (*matrix)[0].resize(n), (*matrix)[1].resize(n), (*matrix)[1][n - 1] = 0;
    }
    std::size_t size() const { return K_[0].size(); }
    /// Negative eigenvalues of k K + s G - m M.
    int negative(Quad k, Quad s, Quad m) const {
        int count = 0;
        Quad pivot = 1, off = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            const Quad d = k * K_[0][i] + s * G_[0][i] - m * M_[0][i];
            pivot = d - (i == 0 ? Quad(0) : off * off / pivot);
            count += pivot < 0;
            off = k * K_[1][i] + s * G_[1][i] - m * M_[1][i];
        }
        return count;
    }
    /// Heights above one: eigenvalues of K - M/h below 0 beyond those of K. M >= 0.
    int above(Quad height) const { return negative(1, 0, 1 / height) - negative(1, 0, 0); }
    /// Speeds between 0 and n, of its sense. K > 0, M >= 0.
    int slower(Quad n) const { return negative(1, n, n * n / gravity_); }

    /// The root of det (K + n G - n^2/g M), or with `height` of det (K - M/h), next to one, by Newton's method.
    std::complex<Quad> root(std::complex<Quad> x, bool height) const {
        using C = std::complex<Quad>;
        for (int step = 0; step < 6; ++step) {
            C p(1), before(0), dp(0), dbefore(0), off(0), doff(0);
            for (std::size_t i = 0; i < size(); ++i) {
                const auto value = [&](int j) {
                    return height ? x * C(K_[j][i]) - C(M_[j][i])
                                  : C(K_[j][i]) + x * C(G_[j][i]) - x * x * C(M_[j][i] / gravity_);
                };
                const auto slope = [&](int j) {
                    return height ? C(K_[j][i]) : C(G_[j][i]) - C(2) * x * C(M_[j][i] / gravity_);
                };
                const C next = value(0) * p - off * off * before;
                const C dnext = slope(0) * p + value(0) * dp - C(2) * off * doff * before - off * off * dbefore;
                before = p, dbefore = dp, p = next, dp = dnext, off = value(1), doff = slope(1);
            }
            x -= p / dp;
        }
        return x;
    }

   private:
    Quad gravity_;
    std::array<Numbers<Quad>, 2> K_, G_, M_;  // diagonal, and beside it
};

/// Moments of a steady shape about its pins, and the force on a support that yields; place: inclinations, then that
/// support's offset.
template <class T>
class ShapeEquations {
   public:
    ShapeEquations(const Rig& rig, T height, T speed) : data_(rig), height_(height), speed_(speed) {}
    std::size_t size() const { return data_.unknowns(); }

    /// The solution next to a place, by Newton's method; nothing where it does not settle.
    std::optional<Numbers<T>> solved_from(Numbers<T> place, int steps, T settled) const {
        for (int i = 0; i < steps; ++i) {
            auto [balance, slope] = at(place);
            const auto change = solved(std::move(slope), std::move(balance));
            if (!change) return std::nullopt;
            T largest = 0;
            for (std::size_t j = 0; j < place.size(); ++j) {
                place[j] -= (*change)[j];
                largest = std::max(largest, (*change)[j] < 0 ? -(*change)[j] : (*change)[j]);
            }
            if (!(largest < T(1e6))) return std::nullopt;
            if (largest < settled) return place;
        }
        return std::nullopt;
    }

   private:
    std::pair<Numbers<T>, std::vector<Numbers<T>>> at(const Numbers<T>& place) const {
        const std::size_t n = data_.size(), all = size();
        const T top = data_.yields ? place[n] : data_.radius;
        Numbers<T> s(n), c(n), balance(all, 0), gradient(all);
        std::vector<Numbers<T>> slope(all, Numbers<T>(all, 0));
        for (std::size_t i = 0; i < n; ++i) s[i] = sine(place[i]), c[i] = cosine(place[i]);
        for (const Body<T>& body : data_.bodies) {
            const auto arm = [&](std::size_t i) { return i == body.link ? body.depth : data_.a[i]; };
            T out = top;
            for (std::size_t i = body.link; i < n; ++i) out += arm(i) * s[i];
            for (std::size_t i = body.link; i < n; ++i) gradient[i] = arm(i) * c[i];
            if (data_.yields) gradient[n] = 1;
            const T pull = body.moves / height_;
            for (std::size_t i = body.link; i < n; ++i) {
                balance[i] += arm(i) * (body.bears * s[i] - pull * out * c[i]);
                slope[i][i] += arm(i) * (body.bears * c[i] + pull * out * s[i]);
            }
            if (data_.yields) balance[n] -= pull * out;
            for (std::size_t i = body.link; i < all; ++i)
                for (std::size_t j = body.link; j < all; ++j) slope[i][j] -= pull * gradient[i] * gradient[j];
            turned(balance, slope, body.link, pull * body.turn, s, c);
        }
        for (std::size_t i = 0; i < n; ++i) {
            turned(balance, slope, i, -data_.axial[i] / height_, s, c);
            balance[i] += speed_ * data_.momentum[i] * s[i], slope[i][i] += speed_ * data_.momentum[i] * c[i];
        }
        if (data_.yields) {
            balance[n] += data_.stiffness * (top - data_.radius) - data_.carriage * top / height_;
            slope[n][n] += data_.stiffness - data_.carriage / height_;
        }
        return {balance, slope};
    }
    static void turned(Numbers<T>& balance, std::vector<Numbers<T>>& slope, std::size_t i, T factor,
                       const Numbers<T>& s, const Numbers<T>& c) {
        balance[i] -= factor * s[i] * c[i], slope[i][i] -= factor * (c[i] * c[i] - s[i] * s[i]);
    }
    RigData<T> data_;
    T height_, speed_;
};

}  // namespace support
