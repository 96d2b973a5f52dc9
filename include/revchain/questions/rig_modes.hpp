// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "revchain/linear/mode_shapes.hpp"
#include "revchain/linear/rig_counts.hpp"
#include "revchain/linear/rig_shapes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/spectrum.hpp"
#include "revchain/questions/mode_range.hpp"
#include "revchain/rig_modes.hpp"

namespace revchain {

namespace detail {

/// The range of mode numbers asked for of so many; fewer, or none, where there are not as many. How many there are of
/// a sense is told by the result.
inline ModeRange chosen(const ModesOptions<double>& options, Index available) {
    if (options.first < 1) throw_invalid("modes", "first must be at least 1", options.first);
    if (options.count && *options.count < 1) throw_invalid("modes", "count must be at least 1", *options.count);
    const Index left = std::max<Index>(0, available - options.first + 1);
    return {options.first, std::min(left, options.count.value_or(default_count))};
}

inline void make_room(WhirlModes& modes, const ModeRange& range, Index available) {
    modes.first = range.first, modes.available = available;
    for (Vector<double>* column :
         {&modes.conical_height, &modes.error_bound, &modes.angular_speed, &modes.speed_error_bound})
        column->resize(range.count);
}

/// Stores mode number j (from 0) of those found; false where nothing was proved of it.
inline bool set_mode(WhirlModes& modes, Index j, const RigPencil& rig, const pencil::SignedPencil<RigWord>& pencil,
                     const FoundRoot& root) {
    const RigWord height = pencil.quadratic ? root.x * root.x : root.x;
    const RigWord speed = rig.pace / (pencil.quadratic ? root.x : sqrt(root.x));
    modes.conical_height[j] = std::ldexp(static_cast<double>(height), rig.units.length_exponent);
    modes.angular_speed[j] = static_cast<double>(speed);
    // The margin is about what is given out; the other takes in half an ulp for each of the two roundings.
    const double ulp = epsilon<double>(), few = 32 * operation_error<RigWord>();
    const double margin = root.margin * (1 + 4 * root.margin) + few;
    double of_height = margin, of_speed = (margin / 2 + 0.76 * ulp) * (1 + margin);
    if (pencil.quadratic) of_speed = margin, of_height = (2 * margin + 1.51 * ulp) * (1 + 4 * margin);
    const bool proved = of_height < 1;
    modes.error_bound[j] = proved ? of_height : std::numeric_limits<double>::infinity();
    modes.speed_error_bound[j] = proved ? of_speed : std::numeric_limits<double>::infinity();
    return proved;
}

/// Finds the modes of one sense; reports progress from one share to another.
inline bool count_modes_of(WhirlModes& modes, const Rig& rig, const RigPencil& pencil, const CountedRoots& roots,
                           Index available, const ModesOptions<double>& options, double from, double to) {
    const ModeRange range = chosen(options, available);
    make_room(modes, range, available);
    if (range.count == 0) return true;
    const double all = static_cast<double>(range.count);
    const double height = std::ldexp(rig.chain().total_length(), -pencil.units.length_exponent);
    const double guess = roots.pencil().quadratic ? std::sqrt(height) : height;
    const auto finished = [&](Index done) {
        advance(options.progress, from + (to - from) * 0.4 * static_cast<double>(done) / all);
    };
    bool proved = true;
    std::vector<RigWord> found;
    const auto keep_shapes = [&](std::shared_ptr<const pencil::ElementPencil<RigWord>> elements) {
        modes.lazy_shapes = LazyModeShapes<double>(
            RigShapeFinder(rig, pencil.idle, roots.pencil(), std::move(elements), std::move(found), options.threads));
    };
    if (pencil.stiffness_positive && pencil.mass_not_negative)
        if (auto elements = pencil::positive_elements(roots.pencil())) {
            auto several = roots_under_a_spring(rig, *elements, range, available);
            if (!several) several = roots_in_lanes(*elements, roots, range, available, guess, finished);
            if (several) {
                for (Index j = 0; j < range.count; ++j) {
                    const FoundRoot& root = (*several)[static_cast<std::size_t>(j)];
                    proved = set_mode(modes, j, pencil, roots.pencil(), root) && proved;
                    found.push_back(root.x);
                }
                keep_shapes(std::make_shared<const pencil::ElementPencil<RigWord>>(*std::move(elements)));
                return proved;
            }
        }
    const auto brackets = roots.brackets(range.first - 1, range.count, guess, finished);
    for (Index j = 0; j < range.count; ++j) {
        const FoundRoot root = roots.refined(range.first - 1 + j, brackets[static_cast<std::size_t>(j)]);
        proved = set_mode(modes, j, pencil, roots.pencil(), root) && proved;
        found.push_back(root.x);
        advance(options.progress, from + (to - from) * (0.4 + 0.6 * static_cast<double>(j + 1) / all));
    }
    keep_shapes(nullptr);
    return proved;
}

/// As the chain's own modes, which they are.
inline RigModes plain_modes(const Rig& rig, const ModesOptions<double>& options) {
    RigModes result;
    const Index available = rig.chain().mode_count();
    const ModeRange range = chosen(options, available);
    make_room(result.forward, range, available);
    result.complete = true, result.method = "modes";
    if (range.count == 0) return result;
    const Modes<double> plain = modes(
        rig.chain(),
        ModesOptions<double>{
            .first = range.first, .count = range.count, .threads = options.threads, .progress = options.progress});
    result.forward = {range.first,
                      available,
                      plain.conical_height,
                      plain.error_bound,
                      plain.angular_speed(options.gravity),
                      plain.error_bound,
                      plain.lazy_shapes};
    for (double& bound : result.forward.speed_error_bound) bound = bound / 2 + 2 * epsilon<double>();
    result.status = plain.status;
    return result;
}

inline bool has_nothing(const Rig& rig) {
    for (Index m = 0; m < rig.size(); ++m)
        if (rig.stands(m) || !(rig.flywheel(m) == Flywheel{}) || rig.displaced(m).weight != 0 ||
            rig.displaced(m).added_weight != 0)
            return false;
    return rig.support().is_firm();
}

/// The mode of a height in the pencil's unit; the root of -g/height with a positive real part is the growth rate.
inline OtherMode other_height(const RigPencil& rig, const std::complex<double>& x, double relative_bound) {
    OtherMode mode;
    mode.conical_height = {std::ldexp(x.real(), rig.units.length_exponent),
                           std::ldexp(x.imag(), rig.units.length_exponent)};
    const std::complex<double> rate = static_cast<double>(rig.pace) / std::sqrt(-x);
    mode.growth_rate = rate.real();
    mode.angular_speed = {rate.imag(), -rate.real()};
    mode.error_bound = relative_bound < 1 ? relative_bound : std::numeric_limits<double>::infinity();
    return mode;
}

/// Heights below 0, all of them, by counts: base + sign (negative eigenvalues of Q(-x)) of them exceed x in size.
/// `known`: how many there are.
inline bool negative_heights(RigModes& result, const Rig& rig, const RigPencil& pencil, Index base, Index sign,
                             const std::optional<Index>& known, Index& count) {
    const CountedRoots roots(pencil.pencil, pencil.pace, base, sign, -1);
    const auto available = known ? CountedRoots::Available{*known, true} : roots.available();
    count = available.count;
    if (count <= 0) return available.proved;
    const double start = std::ldexp(rig.chain().total_length(), -pencil.units.length_exponent);
    const auto brackets = roots.brackets(0, count, start, [](Index) {});
    bool proved = available.proved;
    for (Index j = 0; j < count; ++j) {
        const FoundRoot root = roots.refined(j, brackets[static_cast<std::size_t>(j)]);
        result.other.push_back(other_height(pencil, -static_cast<double>(root.x), root.margin + 1e-30));
        proved = proved && std::isfinite(result.other.back().error_bound);
    }
    return proved;
}

/// Without momentum, where heights are real.
inline RigModes counted_heights(const Rig& rig, const RigPencil& pencil, const ModesOptions<double>& options) {
    RigModes result;
    result.method = "counts";
    // Where K > 0, heights above h are the negative eigenvalues of hK - M. Where M >= 0 those of K - mu M, mu = 1/h,
    // are these and besides as many as K has.
    const Index before = pencil.stiffness_positive ? 0 : pencil.not_positive;
    const CountedRoots roots(pencil.pencil, pencil.pace, -before, 1, 1);
    // Just above h = 0 the form hK - M is negative where there is inertia; elsewhere it has the signs of K.
    const MasslessForm& form = pencil.massless;
    const bool ranked = pencil.mass_not_negative && form.certain && form.zero == 0;
    const Index size = pencil.pencil.size();
    const auto available =
        ranked ? CountedRoots::Available{size - form.size + form.negative - before, true} : roots.available();
    const bool modes_proved = count_modes_of(result.forward, rig, pencil, roots, available.count, options, 0, 0.9);
    Index negative = 0;
    bool others_proved = true;
    if (options.other && pencil.stiffness_positive && !pencil.mass_not_negative)
        others_proved = negative_heights(result, rig, pencil, size, -1, std::nullopt, negative);
    else if (options.other && !pencil.stiffness_positive)
        others_proved =
            negative_heights(result, rig, pencil, before - pencil.neutral - size, 1,
                             ranked ? std::optional(before - pencil.neutral - form.negative) : std::nullopt, negative);
    result.complete = available.proved && others_proved && (pencil.stiffness_positive || pencil.stiffness_certain);
    if (!modes_proved || !result.complete) result.status = Status::tolerance_not_met;
    return result;
}

/// With momentum, K > 0 and M >= 0.
inline RigModes counted_speeds(const Rig& rig, const RigPencil& pencil, const ModesOptions<double>& options) {
    RigModes result;
    result.has_momentum = true, result.method = "counts", result.complete = true;
    for (const bool forward : {true, false}) {
        const CountedRoots roots(forward ? pencil.pencil : pencil.pencil.reversed(), pencil.pace, 0, 1, 1);
        // Just above x = 0 the form Q is negative where there is inertia; elsewhere it has the signs of G, and where
        // that is 0, too, those of K > 0 and of a square.
        const MasslessForm& form = pencil.massless;
        const Index negative = forward ? form.negative : form.size - form.zero - form.negative;
        const auto available = form.certain ? CountedRoots::Available{pencil.pencil.size() - form.size + negative, true}
                                            : roots.available();
        const bool proved = count_modes_of(forward ? result.forward : result.backward, rig, pencil, roots,
                                           available.count, options, forward ? 0 : 0.5, forward ? 0.5 : 1);
        result.complete = result.complete && available.proved;
        if (!proved || !available.proved) result.status = Status::tolerance_not_met;
    }
    return result;
}

/// Neither: all roots at once.
inline RigModes enclosed_modes(const Rig& rig, const RigPencil& pencil, const ModesOptions<double>& options) {
    if (pencil.pencil.size() > dense_rig_limit)
        throw_invalid(
            "modes",
            "a rig whose speeds may be complex (standing links with momentum, driven wheels, floats in a fluid that "
            "turns with them) is solved for at most " +
                std::to_string(dense_rig_limit) + " links and supports that yield",
            pencil.pencil.size());
    RigModes result;
    result.has_momentum = pencil.pencil.quadratic, result.method = "discs";
    // A massless coordinate has a root x = 0, and two where no momentum acts on it.
    const Index zeros = pencil.massless.size + (pencil.pencil.quadratic ? pencil.massless.zero : 0);
    const pencil::ComplexSpectrum spectrum =
        pencil::complex_spectrum(pencil.pencil, zeros, [&](double share) { advance(options.progress, 0.9 * share); });
    result.complete = spectrum.proved;
    if (!spectrum.proved) result.status = Status::tolerance_not_met;
    std::vector<FoundRoot> forward, backward;
    for (const pencil::EnclosedRoot& root : spectrum.roots) {
        const double size = std::abs(root.value),
                     bound = spectrum.proved ? root.radius / size : std::numeric_limits<double>::infinity();
        if (!(size > 0x1p-200)) continue;  // not proved, and no speed if it is 0
        if (root.is_real && (root.value.real() > 0 || result.has_momentum)) {
            const bool ahead = root.value.real() > 0;
            // What is given out is rounded from x, and may be half an ulp from the disc's centre.
            (ahead ? forward : backward)
                .push_back({ahead ? root.x.real : -root.x.real, bound + 1.01 * epsilon<double>()});
        } else if (options.other && !result.has_momentum) {
            result.other.push_back(other_height(pencil, root.value, bound));
        } else if (options.other) {
            const double unit = std::ldexp(1.0, pencil.units.length_exponent);
            // In double words: std::complex divides by less accurate rules in some libraries.
            const std::complex<double> height(root.x * root.x), speed(pencil::ComplexWord(pencil.pace) / root.x);
            result.other.push_back(
                {height * unit, speed, std::abs(speed.imag()), 2 * bound * (1 + bound) + 8 * epsilon<double>()});
        }
    }
    const auto store = [&](WhirlModes& modes, const std::vector<FoundRoot>& found, bool ahead) {
        const ModeRange range = chosen(options, static_cast<Index>(found.size()));
        make_room(modes, range, static_cast<Index>(found.size()));
        auto sense = ahead ? pencil.pencil : pencil.pencil.reversed();
        std::vector<RigWord> roots;
        for (Index j = 0; j < range.count; ++j) {
            const FoundRoot& root = found[static_cast<std::size_t>(range.first - 1 + j)];
            set_mode(modes, j, pencil, sense, root);
            roots.push_back(root.x);
        }
        modes.lazy_shapes = LazyModeShapes<double>(
            RigShapeFinder(rig, pencil.idle, std::move(sense), nullptr, std::move(roots), options.threads));
    };
    store(result.forward, forward, true);
    if (result.has_momentum) store(result.backward, backward, false);
    return result;
}

/// Where tension + n spin = 0 between n = 0 and the fastest speeds found.
inline std::vector<SlackLink> slack_links(const Rig& rig, const RigModes& modes) {
    const auto fastest = [](const WhirlModes& sense) {
        return sense.size() == 0 ? 0.0 : sense.angular_speed.maxCoeff();
    };
    const double ahead = fastest(modes.forward), back = fastest(modes.backward);
    std::vector<SlackLink> slack;
    Index m = 0;
    for (const RigLink& link : rig_links(rig)) {
        const RigWord zero(0.0);
        if (!(link.spin == zero) && !(link.tension == zero)) {
            const double speed = static_cast<double>(-link.tension / link.spin);
            if (speed > 0 ? speed <= ahead : -speed <= back) slack.push_back({m, speed});
        }
        ++m;
    }
    std::stable_sort(slack.begin(), slack.end(), [](const SlackLink& x, const SlackLink& y) {
        return std::abs(x.angular_speed) < std::abs(y.angular_speed);
    });
    return slack;
}

}  // namespace detail

REVCHAIN_INLINE RigModes modes(const Rig& rig, const ModesOptions<double>& options) {
    detail::require_positive("modes", "gravity", options.gravity);
    const detail::Threads used("modes", options.threads);
    if (options.conical_height || options.angular_speed)
        detail::throw_invalid("modes", "a window needs counts, which rigs do not have yet; give first and count");
    if (options.certify)
        detail::throw_invalid("modes", "certify needs counts, which rigs do not have yet; leave it out");
    if (detail::has_nothing(rig)) return detail::plain_modes(rig, options);
    const RigPencil pencil = rig_pencil(rig, options.gravity);
    RigModes result;
    if (pencil.pencil.size() == 0) {  // nothing to whirl
        result.complete = true, result.method = "counts";
        for (WhirlModes* sense : {&result.forward, &result.backward}) {
            detail::make_room(*sense, detail::chosen(options, 0), 0);
            sense->lazy_shapes = detail::LazyModeShapes<double>(detail::room_for_shapes(rig.chain(), 0));
        }
    } else if (pencil.pencil.quadratic)
        result = pencil.stiffness_positive && pencil.mass_not_negative ? detail::counted_speeds(rig, pencil, options)
                                                                       : detail::enclosed_modes(rig, pencil, options);
    else
        result = pencil.stiffness_positive || pencil.mass_not_negative ? detail::counted_heights(rig, pencil, options)
                                                                       : detail::enclosed_modes(rig, pencil, options);
    if (options.other)
        result.other.insert(result.other.begin(), static_cast<std::size_t>(pencil.neutral),
                            {{std::numeric_limits<double>::infinity(), 0.0}, 0.0, 0, 0});
    if (result.has_momentum) result.slack = detail::slack_links(rig, result);
    detail::advance(options.progress, 1);
    return result;
}

REVCHAIN_INLINE Index count_modes(const Rig&, const CountOptions<double>&) {
    detail::throw_invalid(
        "count_modes", "modes of a Rig cannot be counted yet; ask modes(rig), whose forward.available counts them all");
}

}  // namespace revchain
