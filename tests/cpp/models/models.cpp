// SPDX-License-Identifier: MPL-2.0
// Truth: `modes` to the last digit (0.5 ulp, itself tested against quadruple precision). Error: relative.
#include "revchain/methods.hpp"
#include "revchain/models/heights.hpp"
#include "revchain/modes.hpp"

#include <map>

#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain;
using namespace revchain::models;
using support::Random;

namespace {

constexpr double half_ulp = 0x1p-53;

/// The worst of error over bound, over all heights of an answer.
double worst_share(const Answer& answer, const Modes<double>& truth, Index first = 1) {
    double worst = 0;
    for (Index j = 0; j < answer.conical_height.size(); ++j) {
        const double exact = truth.conical_height[first - 1 + j];
        const double error = std::abs(answer.conical_height[j] / exact - 1);
        worst = std::max(worst, std::max(0.0, error - half_ulp) / answer.error_bound[j]);
    }
    return worst;
}

template <class M>
double worst_of_all(const M& model, const Chain<double>& chain) {
    const ChainKind kind(chain);
    const Modes<double> truth = modes(chain, {.count = revchain::all_modes});
    double worst = 0;
    for (Index k = 1; k <= chain.size(); ++k) {
        const Question question{.first = k, .count = 1};
        if (!model.applies(kind, question).applies) continue;
        const Answer answer = model.solve(chain, kind, question);
        REQUIRE(answer.found);
        REQUIRE(answer.error_bound[0] <= model.error_bound(kind, question) * (1 + 1e-12));
        worst = std::max(worst, worst_share(answer, truth, k));
    }
    return worst;
}

Chain<double> random_chain(Random& random, Index size) {
    std::vector<Link<double>> links;
    const int kind = static_cast<int>(random.between(0, 4));
    const double wide = random.between(0, 2);
    for (Index m = 0; m < size; ++m) {
        const double W = std::exp(wide * random.between(-1, 1)), a = std::exp(wide * random.between(-1, 1));
        const double h = a * random.between(0.2, 1), rho = a * random.between(0, 0.5);
        if (kind == 0) links.push_back(plummet(W, a));
        if (kind == 1) links.push_back(uniform_rod(W, a));
        if (kind >= 2)
            links.push_back(
                compound_pendulum<double>({.weight = W, .length = a, .centroid = h, .radius_of_gyration = rho}));
    }
    return Chain<double>(links);
}

/// A model that foresees one bound and finds another; models of greater `cost` are asked later.
struct Hopeful {
    static constexpr std::string_view name = "hopeful";
    double foreseen, found, seconds;

    Fit applies(const ChainKind&, const Question&) const { return {}; }
    double error_bound(const ChainKind&, const Question&) const { return foreseen; }
    double cost(const ChainKind&, const Question&) const { return seconds; }
    Answer solve(const Chain<double>&, const ChainKind&, const Question&) const {
        return {Vector<double>::Constant(1, 1.0), Vector<double>::Constant(1, found)};
    }
};

}  // namespace

TEST_CASE("Laguerre asymptotics: within the bound, all modes that it takes") {
    double worst = 0;
    for (const Index n : {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 30, 50, 100, 300, 1000})
        worst = std::max(worst, worst_of_all(models::EqualPlummets{}, Chain<double>::uniform_plummets(n, 2.5)));
    CAPTURE(worst);
    CHECK(worst <= 0.8);
    CHECK(worst > 0.2);  // not wasteful
    const auto long_chain = Chain<double>::uniform_plummets(1'000'000, 3.0);
    const Answer answer = models::EqualPlummets{}.solve(long_chain, ChainKind(long_chain), {.count = 10});
    CHECK(worst_share(answer, modes(long_chain, {.count = 10})) <= 1);
    CHECK(answer.error_bound.maxCoeff() <= 1e-15);
}

TEST_CASE("continuous chain: as far from many links as it says") {
    double plummets = 0, rods = 0;
    for (const Index n : {2, 3, 4, 5, 6, 8, 10, 14, 20, 40, 100, 400, 1000}) {
        plummets = std::max(plummets, worst_of_all(models::ContinuousChain{}, Chain<double>::uniform_plummets(n, 2.5)));
        rods = std::max(rods, worst_of_all(models::ContinuousChain{}, Chain<double>::uniform_rods(n, 2.5)));
    }
    CAPTURE(plummets, rods);
    CHECK(plummets <= 1);
    CHECK(rods <= 1);
    CHECK(plummets > 0.5);
    CHECK(rods > 0.5);
}

