// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Linear solver for the balance of a chain together with one condition. The unknowns are changes d
/// of the links' reaches a sin delta, and h of log lambda:
///     T y + h (change of pull along log lambda) = forces,      sum row d + row_height h = left.
/// T is the tangent stiffness of the elements, lambda sigma sec^3 delta/a + X between pins, less
/// the masses on the diagonal. Elements are eliminated from the free end up with forces summed from
/// there; no matrix is assembled, which keeps the digits of the slowest modes of long chains. The
/// last pin and log lambda are solved together, as T is singular where a branch folds.
class BorderedChain {
   public:
    explicit BorderedChain(std::size_t size)
        : size_(size), below_(size), pivot_(size), force_(size), along_height_(size), weight_(size) {}

    /// Factors at a shape, from element stiffnesses, masses at lower and upper pins, pull = lambda
    /// sigma tan delta, and the condition's row and derivative by log lambda.
    template <class Link>
    void factor(const std::vector<double>& stiffness, const std::vector<Link>& links, const std::vector<double>& pull,
                const std::vector<double>& row, double row_height) {
        corner_ = row_height;
        double dynamic = 0, eliminated = 0, share = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double k = stiffness[m], u = dynamic - as_double(links[m].moment);
            const double p = guarded(u + k, k), inverse = 1 / p, ratio = u * inverse;
            const double h = pull[m] - eliminated, whole = share + row[m];
            below_[m] = u, pivot_[m] = p, along_height_[m] = h, weight_[m] = whole;
            if (m + 1 == size_) break;
            corner_ -= whole * inverse * h;
            share = (share * k - row[m] * u) * inverse;
            eliminated += ratio * h;
            dynamic = k * ratio - as_double(links[m].rest);
        }
    }

    /// Solves for given forces, summed from the free end, and a given residual of the condition.
    /// Fills `reach` with the changes of the reaches and returns the change of log lambda.
    double solve(const std::vector<double>& summed, double left, std::vector<double>& reach) {
        const std::size_t top = size_ - 1;
        double eliminated = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const double g = summed[m] - eliminated;
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
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        reach.assign(reach.size(), unknown);
        return unknown;
    }

    std::size_t size_;
    std::vector<double> below_, pivot_, force_, along_height_, weight_;
    double corner_ = 0;
};

}  // namespace revchain::finite
