// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "revchain/models/model.hpp"
#include "revchain/numeric/status.hpp"

namespace revchain {

/// What is known of a model before it is asked.
struct Estimate {
    std::string_view name;
    Fit fit;
    double error_bound = std::numeric_limits<double>::infinity();  ///< relative
    double cost = std::numeric_limits<double>::infinity();         ///< seconds, predicted
};

/// What `select` chose: `model` is an index into `estimates`, past the last where none applies. `meets_tolerance`
/// false: none does (within the budget), and this is the most accurate.
template <std::size_t N>
struct Choice {
    std::array<Estimate, N> estimates;
    std::size_t model = 0;
    bool meets_tolerance = false;
};

/// An answer and who gave it.
struct Solution {
    Answer answer;
    std::string_view model;
    Status status = Status::success;
};

namespace detail {

inline void check(const ChainKind& kind, const Question& question) {
    if (question.first < 1) throw_invalid("select", "first must be at least 1", question.first);
    if (question.count < 1) throw_invalid("select", "count must be at least 1", question.count);
    if (question.last() > kind.mode_count)
        throw_invalid(
            "select",
            "the last mode asked for must be at most number " + std::to_string(kind.mode_count) + ", the last there is",
            question.last());
    if (!(question.rtol >= 0)) throw_invalid("select", "rtol must not be negative or NaN", question.rtol);
    if (!(question.inclination >= 0 && question.inclination < std::numbers::pi / 2))
        throw_invalid("select", "inclination must be at least 0 and less than a right angle", question.inclination);
}

/// The tolerance to be kept; where none is said, what any chain's heights can be had to in double: 2 ulp.
inline double goal(const Question& question) { return question.rtol > 0 ? question.rtol : 2.001 * epsilon<double>(); }

template <Model M>
Estimate estimate(const M& model, const ChainKind& kind, const Question& question) {
    if (question.proved && !is_proved<M>()) return {model.name, Fit::no("its bound is not proved by counts")};
    Estimate estimate{model.name, model.applies(kind, question)};
    const double off = is_linear<M>() ? error_of_small_inclinations(kind, question) : 0;
    if (estimate.fit.applies && !(off < 1))
        estimate.fit = Fit::no("of small inclinations; how far that is off is not known here");
    if (!estimate.fit.applies) return estimate;
    estimate.error_bound = model.error_bound(kind, question), estimate.cost = model.cost(kind, question);
    estimate.error_bound += off * (1 + estimate.error_bound);
    return estimate;
}

template <Model... Models>
std::array<Estimate, sizeof...(Models)> estimates(const std::tuple<Models...>& models, const ChainKind& kind,
                                                  const Question& question) {
    return std::apply(
        [&](const Models&... each) {
            return std::array<Estimate, sizeof...(Models)>{estimate(each, kind, question)...};
        },
        models);
}

/// Of those left: the cheapest that keeps the tolerance, else the most accurate, the cheaper of equals.
template <std::size_t N>
std::optional<std::size_t> best(const std::array<Estimate, N>& estimates, const std::array<bool, N>& out, double rtol,
                                double budget) {
    std::optional<std::size_t> chosen;
    const auto better = [&](const Estimate& x, const Estimate& y) {
        const bool x_meets = x.error_bound <= rtol, y_meets = y.error_bound <= rtol;
        if (x_meets != y_meets) return x_meets;
        if (x_meets || x.error_bound == y.error_bound) return x.cost < y.cost;
        return x.error_bound < y.error_bound;
    };
    for (std::size_t i = 0; i < N; ++i) {
        if (out[i] || !estimates[i].fit.applies || !(estimates[i].cost <= budget)) continue;
        if (!chosen || better(estimates[i], estimates[*chosen])) chosen = i;
    }
    return chosen;
}

template <Model... Models>
Answer asked(const std::tuple<Models...>& models, std::size_t number, const Chain<double>& chain, const ChainKind& kind,
             const Question& question) {
    Answer answer;
    std::size_t i = 0;
    const auto ask = [&]<class M>(const M& model) {
        if (i++ != number) return;
        answer = model.solve(chain, kind, question);
        constexpr double least = std::numeric_limits<double>::denorm_min();
        for (Index j = 0; j < answer.conical_height.size(); ++j)  // what a number below the normal ones cannot hold
            if (!(answer.conical_height[j] >= std::numeric_limits<double>::min()))
                answer.error_bound[j] += 4 * least / std::max(0.0, answer.conical_height[j]);
            else if (!std::isfinite(answer.conical_height[j]))
                answer.error_bound[j] = std::numeric_limits<double>::infinity();
        if (!is_linear<M>() || !(question.inclination > 0)) return;
        const double off = error_of_small_inclinations(kind, question);
        for (double& bound : answer.error_bound) bound += off * (1 + bound);
    };
    std::apply([&](const Models&... each) { (ask(each), ...); }, models);
    return answer;
}

}  // namespace detail

/// Which model answers: the cheapest whose bound keeps the tolerance; with a `time_budget` in seconds the most accurate
/// within it if none does both, and the cheapest, which then does not meet the tolerance, if none is as cheap. Cost:
/// 0.2 microseconds; no link is looked at.
/// Throws InvalidArgument for modes that are not there, a tolerance that is negative or NaN, a budget that is not
/// positive.
template <Model... Models>
Choice<sizeof...(Models)> select(const std::tuple<Models...>& models, const ChainKind& kind, const Question& question,
                                 std::optional<double> time_budget = std::nullopt) {
    detail::check(kind, question);
    if (time_budget) detail::require_positive("select", "time budget", *time_budget);
    Choice<sizeof...(Models)> choice{detail::estimates(models, kind, question), 0, false};
    const double budget = time_budget.value_or(std::numeric_limits<double>::infinity());
    auto chosen = detail::best<sizeof...(Models)>(choice.estimates, {}, detail::goal(question), budget);
    if (!chosen)  // nothing is as cheap: the cheapest there is
        for (std::size_t i = 0; i < sizeof...(Models); ++i)
            if (choice.estimates[i].fit.applies &&
                (!chosen || choice.estimates[i].cost < choice.estimates[*chosen].cost))
                chosen = i;
    choice.model = chosen.value_or(sizeof...(Models));
    choice.meets_tolerance = chosen && choice.estimates[*chosen].error_bound <= detail::goal(question) &&
                             choice.estimates[*chosen].cost <= budget;
    return choice;
}
template <Model... Models>
Choice<sizeof...(Models)> select(const std::tuple<Models...>& models, const Chain<double>& chain,
                                 const Question& question, std::optional<double> time_budget = std::nullopt) {
    return select(models, ChainKind(chain), question, time_budget);
}

/// The heights asked for, by the model chosen. One that finds that it has no answer after all, or a worse bound than it
/// foresaw and than is asked for, is left out and the next one asked. Status `tolerance_not_met` where nothing keeps
/// the tolerance (within the budget); the bounds are then the best there are. Without any answer there are no heights:
/// of unlike links without inertia at an inclination, where no model applies, or of a model list without one that
/// always has one.
template <Model... Models>
Solution solve(const std::tuple<Models...>& models, const Chain<double>& chain, const Question& question,
               std::optional<double> time_budget = std::nullopt) {
    const ChainKind kind(chain);
    const auto choice = select(models, kind, question, time_budget);
    const double rtol = detail::goal(question), budget = time_budget.value_or(std::numeric_limits<double>::infinity());
    std::array<bool, sizeof...(Models)> out{};
    Solution best{Answer::none(), {}, Status::tolerance_not_met};
    if (choice.model == sizeof...(Models)) return best;
    for (std::optional<std::size_t> model = choice.model; model;) {
        const std::string_view name = choice.estimates[*model].name;
        Answer answer = detail::asked(models, *model, chain, kind, question);
        const double bound = answer.worst_bound();
        if (bound <= rtol && choice.estimates[*model].cost <= budget) return {std::move(answer), name, Status::success};
        if (answer.found && (best.model.empty() || bound < best.answer.worst_bound()))
            best = {std::move(answer), name, Status::tolerance_not_met};
        out[*model] = true;
        model = detail::best(choice.estimates, out, rtol, budget);
        if (model && !best.model.empty() && !(choice.estimates[*model].error_bound < best.answer.worst_bound())) break;
    }
    return best;
}

/// By the model of that name, whatever others would cost. No heights, and `tolerance_not_met`, where it does not apply
/// or finds no answer; that status, too, where its bound is larger than the tolerance.
/// Throws InvalidArgument as `select`, and for a name that no model has.
template <Model... Models>
Solution solve_by(const std::tuple<Models...>& models, std::string_view model, const Chain<double>& chain,
                  const Question& question) {
    const ChainKind kind(chain);
    detail::check(kind, question);
    const auto estimates = detail::estimates(models, kind, question);
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        if (estimates[i].name != model) continue;
        Solution found{Answer::none(), estimates[i].name, Status::tolerance_not_met};
        if (!estimates[i].fit.applies) return found;
        found.answer = detail::asked(models, i, chain, kind, question);
        if (found.answer.worst_bound() <= detail::goal(question)) found.status = Status::success;
        return found;
    }
    detail::throw_invalid("solve_by", "there is no model " + std::string(model));
}

}  // namespace revchain
