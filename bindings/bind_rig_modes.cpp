// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <complex>
#include <optional>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/damped_modes.hpp"
#include "revchain/rig_modes.hpp"

namespace {

using revchain::Index;
using revchain::Rig;
using revchain::RigModes;
using revchain::Table;
using revchain::Vector;
using revchain::WhirlModes;

/// Modes of a rig in both directions, slowest first; shapes are computed when read.
struct FoundRigModes {
    RigModes modes;
    struct Place {
        bool forward;
        Index j;
    };
    std::vector<Place> order;
    Index pins;

    FoundRigModes(RigModes found, Index pins_) : modes(std::move(found)), pins(pins_) {
        for (const bool forward : {true, false}) {
            const WhirlModes& sense = forward ? modes.forward : modes.backward;
            for (Index j = 0; j < sense.size(); ++j) order.push_back({forward, j});
        }
        // equal heights may have speeds an ulp apart
        const auto slowness = [this](const Place& x) {
            return std::pair(of(x).conical_height[x.j], -of(x).angular_speed[x.j]);
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](const Place& x, const Place& y) { return slowness(x) > slowness(y); });
    }
    const WhirlModes& of(const Place& place) const { return place.forward ? modes.forward : modes.backward; }
    template <class Value, class Number>
    py::array column(const Number& number) const {
        py::array_t<Value> array(static_cast<py::ssize_t>(order.size()));
        for (std::size_t i = 0; i < order.size(); ++i)
            array.mutable_data()[i] = number(of(order[i]), order[i].j, order[i].forward);
        return frozen(std::move(array));
    }
    /// One number of each of a list's items, as an array.
    template <class Value, class Items, class Number>
    static py::array items(const Items& list, const Number& number) {
        py::array_t<Value> array(static_cast<py::ssize_t>(list.size()));
        for (std::size_t i = 0; i < list.size(); ++i) array.mutable_data()[i] = number(list[i]);
        return frozen(std::move(array));
    }
    /// Shapes of both directions.
    void find_shapes() const {
        without_lock([&] {
            modes.forward.shapes();
            modes.backward.shapes();
            return 0;
        });
    }
};

py::array shape(const FoundRigModes& found) {
    found.find_shapes();
    Table<double> table(static_cast<Index>(found.order.size()), found.pins);
    for (std::size_t i = 0; i < found.order.size(); ++i)
        table.row(static_cast<Index>(i)) = found.of(found.order[i]).shapes().row(found.order[i].j);
    return to_numpy(table);
}

py::tuple nodes(const FoundRigModes& found) {
    py::tuple lists(found.order.size());
    for (std::size_t i = 0; i < found.order.size(); ++i)
        lists[i] = to_numpy(found.of(found.order[i]).nodes()[static_cast<std::size_t>(found.order[i].j)]);
    return lists;
}

py::object certificate(const FoundRigModes& found) {
    if (found.modes.forward.certificate.lower.size() + found.modes.backward.certificate.lower.size() == 0)
        return py::none();
    const auto heights = [&](Vector<double> revchain::Certificate<double>::*part) {
        return found.column<double>([&](const WhirlModes& m, Index j, bool) { return (m.certificate.*part)[j]; });
    };
    const auto counts = [&](Vector<Index> revchain::Certificate<double>::*part) {
        return found.column<std::int64_t>([&](const WhirlModes& m, Index j, bool) { return (m.certificate.*part)[j]; });
    };
    using C = revchain::Certificate<double>;
    return py::make_tuple(heights(&C::lower), heights(&C::upper), counts(&C::above_lower), counts(&C::above_upper),
                          py::none(), py::none());
}

}  // namespace