TEST_CASE("closed forms: one link and two") {
    Random random(31);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const Chain<double> chain = random_chain(random, 1 + i % 2);
        const ChainKind kind(chain);
        const Question question{.first = 1, .count = chain.mode_count()};
        if (!models::ClosedForms{}.applies(kind, question).applies) continue;
        const Answer answer = models::ClosedForms{}.solve(chain, kind, question);
        REQUIRE(answer.found);
        worst = std::max(worst, worst_share(answer, modes(chain, {.count = revchain::all_modes})));
    }
    CAPTURE(worst);
    CHECK(worst <= 0.5);
}

TEST_CASE("closed forms: any unit of length") {
    for (const double unit : {1e-300, 1e-200, 1e-160, 1e-157, 1e-120, 1e-105, 1e-90, 1e90, 1e105, 1e120, 1e160, 1e300})
        for (const Index n : {1, 2}) {
            std::vector<Link<double>> links{uniform_rod(1.0, 3 * unit), plummet(2.0, 5 * unit)};
            links.resize(static_cast<std::size_t>(n));
            const Chain<double> chain(links);
            const Answer answer = models::ClosedForms{}.solve(chain, ChainKind(chain), {.count = n});
            CAPTURE(unit, n);
            REQUIRE(answer.found);
            CHECK(worst_share(answer, modes(chain, {.count = revchain::all_modes})) <= 0.5);
            if (n > 1) continue;
            const Solution leaning = solve(chain, {.inclination = 1.2});
            CHECK(leaning.model == models::ConicalPendulum::name);
            CHECK(leaning.answer.conical_height[0] == Approx(2 * unit * std::cos(1.2)).epsilon(1e-15));
        }
}

TEST_CASE("coarse chains: heights between those proved") {
    Random random(32);
    int found = 0, asked = 0;
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        const Index size = static_cast<Index>(random.log_between(24, 3000));
        const Chain<double> chain = random_chain(random, size);
        const Question question{.first = 1 + i % 3, .count = 1 + i % 4, .rtol = random.log_between(1e-4, 0.3)};
        const ChainKind kind(chain);
        if (!models::CoarseChain{}.applies(kind, question).applies) continue;
        ++asked;
        const Answer answer = models::CoarseChain{}.solve(chain, kind, question);
        if (!answer.found) continue;
        ++found;
        worst = std::max(worst, worst_share(answer, modes(chain, {.count = 12}), question.first));
    }
    CAPTURE(found, asked, worst);
    CHECK(asked > 100);
    CHECK(found > 0.9 * asked);
    CHECK(worst <= 1);
    CHECK(worst > 0.3);  // no idle bound
}

TEST_CASE("coarse chains: links far apart in length, weight, centroid and radius of gyration") {
    Random random(36);
    int found = 0, asked = 0;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        const Index size = static_cast<Index>(random.log_between(24, 1500));
        const double wide = random.between(0, 12), lengths = random.between(0, 30), rho = random.log_between(1e-6, 1e4);
        std::vector<Link<double>> links;
        for (Index m = 0; m < size; ++m) {
            const double W = std::exp(wide * random.between(-1, 1)), a = std::exp(lengths * random.between(-1, 1));
            const double h = i % 3 == 0 && m % 5 == 0 ? a * 1e6 : a * random.between(0.01, 1.5);
            links.push_back(compound_pendulum<double>(
                {.weight = W, .length = a, .centroid = h, .radius_of_gyration = i % 2 == 0 ? rho : rho * a}));
        }
        const Chain<double> chain(links);
        const Question question{.first = 1 + i % 3, .count = 1 + i % 4, .rtol = random.log_between(1e-5, 0.5)};
        const ChainKind kind(chain);
        if (!models::CoarseChain{}.applies(kind, question).applies) continue;
        ++asked;
        const Answer answer = models::CoarseChain{}.solve(chain, kind, question);
        if (!answer.found) continue;
        ++found;
        worst = std::max(worst, worst_share(answer, modes(chain, {.count = 12}), question.first));
    }
    CAPTURE(found, asked, worst);
    CHECK(asked > 100);
    CHECK(found > 0.5 * asked);
    CHECK(worst <= 1);
}

