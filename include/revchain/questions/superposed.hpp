// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "revchain/linear/mode_shape.hpp"
#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/twisted.hpp"
#include "revchain/system/converted.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// K and M of a chain in double-double, never assembled but for `settled`.
class OscillatingChain {
   public:
    using S = DoubleDouble;
    using Offsets = Vector<S>;

    explicit OscillatingChain(const Chain<double>& chain) : OscillatingChain(assemble(converted<S>(chain))) {
        if (!pencil().units.empty())
            throw_invalid("swing", "weights must not be more than 1e123 apart", chain.total_weight());
    }
    explicit OscillatingChain(AssembledChain<S> assembled) : assembled_(std::move(assembled)) {}
    const pencil::ElementPencil<S>& pencil() const { return assembled_.pencil; }
    const ChainUnits& units() const { return assembled_.units; }
    Index size() const { return pencil().size(); }

    /// x^T M y and x^T K y, in the units of the chain.
    S inertia(const Offsets& x, const Offsets& y) const {
        S sum(0);
        each([&](const auto& e, Index m) {
            sum += x[m] * (e.lower * y[m] + e.cross * y[m + 1]) + x[m + 1] * (e.cross * y[m] + e.upper * y[m + 1]);
        });
        return sum;
    }
    S stiffness(const Offsets& x, const Offsets& y) const {
        S sum(0);
        each([&](const auto& e, Index m) { sum += e.stiffness * (x[m] - x[m + 1]) * (y[m] - y[m + 1]); });
        return sum;
    }
    /// Bound on the norm of (height K - M) y in the inverse of K, over the height: forces summed from the free end up
    /// are what the links carry, sum of force^2 / k. What rounding does to them is added.
    double residual(const S& height, const Offsets& y) const {
        const double unit = 0x1p-100;
        S inertial(0), pin(0);
        double size = 0, squares = 0, count = 16;
        each([&](const auto& e, Index m) {
            const S lower = e.lower * y[m] + e.cross * y[m + 1], upper = e.cross * y[m] + e.upper * y[m + 1];
            const S spring = height * e.stiffness * (y[m] - y[m + 1]);
            inertial += pin + lower;
            pin = upper;
            const double k = static_cast<double>(e.stiffness), h = static_cast<double>(height);
            const double l = std::abs(static_cast<double>(y[m])), u = std::abs(static_cast<double>(y[m + 1]));
            const double x = std::abs(static_cast<double>(e.cross)) + 2 * static_cast<double>(e.turning);
            size += static_cast<double>(e.lower) * l + x * (u + l) + static_cast<double>(e.upper) * u;
            const double entry = static_cast<double>(pencil().entry_error);
            const double force = std::abs(static_cast<double>(spring - inertial)) +
                                 (entry + unit * (count += 4)) * (size + h * k * (l + u));
            squares += force * force / k;
        });
        return std::sqrt(squares) / static_cast<double>(height) * (1 + 1e-10);
    }
    /// (K's flexibility at each pin) |y_m|^2 <= flexibility_m y^T K y.
    Vector<double> flexibility() const {
        Vector<double> result(size() + 1);
        result[size()] = 0;
        for (Index m = size(); m-- > 0;)
            result[m] = result[m + 1] + (1 + 1e-14) / static_cast<double>(element(m).stiffness);
        return result;
    }
    /// The offsets in which a chain with these is in equilibrium as far as it has no inertia: those of least y^T K y
    /// with the same M y. By (h K + M) y' = M y, repeated; h is small beside the least conical height. `change` is the
    /// size of the last correction, many times the one left out.
    Offsets settled(const Offsets& given, const S& h, double& change) const {
        Offsets result = given;
        const std::size_t n = static_cast<std::size_t>(size());
        std::vector<S> diagonal(n, S(0)), off(n, S(0));
        each([&](const auto& e, Index at) {
            const auto m = static_cast<std::size_t>(at);
            diagonal[m] += h * e.stiffness + e.lower;
            off[m] = e.cross - h * e.stiffness;
            if (m + 1 < n) diagonal[m + 1] += h * e.stiffness + e.upper;
        });
        for (std::size_t m = 1; m < n; ++m) diagonal[m] -= off[m - 1] * (off[m - 1] / diagonal[m - 1]);
        Offsets at = Offsets::Zero(size() + 1);
        for (int i = 0; i < 4; ++i) {
            const Offsets missing = given - at;
            std::vector<S> right(n, S(0));
            each([&](const auto& e, Index m) {
                right[static_cast<std::size_t>(m)] += e.lower * missing[m] + e.cross * missing[m + 1];
                if (m + 1 < size())
                    right[static_cast<std::size_t>(m) + 1] += e.cross * missing[m] + e.upper * missing[m + 1];
            });
            for (std::size_t m = 1; m < n; ++m) right[m] -= off[m - 1] * (right[m - 1] / diagonal[m - 1]);
            Offsets step = Offsets::Zero(size() + 1);
            for (std::size_t m = n; m-- > 0;)
                step[static_cast<Index>(m)] = (right[m] - off[m] * step[static_cast<Index>(m) + 1]) / diagonal[m];
            at += step;
            change = std::sqrt(std::max(0.0, static_cast<double>(stiffness(step, step))));
        }
        return at;
    }

