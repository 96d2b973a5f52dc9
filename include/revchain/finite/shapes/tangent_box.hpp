// SPDX-License-Identifier: MPL-2.0
// Boxes of the tangents of all inclinations, and Krawczyk's test of them.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "revchain/finite/balance/support_end.hpp"
#include "revchain/finite/shapes/monotone_branch.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

template <class T>
using TangentBox = std::vector<Interval<T>>;

template <Real T>
bool within(const TangentBox<T>& x, const TangentBox<T>& y) {
    const auto inside = [](const auto& a, const auto& b) {
        return b.low <= a.low && a.high <= b.high;
    };
    return std::equal(x.begin(), x.end(), y.begin(), inside);
}
template <Real T>
bool strictly_within(const TangentBox<T>& x, const TangentBox<T>& y) {
    const auto inside = [](const auto& a, const auto& b) {
        return b.low < a.low && a.high < b.high;
    };
    return std::equal(x.begin(), x.end(), y.begin(), inside);
}
template <Real T>
bool apart(const TangentBox<T>& x, const TangentBox<T>& y) {
    const auto meet = [](const auto& a, const auto& b) {
        return !(a.high < b.low || b.high < a.low);
    };
    return !std::equal(x.begin(), x.end(), y.begin(), meet);
}
template <Real T>
TangentBox<T> mirror_image(TangentBox<T> x) {
    for (Interval<T>& t : x) t = -t;
    return x;
}
template <Real T>
std::vector<T> middle_of(const TangentBox<T>& x) {
    std::vector<T> result;
    for (const Interval<T>& t : x) result.push_back(t.middle());
    return result;
}

/// Returns the inverse of a matrix of n rows, by elimination, if it is finite. Eigen's LU would add
/// a quarter to the compile time of `steady_shapes`.
template <Real T>
std::optional<std::vector<T>> inverse_of(const std::vector<T>& a, std::size_t n) {
    using std::abs, std::isfinite;
    std::vector<std::vector<T>> rows(
        n, std::vector<T>(2 * n));  // rows of a, followed by those of its inverse
    for (std::size_t i = 0; i < n; ++i) {
        std::copy_n(&a[i * n], n, rows[i].begin());
        rows[i][n + i] = T(1);
    }
    for (std::size_t j = 0; j < n; ++j) {
        std::size_t pivot = j;
        for (std::size_t i = j + 1; i < n; ++i)
            if (abs(rows[i][j]) > abs(rows[pivot][j])) pivot = i;
        std::swap(rows[j], rows[pivot]);
        const T top = rows[j][j];
        if (!(abs(top) > T(0))) return std::nullopt;
        for (std::size_t k = j; k < 2 * n; ++k) rows[j][k] /= top;
        for (std::size_t i = 0; i < n; ++i)
            if (const T share = rows[i][j]; i != j && share != T(0))
                for (std::size_t k = j; k < 2 * n; ++k) rows[i][k] -= share * rows[j][k];
    }
    std::vector<T> inverse;
    for (const std::vector<T>& row : rows)
        for (std::size_t k = n; k < 2 * n; ++k) {
            if (!isfinite(row[k])) return std::nullopt;
            inverse.push_back(row[k]);
        }
    return inverse;
}

/// The balance of a whole chain in the tangents of its links in one posture, with s the sines:
///     F_m = lambda sigma_m t_m - sum_r B_mr s_r = 0,  B_mr = sigma_min(m,r) a_r - (m = r) X_m a_m.
/// It is linear except for the sines. So its derivative over a box is as sharp as theirs, and
/// regular at joints of branches. In a rig, sigma in B is of the moving weights. With W their sum
/// the highest pin is at
///     y = (b + sum_r sigma_r a_r s_r/(lambda E))/(1 - W/(lambda E)),
/// and sigma_m y is subtracted from F_m.
template <Real T, class End = OnAxis>
class WholeBalance {
   public:
    WholeBalance(const EnclosedLinks<T>& links, const Interval<T>& height,
                 std::vector<Posture> posture, const End& support = {})
        : size_(links.size()), posture_(std::move(posture)), matrix_(size_ * size_) {
        std::vector<Interval<T>> moving;  // sigma of the weights that move
        if constexpr (is_support<End>)
            moving = hold(links, support);
        else
            for (const Link<Interval<T>>& link : links) moving.push_back(link.pull);
        for (std::size_t m = 0; m < size_; ++m) {
            stiffness_.push_back(height * links[m].pull);
            for (std::size_t r = 0; r < size_; ++r) {
                Interval<T>& entry = matrix_[m * size_ + r];
                entry = (r == m ? moving[m] - links[m].cross : moving[std::min(m, r)]) *
                        links[r].length;
                if (support.yields()) entry = entry + moving[m] * top_.drawn[r];
                middle_.push_back(entry.middle());
            }
        }
    }
    const std::vector<Posture>& posture() const { return posture_; }
    bool is_symmetric() const { return top_.symmetric; }
    Interval<T> top(const std::vector<Interval<T>>& sines) const {
        Interval<T> y(T(0));
        if constexpr (is_support<End>) {
            y = top_.at_rest;
            for (std::size_t r = 0; r < size_; ++r) y = y + top_.drawn[r] * sines[r];
        }
        return y;
    }

    Interval<T> sine(std::size_t m, const Interval<T>& t) const { return signed_(m, sine_at(t)); }

