// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "revchain/count.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Whether a model can answer; if not, `reason` is a string literal that says why.
struct Fit {
    bool applies = true;
    std::string_view reason{};

    static Fit no(std::string_view why) { return {false, why}; }
};

namespace models {

using revchain::detail::segment_size;

/// The modes whose conical heights are requested, and the relative tolerance of each height; 0
/// means full accuracy.
struct Question {
    Index first = 1;  ///< number of the slowest mode wanted, from 1
    Index count = 1;
    double rtol = 0;
    double inclination =
        0;  ///< rad, below pi/2: of the lowest link of the shape that grows out of the mode
    Progress* progress = nullptr;
    bool proved = false;  ///< whether only models whose bounds are proved by counts may answer
    /// The pencils of the chain, assembled when first needed; null if each model assembles its own.
    revchain::detail::LazyCounter<double>* assembled = nullptr;

    Index last() const { return first - 1 + count; }
};

/// Heights and bounds of their relative errors.
struct Answer {
    Vector<double> conical_height;
    Vector<double> error_bound;
    bool found = true;  ///< false where the model turned out to have no answer
    Vector<double>
        conical_height_low{};  ///< exact heights minus `conical_height`; empty if not known
    /// The heights before they were rounded, in units of 2^length_exponent of the chain: for
    /// shapes; may be empty.
    std::vector<Wide<double>> unrounded{};

    static Answer none() { return {{}, {}, false}; }
    double worst_bound() const {
        return error_bound.size() > 0 && found ? error_bound.maxCoeff()
                                               : std::numeric_limits<double>::infinity();
    }
};

/// The properties of a chain from which a model is chosen. Cost O(log N), or O(N) if equal links
/// are stored one by one, because they are compared.
struct ChainKind {
    Index size = 0;
    Index mode_count = 0;
    bool equal = false;           ///< one number of each kind serves all links
    bool plummets = false;        ///< equal plummets
    bool rods = false;            ///< equal uniform rods
    double length = 0;            ///< of the whole chain
    std::optional<double> taper;  ///< `Chain::taper`
    // The next five are read from a sample of the links.
    bool centroids_below = true;  ///< none lies above its pin
    bool short_pendulums =
        false;  ///< all plummets, or each pendulum shorter than its link, and no plummet
    bool point_masses = true;  ///< all are plummets
    double long_pendulums =
        0;  ///< share of links whose pendulum is longer than they, or whose centroid is above
    bool negative_pins =
        false;  ///< two neighbours have so much weight beyond their common pin that the pin's share
                ///< is negative
    // The rest is 0 for equal links, and for fewer unequal links than `least_sampled`.
    static constexpr Index least_sampled = 24;
    double growth =
        0;  ///< log2 of the upper half's weight over the lower half's, from 256 links on
    Index light =
        0;  ///< number of links at the top that weigh less than about 2e-14 of what is below
    /// Phase of a wave of conical height 1 in each of up to 32 stretches of the chain, lowest
    /// first: the integral of sqrt(dW ds / S), S the weight below.
    std::array<double, 32> phase{};
    Index stretches = 0;
    double links_per_stretch = 0;
    double tip_share = 0;      ///< weight of the lowest link over that of the chain
    double greatest_pull = 0;  ///< largest S / W of a link, from means over stretches
    double range = 0;          ///< mean of log2(greatest_pull W / S)
    double tilt =
        0;  ///< conical height of the chain as one rigid link: less than its largest height

   private:
    template <class V>
    static bool is_one(const Column<V>& column) {
        const V* const numbers = column.data();
        return std::all_of(numbers, numbers + column.stored(),
                           [&](const V& x) { return x == numbers[0]; });
    }

    /// Reads one link if all are equal, all of up to 100 unequal links, else a sample spread over
    /// the chain.
    void look_at_links(const Chain<double>& chain) {
        const Index sampled = equal ? 1 : size <= 100 ? size : 32;
        bool points = true, shorter = true;
        Index longer = 0;
        for (Index i = 0; i < sampled; ++i) {
            const Index m = i * size / sampled;
            const double p = chain.centroid()[m] / chain.length()[m],
                         r = chain.gyration_ratio()[m].high;
            points = points && p == 1 && r == 0;
            shorter = shorter && r > 0 && p * (1 - p) > r;
            centroids_below = centroids_below && p >= 0;
            longer += p >= 0 && p * (1 - p) >= r ? 0 : 1;
            if (p <= 1 || m + 1 == size) continue;
            const double above = chain.centroid()[m + 1] / chain.length()[m + 1];
            negative_pins =
                negative_pins || chain.weight()[m] * (1 - p) + chain.weight()[m + 1] * above <= 0;
        }
        short_pendulums = points || shorter, point_masses = points;
        long_pendulums = static_cast<double>(longer) / static_cast<double>(sampled);
    }
    /// Samples the weights along the chain. All links are read if there are at most 255. For longer
    /// chains weights come from the stored sums, and lengths are taken as equal.
    void look_at_stretches(const Chain<double>& chain) {
        const revchain::detail::FloatingPointStateGuard quiet;  // ratios may be infinite
        const bool few = size < segment_size;
        const Index pieces = few ? size : (size - 1) / segment_size + 1,
                    most = static_cast<Index>(phase.size());
        const Index step = ((pieces - 1) / most + 1) * (few ? 1 : segment_size);
        const double tip = chain.weight()[0], total = chain.total_weight();
        links_per_stretch = static_cast<double>(step), tip_share = tip / total;
        double below = 0, at = 0, inertia = 0, stiffness = 0, exponents = 0;
        for (Index first = 0; first < size; first += step, ++stretches) {
            const Index end = std::min(first + step, size);
            double above = 0,
                   run = length * static_cast<double>(end - first) / static_cast<double>(size);
            if (few) {
                above = below, run = 0;
                for (Index m = first; m < end; ++m)
                    above += chain.weight()[m], run += chain.length()[m];
            } else {
                above = static_cast<double>(chain.weight_below(end));
            }
            // The lowest link counts as a weight at the tip.
            const double least = std::max(below, tip), weight = above - least,
                         links = static_cast<double>(end - first);
            phase[static_cast<std::size_t>(stretches)] =
                2 * std::sqrt(run * weight) / (std::sqrt(above) + std::sqrt(least));
            const double outside = 1 - (at + run / 2) / length,
                         pull = links * above / (above - below);
            inertia += (above - below) * outside * outside, stiffness += (above + below) / 2 * run;
            greatest_pull = std::max(greatest_pull, pull);
            exponents += std::log2(pull);
            below = above, at += run;
        }
        range = std::log2(greatest_pull) - exponents / static_cast<double>(stretches);
        tilt = inertia / stiffness * length * length;
    }
    /// Returns the number of light links at the top. The search in the stored sums assumes that
    /// links become lighter upwards.
    static Index light_links(const Chain<double>& chain) {
        const auto& below = chain.partial_weights();
        if (below.size() < 3) return 0;
        std::size_t first = 1, last = below.size() - 1;
        while (first < last) {
            const std::size_t middle = (first + last) / 2;
            const double weight = static_cast<double>(below[middle + 1] - below[middle]);
            if (weight < 2e-14 * segment_size * static_cast<double>(below[middle]))
                last = middle;
            else
                first = middle + 1;
        }
        return std::max<Index>(0, chain.size() - static_cast<Index>(first) * segment_size);
    }