TEST_CASE("any chain, any tolerance: a model that keeps it, or it is said") {
    Random random(33);
    double worst = 0;
    std::map<std::string_view, int> chosen;
    for (int i = 0; i < 400; ++i) {
        const Index size = static_cast<Index>(random.log_between(1, 2000));
        const Chain<double> chain = i % 5 == 0   ? Chain<double>::uniform_rods(size, 2.0)
                                    : i % 5 == 1 ? Chain<double>::uniform_plummets(size, 2.0)
                                                 : random_chain(random, size);
        const Index available = std::min<Index>(chain.mode_count(), 12);
        const Modes<double> truth = modes(chain, {.count = available});
        for (const double rtol : {1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15}) {
            const Index first = 1 + static_cast<Index>(random.between(0, static_cast<double>(available) * 0.999));
            const Question question{
                first, 1 + static_cast<Index>(random.between(0, static_cast<double>(available - first) + 0.999)), rtol};
            const Choice choice = select(chain, question);
            const Solution found = solve(chain, question);
            CAPTURE(i, size, rtol, question.first, question.count, found.model);
            REQUIRE(found.answer.conical_height.size() == question.count);
            REQUIRE(found.status == Status::success);
            REQUIRE(choice.meets_tolerance);
            REQUIRE(found.answer.worst_bound() <= rtol);
            REQUIRE(worst_share(found.answer, truth, first) <= 1);
            worst = std::max(worst, worst_share(found.answer, truth, first));
            ++chosen[found.model];
        }
    }
    CHECK(chosen.size() >= 6);
}

// Heavy tips of every kind, light tips, bodies: who is chosen first must seldom find that it has no answer.
TEST_CASE("the first choice is seldom replaced, heavy tips included") {
    Random random(8);
    int asked = 0, replaced = 0;
    for (int i = 0; i < 700; ++i) {
        const Index size = static_cast<Index>(random.log_between(2, 8000));
        const int kind = i % 6;
        const double ratio = random.log_between(1, 1e12), tip = random.log_between(1, 1e4) * static_cast<double>(size);
        const auto chain = support::chain_of(size, [&](Index m) {
            const double a = random.between(0.5, 2), weight = random.between(0.5, 2);
            if (kind == 0) return plummet(m == 0 ? tip : weight, a);
            if (kind == 1) return uniform_rod(m == 0 ? tip : weight, a);
            if (kind == 2) return plummet(support::graded(size - 1 - m, size, ratio), 1.0);
            if (kind == 3) return uniform_rod(support::graded(size - 1 - m, size, ratio), a);
            if (kind == 4) return uniform_rod(support::graded(m, size, ratio), 1.0);
            return compound_pendulum<double>({.weight = random.log_between(0.01, 100),
                                              .length = a,
                                              .centroid = a * random.between(0.05, 1.3),
                                              .radius_of_gyration = a * random.between(0, 1.5)});
        });
        const Index most = std::min<Index>(chain.mode_count(), 20);
        const Index first = 1 + static_cast<Index>(random.between(0, 0.999 * static_cast<double>(most)));
        for (const double rtol : {0.1, 1e-2, 1e-4, 1e-9, 1e-12}) {
            const Question question{first, 1 + static_cast<Index>(random() * static_cast<double>(most - first)), rtol};
            const auto choice = select(height_models, chain, question);
            const Solution found = solve(height_models, chain, question);
            ++asked, replaced += choice.estimates[choice.model].name != found.model;
            CHECK(found.status == Status::success);
        }
    }
    CAPTURE(asked, replaced);
    CHECK(replaced <= asked / 50);
}

TEST_CASE("bounds found are no larger than those foreseen, of every model") {
    Random random(37);
    double least = 1;
    for (int i = 0; i < 200; ++i) {
        const Index size = static_cast<Index>(random.log_between(1, 2000));
        const Chain<double> chain = i % 3 == 0 ? Chain<double>::uniform_plummets(size) : random_chain(random, size);
        const ChainKind kind(chain);
        for (const double rtol : {0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 2.0}) {
            const Question question{.count = std::min<Index>(chain.mode_count(), 1 + i % 12), .rtol = rtol};
            const auto check = [&](const auto& model) {
                if (!model.applies(kind, question).applies) return;
                const Answer answer = model.solve(chain, kind, question);
                if (!answer.found) return;
                CAPTURE(model.name, i, size, rtol);
                const bool most = model.name == models::Aberth::name || model.name == models::Interpolated::name;
                const double slack = most ? 30 : 1 + 1e-12;  // foreseen of most chains
                REQUIRE(answer.worst_bound() <= model.error_bound(kind, question) * slack);
                if (rtol >= 1e-3) least = std::min(least, answer.worst_bound() / rtol);
            };
            std::apply([&](const auto&... models) { (check(models), ...); }, height_models);
        }
    }
    CHECK(least < 1e-9);  // some give more than they are asked for
}

