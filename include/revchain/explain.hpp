// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "revchain/models/select.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"

/// The method that `modes`, with all of methods.hpp, tries first for a tolerance, and the predicted
/// costs of the others.
///
///     const auto rods = revchain::Chain<double>::uniform_rods(100'000, 0.36);
///     const auto e = revchain::explain(rods, {.count = 3, .rtol = 1e-2});
///     e.methods[e.chosen].name;    // "continuous chain"
///     const std::string table = e.text();  // each method with its bound and time, or why not
namespace revchain::inline REVCHAIN_BUILD {

class Rig;   // revchain/rig.hpp
class Cord;  // revchain/cord.hpp
template <class System>
class Held;  // revchain/held.hpp

/// The methods for some modes, with their predicted properties, and the one chosen.
struct Explanation {
    std::vector<Estimate> methods;  ///< name, fit, error bound (relative), cost (seconds)
    std::size_t chosen = 0;         ///< index into `methods`
    bool meets_tolerance = false;   ///< false: none does; `chosen` is the most accurate

    /// A table in plain text; the method chosen is marked. Each line ends with a newline.
    [[nodiscard]] std::string text() const;
};

/// Selects modes by number and sets their tolerance, as `ModesOptions` does.
struct ExplainOptions {
    Index first = 1;               ///< from 1 for the slowest
    std::optional<Index> count{};  ///< or `all_modes`; absent: at most 10
    std::optional<double> rtol{};  ///< of the conical heights; absent: full accuracy
};

/// Compares the methods for a chain. With all of methods.hpp, `modes` first tries the one chosen.
/// If that cannot prove its bound, it takes the next one; `Modes::method` names the method used. No
/// mode is computed. Throws as `modes`.
REVCHAIN_DECLARE
[[nodiscard]] Explanation explain(const Chain<double>& chain, const ExplainOptions& options = {});

/// Deleted: for rigs, cords and held systems there is no choice of methods by cost.
Explanation explain(const Rig& rig, const ExplainOptions& options = {}) = delete;
Explanation explain(const Cord& cord, const ExplainOptions& options = {}) = delete;
template <class System>
Explanation explain(const Held<System>& held, const ExplainOptions& options = {}) = delete;

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/explain.hpp"
#endif
