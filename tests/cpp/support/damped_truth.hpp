// SPDX-License-Identifier: MPL-2.0
// Rigs with springs, dashpots and trolleys in quadruple precision: energies added up in rotations, dense matrices that the
// library never assembles; and random rigs.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "revchain/rig.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

namespace support {

using namespace revchain;

struct Z {  // std::complex is for built-in scalars only
    Quad re = 0, im = 0;
    friend Z operator+(Z x, Z y) { return {x.re + y.re, x.im + y.im}; }
    friend Z operator-(Z x, Z y) { return {x.re - y.re, x.im - y.im}; }
    friend Z operator*(Z x, Z y) { return {x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re}; }
    friend Z operator/(Z x, Z y) {
        const Quad size = y.re * y.re + y.im * y.im;
        return {(x.re * y.re + x.im * y.im) / size, (x.im * y.re - x.re * y.im) / size};
    }
    friend Quad size_of(Z x) { return sqrtq(x.re * x.re + x.im * x.im); }
};

/// Makes the left square of a matrix diagonal: Gauss and Jordan, with the largest pivot of each column.
inline void reduce(std::vector<std::vector<Z>>& Q) {
    for (std::size_t p = 0; p < Q.size(); ++p) {
        std::size_t best = p;
        for (std::size_t k = p; k < Q.size(); ++k)
            if (size_of(Q[k][p]) > size_of(Q[best][p])) best = k;
        std::swap(Q[p], Q[best]);
        for (std::size_t k = 0; k < Q.size(); ++k) {
            if (k == p) continue;
            const Z share = Q[k][p] / Q[p][p];
            for (std::size_t l = p; l < Q[k].size(); ++l) Q[k][l] = Q[k][l] - share * Q[p][l];
        }
    }
}

struct DampedTruth {
    using Square = std::vector<std::vector<Quad>>;
    std::size_t links, size;
    Square K, C, G, M;

    DampedTruth(const Rig& rig, double gravity, bool with_support = false)
        : links(static_cast<std::size_t>(rig.size())) {
        const Support& support = rig.support();
        size = links + (support.is_firm() && !with_support ? 0 : 1);
        for (Square* each : {&K, &C, &G, &M}) each->assign(size, std::vector<Quad>(size, 0));
        Quad hung = 0;
        for (std::size_t m = 0; m < links; ++m) {
            const auto i = static_cast<Index>(m);
            const Link<double> link = rig.chain().link(i);
            const Quad sign = rig.stands(i) ? -1 : 1, W = link.weight, a = link.length;
            // the centre's offset by every rotation above, by its own, and by the support's offset
            std::vector<Quad> centre(size, 0);
            centre[m] = sign * link.centroid;
            for (std::size_t k = m + 1; k < links; ++k) centre[k] = lever(rig, k);
            if (size > links) centre[links] = 1;
            for (std::size_t k = 0; k < size; ++k)
                for (std::size_t l = 0; l < size; ++l) M[k][l] += W * centre[k] * centre[l] / gravity;
            M[m][m] += W * quad(link.gyration_ratio) * a * a / gravity;
            const Quad drag = quad(rig.drag(i));  // on the velocity of the middle, and about it
            centre[m] = sign * a / 2;
            for (std::size_t k = 0; k < size; ++k)
                for (std::size_t l = 0; l < size; ++l) C[k][l] += drag * centre[k] * centre[l];
            C[m][m] += drag * a * a / 12;
            K[m][m] += sign * (W * link.centroid + a * hung);
            G[m][m] += sign * quad(rig.flywheel(i).momentum);
            hung += W;
            const Pin pin = rig.pin(i);
            for (auto [matrix, number] : {std::pair(&K, quad(pin.stiffness)), std::pair(&C, quad(pin.damping))}) {
                (*matrix)[m][m] += number;
                if (m + 1 == links) continue;
                (*matrix)[m + 1][m + 1] += number;
                (*matrix)[m][m + 1] -= number, (*matrix)[m + 1][m] -= number;
            }
        }
        if (size == links) return;
        if (support.is_firm()) return;  // a coordinate that is prescribed
        K[links][links] += quad(support.stiffness), C[links][links] += quad(support.damping);
        M[links][links] += Quad(support.carriage_weight) / gravity;
    }
    static Quad lever(const Rig& rig, std::size_t m) {
        const auto i = static_cast<Index>(m);
        return (rig.stands(i) ? -1 : 1) * Quad(rig.chain().length()[i]);
    }

