// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of chains and of chains held at both ends.
#include <array>
#include <functional>
#include <optional>
#include <tuple>
#include <variant>

#include "bindings.hpp"
#include "forces.hpp"
#include "interrupt.hpp"
#include "revchain/count.hpp"
#include "revchain/held.hpp"
#include "revchain/modes.hpp"
#include "revchain/questions/dense_reference.hpp"
#include "scalars.hpp"

namespace {

using revchain::Index;
using Chain = revchain::Chain<double>;
using Pair = std::pair<double, double>;
using Triple = std::tuple<double, double, double>;

constexpr std::array<std::string_view, 7> methods{"auto",         "bisection", "condensed", "aberth",
                                                  "interpolated", "dense",     "recurrence"};
constexpr std::array<std::string_view, 3> precisions{"double", "extended", "double-double"};

template <std::size_t N>
void check_word(std::string_view what, const std::string& word, const std::array<std::string_view, N>& words) {
    std::string known;
    for (const auto& each : words) {
        if (each == word) return;
        known += (known.empty() ? "" : ", ") + std::string(each);
    }
    revchain::detail::throw_invalid("modes", std::string(what) + " must be one of " + known, word);
}

/// What Python asks, before it is known in which scalar.
struct Asked {
    Index first;
    std::optional<Index> count;
    std::optional<Pair> conical_height;
    std::optional<Triple> angular_speed;
    std::optional<double> rtol;
    bool certify;
    revchain::ModesMethod method;
    Index threads = 1;

    template <class T>
    revchain::ModesOptions<T> options(revchain::Progress* progress) const {
        revchain::ModesOptions<T> result{.first = first};
        if (count || !(conical_height || angular_speed)) result.count = count.value_or(revchain::all_modes);
        const auto number = [](double x) { return static_cast<T>(x); };
        if (conical_height) result.conical_height = {number(conical_height->first), number(conical_height->second)};
        if (angular_speed)
            result.angular_speed = {number(std::get<0>(*angular_speed)), number(std::get<1>(*angular_speed))},
            result.gravity = number(std::get<2>(*angular_speed));
        if (rtol) result.rtol = number(*rtol);
        result.certify = certify;
        result.threads = threads;
        result.progress = progress;
        result.method = method;
        return result;
    }
};

template <class T>
using Solver = revchain::Modes<T> (*)(const revchain::Chain<T>&, const revchain::ModesOptions<T>&);

template <class T>
Solver<T> solver(const std::string& method) {
    if constexpr (std::is_same_v<T, double>) {
        if (method == "dense") return &revchain::modes_dense<double>;
        if (method == "recurrence") return &revchain::modes_recurrence<double>;
    } else if (method == "dense" || method == "recurrence") {
        revchain::detail::throw_invalid("modes", "this method knows precision double only", method);
    }
    return &revchain::modes<T>;
}

/// Modes of a chain in one of the three scalars. Python reads its numbers one by one; shapes are computed when read.
struct FoundModes {
    std::variant<revchain::Modes<double>, revchain::Modes<long double>, revchain::Modes<revchain::DoubleDouble>> modes;
    bool certified;

