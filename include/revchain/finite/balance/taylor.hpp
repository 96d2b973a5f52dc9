// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/finite/balance/sweep.hpp"
#include "revchain/simd/interval_lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packs never leave a translation unit

namespace revchain::inline REVCHAIN_BUILD::finite {

/// First and second derivatives of a function of D numbers, enclosed over a cell, and slopes at the
/// cell's centre. T is a number or a pack with one cell in each lane.
template <class T, std::size_t D>
struct CellDerivatives {
    static constexpr std::size_t pairs = D * (D + 1) / 2;
    std::array<Interval<T>, D> slope, centre_slope;
    std::array<Interval<T>, pairs> bend;  ///< for pairs (0, 0), ..., (0, D - 1), (1, 1), ...

    template <class Operation>
    [[gnu::always_inline]] void combine(const CellDerivatives& f, const CellDerivatives& g,
                                        const Operation& of) {
        for (std::size_t n = 0; n < 2 * D + pairs; ++n) part(*this, n) = of(part(f, n), part(g, n));
    }

   private:
    template <class Any>  // part n; one loop compiles in 2/3 of the time of three loops
    [[gnu::always_inline]] static auto& part(Any& f, std::size_t n) {
        return n < D ? f.slope[n] : n < 2 * D ? f.centre_slope[n - D] : f.bend[n - 2 * D];
    }
};

/// A function with its derivatives: its enclosure over the cell and its value at the centre.
template <class T, std::size_t D>
struct Taylor : CellDerivatives<T, D> {
    using I = Interval<T>;
    I value, centre_value;

    template <class Operation>
    [[gnu::always_inline]] static Taylor combined(const Taylor& f, const Taylor& g,
                                                  const Operation& of) {
        Taylor r;
        r.value = of(f.value, g.value), r.centre_value = of(f.centre_value, g.centre_value);
        r.combine(f, g, of);
        return r;
    }
    [[gnu::always_inline]] friend Taylor operator+(const Taylor& f, const Taylor& g) {
        return combined(f, g, [](const I& x, const I& y) REVCHAIN_INLINED { return x + y; });
    }
    [[gnu::always_inline]] friend Taylor operator-(const Taylor& f, const Taylor& g) {
        return combined(f, g, [](const I& x, const I& y) REVCHAIN_INLINED { return x - y; });
    }
    [[gnu::always_inline]] friend Taylor operator-(const Taylor& f, const I& constant) {
        Taylor r = f;  // a parameter by value of this alignment makes GCC print a note
        r.value = f.value - constant, r.centre_value = f.centre_value - constant;
        return r;
    }
    [[gnu::always_inline]] friend Taylor operator*(const I& k, const Taylor& f) {
        return combined(f, f, [&](const I& x, const I&) REVCHAIN_INLINED { return k * x; });
    }
    [[gnu::always_inline]] friend Taylor operator/(const Taylor& f, const I& k) {
        return (I(T(1)) / k) * f;
    }
};

/// Calls `each(k, i, j)` for all i <= j, with k the index in `Taylor::bend`. Without forced
/// inlining a diagram's proof takes 1.15 times as long (GCC 12, -O3).
template <std::size_t D, class Each>
[[gnu::always_inline]] inline void each_pair(const Each& each) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < D; ++i)
        for (std::size_t j = i; j < D; ++j) each(k++, i, j);
}
template <class I, std::size_t D>
[[gnu::always_inline]] inline I product(const std::array<I, D>& x, std::size_t i, std::size_t j) {
    return i == j ? square(x[i]) : x[i] * x[j];
}

