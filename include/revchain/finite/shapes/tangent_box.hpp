// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "revchain/finite/balance/support_end.hpp"
#include "revchain/finite/shapes/monotone_branch.hpp"

namespace revchain::finite {

/// Tangents of all links, each within an interval.
template <class T>
using TangentBox = std::vector<Interval<T>>;

template <Real T>
bool within(const TangentBox<T>& x, const TangentBox<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (!(y[m].low <= x[m].low && x[m].high <= y[m].high)) return false;
    return true;
}
template <Real T>
bool strictly_within(const TangentBox<T>& x, const TangentBox<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (!(y[m].low < x[m].low && x[m].high < y[m].high)) return false;
    return true;
}
template <Real T>
bool apart(const TangentBox<T>& x, const TangentBox<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (x[m].high < y[m].low || y[m].high < x[m].low) return true;
    return false;
}
template <Real T>
TangentBox<T> mirrored(TangentBox<T> x) {
    for (Interval<T>& t : x) t = -t;
    return x;
}
template <Real T>
std::vector<T> middle_of(const TangentBox<T>& x) {
    std::vector<T> result;
    for (const Interval<T>& t : x) result.push_back(t.middle());
    return result;
}

namespace detail {

/// The inverse of a matrix of `n` rows, by rows, in double; false if it has none in sight.
inline bool invert(std::vector<double>& a, std::size_t n) {
    std::vector<double> inverse(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) inverse[i * n + i] = 1;
    for (std::size_t j = 0; j < n; ++j) {
        std::size_t pivot = j;
        for (std::size_t i = j + 1; i < n; ++i)
            if (std::abs(a[i * n + j]) > std::abs(a[pivot * n + j])) pivot = i;
        const double top = a[pivot * n + j];
        if (!(std::abs(top) > 0)) return false;
        for (std::size_t r = 0; r < n; ++r) {
            std::swap(a[j * n + r], a[pivot * n + r]), std::swap(inverse[j * n + r], inverse[pivot * n + r]);
            a[j * n + r] /= top, inverse[j * n + r] /= top;
        }
        for (std::size_t i = 0; i < n; ++i) {
            const double share = a[i * n + j];
            if (i == j || share == 0) continue;
            for (std::size_t r = 0; r < n; ++r) {
                a[i * n + r] -= share * a[j * n + r], inverse[i * n + r] -= share * inverse[j * n + r];
            }
        }
    }
    a = std::move(inverse);
    return std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace detail

/// The balance of the whole chain in the tangents of all its links, each in its posture, s the sines:
///     F_m = lambda sigma_m t_m - sum_r B_mr s_r = 0,   B_mr = sigma_min(m,r) a_r, less X a on the diagonal:
/// linear but for the sines, so that its derivative over a box is known as sharply as those of the sines. Here nothing
/// is singular at a joint of two branches.
/// In a rig, sigma in B belongs to the weights that move, the highest pin is at
///     y = (b + sum_r sigma_r a_r s_r/(lambda E))/(1 - W/(lambda E)),
/// where W is all the weight that moves, and F_m is less by sigma_m y.
template <Real T, class End = OnAxis>
class WholeBalance {
   public:
    WholeBalance(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, std::vector<Posture> posture,
                 const End& support = {})
        : size_(links.size()), posture_(std::move(posture)), matrix_(size_ * size_) {
        if constexpr (is_held<End>) {
            add_held(links, height, support);
            return;
        }
        for (std::size_t m = 0; m < size_; ++m) {
            stiffness_.push_back(height * links[m].pull);
            for (std::size_t r = 0; r < size_; ++r) {
                const Link<Interval<T>>& lower = links[std::min(m, r)];
                const Interval<T> pull = r == m ? lower.pull - lower.cross : lower.pull;
                matrix_[m * size_ + r] = pull * links[r].length;
                middle_.push_back(static_cast<double>(matrix_[m * size_ + r].middle()));
            }
        }
    }
    const std::vector<Posture>& posture() const { return posture_; }
    bool is_symmetric() const {
        if constexpr (is_held<End>) return top_.symmetric;
        return true;
    }
    /// Offset of the topmost pin.
    Interval<T> top(const std::vector<Interval<T>>& sines) const {
        Interval<T> y(T(0));
        if constexpr (is_held<End>) {
            y = top_.at_rest;
            for (std::size_t r = 0; r < size_; ++r) y = y + top_.drawn[r] * sines[r];
        }
        return y;
    }

    Interval<T> sine(std::size_t m, const Interval<T>& t) const { return signed_(m, detail::Sine<T>(t).value); }

    /// All zeros of F that the box holds lie in what is returned (Krawczyk); if that lies strictly within the box, the
    /// box holds exactly one. Nothing is returned where the derivative has no inverse. Cost N^3.
    std::optional<TangentBox<T>> narrowed(const TangentBox<T>& box) const {
        const std::vector<T> centre = middle_of(box);
        const auto inverse = inverse_at(centre);
        if (!inverse) return std::nullopt;
        const TangentBox<T> left = scaled(*inverse, value(centre));
        TangentBox<T> result(size_), slope(size_), off(size_);
        for (std::size_t r = 0; r < size_; ++r) {
            slope[r] = signed_(r, detail::Sine<T>(box[r]).slope);
            off[r] = box[r] - Interval<T>(centre[r]);
        }
        for (std::size_t m = 0; m < size_; ++m) {
            Interval<T> sum = Interval<T>(centre[m]) - left[m];
            for (std::size_t r = 0; r < size_; ++r) {
                Interval<T> product(T(0));  // of the inverse and B
                for (std::size_t q = 0; q < size_; ++q)
                    product = product + Interval<T>(T((*inverse)[m * size_ + q])) * matrix_[q * size_ + r];
                Interval<T> entry = product * slope[r] - Interval<T>(T((*inverse)[m * size_ + r])) * stiffness_[r];
                if (m == r) entry = entry + Interval<T>(T(1));
                sum = sum + entry * off[r];
            }
            result[m] = sum;
        }
        return result;
    }

    /// One step of Newton's method in T, with a derivative in double; the largest change of an inclination, if any.
    std::optional<double> improve(std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return std::nullopt;
        const TangentBox<T> left = scaled(*inverse, value(t));
        double largest = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            const T step = left[m].middle();
            const double tangent = static_cast<double>(t[m]);
            largest = std::max(largest, std::abs(static_cast<double>(step)) / (1 + tangent * tangent));
            t[m] = t[m] - step;
        }
        return largest;
    }

    /// Largest change of an inclination, rad, where each F_m changes by the sizes of its terms, times it; if any.
    std::optional<double> condition(const std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return std::nullopt;
        std::vector<double> terms(size_);
        double largest = 0;
        for (std::size_t m = 0; m < size_; ++m) {
            terms[m] = std::abs(static_cast<double>(stiffness_[m].middle() * t[m]));
            for (std::size_t r = 0; r < size_; ++r)
                terms[m] += std::abs(middle_[m * size_ + r] * static_cast<double>(sine(r, Interval<T>(t[r])).middle()));
        }
        for (std::size_t m = 0; m < size_; ++m) {
            double change = 0;
            for (std::size_t r = 0; r < size_; ++r) change += std::abs((*inverse)[m * size_ + r]) * terms[r];
            const double tangent = static_cast<double>(t[m]);
            largest = std::max(largest, change / (1 + tangent * tangent));
        }
        return largest;
    }

   private:
    void add_held(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, const End& support) {
        Interval<T> below(T(0));
        std::vector<Interval<T>> moving;  // sigma
        for (const Link<Interval<T>>& link : links) {
            stiffness_.push_back(height * link.pull);
            moving.push_back(below + link.moment);
            below = moving.back() + link.rest;
        }
        const Interval<T> yields = Interval<T>(T(1)) - support.compliance * (below + support.carriage);
        top_.at_rest = support.firm ? support.radius : support.radius / yields;
        top_.symmetric = support.symmetric;
        for (std::size_t r = 0; r < size_; ++r)
            top_.drawn.push_back(support.firm ? Interval<T>(T(0))
                                              : support.compliance / yields * moving[r] * links[r].length);
        for (std::size_t m = 0; m < size_; ++m) {
            top_.load.push_back(moving[m] * top_.at_rest);
            for (std::size_t r = 0; r < size_; ++r) {
                Interval<T>& entry = matrix_[m * size_ + r];
                entry = (r == m ? moving[m] - links[m].cross : moving[std::min(m, r)]) * links[r].length;
                if (!support.firm) entry = entry + moving[m] * top_.drawn[r];
                middle_.push_back(static_cast<double>(entry.middle()));
            }
        }
    }

    Interval<T> signed_(std::size_t m, const Interval<T>& x) const { return posture_[m] == Posture::hangs ? x : -x; }

    TangentBox<T> value(const std::vector<T>& t) const {
        TangentBox<T> sines(size_), F(size_);
        for (std::size_t r = 0; r < size_; ++r) sines[r] = sine(r, Interval<T>(t[r]));
        for (std::size_t m = 0; m < size_; ++m) {
            F[m] = stiffness_[m] * Interval<T>(t[m]);
            if constexpr (is_held<End>) F[m] = F[m] - top_.load[m];
            for (std::size_t r = 0; r < size_; ++r) F[m] = F[m] - matrix_[m * size_ + r] * sines[r];
        }
        return F;
    }
    std::optional<std::vector<double>> inverse_at(const std::vector<T>& t) const {
        std::vector<double> jacobian(size_ * size_);
        for (std::size_t r = 0; r < size_; ++r) {
            const double tangent = static_cast<double>(t[r]), secant_squared = 1 + tangent * tangent;
            const double slope = static_cast<int>(posture_[r]) / (secant_squared * std::sqrt(secant_squared));
            for (std::size_t m = 0; m < size_; ++m) jacobian[m * size_ + r] = -middle_[m * size_ + r] * slope;
            jacobian[r * size_ + r] += static_cast<double>(stiffness_[r].middle());
        }
        if (!detail::invert(jacobian, size_)) return std::nullopt;
        return jacobian;
    }
    TangentBox<T> scaled(const std::vector<double>& a, const TangentBox<T>& x) const {
        TangentBox<T> result(size_, Interval<T>(T(0)));
        for (std::size_t m = 0; m < size_; ++m)
            for (std::size_t r = 0; r < size_; ++r) result[m] = result[m] + Interval<T>(T(a[m * size_ + r])) * x[r];
        return result;
    }

    std::size_t size_;
    std::vector<Posture> posture_;
    TangentBox<T> stiffness_, matrix_;
    std::vector<double> middle_;
    struct OnTheAxis {};
    struct Top {
        Interval<T> at_rest;        // offset of the topmost pin under vertical links
        TangentBox<T> drawn, load;  // what each sine adds to it; sigma times it at rest
        bool symmetric;
    };
    [[no_unique_address]] std::conditional_t<is_held<End>, Top, OnTheAxis> top_;
};

}  // namespace revchain::finite
