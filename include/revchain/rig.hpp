// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/system/link.hpp"

/// A chain and its rigging: a yielding or carried support, flywheels, a fluid, standing links,
/// springs and dashpots at pins, linear drag.
///
///     const revchain::Chain<double> chain({revchain::plummet(80.0, 0.5), revchain::plummet(20.0, 4.0)});
///     const revchain::Rig carousel(chain, {.support = {.radius = 4.0}});             // m
///     const auto found = revchain::steady_shapes(carousel, {.angular_speed = 1.0});  // steady_shapes.hpp
///     found.shapes[0].offset[0];                                     // 6.46323 m: the seat's radius
///     const revchain::Rig sprung(chain, {.support = revchain::horizontal_spring(500.0, 10.0)});
///
/// Forces are in the unit of the weights, the stiffness of a support in that unit over the unit of
/// length, of a pin in that unit times it. Stiffness and momentum are double words: with masses for
/// weights, newtons are divided by gravity without rounding to double, `Wide<double>(500.0) /
/// Wide<double>(9.81)`. `modes` of a rig is in rig_modes.hpp. Greenhill (1908) §2, §7 and §8.
namespace revchain::inline REVCHAIN_BUILD {

/// The support of the uppermost pin. The default is a firm point on the axis.
struct Support {
    /// sideways, force over length; infinite if firm, 0 for a trolley that rolls freely
    Wide<double> stiffness = std::numeric_limits<double>::infinity();
    double carriage_weight = 0;  ///< weight that moves sideways with a pin that yields
    double radius = 0;           ///< distance of the support's rest position from the axis
    Wide<double> damping{0.0};   ///< of a dashpot to the ground, force times time over length

    bool is_firm() const noexcept { return std::isinf(stiffness.high); }
    bool is_free() const noexcept { return stiffness == Wide<double>(0.0); }
    friend bool operator==(const Support&, const Support&) = default;
};

/// A pin that slides sideways on a spring of stiffness E, Greenhill (1908) §2 (7). Throws
/// InvalidArgument unless stiffness > 0 and carriage weight >= 0.
[[nodiscard]] inline Support horizontal_spring(const Wide<double>& stiffness,
                                               double carriage_weight = 0) {
    detail::require_positive("horizontal_spring", "stiffness", stiffness.high);
    detail::require_not_negative("horizontal_spring", "carriage weight", carriage_weight);
    return {stiffness, carriage_weight, 0};
}

/// A trolley of this weight that rolls sideways without a spring (Taylor, Classical Mechanics,
/// 2005, problem 11.28). Throws InvalidArgument unless the weight is >= 0 and finite.
[[nodiscard]] inline Support free_trolley(double carriage_weight) {
    detail::require_not_negative("free_trolley", "carriage weight", carriage_weight);
    return {0.0, carriage_weight, 0};
}

/// A torsion spring and a dashpot between the two links at a pin, or at the uppermost pin between
/// link and vertical. The spring is relaxed in the straight chain at rest.
struct Pin {
    Wide<double> stiffness{0.0};  ///< torque over angle, >= 0
    Wide<double> damping{0.0};    ///< torque times time over angle, >= 0

    friend bool operator==(const Pin&, const Pin&) = default;
};

/// A pin carried round the axis: a chair on the arm of a carousel, a hand, Greenhill (1908) §1 (9).
/// Throws InvalidArgument unless radius >= 0 and finite.
[[nodiscard]] inline Support carried_round(double radius) {
    detail::require_not_negative("carried_round", "radius", radius);
    return {.radius = radius};
}

/// Angular momentum of a link along its own axis, positive from its lower pin to its upper one. For
/// a hanging link this is the direction of rotation for n > 0. One part is constant, and the other
/// turns with the link:
///     p = momentum + axial_moment n cos(inclination) / g.
/// The flywheel's weight, and its inertia across the axis, belong to the link's own numbers.
struct Flywheel {
    Wide<double> momentum{0.0};      ///< H, constant; weight times length times time, any sign
    Wide<double> axial_moment{0.0};  ///< C >= 0, weight times length squared (over g: an inertia)

    friend bool operator==(const Flywheel&, const Flywheel&) = default;
};

/// A wheel on free bearings: its spin is constant, `spin` rad/s about the link's axis as seen from
/// outside. Throws InvalidArgument for numbers out of range.
[[nodiscard]] Flywheel free_flywheel(double weight, double radius_of_gyration, double spin,
                                     double gravity = conical_pendulum::standard_gravity);

/// A wheel that a motor turns with `spin` rad/s relative to its link, which turns about its axis
/// with the whole chain. Throws as free_flywheel.
[[nodiscard]] Flywheel driven_flywheel(double weight, double radius_of_gyration, double spin,
                                       double gravity = conical_pendulum::standard_gravity);

/// The fluid around a chain: at rest, or turning bodily with it.
enum class Fluid { still, turning };

/// The fluid that a link displaces.
struct Displaced {
    double weight = 0;    ///< B >= 0, of the fluid displaced
    double centroid = 0;  ///< centre of buoyancy, from the upper pin, positive downwards
    Wide<double> gyration_ratio{0.0};  ///< (radius of gyration / link length)^2, about it
    double added_weight = 0;  ///< of the still fluid that moves with the link; distributed as B

