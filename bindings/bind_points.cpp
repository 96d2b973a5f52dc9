// SPDX-License-Identifier: GPL-3.0-or-later
// Many systems that differ in numbers alone: made and solved one by one without Python.
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "bindings.hpp"
#include "forces.hpp"
#include "interrupt.hpp"
#include "revchain/modes.hpp"
#include "revchain/response.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/system/edit.hpp"

namespace {

using revchain::Index;
using revchain::Progress;
using revchain::Rig;
using Chain = revchain::Chain<double>;
using Wide = revchain::Wide<double>;
using Marks = std::vector<bool>;
using Whole = py::array_t<std::int64_t>;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
enum Outcome : std::uint8_t { success, not_met, refused };

/// A table of 1 row for all points or one for each, and in a row 1 number for all links or one for each.
class Numbers {
   public:
    Numbers() = default;
    Numbers(const std::string& name, const Array& table, Index points) : data_(table.data()), given_(true) {
        if (table.ndim() != 2 || table.size() == 0 || (table.shape(0) != 1 && table.shape(0) != points))
            revchain::detail::throw_invalid("Points", name + " must have one row, or one for each point");
        links_ = table.shape(1);
        row_ = table.shape(0) == 1 ? 0 : links_;
    }
    bool given() const { return given_; }
    Index links() const { return links_; }
    double operator()(Index point, Index link = 0) const { return data_[point * row_ + (links_ == 1 ? 0 : link)]; }

   private:
    const double* data_ = nullptr;
    Index row_ = 0, links_ = 0;
    bool given_ = false;
};

/// The systems of many points. `kind` says of what the chains are made: "links", with a table for each number of the
/// links; or "plummets", "rods", "tapered", of `links` equal or tapered links, with tables for the whole chain.
class Points {
   public:
    Points(Index points, Index links, std::string kind, const std::map<std::string, Array>& tables, Marks clamped,
           std::vector<Index> first, bool rigged, Marks standing, bool turning, bool by_mass)
        : points_(points),
          links_(links),
          kind_(std::move(kind)),
          tables_(tables),
          clamped_(std::move(clamped)),
          first_(std::move(first)),
          standing_(std::move(standing)),
          rigged_(rigged),
          turning_(turning),
          by_mass_(by_mass) {
        const auto read = [&](const char* name, bool needed = false) {
            const auto found = tables_.find(name);
            if (found != tables_.end()) return Numbers(name, found->second, points_);
            if (needed) revchain::detail::throw_invalid("Points", std::string(name) + " is missing");
            return Numbers();
        };
        weight_ = read("weight", true), length_ = read("length", true);
        centroid_ = read("centroid"), radius_ = read("radius_of_gyration", centroid_.given());
        tip_ = read("tip"), exponent_ = read("exponent", kind_ == "tapered");
        stiffness_ = read("stiffness"), carriage_ = read("carriage_weight"), arm_ = read("support_radius");
        wheel_ = read("wheel_weight"), turned_ = read("wheel_radius_of_gyration", wheel_.given());
        spin_ = read("spin", wheel_.given()), driven_ = read("driven", wheel_.given());
        displaced_ = read("displaced_weight"), added_ = read("added_weight");
        buoyancy_ = read("displaced_centroid"), spread_ = read("displaced_radius_of_gyration");
        if (first_.size() != clamped_.size() || (tip_.given() && tip_.links() > Index(first_.size())))
            revchain::detail::throw_invalid("Points", "tip and clamped must have one entry for each table of links");
    }

    Index size() const { return points_; }
    bool rigged() const { return rigged_; }

    Chain chain(Index i) const {
        Chain result = kind_ == "links"      ? of_links(i)
                       : kind_ == "plummets" ? Chain::uniform_plummets(links_, length_(i), weight_(i))
                       : kind_ == "rods"     ? Chain::uniform_rods(links_, length_(i), weight_(i))
                                             : Chain::tapered(links_, length_(i), exponent_(i), weight_(i));
        for (auto k = static_cast<Index>(first_.size()); k-- > 0;) {  // from the top: links below keep their numbers
            const Index pin = first_[static_cast<std::size_t>(k)];
            if (tip_.given() && tip_(i, k) != 0) result = revchain::with_weight(result, tip_(i, k), pin, 0.0);
            if (clamped_[static_cast<std::size_t>(k)]) result = revchain::clamped(result, pin);
        }
        return result;
    }

