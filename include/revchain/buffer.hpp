// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <vector>

#include "revchain/numeric/compiler.hpp"

/// Two railway carriages, coupled by a spring, that hit a buffer stop: one blow, two or more.
///
///     const revchain::BufferImpact impact(
///         {.front_mass = 20e3, .rear_mass = 20e3, .buffer_stiffness = 2e6,
///          .coupling_stiffness = 0.5e6, .speed = 2.0});
///     impact.blows().size();      // 2 blows
///     impact.blows()[0].end;      // 0.397384 s
///     impact(0.1).buffer_force;   // 337373 N at 0.1 s
///
/// Greenhill (1908) §2: "the system is seen to deal a double blow". Units: any consistent set.
namespace revchain::inline REVCHAIN_BUILD {

/// The data. At time 0 the coupling is unloaded.
struct Carriages {
    double front_mass, rear_mass;
    double buffer_stiffness;    ///< the buffer only pushes; it loses contact where it would pull
    double coupling_stiffness;  ///< the coupling pulls and pushes
    double speed;  ///< of both, towards the buffer, at time 0, when the front one touches it
};

/// Displacements of the carriages since time 0, towards the buffer, and their speeds.
struct CarriageState {
    double front, rear, front_speed, rear_speed;
    double buffer_force;  ///< 0 without contact
};

/// One contact with the buffer.
struct Blow {
    double start, end;  ///< times
    double impulse;     ///< integral of the buffer's force: the momentum that the carriages lose
};

/// The motion as a function of time. Accuracy for up to 30 blows, if none only grazes
/// (tests/cpp/buffer.cpp): positions 1e-13 of speed x time, speeds 1e-13 of the speed and of
/// acceleration x time, times of blows 1e-13 of the last one. Errors grow with the number of blows.
/// Cost: 0.6 microseconds a blow, 25 ns for a state.
class BufferImpact {
   public:
    /// Throws InvalidArgument unless all numbers are positive and finite, and for more than 100,000
    /// blows.
    explicit BufferImpact(const Carriages& given);

    const std::vector<Blow>& blows() const noexcept { return blows_; }
    /// The state at a time. Throws InvalidArgument for a negative time.
    [[nodiscard]] CarriageState operator()(double time) const;

   private:
    /// The front carriage is at c + v t + sum of (a cos w t + b sin w t), the rear one at c + v t +
    /// the same sum with each term times `ratio`.
    struct Phase {
        double start, centre = 0, drift = 0;
        std::array<double, 2> cosine{}, sine{}, frequency{}, ratio{};

        CarriageState at(double t) const;
        double first_zero(double sign, double end, long& steps) const;
    };
    void find_blows();
    Phase contact(double start, const CarriageState& from) const;
    Phase freedom(double start, const CarriageState& from) const;

    Carriages given_;
    std::array<double, 2> frequency_{}, ratio_{};  // in contact; ratio: rear over front
    std::vector<Phase> phases_;                    // contact, freedom, contact, ..., freedom
    std::vector<Blow> blows_;
};

}  // namespace revchain

#include "revchain/paper/buffer.hpp"
