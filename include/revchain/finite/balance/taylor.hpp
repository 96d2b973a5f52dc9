// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <functional>

#include "revchain/finite/balance/sweep.hpp"

namespace revchain::finite {

/// A function of D numbers over a cell of them: what it and its derivatives to the second order stay within, and its
/// value and slopes at the cell's centre.
template <Real T, std::size_t D>
struct Taylor {
    static constexpr std::size_t pairs = D * (D + 1) / 2;
    Interval<T> value, centre_value;
    std::array<Interval<T>, D> slope, centre_slope;
    std::array<Interval<T>, pairs> bend;  ///< by the pairs of numbers (0, 0), ..., (0, D - 1), (1, 1), ...

    /// f and g, part by part.
    template <class Operation>
    static Taylor combined(const Taylor& f, const Taylor& g, const Operation& of) {
        Taylor r;
        r.value = of(f.value, g.value), r.centre_value = of(f.centre_value, g.centre_value);
        for (std::size_t i = 0; i < D; ++i) {
            r.slope[i] = of(f.slope[i], g.slope[i]);
            r.centre_slope[i] = of(f.centre_slope[i], g.centre_slope[i]);
        }
        for (std::size_t k = 0; k < pairs; ++k) r.bend[k] = of(f.bend[k], g.bend[k]);
        return r;
    }
    friend Taylor operator+(const Taylor& f, const Taylor& g) { return combined(f, g, std::plus<Interval<T>>()); }
    friend Taylor operator-(const Taylor& f, const Taylor& g) { return combined(f, g, std::minus<Interval<T>>()); }
    friend Taylor operator-(Taylor f, const Interval<T>& constant) {
        f.value = f.value - constant, f.centre_value = f.centre_value - constant;
        return f;
    }
    friend Taylor operator*(const Interval<T>& k, const Taylor& f) {
        return combined(f, f, [&](const Interval<T>& x, const Interval<T>&) { return k * x; });
    }
    friend Taylor operator/(const Taylor& f, const Interval<T>& k) { return (Interval<T>(T(1)) / k) * f; }
};

/// Calls `each(k, i, j)` for every pair of numbers i <= j, k its place in `Taylor::bend`. Inlined by force: as a call,
/// the proof of a diagram takes 1.15 times as long (GCC 12, -O3).
template <std::size_t D, class Each>
[[gnu::always_inline]] inline void each_pair(const Each& each) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < D; ++i)
        for (std::size_t j = i; j < D; ++j) each(k++, i, j);
}
template <Real T, std::size_t D>
Interval<T> product(const std::array<Interval<T>, D>& x, std::size_t i, std::size_t j) {
    return i == j ? square(x[i]) : x[i] * x[j];
}

/// Ranges of D numbers, their centre, and what the mean value theorem and Taylor's formula about it need of them.
template <Real T, std::size_t D>
class Cell {
   public:
    template <std::convertible_to<Interval<T>>... Ranges>
    explicit Cell(const Ranges&... ranges) : range_{Interval<T>(ranges)...} {
        static_assert(sizeof...(Ranges) == D);
        for (std::size_t i = 0; i < D; ++i) {
            centre_[i] = Interval<T>(range_[i].middle());
            const Interval<T> off = range_[i] - centre_[i];
            const T reach = std::max(T(-off.low), off.high);
            off_[i] = {-reach, reach};
        }
        each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) {
            using revchain::detail::up;
            const T reach = off_[i].high;
            product_[k] = i == j ? Interval<T>(T(0), up(T(up(T(reach * reach)) / T(2)))) : off_[i] * off_[j];
        });
    }
    const Interval<T>& range(std::size_t i) const { return range_[i]; }
    const Interval<T>& centre(std::size_t i) const { return centre_[i]; }
    /// The first number itself.
    Taylor<T, D> first() const {
        Taylor<T, D> x;
        x.value = range_[0], x.centre_value = centre_[0];
        x.slope[0] = x.centre_slope[0] = Interval<T>(T(1));
        return x;
    }
    /// A narrower enclosure of `f`, from Taylor's formula about the centre to first and to second order.
    Taylor<T, D> centred(Taylor<T, D> f) const {
        auto slope = f.centre_slope;
        each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) {
            slope[i] = slope[i] + f.bend[k] * off_[j];
            if (i != j) slope[j] = slope[j] + f.bend[k] * off_[i];
        });
        Interval<T> first = f.centre_value, second = f.centre_value;
        for (std::size_t i = 0; i < D; ++i) {
            f.slope[i] = common(f.slope[i], slope[i]);
            first = first + f.slope[i] * off_[i], second = second + f.centre_slope[i] * off_[i];
        }
        for (std::size_t k = 0; k < f.pairs; ++k) second = second + f.bend[k] * product_[k];
        f.value = common(common(f.value, first), second);
        return f;
    }

   private:
    std::array<Interval<T>, D> range_, centre_, off_;
    std::array<Interval<T>, Taylor<T, D>::pairs> product_;
};

namespace detail {

/// Sine of the inclination whose tangent is t.
template <Real T, std::size_t D>
Taylor<T, D> sine_at(const Taylor<T, D>& t) {
    const Sine<T> over(t.value), centre(t.centre_value);
    const Interval<T> bend = Interval<T>(T(3)) * over.half_bend;
    Taylor<T, D> s;
    s.value = over.value, s.centre_value = centre.value;
    for (std::size_t i = 0; i < D; ++i)
        s.slope[i] = over.slope * t.slope[i], s.centre_slope[i] = centre.slope * t.centre_slope[i];
    each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) {
        s.bend[k] = over.slope * t.bend[k] - bend * product(t.slope, i, j);
    });
    return s;
}

