// SPDX-License-Identifier: MPL-2.0
// The truth that a rig's whirl speeds are measured against: quadruple precision, energies of the bodies added up into
// tridiagonal K, G and M (assembled, which the library never does), textbook LDL^T pivots of K + n G - n^2 M/g.
#pragma once

#include <complex>

#include "revchain/rig.hpp"
#include "support/truth.hpp"

namespace support {

class RigTruth {
   public:
    using Index = revchain::Index;
    /// Symmetric and tridiagonal: diagonal and the one above it.
    struct Band {
        std::vector<Quad> d, e;
    };
    Band K, G, M;

    explicit RigTruth(const revchain::Rig& rig, Quad gravity = revchain::conical_pendulum::standard_gravity)
        : gravity_(gravity) {
        const bool firm = rig.support().is_firm();
        const std::size_t links = static_cast<std::size_t>(rig.size());
        size = links + (firm ? 0 : 1);
        for (Band* band : {&K, &G, &M}) band->d.assign(size + 1, 0), band->e.assign(size + 1, 0);
        Quad hung = 0;
        for (std::size_t m = 0; m < links; ++m) {
            const Index i = static_cast<Index>(m);
            const revchain::Link<double> link = rig.chain().link(i);
            const revchain::Displaced fluid = rig.displaced(i);
            const Quad a = link.length, sign = rig.stands(i) ? -1 : 1;
            const Quad W = link.weight, h = link.centroid, B = fluid.weight, hB = fluid.centroid;
            const bool turning = rig.fluid() == revchain::Fluid::turning;
            const Quad moment = W * h - B * hB + a * hung;  // of what bears, about the upper pin
            hung += W - B;
            add(K, m, sign * moment / (a * a), -sign * moment / (a * a), sign * moment / (a * a));
            const Quad p = quad(rig.flywheel(i).momentum) / (a * a) * sign;
            add(G, m, p, -p, p);
            const auto body = [&](Quad moves, Quad centroid, Quad gyration) {  // gyration: radius^2 / a^2
                const Quad y0 = centroid / a, y1 = (a - centroid) / a;
                add(M, m, moves * (y0 * y0 + gyration), moves * (y0 * y1 - gyration), moves * (y1 * y1 + gyration));
            };
            body(W, h, quad(link.gyration_ratio));
            body(turning ? -B : Quad(fluid.added_weight), hB, quad(fluid.gyration_ratio));
            const Quad c = -quad(rig.flywheel(i).axial_moment) / (a * a);
            add(M, m, c, -c, c);
        }
        if (!firm) {
            K.d[links] += quad(rig.support().stiffness);
            M.d[links] += Quad(rig.support().carriage_weight);
        }
    }

    std::size_t size = 0;

    /// One of the three as a dense matrix.
    template <class T>
    revchain::Matrix<T> dense(const Band& band) const {
        const Index n = static_cast<Index>(size);
        revchain::Matrix<T> result = revchain::Matrix<T>::Zero(n, n);
        for (Index i = 0; i < n; ++i) {
            const std::size_t s = static_cast<std::size_t>(i);
            result(i, i) = static_cast<T>(band.d[s]);
            if (i + 1 < n) result(i, i + 1) = result(i + 1, i) = static_cast<T>(band.e[s]);
        }
        return result;
    }

    /// visit(pivot) for each pivot of a K + b G - c M.
    template <class Visit>
    void pivots(Quad a, Quad b, Quad c, const Visit& visit) const {
        Quad pivot = 1;
        const auto at = [&](const std::vector<Quad> Band::*part, std::size_t m) {
            return a * (K.*part)[m] + b * (G.*part)[m] - c * (M.*part)[m];
        };
        for (std::size_t m = 0; m < size; ++m) {
            const Quad off = m == 0 ? Quad(0) : at(&Band::e, m - 1);
            pivot = at(&Band::d, m) - (m == 0 ? Quad(0) : off * off / (pivot == 0 ? Quad(1e-300) : pivot));
            visit(pivot);
        }
    }
    /// Negative eigenvalues of a K + b G - c M.
    Index negative(Quad a, Quad b, Quad c) const {
        Index count = 0;
        pivots(a, b, c, [&](Quad pivot) { count += pivot < 0 ? 1 : 0; });
        return count;
    }
    /// det(K + n G - n^2 M/g).
    Quad determinant(Quad n) const {
        Quad product = 1;
        pivots(1, n, n * n / gravity_, [&](Quad pivot) { product *= pivot; });
        return product;
    }
    Index at_speed(Quad n) const { return negative(1, n, n * n / gravity_); }
    Index at_height(Quad lambda) const { return negative(lambda, 0, 1); }

