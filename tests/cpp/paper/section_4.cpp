// SPDX-License-Identifier: GPL-3.0-or-later
// Greenhill (1908) §4: the continuous chain, as a theory of its own and as the limit of many links.
#include <array>
#include <functional>
#include <numbers>

#include "paper.hpp"
#include "revchain/special/heavy_chain.hpp"
#include "revchain/special/tapered_chain.hpp"
#include "revchain/special/tip_mass.hpp"

namespace heavy_chain = revchain::analytic::heavy_chain;
namespace tapered_chain = revchain::analytic::tapered_chain;
namespace tip_mass = revchain::analytic::tip_mass;
using paper::Index;
using paper::Quad;

namespace {

constexpr int modes_tried = 6;

/// The chain's profile of mode k as a function of z = 2 sqrt(x / lambda), for a chain of length 1.
struct Profile {
    explicit Profile(Index k)
        : mode(k), height(heavy_chain::conical_heights(k, 1.0)[k - 1]), end(2 / std::sqrt(height)) {}
    double x(double z) const { return std::min(height * (z * z) / 4, 1.0); }
    double operator()(double z) const { return heavy_chain::shape(x(z), mode, 1.0); }

    Index mode;
    double height, end;
};

/// Gauss-Legendre, eight points to a panel.
double integral(double from, double to, const std::function<double(double)>& f, int panels = 40) {
    constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                         0.9602898564975363};
    constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                           0.1012285362903763};
    const double half = (to - from) / panels / 2;
    double sum = 0;
    for (int p = 0; p < panels; ++p) {
        const double middle = from + (2 * p + 1) * half;
        for (std::size_t i = 0; i < 4; ++i)
            sum += weight[i] * half * (f(middle - half * node[i]) + f(middle + half * node[i]));
    }
    return sum;
}

/// J_0 by its power series in quadruple precision: nothing in common with the library's.
Quad bessel_j0(Quad z) {
    const Quad quarter = z * z / 4;
    Quad term = 1, sum = 1;
    for (int m = 1; m < 200; ++m) sum += term *= -quarter / (Quad(m) * m);
    return sum;
}

