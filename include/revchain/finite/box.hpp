// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "revchain/finite/pieces.hpp"

namespace revchain::finite {

/// Tangents of all links, each within an interval.
template <class T>
using Box = std::vector<Interval<T>>;

template <Real T>
bool within(const Box<T>& x, const Box<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (!(y[m].low <= x[m].low && x[m].high <= y[m].high)) return false;
    return true;
}
template <Real T>
bool strictly_within(const Box<T>& x, const Box<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (!(y[m].low < x[m].low && x[m].high < y[m].high)) return false;
    return true;
}
template <Real T>
bool apart(const Box<T>& x, const Box<T>& y) {
    for (std::size_t m = 0; m < x.size(); ++m)
        if (x[m].high < y[m].low || y[m].high < x[m].low) return true;
    return false;
}
template <Real T>
Box<T> mirrored(Box<T> x) {
    for (Interval<T>& t : x) t = -t;
    return x;
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
/// is singular at a joint of two pieces.
template <Real T>
class WholeBalance {
   public:
    WholeBalance(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, std::vector<Posture> posture)
        : size_(links.size()), posture_(std::move(posture)), matrix_(size_ * size_) {
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

    Interval<T> sine(std::size_t m, const Interval<T>& t) const { return signed_(m, detail::Sine<T>(t).value); }

    /// All zeros of F that the box holds lie in what is returned (Krawczyk); if that lies strictly within the box, the box
    /// holds exactly one. Nothing is returned where the derivative has no inverse. Cost N^3.
    std::optional<Box<T>> narrowed(const Box<T>& box) const {
        std::vector<T> centre(size_);
        for (std::size_t m = 0; m < size_; ++m) centre[m] = box[m].middle();
        const auto inverse = inverse_at(centre);
        if (!inverse) return std::nullopt;
        const Box<T> left = scaled(*inverse, value(centre));
        Box<T> result(size_), slope(size_), off(size_);
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

    /// One step of Newton's method in T, with a derivative in double.
    bool improve(std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return false;
        const Box<T> left = scaled(*inverse, value(t));
        for (std::size_t m = 0; m < size_; ++m) t[m] = t[m] - left[m].middle();
        return true;
    }

    /// Largest moment left over, over the sizes of its terms, and largest change of an inclination for a relative change 1
    /// of those terms.
    struct Quality {
        double residual = 0, condition = 0;
    };
    std::optional<Quality> quality(const std::vector<T>& t) const {
        const auto inverse = inverse_at(t);
        if (!inverse) return std::nullopt;
        using std::abs;
        const Box<T> left = value(t);
        std::vector<double> terms(size_);
        Quality result;
        for (std::size_t m = 0; m < size_; ++m) {
            terms[m] = std::abs(static_cast<double>(stiffness_[m].middle() * t[m]));
            for (std::size_t r = 0; r < size_; ++r)
                terms[m] += std::abs(middle_[m * size_ + r] * static_cast<double>(sine(r, Interval<T>(t[r])).middle()));
            const double off = static_cast<double>(abs(left[m].middle()));
            if (terms[m] > 0) result.residual = std::max(result.residual, off / terms[m]);
        }
        for (std::size_t m = 0; m < size_; ++m) {
            double change = 0;
            for (std::size_t r = 0; r < size_; ++r) change += std::abs((*inverse)[m * size_ + r]) * terms[r];
            const double tangent = static_cast<double>(t[m]);
            result.condition = std::max(result.condition, change / (1 + tangent * tangent));
        }
        return result;
    }

   private:
    Interval<T> signed_(std::size_t m, const Interval<T>& x) const { return posture_[m] == Posture::hangs ? x : -x; }

    Box<T> value(const std::vector<T>& t) const {
        Box<T> sines(size_), F(size_);
        for (std::size_t r = 0; r < size_; ++r) sines[r] = sine(r, Interval<T>(t[r]));
        for (std::size_t m = 0; m < size_; ++m) {
            F[m] = stiffness_[m] * Interval<T>(t[m]);
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
    Box<T> scaled(const std::vector<double>& a, const Box<T>& x) const {
        Box<T> result(size_, Interval<T>(T(0)));
        for (std::size_t m = 0; m < size_; ++m)
            for (std::size_t r = 0; r < size_; ++r) result[m] = result[m] + Interval<T>(T(a[m * size_ + r])) * x[r];
        return result;
    }

    std::size_t size_;
    std::vector<Posture> posture_;
    Box<T> stiffness_, matrix_;
    std::vector<double> middle_;
};

/// Zeros of the balance in one posture, each in a box that holds no other; mirror images are one.
template <Real T>
class Zeros {
   public:
    struct Zero {
        Box<T> near;  ///< holds it, narrow
        bool straight = false;
    };

    explicit Zeros(const WholeBalance<T>& balance) : balance_(balance) { add_straight(balance.posture().size()); }
    /// Those of the same balance found in fewer digits.
    template <class Fewer>
    Zeros(const WholeBalance<T>& balance, const Zeros<Fewer>& known) : balance_(balance) {
        const auto same = [](const Box<Fewer>& x) {
            Box<T> result;
            for (const Interval<Fewer>& t : x) result.push_back({T(t.low), T(t.high)});
            return result;
        };
        for (const auto& zero : known.found_) found_.push_back({same(zero.near), zero.straight});
        for (const auto& zone : known.zones_) zones_.push_back({same(zone.box), zone.zero});
    }

    const std::vector<Zero>& found() const { return found_; }

    /// Whether all zeros in the box are known now: there is none, or one, which is in the list.
    bool settles(Box<T> box) {
        for (int round = 0; round < 4; ++round) {
            if (is_known(box)) return true;
            const auto narrow = balance_.narrowed(box);
            if (!narrow) return false;
            if (apart(*narrow, box)) return true;
            bool less = false;
            for (std::size_t m = 0; m < box.size(); ++m) {
                const Interval<T> now = common((*narrow)[m], box[m]);
                if (!(now.low <= now.high)) return false;  // nothing is known of it
                less = less || now.width() < T(0.75) * box[m].width();
                box[m] = now;
            }
            if (!less) break;
        }
        // A zero on the edge of the box, or of a box narrowed to rounding, needs room about it.
        Box<T> wider = box;
        for (int round = 0; round < 3; ++round) {
            using std::abs;
            for (Interval<T>& t : wider) {
                const T off = t.width() / T(2) + T(64) * epsilon<T>() * std::max(abs(t.low), abs(t.high)) +
                              std::numeric_limits<T>::min();
                t = {t.low - off, t.high + off};
            }
            const auto narrow = balance_.narrowed(wider);
            if (!narrow) return false;
            if (strictly_within(*narrow, wider)) return add(wider, *narrow);
            for (std::size_t m = 0; m < box.size(); ++m) {
                if (!((*narrow)[m].width() < T(4) * wider[m].width())) return false;
                wider[m] = hull(wider[m], (*narrow)[m]);
            }
        }
        return false;
    }

   private:
    template <Real>
    friend class Zeros;
    struct Zone {
        Box<T> box;
        std::size_t zero;
    };

    bool is_known(const Box<T>& box) const {
        return std::any_of(zones_.begin(), zones_.end(), [&](const Zone& zone) { return within(box, zone.box); });
    }

    /// Puts the one zero of the box, `narrow` in it, on the list; false if it cannot be told from those there.
    bool add(const Box<T>& box, Box<T> near) {
        for (int round = 0; round < 20; ++round) {
            const auto again = balance_.narrowed(near);
            if (!again) break;
            T before(0), now(0);
            for (std::size_t m = 0; m < box.size(); ++m) {
                before = before + near[m].width();
                near[m] = common(near[m], (*again)[m]);
                now = now + near[m].width();
            }
            if (!(now < T(0.5) * before)) break;
        }
        const Box<T> other = mirrored(near);
        for (const Zone& zone : zones_) {
            if (!within(near, zone.box) && !within(other, zone.box)) continue;
            zones_.push_back({box, zone.zero});
            return true;
        }
        for (std::size_t i = 0; i < found_.size(); ++i) {
            if (within(found_[i].near, box) || within(found_[i].near, mirrored(box))) {
                zones_.push_back({box, i});
                return true;
            }
            if (!apart(near, found_[i].near) || !apart(other, found_[i].near)) return false;
        }
        found_.push_back({near, false});
        zones_.push_back({box, found_.size() - 1});
        return true;
    }

    void add_straight(std::size_t size) {
        for (T reach(0.5); reach > T(1e-12); reach = reach / T(4)) {
            const Box<T> box(size, Interval<T>(-reach, reach));
            const auto narrow = balance_.narrowed(box);
            if (!narrow || !strictly_within(*narrow, box)) continue;
            found_.push_back({Box<T>(size, Interval<T>(T(0))), true});
            zones_.push_back({box, 0});
            return;
        }
    }

    const WholeBalance<T>& balance_;
    std::vector<Zero> found_;
    std::vector<Zone> zones_;
};

}  // namespace revchain::finite