    /// One step of Newton's method on det(a K + b G - c M) from a complex n (with momentum: a = 1, b = n, c = n^2/g) or
    /// height (a = height, c = 1): about its distance from the root, relative, by pivots and their derivatives.
    double newton_step(std::complex<double> x, bool speed) const {
        const auto complex = [](Quad re, Quad im) {
            __complex128 z = 0;
            __real__ z = re, __imag__ z = im;
            return z;
        };
        const __complex128 z = complex(x.real(), x.imag()), one = complex(1, 0), none = complex(0, 0);
        const __complex128 a = speed ? one : z, b = speed ? z : none, c = speed ? z * z / gravity_ : one;
        const __complex128 da = speed ? none : one, db = speed ? one : none, dc = speed ? 2 * z / gravity_ : none;
        __complex128 p = one, dp = none, sum = none;
        for (std::size_t m = 0; m < size; ++m) {
            __complex128 pivot = a * K.d[m] + b * G.d[m] - c * M.d[m], slope = da * K.d[m] + db * G.d[m] - dc * M.d[m];
            if (m > 0) {
                const __complex128 off = a * K.e[m - 1] + b * G.e[m - 1] - c * M.e[m - 1];
                const __complex128 turn = da * K.e[m - 1] + db * G.e[m - 1] - dc * M.e[m - 1];
                pivot -= off * off / p, slope -= 2 * off * turn / p - off * off * dp / (p * p);
            }
            p = pivot, dp = slope;
            sum += dp / p;
        }
        return static_cast<double>(cabsq(one / sum) / cabsq(z));
    }

    /// Where a count changes near `guess`, to `width`: in ulp of double, how far from it; infinite if it does not change.
    template <class Count>
    static double off_by(Quad guess, const Count& count, double reach = 1e-12) {
        Quad lower = guess * (1 - Quad(reach)), upper = guess * (1 + Quad(reach));
        const Index low = count(lower);
        if (low == count(upper)) return std::numeric_limits<double>::infinity();
        for (int i = 0; i < 60; ++i) {
            const Quad middle = (lower + upper) / 2;
            (count(middle) == low ? lower : upper) = middle;
        }
        return static_cast<double>(fabsq((guess - lower) / lower)) / 0x1p-52;
    }

    /// max |(K + n G - n^2 M/g) y| over max of the sizes of its terms.
    template <class Offsets>
    double residual(Quad n, const Offsets& y) const {
        Quad worst = 0, largest = 0;
        for (std::size_t m = 0; m < size; ++m) {
            Quad sum = 0, terms = 0;
            for (const auto& [factor, band] :
                 {std::pair(Quad(1), &K), std::pair(n, &G), std::pair(-n * n / gravity_, &M)}) {
                const auto one = [&, factor = factor](Quad entry, std::size_t i) {
                    const Quad term = factor * entry * Quad(y[static_cast<Index>(i)]);
                    sum += term, terms += fabsq(term);
                };
                if (m > 0) one(band->e[m - 1], m - 1);
                one(band->d[m], m);
                if (m + 1 < size) one(band->e[m], m + 1);
            }
            worst = fmaxq(worst, fabsq(sum)), largest = fmaxq(largest, terms);
        }
        return static_cast<double>(worst / largest);
    }

   private:
    static void add(Band& band, std::size_t m, Quad lower, Quad cross, Quad upper) {
        band.d[m] += lower, band.e[m] += cross, band.d[m + 1] += upper;
    }
    Quad gravity_;
};

}  // namespace support
