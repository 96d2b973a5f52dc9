// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/branches.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Shapes with a given quantity (a height, tip inclination, tip radius or top tension) on a branch
/// of a cord, in order along the branch.
struct CordShapesOnBranch {
    std::vector<CordShape> shapes;
    BranchEnd end = BranchEnd::height;  ///< why the search ended; `budget`: after 100,000 points
    double searched_to = 0;             ///< the conical height at which the search ended
};

namespace finite {

/// Returns the difference of a number at a point of a branch from the wanted number.
class WantedOnLine {
   public:
    enum class Kind { height, tip_inclination, tip_radius, top_tension };

    /// Throws InvalidArgument unless exactly one number is given, within its range.
    WantedOnLine(const BranchLine& line, double critical, const OnBranchOptions& given)
        : line_(line) {
        using detail::require_positive, detail::throw_invalid;
        constexpr std::string_view place = "steady_shape";
        const int count = given.conical_height.has_value() + given.angular_speed.has_value() +
                          given.tip_inclination.has_value() + given.tip_radius.has_value() +
                          given.top_tension.has_value();
        if (count != 1)
            throw_invalid(place,
                          "give exactly one of conical height, angular speed, tip inclination, tip "
                          "radius and top tension; given were",
                          count);
        const ContinuousChain& chain = line.chain();
        if (given.conical_height || given.angular_speed) {
            height_ = given.conical_height
                          ? *given.conical_height
                          : conical_pendulum::height(*given.angular_speed, given.gravity);
            require_positive(place,
                             given.conical_height ? "conical height" : "gravity / angular speed^2",
                             height_);
            if (!(height_ < critical))
                detail::throw_too_slow(place, line.crossing(), critical, height_, given);
            kind_ = Kind::height, wanted_ = std::log(height_);
        } else if (given.tip_inclination) {
            if (!(*given.tip_inclination > 0 && *given.tip_inclination < std::numbers::pi / 2))
                throw_invalid(place, "tip inclination must lie between 0 and pi/2",
                              *given.tip_inclination);
            kind_ = Kind::tip_inclination, wanted_ = std::asinh(std::tan(*given.tip_inclination));
        } else if (given.tip_radius) {
            require_positive(place, "tip radius", *given.tip_radius);
            if (!(*given.tip_radius < chain.length))
                throw_invalid(place, "tip radius must be less than the length of the cord",
                              *given.tip_radius);
            kind_ = Kind::tip_radius, wanted_ = *given.tip_radius;
        } else {
            const double tension = *given.top_tension,
                         weight = chain.line_weight * (chain.length + chain.tip);
            if (!(tension > weight) || !std::isfinite(tension))
                throw_invalid(place,
                              "top tension must be finite and more than the weight of cord and tip",
                              tension);
            kind_ = Kind::top_tension, wanted_ = std::sqrt((tension - weight) * (tension + weight));
        }
    }

    Kind kind() const { return kind_; }
    double height() const { return height_; }
    double operator()(const BranchLine::Point& point) const {
        const double height = std::exp(point.at.log_height), tip = std::sinh(point.at.bend);
        if (kind_ == Kind::height) return wanted_ - point.at.log_height;
        if (kind_ == Kind::tip_inclination) return point.at.bend - wanted_;
        if (kind_ == Kind::tip_radius) return tip * height / wanted_ - 1;
        if (tip == 0) return -1;
        double pull = 0;
        const auto visit = [&](const auto& series, double duration) {
            pull = series.state(duration).pull;
        };
        const Path path(line_.kind(point.at.log_height), tip,
                        {.crossings = line_.crossing(), .with_change = false}, visit);
        return std::abs(pull) * line_.chain().line_weight * height / wanted_ - 1;
    }

   private:
    const BranchLine& line_;
    Kind kind_ = Kind::height;
    double wanted_ = 0, height_ = 0;
};

/// Returns all shapes with a given number on the branch of a mode of height `critical`.
REVCHAIN_LAZY
CordShapesOnBranch search_branch(const Cord& cord, double critical, const OnBranchOptions& given,
                                 std::size_t max_shapes) {
    constexpr std::string_view place = "steady_shape";
    auto line = std::make_shared<const BranchLine>(cord, static_cast<int>(given.mode));
    const WantedOnLine wanted(*line, critical, given);
    double lowest =
        wanted.kind() == WantedOnLine::Kind::height ? wanted.height() / 2 : 1e-6 * critical;
    if (given.min_conical_height) {
        lowest = *given.min_conical_height;
        detail::require_positive(place, "min_conical_height", lowest);
        if (!(lowest < critical))
            detail::throw_invalid(
                place,
                "min_conical_height must be less than the conical height of the mode, " +
                    detail::in_digits(critical),
                lowest);
    }
    const double log_end = std::log(std::max(lowest, 1.0001e-6 * cord.length()));
    CordShapesOnBranch result;
    CordBranch branch;
    branch.line = line;
    append_vertical(branch, critical);
    const auto to_end = down_to(*line, log_end);
    result.end = follow(
        branch, branch.points.front(), 0.1, 100'000,
        [&](const BranchLine::Point& last, BranchLine::Point& now) -> std::optional<BranchEnd> {
            const auto end = to_end(last, now);
            std::vector<BranchLine::Point> met;
            add_passing(met, *line, last, now, wanted);
            for (BranchLine::Point& point : met) {
                if (wanted.kind() == WantedOnLine::Kind::height)
                    point.at.log_height = std::log(wanted.height());
                auto shape = shape_at(*line, point);
                if (!shape) continue;
                if (wanted.kind() == WantedOnLine::Kind::height)
                    shape->conical_height = wanted.height();
                result.shapes.push_back(std::move(*shape));
            }
            return result.shapes.size() >= max_shapes ? BranchEnd::height : end;
        });
    result.searched_to = branch.conical_height.back();
    return result;
}

}  // namespace finite
}  // namespace revchain