    Rig rig(Index i, double gravity) const {
        const Chain chain = this->chain(i);
        revchain::Rigging with{};
        if (stiffness_.given()) with.support.stiffness = quotient(stiffness_(i), by_mass_ ? gravity : 1.0);
        if (carriage_.given()) with.support.carriage_weight = carriage_(i);
        if (arm_.given()) with.support.radius = arm_(i);
        with.fluid = turning_ ? revchain::Fluid::turning : revchain::Fluid::still;
        for (Index m = 0; m < chain.size(); ++m) {
            const revchain::Link<double> link = chain.link(m);
            if (!standing_.empty())
                with.posture.push_back(standing_[static_cast<std::size_t>(m)] ? revchain::Posture::stands
                                                                              : revchain::Posture::hangs);
            if (wheel_.given())
                with.flywheels.push_back(
                    wheel(wheel_(i, m), turned_(i, m), spin_(i, m), driven_(i, m) != 0, gravity));
            if (!displaced_.given()) continue;
            if (turning_ && added_(i, m) > 0)
                revchain::detail::throw_invalid("Rig", "fluid that turns with the chain has no added_weight",
                                                added_(i, m));
            revchain::Displaced fluid = displaced_by(link, displaced_(i, m), added_(i, m));
            if (!std::isnan(buoyancy_(i, m))) fluid.centroid = buoyancy_(i, m);
            if (spread_.given())
                fluid.gyration_ratio = revchain::detail::gyration_from_radius<double>(
                    "Rig", link.length,
                    std::isnan(spread_(i, m)) ? revchain::radius_of_gyration(link) : spread_(i, m));
            with.displaced.push_back(fluid);
        }
        without_idle(with.flywheels);
        return Rig(chain, std::move(with));
    }

    /// solve(i) for every point, other threads of Python running; 0 proved, 1 not proved, 2 refused.
    template <class Solve>
    py::array_t<std::uint8_t> each(Progress* progress, const Solve& solve) const {
        py::array_t<std::uint8_t> status(points_);
        std::uint8_t* const to = status.mutable_data();
        const py::gil_scoped_release release;
        for (Index i = 0; i < points_; ++i) {
            revchain::detail::advance(progress, static_cast<double>(i) / static_cast<double>(points_));
            try {
                to[i] = solve(i) ? success : not_met;
            } catch (const revchain::InvalidArgument&) {
                to[i] = refused;
            }
        }
        return status;
    }

   private:
    Chain of_links(Index i) const {
        const auto column = [&](const Numbers& table) {
            std::vector<double> numbers(static_cast<std::size_t>(links_));
            for (Index m = 0; m < links_; ++m) numbers[static_cast<std::size_t>(m)] = table(i, m);
            return numbers;
        };
        std::vector<double> a = column(length_);
        if (!centroid_.given()) return Chain(links_, column(weight_), a, a, Wide(0));
        std::vector<Wide> gyration;
        gyration.reserve(a.size());
        for (Index m = 0; m < links_; ++m)
            gyration.push_back(revchain::detail::gyration_from_radius<double>("Chain", length_(i, m), radius_(i, m)));
        return Chain(links_, column(weight_), std::move(a), column(centroid_), std::move(gyration));
    }

    Index points_, links_;
    std::string kind_;
    std::map<std::string, Array> tables_;  // which the members below read
    Marks clamped_;
    std::vector<Index> first_;
    Marks standing_;
    bool rigged_, turning_, by_mass_;
    Numbers weight_, length_, centroid_, radius_, tip_, exponent_, stiffness_, carriage_, arm_, wheel_, turned_;
    Numbers spin_, driven_, displaced_, added_, buoyancy_, spread_;
};

/// An array of one row for each point, all NaN, 0 or false.
template <class Value>
class Filled {
   public:
    Filled(Index points, Index each, Value value) : array({points, each}), each_(each), to_(array.mutable_data()) {
        std::fill_n(to_, points * each, value);
    }
    Value& operator()(Index point, Index k) { return to_[point * each_ + k]; }
    template <class Numbers>
    void row(Index point, const Numbers& numbers) {
        for (Index k = 0; k < std::min<Index>(each_, numbers.size()); ++k) (*this)(point, k) = numbers[k];
    }
    py::array_t<Value> array;

