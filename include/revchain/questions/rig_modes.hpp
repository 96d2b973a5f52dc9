// SPDX-License-Identifier: MPL-2.0
// Defines what rig_modes.hpp declares.
#pragma once

#include "revchain/linear/mode_shapes.hpp"
#include "revchain/linear/rig_roots.hpp"
#include "revchain/linear/rig_shape.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/mode_range.hpp"
#include "revchain/rig_modes.hpp"
// After revchain/modes.hpp, whose templates use `certify`: mode_certificate.hpp includes modes.hpp
// before it declares `certify`.
#include "revchain/questions/mode_certificate.hpp"

/// Finds the whirl modes of a rig in one of three ways. The modes of a rig that is a plain chain
/// are those of the chain. The modes of most other rigs are found by counts of the roots above a
/// shift (`modes_by_counts`). If counts cannot find the roots, all are found at once and proved in
/// disjoint discs (`modes_by_discs`). `modes`, near the end of this file, makes the choice.
namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns the requested mode numbers; fewer, or none, if fewer modes are available.
REVCHAIN_LAZY
ModeRange numbered(const RigModesOptions& options, Index available) {
    const Index count = options.count.value_or(default_count);
    if (options.first < 1) throw_invalid("modes", "first must be at least 1", options.first);
    if (count < 1) throw_invalid("modes", "count must be at least 1", count);
    return {options.first, std::clamp<Index>(available - options.first + 1, 0, count)};
}

/// Returns the mode numbers of one sense that the options request by numbers or a window.
REVCHAIN_LAZY
ModeRange chosen(const RigModesOptions& options, const RigRoots& roots, bool forward,
                 Index available) {
    if (!options.conical_height && !options.angular_speed) return numbered(options, available);
    const auto above = [&](const RigWord& x, double given) {
        return roots.above(x, forward, "modes", given);
    };
    return chosen(
        available, options, [&](double height) { return above(roots.at_height(height), height); },
        [&](double speed) { return above(roots.at_speed(speed), speed); });
}

REVCHAIN_LAZY
void make_room(WhirlModes& modes, const ModeRange& range, Index available) {
    modes.first = range.first, modes.available = available;
    for (Vector<double>* column : {&modes.conical_height, &modes.error_bound, &modes.angular_speed,
                                   &modes.speed_error_bound})
        column->resize(range.count);
}

/// Stores mode number j (from 0) of those found; returns whether it is proved.
REVCHAIN_LAZY
bool set_mode(WhirlModes& modes, Index j, const RigPencil& rig,
              const pencil::SignedPencil<RigWord>& pencil, const FoundRoot& root) {
    const RigWord height = pencil.quadratic ? root.unrounded * root.unrounded : root.unrounded;
    const RigWord speed = rig.pace / (pencil.quadratic ? root.unrounded : sqrt(root.unrounded));
    modes.conical_height[j] = std::ldexp(static_cast<double>(height), rig.units.length_exponent);
    modes.angular_speed[j] = static_cast<double>(speed);
    // `margin` bounds the error of the root x. The bound of x^2, or of sqrt(x), includes the
    // roundings of the height and of the speed.
    const double ulp = epsilon<double>();
    const double margin =
        root.error_bound * (1 + 4 * root.error_bound) + 32 * operation_error<RigWord>();
    double of_height = margin, of_speed = (margin / 2 + 0.76 * ulp) * (1 + margin);
    if (pencil.quadratic)
        of_speed = margin, of_height = (2 * margin + 1.51 * ulp) * (1 + 4 * margin);
    const bool proved = of_height < 1;
    if (!proved) of_height = of_speed = std::numeric_limits<double>::infinity();
    modes.error_bound[j] = of_height, modes.speed_error_bound[j] = of_speed;
    return proved;
}