   private:
    const pencil::Element<S>& element(Index m) const { return pencil().elements[static_cast<std::size_t>(m)]; }
    template <class F>
    void each(const F& f) const {
        for (Index m = 0; m < size(); ++m) f(element(m), m);
    }
    AssembledChain<S> assembled_;
};

/// exp(i angle) of a large angle, reduced in double-double.
inline std::complex<double> turned(const DoubleDouble& angle) {
    const DoubleDouble turn(6.283185307179586, 2.4492935982947064e-16);
    const DoubleDouble rest = angle - turn * DoubleDouble(std::nearbyint((angle / turn).high()));
    const double c = std::cos(rest.high()), s = std::sin(rest.high());
    return {c - s * rest.low(), s + c * rest.low()};
}

/// What the modes kept have of a start: offsets are the sum of amplitude shape exp(i speed t), or of
/// its real part.
struct Superposition {
    double rounding;  ///< what that does to a sum, in 2^-53 of the largest sum of |amplitude shape|
    double at_once;   ///< what a residual does, over it, besides what grows with time
    std::vector<DoubleDouble> speed{};
    std::vector<std::complex<double>> amplitude{};
    std::vector<double> size{};        ///< of each amplitude, at most
    std::vector<double> unbalanced{};  ///< that times the residual
    Vector<double> reached{};  ///< bound of the sum of |amplitude shape| at each pin

    void add(const DoubleDouble& turns, const std::complex<double>& part, double residual,
             const Eigen::Ref<const Vector<double>>& shape) {
        speed.push_back(turns);
        amplitude.push_back(part);
        size.push_back(std::abs(part) * (1 + 1e-15));
        unbalanced.push_back(std::max(size.back(), 1e-300) * residual);
        if (reached.size() == 0) reached = Vector<double>::Zero(shape.size());
        reached += 1.5 * size.back() * shape.cwiseAbs();
    }
};

/// What the modes kept lack of a start. It moves by itself, and keeps its energy.
struct LeftOut {
    double size;                 ///< bound of the square root of twice that energy
    Vector<double> flexibility;  ///< |y_m|^2 <= flexibility_m y^T K y
    int exponent;                ///< of 2, the unit of energies
};

/// Fills in offsets and velocities at each time, complex where they are in both level directions,
/// the bound of their errors and what is left out.
template <class Result>
void superpose(Result& result, const Superposition& modes, const LeftOut& rest,
               const std::vector<double>& time, Progress* progress) {
    using Number = typename decltype(result.offset)::Scalar;
    constexpr std::size_t planes = sizeof(Number) / sizeof(double);
    const auto times = static_cast<Index>(time.size()), pins = result.shape.cols();
    for (auto* table : {&result.offset, &result.velocity}) table->resize(times, pins);
    result.error_bound.resize(times);
    using Sums = std::array<CompensatedSum<double>, 2 * planes>;
    std::vector<Sums> sums(static_cast<std::size_t>(pins));
    result.truncation_error = rest.size * rest.flexibility.head(pins).cwiseSqrt();
    result.energy_left_out = std::ldexp(rest.size * rest.size / 2, rest.exponent);
    const double reach = std::sqrt(rest.flexibility[0]) * (1 + 1e-10);
    const double largest = modes.speed.empty() ? 0 : modes.reached.maxCoeff();
    for (Index i = 0; i < times; ++i) {
        const DoubleDouble now(time[static_cast<std::size_t>(i)]);
        std::fill(sums.begin(), sums.end(), Sums{});
        double bound = modes.rounding * 0x1p-53 * largest;
        for (std::size_t k = 0; k < modes.speed.size(); ++k) {
            const DoubleDouble angle = modes.speed[k] * now;
            const double turns = std::abs(angle.high()), n = modes.speed[k].high();
            const std::complex<double> y = modes.amplitude[k] * turned(angle);
            const std::array<double, 4> part{y.real(), -n * y.imag(), y.imag(), n * y.real()};
            bound += modes.size[k] * turns * 0x1p-96;
            bound += reach * modes.unbalanced[k] * (modes.at_once + 2 * turns);
            const double* shape = result.shape.row(static_cast<Index>(k)).data();
            for (std::size_t m = 0; m < sums.size(); ++m)
#pragma GCC unroll 4
                for (std::size_t p = 0; p < 2 * planes; ++p) sums[m][p].add(part[p] * shape[m]);
        }
        for (Index pin = 0; pin < pins; ++pin) {
            const auto& sum = sums[static_cast<std::size_t>(pin)];
            if constexpr (planes == 1) {
                result.offset(i, pin) = sum[0].value(), result.velocity(i, pin) = sum[1].value();
            } else {
                result.offset(i, pin) = {sum[0].value(), sum[2].value()};
                result.velocity(i, pin) = {sum[1].value(), sum[3].value()};
            }
        }
        result.error_bound[i] = bound * (1 + 1e-10);
        advance(progress, 0.5 + 0.5 * static_cast<double>(i + 1) / static_cast<double>(times));
    }
}

