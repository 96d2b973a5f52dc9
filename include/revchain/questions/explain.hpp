// SPDX-License-Identifier: MPL-2.0
// Defines what explain.hpp declares.
#pragma once

#include <array>
#include <ios>
#include <sstream>
#include <utility>

#include "revchain/explain.hpp"
#include "revchain/methods.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/mode_range.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns a time as text in s, ms, us or ns.
REVCHAIN_LAZY
std::string time_text(double seconds) {
    using Unit = std::pair<const char*, double>;
    constexpr std::array units{Unit("s", 1), Unit("ms", 1e-3), Unit("us", 1e-6), Unit("ns", 1e-9)};
    std::size_t i = 0;
    while (i + 1 < units.size() && !(seconds >= units[i].second)) ++i;
    std::ostringstream text;
    text.precision(3);
    text << seconds / units[i].second << ' ' << units[i].first;
    return text.str();
}

}  // namespace detail

REVCHAIN_INLINE std::string Explanation::text() const {
    using Line = std::array<std::string, 5>;
    std::vector<Line> lines{Line{"", "model", "error bound", "expected to take", ""}};
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const Estimate& model = methods[i];
        std::ostringstream bound;
        bound.precision(1);
        bound << std::scientific << model.error_bound;
        const std::string arrow = i == chosen ? "->" : "", name(model.name);
        lines.push_back(model.fit.applies
                            ? Line{arrow, name, bound.str(), detail::time_text(model.cost), ""}
                            : Line{arrow, name, "-", "-", std::string(model.fit.reason)});
    }
    std::array<std::size_t, 4> width{};
    for (const Line& line : lines)
        for (std::size_t i = 0; i < width.size(); ++i)
            width[i] = std::max(width[i], line[i].size());
    std::string result = meets_tolerance ? "" : "no model keeps the tolerance\n";
    for (const Line& line : lines) {
        const auto space = [&](std::size_t i) {
            return std::string(width[i] - line[i].size(), ' ');
        };
        std::string row = line[0] + space(0) + ' ' + line[1] + space(1) + "  " + space(2) +
                          line[2] + "  " + space(3) + line[3] + "  " + line[4];
        row.erase(row.find_last_not_of(' ') + 1);
        result += row + '\n';
    }
#if !defined(REVCHAIN_COMPILED)
    if (chosen < methods.size() && methods[chosen].name != models::Bisection::name)
        result +=
            "include <revchain/methods.hpp> and call modes(chain, options, "
            "revchain::methods::all)\n";
#endif
    return result;
}

REVCHAIN_DEFINE
Explanation explain(const Chain<double>& chain, const ExplainOptions& options) {
    detail::check(options);
    const ModeRange range = detail::numbered_range(chain.mode_count(), options);
    const auto choice = select(detail::with_bisection(methods::all), chain,
                               detail::question_of(range, options.rtol));
    return {
        {choice.estimates.begin(), choice.estimates.end()}, choice.model, choice.meets_tolerance};
}

}  // namespace revchain
