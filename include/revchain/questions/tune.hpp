// SPDX-License-Identifier: MPL-2.0
// Defines what tune.hpp declares.
#pragma once

#include "revchain/linear/one_mode.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/zero_between.hpp"
#include "revchain/questions/tune_candidates.hpp"
#include "revchain/system/edit.hpp"
#include "revchain/tune.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Makes the chain with any value of the datum, and finds on which side of the wanted height its
/// mode is.
class Tuning {
   public:
    Tuning(const Chain<double>& chain, const TuneOptions& options, const Wide<double>& wanted)
        : chain_(chain), links_(links_of(chain)), options_(options), wanted_(wanted) {}

    Chain<double> with(double x) const {
        std::vector<Link<double>> links = links_;
        Link<double>& link = links[static_cast<std::size_t>(options_.link)];
        link = with_datum(link, options_.datum, x);
        return Chain<double>(links);
    }
    /// The number of heights that exceed the wanted one; absent if it is not proved.
    std::optional<Index> above(double x) const {
        const Pencils<double> pencils(with(x));
        const auto count = pencils.certified_count<1>({pencils.scaled(wanted_)});
        return count[0].proved ? std::optional<Index>(count[0].above) : std::nullopt;
    }
    /// Returns 1 if the mode's height exceeds the wanted one, -1 if not, 0 if neither is proved.
    int side(double x) const {
        const auto count = above(x);
        return !count ? 0 : *count >= options_.mode ? 1 : -1;
    }
    /// The mode's height; 0 if the chain has no such mode.
    double height(double x) const {
        const Chain<double> chain = with(x);
        if (chain.mode_count() < options_.mode) return 0;
        return modes(chain, {.first = options_.mode, .count = 1}).conical_height[0];
    }
    /// d ln(height)/d ln(datum).
    double slope(double x, double at) const {
        const Chain<double> chain = with(x);
        Modes<double> one;
        one.first = options_.mode;
        one.conical_height = Vector<double>::Constant(1, at);
        return sensitivity(chain, one).of(options_.datum).value(0, options_.link) * (x / at);
    }
    double wanted() const { return static_cast<double>(wanted_); }
    const Chain<double>& chain() const { return chain_; }
    const TuneOptions& options() const { return options_; }

   private:
    const Chain<double>& chain_;
    std::vector<Link<double>> links_;
    TuneOptions options_;
    Wide<double> wanted_;
};

struct TunedValue {
    double value, error_bound;
};

/// Returns the value at which the mode has the wanted height, between proved counts on both sides.
REVCHAIN_LAZY
TunedValue enclosed(const Tuning& tuning, double from, double to, int low_side) {
    const auto [low, high] = halved(from, to, [&](double x) { return -low_side * tuning.side(x); });
    const double value = low + (high - low) / 2;
    return {value, std::max(value - low, high - value)};
}

/// `explained` is true if some mode passes the wanted height within a millionth of a candidate,
/// that is, if proved counts on either side differ by one.
struct TuneCandidate {
    bool explained = false;
    std::optional<TunedValue> crossing{};  ///< of the mode asked for
};

REVCHAIN_LAZY
TuneCandidate classified(const Tuning& tuning, double x, double low, double high) {
    const double size = std::max(std::abs(x), (high - low) * 0x1p-60);
    for (double margin = 0x1p-52; margin < 2e-6; margin *= 8) {
        const double left = std::max(low, x - margin * size),
                     right = std::min(high, x + margin * size);
        const auto before = tuning.above(left), after = tuning.above(right);
        if (!before || !after || *before == *after) continue;
        if (std::abs(*before - *after) != 1) return {};
        if (std::max(*before, *after) != tuning.options().mode) return {true, {}};
        return {true, enclosed(tuning, left, right, *before > *after ? 1 : -1)};
    }
    return {};
}

/// The first weight from `from` towards `to` at which the mode has the wanted height. No such
/// weight lies within a logarithmic step of |ln(height/wanted)|/c, c the bound of
/// `weight_influence`. If Newton's step is below 5 per cent (after 60 rounds, below a factor e), a
/// point just beyond it is tried and the interval is bisected. `proved` is true if the search
/// covered the whole range.
struct TuneSearch {
    std::optional<TunedValue> found{};
    bool proved = false;
};