/// A start as it was given, with the support's 0 where that was left out and does not yield.
template <class Number>
Vector<Number> checked_start(std::string_view place, Index links, bool yields, std::string_view name,
                             const Vector<Number>& given) {
    if (given.size() == 0) return Vector<Number>::Zero(links + 1);
    if (given.size() != links && given.size() != links + 1)
        throw_invalid(place,
                      std::string(name) + " must have a number for each of the " + std::to_string(links + 1) +
                          " pins, the support's last or left out",
                      given.size());
    for (const Number& x : given)
        if (!std::isfinite(std::abs(x))) throw_invalid(place, std::string(name) + " must be finite", std::abs(x));
    Vector<Number> result = Vector<Number>::Zero(links + 1);
    result.head(given.size()) = given;
    if (!yields && result[links] != Number(0))
        throw_invalid(place, std::string(name) + " of the support must be 0", std::abs(result[links]));
    return result;
}

/// Throws InvalidArgument for times and gravity that cannot be.
inline void check_times(std::string_view place, const std::vector<double>& time, double gravity) {
    require_positive(place, "gravity", gravity);
    for (const double t : time)
        if (!std::isfinite(t)) throw_invalid(place, "times must be finite", t);
}

/// How many of `all` modes are asked for.
inline Index checked_count(std::string_view place, const std::optional<Index>& asked, Index all) {
    const Index count = asked.value_or(all);
    if (count < 0 || count > all) throw_invalid(place, "count must be from 0 to " + std::to_string(all), count);
    return count;
}

/// The sum of `count` of `all` modes. The links and, if that yields, the support are the elements of `system`;
/// `found(first, count)` has their heights and shapes.
template <class Result, class Options, class Found>
Result superposed(const OscillatingChain& system, const Options& options, const Vector<double>& from,
                  const Vector<double>& speed, Index count, Index all, const Found& found) {
    using S = DoubleDouble;
    using Offsets = Vector<S>;
    const int length = system.units().length_exponent, weight = system.units().weight_exponent;
    const Index pins = from.size(), all_pins = system.size() + 1;  // what a support that yields is on, too
    Result result;
    result.start = from;
    Offsets rest = Offsets::Zero(all_pins), rest_speed = rest;
    rest.head(pins) = from.cast<S>(), rest_speed.head(pins) = speed.cast<S>();
    double unsettled = 0, unsettled_speed = 0;
    if (all < system.size()) {
        const double least = all == 0 ? 1 : std::ldexp(found(all, 1).conical_height[0], -length);
        const S h(1e-8 * least);
        rest = system.settled(rest, h, unsettled), rest_speed = system.settled(rest_speed, h, unsettled_speed);
        for (Index m = 0; m < pins; ++m) result.start[m] = static_cast<double>(rest[m]);
        result.projected = (result.start - from).cwiseAbs().maxCoeff() > 0x1p-50 * from.cwiseAbs().maxCoeff();
    }

    const S gravity = ldexp(S(options.gravity), -length);
    Superposition parts{10, 8.0 / 3};
    const auto modes = found(1, count);
    result.shape.resize(count, pins);
    for (auto* column : {&result.angular_frequency, &result.energy, &result.cosine, &result.sine})
        column->resize(count);
    Vector<double> rough = Vector<double>::Zero(all_pins);
    for (Index k = 0; k < count; ++k) {
        rough.head(pins) = modes.shapes().row(k).transpose();
        const S height = pencil::rayleigh_quotient(system.pencil(), rough);
        const Offsets shape = pencil::eigenvector(system.pencil(), height).offset;
        const S inertia = system.inertia(shape, shape), frequency = sqrt(gravity / height);
        const S cosine = system.inertia(shape, rest) / inertia, rate = system.inertia(shape, rest_speed) / inertia;
        const S sine = rate / frequency;
        rest -= shape * cosine, rest_speed -= shape * rate;
        for (Index m = 0; m < pins; ++m) result.shape(k, m) = static_cast<double>(shape[m]);
        result.angular_frequency[k] = static_cast<double>(frequency);
        result.cosine[k] = static_cast<double>(cosine), result.sine[k] = static_cast<double>(sine);
        result.energy[k] = std::ldexp(static_cast<double>(S(0.5) * (cosine * cosine + sine * sine) * inertia / height),
                                      weight - length);
        parts.add(frequency, {result.cosine[k], -result.sine[k]}, system.residual(height, shape),
                  result.shape.row(k).transpose());
        advance(options.progress, 0.5 * static_cast<double>(k + 1) / static_cast<double>(count));
    }

    const double left = std::sqrt(std::max(0.0, static_cast<double>(system.stiffness(rest, rest)))) + unsettled;
    const double left_speed =
        std::sqrt(std::max(0.0, static_cast<double>(system.inertia(rest_speed, rest_speed) / gravity)));
    const double size = std::hypot(left, left_speed) * (1 + 1e-10);
    const LeftOut lacking{size, system.flexibility(), weight - length};
    superpose(result, parts, lacking, options.time, options.progress);
    return result;
}

}  // namespace detail

}  // namespace revchain