   private:
    Index each_;
    Value* to_;
};

revchain::ModesMethod method_of(const std::string& name) {
    using revchain::ModesMethod;
    const std::map<std::string, ModesMethod> known{{"auto", ModesMethod::automatic},
                                                   {"bisection", ModesMethod::bisection},
                                                   {"condensed", ModesMethod::condensed},
                                                   {"aberth", ModesMethod::aberth},
                                                   {"interpolated", ModesMethod::interpolated}};
    return known.at(name);
}

/// Status, heights and bounds of chains; `columns` numbers for each point. No `count`: 10, or all if fewer.
py::tuple modes(const Points& points, Index columns, Index first, std::optional<Index> count,
                std::optional<double> rtol, bool certify, const std::string& method, Progress* progress) {
    Filled<double> height(points.size(), columns, missing), bound(points.size(), columns, missing);
    const revchain::ModesMethod way = method_of(method);
    auto status = points.each(progress, [&](Index i) {
        const Chain chain = points.chain(i);
        revchain::ModesOptions<double> options{.first = first, .rtol = rtol, .certify = certify, .method = way};
        options.count = count.value_or(std::max<Index>(1, std::min<Index>(10, chain.mode_count() - first + 1)));
        options.progress = progress;
        const auto found = revchain::modes(chain, options);
        height.row(i, found.conical_height), bound.row(i, found.error_bound);
        return found.status == revchain::Status::success;
    });
    return py::make_tuple(status, height.array, bound.array);
}

/// Status; speed, height and their bounds forwards, then backwards; how many other modes, and whether all are known.
py::tuple rig_modes(const Points& points, Index columns, Index first, Index count, const Array& gravity,
                    Progress* progress) {
    std::vector<Filled<double>> found(8, Filled<double>(0, 0, 0));
    for (auto& table : found) table = Filled<double>(points.size(), columns, missing);
    Filled<std::int64_t> other(points.size(), 1, 0);
    Filled<bool> complete(points.size(), 1, false);
    const Numbers g("gravity", gravity, points.size());
    auto status = points.each(progress, [&](Index i) {
        const auto modes = revchain::modes(
            points.rig(i, g(i)), {.first = first, .count = count, .gravity = g(i), .other = false, .progress = progress});
        const Index available = std::max(modes.forward.available, modes.backward.available);
        if (first > std::max<Index>(1, available))
            revchain::detail::throw_invalid("modes", "there are fewer modes in a direction", available);
        std::size_t k = 0;
        for (const auto* sense : {&modes.forward, &modes.backward}) {
            found[k++].row(i, sense->angular_speed), found[k++].row(i, sense->conical_height);
            found[k++].row(i, sense->error_bound), found[k++].row(i, sense->speed_error_bound);
        }
        other(i, 0) = static_cast<std::int64_t>(modes.other_available), complete(i, 0) = modes.complete;
        return modes.status == revchain::Status::success;
    });
    py::list tables;
    for (auto& table : found) tables.append(table.array);
    return py::make_tuple(status, tables, other.array, complete.array);
}

/// Status; how many shapes, and whether all are known; half waves, and a table for each of five numbers of the first
/// `most` shapes. `given` are speeds or heights, one for each point or for all.
py::tuple steady_shapes(const Points& points, Index most, const Array& given, bool speeds, int direction,
                        bool hanging_only, const Array& gravity, Progress* progress) {
    Filled<std::int64_t> count(points.size(), 1, 0), half_waves(points.size(), most, 0);
    Filled<bool> complete(points.size(), 1, false);
    std::vector<Filled<double>> found(5, Filled<double>(0, 0, 0));
    for (auto& table : found) table = Filled<double>(points.size(), most, missing);
    const Numbers at("speed", given, points.size()), g("gravity", gravity, points.size());
    auto status = points.each(progress, [&](Index i) {
        if (!(at(i) > 0)) revchain::detail::throw_invalid("steady_shapes", "the speed must be positive", at(i));
        const auto asked = [&](auto options, int sign) {
            options.hanging_only = hanging_only, options.gravity = g(i);
            (speeds ? options.angular_speed : options.conical_height) = speeds ? sign * at(i) : at(i);
            return options;
        };
        const revchain::RigShapesOptions turning{.direction = rotation(direction)};
        const auto shapes = points.rigged()
                                ? revchain::steady_shapes(points.rig(i, g(i)), asked(turning, direction))
                                : revchain::steady_shapes(points.chain(i), asked(revchain::SteadyShapesOptions{}, 1));
        count(i, 0) = static_cast<std::int64_t>(shapes.shapes.size()), complete(i, 0) = shapes.complete;
        for (Index k = 0; k < std::min<Index>(most, static_cast<Index>(shapes.shapes.size())); ++k) {
            const auto& shape = shapes.shapes[static_cast<std::size_t>(k)];
            const Index top = shape.inclination.size() - 1;
            half_waves(i, k) = shape.half_waves;
            const std::array<double, 5> numbers{shape.inclination[0], shape.inclination[top], shape.offset[0],
                                                shape.tension[top], shape.error_bound};
            for (std::size_t q = 0; q < 5; ++q) found[q](i, k) = numbers[q];
        }
        return shapes.complete;
    });
    py::list tables;
    for (auto& table : found) tables.append(table.array);
    return py::make_tuple(status, count.array, complete.array, half_waves.array, tables);
}

/// Status, and of every speed: itself, offset of the free end, largest offset of a pin, pull on the support, bound.
py::tuple response(const Points& points, const Array& given, bool speeds, const Array& gravity, Progress* progress) {
    const Numbers at("speed", given, points.size()), g("gravity", gravity, points.size());
    std::vector<Filled<double>> found(5, Filled<double>(0, 0, 0));
    for (auto& table : found) table = Filled<double>(points.size(), at.links(), missing);
    auto status = points.each(progress, [&](Index i) {
        revchain::ResponseOptions options{.gravity = g(i)};
        auto& asked = speeds ? options.angular_speed : options.conical_height;
        for (Index k = 0; k < at.links(); ++k) asked.push_back(at(i, k));
        revchain::Response moved;
        if (points.rigged()) {
            const Rig rig = points.rig(i, g(i));
            if (rig.support().radius != 0) options.support_radius = rig.support().radius;
            moved = revchain::response(rig, options);
        } else {
            moved = revchain::response(points.chain(i), options);
        }
        bool proved = true;
        for (Index k = 0; k < at.links(); ++k) {
            double largest = 0;
            for (Index pin = 0; pin < moved.offset.cols(); ++pin) {
                const double size = std::abs(moved.offset(k, pin));
                largest = size > largest || std::isnan(size) ? size : largest;
                if (std::isnan(size)) break;
            }
            const double speed =
                speeds ? at(i, k) : revchain::conical_pendulum::angular_speed<double>(at(i, k), g(i));
            const std::array<double, 5> numbers{speed, moved.offset(k, 0), largest, moved.support_force[k],
                                                moved.error_bound[k]};
            for (std::size_t q = 0; q < 5; ++q) found[q](i, k) = numbers[q];
            proved = proved && std::isfinite(moved.error_bound[k]);
        }
        return proved;
    });
    py::list tables;
    for (auto& table : found) tables.append(table.array);
    return py::make_tuple(status, tables);
}

}  // namespace

void bind_points(py::module_& module) {
    py::class_<Points>(module, "Points", "Systems that differ only in numbers, solved one by one.")
        .def(py::init<Index, Index, std::string, const std::map<std::string, Array>&, Marks, std::vector<Index>, bool,
                      Marks, bool, bool>(),
             "points"_a, "links"_a, "kind"_a, "tables"_a, "clamped"_a, "first"_a, "rigged"_a, "standing"_a, "turning"_a,
             "by_mass"_a)
        .def("modes", &modes, "columns"_a, "first"_a, "count"_a, "rtol"_a, "certify"_a, "method"_a, "progress"_a)
        .def("rig_modes", &rig_modes, "columns"_a, "first"_a, "count"_a, "gravity"_a, "progress"_a)
        .def("steady_shapes", &steady_shapes, "most"_a, "given"_a, "speeds"_a, "direction"_a, "hanging_only"_a,
             "gravity"_a, "progress"_a)
        .def("response", &response, "given"_a, "speeds"_a, "gravity"_a, "progress"_a);
}