/// Sets the derivatives of the tangent t under the load R from its value and its centre's; false where the load may not
/// grow with it. The last of two numbers is lambda: `pull` is the derivative of the stiffness with it.
template <Real T, std::size_t D>
bool derive(const Interval<T>& stiffness, const Interval<T>& centre_stiffness, const Interval<T>& turning,
            const Interval<T>& pull, const Taylor<T, D>& R, Taylor<T, D>& t) {
    Interval<T> growth = stiffness, centre_growth = centre_stiffness, bend(T(0));
    if (!is_zero(turning)) {
        const Sine<T> over(t.value), centre(t.centre_value);
        growth = growth + turning * over.slope, centre_growth = centre_growth + turning * centre.slope;
        bend = Interval<T>(T(3)) * turning * over.half_bend;
    }
    Taylor<T, D> rest = R;
    if constexpr (D == 2) {
        rest.slope[1] = rest.slope[1] - pull * t.value;
        rest.centre_slope[1] = rest.centre_slope[1] - pull * t.centre_value;
    }
    for (std::size_t i = 0; i < D; ++i)
        t.slope[i] = rest.slope[i] / growth, t.centre_slope[i] = rest.centre_slope[i] / centre_growth;
    if constexpr (D == 2) {
        rest.bend[1] = rest.bend[1] - pull * t.slope[0];
        rest.bend[2] = rest.bend[2] - Interval<T>(T(2)) * pull * t.slope[1];
    }
    each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) {
        if (!is_zero(turning)) rest.bend[k] = rest.bend[k] + bend * product(t.slope, i, j);
        t.bend[k] = rest.bend[k] / growth;
    });
    return !growth.may_vanish();
}

}  // namespace detail

/// The sweep over a cell of the lowest link's tangent (D = 1), or of lambda times that and of lambda (D = 2).
template <Real T, std::size_t D>
struct TaylorSweep {
    const EnclosedLinks<T>& links;
    const Cell<T, D>& cell;
    const Interval<T>&height, &centre_height;

    Taylor<T, D> tighten(const Taylor<T, D>& f) const { return cell.centred(f); }
    bool propagate(std::size_t m, const Taylor<T, D>& R, Taylor<T, D>& t) const {
        const Link<Interval<T>>& link = links[m];
        const Interval<T> stiffness = height * link.pull, turning = turning_of(link),
                          centre_stiffness = D == 1 ? stiffness : centre_height * link.pull;
        if (D == 1 && is_zero(turning)) {
            t = R / stiffness;
            return true;
        }
        t.value = detail::tangent_of(stiffness, turning, R.value);
        t.centre_value = detail::tangent_of(centre_stiffness, turning, R.centre_value);
        detail::derive(stiffness, centre_stiffness, turning, link.pull, R, t);
        return true;
    }
    Taylor<T, D> sine(std::size_t, const Taylor<T, D>& t) const { return detail::sine_at(t); }
    Taylor<T, D> upright(const Taylor<T, D>&) const {
        const Interval<T> weight = D == 1 ? height * links[0].pull : links[0].pull;
        Taylor<T, D> R;
        R.value = weight * cell.range(0), R.centre_value = weight * cell.centre(0);
        R.slope[0] = R.centre_slope[0] = weight;
        return R;
    }
    void pass(std::size_t, const Taylor<T, D>&, const Taylor<T, D>&) const {}
};

/// Offset of the support over a cell of tangents of the lowest link: zero for every steady shape. `height` is lambda.
/// Where the support yields or is carried round, the result is its distance from the place where it is held.
template <Real T, class End = OnAxis>
Taylor<T, 1> support_offset(const EnclosedLinks<T>& links, const Interval<T>& height, const Cell<T, 1>& cell,
                            const End& support = {}) {
    TaylorSweep<T, 1> rules{links, cell, height, height};
    const auto end = sweep_up(links, cell.first(), rules);
    return is_held<End> ? cell.centred(support.miss(end.offset, end.sum)) : end.offset;
}

/// Offset of the support over a cell of x = lambda t, t the tangent of the lowest link, and of heights lambda: zero for
/// every steady shape. NaN where a link may have several inclinations.
template <Real T>
Taylor<T, 2> support_offset(const EnclosedLinks<T>& links, const Cell<T, 2>& cell) {
    const auto over = [](const Interval<T>& x, const Interval<T>& height) {  // x/lambda and its slopes
        const Interval<T> slope = Interval<T>(T(1)) / height, value = x * slope;
        return std::array{value, slope, -(value * slope)};
    };
    Taylor<T, 2> t;
    const auto [value, by_x, by_height] = over(cell.range(0), cell.range(1));
    const auto [centre_value, centre_by_x, centre_by_height] = over(cell.centre(0), cell.centre(1));
    t.value = value, t.slope = {by_x, by_height};
    t.centre_value = centre_value, t.centre_slope = {centre_by_x, centre_by_height};
    t.bend = {Interval<T>(T(0)), -square(by_x), Interval<T>(T(2)) * value * square(by_x)};
    TaylorSweep<T, 2> rules{links, cell, cell.range(1), cell.centre(1)};
    return sweep_up(links, cell.centred(t), rules).offset;
}

}  // namespace revchain::finite
