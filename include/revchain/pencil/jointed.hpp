// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "revchain/pencil/element.hpp"

/// Pencils with springs or dashpots at pins. A torsion spring between two links couples three pins,
/// so one number no longer describes everything below a pin. Two do: the offset y of the pin, and
/// the rotation r of the link below it. Each link's own rotation is eliminated, from the lowest on:
/// its pivot is the link's dynamic stiffness against rotation plus the spring's. See
/// docs/theory/damping.md.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Factors of stiffnesses, spins, dashpots and masses: Q is their sum. Those of a steady motion are
/// x, 0, 0, -1, or with spins x^2, x, 0, -1.
template <class F>
struct JointFactors {
    F stiffness{}, spin{}, damping{}, mass{};
};

/// The entries that the mass or the drag of an element adds to a matrix over its two pins.
template <class F>
struct Carried {
    F lower, cross, upper;
};

/// Returns it; `number` makes an F of a number of the element.
template <class F, Real S, class Number>
Carried<F> carried(const SignedElement<S>& e, const Joint<S>& joint, const JointFactors<F>& x,
                   const Number& number) {
    const F drag = x.damping * number(joint.drag), twice = drag + drag;
    return {x.mass * number(e.lower) + twice, x.mass * number(e.cross) + drag,
            x.mass * number(e.upper) + twice};
}

/// Calls `take(pivot, yr, spring, m)` for each element m, lowest first. `yr` couples the offset of
/// its upper pin to its own rotation, `spring` is the dynamic stiffness of its joint. F has the
/// field operations and a constructor from S.
template <class F, Real S, class Take>
void eliminate(const SignedPencil<S>& pencil, const JointFactors<F>& x, const Take& take) {
    const S zero(Narrow<S>(0));
    const F none(zero);
    F yy = none, yr = none, rr = none;  // the form of everything below
    const std::size_t count = pencil.elements.size();
    for (std::size_t m = 0; m < count; ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const Joint<S>& joint = pencil.joints[m];
        const Carried<F> part = carried(e, joint, x, [](const S& y) { return F(y); });
        const F own = x.stiffness * F(e.stiffness) + x.spin * F(e.spin) + part.lower;
        if (joint.lever == zero) {  // a support: its pin has no rotation
            take(F(yy + own + x.damping * F(joint.damping)), yr, none, m);
            return;
        }
        const F lever(joint.lever), far = lever * yy + yr;
        rr = rr + lever * (yr + far + lever * own);
        yr = far + lever * (part.lower + part.cross);
        yy = yy + ((part.lower + part.cross) + (part.cross + part.upper));
        const F spring = x.stiffness * F(joint.stiffness) + x.damping * F(joint.damping);
        const F pivot = rr + spring;
        take(pivot, yr, spring, m);
        if (m + 1 == count) return;
        const F share = yr / pivot;
        yy = yy - yr * share;
        const bool hangs_from_link = pencil.joints[m + 1].lever != zero;
        yr = hangs_from_link ? F(spring * share) : none;
        rr = hangs_from_link ? F(spring * (rr / pivot)) : none;
    }
}

/// Returns the factors of steady motion at x.
template <class F, Real S>
JointFactors<F> steady_factors(const SignedPencil<S>& pencil, const F& x) {
    const F one(S(Narrow<S>(1))), none(S(Narrow<S>(0)));
    if (pencil.quadratic) return {x * x, x, none, -one};
    return {x, none, none, -one};
}

/// A count. If `proved`, exactly `above` eigenvalues of the exact pencil exceed the exact shift.
struct CertifiedCount {
    Index above = 0;
    bool proved = false;
};

namespace detail {

/// A bound B of the error E of a form in an offset y and a rotation r: -B <= E <= B as quadratic
/// forms. B is carried like the form itself. So errors that cancel there cancel here, too: bounds of
/// single numbers would grow with every link.
template <Real M>
struct FormError {
    M yy{}, yr{}, rr{};

