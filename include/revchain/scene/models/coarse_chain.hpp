// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/modes.hpp"
#include "revchain/scene/model.hpp"

namespace revchain::models {

/// Groups of neighbouring links, each locked into one straight body of the same weight, centre of gravity and radius of
/// gyration. That holds pins which are free in the chain, so that each conical height is at most that of the chain
/// (Courant, Fischer); how much less is about what it is for equal rods, and is verified: one count on the chain itself
/// shows that no more modes than those lie above the height by twice that share. So all heights are proved to lie
/// between the coarse ones and those. Where the count says no, twice as many groups are taken.
/// Cost: 110 ns a link, most of it the chain's own pencil, the modes of the coarse chain, and 20 ns a link and mode for counts.
struct CoarseChain {
    static constexpr std::string_view name = "coarse chain";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (kind.size < 24) return Fit::no("fewer than 24 links");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        if (question.rtol <= 0) return Fit::no("no tolerance to spend");
        if (2 * groups(question) > kind.size) return Fit::no("as many groups as links, for that tolerance");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const {
        return share(groups(question), question.last());
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double n = static_cast<double>(kind.size), m = static_cast<double>(groups(question));
        const double k = static_cast<double>(question.count);
        // its modes by the ways of models/numerical.hpp
        double small = m <= 32 ? 4e-7 + 2.6e-8 * m + 4e-9 * m * m : 8e-7 + m * (1.6e-7 + 2.9e-7 * k);
        if (m >= 12 && k >= 8) small = std::min(small, 2.5e-5 + m * (5e-7 + 2.5e-9 * k));
        if (m >= 256) small = std::min(small, 3e-5 + 1.7e-9 * m + 5e-5 * k * (1 + k / 20));
        return 2e-6 + n * (1.1e-7 + 2e-8 * k) + small;
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind, const Question& question) const {
        Index count = groups(question);
        for (int attempt = 0; attempt < 4 && 2 * count <= kind.size; ++attempt, count *= 2)
            if (Answer answer = verified(chain, question, count); answer.found) return answer;
        return {{}, {}, false};
    }

   private:
    /// Twice what equal rods are short of the chain without links: q (1/24 J^2 - 1/12)/M^2, 1/J^2 < pi j/2.
    static double share(Index groups, Index mode) {
        const double j = 3.1415926535897931 * static_cast<double>(mode), m = static_cast<double>(groups);
        return 2 * (j * j * j * 0.0164 + 0.05) / (m * m);
    }
    /// As many as the tolerance needs, for errors of half of it.
    static Index groups(const Question& question) {
        const double needed = std::sqrt(share(1, question.last()) / std::max(question.rtol, 1e-30));
        return needed < 1e9 ? std::max<Index>(8 + 4 * question.last(), static_cast<Index>(std::ceil(needed)))
                            : Index(1e9);
    }
    static Answer verified(const Chain<double>& chain, const Question& question, Index groups) {
        const Chain<double> coarse = merged(chain, groups);
        ModesOptions<double> options{.first = question.first, .count = question.count};
        options.rtol = 1e-13, options.shapes = false;
        const Modes<double> found = modes(coarse, options);
        Answer answer{found.conical_height, Vector<double>(question.count)};
        const revchain::detail::Pencils<double> pencils(chain);
        for (Index i = 0; i < question.count; ++i) {
            const double wide = share(groups, question.first + i), low = found.conical_height[i] * (1 - 2e-13);
            const double high = found.conical_height[i] * (1 + wide);
            const auto above = pencils.certified_count<1>({pencils.scaled(Wide<double>(high))})[0];
            if (!above.proved || above.above > question.first + i - 1) return {{}, {}, false};
            answer.conical_height[i] = low + (high - low) / 2;
            answer.error_bound[i] = (high - low) / (2 * low) * (1 + 1e-12);
        }
        return answer;
    }
    static Chain<double> merged(const Chain<double>& chain, Index groups) {
        std::vector<Link<double>> links;
        links.reserve(static_cast<std::size_t>(groups));
        for (Index g = 0; g < groups; ++g) {
            const Index begin = g * chain.size() / groups, end = (g + 1) * chain.size() / groups;
            double weight = 0, length = 0;
            for (Index m = begin; m < end; ++m) weight += chain.weight()[m], length += chain.length()[m];
            double moment = 0, second = 0, above = length;  // about the group's upper pin
            for (Index m = begin; m < end; ++m) {
                const Link<double> link = chain.link(m);
                above -= link.length;
                const double h = above + link.centroid;
                moment += link.weight * h;
                second += link.weight * (h * h + static_cast<double>(link.gyration_ratio) * link.length * link.length);
            }
            const double h = moment / weight, square = std::max(0.0, second / weight - h * h);
            links.push_back(compound_pendulum<double>(
                {.weight = weight, .length = length, .centroid = h, .radius_of_gyration = std::sqrt(square)}));
        }
        return Chain<double>(links);
    }
};

}  // namespace revchain::models
