// SPDX-License-Identifier: MPL-2.0
// Defines what response.hpp declares.
#pragma once

#include <algorithm>
#include <numeric>

#include "revchain/linear/driven_chain.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/response.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns heights and speeds in the units of a chain.
template <class Carried>
std::vector<Driving> drives(const Carried& carried, const ResponseOptions& options) {
    using S = Wide<double>;
    constexpr std::string_view place = "response";
    const bool speeds = !options.angular_speed.empty();
    if (speeds && !options.conical_height.empty())
        throw_invalid(place, "give conical_height or angular_speed, not both");
    const std::vector<double>& given = speeds ? options.angular_speed : options.conical_height;
    const S gravity(options.gravity);
    const std::string name = speeds ? "angular speed" : "conical height";
    const bool either_sense = speeds && tells_senses_apart(carried);
    require_positive(place, "gravity", options.gravity);
    const int down = -base_chain(carried).units().length_exponent;
    std::vector<Driving> result;
    result.reserve(given.size());
    for (const double x : given) {
        require_positive(place, name, either_sense ? std::abs(x) : x);
        const S height = ldexp(speeds ? gravity / S(x) / S(x) : S(x), down);
        const S swing = ldexp(speeds ? gravity / S(x) : sqrt(gravity * S(x)), down);
        if (!(height.high > 0x1p-250 && height.high < 0x1p250))
            throw_invalid(place, name + " must not be that far from the chain's own", x);
        result.push_back({height, swing});
    }
    return result;
}

/// The source of each requested offset.
struct PinsAsked {
    std::vector<Index> asked;
    pencil::DrivenPins wanted;
    std::vector<std::vector<Index>> columns;  ///< of each pin wanted
    std::vector<Index> carried_columns;       ///< of the moved end itself
};

/// Returns the requested pins. A pin of an idle link moves with the lowest pin of the other links.
REVCHAIN_LAZY
PinsAsked pins_asked(const ResponseOptions& options, Index links, const DrivenChain& chain) {
    const std::size_t below = chain.pencil.elements.size();
    const auto place = [&](Index pin) {
        return static_cast<std::size_t>(std::max<Index>(0, pin - chain.idle));
    };
    PinsAsked result;
    if (options.pins) {
        result.asked = *options.pins;
    } else {
        result.asked.resize(static_cast<std::size_t>(links) + 1);
        std::iota(result.asked.begin(), result.asked.end(), Index(0));
    }
    for (const Index pin : result.asked) {
        if (pin < 0 || pin > links)
            throw_invalid("response", "pins must be numbers from 0 to " + std::to_string(links),
                          pin);
        if (place(pin) < below) result.wanted.pins.push_back(place(pin));
    }
    auto& pins = result.wanted.pins;
    std::sort(pins.begin(), pins.end());
    pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
    result.columns.resize(pins.size());
    for (std::size_t column = 0; column < result.asked.size(); ++column) {
        const std::size_t pin = place(result.asked[column]);
        if (pin >= below) {
            result.carried_columns.push_back(static_cast<Index>(column));
        } else {
            const auto at = std::lower_bound(pins.begin(), pins.end(), pin) - pins.begin();
            result.columns[static_cast<std::size_t>(at)].push_back(static_cast<Index>(column));
        }
    }
    return result;
}

REVCHAIN_LAZY
void store(Response& result, Index row, const pencil::Driven& found, const Driving& at,
           const DrivenChain& chain, double radius) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const bool finite = found.decided && result.offset.row(row).allFinite();
    result.resonant[static_cast<std::size_t>(row)] = found.decided ? 0 : 1;
    result.modes_below[row] = found.negative - chain.standing;
    result.reversed[static_cast<std::size_t>(row)] = found.decided && found.reversed ? 1 : 0;
    if (!finite) {
        result.offset.row(row).setConstant(unknown);
        result.error_bound[row] = infinity;
        result.support_force[row] = unknown, result.support_force_error[row] = infinity;
        return;
    }
    const double rounding = 0x1.00001p-53 + std::numeric_limits<double>::denorm_min() / radius;
    result.error_bound[row] = found.error_bound * (1 + 0x1p-50) + rounding;
    const double over = std::ldexp(radius / at.height.high,
                                   chain.units.weight_exponent - chain.units.length_exponent);
    result.support_force[row] = -found.stiffness * over;
    result.support_force_error[row] = found.stiffness_error * over * (1 + 0x1p-40) +
                                      0x1p-50 * std::abs(result.support_force[row]) +
                                      std::numeric_limits<double>::denorm_min();
}

template <class Carried>
Response responses(const Carried& carried, const ResponseOptions& options) {
    const Threads threads("response", options.threads);
    require_positive("response", "support radius", options.support_radius);
    const double radius = options.support_radius;
    const std::vector<Driving> at = drives(carried, options);
    const DrivenChain chain = driven_chain(carried);
    const PinsAsked pins = pins_asked(options, base_chain(carried).size(), chain);

    const auto rows = static_cast<Index>(at.size()),
               columns = static_cast<Index>(pins.asked.size());
    Response result{
        pins.asked,           Table<double>(rows, columns), Vector<double>(rows),
        Vector<Index>(rows),  std::vector<char>(at.size()), std::vector<char>(at.size()),
        Vector<double>(rows), Vector<double>(rows)};
    for (const Index column : pins.carried_columns) result.offset.col(column).setConstant(radius);
    const auto put = [&](Index row, std::size_t which, const Wide<double>& y) {
        const double offset = (y * radius).high;
        for (const Index column : pins.columns[which]) result.offset(row, column) = offset;
    };
    const auto take = [&](Index row, const pencil::Driven& found) {
        store(result, row, found, at[static_cast<std::size_t>(row)], chain, radius);
    };
    const bool one_unit = chain.pencil.units.empty();
    if (one_unit)
        driven_by_lanes<std::is_same_v<Carried, Rig>>(chain, at, pins.wanted, put, take,
                                                      options.progress);
    std::vector<Index> left;
    for (Index row = 0; row < rows; ++row)
        if (!one_unit || result.resonant[static_cast<std::size_t>(row)] != 0) left.push_back(row);
    parallel_for(left.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index row = left[i];
            std::size_t which = pins.wanted.pins.size();
            const auto found = pencil::driven(
                chain.pencil, at[static_cast<std::size_t>(row)],
                [&](std::size_t pin, const Wide<double>& y) {
                    if (which == 0 || pins.wanted.pins[which - 1] != pin) return;
                    put(row, --which, y);
                },
                chain.end);
            for (const Index column : pins.carried_columns) result.offset(row, column) = radius;
            store(result, row, found, at[static_cast<std::size_t>(row)], chain, radius);
            for (const Index column : pins.carried_columns) result.offset(row, column) = radius;
            advance(options.progress, 1.0);
        }
    });
    return result;
}

}  // namespace detail

REVCHAIN_DEFINE
Response response(const Chain<double>& chain, const ResponseOptions& options) {
    return detail::responses(chain, options);
}
REVCHAIN_DEFINE
Response response(const Rig& rig, const ResponseOptions& options) {
    return detail::responses(rig, options);
}

}  // namespace revchain