    /// Adds errors of single numbers. An error of yr is shared by y^2 and r^2.
    void add(const M& of_yy, const M& of_yr, const M& of_rr, const M& lever) {
        using std::abs;
        const M slack = M(1) + M(16) * epsilon<M>();
        yy = (yy + of_yy + of_yr / abs(lever)) * slack;
        rr = (rr + of_rr + of_yr * abs(lever)) * slack;
    }
    /// Goes from the offset of a link's lower pin to that of its upper pin.
    void shift(const M& lever) {
        using std::abs;
        const M far = lever * yy, size = abs(lever) * yy + abs(yr);
        const M sizes = rr + abs(lever) * (abs(yr) + size);
        rr = rr + lever * (yr + (yr + far)), yr = yr + far;
        add(M(0), lost * size, lost * sizes, lever);
    }
    /// Puts r = t y + s (rotation of the link above), at which the form is stationary. For another
    /// form within B it is stationary elsewhere: B grows by |pivot| / (|pivot| - B_rr).
    void eliminate(const M& t, const M& s, const M& growth, const M& lever) {
        using std::abs;
        const M size = abs(yr) + abs(t) * rr, sizes = yy + abs(t) * (abs(yr) + size);
        yy = growth * (yy + t * (yr + (yr + t * rr))), yr = growth * s * (yr + t * rr);
        rr = growth * s * s * rr;
        add(lost * growth * sizes, lost * growth * abs(s) * size, lost * rr, lever);
    }

   private:
    static constexpr M lost = 32 * std::numeric_limits<M>::epsilon();
};

}  // namespace detail

/// Returns the number of negative eigenvalues of Q; proved if the sign of every pivot is certain.
/// Cost: 0.5 microseconds a link in double words.
template <Real S>
CertifiedCount certified_count(const SignedPencil<S>& pencil, const JointFactors<S>& x) {
    using std::abs;
    using M = Narrow<S>;
    const S zero(M(0));
    const M u = 4 * operation_error<S>();
    const auto size = [](const S& y) { return abs(static_cast<M>(y)); };
    const JointFactors<M> f{size(x.stiffness), size(x.spin), size(x.damping), size(x.mass)};
    CertifiedCount count{0, true};
    S yy = zero, yr = zero, rr = zero;
    detail::FormError<M> off;
    const auto take = [&](const S& pivot, const M& error) {
        // The comparison is written so that any NaN withdraws the proof.
        count.proved = count.proved && size(pivot) * (M(1) - epsilon<M>()) > error;
        count.above += pivot < zero ? 1 : 0;
    };
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const Joint<S>& joint = pencil.joints[m];
        const M k = f.stiffness * size(e.stiffness), g = f.spin * size(e.spin),
                lower_size = f.mass * size(e.lower), cross_size = f.mass * size(e.cross);
        const M stiffness_error = f.stiffness * e.error.stiffness + f.spin * e.error.spin;
        const M lower_error = f.mass * e.error.lower, cross_error = f.mass * e.error.cross;
        const S own = x.stiffness * e.stiffness + x.spin * e.spin + x.mass * e.lower;
        if (joint.lever == zero) {
            const S held = x.damping * joint.damping;
            const S pivot = yy + own + held;
            const M rounding = M(3) * u * (size(yy) + k + lower_size + size(held));
            take(pivot, off.yy + stiffness_error + lower_error + rounding);
            return count;
        }
        const S& lever = joint.lever;
        const M long_arm = size(lever);
        const M own_size = k + g + lower_size;
        off.shift(static_cast<M>(lever));
        off.add(M(0), u * (long_arm * size(yy) + size(yr)),
                long_arm * (M(2) * u * (M(2) * size(yr) + long_arm * (size(yy) + own_size)) +
                            long_arm * (stiffness_error + lower_error)) +
                    u * size(rr),
                long_arm);
        const S far = lever * yy + yr;
        rr = rr + lever * (yr + far + lever * own);
        yr = far + x.mass * lever * (e.lower + e.cross);
        yy = yy + x.mass * ((e.lower + e.cross) + (e.cross + e.upper));
        const M upper_size = f.mass * size(e.upper);
        off.add(M(2) * u * (size(yy) + lower_size + M(2) * cross_size + upper_size) + lower_error +
                    M(2) * cross_error + f.mass * e.error.upper,
                long_arm * (M(2) * u * (lower_size + cross_size) + lower_error + cross_error) +
                    u * size(yr),
                M(0), long_arm);
        const S spring = x.stiffness * joint.stiffness + x.damping * joint.damping;
        const S pivot = rr + spring;
        off.add(M(0), M(0), u * (size(rr) + M(2) * size(spring)), long_arm);
        take(pivot, off.rr);
        if (m + 1 == pencil.elements.size()) return count;
        const bool to_link = pencil.joints[m + 1].lever != zero;
        const S share = yr / pivot, turn = to_link ? S(spring / pivot) : zero;
        const S lost = yr * share;
        const M left = size(pivot) * (M(1) - M(4) * epsilon<M>()) - off.rr;
        const M growth = size(pivot) / left * (M(1) + M(8) * epsilon<M>());
        off.eliminate(-static_cast<M>(share), static_cast<M>(turn), growth, long_arm);
        const M arm_above = to_link ? size(pencil.joints[m + 1].lever) : long_arm;
        off.add(u * (size(yy) + M(2) * size(lost)), M(0), M(0), long_arm);
        yy = yy - lost, yr = turn * yr, rr = turn * rr;
        off.add(M(0), M(2) * u * size(yr), M(2) * u * size(rr), arm_above);
    }
    return count;
}

