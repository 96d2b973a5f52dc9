// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <string_view>

#include "revchain/chain/chain.hpp"

namespace revchain {

/// What is asked of a chain: the conical heights of modes number `first`, ..., each to a relative tolerance; 0: as
/// accurate as there is.
struct Question {
    Index first = 1;  ///< number of the slowest mode wanted, from 1
    Index count = 1;
    double rtol = 0;
    double inclination = 0;  ///< of the lowest link, rad, below a right angle: of the shape that grows out of the mode

    Index last() const { return first - 1 + count; }
};

/// Heights and what bounds their relative errors.
struct Answer {
    Vector<double> conical_height;
    Vector<double> error_bound;
    /// Whether the model had an answer after all.
    bool found = true;
    Vector<double> conical_height_low{};  ///< what a double cannot hold of the heights; empty where it is not known

    double worst_bound() const {
        return error_bound.size() > 0 && found ? error_bound.maxCoeff() : std::numeric_limits<double>::infinity();
    }
};

/// What the models have to know of a chain at once. Cost O(log N), but of equal links stored one by one,
/// and of at most 100 links, which are looked at.
struct ChainKind {
    Index size = 0;
    Index mode_count = 0;
    bool equal = false;            ///< one number of each kind serves all links
    bool plummets = false;         ///< equal plummets
    bool rods = false;             ///< equal uniform rods
    double length = 0;             ///< of the whole chain
    std::optional<double> taper;   ///< `Chain::taper`
    bool centroids_below = true;   ///< of at most 100 links: none lies above its pin
    bool short_pendulums = false;  ///< of at most 100 links: all plummets, or all pendulum lengths below the links'
    double growth = 0;  ///< log2 of what the upper half of the links weighs over what the lower does; 256 and more
    double long_pendulums =
        0;            ///< share of links whose pendulum length exceeds their length, or whose centroid is above
    Index light = 0;  ///< links at the top that weigh less than 2e-14 of what hangs below them, about

   private:
    template <class V>
    static bool is_one(const Column<V>& column) {
        const V* const numbers = column.data();
        return std::all_of(numbers, numbers + column.stored(), [&](const V& x) { return x == numbers[0]; });
    }

    void look_at_links(const Chain<double>& chain) {
        bool points = true, shorter = true;
        const Index different = equal ? 1 : chain.size();
        for (Index m = 0; m < different && (points || shorter || centroids_below); ++m) {
            const double p = chain.centroid()[m] / chain.length()[m], r = chain.gyration_ratio()[m].high;
            points = points && p == 1 && r == 0;
            shorter = shorter && r > 0 && p * (1 - p) > r;
            centroids_below = centroids_below && p >= 0;
        }
        short_pendulums = points || shorter;
    }
    /// Of so many at most, spread over the chain.
    static double share_of_long_pendulums(const Chain<double>& chain) {
        constexpr Index most = 32;
        const Index looked_at = std::min(most, chain.size());
        Index longer = 0;
        for (Index i = 0; i < looked_at; ++i) {
            const Index m = i * chain.size() / looked_at;
            const double p = chain.centroid()[m] / chain.length()[m];
            longer += p >= 0 && p * (1 - p) >= chain.gyration_ratio()[m].high ? 0 : 1;
        }
        return static_cast<double>(longer) / static_cast<double>(looked_at);
    }
    /// As if they grew lighter upwards: a search among the sums at hand.
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
        : size(chain.size()), mode_count(chain.mode_count()), length(chain.total_length()), taper(chain.taper()) {
        equal = is_one(chain.weight()) && is_one(chain.length()) && is_one(chain.centroid()) &&
                is_one(chain.gyration_ratio());
        if (size <= 100) look_at_links(chain);
        if (!equal) {
            if (size >= segment_size) {
                const double half = static_cast<double>(chain.weight_below(size / 2));
                growth = std::log2(static_cast<double>(chain.total_weight()) / half - 1);
            }
            light = light_links(chain);
            long_pendulums = share_of_long_pendulums(chain);
            return;
        }
        const Link<double> link = chain.link(0);
        plummets = link == plummet(link.weight, link.length);
        rods = link == uniform_rod(link.weight, link.length);
    }
};

/// Whether a model can answer, and if not why: a sentence that lives for ever.
struct Fit {
    bool applies = true;
    std::string_view reason{};

    static Fit no(std::string_view why) { return {false, why}; }
};

/// One theory or method: whether it applies to a question, how large its error can be (relative, of every height asked
/// for; a bound, before anything is computed), what it costs (seconds, predicted), and its answer, with the bounds
/// reached.
template <class M>
concept Model = requires(const M& model, const Chain<double>& chain, const ChainKind& kind, const Question& question) {
    { M::name } -> std::convertible_to<std::string_view>;
    { model.applies(kind, question) } -> std::same_as<Fit>;
    { model.error_bound(kind, question) } -> std::same_as<double>;
    { model.cost(kind, question) } -> std::same_as<double>;
    { model.solve(chain, kind, question) } -> std::same_as<Answer>;
};

/// Whether a model is of the theory of small inclinations, as all are that do not say otherwise.
template <class M>
constexpr bool is_linear() {
    if constexpr (requires { M::is_linear; })
        return M::is_linear;
    else
        return true;
}

/// How far the theory of small inclinations is off where the lowest link has one that is not: at most 1/cos - 1, if no
/// link leans more than the lowest. Offsets of a shape are those of a mode of the straight chain with links as long as
/// they reach down (`transferred_to_axis`), and no link made longer as a whole lowers a height. Of equal links the
/// lowest leans most in the slowest modes: up to number 1.15 sqrt(N) of plummets, 1.6 sqrt(N) of rods as the linear
/// theory has it, and no more than a third of them; here up to sqrt(N), found so up to 80 degrees
/// (tests/cpp/scene/models.cpp). Infinite of others.
inline double error_of_small_inclinations(const ChainKind& kind, const Question& question) {
    if (!(question.inclination > 0)) return 0;
    const Index last = question.last();
    if (!(kind.plummets || kind.rods) || (last > 1 && (3 * last > kind.size || last * last > kind.size)))
        return std::numeric_limits<double>::infinity();
    const double sine = std::sin(question.inclination / 2);
    return 2 * sine * sine / std::cos(question.inclination) * (1 + 1e-15);
}

}  // namespace revchain
