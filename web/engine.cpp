// SPDX-License-Identifier: MPL-2.0
// What the live page asks of the library. Numbers go in and out as arrays of doubles; web/engine.js has their order.
// An exception reaches web/engine.js, which starts a new instance: the build catches none, which makes it a third smaller.
// Masses serve as weights, as in the Python package: speeds depend on ratios alone, stiffness and momentum are divided
// by gravity.
#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "engine.hpp"
#include "revchain/branches.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"

namespace web {

std::vector<double> numbers;
std::optional<revchain::Rig> rig;
double gravity = revchain::conical_pendulum::standard_gravity;

namespace {

std::vector<revchain::SteadyShape> shapes;
revchain::Rotation direction = revchain::Rotation::forward;

/// A force in newtons in the unit of the weights, in double words: bounds hold for the number given.
revchain::Wide<double> over_gravity(double force) {
    if (std::isinf(force)) return force;
    return revchain::Wide<double>(force) / revchain::Wide<double>(gravity);
}

// A rig without rigging costs what its chain costs: one way for both keeps the page small.

/// A part is so many equal links: count, mass, length, centroid, radius of gyration, whether they stand, momentum and
/// axial moment of inertia of their flywheels.
constexpr int part_size = 8;

revchain::Rig rig_of(const std::vector<double>& given, int parts, revchain::Support support) {
    std::vector<revchain::Link<double>> links;
    revchain::Rigging rigging{.support = support};
    bool stand = false, turn = false;
    for (int p = 0; p < parts; ++p) {
        const double* part = given.data() + p * part_size;
        const auto count = static_cast<std::size_t>(part[0]);
        const auto link = revchain::compound_pendulum<double>(
            {.weight = part[1], .length = part[2], .centroid = part[3], .radius_of_gyration = part[4]});
        links.insert(links.end(), count, link);
        stand = stand || part[5] != 0, turn = turn || part[6] != 0 || part[7] != 0;
        rigging.posture.insert(rigging.posture.end(), count,
                               part[5] != 0 ? revchain::Posture::stands : revchain::Posture::hangs);
        rigging.flywheels.insert(rigging.flywheels.end(), count, {over_gravity(part[6]), part[7]});
    }
    if (!stand) rigging.posture.clear();
    if (!turn) rigging.flywheels.clear();
    return {revchain::Chain<double>(links), std::move(rigging)};
}

void put_branch(const revchain::Branch& branch) {
    put(static_cast<double>(branch.mode)), put(static_cast<double>(branch.birth));
    put(static_cast<double>(branch.end)), put(static_cast<double>(branch.size()));
    for (std::size_t i = 0; i < branch.size(); ++i) put(branch.angular_speed(i, gravity));
    put_all(branch.tip_radius), put_all(branch.half_waves);
}

}  // namespace
}  // namespace web

extern "C" {

using namespace web;

/// Room for `count` numbers that the next call reads.
double* room(int count) {
    numbers.assign(static_cast<std::size_t>(count), 0.0);
    return numbers.data();
}
const double* answer() { return numbers.data(); }
const char* what(const std::exception* thrown) { return thrown->what(); }

/// The system that the next calls are about, from `parts` parts in the room. Answers its number of links.
int set_rig(int parts, double stiffness, double carriage, double radius, double g) {
    const std::vector<double> given = numbers;
    return answered([&] {
        gravity = g, direction = revchain::Rotation::forward, shapes.clear();
        rig = rig_of(given, parts, {over_gravity(stiffness), carriage, radius});
        put(static_cast<double>(rig->size()));
    });
}

/// Whether the list is complete, the number of shapes; each shape. Forces are over gravity.
int find_shapes(double speed, double budget) {
    return answered([&] {
        direction = speed < 0 ? revchain::Rotation::backward : revchain::Rotation::forward;
        const revchain::RigShapesOptions options{
            .angular_speed = speed, .budget = static_cast<long>(budget), .gravity = gravity};
        revchain::SteadyShapes found = revchain::steady_shapes(*rig, options, revchain::thorough);
        shapes = std::move(found.shapes);
        put(found.complete), put(static_cast<double>(shapes.size()));
        for (const auto& shape : shapes) {
            put(shape.half_waves), put(shape.error_bound), put(shape.tension[shape.tension.size() - 1]);
            put_all(shape.inclination), put_all(shape.offset), put_all(shape.height);
        }
    });
}

/// Verdict and growth rate (over the speed) of shapes `first` ... `last` - 1 of those found last.
int judge_shapes(int first, int last) {
    return answered([&] {
        for (int i = first; i < last; ++i) {
            const auto& shape = shapes.at(static_cast<std::size_t>(i));
            const revchain::RigStabilityOptions options{.direction = direction, .gravity = gravity};
            const revchain::Stability judged = revchain::stability(*rig, shape, options, revchain::thorough);
            put(static_cast<double>(judged.verdict)), put(judged.growth_rate);
        }
    });
}

/// The branch that leaves the vertical at a mode (1: from rest, where the support is carried round), up to a speed.
int find_branch(int mode, double speed) {
    return answered([&] {
        const revchain::RigBranchOptions options{.mode = mode, .max_angular_speed = speed, .gravity = gravity};
        put_branch(revchain::branch(*rig, options));
    });
}

/// Whether the diagram is complete, the number of branches; each branch.
int find_branches(double speed, int lists, double budget, double proof_budget) {
    return answered([&] {
        const revchain::RigDiagramOptions options{.max_angular_speed = speed,
                                                  .lists = lists,
                                                  .budget = static_cast<long>(budget),
                                                  .proof_budget = static_cast<long>(proof_budget),
                                                  .gravity = gravity};
        const revchain::Branches found = revchain::branches(*rig, options, revchain::thorough);
        put(found.complete), put(static_cast<double>(found.branches.size()));
        for (const auto& branch : found.branches) put_branch(branch);
    });
}
}
