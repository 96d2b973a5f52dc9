// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <string>

#include "revchain/linear/mode_shape.hpp"
#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/turned.hpp"
#include "revchain/system/converted.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Products of offsets, from the free end up, with the matrices K and M of a pencil.
template <class Pencil>
class PencilForms {
   public:
    using Element = typename decltype(Pencil::elements)::value_type;
    using S = decltype(Element::stiffness);

    explicit PencilForms(Pencil pencil) : pencil_(std::move(pencil)) {}
    const Pencil& pencil() const { return pencil_; }
    template <class Offsets>
    S inertia(const Offsets& x, const Offsets& y) const {
        const S *u = x.data(), *v = y.data();
        return sum([&](const Element& e, std::size_t m) {
            return u[m] * (e.lower * v[m] + e.cross * v[m + 1]) +
                   u[m + 1] * (e.cross * v[m] + e.upper * v[m + 1]);
        });
    }
    template <class Offsets>
    S stiffness(const Offsets& x, const Offsets& y) const {
        const S *u = x.data(), *v = y.data();
        return sum([&](const Element& e, std::size_t m) {
            return e.stiffness * (u[m] - u[m + 1]) * (v[m] - v[m + 1]);
        });
    }
    /// Returns the flexibility_m in |y_m|^2 <= flexibility_m y^T K y. Every stiffness must be
    /// positive.
    Vector<double> flexibility() const {
        Vector<double> result = Vector<double>::Zero(pencil_.size() + 1);
        for (Index m = pencil_.size(); m-- > 0;)
            result[m] = result[m + 1] + (1 + 1e-14) / static_cast<double>(element(m).stiffness);
        return result;
    }

   protected:
    const Element& element(Index m) const { return pencil_.elements[static_cast<std::size_t>(m)]; }
    template <class F>
    S sum(const F& f) const {
        S total(0.0);
        for (std::size_t m = 0; m < pencil_.elements.size(); ++m)
            total = total + f(pencil_.elements[m], m);
        return total;
    }

   private:
    Pencil pencil_;
};

/// A chain in double-double. Its matrices are assembled only in `relaxed`.
class OscillatingChain : public PencilForms<pencil::ElementPencil<DoubleDouble>> {
   public:
    using Offsets = Vector<S>;

    explicit OscillatingChain(const Chain<double>& chain) : OscillatingChain(converted<S>(chain)) {}
    explicit OscillatingChain(const Chain<S>& chain) : OscillatingChain(assemble(chain)) {
        require_one_weight_unit("swing", chain);
    }
    explicit OscillatingChain(AssembledChain<S> assembled)
        : PencilForms(std::move(assembled.pencil)), units_(assembled.units) {}
    const ChainUnits& units() const { return units_; }
    Index size() const { return pencil().size(); }

    /// Returns a bound on the norm of (height K - M) y in the inverse of K, divided by the height.
    double residual(const S& height, const Offsets& y) const {
        S energy;
        const std::vector<S> offset(y.begin(), y.end());
        const double size = static_cast<double>(residual_size(pencil(), height, offset, &energy));
        return size * std::sqrt(energy.high()) * (1 + 1e-10);
    }
    /// Returns the offsets with the same M y and the least y^T K y: parts without inertia are in
    /// equilibrium. (h K + M) y' = M y is solved repeatedly, with h small beside the least conical
    /// height. `change` is the size of the last correction, many times the one left out.
    Offsets relaxed(const Offsets& given, const S& h, double& change) const {
        const Index n = size();
        Offsets diagonal = Offsets::Zero(n + 1), off = diagonal, at = diagonal;
        for (Index m = 0; m < n; ++m) {
            const S spring = h * element(m).stiffness;
            diagonal[m] += spring + element(m).lower;
            off[m] = element(m).cross - spring;
            diagonal[m + 1] += spring + element(m).upper;
        }
        for (Index m = 1; m < n; ++m) diagonal[m] -= off[m - 1] * (off[m - 1] / diagonal[m - 1]);
        for (int i = 0; i < 4; ++i) {
            const Offsets missing = given - at;
            Offsets right = Offsets::Zero(n + 1), step = right;
            for (Index m = 0; m < n; ++m) {
                const Element& e = element(m);
                right[m] += e.lower * missing[m] + e.cross * missing[m + 1];
                right[m + 1] += e.cross * missing[m] + e.upper * missing[m + 1];
            }
            for (Index m = 1; m < n; ++m) right[m] -= off[m - 1] * (right[m - 1] / diagonal[m - 1]);
            for (Index m = n; m-- > 0;) step[m] = (right[m] - off[m] * step[m + 1]) / diagonal[m];
            at += step;
            change = std::sqrt(std::max(0.0, stiffness(step, step).high()));
        }
        return at;
    }

   private:
    ChainUnits units_;
};