/// Finds the modes of one sense by counts; returns whether all are proved.
REVCHAIN_LAZY
bool modes_of_sense_by_counts(WhirlModes& modes, const Rig& rig, const RigRoots& all_roots,
                              bool forward, const RigModesOptions& options, double from,
                              double to) {
    const RigPencil& pencil = all_roots.rig();
    const CountedSense& sense = all_roots.senses()[forward ? 0 : 1];
    const CountedRoots& roots = sense.roots;  // Clang 14 captures no structured binding
    const Index available = sense.available.count;
    const ModeRange range = chosen(options, all_roots, forward, available);
    make_room(modes, range, available);
    if (range.count == 0) return true;
    const double all = static_cast<double>(range.count);
    const double height = std::ldexp(rig.chain().total_length(), -pencil.units.length_exponent);
    const double guess = roots.pencil().quadratic ? std::sqrt(height) : height;
    const auto report = [&](double share, Index done, double of) {
        advance(options.progress,
                from + (to - from) * (share + of * static_cast<double>(done) / all));
    };
    const auto finished = [&](Index done) { report(0, done, 0.4); };
    bool proved = true;
    std::vector<RigWord> found;
    const auto store = [&]<bool Spins>(
                           const std::vector<FoundRoot>& stored,
                           std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements) {
        for (const FoundRoot& root : stored) {
            const auto j = static_cast<Index>(found.size());
            proved = set_mode(modes, j, pencil, roots.pencil(), root) && proved;
            found.push_back(root.unrounded);
        }
        ShapesBehind::of(modes) =
            shapes_when_read<double>(RigShapeFinder<Spins>{rig.chain(), pencil.idle, roots.pencil(),
                                                           std::move(found), std::move(elements)},
                                     options.threads);
    };
    const auto found_in_lanes = [&]<bool Spins>(std::bool_constant<Spins>) {
        auto elements = pencil::positive_elements<Spins>(roots.pencil());
        if (!elements) return false;
        std::optional<std::vector<FoundRoot>> found_roots;
        if constexpr (!Spins) found_roots = roots_under_a_spring(rig, *elements, range, available);
        if (!found_roots)
            found_roots = roots_in_lanes(*elements, roots, range, available, guess, finished);
        if (!found_roots) return false;
        using Elements = pencil::ElementPencil<RigWord, Spins>;
        store(*found_roots, std::make_shared<const Elements>(*std::move(elements)));
        return true;
    };
    if (pencil.stiffness_positive && pencil.mass_not_negative && pencil.rigid == 0 &&
        !pencil.pencil.has_joints())
        if (roots.pencil().quadratic ? found_in_lanes(std::true_type())
                                     : found_in_lanes(std::false_type()))
            return proved;
    store(refined_roots(roots, range.first - 1, range.count, guess, finished,
                        [&](Index done) { report(0.4, done, 0.6); }),
          std::shared_ptr<const pencil::ElementPencil<RigWord>>());
    return proved;
}

/// Throws InvalidArgument for a rig with dashpots, whose motions are those of `damped_modes`.
REVCHAIN_LAZY
void require_no_dashpots(std::string_view place, const Rig& rig) {
    if (rig.is_damped())
        throw_invalid(place, "a rig with dashpots has damped modes: damped_modes");
}

/// Returns the modes of a rig that is a plain chain.
REVCHAIN_LAZY
RigModes plain_modes(const Rig& rig, const RigModesOptions& options) {
    RigModes result;
    const Index available = rig.chain().mode_count();
    result.complete = true, result.method = RigMethod::modes;
    ModesOptions<double> of_chain{.first = options.first,
                                  .count = options.count,
                                  .conical_height = options.conical_height,
                                  .angular_speed = options.angular_speed,
                                  .rtol = options.rtol,
                                  .certify = options.certify,
                                  .gravity = options.gravity,
                                  .threads = options.threads,
                                  .progress = options.progress};
    if (!options.conical_height &&
        !options.angular_speed) {  // numbers beyond the last give no modes
        const ModeRange range = numbered(options, available);
        if (range.count == 0) {
            make_room(result.forward, range, available);
            return result;
        }
        of_chain.count = range.count;
    }
    const Modes<double> plain = modes(rig.chain(), of_chain);
    WhirlModes& found = result.forward;
    found.first = plain.first, found.available = available;
    found.conical_height = plain.conical_height, found.error_bound = plain.error_bound;
    found.angular_speed = plain.angular_speed(options.gravity);
    found.speed_error_bound = plain.error_bound.array() / 2 + 2 * epsilon<double>();
    found.certificate = plain.certificate, result.status = plain.status;
    ShapesBehind::of(found) = ShapesBehind::of(plain);
    return result;
}

/// Returns the solution of a height that is negative or complex, in the pencil's unit, and its
/// relative bound. The growth rate is the square root of -g/height with a positive real part.
REVCHAIN_LAZY
OtherMode other_mode_of_height(const RigPencil& rig, const std::complex<double>& x, double bound) {
    const std::complex<double> rate = static_cast<double>(rig.pace) / std::sqrt(-x);
    if (!(bound < 1)) bound = std::numeric_limits<double>::infinity();
    const auto in_unit = [&](double y) { return std::ldexp(y, rig.units.length_exponent); };
    return {
        {in_unit(x.real()), in_unit(x.imag())}, {rate.imag(), -rate.real()}, rate.real(), bound};
}

