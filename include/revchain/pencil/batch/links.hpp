// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/batch/block.hpp"

/// The equations of small amplitude, link by link from the free end to the support, for many chains
/// at once, one in each lane: `PlummetLanes` for point masses, `RigidLanes` for bodies. The unknown
/// `x` is mu = 1/lambda; the zeros of the support's offset as a polynomial in it are the modes.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Plummets. F is the force above each pin and y the pin's offset, for a free end at offset 1. With
/// mu = 1/lambda they follow from
///
///     F <- F - mu W y,      y <- y + F / k,      k = (weight hung on the thread above) / a.
///
/// y at the support is a polynomial in mu whose zeros are the modes; other sums have one sign.
template <class V>
class PlummetLanes : public detail::LaneNumbers<V, 3> {
    using Numbers = detail::LaneNumbers<V, 3>;
    using Numbers::get, Numbers::put, Numbers::units;

   public:
    using Numbers::size, Numbers::max_polynomial;

    [[gnu::always_inline]] PlummetLanes(const LaneBlock& block, std::ptrdiff_t lane, double* work)
        : Numbers(block, lane, work) {
        CompensatedSum<V> hung;
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const V weight = V::load(block.weight + m * block_lanes + lane) * units().per_weight;
            const V length = V::load(block.length + m * block_lanes + lane) * units().per_length;
            hung.add(weight);
            put(m, 0, weight);
            put(m, 1, hung.value() / length);
            put(m, 2, length / hung.value());
        }
    }

    /// Writes the size() + 1 coefficients of y at the support, lowest first. Cost N^2.
    [[gnu::always_inline]] void polynomial(V* y) const {
        V f[max_polynomial];  // F / (-mu)
        y[0] = V(1.0);
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const V weight = get(m, 0), flexibility = get(m, 2);
            for (std::ptrdiff_t j = 0; j < m; ++j) f[j] = f[j] + weight * y[j];
            f[m] = weight * y[m];
            for (std::ptrdiff_t j = 1; j <= m; ++j) y[j] = y[j] + flexibility * f[j - 1];
            y[m + 1] = flexibility * f[m];
        }
        for (std::ptrdiff_t j = 1; j <= size(); j += 2) y[j] = -y[j];
    }

    /// Carries y and F with derivatives up one link. One template for numbers and for truncated
    /// power series took 1.1 to 1.25 times as long, because the terms in x then wait for y.
    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneTaylor<V>& y,
                                     LaneTaylor<V>& f) const {
        const V weight = get(m, 0), flexibility = get(m, 2);
        f.curvature = f.curvature - weight * (x * y.curvature + y.slope);
        f.slope = f.slope - weight * (x * y.slope + y.value);
        f.value = f.value - x * (weight * y.value);
        y.curvature = y.curvature + flexibility * f.curvature;
        y.slope = y.slope + flexibility * f.slope;
        y.value = y.value + flexibility * f.value;
    }

    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, V& y, V& f) const {
        f = f - (x * get(m, 0)) * y;
        y = y + get(m, 2) * f;
    }

    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        const V push = get(m, 0) * s.offset;
        s.inertia = s.inertia + push * s.offset;
        s.force = s.force - x * push;
        stretch(m, s);
    }

    /// Carries the shape down one link. The force has the opposite sign.
    [[gnu::always_inline]] void descend(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        stretch(m, s);
        const V push = get(m, 0) * s.offset;
        s.inertia = s.inertia + push * s.offset;
        s.force = s.force - x * push;
    }

    /// These return a link's mass at its lower pin, its stiffness, and its mass at its upper pin.
    [[gnu::always_inline]] V lower_mass(std::ptrdiff_t m) const { return get(m, 0); }
    [[gnu::always_inline]] V stiffness(std::ptrdiff_t m) const { return get(m, 1); }
    [[gnu::always_inline]] V upper_mass(std::ptrdiff_t) const { return V(0.0); }

   private:
    [[gnu::always_inline]] void stretch(std::ptrdiff_t m, LaneShape<V>& s) const {
        const V next = s.offset + get(m, 2) * s.force;
        const V stretched = next - s.offset;  // rounded: second-order error of the quotient
        s.stiffness = s.stiffness + (get(m, 1) * stretched) * stretched;
        s.offset = next;
    }
};

/// Rigid links. Let y and y' be the offsets of a link's lower and upper pin, and p = h/a,
/// q = (a - h)/a, r = rho^2/a^2. The link's mass is W (y_G^2 + r d^2), where y_G = p y + q y' is
/// the offset of its centre of gravity and d = y' - y:
///
///     d = (F - mu W p y) / (k + mu X),     F <- F - mu W y_G,     X = W (p q - r).
///
/// Multiplied by (k + mu X)/k for each link, y is a polynomial in mu without divisions. The number
/// of sign changes of y along the chain is that of negative pivots of K - mu M, also if k + mu X <
/// 0.
template <class V>
class RigidLanes : public detail::LaneNumbers<V, 12> {
    using Numbers = detail::LaneNumbers<V, 12>;
    using Numbers::get, Numbers::put, Numbers::units;

   public:
    using Numbers::size, Numbers::max_polynomial;