TEST_CASE("a tolerance costs no more than none") {
    Random random(71);
    Index asked = 0;
    for (int i = 0; i < 200; ++i) {
        const Index size = static_cast<Index>(std::exp(random.between(1, 6)));
        const Chain<double> chain = random_chain(random, size);
        const ChainKind kind(chain);
        const Index count = std::min<Index>(3 + static_cast<Index>(random.between(0, 40)), size);
        const Index first = 1 + static_cast<Index>(random.between(0, static_cast<double>(size - count)));
        const double rtol = std::pow(10.0, random.between(-15, -1));
        const Question full{first, count}, loose{first, count, rtol};
        CAPTURE(size, first, count, rtol);
        // of no model, as predicted
        const auto exactly = select(revchain::detail::with_bisection(revchain::methods::all), kind, full).estimates;
        const auto loosely = select(revchain::detail::with_bisection(revchain::methods::all), kind, loose).estimates;
        for (std::size_t m = 0; m < exactly.size(); ++m)
            if (exactly[m].fit.applies && exactly[m].error_bound <= models::detail::full_accuracy) {
                CAPTURE(exactly[m].name);
                CHECK(loosely[m].cost <= exactly[m].cost);
            }
        // Three modes and more: full accuracy costs less than the counts that this tolerance takes.
        if (count < 3 || !(rtol < 1e-6)) continue;
        const auto found =
            modes(chain, {.first = first, .count = count, .rtol = rtol, .method = ModesMethod::bisection});
        CHECK(found.error_bound.maxCoeff() <= models::detail::full_accuracy);
        ++asked;
    }
    CHECK(asked > 100);
}

TEST_CASE("where no model keeps the tolerance: the best of the bounds found, whichever came first") {
    const auto rods = Chain<double>::uniform_rods(3);
    for (const auto& [first, second] : {std::pair(1e-3, 1e-5), std::pair(1e-5, 1e-3)}) {
        const std::tuple models(Hopeful{1e-7, first, 1.0}, Hopeful{1e-7, second, 2.0}, Hopeful{1e-4, 1e-4, 0.5});
        const Solution best = solve(models, rods, {.rtol = 1e-6});
        CHECK(best.status == Status::tolerance_not_met);
        CHECK(best.answer.worst_bound() == 1e-5);
    }
}

