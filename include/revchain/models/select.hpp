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
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/status.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A model's properties for one question, before it is solved.
struct Estimate {
    std::string_view name;
    Fit fit;
    double error_bound = std::numeric_limits<double>::infinity();  ///< relative
    double cost = std::numeric_limits<double>::infinity();         ///< seconds, predicted
};

namespace models {

using revchain::detail::throw_invalid;

/// The choice of `select`: `model` is an index into `estimates`, past the last if none applies. If
/// `meets_tolerance` is false, no model within the budget meets the tolerance. `model` is then the
/// most accurate within the budget, or else the cheapest.
template <std::size_t N>
struct Choice {
    std::array<Estimate, N> estimates;
    std::size_t model = 0;
    bool meets_tolerance = false;
};

/// An answer and the name of the model that gave it.
struct Solution {
    Answer answer;
    std::string_view model;
    Status status = Status::success;
};

namespace detail {

/// Throws InvalidArgument, with the name of the function, for a question that no model can answer.
REVCHAIN_LAZY
void check(std::string_view function, const ChainKind& kind, const Question& question) {
    if (question.first < 1) throw_invalid(function, "first must be at least 1", question.first);
    if (question.count < 1) throw_invalid(function, "count must be at least 1", question.count);
    if (question.last() > kind.mode_count)
        throw_invalid(function,
                      "the number of the last mode, first + count - 1, must be at most " +
                          std::to_string(kind.mode_count) + ", the number of modes",
                      question.last());
    if (!(question.rtol >= 0))
        throw_invalid(function, "rtol must not be negative or NaN", question.rtol);
    if (!(question.inclination >= 0 && question.inclination < std::numbers::pi / 2))
        throw_invalid(function, "inclination must be at least 0 and less than a right angle",
                      question.inclination);
}

/// Returns the tolerance to meet: the requested one, or full accuracy.
REVCHAIN_LAZY
double required_tolerance(const Question& question) {
    return question.rtol > 0 ? question.rtol : full_accuracy;
}

template <Model M>
Estimate estimate(const M& model, const ChainKind& kind, const Question& question) {
    if (question.proved && !is_proved<M>())
        return {model.name, Fit::no("its bound is not proved by counts")};
    Estimate estimate{model.name, model.applies(kind, question)};
    const double off = is_linear<M>() ? error_of_small_inclinations(kind, question) : 0;
    if (estimate.fit.applies && !(off < 1))
        estimate.fit =
            Fit::no("for small inclinations only; its error at this inclination has no bound");
    if (!estimate.fit.applies) return estimate;
    estimate.error_bound = model.error_bound(kind, question);
    estimate.cost = model.cost(kind, question);
    estimate.error_bound += off * (1 + estimate.error_bound);
    return estimate;
}

template <Model... Models>
std::array<Estimate, sizeof...(Models)> estimates(const std::tuple<Models...>& models,
                                                  const ChainKind& kind, const Question& question) {
    return std::apply(
        [&](const Models&... each) { return std::array{estimate(each, kind, question)...}; },
        models);
}

/// Returns the cheapest model that meets the tolerance, of those within the budget that apply and
/// are not `out`. If none of these does, returns the most accurate of them, the cheaper of equals.
/// With an infinite `rtol` it returns the cheapest.
template <std::size_t N>
std::optional<std::size_t> best(const std::array<Estimate, N>& estimates,
                                const std::array<bool, N>& out, double rtol, double budget) {
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

/// Returns the answer of one model. Its bounds are widened for effects that the model does not
/// include: digits lost in subnormal numbers, and inclinations.
template <Model M>
Answer answer_by(const M& model, const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) {
    Answer answer = model.solve(chain, kind, question);
    constexpr double least = std::numeric_limits<double>::denorm_min();
    for (Index j = 0; j < answer.conical_height.size(); ++j)
        if (!(answer.conical_height[j] >= std::numeric_limits<double>::min()))
            answer.error_bound[j] += 4 * least / std::max(0.0, answer.conical_height[j]);
        else if (!std::isfinite(answer.conical_height[j]))
            answer.error_bound[j] = std::numeric_limits<double>::infinity();
    if (is_linear<M>() && question.inclination > 0) {
        const double off = error_of_small_inclinations(kind, question);
        for (double& bound : answer.error_bound) bound += off * (1 + bound);
    }
    return answer;
}

/// Returns the answer of the model with that index.
template <Model... Models>
Answer answer_by_number(const std::tuple<Models...>& models, std::size_t number,
                        const Chain<double>& chain, const ChainKind& kind,
                        const Question& question) {
    Answer answer;
    std::size_t i = 0;
    const auto answer_if_chosen = [&](const auto& model) {
        if (i++ == number) answer = answer_by(model, chain, kind, question);
    };
    std::apply([&](const Models&... each) { (answer_if_chosen(each), ...); }, models);
    return answer;
}

/// Does `select` for the function of that name.
template <Model... Models>
Choice<sizeof...(Models)> choice_for(std::string_view function, const std::tuple<Models...>& models,
                                     const ChainKind& kind, const Question& question,
                                     std::optional<double> time_budget) {
    check(function, kind, question);
    if (time_budget) revchain::detail::require_positive(function, "time budget", *time_budget);
    Choice<sizeof...(Models)> choice{estimates(models, kind, question), 0, false};
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double budget = time_budget.value_or(infinity);
    auto chosen =
        best<sizeof...(Models)>(choice.estimates, {}, required_tolerance(question), budget);
    if (!chosen)  // no model is within the budget: the cheapest, whatever its accuracy
        chosen = best<sizeof...(Models)>(choice.estimates, {}, infinity, infinity);
    choice.model = chosen.value_or(sizeof...(Models));
    choice.meets_tolerance =
        chosen && choice.estimates[*chosen].error_bound <= required_tolerance(question) &&
        choice.estimates[*chosen].cost <= budget;
    return choice;
}

}  // namespace detail

/// Chooses the cheapest model whose bound meets the tolerance. With a `time_budget` in seconds, its
/// time must be within the budget too. If there is no such model, the choice is the most accurate
/// within the budget, or else the cheapest. Cost: 0.2 microseconds; no link is read.
/// Throws InvalidArgument for modes that do not exist, a tolerance that is negative or NaN, an
/// inclination not between 0 and a right angle, and a budget that is not positive and finite.
template <Model... Models>
Choice<sizeof...(Models)> select(const std::tuple<Models...>& models, const ChainKind& kind,
                                 const Question& question,
                                 std::optional<double> time_budget = std::nullopt) {
    return detail::choice_for("select", models, kind, question, time_budget);
}
template <Model... Models>
Choice<sizeof...(Models)> select(const std::tuple<Models...>& models, const Chain<double>& chain,
                                 const Question& question,
                                 std::optional<double> time_budget = std::nullopt) {
    return select(models, ChainKind(chain), question, time_budget);
}

/// Returns the requested heights by the chosen model. If that model has no answer, or a bound worse
/// than predicted and requested, the next best is tried. The status is `tolerance_not_met` if no
/// model within the budget meets the tolerance; the bounds are then the best available. There are
/// no heights if no model applies, as for unequal links without inertia at an inclination, or if no
/// model of the list has an answer. Throws InvalidArgument as `select`.
template <Model... Models>
Solution solve(const std::tuple<Models...>& models, const Chain<double>& chain,
               const Question& question, std::optional<double> time_budget = std::nullopt) {
    const ChainKind kind(chain);
    const auto choice = detail::choice_for("solve", models, kind, question, time_budget);
    const double rtol = detail::required_tolerance(question);
    const double budget = time_budget.value_or(std::numeric_limits<double>::infinity());
    std::array<bool, sizeof...(Models)> out{};
    Solution best{Answer::none(), {}, Status::tolerance_not_met};
    if (choice.model == sizeof...(Models)) return best;
    for (std::optional<std::size_t> model = choice.model; model;) {
        const std::string_view name = choice.estimates[*model].name;
        Answer answer = detail::answer_by_number(models, *model, chain, kind, question);
        const double bound = answer.worst_bound();
        if (bound <= rtol && choice.estimates[*model].cost <= budget)
            return {std::move(answer), name, Status::success};
        if (answer.found && (best.model.empty() || bound < best.answer.worst_bound()))
            best = {std::move(answer), name, Status::tolerance_not_met};
        out[*model] = true;
        model = detail::best(choice.estimates, out, rtol, budget);
        if (model && !best.model.empty() &&
            !(choice.estimates[*model].error_bound < best.answer.worst_bound()))
            break;
    }
    return best;
}

/// Returns the heights by the model of that name, even if others would be faster or more accurate.
/// There are no heights if the model does not apply or finds no answer. The status is then
/// `tolerance_not_met`, as it is if the bound exceeds the tolerance.
/// Throws InvalidArgument as `select`, and for a name that no model has.
template <Model... Models>
Solution solve_by(const std::tuple<Models...>& models, std::string_view model,
                  const Chain<double>& chain, const Question& question) {
    const ChainKind kind(chain);
    detail::check("solve_by", kind, question);
    const auto estimates = detail::estimates(models, kind, question);
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        if (estimates[i].name != model) continue;
        Solution found{Answer::none(), estimates[i].name, Status::tolerance_not_met};
        if (!estimates[i].fit.applies) return found;
        found.answer = detail::answer_by_number(models, i, chain, kind, question);
        if (found.answer.worst_bound() <= detail::required_tolerance(question))
            found.status = Status::success;
        return found;
    }
    throw_invalid("solve_by", "there is no model " + std::string(model));
}

}  // namespace models
}  // namespace revchain