/// Finds modes by counts, in each direction.
REVCHAIN_LAZY
RigModes modes_by_counts(const Rig& rig, const RigRoots& roots, const RigModesOptions& options) {
    RigModes result;
    const RigPencil& pencil = roots.rig();
    result.has_momentum = roots.has_momentum(), result.method = RigMethod::counts;
    result.complete = pencil.stiffness_positive || pencil.stiffness_certain;
    const std::size_t senses = roots.senses().size();
    bool proved = true;
    for (std::size_t i = 0; i < senses; ++i) {
        const double share = 0.9 / static_cast<double>(senses),
                     from = share * static_cast<double>(i);
        WhirlModes& sense = i == 0 ? result.forward : result.backward;
        proved &= modes_of_sense_by_counts(sense, rig, roots, i == 0, options, from, from + share);
        result.complete &= roots.senses()[i].available.proved;
    }
    if (!roots.has_momentum())
        if (const auto negative = counted_negative_heights(pencil)) {
            const Index count = std::max<Index>(0, negative->available.count);
            const double start =
                std::ldexp(rig.chain().total_length(), -pencil.units.length_exponent);
            result.other_available = count;
            result.complete &= negative->available.proved;
            if (options.other && count > 0)
                for (const FoundRoot& root :
                     refined_roots(negative->roots, 0, count, start, {}, {})) {
                    const double height = -root.eigenvalue;
                    result.other.push_back(
                        other_mode_of_height(pencil, height, root.error_bound + 1e-30));
                    proved &= std::isfinite(result.other.back().error_bound);
                }
        }
    if (!proved || !result.complete) result.status = Status::tolerance_not_met;
    return result;
}

/// Finds modes from discs around all roots. It is for rigs whose roots cannot be found by counts.
REVCHAIN_LAZY
RigModes modes_by_discs(const Rig& rig, const RigRoots& roots, const RigModesOptions& options) {
    const RigPencil& pencil = roots.rig();
    const pencil::ComplexSpectrum& spectrum = *roots.spectrum();
    RigModes result;
    result.has_momentum = roots.has_momentum(), result.method = RigMethod::discs;
    result.complete = spectrum.proved;
    if (!spectrum.proved) result.status = Status::tolerance_not_met;
    std::vector<FoundRoot> forward, backward;
    for (const pencil::EnclosedRoot& root : spectrum.roots) {
        const double size = std::abs(root.value);
        double bound = std::numeric_limits<double>::infinity();
        if (spectrum.proved) bound = root.radius / size;
        // A root of 0 has no speed. So small a root counts as 0.
        if (!(size > 0x1p-200)) continue;
        if (root.is_real && (root.value.real() > 0 || result.has_momentum)) {
            const bool is_forward = root.value.real() > 0;
            // The mode is rounded from x, which may be half an ulp from the disc's centre.
            const RigWord x = is_forward ? root.x.real : -root.x.real;
            (is_forward ? forward : backward)
                .push_back({static_cast<double>(x), bound + 1.01 * epsilon<double>(), x});
        } else if (!result.has_momentum) {
            result.other.push_back(other_mode_of_height(pencil, root.value, bound));
        } else {
            const double unit = std::ldexp(1.0, pencil.units.length_exponent);
            // In double words: std::complex divides by less accurate rules in some libraries.
            const std::complex<double> height(root.x * root.x);
            const std::complex<double> speed(pencil::ComplexWord(pencil.pace) / root.x);
            result.other.push_back({height * unit, speed, std::abs(speed.imag()),
                                    2 * bound * (1 + bound) + 8 * epsilon<double>()});
        }
    }
    result.other_available = static_cast<Index>(result.other.size());
    const auto store = [&](WhirlModes& modes, const std::vector<FoundRoot>& found,
                           bool is_forward) {
        const auto available = static_cast<Index>(found.size());
        const ModeRange range = chosen(options, roots, is_forward, available);
        make_room(modes, range, available);
        auto sense = is_forward ? pencil.pencil : pencil.pencil.reversed();
        std::vector<RigWord> at;
        for (Index j = 0; j < range.count; ++j) {
            const FoundRoot& root = found[static_cast<std::size_t>(range.first - 1 + j)];
            set_mode(modes, j, pencil, sense, root);
            at.push_back(root.unrounded);
        }
        ShapesBehind::of(modes) = shapes_when_read<double>(
            RigShapeFinder<>{rig.chain(), pencil.idle, std::move(sense), std::move(at)},
            options.threads);
    };
    store(result.forward, forward, true);
    if (result.has_momentum) store(result.backward, backward, false);
    return result;
}