    Z at(Z s, std::size_t k, std::size_t l) const {
        return Z{K[k][l], 0} + s * (Z{C[k][l], 0} - Z{0, 1} * Z{G[k][l], 0}) + s * s * Z{M[k][l], 0};
    }
    /// Newton's step at s for det Q: 1 / trace(Q^-1 Q').
    Z step(Z s) const {
        std::vector<std::vector<Z>> Q(size, std::vector<Z>(2 * size));  // beside Q its derivative
        const Z i{0, 1};
        for (std::size_t k = 0; k < size; ++k)
            for (std::size_t l = 0; l < size; ++l) {
                Q[k][l] = at(s, k, l);
                Q[k][size + l] = Z{C[k][l], 0} - i * Z{G[k][l], 0} + (s + s) * Z{M[k][l], 0};
            }
        reduce(Q);
        Z trace;
        for (std::size_t k = 0; k < size; ++k) trace = trace + Q[k][size + k] / Q[k][k];
        return Z{1, 0} / trace;
    }
    /// The nearest root of det Q: Newton's method from s, with the others so far away that it converges at once.
    Z root(std::complex<double> start) const {
        Z s{start.real(), start.imag()};
        for (int round = 0; round < 4; ++round) {
            const Z change = step(s);
            if (!(size_of(change) >= 0)) break;  // NaN: a pivot is 0, at the exact root
            s = s - change;
        }
        return s;
    }
};

struct DampedOptions {
    bool damped = true, momentum = false, extreme = false, stands = false, drag = false;
    Index most = 12;
};

inline Rig random_rig(Random& random, const DampedOptions& options) {
    const auto n = static_cast<Index>(random.between(1, double(options.most) + 0.999));
    std::vector<Link<double>> links;
    double weight = 0, length = 0;
    for (Index m = 0; m < n; ++m) {
        const double decades = options.extreme ? 8 : 2;
        const double w = std::pow(10, random.between(-decades, decades)), a = std::pow(10, random.between(-1, 1));
        const double h = a * random.between(0.05, 1.5), k = a * random();
        links.push_back(compound_pendulum<double>({.weight = w, .length = a, .centroid = h, .radius_of_gyration = k}));
        weight += w, length += a;
    }
    Rigging with;
    const double time = std::sqrt(length / 9.81);
    const auto stiffness = [&] { return std::pow(10, random.between(-3, 3)); };
    const auto damping = [&](double k) { return options.damped ? 2 * random.log_between(1e-4, 2) * k * time : 0.0; };
    for (Index m = 0; m < n; ++m) {
        const double k = stiffness();
        with.pins.push_back(
            {k * weight * length * (random() < 0.7 ? 1.0 : 0.0), damping(std::sqrt(k)) * weight * length});
        if (options.drag) with.drag.push_back(random() < 0.7 ? damping(1) * weight / length : 0.0);
        if (options.momentum) with.flywheels.push_back({random.between(-3, 3) * weight * length * time, 0});
        with.posture.push_back(options.stands && random() < 0.5 ? Posture::stands : Posture::hangs);
    }
    if (random() < 0.6) {
        const double k = random() < 0.3 ? 0.0 : stiffness();
        with.support = {k * weight / length, weight * random.log_between(1e-2, 1e2), 0};
        if (random() < 0.7) with.support.damping = damping(std::sqrt(std::max(k, 0.1))) * weight / length;
    }
    return {Chain<double>(links), with};
}

}  // namespace support