void bind_rig_modes(py::module_& module) {
    using Found = FoundRigModes;
    using Other = revchain::OtherMode;
    using Slack = revchain::SlackLink;
    py::class_<Found>(module, "RigModes", "Modes of a rig.")
        .def_property_readonly(
            "number",
            [](const Found& f) {
                return f.column<std::int64_t>([](const WhirlModes& m, Index j, bool) { return m.first + j; });
            })
        .def_property_readonly(
            "direction",
            [](const Found& f) {
                return f.column<std::int64_t>([](const WhirlModes&, Index, bool forward) { return forward ? 1 : -1; });
            })
        .def_property_readonly(
            "conical_height",
            [](const Found& f) {
                return f.column<double>([](const WhirlModes& m, Index j, bool) { return m.conical_height[j]; });
            })
        .def_property_readonly(
            "error_bound",
            [](const Found& f) {
                return f.column<double>([](const WhirlModes& m, Index j, bool) { return m.error_bound[j]; });
            })
        .def_property_readonly("angular_speed",
                               [](const Found& f) {
                                   return f.column<double>([](const WhirlModes& m, Index j, bool forward) {
                                       return forward ? m.angular_speed[j] : -m.angular_speed[j];
                                   });
                               })
        .def_property_readonly(
            "speed_error_bound",
            [](const Found& f) {
                return f.column<double>([](const WhirlModes& m, Index j, bool) { return m.speed_error_bound[j]; });
            })
        .def_property_readonly("shape", &shape)
        .def_property_readonly(
            "residual",
            [](const Found& f) {
                return f.column<double>([](const WhirlModes& m, Index j, bool) { return m.residual()[j]; });
            })
        .def_property_readonly("nodes", &nodes)
        .def_property_readonly("certificate", &certificate)
        .def_property_readonly(
            "available",
            [](const Found& f) { return py::make_tuple(f.modes.forward.available, f.modes.backward.available); })
        .def_property_readonly("has_momentum", [](const Found& f) { return f.modes.has_momentum; })
        .def_property_readonly("rigid", [](const Found& f) { return f.modes.rigid; })
        .def_property_readonly("other_available", [](const Found& f) { return f.modes.other_available; })
        .def_property_readonly("slack_link",
                               [](const Found& f) {
                                   return Found::items<std::int64_t>(f.modes.slack,
                                                                     [](const Slack& x) { return x.link; });
                               })
        .def_property_readonly("slack_speed",
                               [](const Found& f) {
                                   return Found::items<double>(f.modes.slack,
                                                               [](const Slack& x) { return x.angular_speed; });
                               })
        .def_property_readonly("complete", [](const Found& f) { return f.modes.complete; })
        .def_property_readonly("method", [](const Found& f) { return std::string(to_string(f.modes.method)); })
        .def_property_readonly("status", [](const Found& f) { return std::string(to_string(f.modes.status)); });
    using Window = std::optional<std::pair<double, double>>;
    module.def(
        "rig_modes",
        [](const Rig& rig, Index first, std::optional<Index> count, const Window& heights, const Window& speeds,
           std::optional<double> rtol, bool certify, double gravity, MaybeProgress progress, Index threads) {
            revchain::RigModesOptions options{.first = first,
                                              .rtol = rtol,
                                              .certify = certify,
                                              .gravity = gravity,
                                              .other = false,
                                              .threads = threads,
                                              .progress = progress.value_or(nullptr)};
            if (heights) options.conical_height = {heights->first, heights->second};
            if (speeds) options.angular_speed = {speeds->first, speeds->second};
            if (!heights && !speeds) options.count = count.value_or(revchain::all_modes);
            return without_lock([&] { return Found(revchain::modes(rig, options), rig.size() + 1); });
        },
        "rig"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a, "rtol"_a, "certify"_a, "gravity"_a,
        "progress"_a = py::none(), "threads"_a = 1);
    module.def(
        "damped_modes",
        [](const Rig& rig, Index first, std::optional<Index> count, double gravity, MaybeProgress progress) {
            const revchain::Progress* shared = progress.value_or(nullptr);
            const revchain::DampedModesOptions options{.first = first, .count = count, .gravity = gravity};
            const auto found = aside(rig.chain(), shared, [rig, options](const revchain::Chain<double>&) {
                return revchain::damped_modes(rig, options);
            });
            return py::make_tuple(complex_numbers(found.exponent, {found.size()}), to_numpy(found.error_bound),
                                  to_numpy(found.error_estimate),
                                  complex_numbers(found.shapes, {found.size(), rig.size() + 1}), found.available,
                                  found.rigid, found.complete, std::string(to_string(found.status)));
        },
        "rig"_a, "first"_a, "count"_a, "gravity"_a, "progress"_a = py::none());
    module.def(
        "other_rig_modes",
        [](const Rig& rig, double gravity, std::optional<const Found*> given) {
            const Found* found = given.value_or(nullptr);
            const bool known = found && static_cast<Index>(found->modes.other.size()) == found->modes.other_available;
            const auto other =
                known ? found->modes.other
                      : without_lock([&] { return revchain::modes(rig, {.count = 1, .gravity = gravity}).other; });
            return py::make_tuple(
                Found::items<std::complex<double>>(other, [](const Other& x) { return x.conical_height; }),
                Found::items<std::complex<double>>(other, [](const Other& x) { return x.angular_speed; }),
                Found::items<double>(other, [](const Other& x) { return x.growth_rate; }),
                Found::items<double>(other, [](const Other& x) { return x.error_bound; }));
        },
        "rig"_a, "gravity"_a, "found"_a = py::none());
    module.def(
        "count_rig_modes",
        [](const Rig& rig, const Array& values, bool by_height, double gravity) {
            py::array_t<std::int64_t> result(std::vector<py::ssize_t>(values.shape(), values.shape() + values.ndim()));
            const py::gil_scoped_release release;
            const revchain::RigModeCounter counter(rig, gravity);
            std::transform(values.data(), values.data() + values.size(), result.mutable_data(), [&](double x) {
                revchain::detail::check_interrupt();
                return by_height ? counter.above_height(x) : counter.below_speed(x);
            });
            return result;
        },
        "rig"_a, "values"_a, "by_height"_a, "gravity"_a);
}