/// Returns the number of negative eigenvalues of Q(x), by rounded pivots.
template <Real T>
Index jointed_count(const SignedPencil<T>& pencil, const T& x) {
    Index negative = 0;
    eliminate<T>(pencil, steady_factors<T>(pencil, x),
                 [&](const T& pivot, const auto&, const auto&, std::size_t) {
                     negative += pivot < T(0) ? 1 : 0;
                 });
    return negative;
}

/// The elimination of all rotations at one x, for any number of loads. F has the field operations.
template <class F>
class JointSolver {
   public:
    template <Real S>
    JointSolver(const SignedPencil<S>& pencil, const JointFactors<F>& x) {
        eliminate<F>(pencil, x, [&](const F& pivot, const F& yr, const F& spring, std::size_t m) {
            steps_.push_back({pivot, yr, spring, F(pencil.joints[m].lever)});
        });
        yields_ = pencil.joints.back().lever == S(Narrow<S>(0));
    }
    std::size_t size() const { return steps_.size(); }
    F& pivot(std::size_t m) { return steps_[m].pivot; }

    /// Replaces loads (torques on rotations; last the force on a support) by rotations, and by the
    /// offset of a support that yields.
    void solve(std::vector<F>& load) const {
        const std::size_t links = steps_.size() - (yields_ ? 1 : 0);
        const F none = load[0] - load[0];
        F at_pin = none;  // the load that is carried to the pin above
        for (std::size_t m = 0; m < links; ++m) {
            const Step& step = steps_[m];
            load[m] = load[m] + step.lever * at_pin;
            const F share = load[m] / step.pivot;
            at_pin = at_pin - step.yr * share;
            if (m + 1 < links) load[m + 1] = load[m + 1] + step.spring * share;
        }
        F y = none;
        if (yields_) y = load[links] = (load[links] + at_pin) / steps_[links].pivot;
        for (std::size_t m = links; m-- > 0;) {
            const Step& step = steps_[m];
            F torque = load[m] - step.yr * y;
            if (m + 1 < links) torque = torque + step.spring * load[m + 1];
            load[m] = torque / step.pivot;
            y = y + step.lever * load[m];
        }
    }

   private:
    struct Step {
        F pivot, yr, spring, lever;
    };
    std::vector<Step> steps_;
    bool yields_ = false;
};

/// Returns the offsets of all pins, lowest first, of rotations q, last the offset of a support that
/// yields. `number` makes an F of a lever.
template <class F, Real S, class Number>
std::vector<F> offsets(const SignedPencil<S>& pencil, const std::vector<F>& q,
                       const Number& number) {
    const bool yields = pencil.joints.back().lever == S(Narrow<S>(0));
    const std::size_t links = q.size() - (yields ? 1 : 0);
    std::vector<F> offset(q.size() + 1, q[0] - q[0]);
    if (yields) offset[links] = q[links];
    for (std::size_t m = links; m-- > 0;)
        offset[m] = offset[m + 1] + number(pencil.joints[m].lever) * q[m];
    return offset;
}

