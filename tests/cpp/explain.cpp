// SPDX-License-Identifier: MPL-2.0
#include "revchain/explain.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "revchain/models/heights.hpp"
#include "support/catch.hpp"

using namespace revchain;
using namespace revchain::models;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

template <class Choice>
Explanation explanation(const Choice& choice) {
    return {{choice.estimates.begin(), choice.estimates.end()}, choice.model, choice.meets_tolerance};
}

template <class Choice>
std::vector<std::string> explained(const Choice& choice) {
    const std::string text = explanation(choice).text();
    REQUIRE(text.back() == '\n');
    const auto lines = lines_of(text);
    REQUIRE(lines.size() == choice.estimates.size() + (choice.meets_tolerance ? 1 : 2));
    return lines;
}

}  // namespace

TEST_CASE("explain: a row for every model, one mark, the reasons and the numbers of the choice") {
    for (const double inclination : {0.0, 0.1})
        for (const Index size : {1, 2, 5, 100, 100'000})
            for (const double rtol : {0.5, 1e-3, 1e-12, 0.0, 1e-40}) {
                const auto chain = Chain<double>::uniform_rods(size);
                const Choice choice = select(chain, {.rtol = rtol, .inclination = inclination});
                CAPTURE(size, rtol, inclination);
                const auto lines = explained(choice);
                const std::size_t head = choice.meets_tolerance ? 0 : 1;
                if (head == 1) REQUIRE(lines[0] == "no model keeps the tolerance");
                const std::size_t bounds = lines[head].find("error bound"),
                                  times = lines[head].find("expected to take");
                for (std::size_t i = 0; i < choice.estimates.size(); ++i) {
                    const Estimate& model = choice.estimates[i];
                    const std::string& line = lines[head + 1 + i];
                    CAPTURE(line);
                    REQUIRE(line.substr(0, 3) == (i == choice.model ? "-> " : "   "));
                    REQUIRE(line.compare(3, model.name.size(), model.name) == 0);
                    REQUIRE(line.back() != ' ');
                    if (!model.fit.applies) {
                        REQUIRE(line.find('-', 3 + model.name.size()) ==
                                bounds + std::string("error bound").size() - 1);
                        REQUIRE(line.ends_with(std::string(model.fit.reason)));
                        continue;
                    }
                    // numbers as they are, to the digits shown
                    REQUIRE(std::abs(std::stod(line.substr(bounds)) / model.error_bound - 1) <= 0.051);
                    std::istringstream time(line.substr(times));
                    double number = 0;
                    std::string unit;
                    time >> number >> unit;
                    const double seconds = unit == "s" ? 1 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 1e-9;
                    REQUIRE(std::abs(number * seconds / model.cost - 1) <= 0.0051);
                }
            }
}

TEST_CASE("explain: to the letter") {
    const Choice<3> choice{{Estimate{"short", {}, 1.5e-3, 2.5e-7}, Estimate{"no", Fit::no("more than two links")},
                            Estimate{"rather longer", {}, 0x1p-51, 0.25}},
                           0,
                           true};
    CHECK(explanation(choice).text() ==
          "   model          error bound  expected to take\n"
          "-> short              1.5e-03            250 ns\n"
          "   no                       -                 -  more than two links\n"
          "   rather longer      4.4e-16            250 ms\n");
    const Choice<1> none{{Estimate{"only", {}, 0.5, 1e-12}}, 0, false};
    CHECK(explanation(none).text() ==
          "no model keeps the tolerance\n"
          "   model  error bound  expected to take\n"
          "-> only       5.0e-01          0.001 ns\n");
}

TEST_CASE("explain names the method that modes takes") {
    for (const Index size : {1, 2, 5, 30, 1000, 100'000})
        for (const double rtol : {0.1, 1e-4, 1e-9, 1e-13, 0.0}) {
            const auto chain = Chain<double>::uniform_rods(size);
            const Index count = std::min<Index>(3, size);
            const Explanation found = explain(chain, {.count = count, .rtol = rtol});
            CAPTURE(size, rtol, found.text());
            REQUIRE(found.methods[found.chosen].name == modes(chain, {.count = count, .rtol = rtol}).method);
            REQUIRE(found.methods[found.chosen].fit.applies);
        }
    const auto chain = Chain<double>::uniform_rods(3);
    CHECK(explain(chain).meets_tolerance);
    CHECK_THROWS_AS(explain(chain, {.count = 4}), InvalidArgument);
    CHECK_THROWS_AS(explain(chain, {.rtol = -1.0}), InvalidArgument);
}

template <class System>
concept Explained = requires(const System& system) {
    explain(system);
};
static_assert(Explained<Chain<double>> && !Explained<Rig> && !Explained<Cord> && !Explained<Held<Chain<double>>>);
