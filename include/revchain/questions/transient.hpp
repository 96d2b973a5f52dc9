// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "revchain/linear/moved_support.hpp"
#include "revchain/numeric/turned.hpp"
#include "revchain/questions/driven_motions.hpp"
#include "revchain/questions/support_motion.hpp"
#include "revchain/transient.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// Does what `transient` says. Compiled where it is used.
template <int = 0>
class TransientMotion {
   public:
    using C = pencil::ComplexWord;
    using S = Wide<double>;
    using Complex = pencil::Complex;

    TransientMotion(const Rig& rig, const TransientOptions& options)
        : options_(options),
          moved_(moved_part(rig, options.motion.given == SupportMotion::Given::force &&
                                     !options.motion.time.empty())),
          support_moves_(!options.motion.time.empty() && moved_ != Moved::by_force),
          rig_(without_axial_moments(support_moves_ ? relative_rig(rig, moved_)
                                                    : relative_rig(rig, Moved::by_force))),
          pieces_(motion_pieces(place, options.motion)),
          motions_(rig_, options.gravity, support_moves_ ? moved_ : Moved::by_force),
          pace_(motions_.system().rig.pace),
          length_(std::ldexp(1.0, motions_.system().rig.units.length_exponent)),
          weight_(std::ldexp(1.0, motions_.system().rig.units.weight_exponent)) {
        for (const MotionPiece& each : pieces_) scaled_.push_back(scaled(each));
    }

    Transient found() {
        set_start();
        result_.end = options_.motion.time.empty() ? 0 : options_.motion.time.back();
        const auto rows = static_cast<Index>(options_.time.size());
        const Index pins = rig_.size() + 1;
        result_.offset.resize(rows, pins), result_.velocity.resize(rows, pins);
        result_.error_estimate.resize(rows);
        superpose();
        if (motions_.system().inertia && !(loss_ < 1e-9)) {
            const Transient sum = result_;
            motions_.system().momentum ? stepped<Complex>() : stepped<double>();
            const auto most = [](const Transient& of) { return of.error_estimate.maxCoeff(); };
            if (rows > 0 && is_sum_ && most(sum) <= most(result_)) result_ = sum;
        }
        return std::move(result_);
    }

    static constexpr std::string_view place = "transient";