/// Returns Q q for rotations q, last the offset of a support that yields: torques, and the force on
/// the support. F has the field operations and a constructor from S. With `Sizes` all numbers and
/// differences are sums of sizes, and F is real.
template <bool Sizes = false, class F, Real S>
std::vector<F> applied(const SignedPencil<S>& pencil, const JointFactors<F>& x,
                       const std::vector<F>& q) {
    using std::abs;
    const S zero(Narrow<S>(0));
    const auto number = [](const S& y) { return Sizes ? F(S(abs(y))) : F(y); };
    const std::size_t count = pencil.elements.size();
    const bool yields = pencil.joints.back().lever == zero;
    const F none = q[0] - q[0];
    const std::size_t links = count - (yields ? 1 : 0);
    const std::vector<F> offset = offsets(pencil, q, number);
    std::vector<F> row(count, none);
    F force = none, spring_below = none;
    for (std::size_t m = 0; m < count; ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const Joint<S>& joint = pencil.joints[m];
        const F& lower = offset[m];
        const F& upper = offset[m + 1];
        const Carried<F> part = carried(e, joint, x, number);
        const F at_lower = force + part.lower * lower + part.cross * upper;
        const F held = x.stiffness * number(e.stiffness) + x.spin * number(e.spin);
        if (m == links) {
            row[m] = at_lower + (held + x.damping * number(joint.damping)) * lower;
            break;
        }
        const F lever = number(joint.lever);
        const F spring = x.stiffness * number(joint.stiffness) + x.damping * number(joint.damping);
        const F above = m + 1 < links ? q[m + 1] : none;
        const F bent = spring * (Sizes ? q[m] + above : q[m] - above);
        row[m] = lever * (held * lever * q[m] + at_lower) +
                 (Sizes ? bent + spring_below : bent - spring_below);
        spring_below = bent;
        force = at_lower + part.cross * lower + part.upper * upper;
    }
    return row;
}

/// Returns rotations, last the offset of a support that yields, of offsets.
template <Real S>
std::vector<S> rotations(const SignedPencil<S>& pencil, const std::vector<S>& offset) {
    std::vector<S> q;
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const S& lever = pencil.joints[m].lever;
        q.push_back(lever == S(Narrow<S>(0)) ? offset[m] : S((offset[m] - offset[m + 1]) / lever));
    }
    return q;
}

/// Returns the offsets of the mode whose root is next to x, by inverse iteration, largest size 1.
template <Real S>
std::vector<S> jointed_vector(const SignedPencil<S>& pencil, const S& x) {
    using std::abs;
    using M = Narrow<S>;
    JointSolver<S> solver(pencil, steady_factors<S>(pencil, x));
    for (std::size_t m = 0; m < solver.size(); ++m)
        if (abs(solver.pivot(m)) < S(least_pivot<M>())) solver.pivot(m) = S(least_pivot<M>());
    const S none(M(0));
    std::vector<S> offset(pencil.elements.size() + 1);
    for (std::size_t m = 0; m < offset.size(); ++m)  // any start that is no special shape
        offset[m] = S(M(1) / M(static_cast<double>(1 + (m * 7) % 11)) - M(0.3));
    for (int round = 0; round < 3; ++round) {
        std::vector<S> load =
            applied(pencil, JointFactors<S>{none, none, none, S(M(1))}, rotations(pencil, offset));
        solver.solve(load);
        offset = offsets(pencil, load, [](const S& lever) { return lever; });
        S largest = none;
        for (const S& y : offset)
            if (abs(y) > abs(largest)) largest = y;
        for (S& y : offset) y = y / largest;
    }
    return offset;
}

/// Returns the backward error of offsets: the largest residual torque on a rotation, or force on
/// the support, over the largest sum of the sizes of its terms.
template <Real S>
Narrow<S> jointed_residual(const SignedPencil<S>& pencil, const Factors<S>& x,
                           const std::vector<S>& offset) {
    using std::abs;
    using M = Narrow<S>;
    const S one(M(1)), none(M(0));
    std::vector<S> q = rotations(pencil, offset);
    const std::vector<S> off = applied(pencil, JointFactors<S>{x.stiffness, x.spin, none, -one}, q);
    for (S& each : q) each = abs(each);
    const std::vector<S> sizes =
        applied<true>(pencil, JointFactors<S>{abs(x.stiffness), abs(x.spin), none, one}, q);
    M worst(0), largest(0);
    for (std::size_t m = 0; m < off.size(); ++m) {
        worst = std::max(worst, abs(static_cast<M>(off[m])));
        largest = std::max(largest, static_cast<M>(sizes[m]));
    }
    return largest > M(0) ? worst / largest : M(0);
}

/// Returns y^T K y of the springs at the pins.
template <Real S>
S spring_form(const SignedPencil<S>& pencil, const std::vector<S>& offset) {
    S form(Narrow<S>(0)), above(Narrow<S>(0));
    for (std::size_t m = pencil.elements.size(); m-- > 0;) {
        const Joint<S>& joint = pencil.joints[m];
        if (joint.lever == S(Narrow<S>(0))) continue;
        const S rotation = (offset[m] - offset[m + 1]) / joint.lever, bend = rotation - above;
        form = form + joint.stiffness * bend * bend;
        above = rotation;
    }
    return form;
}

}  // namespace revchain::pencil