    /// Encloses all zeros of F in the box (Krawczyk). If the result is strictly within the box,
    /// there is exactly one. Returns none if the derivative has no inverse. Cost N^3. The tests of
    /// two forces (finite/held) and of all pins (verification.hpp) stay separate: one template for
    /// all four took 59 lines more than it saved.
    std::optional<TangentBox<T>> narrowed(const TangentBox<T>& box) const {
        const std::vector<T> centre = middle_of(box);
        const auto inverse = inverse_at(centre);
        if (!inverse) return std::nullopt;
        const TangentBox<T> left = scaled(*inverse, value(centre));
        TangentBox<T> result(size_), slope(size_), off(size_);
        for (std::size_t r = 0; r < size_; ++r) {
            slope[r] = signed_(r, Sine<T>(box[r]).slope);
            off[r] = box[r] - Interval<T>(centre[r]);
        }
        for (std::size_t m = 0; m < size_; ++m) {
            Interval<T> sum = Interval<T>(centre[m]) - left[m];
            for (std::size_t r = 0; r < size_; ++r) {
                Interval<T> product(T(0));  // of the inverse and B
                for (std::size_t q = 0; q < size_; ++q)
                    product =
                        product + Interval<T>((*inverse)[m * size_ + q]) * matrix_[q * size_ + r];
                Interval<T> entry =
                    product * slope[r] - Interval<T>((*inverse)[m * size_ + r]) * stiffness_[r];
                if (m == r) entry = entry + Interval<T>(T(1));
                sum = sum + entry * off[r];
            }
            result[m] = sum;
        }
        return result;
    }

    /// Makes a step of Newton's method in T. Returns the largest change of an inclination; none on
    /// failure.
    std::optional<double> improve(std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return std::nullopt;
        const TangentBox<T> left = scaled(*inverse, value(t));
        double largest = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const T step = left[m].middle();
            const double tangent = as_double(t[m]);
            largest = std::max(largest, std::abs(as_double(step)) / (1 + tangent * tangent));
            t[m] = t[m] - step;
        }
        return largest;
    }

    /// Returns the largest change of an inclination (rad) for relative changes 1 of the terms of F.
    std::optional<double> condition(const std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return std::nullopt;
        std::vector<double> terms(size_);
        double largest = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            terms[m] = std::abs(as_double(stiffness_[m].middle() * t[m]));
            for (std::size_t r = 0; r < size_; ++r)
                terms[m] += std::abs(
                    as_double(middle_[m * size_ + r] * sine(r, Interval<T>(t[r])).middle()));
        }
        for (std::size_t m = 0; m < size_; ++m) {
            double change = 0;
            for (std::size_t r = 0; r < size_; ++r)
                change += std::abs(as_double((*inverse)[m * size_ + r])) * terms[r];
            const double tangent = as_double(t[m]);
            largest = std::max(largest, change / (1 + tangent * tangent));
        }
        return largest;
    }

   private:
    /// Sets the topmost pin of a rig. Returns the sigma of its moving weights.
    std::vector<Interval<T>> hold(const EnclosedLinks<T>& links, const End& support) {
        Interval<T> below(T(0));
        std::vector<Interval<T>> moving;
        for (const Link<Interval<T>>& link : links) {
            moving.push_back(below + link.moment);
            below = moving.back() + link.rest;
        }
        const Interval<T> yields =
            Interval<T>(T(1)) - support.compliance * (below + support.carriage);
        top_.at_rest = support.firm ? support.radius : support.radius / yields;
        top_.symmetric = support.symmetric;
        for (std::size_t r = 0; r < size_; ++r) {
            const Interval<T> drawn = support.compliance / yields * moving[r] * links[r].length;
            top_.drawn.push_back(support.firm ? Interval<T>(T(0)) : drawn);
            top_.load.push_back(moving[r] * top_.at_rest);
        }
        return moving;
    }

    Interval<T> signed_(std::size_t m, const Interval<T>& x) const {
        return posture_[m] == Posture::hangs ? x : -x;
    }

    TangentBox<T> value(const std::vector<T>& t) const {
        TangentBox<T> sines(size_), F(size_);
        for (std::size_t r = 0; r < size_; ++r) sines[r] = sine(r, Interval<T>(t[r]));
        for (std::size_t m = 0; m < size_; ++m) {
            F[m] = stiffness_[m] * Interval<T>(t[m]);
            if constexpr (is_support<End>) F[m] = F[m] - top_.load[m];
            for (std::size_t r = 0; r < size_; ++r) F[m] = F[m] - matrix_[m * size_ + r] * sines[r];
        }
        return F;
    }
    /// Returns the inverse of the derivative in T: double is too coarse near a critical height.
    std::optional<std::vector<T>> inverse_at(const std::vector<T>& t) const {
        std::vector<T> jacobian(size_ * size_);
        for (std::size_t r = 0; r < size_; ++r) {
            const T cosine = cosine_at(t[r]),
                    slope = T(static_cast<int>(posture_[r])) * cosine * cosine * cosine;
            for (std::size_t m = 0; m < size_; ++m)
                jacobian[m * size_ + r] = -(middle_[m * size_ + r] * slope);
            jacobian[r * size_ + r] += stiffness_[r].middle();
        }
        return inverse_of(jacobian, size_);
    }
    TangentBox<T> scaled(const std::vector<T>& a, const TangentBox<T>& x) const {
        TangentBox<T> result(size_, Interval<T>(T(0)));
        for (std::size_t m = 0; m < size_; ++m)
            for (std::size_t r = 0; r < size_; ++r)
                result[m] = result[m] + Interval<T>(a[m * size_ + r]) * x[r];
        return result;
    }

    std::size_t size_;
    std::vector<Posture> posture_;
    TangentBox<T> stiffness_, matrix_;
    std::vector<T> middle_;
    struct {
        Interval<T> at_rest;        // offset of the topmost pin under vertical links
        TangentBox<T> drawn, load;  // offset per unit of each sine; sigma times `at_rest`
        bool symmetric = true;
    } top_;
};

}  // namespace revchain::finite