    template <class Read>
    auto read(const Read& function) const {
        return std::visit(function, modes);
    }
};

py::object certificate(const FoundModes& found) {
    if (!found.certified) return py::none();
    return found.read([](const auto& m) -> py::object {
        const auto& c = m.certificate;
        return py::make_tuple(leading(c.lower), leading(c.upper), leading(c.above_lower), leading(c.above_upper),
                              rest(c.lower), rest(c.upper));
    });
}

py::array numbers(const FoundModes& found) {
    return found.read([](const auto& m) {
        py::array_t<std::int64_t> number(m.size());
        for (Index j = 0; j < m.size(); ++j) number.mutable_data()[j] = m.first + j;
        return frozen(std::move(number));
    });
}

py::array shape(const FoundModes& found) {
    return found.read([](const auto& m) -> py::array {
        const auto* table = without_lock([&] { return &m.shapes(); });
        if constexpr (std::is_same_v<decltype(table), const revchain::Table<double>*>)
            return in_place(*table, revchain::detail::ShapesBehind::of(m).owner());
        else
            return leading(*table);
    });
}

py::tuple nodes(const FoundModes& found) {
    return found.read([](const auto& m) {
        const auto* nodes = without_lock([&] { return &m.nodes(); });
        py::tuple lists(nodes->size());
        for (std::size_t j = 0; j < nodes->size(); ++j) lists[j] = leading((*nodes)[j]);
        return lists;
    });
}

template <class T>
FoundModes solved(const Chain& chain, const Asked& asked, const std::string& method, revchain::Progress* progress) {
    const Solver<T> solve = solver<T>(method);
    const bool certified = asked.certify;
    if constexpr (std::is_same_v<T, double>) {
        if (method == "dense")
            return {
                aside(chain, progress, [=](const Chain& own) { return solve(own, asked.options<double>(nullptr)); }),
                certified};
        return {without_lock([&] { return solve(chain, asked.options<double>(progress)); }), certified};
    } else {
        return {without_lock([&] { return solve(revchain::detail::converted<T>(chain), asked.options<T>(progress)); }),
                certified};
    }
}

FoundModes modes(const Chain& chain, Index first, std::optional<Index> count, std::optional<Pair> conical_height,
                 std::optional<Triple> angular_speed, std::optional<double> rtol, bool certify,
                 const std::string& precision, const std::string& method, MaybeProgress progress, Index threads) {
    check_word("method", method, methods);
    check_word("precision", precision, precisions);
    const auto way = method == "bisection"      ? revchain::ModesMethod::bisection
                     : method == "condensed"    ? revchain::ModesMethod::condensed
                     : method == "aberth"       ? revchain::ModesMethod::aberth
                     : method == "interpolated" ? revchain::ModesMethod::interpolated
                                                : revchain::ModesMethod::automatic;
    const Asked asked{first, count, conical_height, angular_speed, rtol, certify, way, threads};
    revchain::Progress* reported = progress.value_or(nullptr);
    if (precision == "extended") return solved<long double>(chain, asked, method, reported);
    if (precision == "double-double") return solved<revchain::DoubleDouble>(chain, asked, method, reported);
    return solved<double>(chain, asked, method, reported);
}

using HeldChain = revchain::Held<Chain>;

/// Modes of a chain held straight under a tension at its upper end.
FoundModes held_modes(const HeldChain& held, Index first, std::optional<Index> count,
                      std::optional<Pair> conical_height, std::optional<Triple> angular_speed,
                      std::optional<double> rtol, bool certify, MaybeProgress progress, double gravity) {
    const Asked asked{first, count, conical_height, angular_speed, rtol, certify, revchain::ModesMethod::automatic};
    const auto as_hung = asked.options<double>(progress.value_or(nullptr));
    const revchain::HeldModesOptions options{.first = first,
                                             .count = as_hung.count,
                                             .conical_height = as_hung.conical_height,
                                             .angular_speed = as_hung.angular_speed,
                                             .rtol = rtol,
                                             .gravity = gravity,
                                             .certify = certify,
                                             .progress = as_hung.progress};
    return {without_lock([&] { return revchain::modes(held, options); }), certify};
}

template <std::size_t N>
py::tuple words(const std::array<std::string_view, N>& names) {
    py::tuple result(N);
    for (std::size_t i = 0; i < N; ++i) result[i] = py::str(std::string(names[i]));
    return result;
}

/// One count for each place of an array shaped like `like`, the GIL released.
py::array_t<std::int64_t> counts(const Chain& chain, const Array& like,
                                 const std::function<Index(const revchain::ModeCounter<double>&, py::ssize_t)>& count) {
    py::array_t<std::int64_t> result(std::vector<py::ssize_t>(like.shape(), like.shape() + like.ndim()));
    std::int64_t* out = result.mutable_data();
    const py::ssize_t size = like.size();
    const py::gil_scoped_release release;
    const revchain::ModeCounter<double> counter(chain);
    for (py::ssize_t i = 0; i < size; ++i) {
        revchain::detail::check_interrupt();
        out[i] = count(counter, i);
    }
    return result;
}

}  // namespace