// First and second derivative by central differences of eighth order.
double slope(const Profile& y, double z, double h) {
    constexpr std::array<double, 4> c{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += c[i] * (y(z + double(i + 1) * h) - y(z - double(i + 1) * h));
    return sum / h;
}

double curvature(const Profile& y, double z, double h) {
    constexpr std::array<double, 4> c{8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    double sum = -205.0 / 72 * y(z);
    for (std::size_t i = 0; i < 4; ++i) sum += c[i] * (y(z + double(i + 1) * h) + y(z - double(i + 1) * h));
    return sum / (h * h);
}

}  // namespace

TEST_CASE("§4 (1), (2), (4): lambda x dy/dx + integral of y dx = 0", "[paper][section_4]") {
    // Divided by x and integrated from the free end it needs no derivative: y(x) = y(0) - (1/lambda) times the integral
    // of (1/x) times the integral of y. That is (2) for small inclinations, with the constant y(0) that (2) leaves out.
    double worst = 0;
    for (Index k = 1; k <= modes_tried; ++k) {
        const Profile y(k);
        const auto below = [&](double z) {  // the integral of y dx up to z, over lambda
            return integral(
                0, z, [&](double t) { return y(t) * t / 2; }, 10);
        };
        for (const double share : {0.2, 0.5, 0.8, 1.0}) {
            const double z = share * y.end;
            // dx/x = 2 dz/z
            const double fallen = integral(
                0, z, [&](double t) { return below(t) * 2 / t; }, 10);
            worst = std::max(worst, std::abs(1 - fallen - y(z)) / std::numeric_limits<double>::epsilon());
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 4);  // ulp of the offset at the free end; measured 3.5
}

TEST_CASE("§4 (5)-(7): the differential equations in z = 2 sqrt(x/lambda)", "[paper][section_4]") {
    // Erratum: (5) is printed z dy/dz + integral of 2 y dz; the 2 is a z, as (6) shows.
    constexpr double h = 0.04;
    double worst_5 = 0, worst_6 = 0, worst_7 = 0, least_printed = 1e9;
    for (Index k = 1; k <= modes_tried; ++k) {
        const Profile y(k);
        for (int i = 1; i < 20; ++i) {
            const double z = 8 * h + (y.end - 16 * h) * i / 20.0;
            const double first = slope(y, z, h), second = curvature(y, z, h);
            const double area = integral(0, z, [&](double t) { return t * y(t); });
            worst_5 = std::max(worst_5, std::abs(z * first + area) / z);
            const double printed = z * first + integral(0, z, [&](double t) { return 2 * y(t); });
            if (i == 10) least_printed = std::min(least_printed, std::abs(printed) / z);
            // d/dz (z dy/dz), itself by differences of z dy/dz
            const double outer =
                (4.0 / 5 * ((z + h) * slope(y, z + h, h) - (z - h) * slope(y, z - h, h)) -
                 1.0 / 5 * ((z + 2 * h) * slope(y, z + 2 * h, h) - (z - 2 * h) * slope(y, z - 2 * h, h)) +
                 4.0 / 105 * ((z + 3 * h) * slope(y, z + 3 * h, h) - (z - 3 * h) * slope(y, z - 3 * h, h)) -
                 1.0 / 280 * ((z + 4 * h) * slope(y, z + 4 * h, h) - (z - 4 * h) * slope(y, z - 4 * h, h))) /
                h;
            worst_6 = std::max(worst_6, std::abs(outer + z * y(z)) / z);
            worst_7 = std::max(worst_7, std::abs(second + first / z + y(z)));
        }
    }
    CAPTURE(worst_5 * 1e15, worst_6 * 1e15, worst_7 * 1e15, least_printed);
    CHECK(worst_5 <= 2e-14);  // differences of step h lose eps/h; measured 1.55e-14
    CHECK(worst_6 <= 5e-13);  // eps/h^2; measured 4.1e-13
    CHECK(worst_7 <= 1e-12);  // eps/h^2; measured 8.7e-13
    CHECK(least_printed > 0.01);
}

TEST_CASE("§4 (8), (9): the profile is J_0(2 sqrt(x/lambda))", "[paper][section_4]") {
    double worst = 0;
    for (Index k = 1; k <= modes_tried; ++k) {
        const Quad height = Quad(4) / (Quad(revchain::analytic::zero_of_j0(k)) * revchain::analytic::zero_of_j0(k));
        for (int i = 0; i <= 200; ++i) {
            const double x = i / 200.0;
            const Quad truth = bessel_j0(2 * sqrtq(x / height));
            const double error = static_cast<double>(fabsq(heavy_chain::shape(x, k, 1.0) - truth));
            worst =
                std::max(worst, error / (4e-16 * (1 + 2 / std::sqrt(static_cast<double>(height)))));  // as documented
        }
        CHECK(heavy_chain::shape(0.0, k, 1.0) == 1.0);
    }
    CAPTURE(worst);
    CHECK(worst <= 0.3);  // measured 0.26
}

TEST_CASE("§4 (10): the zeros of J_0", "[paper][section_4]") {
    const std::array<double, 6> by_eye{2.4, 5.5, 8.6, 11.8, 14.9, 18.0};
    const std::array<double, 6> read{2.404826, 5.520078, 8.653728, 11.791534, 14.930918, 18.071064};
    for (std::size_t k = 0; k < 6; ++k) {
        const double z = revchain::analytic::zero_of_j0(static_cast<Index>(k + 1));
        CHECK(std::abs(z - read[k]) < 5.1e-7);
        // What Greenhill read off a graph is right to the figure printed, but for the third and the sixth.
        CHECK((std::abs(z - by_eye[k]) < 0.05) == (k != 2 && k != 5));
        CHECK(fabsq(bessel_j0(z)) < Quad(1e-15));
        if (k > 0) {  // "the increment difference approximating to pi"
            const double increment = z - revchain::analytic::zero_of_j0(static_cast<Index>(k));
            CHECK(increment < std::numbers::pi);
            CHECK(increment > std::numbers::pi - 0.04 / double(k * k));
        }
    }
}

TEST_CASE("§4 (11): R = N z/2 revolutions a second", "[paper][section_4]") {
    const double length = 0.39, g = 9.81;
    const double N = revchain::conical_pendulum::revolutions_per_second(length, g);
    const auto R = heavy_chain::revolutions_per_second(6, length, g);
    const auto height = heavy_chain::conical_heights(6, length);
    const std::array<double, 3> printed{2.4, 5.5, 8.6};
    for (Index k = 0; k < 6; ++k) {
        CHECK(R[k] == Approx(N * revchain::analytic::zero_of_j0(k + 1) / 2).epsilon(1e-15));
        // and the speed that belongs to the conical height
        CHECK(R[k] == Approx(revchain::conical_pendulum::revolutions_per_second(height[k], g)).epsilon(1e-15));
        if (k < 3) CHECK(std::abs(2 * R[k] / N - printed[static_cast<std::size_t>(k)]) < 0.06);
    }
}

TEST_CASE("§4 (12): nodes at x/lambda = z^2/4", "[paper][section_4]") {
    // Erratum: n/lambda is printed; and by eye 1.44, 7.56, 18.49, 34.81, 55.5, 81.
    const std::array<double, 6> read{1.445796, 7.617816, 18.721752, 34.760071, 55.733076, 81.640838};
    for (Index k = 1; k <= modes_tried; ++k) {
        const double height = heavy_chain::conical_heights(k, 2.5)[k - 1];
        CHECK(std::abs(2.5 / height - read[static_cast<std::size_t>(k - 1)]) < 5.1e-7);  // the support is a node too
        const auto nodes = heavy_chain::nodes(k, 2.5);
        REQUIRE(nodes.size() == k - 1);
        for (Index i = 0; i < nodes.size(); ++i) {
            CHECK(std::abs(nodes[i] / height - read[static_cast<std::size_t>(i)]) < 5.1e-7);
            CHECK(std::abs(heavy_chain::shape(nodes[i], k, 2.5)) < 3e-15);  // measured 1.9e-15
        }
    }
}

TEST_CASE("§4 (13), (14): where the chain is vertical, the chain below has its C.G. on the axis",
          "[paper][section_4]") {
    const std::array<double, 4> z_read{3.831706, 7.015587, 10.173468, 13.323692};  // printed 3.8, 7.0, 10.2, 13.3
    const std::array<double, 4> read{3.670493, 12.304614, 25.874863, 44.380192};   // printed 3.61, 12.25, 26.01, 44.22
    for (Index i = 0; i < 4; ++i)
        CHECK(std::abs(revchain::analytic::zero_of_j1(i + 1) - z_read[static_cast<std::size_t>(i)]) < 5.1e-7);
    double worst_slope = 0, worst_centroid = 0;
    for (Index k = 2; k <= 5; ++k) {
        const Profile y(k);
        const auto points = heavy_chain::vertical_points(k, 1.0);
        REQUIRE(points.size() == k - 1);
        for (Index i = 0; i < points.size(); ++i) {
            CHECK(std::abs(points[i] / y.height - read[static_cast<std::size_t>(i)]) < 5.1e-7);
            const double z = 2 * std::sqrt(points[i] / y.height);
            worst_slope = std::max(worst_slope, std::abs(slope(y, z, 0.04)));
            // Distance of the centre of gravity below from the axis, the largest offset being 1
            const double moment = integral(0, z, [&](double t) { return y(t) * y.height * t / 2; });
            worst_centroid = std::max(worst_centroid, std::abs(moment) / points[i]);
        }
    }
    CAPTURE(worst_slope * 1e15, worst_centroid * 1e15);
    CHECK(worst_slope <= 4e-15);     // measured 2.8e-15
    CHECK(worst_centroid <= 2e-16);  // measured 1.5e-16
}

TEST_CASE("§4 (4), (9): slope and tension close the balance of forces", "[paper][section_4]") {
    // tension dy/dx + (1/lambda) integral of y dx = 0, dx = lambda z dz / 2
    double worst = 0;
    for (Index k = 1; k <= modes_tried; ++k) {
        const Profile y(k);
        CHECK(heavy_chain::slope(0.0, k, 1.0) == -1 / y.height);
        CHECK(heavy_chain::slope(1e-300, k, 1.0) == Approx(-1 / y.height).epsilon(1e-15));
        for (int i = 1; i <= 20; ++i) {
            const double z = y.end * i / 20, x = y.x(z);
            const double below = integral(0, z, [&](double t) { return y(t) * t / 2; });
            worst = std::max(worst, std::abs(heavy_chain::tension(x, 1.0) * heavy_chain::slope(x, k, 1.0) + below));
        }
        for (const double x : {0.3, 0.8}) {  // and is the derivative of the offset
            const double h = 1e-3 / static_cast<double>(k);
            const auto at = [&](double place) { return heavy_chain::shape(place, k, 1.0); };
            const double difference =
                (4.0 / 5 * (at(x + h) - at(x - h)) - 1.0 / 5 * (at(x + 2 * h) - at(x - 2 * h)) +
                 4.0 / 105 * (at(x + 3 * h) - at(x - 3 * h)) - 1.0 / 280 * (at(x + 4 * h) - at(x - 4 * h))) /
                h;
            CHECK(std::abs(heavy_chain::slope(x, k, 1.0) - difference) < 1e-11);
        }
        for (const Index i : {Index(1), k - 1})  // vertical where the paper says
            if (k > 1)
                CHECK(std::abs(heavy_chain::slope(heavy_chain::vertical_points(k, 1.0)[i - 1], k, 1.0)) * y.height <
                      1e-15);
    }
    CAPTURE(worst * 1e15);
    CHECK(worst <= 4.5e-15);  // of tensions times slopes up to 2.8; measured 3.9e-15
}

TEST_CASE("§4: energies of the steady whirl, kinetic and potential alike", "[paper][section_4]") {
    double worst = 0;
    for (Index k = 1; k <= 3 * modes_tried; ++k) {
        const double b = 0.3, length = 1.7, height = heavy_chain::conical_heights(k, length)[k - 1];
        const double end = 2 * std::sqrt(length / height);
        const auto x = [&](double z) { return std::min(height * (z * z) / 4, length); };
        const double kinetic = integral(0, end,
                                        [&](double z) {
                                            const double y = b * heavy_chain::shape(x(z), k, length);
                                            return y * y * z;
                                        }) /
                               4;  // 1/(2 lambda), dx = lambda z dz / 2
        const double potential = integral(0, end,
                                          [&](double z) {
                                              const double slope = b * heavy_chain::slope(x(z), k, length);
                                              return heavy_chain::tension(x(z), length) * slope * slope * z;
                                          }) *
                                 height / 4;
        worst = std::max({worst, std::abs(kinetic / heavy_chain::kinetic_energy(k, b) - 1),
                          std::abs(potential / heavy_chain::potential_energy(k, b) - 1)});
    }
    CAPTURE(worst * 1e15);
    CHECK(worst <= 1.5e-15);  // measured 1.4e-15
    // (b^2/8) (j J_1(j))^2 for mode 1
    CHECK(heavy_chain::kinetic_energy(1, 1.0) ==
          Approx(0.125 * std::pow(2.404825557695773 * 0.5191474972894669, 2)).epsilon(1e-15));
    // Far up every mode holds b^2 j/(4 pi).
    const double j = revchain::analytic::zero_of_j0(100'000);
    CHECK(heavy_chain::kinetic_energy(100'000, 2.0) == Approx(j / std::numbers::pi).epsilon(1e-9));
}

TEST_CASE("§4 with a tip mass: the balance of forces, and many plummets", "[paper][section_4]") {
    // (tip + x) dy/dx + (tip y(0) + integral of y dx) / lambda = 0: the weight below leans on the link above.
    double worst = 0;
    for (const double tip : {1e-9, 0.01, 0.3, 2.0, 40.0, 1e3}) {
        for (Index k = 1; k <= modes_tried; ++k) {
            const tip_mass::Mode mode(k, 1.0, tip);
            const double height = mode.conical_height(), largest = k == 1 ? 1 : std::sqrt(1 + tip / height);
            for (const double x : {0.1, 0.35, 0.8, 1.0}) {
                const double below = integral(0, std::sqrt(x), [&](double t) {  // x = t^2
                    return 2 * t * mode.shape(std::min(t * t, x));
                });
                const double left = (tip + x) * mode.slope(x) * height, right = tip * mode.shape(0) + below;
                worst = std::max(worst, std::abs(left + right) / (largest * (tip + x)));
            }
        }
    }
    CAPTURE(worst * 1e15);
    CHECK(worst <= 4e-16);  // measured 3.2e-16

    // Equal plummets, half of one at either end, and the tip with the lowest.
    for (const double tip : {0.02, 1.0, 50.0}) {
        std::array<double, 2> worst_height{};
        const auto height = tip_mass::conical_heights(4, 1.0, tip);
        for (std::size_t run = 0; run < 2; ++run) {
            const Index size = run == 0 ? 300 : 600;
            const double step = 1 / static_cast<double>(size);
            const auto chain = support::chain_of(
                size, [&](Index m) { return revchain::plummet(m == 0 ? tip + step / 2 : step, step); });
            const auto m = revchain::modes(chain, {.count = 4});
            for (Index k = 0; k < 4; ++k) {
                worst_height[run] = std::max(worst_height[run], std::abs(m.conical_height[k] / height[k] - 1));
                const tip_mass::Mode mode(k + 1, 1.0, tip);
                CHECK(m.nodes()[static_cast<std::size_t>(k)].size() == mode.nodes().size());
                const double scale = m.shapes()(k, 0);
                for (Index pin = 0; pin <= size; pin += 50)
                    CHECK(std::abs(m.shapes()(k, pin) -
                                   scale * mode.shape(std::min(static_cast<double>(pin) * step, 1.0))) < 1e-3);
            }
        }
        CAPTURE(tip, worst_height);
        CHECK(worst_height[1] < 1e-4);  // measured 9.6e-5
        CHECK(std::log2(worst_height[0] / worst_height[1]) > 1.99);
    }
}

TEST_CASE("§4 with another density: the balance of forces, and many plummets", "[paper][section_4]") {
    // x^(p+1)/(p+1) dy/dx + (1/lambda) integral of s^p y ds = 0; s = x t^2
    double worst = 0;
    for (const double p : {-0.5, 0.5, 1.0, 3.0, 7.5}) {
        for (Index k = 1; k <= modes_tried; ++k) {
            const tapered_chain::Mode mode(k, 1.0, p);
            for (const double x : {0.1, 0.35, 0.8, 1.0}) {
                const double below = integral(0, 1, [&](double t) {
                    return 2 * (p + 1) * std::pow(t, 2 * p + 1) * mode.shape(std::min(x * t * t, x));
                });
                worst = std::max(worst, std::abs(mode.slope(x) * mode.conical_height() + below));
            }
        }
    }
    CAPTURE(worst * 1e15);
    CHECK(worst <= 8e-16);  // measured 6.7e-16

    for (const double p : {-0.5, 1.0, 4.0}) {
        std::array<double, 2> worst_height{};
        const auto height = tapered_chain::conical_heights(4, 1.0, p);
        for (std::size_t run = 0; run < 2; ++run) {
            const Index size = run == 0 ? 300 : 600;
            const double step = 1 / static_cast<double>(size);
            const auto below = [&](double x) { return std::pow(std::max(x, 0.0), p + 1); };
            const auto chain = support::chain_of(size, [&](Index m) {
                const double at = static_cast<double>(m) * step;
                return revchain::plummet(below(at + step / 2) - below(at - step / 2), step);
            });
            const auto m = revchain::modes(chain, {.count = 4});
            for (Index k = 0; k < 4; ++k)
                worst_height[run] = std::max(worst_height[run], std::abs(m.conical_height[k] / height[k] - 1));
        }
        CAPTURE(p, worst_height);
        CHECK(worst_height[1] < 7.5e-4);  // measured 7.1e-4 (p = -1/2), 9.8e-5, 8.4e-5
        CHECK(std::log2(worst_height[0] / worst_height[1]) >
              1.6);  // 1.64 where the density is infinite at the free end, else 2.00
    }
}

TEST_CASE("§4: a chain of many links tends to the continuous chain", "[paper][section_4]") {
    // Uniform rods: order 2 in the heights (coefficients: tests/cpp/limits/convergence_laws.cpp), nodes and vertical points.
    const Index count = 5;
    const auto height = heavy_chain::conical_heights(count, 1.0);
    std::array<double, 2> worst_height{}, worst_shape{}, worst_node{}, worst_vertical{};
    for (std::size_t run = 0; run < 2; ++run) {
        const Index size = run == 0 ? 400 : 800;
        const auto chain = revchain::Chain<double>::uniform_rods(size);
        const auto m = revchain::modes(chain, {.count = count});
        for (Index k = 0; k < count; ++k) {
            worst_height[run] = std::max(worst_height[run], std::abs(m.conical_height[k] / height[k] - 1));
            for (Index pin = 0; pin <= size; ++pin) {
                const double x = static_cast<double>(pin) / static_cast<double>(size);
                worst_shape[run] =
                    std::max(worst_shape[run], std::abs(m.shapes()(k, pin) - heavy_chain::shape(x, k + 1, 1.0)));
            }
            const auto nodes = heavy_chain::nodes(k + 1, 1.0), found = m.nodes()[static_cast<std::size_t>(k)];
            REQUIRE(found.size() == nodes.size());
            for (Index i = 0; i < k; ++i) worst_node[run] = std::max(worst_node[run], std::abs(found[i] - nodes[i]));

            // Vertical points: the slope, linear between the links' middles, changes sign.
            const auto points = heavy_chain::vertical_points(k + 1, 1.0);
            const auto difference = [&](Index link) { return m.shapes()(k, link) - m.shapes()(k, link + 1); };
            Index seen = 0;
            for (Index link = 0; link + 1 < size; ++link) {
                const double lower = difference(link), upper = difference(link + 1);
                if ((lower < 0) == (upper < 0)) continue;
                REQUIRE(seen < points.size());
                const double at =
                    (static_cast<double>(link) + 0.5 + lower / (lower - upper)) / static_cast<double>(size);
                worst_vertical[run] = std::max(worst_vertical[run], std::abs(at - points[seen++]));
            }
            CHECK(seen == points.size());
        }
    }
    const auto order = [](const std::array<double, 2>& error) { return std::log2(error[0] / error[1]); };
    CAPTURE(worst_height, worst_shape, worst_node, worst_vertical);
    CHECK(worst_height[1] < 8e-5);       // the law says 7.77e-5 for mode 5
    CHECK(worst_shape[1] < 5.5e-4);      // measured 5.1e-4
    CHECK(worst_node[1] < 1.7e-5);       // measured 1.61e-5
    CHECK(worst_vertical[1] < 1.75e-5);  // measured 1.67e-5
    CHECK(order(worst_height) > 1.99);
    CHECK(order(worst_node) > 1.99);
    CHECK(order(worst_vertical) > 1.99);
    CHECK(order(worst_shape) > 1.73);  // near the free end, where the pull vanishes: 1.85 at 50,000 rods, rising to 2
}
