// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/pencil/jointed.hpp"

/// The family Q(s) = K + s (C - i G) + s^2 M of a rig with dashpots, and what its moving support
/// adds.
namespace revchain::inline REVCHAIN_BUILD::pencil {

using DampedPencil = SignedPencil<Wide<double>>;

/// Returns the factors of K + s (C - i G) + s^2 M; `slope`: of its derivative.
template <class F>
JointFactors<F> damped_factors(const F& s, const F& i, bool slope = false) {
    const F one(Wide<double>(1.0)), none(Wide<double>(0.0));
    if (slope) return {none, -i, one, s + s};
    return {one, none - i * s, s, s * s};
}

/// Returns Q times a unit motion of all pins together: torques on rotations, and the force on what
/// moves them, which for a support that yields is that on its offset. Springs and dashpots at pins
/// have no part in it.
template <class F>
struct MovedTogether {
    std::vector<F> load;
    F force{};

    MovedTogether(const DampedPencil& pencil, const JointFactors<F>& x) {
        const Wide<double> zero(0.0);
        force = F(zero);
        for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
            const SignedElement<Wide<double>>& e = pencil.elements[m];
            const Joint<Wide<double>>& joint = pencil.joints[m];
            const Carried<F> part =
                carried(e, joint, x, [](const Wide<double>& y) { return F(y); });
            const F at_lower = force + (part.lower + part.cross);
            if (joint.lever == zero) {
                force = at_lower + x.stiffness * F(e.stiffness) + x.damping * F(joint.damping);
                load.push_back(force);
                return;
            }
            load.push_back(F(joint.lever) * at_lower);
            force = at_lower + (part.cross + part.upper);
        }
    }
};

/// Returns the damping of a motion of all pins together.
inline Wide<double> damping_together(const DampedPencil& pencil) {
    Wide<double> sum = pencil.joints.back().lever == Wide<double>(0.0)
                           ? pencil.joints.back().damping
                           : Wide<double>(0.0);
    for (const Joint<Wide<double>>& joint : pencil.joints)
        sum = sum + Wide<double>(6.0) * joint.drag;
    return sum;
}

}  // namespace revchain::pencil