void bind_linear(py::module_& module) {
    module.attr("METHODS") = words(methods);
    module.attr("PRECISIONS") = words(precisions);

    py::class_<FoundModes>(module, "Modes", "Modes of a chain.")
        .def_property_readonly("number", &numbers)
        .def_property_readonly(
            "conical_height",
            [](const FoundModes& f) { return f.read([](const auto& m) { return leading(m.conical_height); }); })
        .def_property_readonly(
            "conical_height_low",
            [](const FoundModes& f) { return f.read([](const auto& m) { return rest(m.conical_height); }); })
        .def_property_readonly(
            "error_bound",
            [](const FoundModes& f) { return f.read([](const auto& m) { return bounds(m.error_bound); }); })
        .def_property_readonly("shape", &shape)
        .def_property_readonly(
            "residual",
            [](const FoundModes& f) {
                return f.read([](const auto& m) { return leading(*without_lock([&] { return &m.residual(); })); });
            })
        .def_property_readonly("nodes", &nodes)
        .def_property_readonly("certificate", &certificate)
        .def_property_readonly("method",
                               [](const FoundModes& f) { return f.read([](const auto& m) { return m.method; }); })
        .def_property_readonly("status", [](const FoundModes& f) {
            return f.read([](const auto& m) { return std::string(to_string(m.status)); });
        });
    module.def("modes", &modes, "chain"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a, "rtol"_a,
               "certify"_a, "precision"_a, "method"_a, "progress"_a = py::none(), "threads"_a = 1);

    module.def(
        "count_modes",
        [](const Chain& chain, const Array& height) {
            const double* h = height.data();
            return counts(chain, height,
                          [h](const auto& counter, py::ssize_t i) { return counter.above_height(h[i]); });
        },
        "chain"_a, "conical_height"_a);
    module.def(
        "count_modes_at_speed",
        [](const Chain& chain, const Array& speed, const Array& gravity) {
            const double *n = speed.data(), *g = gravity.data();
            if (speed.size() != gravity.size())
                revchain::detail::throw_invalid("count_modes", "angular_speed and gravity must have one shape");
            return counts(chain, speed,
                          [n, g](const auto& counter, py::ssize_t i) { return counter.below_speed(n[i], g[i]); });
        },
        "chain"_a, "angular_speed"_a, "gravity"_a);
    py::class_<HeldChain>(module, "Held", "A chain held at both ends; immutable.")
        .def(py::init([](const Chain& chain, std::optional<double> span, const Tension& pull, bool weightless,
                         const End& lower, const End& upper) {
                 return HeldChain(chain, {.span = span,
                                          .tension = tension(pull),
                                          .weightless = weightless,
                                          .lower = support(lower),
                                          .upper = support(upper)});
             }),
             "chain"_a, "span"_a, "tension"_a, "weightless"_a, "lower"_a, "upper"_a);
    module.def("held_modes", &held_modes, "held"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a,
               "rtol"_a, "certify"_a, "progress"_a, "gravity"_a);
    module.def("count_held_modes", &counts_above<HeldChain>, "held"_a, "conical_height"_a, "gravity"_a);
    module.def(
        "recurrence_matrices",
        [](const Chain& chain) {
            const auto pencil = revchain::recurrence_matrices(chain);
            return py::make_tuple(to_numpy(pencil.A), to_numpy(pencil.B));
        },
        "chain"_a);
}