    friend bool operator==(const Displaced&, const Displaced&) = default;
};

/// The fluid displaced by a body of one density.
[[nodiscard]] inline Displaced displaced_by(const Link<double>& link, double weight,
                                            double added_weight = 0) {
    return {weight, link.centroid, link.gyration_ratio, added_weight};
}

/// The rigging of a chain. Each list has one entry for each link, lowest first, or is empty.
struct Rigging {
    Support support{};
    std::vector<Posture> posture{};  ///< of each link in the straight chain; empty: all hang
    std::vector<Flywheel> flywheels{};
    Fluid fluid = Fluid::still;
    std::vector<Displaced> displaced{};
    std::vector<Pin> pins{};  ///< the upper pin of each link
    /// Linear drag of each link in still air, force times time over length, >= 0: spread evenly
    /// along it, on the velocity.
    std::vector<Wide<double>> drag{};

    friend bool operator==(const Rigging&, const Rigging&) = default;
};

/// A chain and its rigging.
///
/// Throws InvalidArgument, naming the link, for lists that are neither empty nor as long as the
/// chain, numbers out of range, a carriage or a dashpot at a firm support, and a free trolley with
/// a radius or in a fluid that turns. Cost O(N) once.
class Rig {
   public:
    Rig(Chain<double> chain, Rigging with) : chain_(std::move(chain)), with_(std::move(with)) {
        check();
    }

    const Chain<double>& chain() const noexcept { return chain_; }
    const Support& support() const noexcept { return with_.support; }
    const Rigging& rigging() const noexcept { return with_; }
    Index size() const noexcept { return chain_.size(); }
    Fluid fluid() const noexcept { return with_.fluid; }

    bool stands(Index m) const {
        return !with_.posture.empty() &&
               with_.posture[static_cast<std::size_t>(m)] == Posture::stands;
    }
    Flywheel flywheel(Index m) const {
        return with_.flywheels.empty() ? Flywheel{} : with_.flywheels[static_cast<std::size_t>(m)];
    }
    /// The fluid that link m displaces; by default the weights are 0, and centroid and radius of
    /// gyration those of the link.
    Displaced displaced(Index m) const {
        const Displaced given =
            with_.displaced.empty() ? Displaced{} : with_.displaced[static_cast<std::size_t>(m)];
        return given == Displaced{} ? displaced_by(chain_.link(m), 0) : given;
    }
    Pin pin(Index m) const {
        return with_.pins.empty() ? Pin{} : with_.pins[static_cast<std::size_t>(m)];
    }
    Wide<double> drag(Index m) const {
        return with_.drag.empty() ? Wide<double>(0.0) : with_.drag[static_cast<std::size_t>(m)];
    }
    bool has_drag() const {
        return std::any_of(with_.drag.begin(), with_.drag.end(),
                           [](const Wide<double>& drag) { return drag != Wide<double>(0.0); });
    }
    bool has_pin_springs() const {
        return std::any_of(with_.pins.begin(), with_.pins.end(),
                           [](const Pin& pin) { return pin.stiffness != Wide<double>(0.0); });
    }
    /// Whether any pin or the support has a dashpot, or a link linear drag.
    bool is_damped() const {
        return with_.support.damping != Wide<double>(0.0) || has_drag() ||
               std::any_of(with_.pins.begin(), with_.pins.end(),
                           [](const Pin& pin) { return pin.damping != Wide<double>(0.0); });
    }
    /// Whether the fluid that link m displaces, if any, is distributed as the link's own weight.
    bool fills_its_link(Index m) const {
        const Displaced fluid = displaced(m);
        const Link<double> link = chain_.link(m);
        return (fluid.weight == 0 && fluid.added_weight == 0) ||
               (fluid.centroid == link.centroid && fluid.gyration_ratio == link.gyration_ratio);
    }
    /// Whether the two directions of rotation differ.
    bool has_momentum() const {
        return std::any_of(
            with_.flywheels.begin(), with_.flywheels.end(),
            [](const Flywheel& wheel) { return wheel.momentum != Wide<double>(0.0); });
    }
    /// Whether small motions are those of the chain alone. The support may be carried round.
    bool is_plain_chain() const {
        if (has_pin_springs() || is_damped()) return false;
        for (Index m = 0; m < size(); ++m)
            if (stands(m) || flywheel(m) != Flywheel{} || displaced(m).weight != 0 ||
                displaced(m).added_weight != 0)
                return false;
        return with_.support.is_firm();
    }

    friend bool operator==(const Rig&, const Rig&) = default;

   private:
    void check() const;

    Chain<double> chain_;
    Rigging with_;
};

}  // namespace revchain

#include "revchain/system/rig.hpp"
