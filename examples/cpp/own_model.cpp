// SPDX-License-Identifier: MPL-2.0
// A link kind and a method of your own: balls on threads, and the slowest mode of point masses by power iteration.
#include <revchain/models/heights.hpp>
#include <revchain/modes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <vector>

using namespace revchain;
using namespace revchain::models;

/// A solid ball on a thread, which is tied to a hook at its centre.
Link<double> ball(double weight, double thread, double radius) {
    return compound_pendulum<double>(
        {.weight = weight, .length = thread, .centroid = thread, .radius_of_gyration = std::sqrt(0.4) * radius});
}

/// Power iteration for the slowest mode. With offsets that are all positive, its height lies between the least and the
/// greatest ratio of new to old offsets (Collatz 1942).
struct PowerIteration {
    static constexpr std::string_view name = "power iteration";
    static constexpr int most_steps = 40;

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!kind.point_masses) return Fit::no("a link that is no point mass");
        if (question.last() > 1) return Fit::no("modes faster than the slowest");
        if (question.rtol < 1e-8) return Fit::no("a tolerance below 1e-8");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const { return question.rtol; }
    double cost(const ChainKind& kind, const Question& question) const {
        return 1e-7 + 1.2e-9 * static_cast<double>(kind.size) * (4 - std::log(question.rtol));
    }
    Answer solve(const Chain<double>& chain, const ChainKind&, const Question& question) const {
        const Index n = chain.size();
        for (Index m = 0; m < n; ++m)  // `applies` has seen a sample of a long chain
            if (!(chain.link(m) == plummet(chain.weight()[m], chain.length()[m]))) return Answer::none();
        const double rounding = 4.0 * static_cast<double>(n + 4) * epsilon<double>();
        std::vector<double> offset(static_cast<std::size_t>(n), 1.0), rise(offset);
        for (int step = 0; step < most_steps; ++step) {
            double pull = 0, weight = 0;  // of what whirls below the link, and its weight
            for (Index m = 0; m < n; ++m) {
                const auto i = static_cast<std::size_t>(m);
                pull += chain.weight()[m] * offset[i], weight += chain.weight()[m];
                rise[i] = chain.length()[m] * pull / weight;
            }
            double place = 0, low = std::numeric_limits<double>::infinity(), high = 0;
            for (auto i = static_cast<std::size_t>(n); i-- > 0;) {
                place += rise[i];
                low = std::min(low, place / offset[i]), high = std::max(high, place / offset[i]);
                offset[i] = place;
            }
            const double bound = (high - low) / (2 * low) + rounding;
            if (bound <= question.rtol)
                return {Vector<double>::Constant(1, (low + high) / 2), Vector<double>::Constant(1, bound)};
            for (double& y : offset) y /= place;
        }
        return Answer::none();
    }
};
static_assert(Model<PowerIteration>);

int main() {
    const Chain<double> balls({ball(2.0, 0.5, 0.06), ball(1.0, 0.4, 0.05)});
    std::printf("balls: height %.6f, as points %.6f\n", modes(balls).conical_height[0],
                modes(Chain<double>({plummet(2.0, 0.5), plummet(1.0, 0.4)})).conical_height[0]);

    std::vector<Link<double>> links;
    for (int m = 0; m < 200; ++m) links.push_back(plummet(1.0 + m % 7, 0.1 + 0.01 * (m % 3)));
    const Chain<double> chain(links);
    constexpr auto methods = std::tuple_cat(std::tuple<PowerIteration>{}, height_models);
    const Question question{.count = 1, .rtol = 1e-3};
    for (const Estimate& each : select(methods, chain, question).estimates)
        if (each.fit.applies)
            std::printf("%-20.*s bound %.0e, %5.1f us\n", static_cast<int>(each.name.size()), each.name.data(),
                        each.error_bound, 1e6 * each.cost);
        else
            std::printf("%-20.*s %.*s\n", static_cast<int>(each.name.size()), each.name.data(),
                        static_cast<int>(each.fit.reason.size()), each.fit.reason.data());
    const Solution found = solve(methods, chain, question);
    const double exact = modes(chain, {.count = 1}).conical_height[0], height = found.answer.conical_height[0];
    std::printf("%.*s: %.6f within %.1e; to the last digit %.12f\n", static_cast<int>(found.model.size()),
                found.model.data(), height, found.answer.error_bound[0], exact);
    return found.model == PowerIteration::name && std::abs(height / exact - 1) <= found.answer.error_bound[0] ? 0 : 1;
}