   private:
    ScaledPiece scaled(const MotionPiece& piece) const {
        const double pace = static_cast<double>(pace_);
        ScaledPiece result{{}, S(piece.begin) * pace_};
        if (!support_moves_) {
            const double unit = weight_;
            result.load[0] = {piece.value / unit, piece.slope / (unit * pace), 0};
            return result;
        }
        const double once = length_ * pace, twice = once * pace;
        result.load[0] = {piece.value / twice, piece.slope / (twice * pace), 0};
        result.load[1] = {piece.velocity / once, piece.value / twice,
                          piece.slope / (2 * twice * pace)};
        return result;
    }
    /// Offsets or velocities of all pins relative to the support, in units of the pencil, as
    /// rotations.
    std::vector<C> rotations(const std::string& name, const Vector<Complex>& given, double support,
                             double unit) const {
        const Index links = rig_.size(), pins = links + 1;
        const bool yields = !rig_.support().is_firm();
        if (given.size() != 0 && given.size() != links && given.size() != pins)
            throw_invalid(place,
                          name +
                              " must have a number for each pin (the last, of the support, may "
                              "be left out), got",
                          given.size());
        Vector<Complex> y = Vector<Complex>::Zero(pins);
        if (given.size() == 0) {
            if (support_moves_) y.setConstant(support);
        } else {
            y.head(given.size()) = given;
            if (given.size() == links && support_moves_) y[links] = support;
        }
        for (Index m = 0; m < pins; ++m) {
            require_finite(place, name, y[m].real(), name, y[m].imag());
            if (!motions_.system().momentum && y[m].imag() != 0)
                throw_invalid(place, name + " must be real without momentum; it has", y[m].imag());
        }
        if (!yields && y[links] != Complex(support_moves_ ? support : 0.0))
            throw_invalid(
                place,
                "leave out the " + name + " of the support, which is firm or prescribed; it has",
                y[links].real());
        const auto idle = motions_.system().rig.idle;
        std::vector<C> q;
        const auto& joints = motions_.system().pencil().joints;
        for (std::size_t m = 0; m < joints.size(); ++m) {
            const auto pin = static_cast<Index>(m) + idle;
            // Double words keep a difference that is small beside the support's own offset.
            const auto word = [&](Index k, double less) {
                return C(S(y[k].real()) - S(less), S(y[k].imag()));
            };
            const bool support_itself = joints[m].lever == S(0.0);
            const C part = support_itself ? word(pin, support_moves_ ? support : 0.0)
                                          : word(pin, 0.0) - word(pin + 1, 0.0);
            const C scaled = part / C(S(unit));
            q.push_back(support_itself ? scaled : scaled / C(joints[m].lever));
        }
        return q;
    }
    void set_start() {
        for (double last = 0; const double t : options_.time) {
            require_finite(place, "time", t);
            if (t < 0) throw_invalid(place, "times must not be negative", t);
            if (t < last) throw_invalid(place, "times must ascend", t);
            last = t;
        }
        if (moved_ == Moved::by_force && rig_.support().is_firm())
            throw_invalid(place, "a force does not move a firm support: give a motion");
        const MotionPiece& first = pieces_.front();
        const double pace = static_cast<double>(pace_);
        q_ = rotations("offset", options_.offset, first.offset, length_);
        rate_ = rotations("velocity", options_.velocity, first.velocity, length_ * pace);
        motions_.split(q_, rate_);
    }
    /// The motion at a time within a piece, from the amplitudes at its beginning.
    struct State {
        std::vector<Complex> amplitude;
        std::array<Complex, 2> drift;  ///< offset and velocity in the pencil's units
    };
    State after(const State& begin, const ScaledPiece& piece, const S& h) const {
        State result = begin;
        const double step = static_cast<double>(h);
        for (std::size_t j = 0; j < motions_.motions.size(); ++j) {
            const auto& each = motions_.motions[j];
            const DoubleDouble angle(each.s.imag * h);
            const Complex exponential =
                std::exp(static_cast<double>(each.s.real * h)) * turned(angle);
            pencil::Polynomial<Complex> p{};
            for (std::size_t c = 0; c < 2; ++c)
                for (std::size_t k = 0; k < 3; ++k) p[k] += each.load[c] * piece.load[c][k];
            result.amplitude[j] =
                pencil::driven_amplitude(begin.amplitude[j], each.rate, step, exponential, p);
        }
        if (motions_.system().drifts) {
            const double f = piece.load[0][0] / motions_.whole,
                         slope = piece.load[0][1] / motions_.whole;
            auto& [y, v] = result.drift;
            y += step * (v + step * (f / 2 + step * slope / 6));
            v += step * (f + step * slope / 2);
        }
        return result;
    }
    /// Offsets and velocities of a state, relative to the support; sums of sizes.
    void put(const State& state, const ScaledPiece& piece, double step, Vector<Complex>& y,
             Vector<Complex>& v, double& size) const {
        const Index pins = rig_.size() + 1;
        const double pace = static_cast<double>(pace_);
        y = Vector<Complex>::Constant(pins, state.drift[0]);
        v = Vector<Complex>::Constant(pins, state.drift[1]);
        Vector<double> sizes = y.cwiseAbs();
        for (std::size_t j = 0; j < motions_.motions.size(); ++j) {
            const auto& each = motions_.motions[j];
            for (Index m = 0; m < pins; ++m) {
                const Complex part = each.shape[m] * state.amplitude[j];
                y[m] += motions_.counted(each, part),
                    v[m] += motions_.counted(each, part * each.rate);
                sizes[m] += each.times * std::abs(part);
            }
        }
        for (std::size_t c = 0; c < 2; ++c) {
            if (motions_.at_once[c].size() == 0) continue;
            const auto& p = piece.load[c];
            y += motions_.at_once[c] * (p[0] + step * (p[1] + step * p[2]));
            v += motions_.at_once[c] * (p[1] + 2 * step * p[2]);
        }
        y *= length_, v *= length_ * pace, size = sizes.maxCoeff() * length_;
    }
    void superpose() {
        State state{{}, motions_.drift};
        for (const auto& each : motions_.motions) state.amplitude.push_back(each.start);
        const auto rows = static_cast<Index>(options_.time.size());
        const double unit = 8 * epsilon<double>() + motions_.defect;
        double largest = 0, worst = 0, fastest = 0;
        for (const auto& each : motions_.motions) fastest = std::max(fastest, std::abs(each.rate));
        Vector<Complex> y, v;
        double size = 0;
        Index row = 0;
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            const MotionPiece& piece = pieces_[k];
            const bool is_last = k + 1 == pieces_.size();
            const auto at = [&](double t) {
                return after(state, scaled_[k], S(t) * pace_ - scaled_[k].begin);
            };
            if (k == 0) {
                if (motions_.system().inertia)  // nothing snaps; a sum of motions would lose digits
                    result_.start = motions_.offsets_of(q_) * length_;
                else
                    put(state, scaled_[0], 0, result_.start, v, size);
                add_support(piece, 0, result_.start, v);
                set_projected();
            }
            for (; row < rows; ++row) {
                const double t = options_.time[static_cast<std::size_t>(row)];
                if (!is_last && t >= pieces_[k + 1].begin) break;
                const double h = t - piece.begin;
                put(at(t), scaled_[k], h * static_cast<double>(pace_), y, v, size);
                largest = std::max(largest, y.cwiseAbs().maxCoeff());
                worst = std::max(worst, size);
                add_support(piece, h, y, v);
                result_.offset.row(row) = y.transpose(), result_.velocity.row(row) = v.transpose();
                if (!y.allFinite() || !v.allFinite())
                    throw_invalid(place, "the motion grows beyond all numbers before this time", t);
                const double turns = fastest * t * static_cast<double>(pace_);
                const double there = support_moves_ ? std::abs(piece.offset_after(h)) : 0;
                result_.error_estimate[row] =
                    (unit + 0x1p-96 * turns) * size + epsilon<double>() * there;
                advance(options_.progress, 0.5 + 0.5 * double(row + 1) / double(rows));
            }
            if (!is_last) state = at(pieces_[k + 1].begin);
        }
        set_sway(state);
        is_sum_ = motions_.all_found() &&
                  unit * motions_.cancelled(state.amplitude, result_.sway / length_) < 1e-9;
        loss_ = !is_sum_ ? 1 : largest > 0 ? unit * worst / largest : unit;
    }
    void add_support(const MotionPiece& piece, double h, Vector<Complex>& y,
                     Vector<Complex>& v) const {
        if (!support_moves_) return;
        y.array() += piece.offset_after(h), v.array() += piece.velocity_after(h);
    }
    void set_projected() {
        const Vector<Complex>& given = options_.offset;
        for (Index m = 0; m < given.size(); ++m)
            result_.projected = result_.projected || std::abs(given[m] - result_.start[m]) >
                                                         1e-9 * given.cwiseAbs().maxCoeff();
    }
    /// The motions after the end, with amplitudes for shapes whose largest offset is 1.
    void set_sway(const State& state) {
        result_.sway = motions_.largest_deflections(state.amplitude) * length_;
        std::vector<std::size_t> moving;
        for (std::size_t j = 0; j < motions_.motions.size(); ++j)
            if (motions_.motions[j].rate != Complex(0.0)) moving.push_back(j);
        const auto count = static_cast<Index>(moving.size());
        result_.exponent.resize(count), result_.amplitude.resize(count);
        result_.shape.resize(count, rig_.size() + 1);
        for (Index i = 0; i < count; ++i) {
            const std::size_t j = moving[static_cast<std::size_t>(i)];
            const auto& each = motions_.motions[j];
            Index place_of_largest = 0;
            each.shape.cwiseAbs().maxCoeff(&place_of_largest);
            const Complex largest = each.shape[place_of_largest];
            result_.exponent[i] = static_cast<Complex>(each.s * C(pace_));
            result_.shape.row(i) = (each.shape / largest).transpose();
            result_.amplitude[i] = state.amplitude[j] * largest * length_ * double(each.times);
        }
    }

    template <class T>
    static Vector<T> numbers(const std::vector<C>& words) {
        Vector<T> result(static_cast<Index>(words.size()));
        for (std::size_t m = 0; m < words.size(); ++m) {
            const auto z = static_cast<Complex>(words[m]);
            if constexpr (std::is_same_v<T, double>)
                result[static_cast<Index>(m)] = z.real();
            else
                result[static_cast<Index>(m)] = z;
        }
        return result;
    }
    /// Goes through all times by matrix exponentials, twice: then in half steps, with matrices that
    /// differ by roundings.
    template <class T>
    void stepped() {
        const auto n = static_cast<Index>(motions_.size());
        Matrix<T> load(n, 2);
        for (Index c = 0; c < 2; ++c)
            load.col(c) = numbers<T>(motions_.loads()[static_cast<std::size_t>(c)]);
        pencil::DampedMatrices matrices(motions_.system().pencil());
        pencil::SteppedMotion<T> whole(matrices, load);
        for (Matrix<double>* each : {&matrices.K, &matrices.C, &matrices.G, &matrices.M})
            for (Index i = 0; i < n; ++i)
                for (Index j = 0; j < n; ++j)
                    (*each)(i, j) *= 1 + double((i + j) % 3 - 1) * epsilon<double>();
        pencil::SteppedMotion<T> half(matrices, load);
        Vector<T> begin(2 * n);
        begin << numbers<T>(q_), numbers<T>(rate_);
        const auto rows = static_cast<Index>(options_.time.size());
        std::array<Vector<T>, 2> state{begin, begin};
        const double pace = static_cast<double>(pace_);
        Index row = 0;
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            const bool is_last = k + 1 == pieces_.size();
            double now = pieces_[k].begin;
            const auto go = [&](double t) {
                if (t == now) return;
                const double h = (t - now) * pace, from = (now - pieces_[k].begin) * pace;
                state[0] = whole.after(state[0], h, scaled_[k].shifted(from));
                for (const double part : {0.0, 0.5})
                    state[1] = half.after(state[1], h / 2, scaled_[k].shifted(from + part * h));
                now = t;
            };
            for (; row < rows; ++row) {
                const double t = options_.time[static_cast<std::size_t>(row)];
                if (!is_last && t >= pieces_[k + 1].begin) break;
                go(t);
                Vector<Complex> y = pins_of(state[0], 0), v = pins_of(state[0], n) * pace;
                const Vector<Complex> other = pins_of(state[1], 0);
                result_.error_estimate[row] =
                    2 * (y - other).cwiseAbs().maxCoeff() +
                    (0x1p-48 + whole.rounding(t * pace)) * y.cwiseAbs().maxCoeff();
                add_support(pieces_[k], t - pieces_[k].begin, y, v);
                result_.offset.row(row) = y.transpose(), result_.velocity.row(row) = v.transpose();
            }
            if (!is_last) go(pieces_[k + 1].begin);
        }
        if (is_sum_) return;
        result_.in_modes = false;
        result_.amplitude.setConstant(std::numeric_limits<double>::quiet_NaN());
        sample_sway(begin, half);
    }
    /// Sets the largest offsets at 400 instants of three turns of the slowest motion.
    template <class T>
    void sample_sway(const Vector<T>& begin, pencil::SteppedMotion<T>& steps) {
        const double pace = static_cast<double>(pace_);
        Vector<T> state = begin;
        for (std::size_t k = 0; k + 1 < pieces_.size(); ++k)
            state = steps.after(state, (pieces_[k + 1].begin - pieces_[k].begin) * pace,
                                scaled_[k].shifted(0));
        double slowest = std::numeric_limits<double>::infinity();
        for (const auto& each : motions_.motions)
            if (each.rate != Complex(0.0)) slowest = std::min(slowest, std::abs(each.rate));
        if (!std::isfinite(slowest)) slowest = 1;
        const std::vector<pencil::Polynomial<double>> none(2);
        result_.sway = deflections(pins_of(state, 0)).cwiseAbs();
        for (int i = 0; i < 400; ++i) {
            state = steps.after(state, 20 / slowest / 400, none);
            result_.sway = result_.sway.cwiseMax(deflections(pins_of(state, 0)).cwiseAbs());
        }
    }
    /// Offsets of all pins of the rotations that begin at `from`, in units of length.
    template <class T>
    Vector<Complex> pins_of(const Vector<T>& state, Index from) const {
        std::vector<C> q;
        for (std::size_t m = 0; m < motions_.size(); ++m)
            q.emplace_back(Complex(state[from + static_cast<Index>(m)]));
        return motions_.offsets_of(q) * length_;
    }

    const TransientOptions& options_;
    Moved moved_;
    bool support_moves_;
    Rig rig_;
    std::vector<MotionPiece> pieces_;
    DrivenMotions<> motions_;
    S pace_;
    double length_, weight_;
    std::vector<ScaledPiece> scaled_;
    std::vector<C> q_, rate_;
    double loss_ = 0;      ///< estimated error over the largest offset
    bool is_sum_ = false;  ///< whether the motion since the end is a sum of motions
    Transient result_;
};

}  // namespace detail

REVCHAIN_DEFINE
Transient transient(const Rig& rig, const TransientOptions& options) {
    detail::require_positive("transient", "gravity", options.gravity);
    if (rig.size() > 1000)
        detail::throw_invalid(
            "transient", "with dashpots or a moving support there may be at most 1000 links",
            rig.size());
    if (rig.support().radius != 0)
        detail::throw_invalid("transient",
                              "the support is carried round: use response; its radius is",
                              rig.support().radius);
    if (rig.fluid() == Fluid::turning)
        detail::throw_invalid("transient",
                              "a rig moves in a fluid at rest, not in one that turns");
    return detail::TransientMotion<>(rig, options).found();
}

}  // namespace revchain
