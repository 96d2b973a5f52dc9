// SPDX-License-Identifier: MPL-2.0
// Defines what cord.hpp declares of branches.
#pragma once

#include "revchain/finite/cord/branches.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

REVCHAIN_INLINE CordShape CordBranch::shape(std::size_t point) const {
    constexpr std::string_view place = "CordBranch::shape";
    if (point >= size())
        detail::throw_invalid(place, "there are so many points: " + std::to_string(size()), point);
    if (points[point].at.bend == 0)
        detail::throw_invalid(place, "this point is the straight cord", point);
    const bool at_fold = std::find(folds.begin(), folds.end(), point) != folds.end();
    auto shape = finite::shape_at(*line, points[point], at_fold);
    if (!shape)
        detail::throw_invalid(place, "the shape at this point could not be followed", point);
    return *std::move(shape);
}

REVCHAIN_INLINE std::vector<CordShape> CordBranch::shapes_at(double height) const {
    detail::require_positive("CordBranch::shapes_at", "conical height", height);
    std::vector<finite::BranchLine::Point> found;
    const double log_height = std::log(height);
    const auto value = [&](const finite::BranchLine::Point& point) {
        return point.at.log_height - log_height;
    };
    if (size() > 0 && points[0].at.bend > 0 && value(points[0]) == 0) found.push_back(points[0]);
    for (std::size_t i = 1; i < size(); ++i)
        finite::add_passing(found, *line, points[i - 1], points[i], value);
    std::vector<CordShape> shapes;
    for (finite::BranchLine::Point& point : found) {
        point.at.log_height = log_height;
        if (auto shape = finite::shape_at(*line, point)) shapes.push_back(*std::move(shape));
    }
    return shapes;
}

REVCHAIN_INLINE CordShape finite::shape_near(const Cord& cord, double height, int half_waves,
                                             double tip_offset, bool at_fold) {
    const BranchLine line(cord, half_waves);
    auto shape =
        shape_at(line, {{std::asinh(tip_offset / height), std::log(height)}, {}, 0, 0}, at_fold);
    if (!shape) detail::throw_invalid("CordShape", "the shape could not be followed", height);
    return *std::move(shape);
}

}  // namespace revchain