REVCHAIN_LAZY
TuneSearch search(const Tuning& tuning, double from, double to, Tuned& seen) {
    const int longest = 400 + static_cast<int>(20000 / tuning.chain().size());
    const double direction = to > from ? 1 : -1;
    double at = from;
    for (int round = 0; round < longest; ++round) {
        check_interrupt();
        const double height = tuning.height(at), away = std::log(height / tuning.wanted());
        seen.lowest_height = std::min(seen.lowest_height, height);
        seen.highest_height = std::max(seen.highest_height, height);
        if (height > 0 && std::abs(away) < 0.2) {  // a quarter beyond Newton's step
            const double slope = tuning.slope(at, height), newton = -away / slope;
            if (newton * direction >= 0 && std::abs(newton) < (round < 60 ? 0.05 : 1.0)) {
                const double beyond = at * std::exp(1.25 * newton + direction * 0x1p-48);
                const double end = direction > 0 ? std::min(beyond, to) : std::max(beyond, to);
                const int here = tuning.side(at), there = tuning.side(end);
                if (here != 0 && there != 0 && here != there) {
                    const double low = std::min(at, end), high = std::max(at, end);
                    return {enclosed(tuning, low, high, direction > 0 ? here : there), true};
                }
            }
        }
        if (at == to) return {std::nullopt, true};
        if (!(std::abs(away) > 1e-12)) return {};
        const double least = std::min(height, tuning.wanted());
        double next = to;
        if (height > 0) {
            const double whole = std::abs(std::log(to / at));
            if (!std::isfinite(whole)) return {};
            for (double step = whole;; step *= 0.75) {
                if (step < whole && !(step > 1e-15)) return {};
                next = step < whole ? at * std::exp(direction * step) : to;
                const auto [low, high] = std::minmax(at, next);
                const double c =
                    weight_influence(tuning.chain(), tuning.options().link, low, high, least);
                if (step * c <= std::abs(away) * (1 - 1e-6)) break;
            }
        } else {
            next = at * (direction > 0 ? 2 : 0.5);  // no such mode: step by a factor 2
            if ((next - to) * direction >= 0) next = to;
        }
        at = next;
    }
    return {};
}

}  // namespace detail

REVCHAIN_DEFINE
Tuned tune(const Chain<double>& chain, const TuneOptions& options) {
    using namespace detail;
    constexpr std::string_view place = "tune";
    require_one_speed(place, options);
    const Index size = chain.size();
    if (options.mode < 1 || options.mode > size)
        throw_invalid(place, "mode must be from 1 to " + std::to_string(size), options.mode);
    if (options.link < 0 || options.link >= size)
        throw_invalid(place, "link must be from 0, the lowest, to " + std::to_string(size - 1),
                      options.link);
    require_one_weight_unit(place, chain);
    using S = Wide<double>;
    S wanted(options.conical_height.value_or(0));
    if (options.angular_speed) {
        require_positive(place, "angular speed", *options.angular_speed, "gravity",
                         options.gravity);
        wanted = S(options.gravity) / S(*options.angular_speed) / S(*options.angular_speed);
    }
    require_positive(place, "conical height", wanted.high);
    Tuned result;
    const auto range =
        tune_range(place, chain, options.link, options.datum, options.low, options.high);
    result.present = range.present, result.low = range.low, result.high = range.high;
    const Tuning tuning(chain, options, wanted);
    std::vector<TunedValue> found;
    const auto distance = [&](double x) {
        const bool by_ratio = options.datum == Datum::weight;
        return std::abs(by_ratio ? std::log(x / range.start) : x - range.start);
    };
    bool proved = true;
    if (options.datum == Datum::weight) {
        for (const double end : {range.high, range.low}) {
            const TuneSearch one = search(tuning, range.start, end, result);
            if (one.found) found.push_back(*one.found);
            proved = proved && one.proved;
        }
    } else {
        for (const double x : tune_candidates(chain, options.link, options.datum, wanted)) {
            if (!(x >= range.low && x <= range.high)) continue;
            const TuneCandidate candidate = classified(tuning, x, range.low, range.high);
            if (candidate.crossing) found.push_back(*candidate.crossing);
            proved = proved && candidate.explained;
        }
        const int low_side = tuning.side(range.low), high_side = tuning.side(range.high);
        proved = proved && low_side != 0 && high_side != 0 &&
                 (low_side != high_side) == (found.size() % 2 == 1);
        result.complete = proved;
    }
    if (!found.empty()) {
        std::sort(found.begin(), found.end(),
                  [](const TunedValue& x, const TunedValue& y) { return x.value < y.value; });
        for (const TunedValue& one : found) result.values.push_back(one.value);
        const auto nearest = std::min_element(found.begin(), found.end(),
                                              [&](const TunedValue& x, const TunedValue& y) {
                                                  return distance(x.value) < distance(y.value);
                                              });
        result.status = TuneStatus::found;
        result.value = nearest->value, result.error_bound = nearest->error_bound;
        result.chain = tuning.with(nearest->value);
        return result;
    }
    result.status = proved ? TuneStatus::no_value : TuneStatus::undecided;
    constexpr int places = 32;
    for (int i = 0; i <= places; ++i) {
        const double share = static_cast<double>(i) / places;
        const auto between = [&](double x, double y) { return x * (1 - share) + y * share; };
        const double x = range.low > 0 && range.high > 10 * range.low
                             ? std::exp(between(std::log(range.low), std::log(range.high)))
                             : between(range.low, range.high);
        const double height = tuning.height(std::clamp(x, range.low, range.high));
        result.lowest_height = std::min(result.lowest_height, height);
        result.highest_height = std::max(result.highest_height, height);
    }
    return result;
}

}  // namespace revchain