/// The modes of a start. Offsets are the sum of amplitude shape exp(i speed t), or its real part.
struct Superposition {
    double rounding;  ///< error of a sum, in 2^-53 of the largest sum of |amplitude shape|
    double at_once;   ///< error that a residual causes at time 0, over the residual
    std::vector<DoubleDouble> speed{};
    std::vector<std::complex<double>> amplitude{};
    std::vector<double> size{};        ///< upper bound of each amplitude's size
    std::vector<double> unbalanced{};  ///< that times the residual
    Vector<double> reached{};          ///< bound of the sum of |amplitude shape| at each pin

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

/// The part of a start that the modes used do not have. It keeps its energy.
struct LeftOut {
    double size;                 ///< bound of the square root of twice that energy
    Vector<double> flexibility;  ///< |y_m|^2 <= flexibility_m y^T K y
    int exponent;                ///< of 2, the unit of energies
};

/// Fills in offsets and velocities at each time, the bound of their errors, and what is left out.
/// Offsets are complex if the motion is in both horizontal directions.
template <class Result, class Options>
void superpose(Result& result, const Superposition& modes, const LeftOut& rest,
               const Options& options) {
    const std::vector<double>& time = options.time;
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
        advance(options.progress,
                0.5 + 0.5 * static_cast<double>(i + 1) / static_cast<double>(times));
    }
}

/// Returns offsets and velocities at the start. The support's entry is 0 if it was left out and the
/// support does not yield. Throws InvalidArgument for invalid offsets, velocities, times or
/// gravity.
template <class Options>
auto checked_start(std::string_view place, Index links, bool yields, const Options& options) {
    const auto checked = [&](const std::string& name, const auto& given) {
        auto result = given;
        result.setZero(links + 1);
        if (given.size() != 0 && given.size() != links && given.size() != links + 1)
            throw_invalid(place,
                          name + " must have a number for each of the " +
                              std::to_string(links + 1) + " pins, the support's last or left out",
                          given.size());
        for (const auto& x : given)
            if (!std::isfinite(std::abs(x)))
                throw_invalid(place, name + " must be finite", std::abs(x));
        result.head(given.size()) = given;
        if (!yields && std::abs(result[links]) != 0)
            throw_invalid(place, name + " of the support must be 0", std::abs(result[links]));
        return result;
    };
    const std::array start{checked("offset", options.offset),
                           checked("velocity", options.velocity)};
    require_positive(place, "gravity", options.gravity);
    for (const double t : options.time)
        if (!std::isfinite(t)) throw_invalid(place, "times must be finite", t);
    return start;
}

REVCHAIN_LAZY
Index checked_count(std::string_view place, const std::optional<Index>& asked, Index all) {
    const Index count = asked.value_or(all);
    if (count >= 0 && count <= all) return count;
    throw_invalid(place, "count must be from 0 to " + std::to_string(all), count);
}

/// Returns the swing from a start by the requested modes; `all` is the number of modes. The
/// elements of `system` are the links and, if it yields, the support. `found(first, count)` returns
/// heights and shapes.
template <class Result, class Options, class Found>
Result superposed(std::string_view place, const OscillatingChain& system, const Options& options,
                  const Vector<double>& from, const Vector<double>& speed, Index all,
                  const Found& found) {
    using S = DoubleDouble;
    using Offsets = Vector<S>;
    const Index count = checked_count(place, options.count, all);
    const int length = system.units().length_exponent, weight = system.units().weight_exponent;
    const Index pins = from.size(), all_pins = system.size() + 1;  // one more below a spring
    Result result;
    result.start = from;
    Offsets rest = Offsets::Zero(all_pins), rest_speed = rest;
    rest.head(pins) = from.cast<S>(), rest_speed.head(pins) = speed.cast<S>();
    double left_over = 0, left_over_speed = 0;
    if (all < system.size()) {
        const double least = all == 0 ? 1 : std::ldexp(found(all, 1).conical_height[0], -length);
        const S h(1e-8 * least);
        rest = system.relaxed(rest, h, left_over);
        rest_speed = system.relaxed(rest_speed, h, left_over_speed);
        for (Index m = 0; m < pins; ++m) result.start[m] = rest[m].high();
        const double moved = (result.start - from).cwiseAbs().maxCoeff();
        result.projected = moved > 0x1p-50 * from.cwiseAbs().maxCoeff();
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
        const S cosine = system.inertia(shape, rest) / inertia;
        const S rate = system.inertia(shape, rest_speed) / inertia, sine = rate / frequency;
        rest -= shape * cosine, rest_speed -= shape * rate;
        for (Index m = 0; m < pins; ++m) result.shape(k, m) = shape[m].high();
        result.angular_frequency[k] = frequency.high();
        result.cosine[k] = cosine.high(), result.sine[k] = sine.high();
        const S energy = S(0.5) * (cosine * cosine + sine * sine) * inertia / height;
        result.energy[k] = std::ldexp(energy.high(), weight - length);
        parts.add(frequency, {result.cosine[k], -result.sine[k]}, system.residual(height, shape),
                  result.shape.row(k).transpose());
        advance(options.progress, 0.5 * static_cast<double>(k + 1) / static_cast<double>(count));
    }

    const auto root = [](const S& x) { return std::sqrt(std::max(0.0, x.high())); };
    const double left = root(system.stiffness(rest, rest)) + left_over;
    const double left_speed = root(system.inertia(rest_speed, rest_speed) / gravity);
    const double size = std::hypot(left, left_speed) * (1 + 1e-10);
    superpose(result, parts, LeftOut{size, system.flexibility(), weight - length}, options);
    return result;
}

}  // namespace detail
}  // namespace revchain