/// Returns the links with tension + n spin = 0 at a speed n no faster than the fastest mode found
/// in the direction of n.
REVCHAIN_LAZY
std::vector<SlackLink> slack_links(const Rig& rig, const RigModes& modes) {
    const auto fastest = [](const WhirlModes& sense) {
        return sense.size() == 0 ? 0.0 : sense.angular_speed.maxCoeff();
    };
    const double forward = fastest(modes.forward), backward = fastest(modes.backward);
    std::vector<SlackLink> slack;
    Index m = 0;
    for (const RigLink& link : rig_links(rig)) {
        const RigWord zero(0.0);
        if (!(link.spin == zero) && !(link.tension == zero)) {
            // negative if backward
            const double speed = static_cast<double>(-link.tension / link.spin);
            if (speed > 0 ? speed <= forward : -speed <= backward) slack.push_back({m, speed});
        }
        ++m;
    }
    std::stable_sort(slack.begin(), slack.end(), [](const SlackLink& x, const SlackLink& y) {
        return std::abs(x.angular_speed) < std::abs(y.angular_speed);
    });
    return slack;
}

}  // namespace detail

REVCHAIN_DEFINE
RigModes modes(const Rig& rig, const RigModesOptions& options) {
    using namespace detail;
    require_positive("modes", "gravity", options.gravity);
    check(options);
    const Threads used("modes", options.threads);
    require_no_dashpots("modes", rig);
    if (rig.is_plain_chain()) return plain_modes(rig, options);
    const RigRoots roots("modes", rig, options.gravity,
                         [&](double share) { advance(options.progress, 0.9 * share); });
    RigModes result;
    if (roots.rig().pencil.size() == 0) {  // nothing to whirl
        result.complete = true, result.method = RigMethod::counts;
        for (WhirlModes* sense : {&result.forward, &result.backward}) {
            // with no modes the direction does not matter, but the options are checked
            make_room(*sense, chosen(options, roots, true, 0), 0);
            ShapesBehind::of(*sense) = LazyModeShapes<double>(room_for_shapes(rig.chain(), 0));
        }
    } else if (roots.spectrum()) {
        result = modes_by_discs(rig, roots, options);
    } else {
        result = modes_by_counts(rig, roots, options);
    }
    result.rigid = roots.rig().rigid;
    const Index neutral = roots.rig().neutral;
    result.other_available += neutral;
    // Discs find the other solutions in any case; they are returned even if not requested.
    if (options.other || roots.spectrum())
        result.other.insert(result.other.begin(), static_cast<std::size_t>(neutral),
                            {{std::numeric_limits<double>::infinity(), 0.0}, 0.0, 0, 0});
    if (result.has_momentum) result.slack = slack_links(rig, result);
    for (const bool forward : {true, false}) {
        WhirlModes& sense = forward ? result.forward : result.backward;
        if (options.certify)
            certify(sense, sense.available, [&](double lower, double upper) {
                return std::array{roots.count(roots.at_height(lower), forward),
                                  roots.count(roots.at_height(upper), forward)};
            });
        if (options.rtol && sense.size() > 0 && !(sense.error_bound.maxCoeff() <= *options.rtol))
            result.status = Status::tolerance_not_met;
    }
    advance(options.progress, 1);
    return result;
}

REVCHAIN_INLINE RigModeCounter::RigModeCounter(const Rig& rig, double gravity) : gravity_(gravity) {
    detail::require_positive("count_modes", "gravity", gravity);
    detail::require_no_dashpots("count_modes", rig);
    if (rig.is_plain_chain())
        plain_ = std::make_shared<const ModeCounter<double>>(rig.chain());
    else
        roots_ =
            std::make_shared<const detail::RigRoots>("count_modes", rig, gravity, [](double) {});
}

REVCHAIN_INLINE Index RigModeCounter::above_height(double height) const {
    detail::require_positive("count_modes", "conical height", height);
    if (plain_) return plain_->above_height(height);
    const auto above = [&](bool forward) {
        return roots_->above(roots_->at_height(height), forward, "count_modes: conical height",
                             height);
    };
    return above(true) + (roots_->has_momentum() ? above(false) : 0);
}

REVCHAIN_INLINE Index RigModeCounter::below_speed(double angular_speed) const {
    if (!std::isfinite(angular_speed) || angular_speed == 0)
        detail::throw_invalid("count_modes", "angular speed must be finite and not 0",
                              angular_speed);
    if (plain_) return plain_->below_speed(std::abs(angular_speed), gravity_);
    // with momentum a negative speed counts the backward modes
    const bool forward = angular_speed > 0 || !roots_->has_momentum();
    return roots_->above(roots_->at_speed(angular_speed), forward, "count_modes: angular speed",
                         angular_speed);
}

REVCHAIN_DEFINE
Index count_modes(const Rig& rig, const CountOptions<double>& options) {
    detail::require_one_speed("count_modes", options);
    const RigModeCounter counter(rig, options.gravity);
    return options.conical_height ? counter.above_height(*options.conical_height)
                                  : counter.below_speed(*options.angular_speed);
}

}  // namespace revchain
