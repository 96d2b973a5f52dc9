// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/assembly.hpp"
#include "revchain/pencil/sturm.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// The pencil of a chain in `Wide<T>` and rounded to T, heights in units of 2^length_exponent.
template <Real T>
class Pencils {
   public:
    explicit Pencils(const Chain<T>& chain)
        : assembled_(assemble(chain)), rounded_(pencil::rounded<T>(assembled_.pencil)) {}

    const pencil::ElementPencil<Wide<T>>& wide() const { return assembled_.pencil; }
    const pencil::ElementPencil<T>& rounded() const { return rounded_; }
    int length_exponent() const { return assembled_.units.length_exponent; }

    /// Converts a length from the chain's unit to that of the pencils.
    template <class Number>
    Number scaled(const Number& height) const {
        using std::ldexp;
        return ldexp(height, -length_exponent());
    }

    /// Returns proved counts above heights: in T if that suffices, else in `Wide<T>` (8 times
    /// slower).
    template <std::size_t L>
    std::array<pencil::CertifiedCount, L> certified_count(
        const std::array<Wide<T>, L>& heights) const {
        std::array<T, L> narrow;
        bool exact = true;
        for (std::size_t i = 0; i < L; ++i) {
            narrow[i] = static_cast<T>(heights[i]);
            exact = exact && Wide<T>(narrow[i]) == heights[i];
        }
        if (exact) {
            const auto quick = pencil::certified_count<T, L>(rounded(), narrow);
            bool proved = true;
            for (const auto& count : quick) proved = proved && count.proved;
            if (proved || std::is_same_v<Wide<T>, T>) return quick;
        }
        return pencil::certified_count<Wide<T>, L>(wide(), heights);
    }

   private:
    AssembledChain<T> assembled_;
    pencil::ElementPencil<T> rounded_;
};

}  // namespace revchain::detail
