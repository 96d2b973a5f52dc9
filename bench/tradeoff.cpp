// SPDX-License-Identifier: MPL-2.0
// What digits cost: every model by its name, over a grid of chains, modes, inclinations and tolerances, as CSV on stdout.
//   bench_tradeoff [--quick]    two to three minutes; quick: a third of one, small chains, every third tolerance
// A row is what a model answers to all tolerances from `loosest` to `tightest`, to which it does the same work: worst relative
// error against the truth, worst error bound, predicted and measured microseconds of CPU time (median of rounds in which all
// models take turns, in a new order each), and the tolerances at which `select` chooses it. A row without an error: no answer,
// or not asked, since it is expected to take more than half a second. Beyond 10 ms every third tolerance is asked.
//
// Truth. At no inclination: heights in quadruple precision (tradeoff/height_truth.hpp), of 100,000 links, of which no model is
// asked for more than double, in double words (1e-26). At one: shapes shot from the free end in quadruple precision
// (tradeoff/inclined_truth.hpp). Both start near a height of the library's; counts of nodes show that it is the right one.
//
// Where no shape of the mode leans so far (the heavy tip's third), no answer must be called a success.
//
// Exit status 1: an error above its bound; an answer of `solve` that is not a success or whose bound is above the tolerance,
// though a model asked by its name keeps it; or a time in which the work cannot have been done. 2: an answer made wrong is not
// found out. Last lines, on stderr: how good choices and predictions were, and who is the cheapest how often.
#include <cstdio>
#include <cstring>
#include <map>
#include <random>

#include "dense_model.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "timing.hpp"
#include "tradeoff/height_truth.hpp"
#include "tradeoff/inclined_truth.hpp"
#include "tradeoff/scenes.hpp"

namespace {

using namespace revchain;
using namespace revchain::models;
using support::Quad;

constexpr double patience = 0.5, slow = 0.01;  // seconds
double sink = 0;

struct Row {
    std::string_view model;
    double predicted = 0, loosest = 0, tightest = 0;
    Answer answer;
    double error = 0, bound = 0;
    double chosen_from = 0, chosen_to = 0;  ///< tolerances at which it is chosen; 0: none
    std::vector<double> times{};