    [[gnu::always_inline]] RigidLanes(const LaneBlock& block, std::ptrdiff_t lane, double* work)
        : Numbers(block, lane, work) {
        CompensatedSum<V> hung;
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const std::ptrdiff_t at = m * block_lanes + lane;
            const V weight = V::load(block.weight + at) * units().per_weight;
            const V a = V::load(block.length + at) * units().per_length;
            const V h = V::load(block.centroid + at) * units().per_length;
            const V turning = V::load(block.turning + at) * units().per_length;
            const V gyration = block.turning_is_radius ? turning * turning : h * (turning - h);
            const V kappa = weight * h + a * hung.value();
            const V square = a * a;
            const V k = kappa / square, flexibility = square / kappa;
            const V p = h / a, q = (a - h) / a, r = gyration / square;
            hung.add(weight);
            put(m, weight_, weight);
            put(m, weight_a, weight / a);
            put(m, weight_aa, weight / square);
            put(m, p_, h);
            put(m, q_, a - h);
            put(m, turn, weight / square * gyration);
            put(m, stiffness_, k);
            put(m, cross, weight * (p * q - r));
            put(m, flexibility_, flexibility);
            put(m, lower, weight * (p * p + r) * flexibility);
            put(m, upper, weight * (q * q + r) * flexibility);
            put(m, coupling, weight * weight * r * flexibility);
        }
    }

    [[gnu::always_inline]] void polynomial(V* y) const {
        V f[max_polynomial + 1];  // F / (-mu)
        y[0] = V(1.0);
        f[0] = V(0.0);
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const V weight = get(m, weight_), a = get(m, lower), b = get(m, upper),
                    c = get(m, coupling);
            const V flexibility = get(m, flexibility_);
            f[m + 1] = b * f[m] + c * y[m];
            y[m + 1] = a * y[m] + flexibility * f[m];
            for (std::ptrdiff_t j = m; j > 0; --j) {
                f[j] = f[j] + weight * y[j] + (b * f[j - 1] + c * y[j - 1]);
                y[j] = y[j] + (a * y[j - 1] + flexibility * f[j - 1]);
            }
            f[0] = f[0] + weight * y[0];
        }
        for (std::ptrdiff_t j = 1; j <= size(); j += 2) y[j] = -y[j];
    }

    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneTaylor<V>& y,
                                     LaneTaylor<V>& f) const {
        const V a = get(m, lower), b = get(m, upper), c = get(m, coupling),
                flexibility = get(m, flexibility_);
        const V on_y = V(1.0) - x * a, on_f = V(1.0) - x * b;
        const V couple = get(m, weight_) - x * c, push = x * couple, push1 = couple - x * c;
        const LaneTaylor<V> above{on_y * y.value + flexibility * f.value,
                                  on_y * y.slope - a * y.value + flexibility * f.slope,
                                  on_y * y.curvature - a * y.slope + flexibility * f.curvature};
        f.curvature =
            on_f * f.curvature - b * f.slope - (push * y.curvature + push1 * y.slope - c * y.value);
        f.slope = on_f * f.slope - b * f.value - (push * y.slope + push1 * y.value);
        f.value = on_f * f.value - push * y.value;
        y = above;
    }

    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, V& y, V& f) const {
        const V push = x * (get(m, weight_) - x * get(m, coupling));
        const V above = (y - (x * get(m, lower)) * y) + get(m, flexibility_) * f;
        f = (f - (x * get(m, upper)) * f) - push * y;
        y = above;
    }

    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        pass(m, x, get(m, p_), get(m, q_), s);
    }
    [[gnu::always_inline]] void descend(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        pass(m, x, get(m, q_), get(m, p_), s);
    }

    [[gnu::always_inline]] V lower_mass(std::ptrdiff_t m) const {
        return get(m, lower) * get(m, stiffness_);
    }
    [[gnu::always_inline]] V stiffness(std::ptrdiff_t m) const { return get(m, stiffness_); }
    [[gnu::always_inline]] V upper_mass(std::ptrdiff_t m) const {
        return get(m, upper) * get(m, stiffness_);
    }

   private:
    static constexpr std::ptrdiff_t weight_ = 0, weight_a = 1, weight_aa = 2, p_ = 3, q_ = 4,
                                    turn = 5;
    static constexpr std::ptrdiff_t stiffness_ = 6, cross = 7, flexibility_ = 8, lower = 9,
                                    upper = 10;
    static constexpr std::ptrdiff_t coupling = 11;

    /// Carries the shape from a pin at distance `far` from the centroid to a pin at distance
    /// `near`. The centroid's offset y_G satisfies a y_G = near y + far y'.
    [[gnu::always_inline]] void pass(std::ptrdiff_t m, const V& x, const V& near, const V& far,
                                     LaneShape<V>& s) const {
        const V pull = get(m, weight_a) * near, k = get(m, stiffness_);
        const V next = s.offset + (s.force - (x * pull) * s.offset) / (k + x * get(m, cross));
        const V stretched = next - s.offset;  // rounded: second-order error of the quotient
        const V moment = near * s.offset + far * next;
        s.inertia = s.inertia + ((get(m, weight_aa) * moment) * moment +
                                 (get(m, turn) * stretched) * stretched);
        s.stiffness = s.stiffness + (k * stretched) * stretched;
        s.force = s.force - x * (get(m, weight_a) * moment);
        s.offset = next;
    }
};

}  // namespace revchain::pencil
