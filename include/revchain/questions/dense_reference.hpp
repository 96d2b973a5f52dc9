// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/modes.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/dense.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/recurrence.hpp"

/// Modes by two formulations that share no step with `modes`. They are slow, less accurate
/// references. Their error bounds are proved by the same counts and show how many digits a dense
/// solver loses.
namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns the proved relative error of `height` as eigenvalue number j. It is the least power of
/// two times an ulp that two counts confirm, or infinity if they confirm none up to 1/2.
template <Real T>
T proved_error(const pencil::ElementPencil<Wide<T>>& pencil, Index j, const T& height) {
    for (T margin = T(2) * epsilon<T>(); height > T(0) && margin <= T(0.5); margin = margin * T(2))
        if (pencil::lies_within<Wide<T>>(pencil, j, height, static_cast<Narrow<Wide<T>>>(margin)))
            return pencil::bound_of_margin<Wide<T>>(margin);
    return std::numeric_limits<T>::infinity();
}

/// Returns the requested modes among all that `solve()` finds, in the units of the chain's pencils.
template <Real T, class Solve>
Modes<T> modes_of(const Chain<T>& chain, const ModesOptions<T>& options, const char* method,
                  const Solve& solve) {
    check(options);
    LazyCounter<T> assembled(chain);
    const ModeRange range = chosen(chain, assembled, options);
    Modes<T> result = room_for_modes<T>(range);
    result.method = method;
    ModeShapes<T> shapes = room_for_shapes(chain, range.count);
    const Pencils<T>& pencils = assembled.pencils();
    const pencil::Eigensystem<T> system = solve(pencils);
    for (Index j = 0; j < range.count; ++j) {
        const Index before = range.first - 1 + j;
        const T height = system.values[before];
        set_height(result, j, height, proved_error(pencils.wide(), before, height),
                   chain.units().length_exponent, options.rtol);
        Vector<T> offset = Vector<T>::Zero(chain.size() + 1);
        offset.head(chain.size()) = system.vectors.col(before);
        const auto vector = pencil::normalised(std::move(offset));
        shapes.offset.row(j) = vector.offset.transpose();
        shapes.residual[j] = pencil::relative_residual(pencils.wide(), height, vector.offset);
        shapes.nodes[static_cast<std::size_t>(j)] =
            nodes(chain, pin_places(chain), vector.crossings);
        advance(options.progress, static_cast<double>(j + 1) / static_cast<double>(range.count));
    }
    if (options.certify) certify(result, pencils, chain.mode_count());
    ShapesBehind::of(result) = LazyModeShapes<T>(std::move(shapes));
    return result;
}

}  // namespace detail

/// Finds modes by a dense solver for the assembled symmetric-definite pencil, O(N^3). Arguments and
/// errors as for `modes`.
template <Real T>
Modes<T> modes_dense(const Chain<T>& chain, const ModesOptions<T>& options = {}) {
    return detail::modes_of(chain, options, "dense", [](const detail::Pencils<T>& pencils) {
        const auto matrices = pencil::assembled(pencils.rounded());
        return pencil::solve_symmetric_definite(matrices.K, matrices.M);
    });
}

/// Finds modes by the QZ algorithm for relation (21) as a dense pencil, O(N^3). Arguments and
/// errors as for `modes`.
template <Real T>
Modes<T> modes_recurrence(const Chain<T>& chain, const ModesOptions<T>& options = {}) {
    return detail::modes_of(chain, options, "recurrence", [&chain](const detail::Pencils<T>&) {
        using std::ldexp;
        const RecurrencePencil<T> pencil = recurrence_matrices(chain);
        auto system = pencil::solve_general(pencil.A, pencil.B);
        for (T& value : system.values) value = ldexp(value, -chain.units().length_exponent);
        return system;
    });
}

}  // namespace revchain

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD {
extern template Modes<double> modes_dense(const Chain<double>&, const ModesOptions<double>&);
extern template Modes<double> modes_recurrence(const Chain<double>&, const ModesOptions<double>&);
}  // namespace revchain
#endif