    double time() const { return bench::median(times); }
    bool serves(double rtol) const { return tightest <= rtol && rtol <= loosest; }
};

struct Tally {
    int asked = 0, violated = 0, implausible = 0, not_kept = 0, choices = 0, good = 0, fallen_back = 0;
    int predicted = 0, mispredicted = 0;      ///< times, and those off by more than a factor of 3
    std::map<std::string, int> wins, chosen;  ///< how often a model is the cheapest that keeps a tolerance, and chosen
    std::vector<std::pair<double, std::string>> worst;
};

bool same(const Vector<double>& x, const Vector<double>& y) {
    return x.size() == y.size() && (x.array() == y.array()).all();
}

/// Whether two answers are one to the last digit.
bool same(const Answer& x, const Answer& y) {
    return x.found == y.found && same(x.conical_height, y.conical_height) && same(x.error_bound, y.error_bound) &&
           same(x.conical_height_low, y.conical_height_low);
}

/// Worst error of an answer; `share`: the worst of error over bound.
double error_of(const Answer& answer, const std::vector<Quad>& truth, double& share) {
    double worst = 0;
    for (Index j = 0; j < answer.conical_height.size(); ++j) {
        const Quad exact = truth[static_cast<std::size_t>(j)];
        Quad off = Quad(answer.conical_height[j]) - exact;
        if (answer.conical_height_low.size() > 0) off += Quad(answer.conical_height_low[j]);
        const double error = static_cast<double>(fabsq(off) / exact);
        worst = std::max(worst, error), share = std::max(share, error / answer.error_bound[j]);
    }
    return worst;
}

std::vector<Quad> truth_of(const Chain<double>& chain, Index count) {
    const Modes<double> near = modes(chain, {.count = count}, revchain::methods::all);
    std::vector<Quad> truth;
    const auto find = [&](const auto& heights) {
        for (Index j = 0; j < count; ++j)
            truth.push_back(heights.height(static_cast<std::size_t>(j), near.conical_height[j]));
    };
    if (chain.size() > 20'000)
        find(bench::HeightTruth<DoubleWord<double>>(chain));
    else
        find(bench::HeightTruth<Quad>(chain));
    return truth;
}

/// Whether an answer three bounds off is found out.
bool finds_a_wrong_answer() {
    const auto chain = Chain<double>::uniform_rods(300);
    Answer wrong = solve(height_models_with_dense, chain, {.count = 3, .rtol = 1e-15}).answer;
    wrong.conical_height[1] *= 1 - 3 * wrong.error_bound[1];
    double share = 0;
    error_of(wrong, truth_of(chain, 3), share);
    return share > 1;
}

class Bench {
   public:
    explicit Bench(std::vector<double> tolerances) : tolerances_(std::move(tolerances)) {
        std::printf(
            "scene,links,modes,inclination,model,loosest,tightest,error,bound,predicted_us,took_us,chosen_from,chosen_"
            "to\n");
    }

    void ask(const std::string& scene, const Chain<double>& chain, Index count, double inclination,
             const std::vector<Quad>& truth) {
        char name[160];
        std::snprintf(name, sizeof name, "%s,%td,%td,%g", scene.c_str(), chain.size(), count, inclination);
        std::vector<Row> rows;
        for (const double rtol : tolerances_) ask_all(name, chain, {1, count, rtol, inclination}, truth, rows);
        measure(chain, count, inclination, rows);
        for (const double rtol : tolerances_) judge(name, rtol, chain.size(), rows);
        for (const Row& row : rows) print(name, row);
    }

    /// What no shape answers must not be answered.
    void ask_in_vain(const std::string& scene, const Chain<double>& chain, Index count, double inclination) {
        char name[160];
        std::snprintf(name, sizeof name, "%s,%td,%td,%g", scene.c_str(), chain.size(), count, inclination);
        for (const double rtol : tolerances_) {
            const Solution found = solve(height_models_with_dense, chain, {1, count, rtol, inclination});
            Row row{found.model, 0, rtol, rtol, {}};
            if (found.status == Status::success || found.answer.conical_height.size() > 0)
                report(tally.violated, "%.0f heights though there is no such shape: %s, %s, rtol %g",
                       static_cast<double>(found.answer.conical_height.size()), row, name);
        }
    }

    Tally tally;

   private:
    void ask_all(const char* name, const Chain<double>& chain, const Question& question, const std::vector<Quad>& truth,
                 std::vector<Row>& rows) {
        const auto choice = select(height_models_with_dense, chain, question);
        bool kept = false;
        for (std::size_t i = 0; i < choice.estimates.size(); ++i) {
            const Estimate& estimate = choice.estimates[i];
            if (!estimate.fit.applies) continue;
            const auto digits = std::lround(-std::log10(question.rtol));
            if (estimate.cost > slow && estimate.cost <= patience && digits <= 15 && digits % 3 != 0) continue;
            Row row{estimate.name, estimate.cost, question.rtol, question.rtol, {{}, {}, false}};
            if (estimate.cost <= patience) {
                const double start = bench::cpu_seconds();
                Solution found = solve_by(height_models_with_dense, estimate.name, chain, question);
                const double took = bench::cpu_seconds() - start;
                if (took > slow) row.times.push_back(took);
                row.answer = std::move(found.answer), ++tally.asked;
                kept = kept || found.status == Status::success;
                if (row.answer.found) {
                    double share = 0;
                    row.error = error_of(row.answer, truth, share), row.bound = row.answer.worst_bound();
                    if (!(share <= 1))
                        report(tally.violated, "error %.3g of the bound: %s, %s, rtol %g", share, row, name);
                }
            }
            add(std::move(row), choice.model == i, rows);
        }
        if (choice.estimates[choice.model].cost > patience) return;
        const Solution found = solve(height_models_with_dense, chain, question);
        double share = 0;
        error_of(found.answer, truth, share);
        Row row{found.model, 0, question.rtol, question.rtol, {}};
        if (!(share <= 1))
            report(tally.violated, "error %.3g of the bound of solve: %s, %s, rtol %g", share, row, name);
        if ((kept && found.status != Status::success) ||
            (found.status == Status::success && !(found.answer.worst_bound() <= question.rtol)))
            report(tally.not_kept, "bound %.3g of solve: %s, %s, rtol %g", found.answer.worst_bound(), row, name);
        if (found.model != choice.estimates[choice.model].name) ++tally.fallen_back;
    }

    void report(int& count, const char* format, double number, const Row& row, const char* name) {
        ++count;
        std::fprintf(stderr, format, number, std::string(row.model).c_str(), name, row.tightest);
        std::fputc('\n', stderr);
    }

    /// To the row of the tolerance before where the work is the same.
    static void add(Row row, bool chosen, std::vector<Row>& rows) {
        Row* before = nullptr;
        for (Row& other : rows)
            if (other.model == row.model) before = &other;
        if (before == nullptr || before->predicted != row.predicted || !same(before->answer, row.answer))
            before = &rows.emplace_back(std::move(row));
        else
            before->tightest = row.tightest,
            before->times.insert(before->times.end(), row.times.begin(), row.times.end());
        if (!chosen) return;
        if (before->chosen_from == 0) before->chosen_from = before->tightest;
        before->chosen_to = before->tightest;
    }

    /// Models take turns, those that answer in no time many times over.
    void measure(const Chain<double>& chain, Index count, double inclination, std::vector<Row>& rows) {
        std::vector<Row*> due;
        for (Row& row : rows)
            if (row.answer.found && row.times.empty()) due.push_back(&row);
        for (int round = 0; round < 5; ++round) {
            std::shuffle(due.begin(), due.end(), order_);
            for (Row* row : due) {
                if (round > 2 && row->times[0] > 2e-3) continue;
                const Question question{1, count, row->tightest, inclination};
                row->times.push_back(bench::seconds_of(
                    [&] {
                        sink +=
                            solve_by(height_models_with_dense, row->model, chain, question).answer.conical_height[0];
                    },
                    1e-4));
            }
        }
    }

    /// How good the choice was: who is chosen, and who has to be asked after that, against the cheapest that keeps `rtol`.
    void judge(const char* name, double rtol, Index size, const std::vector<Row>& rows) {
        const Row *chosen = nullptr, *best = nullptr;
        for (const Row& row : rows) {
            if (!row.answer.found || !row.serves(rtol)) continue;
            const double floor = 2e-9 + (reads_links(name, row.model) ? 5e-11 * static_cast<double>(size) : 0.0);
            if (row.time() < floor)
                report(tally.implausible, "%.3g s is too little: %s, %s, rtol %g", row.time(), row, name);
            if (row.chosen_from >= rtol && rtol >= row.chosen_to) chosen = &row;
            if (row.bound <= rtol && (best == nullptr || row.time() < best->time())) best = &row;
        }
        if (chosen == nullptr || best == nullptr) return;
        ++tally.wins[std::string(best->model)], ++tally.chosen[std::string(chosen->model)];
        const bool kept = chosen->bound <= rtol;
        const double took = chosen->time() + (kept ? 0 : best->time()), ratio = took / best->time();
        ++tally.choices, tally.good += ratio <= 2 || took < 2e-7;
        if (ratio <= 2 || took < 2e-7) return;
        char text[320];
        std::snprintf(text, sizeof text, "%s, rtol %g: %s, %.3g us, for %s, %.3g us", name, rtol,
                      std::string(chosen->model).c_str(), 1e6 * took, std::string(best->model).c_str(),
                      1e6 * best->time());
        tally.worst.emplace_back(ratio, text);
    }

    /// Equal links are known at once; of others every number has to be read.
    static bool reads_links(const char* name, std::string_view model) {
        return std::strncmp(name, "equal", 5) != 0 && model != models::TaperedChain::name;
    }

    void print(const char* name, const Row& row) {
        const std::string model(row.model);
        std::printf("%s,%s,%g,%g,", name, model.c_str(), row.loosest, row.tightest);
        if (row.answer.found) {
            const double ratio = row.time() / row.predicted;
            ++tally.predicted;
            if (ratio > 3 || ratio < 1.0 / 3)
                report(tally.mispredicted, "%.2f of the time predicted: %s, %s, rtol %g", ratio, row, name);
            std::printf("%.3g,%.3g,%.3g,%.3g,", row.error, row.bound, 1e6 * row.predicted, 1e6 * row.time());
        } else {
            std::printf(",,%.3g,,", 1e6 * row.predicted);
        }
        if (row.chosen_from > 0) std::printf("%g,%g", row.chosen_from, row.chosen_to);
        std::printf(row.chosen_from > 0 ? "\n" : ",\n");
        std::fflush(stdout);
    }

    std::vector<double> tolerances_;
    std::mt19937 order_{1};
};

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    if (!finds_a_wrong_answer()) return std::fputs("a wrong answer was not found out\n", stderr), 2;
    std::vector<double> tolerances;
    for (int digits = 0; digits <= 15; digits += quick ? 3 : 1) tolerances.push_back(std::pow(10.0, -digits));
    tolerances.insert(tolerances.end(), {1e-20, 1e-26});
    Bench bench(tolerances);
    for (const auto& family : bench::tradeoff_families())
        for (const Index size : {2, 5, 10, 100, 1000, 10'000, 100'000}) {
            if (quick && size > 1000) continue;
            const Chain<double> chain = family.make(size);
            const auto truth = truth_of(chain, std::min<Index>(size, 30));
            for (const Index count : {1, 3, 10, 30})
                if (count <= size) bench.ask(family.name, chain, count, 0, truth);
            if (size > (quick ? 100 : 1000)) continue;
            const bench::InclinedTruth at(chain);
            for (const double inclination : {0.01, 0.3, 1.0})
                for (const Index count : {1, 3}) {
                    std::vector<Quad> leaning;
                    for (Index mode = 1; mode <= std::min(count, size); ++mode)
                        if (const auto h = at.height(mode, truth[static_cast<std::size_t>(mode - 1)], inclination))
                            leaning.push_back(*h);
                    if (static_cast<Index>(leaning.size()) == count)
                        bench.ask(family.name, chain, count, inclination, leaning);
                    else if (count <= size)
                        bench.ask_in_vain(family.name, chain, count, inclination);
                }
        }
    Tally& tally = bench.tally;
    std::fprintf(stderr, "%d answers asked; %d errors above their bound, %d tolerances not kept, %d times too short\n",
                 tally.asked, tally.violated, tally.not_kept, tally.implausible);
    std::fprintf(stderr,
                 "%d choices, %d (%.1f %%) within a factor of 2 of the cheapest; %d times another had to be asked\n",
                 tally.choices, tally.good, 100.0 * tally.good / tally.choices, tally.fallen_back);
    std::sort(tally.worst.rbegin(), tally.worst.rend());
    for (std::size_t i = 0; i < std::min<std::size_t>(tally.worst.size(), 20); ++i)
        std::fprintf(stderr, "  %.1f x: %s\n", tally.worst[i].first, tally.worst[i].second.c_str());
    std::fprintf(stderr, "%d times predicted, %d beyond a factor of 3\n", tally.predicted, tally.mispredicted);
    for (const Estimate& estimate : select(Chain<double>::uniform_rods(2), {}).estimates) {
        const std::string model(estimate.name);
        std::fprintf(stderr, "%s: the cheapest %d times, chosen %d times\n", model.c_str(), tally.wins[model],
                     tally.chosen[model]);
    }
    return !std::isfinite(sink) || tally.violated + tally.not_kept + tally.implausible > 0 ? 1 : 0;
}