/// Ranges of D numbers and their centre, for the mean value theorem and Taylor's formula.
template <class T, std::size_t D>
class Cell {
   public:
    template <std::convertible_to<Interval<T>>... Ranges>
    [[gnu::always_inline]] explicit Cell(const Ranges&... ranges) : range_{Interval<T>(ranges)...} {
        static_assert(sizeof...(Ranges) == D);
        for (std::size_t i = 0; i < D; ++i) {
            centre_[i] = Interval<T>(range_[i].middle());
            const Interval<T> off = range_[i] - centre_[i];
            using std::max;
            const T reach = max(T(-off.low), off.high);
            off_[i] = {-reach, reach};
        }
        each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) REVCHAIN_INLINED {
            using detail::up;
            const T reach = off_[i].high;
            const Interval<T> half_square(T(0), up(T(up(T(reach * reach)) / T(2))));
            product_[k] = i == j ? half_square : off_[i] * off_[j];
        });
    }
    const Interval<T>& range(std::size_t i) const { return range_[i]; }
    const Interval<T>& centre(std::size_t i) const { return centre_[i]; }
    [[gnu::always_inline]] Taylor<T, D> first() const {
        Taylor<T, D> x;
        x.value = range_[0], x.centre_value = centre_[0];
        x.slope[0] = x.centre_slope[0] = Interval<T>(T(1));
        return x;
    }
    /// Returns `given`, narrowed by Taylor's formula of first and second order about the centre.
    [[gnu::always_inline]] Taylor<T, D> centred(const Taylor<T, D>& given) const {
        Taylor<T, D> f = given;
        auto slope = f.centre_slope;
        each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) REVCHAIN_INLINED {
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

template <class T, std::size_t D>
[[gnu::always_inline]] inline Taylor<T, D> sine_at(const Taylor<T, D>& t) {
    const Sine<T> over(t.value), centre(t.centre_value);
    const Interval<T> bend = Interval<T>(T(3)) * over.half_bend;
    Taylor<T, D> s;
    s.value = over.value, s.centre_value = centre.value;
    for (std::size_t i = 0; i < D; ++i)
        s.slope[i] = over.slope * t.slope[i], s.centre_slope[i] = centre.slope * t.centre_slope[i];
    each_pair<D>([&](std::size_t k, std::size_t i, std::size_t j) REVCHAIN_INLINED {
        s.bend[k] = over.slope * t.bend[k] - bend * product(t.slope, i, j);
    });
    return s;
}

/// Sets the derivatives of the tangent t under the load R, from the enclosure of t and its value at
/// the centre. Returns false if the load may not increase with t.
template <Real T>
bool derive(const Interval<T>& stiffness, const Interval<T>& turning, const Taylor<T, 1>& R,
            Taylor<T, 1>& t) {
    Interval<T> growth = stiffness, centre_growth = stiffness, bend(T(0));
    if (!is_zero(turning)) {
        const Sine<T> over(t.value), centre(t.centre_value);
        growth = growth + turning * over.slope,
        centre_growth = centre_growth + turning * centre.slope;
        bend = Interval<T>(T(3)) * turning * over.half_bend;
    }
    t.slope[0] = R.slope[0] / growth, t.centre_slope[0] = R.centre_slope[0] / centre_growth;
    t.bend[0] = (is_zero(turning) ? R.bend[0] : R.bend[0] + bend * square(t.slope[0])) / growth;
    return !growth.may_vanish();
}

/// Kept momentum of each flywheel over its link's length, and n sqrt(lambda), with n the speed.
template <class S>
struct KeptMomentum {
    std::vector<S> spin;
    S pace;
};

/// The upward sweep over a cell of the tangent t of the lowest link (D = 1), or of x = lambda t and
/// lambda (D = 2). Each link but the lowest has one inclination under its load. With `spins` (and D
/// = 2) the pull of link m is pull + n spin[m]. Plain intervals would grow at each link. So the
/// offset y and the sum H are relative to the cell's centre, in a frame: (y, H) - (y, H at the
/// centre) = u p + v q. Here p and q solve the sweep with s = k R, k near the link's ds/dR at the
/// centre. The sweep conserves areas, so p_y q_H - q_y p_H = 1. From one link to the next, exactly,
///     u -= a R_q N,   v += a R_p N,   N = s - s at the centre - k (R - R at the centre),
/// with R_p and R_q the loads of p and q. N is small where links respond almost as at the centre.
/// For frames see R. J. Lohner, "Computation of guaranteed enclosures for the solutions of ordinary
/// initial and boundary value problems", in: Computational Ordinary Differential Equations (1992).
/// Plain intervals of slopes are computed too: they are narrower if links turn far within the cell.
template <class T, std::size_t D, bool spins = false>
class CellSweep {
    using I = Interval<T>;

   public:
    /// Sweeps from the tangent `t` of the lowest link. `height` is lambda over the cell.
    [[gnu::always_inline]] CellSweep(const EnclosedLinks<Lane<T>>& links, const Cell<T, D>& cell,
                                     const I& height, const I& centre_height, const Taylor<T, D>& t,
                                     const KeptMomentum<Interval<Lane<T>>>* kept = nullptr)
        : cell_(cell), height_(height), centre_height_(centre_height), kept_(kept) {
        if constexpr (spins) {
            const I pace = spread(kept->pace);
            speed_ = pace / sqrt(height), centre_speed_ = pace / sqrt(centre_height);
        }
        start(spread(links[0]), is_zero(links[0].cross), is_zero(links[0].rest), t);
        for (std::size_t m = 1; m < links.size(); ++m)
            pass(m, spread(links[m]), is_zero(links[m].cross));
    }
    [[gnu::always_inline]] Taylor<T, D> offset() const {
        return narrowed(framed(p_.offset, q_.offset, offset_, centre_offset_), offset_slope_);
    }
    [[gnu::always_inline]] Taylor<T, D> sum() const {
        return narrowed(framed(p_.sum, q_.sum, sum_, centre_sum_), sum_slope_);
    }

   private:
    struct Side {
        I offset, sum;
    };

    /// Returns a copy in each lane.
    [[gnu::always_inline]] static I spread(const Interval<Lane<T>>& x) {
        return {T(x.low), T(x.high)};
    }
    [[gnu::always_inline]] static Link<I> spread(const Link<Interval<Lane<T>>>& l) {
        return {spread(l.length), spread(l.pull), spread(l.cross), spread(l.moment),
                spread(l.rest)};
    }
    /// The pull, `whole`; 1st and 2nd derivative by lambda of lambda times it: `growing`, `bend`.
    struct Pull {
        I whole, centre_whole, growing, centre_growing, bend;
    };
    [[gnu::always_inline]] Pull pull_of(std::size_t m, const I& tension) const {
        if constexpr (spins) {
            const I spin = spread(kept_->spin[m]), half(T(0.5)), kept = speed_ * spin,
                    centre_kept = centre_speed_ * spin;
            return {tension + kept, tension + centre_kept, tension + half * kept,
                    tension + half * centre_kept, I(T(-0.25)) * kept / height_};
        } else {
            return {tension, tension, tension, tension, I(T(0))};
        }
    }

    [[gnu::always_inline]] void start(const Link<I>& link, bool is_plummet, bool ends_in_mass,
                                      const Taylor<T, D>& t) {
        const auto s = cell_.centred(sine_at(t));
        const Pull pull = pull_of(0, link.pull);
        const I weight = D == 1 ? height_ * link.pull : pull.whole;
        Taylor<T, D> R;
        R.value = weight * cell_.range(0), R.centre_value = weight * cell_.centre(0);
        R.slope[0] = R.centre_slope[0] = weight;
        if constexpr (spins) {  // pull(lambda) x
            const I fall = I(T(2)) * pull.bend,
                    centre_fall = (pull.centre_growing - pull.centre_whole) / centre_height_;
            R.centre_value = pull.centre_whole * cell_.centre(0),
            R.centre_slope[0] = pull.centre_whole;
            R.slope[1] = fall * cell_.range(0), R.centre_slope[1] = centre_fall * cell_.centre(0);
            R.bend[1] = fall, R.bend[2] = I(T(-1.5)) * fall / height_ * cell_.range(0);
            R = cell_.centred(R);
        }
        if (!is_plummet) R = R + link.length * link.cross * s;
        const auto y = cell_.centred(R / link.moment) - link.length * s;
        const auto H = ends_in_mass ? R : R + link.rest * y;
        offset_ = y.value, centre_offset_ = y.centre_value, u_ = y;
        sum_ = H.value, centre_sum_ = H.centre_value, v_ = H;
        offset_slope_ = y.slope, sum_slope_ = H.slope;
    }

    [[gnu::always_inline]] void pass(std::size_t m, const Link<I>& link, bool is_plummet) {
        const I R_p = p_.sum + link.moment * p_.offset, R_q = q_.sum + link.moment * q_.offset;
        std::array<I, D> R_slope;
        for (std::size_t i = 0; i < D; ++i)
            R_slope[i] = sum_slope_[i] + link.moment * offset_slope_[i];
        const auto R = narrowed(framed(R_p, R_q, sum_ + link.moment * offset_,
                                       centre_sum_ + link.moment * centre_offset_),
                                R_slope);
        const Pull pull = pull_of(m, link.pull);
        const std::array<I, 2> heights{height_, centre_height_}, loads{R.value, R.centre_value},
            pulls{pull.whole, pull.centre_whole};
        std::array<I, 2> tangent, sine, growth, along;
        I bend;
        for (std::size_t which = 2; which-- > 0;) {
            const I stiffness = heights[which] * pulls[which], turning = link.length * link.cross;
            tangent[which] = is_plummet ? loads[which] / stiffness
                                        : tangent_of(stiffness, turning, loads[which]);
            const Sine<T> s(tangent[which]);
            sine[which] = s.value;
            growth[which] = is_plummet ? stiffness : stiffness + turning * s.slope;
            along[which] = s.slope / growth[which];
            if (which > 0) continue;
            bend = I(T(-3)) * s.half_bend * (is_plummet ? I(T(1)) : stiffness / growth[which]);
        }
        const I &t = tangent[0], &centre_t = tangent[1], k(along[1].middle());
        // `load`: derivatives of R less those of lambda pull t by lambda at a fixed t; then
        //     s_i = along load_i,   s_ij = along load_ij + bend t_i t_j
        CellDerivatives<T, D> load = R, N;
        if constexpr (D == 2) {
            load.slope[1] = load.slope[1] - pull.growing * t;
            load.centre_slope[1] = load.centre_slope[1] - pull.centre_growing * centre_t;
        }
        std::array<I, D> slope;
        for (std::size_t i = 0; i < D; ++i) slope[i] = load.slope[i] / growth[0];
        if constexpr (D == 2) {
            load.bend[1] = load.bend[1] - pull.growing * slope[0];
            load.bend[2] = load.bend[2] - I(T(2)) * pull.growing * slope[1];
            if constexpr (spins) load.bend[2] = load.bend[2] - pull.bend * t;
        }
        const I beyond = along[0] - k, centre_beyond = along[1] - k;
        for (std::size_t i = 0; i < D; ++i)
            N.slope[i] = beyond * load.slope[i],
            N.centre_slope[i] = centre_beyond * load.centre_slope[i];
        each_pair<D>([&](std::size_t n, std::size_t i, std::size_t j) REVCHAIN_INLINED {
            N.bend[n] = beyond * load.bend[n] + bend * product(slope, i, j);
        });
        if constexpr (D == 2) {
            N.slope[1] = N.slope[1] - k * (pull.growing * t);
            N.centre_slope[1] = N.centre_slope[1] - k * (pull.centre_growing * centre_t);
            N.bend[1] = N.bend[1] - k * (pull.growing * slope[0]);
            N.bend[2] = N.bend[2] - k * (I(T(2)) * pull.growing * slope[1]);
            if constexpr (spins) N.bend[2] = N.bend[2] - k * (pull.bend * t);
        }
        const I a_p = link.length * R_p, a_q = link.length * R_q;
        u_.combine(u_, N, [&](const I& x, const I& n) REVCHAIN_INLINED { return x - a_q * n; });
        v_.combine(v_, N, [&](const I& x, const I& n) REVCHAIN_INLINED { return x + a_p * n; });
        p_.offset = p_.offset - k * a_p, q_.offset = q_.offset - k * a_q;
        p_.sum = R_p + link.rest * p_.offset, q_.sum = R_q + link.rest * q_.offset;
        spread_frame(T(2) * link.moment.middle());
        offset_ = offset_ - link.length * sine[0], sum_ = R.value + link.rest * offset_;
        centre_offset_ = centre_offset_ - link.length * sine[1];
        centre_sum_ = R.centre_value + link.rest * centre_offset_;
        for (std::size_t i = 0; i < D; ++i) {
            offset_slope_[i] = offset_slope_[i] - link.length * (along[0] * load.slope[i]);
            sum_slope_[i] = R.slope[i] + link.rest * offset_slope_[i];
        }
    }

    /// If p and q are almost parallel, makes q orthogonal to p. `weight` scales offsets.
    [[gnu::always_inline]] void spread_frame(const T& weight) {
        const T a = weight * p_.offset.middle(), b = p_.sum.middle();
        const T c = weight * q_.offset.middle(), d = q_.sum.middle();
        const T share = (a * c + b * d) / (a * a + b * b);
        const T near = share * (a * c + b * d), far = T(0.9) * (c * c + d * d);
        if (!any(far < near)) return;
        const I of_p(if_less(far, near, share, T(0)));
        q_.offset = q_.offset - of_p * p_.offset, q_.sum = q_.sum - of_p * p_.sum;
        u_.combine(u_, v_, [&](const I& x, const I& y) REVCHAIN_INLINED { return x + of_p * y; });
    }

    [[gnu::always_inline]] Taylor<T, D> framed(const I& p, const I& q, const I& value,
                                               const I& centre_value) const {
        Taylor<T, D> f;
        f.value = value, f.centre_value = centre_value;
        f.combine(u_, v_, [&](const I& x, const I& y) REVCHAIN_INLINED { return p * x + q * y; });
        return f;
    }

    [[gnu::always_inline]] Taylor<T, D> narrowed(const Taylor<T, D>& given,
                                                 const std::array<I, D>& slope) const {
        Taylor<T, D> f = given;
        for (std::size_t i = 0; i < D; ++i) f.slope[i] = common(f.slope[i], slope[i]);
        return cell_.centred(f);
    }

    const Cell<T, D>& cell_;
    const I &height_, &centre_height_;
    const KeptMomentum<Interval<Lane<T>>>* kept_;
    I speed_, centre_speed_;  // n
    Side p_{I(T(1)), I(T(0))}, q_{I(T(0)), I(T(1))};
    CellDerivatives<T, D> u_, v_;
    I offset_, centre_offset_, sum_, centre_sum_;  // at the pin, over the cell and at its centre
    std::array<I, D> offset_slope_, sum_slope_;
};

/// Encloses the support's distance from the topmost pin over a cell; it is 0 for steady shapes.
template <Real T, class End = OnAxis>
Taylor<T, 1> support_offset(const EnclosedLinks<T>& links, const Interval<T>& height,
                            const Cell<T, 1>& cell, const End& support = {}) {
    const CellSweep<T, 1> sweep(links, cell, height, height, cell.first());
    if constexpr (is_support<End>) return cell.centred(support.miss(sweep.offset(), sweep.sum()));
    return sweep.offset();
}

/// Returns the sweep over a cell with D = 2; NaN if a link may have several inclinations.
template <class T, bool spins = false>
[[gnu::always_inline]] inline CellSweep<T, 2, spins> swept_cell(
    const EnclosedLinks<Lane<T>>& links, const Cell<T, 2>& cell,
    const KeptMomentum<Interval<Lane<T>>>* kept = nullptr) {
    const auto over = [](const Interval<T>& x, const Interval<T>& height) REVCHAIN_INLINED {
        const Interval<T> slope = Interval<T>(T(1)) / height, value = x * slope;
        return std::array{value, slope, -(value * slope)};  // x/lambda and its slopes
    };
    Taylor<T, 2> t;
    const auto [value, by_x, by_height] = over(cell.range(0), cell.range(1));
    const auto [centre_value, centre_by_x, centre_by_height] = over(cell.centre(0), cell.centre(1));
    t.value = value, t.slope = {by_x, by_height};
    t.centre_value = centre_value, t.centre_slope = {centre_by_x, centre_by_height};
    t.bend = {Interval<T>(T(0)), -square(by_x), Interval<T>(T(2)) * value * square(by_x)};
    return CellSweep<T, 2, spins>(links, cell, cell.range(1), cell.centre(1), cell.centred(t),
                                  kept);
}
template <class T>
[[gnu::always_inline]] inline Taylor<T, 2> support_offset(const EnclosedLinks<Lane<T>>& links,
                                                          const Cell<T, 2>& cell) {
    return swept_cell<T>(links, cell).offset();
}

}  // namespace revchain::finite

#pragma GCC diagnostic pop
