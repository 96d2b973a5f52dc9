// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The balance of a whole chain and one condition beside it, linear in the changes d of the links' sideways reaches
/// a sin delta and the change h of log lambda:
///     T y + h (change of pull along log lambda) = forces left,      sum row d + row_height h = left.
/// T is the tangent stiffness of the elements, lambda sigma sec^3 delta/a + X between pins less the masses on the
/// diagonal. Eliminated from the free end up, element by element, forces in sums from the free end: nothing is
/// assembled, so that the slowest modes of long chains keep their digits. The last pin and log lambda are solved
/// together: T itself may be singular, as it is where a branch folds.
class BorderedChain {
   public:
    explicit BorderedChain(std::size_t size)
        : size_(size), below_(size), pivot_(size), force_(size), along_height_(size), weight_(size) {}

    /// Factors at a shape: element stiffnesses, masses at the lower and upper pin, pull = lambda sigma tan delta, the
    /// condition's row and its share of the height.
    template <class Stiffness, class Link, class Pull, class Row>
    void factor(const Stiffness& stiffness, const std::vector<Link>& links, const Pull& pull, const Row& row,
                double row_height) {
        corner_ = row_height;
        double dynamic = 0, eliminated = 0, share = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double k = stiffness(m), u = dynamic - static_cast<double>(links[m].moment);
            const double p = guarded(u + k, k), inverse = 1 / p, ratio = u * inverse;
            const double h = pull(m) - eliminated, whole = share + row(m);
            below_[m] = u, pivot_[m] = p, along_height_[m] = h, weight_[m] = whole;
            if (m + 1 == size_) break;
            corner_ -= whole * inverse * h;
            share = (share * k - row(m) * u) * inverse;
            eliminated += ratio * h;
            dynamic = k * ratio - static_cast<double>(links[m].rest);
        }
    }

    /// Changes of the reaches, into `reach`, and of log lambda, returned, for forces left at each pin, summed from the
    /// free end, and what is left of the condition.
    template <class Forces>
    double solve(const Forces& summed, double left, std::vector<double>& reach) {
        const std::size_t top = size_ - 1;
        double eliminated = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double g = summed(m) - eliminated;
            force_[m] = g;
            if (m == top) break;
            const double share = g / pivot_[m];
            left -= weight_[m] * share;
            eliminated += below_[m] * share;
        }
        // pivot x + along_height h = force,  weight x + corner h = left
        const double p = pivot_[top], q = along_height_[top], r = weight_[top], g = force_[top];
        double x, h;
        if (std::abs(p) * std::abs(corner_) + std::abs(q) * std::abs(r) == 0) return degenerate(reach);
        if (std::abs(p) >= std::abs(q)) {
            h = (left - r * (g / p)) / (corner_ - r * (q / p));
            x = (g - q * h) / p;
        } else {
            x = (left - corner_ * (g / q)) / (r - corner_ * (p / q));
            h = (g - p * x) / q;
        }
        reach[top] = x;
        for (std::size_t m = top; m-- > 0;) {
            reach[m] = (force_[m] - along_height_[m] * h - below_[m] * x) / pivot_[m];
            x += reach[m];
        }
        return h;
    }

   private:
    static double guarded(double pivot, double stiffness) {
        const double least = 1e-30 * std::abs(stiffness);
        return std::abs(pivot) < least ? least : pivot;
    }
    static double degenerate(std::vector<double>& reach) {
        reach.assign(reach.size(), std::numeric_limits<double>::quiet_NaN());
        return std::numeric_limits<double>::quiet_NaN();
    }

    std::size_t size_;
    std::vector<double> below_, pivot_, force_, along_height_, weight_;
    double corner_ = 0;
};

}  // namespace revchain::finite
