// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>

#include "bindings.hpp"
#include "revchain/chain.hpp"
#include "revchain/numeric/large_memory.hpp"

namespace {

using revchain::Index;
using Chain = revchain::Chain<double>;
using Wide = revchain::Wide<double>;
using revchain::Column;
using revchain::detail::throw_invalid;

Column<double> column(const Array& array, const std::string& name) {
    if (array.ndim() == 0) return *array.data();
    if (array.ndim() > 1) throw_invalid("Chain", name + " must have at most one dimension", array.ndim());
    std::vector<double> numbers;
    const auto size = static_cast<std::size_t>(array.size());
    numbers.reserve(size);
    revchain::detail::will_be_filled(numbers.data(), size * sizeof(double));
    numbers.assign(array.data(), array.data() + size);
    return numbers;
}

/// The number of links: that of the columns that have one number per link, 1 if none has.
class Size {
   public:
    template <class V>
    void note(const Column<V>& column, const std::string& name) {
        if (column.is_scalar()) return;
        const Index stored = static_cast<Index>(column.stored());
        if (size_ && *size_ != stored)
            throw_invalid("Chain",
                          name + " must have as many numbers as " + name_ + " (" + std::to_string(*size_) +
                              ") or be a single number",
                          stored);
        if (!size_) size_ = stored, name_ = name;
    }
    Index value() const { return size_.value_or(1); }

   private:
    std::optional<Index> size_;
    std::string name_;
};

/// A column made from others, link by link; one number where all are.
template <class Make, class... V>
auto combined(Index size, Make make, const Column<V>&... columns) {
    using Made = decltype(make("", columns[0]...));
    if ((columns.is_scalar() && ...)) return Column<Made>(make("Chain", columns[0]...));
    std::vector<Made> values;
    values.reserve(static_cast<std::size_t>(size));
    revchain::detail::will_be_filled(values.data(), static_cast<std::size_t>(size) * sizeof(Made));
    try {
        while (static_cast<Index>(values.size()) < size) {
            const auto m = static_cast<Index>(values.size());
            if (m % 1024 == 0) revchain::detail::check_interrupt();
            values.push_back(make("Chain", columns[m]...));
        }
    } catch (const revchain::InvalidArgument&) {  // once more, with the place
        const auto m = static_cast<Index>(values.size());
        make("Chain: links[" + std::to_string(m) + "]", columns[m]...);
        throw;
    }
    return Column<Made>(std::move(values));
}

Chain make_chain(const Array& weight, const Array& length, const std::optional<Array>& centroid,
                 const std::optional<Array>& pendulum_length, const std::optional<Array>& radius_of_gyration) {
    namespace d = revchain::detail;
    Column<double> W = column(weight, "weight"), a = column(length, "length");
    Size size;
    size.note(W, "weight");
    size.note(a, "length");
    if (!centroid) {
        if (pendulum_length || radius_of_gyration)
            throw_invalid("Chain", "pendulum_length and radius_of_gyration need the centroid");
        Column<double> h = a;
        return Chain(size.value(), std::move(W), std::move(a), std::move(h), Wide(0));
    }
    if (pendulum_length.has_value() == radius_of_gyration.has_value())
        throw_invalid("Chain", "a centroid needs either pendulum_length or radius_of_gyration (not both)");
    Column<double> h = column(*centroid, "centroid");
    std::optional<Column<Wide>> gyration;
    size.note(h, "centroid");
    if (pendulum_length) {
        const Column<double> l = column(*pendulum_length, "pendulum_length");
        size.note(l, "pendulum_length");
        gyration = combined(size.value(), d::gyration_from_pendulum_length<double>, a, h, l);
    } else {
        const Column<double> rho = column(*radius_of_gyration, "radius_of_gyration");
        size.note(rho, "radius_of_gyration");
        gyration = combined(size.value(), d::gyration_from_radius<double>, a, rho);
    }
    return Chain(size.value(), std::move(W), std::move(a), std::move(h), *std::move(gyration));
}

py::array to_numpy(bool is_scalar, Index size, auto value) {
    py::array_t<double> array(is_scalar ? std::vector<py::ssize_t>{} : std::vector<py::ssize_t>{size});
    double* const to = array.mutable_data();
    for (Index m = 0; m < (is_scalar ? 1 : size); ++m) {
        if (m % 1024 == 0) revchain::detail::check_interrupt();
        to[m] = value(m);
    }
    return frozen(std::move(array));
}

py::array to_numpy(const Column<double>& column) {
    return to_numpy(column.is_scalar(), static_cast<Index>(column.stored()), [&](Index m) { return column[m]; });
}

/// A property of a link computed from its data, as a column.
template <double (*property)(const revchain::Link<double>&)>
py::array derived(const Chain& chain) {
    const bool is_scalar =
        chain.length().is_scalar() && chain.centroid().is_scalar() && chain.gyration_ratio().is_scalar();
    return to_numpy(is_scalar, chain.size(), [&](Index m) { return property(chain.link(m)); });
}

/// The state of a chain ends with this number, and with the exponent of a chain that `tapered` made.
constexpr int state_version = 2;

/// Exact: both words of the ratio of squares.
py::tuple get_state(const Chain& chain) {
    const Column<Wide>& g = chain.gyration_ratio();
    const Index stored = static_cast<Index>(g.stored());
    const auto state =
        py::make_tuple(chain.size(), to_numpy(chain.weight()), to_numpy(chain.length()), to_numpy(chain.centroid()),
                       to_numpy(g.is_scalar(), stored, [&](Index m) { return g[m].high; }),
                       to_numpy(g.is_scalar(), stored, [&](Index m) { return g[m].low; }), state_version);
    if (!chain.taper()) return state;
    return py::tuple(state + py::make_tuple(*chain.taper()));
}

Chain set_state(const py::tuple& state) {
    if (state.size() < 7 || state.size() > 8)
        throw_invalid("Chain", "this is not the state of a chain; its number of parts must be 7 or 8", state.size());
    if (state[6].cast<int>() != state_version)
        throw_invalid("Chain", "this is the state of a chain of another version; known is 2", state[6].cast<int>());
    const Index size = state[0].cast<Index>();
    const Column<double> high = column(state[4].cast<Array>(), "gyration_ratio");
    const Column<double> low = column(state[5].cast<Array>(), "gyration_ratio");
    const Index stored = static_cast<Index>(std::min(high.stored(), low.stored()));
    const auto words = [](std::string_view, double h, double l) { return Wide(h, l); };
    const Chain chain(size, column(state[1].cast<Array>(), "weight"), column(state[2].cast<Array>(), "length"),
                      column(state[3].cast<Array>(), "centroid"), combined(stored, words, high, low));
    return state.size() == 8 ? chain.as_tapered(state[7].cast<double>()) : chain;
}

}  // namespace

