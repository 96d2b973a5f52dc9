// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <ios>
#include <sstream>
#include <string>

#include "revchain/models/select.hpp"

namespace revchain {

namespace detail {

inline std::string bound_text(double bound) {
    std::ostringstream text;
    text.precision(1);
    text << std::scientific << bound;
    return text.str();
}

/// Seconds with the unit that suits them.
inline std::string time_text(double seconds) {
    constexpr std::array<std::pair<const char*, double>, 4> units{{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
    std::size_t i = 0;
    while (i + 1 < units.size() && !(seconds >= units[i].second)) ++i;
    std::ostringstream text;
    text.precision(3);
    text << seconds / units[i].second << ' ' << units[i].first;
    return text.str();
}

}  // namespace detail

/// What `select` chose and why, as a table for people: a line for each model, with a mark at the one chosen, the bound
/// of its relative error and the time it is expected to take, or the reason why it does not apply. Nothing is solved
/// for it. The first line says where none keeps the tolerance. Each line ends with a newline. Cost: some microseconds.
template <std::size_t N>
std::string explain(const Choice<N>& choice) {
    using Line = std::array<std::string, 5>;
    std::array<Line, N + 1> lines{Line{"", "model", "error bound", "expected to take", ""}};
    for (std::size_t i = 0; i < N; ++i) {
        const Estimate& model = choice.estimates[i];
        Line& line = lines[i + 1] = {i == choice.model ? "->" : "", std::string(model.name), "-", "-", ""};
        if (model.fit.applies)
            line[2] = detail::bound_text(model.error_bound), line[3] = detail::time_text(model.cost);
        else
            line[4] = model.fit.reason;
    }
    std::array<std::size_t, 4> width{};
    for (const Line& line : lines)
        for (std::size_t i = 0; i < width.size(); ++i) width[i] = std::max(width[i], line[i].size());
    std::string text = choice.meets_tolerance ? "" : "no model keeps the tolerance\n";
    for (const Line& line : lines) {
        const auto space = [&](std::size_t i) { return std::string(width[i] - line[i].size(), ' '); };
        std::string row = line[0] + space(0) + ' ' + line[1] + space(1) + "  " + space(2) + line[2] + "  " + space(3) +
                          line[3] + "  " + line[4];
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + '\n';
    }
    return text;
}

}  // namespace revchain
