// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of what needs GSL: cords, elliptic functions, ropes, governors.
#include "revchain/analytic.hpp"
#include "fuzz.hpp"
#include "revchain/special/incomplete_elliptic.hpp"

namespace {

namespace analytic = revchain::analytic;
using revchain::Index;

analytic::EllipticModulus modulus(fuzz::Random& random) {
    const double k = random.one_in(3) ? random.number() : random.between(0, 1);
    return random.one_in(2) ? analytic::EllipticModulus::of(k) : analytic::EllipticModulus::of_complement(k);
}

void elliptic(fuzz::Random& random) {
    const auto k = modulus(random);
    (void)analytic::complete_integrals(k), (void)analytic::incomplete_integrals(random.number(), k);
    (void)analytic::JacobiFunctions(k)(random.number());
    const double n = random.one_in(2) ? random.between(-3, 1) : random.number();
    (void)analytic::incomplete_pi(n, random.number(), k), (void)analytic::complete_pi(n, k);
}

void ropes(fuzz::Random& random) {
    std::optional<double> analytic::RopeGiven::*const data[] = {
        &analytic::RopeGiven::span, &analytic::RopeGiven::length,        &analytic::RopeGiven::slack,
        &analytic::RopeGiven::sag,  &analytic::RopeGiven::angular_speed, &analytic::RopeGiven::tension};
    analytic::RopeGiven given;
    for (std::uint64_t known = 2 + random.below(2); known-- > 0;) given.*data[random.below(6)] = random.number();
    given.half_waves = random.count(5);
    const analytic::SkippingRope rope(given);
    (void)rope.at(rope.span() * random.between(0, 1)), (void)rope.at_arc(rope.length() * random.between(0, 1));
    (void)rope.moment_of_inertia();
    if (rope.has_speed()) (void)rope.drawn_to(rope.span() * random.between(0.5, 1.5));
}

template <class Mode>
void along(const Mode& mode, double x) {
    (void)mode.shape(x), (void)mode.slope(x), (void)mode.nodes(), (void)mode.vertical_points();
}

}  // namespace

void fuzz::analytic(Random& random) {
    namespace library = revchain::analytic;
    const double length = random.number(), x = random.one_in(9) ? random.number() : length * random.between(0, 1);
    const Index count = random.count(random.one_in(9) ? 3000 : 30);
    switch (random.below(7)) {
        case 0:
            elliptic(random);
            break;
        case 1:
            ropes(random);
            break;
        case 2: {
            const library::GovernorMotion motion({random.number(), random.number(), random.number(), random.number(),
                                                  random.number(), random.between(0, 1)});
            (void)motion(random.number());
            break;
        }
        case 3: {
            const library::TortuousRope rope({random.number(), random.number(), random.number(), random.number()});
            (void)rope.at(random.number()), (void)rope.half_wave_angle(), (void)rope.half_wave_slack();
            break;
        }
        case 4:
            (void)library::heavy_chain::conical_heights(count, length);
            (void)library::heavy_chain::nodes(count, length);
            (void)library::heavy_chain::shape(x, count, length), (void)library::heavy_chain::slope(x, count, length);
            (void)library::heavy_chain::vertical_points(count, length);
            (void)library::heavy_chain::kinetic_energy(count, random.number());
            break;
        case 5: {
            const double tip = random.number();
            (void)library::tip_mass::conical_heights(count, length, tip);
            along(library::tip_mass::Mode(count, length, tip), x);
            break;
        }
        default: {
            const double exponent = random.one_in(2) ? random.between(-0.99, 100) : random.number();
            (void)library::tapered_chain::conical_heights(count, length, exponent);
            along(library::tapered_chain::Mode(count, length, exponent), x);
        }
    }
}