TEST_CASE("a budget of time, what cannot be had, and wrong questions") {
    const auto rods = Chain<double>::uniform_rods(100'000);
    const Choice quick = select(rods, {.count = 3, .rtol = 5e-16}, 1e-6);
    CHECK(!quick.meets_tolerance);
    CHECK(quick.estimates[quick.model].name == "continuous chain");
    const Solution best = solve(rods, {.count = 3, .rtol = 5e-16}, 1e-6);
    CHECK(best.status == Status::tolerance_not_met);
    CHECK(best.answer.worst_bound() < 2e-15);
    CHECK(solve(rods, {.count = 3, .rtol = 5e-16}).status == Status::success);
    const Solution beyond = solve(Chain<double>::uniform_rods(100), {.count = 3, .rtol = 1e-40});
    CHECK(beyond.status == Status::tolerance_not_met);
    CHECK(beyond.answer.worst_bound() <= 1e-24);
    CHECK(solve(rods, {.count = 3}).status == Status::success);  // as accurate as there is
    CHECK(select(rods, {.count = 3, .rtol = 0.5}, 1e-12).estimates.size() ==
          std::tuple_size_v<decltype(height_models)>);
    CHECK_THROWS_AS(select(rods, {.first = 0}), InvalidArgument);
    CHECK_THROWS_AS(select(rods, {.count = 0}), InvalidArgument);
    CHECK_THROWS_AS(select(rods, {.first = 100'000, .count = 2}), InvalidArgument);
    CHECK_THROWS_AS(select(rods, {.rtol = -1.0}), InvalidArgument);
    CHECK_THROWS_AS(select(rods, {.rtol = std::nan("")}), InvalidArgument);
    CHECK_THROWS_AS(select(rods, {.rtol = 0.1}, 0.0), InvalidArgument);
    // a message names the function that was called
    using Catch::Matchers::StartsWith;
    CHECK_THROWS_WITH(select(rods, {.first = 0}), StartsWith("revchain::select: first must be at least 1"));
    CHECK_THROWS_WITH(models::solve(rods, {.first = 0}), StartsWith("revchain::solve: first must be at least 1"));
    CHECK_THROWS_WITH(models::solve_by("bisection", rods, {.first = 0}),
                      StartsWith("revchain::solve_by: first must be at least 1"));
}

TEST_CASE("tolerances below an ulp: double-double, heights in two parts") {
    Random random(34);
    for (int i = 0; i < 30; ++i) {
        const Chain<double> chain = random_chain(random, static_cast<Index>(random.log_between(1, 200)));
        const Question question{.first = 1, .count = std::min<Index>(chain.mode_count(), 3), .rtol = 1e-20};
        const Solution found = solve(chain, question);
        CAPTURE(i, chain.size());
        REQUIRE(found.model == models::DoubleDoubleBisection::name);
        REQUIRE(found.status == Status::success);
        REQUIRE(found.answer.conical_height_low.size() == question.count);
        const Modes<double> rounded = modes(chain, {.count = question.count});
        for (Index j = 0; j < question.count; ++j) {
            REQUIRE(std::abs(found.answer.conical_height[j] / rounded.conical_height[j] - 1) <= 0x1p-52);
            REQUIRE(std::abs(found.answer.conical_height_low[j]) <= 0x1p-53 * found.answer.conical_height[j]);
        }
    }
}

TEST_CASE("at an inclination: the theory of small ones is off by no more than it says, or gives way") {
    double worst = 0, steepest = 0;
    for (const bool rods : {false, true})
        for (const Index n : {1, 2, 3, 4, 6, 10, 30}) {
            const auto chain = rods ? Chain<double>::uniform_rods(n, 2.0) : Chain<double>::uniform_plummets(n, 2.0);
            for (Index mode = 1; mode <= std::min<Index>(n, 4); ++mode)
                for (const double inclination : {1e-4, 0.01, 0.1, 0.3, 0.7, 1.1, 1.4}) {
                    const auto exact = shapes_on_branch(chain, {.mode = mode, .tip_inclination = inclination}, 1);
                    if (exact.shapes.empty()) continue;
                    const SteadyShape& shape = exact.shapes.front();
                    if (mode == 1 || (3 * mode <= n && mode * mode <= n))
                        steepest = std::max(steepest, shape.inclination.cwiseAbs().maxCoeff() / inclination);
                    CAPTURE(rods, n, mode, inclination);
                    for (const double rtol : {0.5, 1e-2, 1e-5, 1e-10}) {
                        const Solution found = solve(chain, {.first = mode, .rtol = rtol, .inclination = inclination});
                        const double error = std::abs(found.answer.conical_height[0] / shape.conical_height - 1);
                        CAPTURE(rtol, found.model, error);
                        REQUIRE(error <= found.answer.error_bound[0] + 4e-16);
                        if (found.status == Status::success) REQUIRE(found.answer.error_bound[0] <= rtol);
                        if (rtol > 1e-6) REQUIRE(found.status == Status::success);
                        worst = std::max(worst, error / found.answer.error_bound[0]);
                    }
                }
        }
    CAPTURE(worst, steepest);
    CHECK(steepest <= 1 + 1e-12);
    CHECK(worst > 0.2);
    Random random(35);
    const Chain<double> unlike = random_chain(random, 5);
    CHECK(solve(unlike, {.rtol = 1e-3, .inclination = 0.01}).model == models::FiniteAmplitude::name);
    CHECK(solve(unlike, {.rtol = 1e-3, .inclination = 1.5707963}).status == Status::tolerance_not_met);
    CHECK_THROWS_AS(select(unlike, {.inclination = 1.6}), InvalidArgument);
    CHECK_THROWS_AS(select(unlike, {.inclination = -0.1}), InvalidArgument);
}

TEST_CASE("at an inclination: up to mode sqrt(N) of equal links the lowest leans most, beyond twice that it does not") {
    bool other = false;
    for (const bool rods : {false, true})
        for (const Index n : {18, 30, 60, 100, 300, 1000}) {
            const auto chain = rods ? Chain<double>::uniform_rods(n, 2.0) : Chain<double>::uniform_plummets(n, 2.0);
            const auto last = static_cast<Index>(std::sqrt(static_cast<double>(n)));
            for (const Index mode : {last, last / 2, 2 * last})
                for (const double inclination : {0.02, 0.3, 0.8, 1.2, 1.4}) {
                    const auto exact = shapes_on_branch(chain, {.mode = mode, .tip_inclination = inclination}, 1);
                    if (exact.shapes.empty()) continue;
                    const double steepest = exact.shapes.front().inclination.cwiseAbs().maxCoeff() / inclination;
                    CAPTURE(rods, n, mode, inclination, steepest);
                    if (mode <= last) CHECK(steepest <= 1 + 1e-12);
                    if (mode > last) other = other || steepest > 1.5;
                    const Solution found = solve(chain, {.first = mode, .rtol = 0.9, .inclination = inclination});
                    const double error =
                        std::abs(found.answer.conical_height[0] / exact.shapes.front().conical_height - 1);
                    CHECK(error <= found.answer.error_bound[0] + 4e-16);
                }
        }
    CHECK(other);
}

TEST_CASE("no shape of the mode leans so far: no heights, and no success") {
    // all but the tip weighs next to nothing, and in the third mode hardly moves it: the links above would have to lean more
    // than a right angle
    std::vector<Link<double>> links;
    for (const double weight : {1e12, 1e9, 1e6, 1e3, 1.0}) links.push_back(uniform_rod(weight, 1.0));
    const Chain<double> chain(links);
    for (const double rtol : {1.0, 1e-6, 0.0}) {
        const Solution found = solve(chain, {.first = 3, .rtol = rtol, .inclination = 0.3});
        CHECK(found.status == Status::tolerance_not_met);
        CHECK(found.answer.conical_height.size() == 0);
        CHECK(!found.answer.found);
        CHECK(found.model.empty());
    }
}

TEST_CASE("heights below the normal numbers: bounds say what is lost") {
    const auto unit = Chain<double>::uniform_plummets(64, 64.0), rods = Chain<double>::uniform_rods(64, 64.0);
    for (const bool plummets : {false, true}) {
        const auto tiny =
            plummets ? Chain<double>::uniform_plummets(64, 0x1p-1054) : Chain<double>::uniform_rods(64, 0x1p-1054);
        const Modes<double> truth = modes(plummets ? unit : rods, {.count = 3});
        const auto check = [&](const auto& model) {
            for (const double rtol : {1e-2, 1e-6, 0.0}) {
                const Solution found = solve_by(model.name, tiny, {.count = 3, .rtol = rtol});
                CAPTURE(model.name, plummets, rtol);
                for (Index j = 0; j < found.answer.conical_height.size(); ++j) {
                    const double height = std::ldexp(found.answer.conical_height[j], 1060);
                    REQUIRE(std::abs(height / truth.conical_height[j] - 1) <= found.answer.error_bound[j] + 2e-16);
                }
            }
        };
        std::apply([&](const auto&... models) { (check(models), ...); }, height_models);
    }
}

TEST_CASE("links without inertia at an inclination: no model applies, and it is said") {
    const Chain<double> chain({plummet(1.0, 1.0), plummet(0.0, 1.0), plummet(1.0, 1.0), plummet(2.0, 1.0)});
    REQUIRE(chain.mode_count() == 3);
    for (const std::optional<double> budget : {std::optional<double>{}, std::optional<double>{1e-9}}) {
        const Question question{.count = 3, .rtol = 1e-3, .inclination = 0.3};
        const Choice choice = select(chain, question, budget);
        CHECK(choice.model == choice.estimates.size());
        CHECK(!choice.meets_tolerance);
        const Solution found = solve(chain, question, budget);
        CHECK(found.status == Status::tolerance_not_met);
        CHECK(found.model.empty());
        CHECK(found.answer.conical_height.size() == 0);
    }
    CHECK(select(chain, {.count = 3}, 1e-12).model < std::tuple_size_v<decltype(height_models)>);
}

TEST_CASE("errors of a model and of small inclinations: both of the exact height") {
    const auto rods = Chain<double>::uniform_plummets(20);
    const Question straight{.first = 2, .rtol = 0.5}, leaning{.first = 2, .rtol = 0.5, .inclination = 1.0};
    const double off = 1 / std::cos(1.0) - 1;
    const models::ContinuousChain model;
    const ChainKind kind(rods);
    const double bound = model.error_bound(kind, straight);
    const Solution found = solve_by(model.name, rods, leaning);
    CHECK(found.answer.error_bound[0] == Approx((1 + bound) * (1 + off) - 1).epsilon(1e-12));
    const Choice choice = select(std::tuple(model), rods, leaning);
    CHECK(choice.estimates[0].error_bound == Approx(found.answer.error_bound[0]).epsilon(1e-12));
}