void bind_chain(py::module_& module) {
    py::class_<Chain>(module, "Chain", "A hanging chain of links, lowest first; immutable.")
        .def(py::init(&make_chain), "weight"_a, "length"_a, "centroid"_a = py::none(), "pendulum_length"_a = py::none(),
             "radius_of_gyration"_a = py::none())
        .def_static("uniform_plummets", &Chain::uniform_plummets, "count"_a, "length"_a, "weight"_a)
        .def_static("uniform_rods", &Chain::uniform_rods, "count"_a, "length"_a, "weight"_a)
        .def_static(
            "tapered",
            [](Index count, double length, double exponent, double weight) {
                const py::gil_scoped_release release;
                return Chain::tapered(count, length, exponent, weight);
            },
            "count"_a, "length"_a, "exponent"_a, "weight"_a)
        .def_property_readonly("taper", &Chain::taper)
        .def_property_readonly("size", &Chain::size)
        .def_property_readonly("mode_count", &Chain::mode_count)
        .def_property_readonly("total_weight", &Chain::total_weight)
        .def_property_readonly("total_length", &Chain::total_length)
        .def_property_readonly("weight", [](const Chain& c) { return to_numpy(c.weight()); })
        .def_property_readonly("length", [](const Chain& c) { return to_numpy(c.length()); })
        .def_property_readonly("centroid", [](const Chain& c) { return to_numpy(c.centroid()); })
        .def_property_readonly("pendulum_length", &derived<revchain::pendulum_length<double>>)
        .def_property_readonly("radius_of_gyration", &derived<revchain::radius_of_gyration<double>>)
        .def(
            "__eq__", [](const Chain& x, const Chain& y) { return x == y; }, py::is_operator())
        .def("__hash__",
             [](const Chain& c) { return py::hash(py::make_tuple(c.size(), c.weight()[0], c.length()[0])); })
        .def(py::pickle(&get_state, &set_state));
}