   public:
    explicit ChainKind(const Chain<double>& chain)
        : size(chain.size()),
          mode_count(chain.mode_count()),
          length(chain.total_length()),
          taper(chain.taper()) {
        equal = is_one(chain.weight()) && is_one(chain.length()) && is_one(chain.centroid()) &&
                is_one(chain.gyration_ratio());
        look_at_links(chain);
        if (!equal) {
            if (size >= segment_size) {
                const double half = static_cast<double>(chain.weight_below(size / 2));
                growth = std::log2(chain.total_weight() / half - 1);
            }
            light = light_links(chain);
            if (size >= least_sampled) look_at_stretches(chain);
            return;
        }
        const Link<double> link = chain.link(0);
        plummets = link == plummet(link.weight, link.length);
        rods = link == uniform_rod(link.weight, link.length);
    }
};

namespace detail {
REVCHAIN_LAZY
double real(Index x) { return static_cast<double>(x); }
/// 2 ulp: the relative error bound that the methods in double can prove for any chain.
inline constexpr double full_accuracy = 2.001 * std::numeric_limits<double>::epsilon();
}  // namespace detail

/// A height and a bound of its relative error.
struct BoundedHeight {
    double height, error_bound;
};

/// Builds the answer from `enclosed(number)` of each mode.
template <class F>
Answer answer_of_each(const Question& question, const F& enclosed) {
    Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
    for (Index i = 0; i < question.count; ++i) {
        const BoundedHeight one = enclosed(question.first + i);
        answer.conical_height[i] = one.height, answer.error_bound[i] = one.error_bound;
    }
    return answer;
}

/// One theory or method. `applies` says whether it can answer a question. Before anything is
/// computed, `error_bound` bounds the relative errors of all requested heights, and `cost` predicts
/// the time in seconds. `solve` returns the answer with the bounds reached.
template <class M>
concept Model = requires(const M& model, const Chain<double>& chain, const ChainKind& kind,
                         const Question& question) {
    { M::name } -> std::convertible_to<std::string_view>;
    { model.applies(kind, question) } -> std::same_as<Fit>;
    { model.error_bound(kind, question) } -> std::same_as<double>;
    { model.cost(kind, question) } -> std::same_as<double>;
    { model.solve(chain, kind, question) } -> std::same_as<Answer>;
};

/// Whether a model belongs to the theory of small inclinations: `M::is_linear`, or true without it.
template <class M>
constexpr bool is_linear() {
    return !requires { requires !M::is_linear; };
}

/// Whether the bounds of a model are proved by counts.
template <class M>
constexpr bool is_proved() {
    return requires { requires M::is_proved; };
}

/// Returns a bound on the error of the theory of small inclinations if the lowest link has the
/// inclination of the question. It is 1/cos - 1 if no link leans more than the lowest. Reason:
/// offsets of a shape are those of a mode of the straight chain with links as long as they reach
/// down (`transferred_to_axis`). Lengthening a link as a whole lowers no height. Among equal links
/// the lowest leans most in the slowest modes. In linear theory these are the modes up to number
/// 1.15 sqrt(N) for plummets and 1.6 sqrt(N) for rods, and at most a third of all. This function
/// uses sqrt(N), checked up to 80 degrees (tests/cpp/models/models.cpp). The result is infinite for
/// other modes and chains.
REVCHAIN_LAZY
double error_of_small_inclinations(const ChainKind& kind, const Question& question) {
    if (!(question.inclination > 0)) return 0;
    const Index last = question.last();
    if (!(kind.plummets || kind.rods) ||
        (last > 1 && (3 * last > kind.size || last * last > kind.size)))
        return std::numeric_limits<double>::infinity();
    const double sine = std::sin(question.inclination / 2);
    return 2 * sine * sine / std::cos(question.inclination) * (1 + 1e-15);
}

}  // namespace models
}  // namespace revchain
