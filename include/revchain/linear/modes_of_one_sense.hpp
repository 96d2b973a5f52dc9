// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/rig_roots.hpp"
#include "revchain/linear/rig_shape.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A few modes of a rig in one sense of rotation, with the numbers, heights and shapes of `modes`.
class ModesOfOneSense {
   public:
    /// Without momentum both directions are alike. Throws what `RigRoots` throws.
    ModesOfOneSense(std::string_view place, const Rig& rig, double gravity, Rotation direction)
        : rig_(rig),
          roots_(place, rig, gravity, [](double) {}),
          forward_(direction == Rotation::forward || !roots_.has_momentum()) {
        if (!roots_.spectrum()) return;
        for (const pencil::EnclosedRoot& root : roots_.spectrum()->roots)
            if (root.is_real && (root.value.real() > 0) == forward_ &&
                std::abs(root.value) > 0x1p-200) {
                const RigWord x = forward_ ? root.x.real : -root.x.real;
                isolated_.push_back(
                    {static_cast<double>(x), root.radius / std::abs(root.value), x});
            }
    }

    Index count() const {
        if (roots_.spectrum()) return static_cast<Index>(isolated_.size());
        return roots_.rig().pencil.size() == 0 ? 0 : sense().available.count;
    }
    bool complete() const {
        const RigPencil& rig = roots_.rig();
        if (roots_.spectrum()) return roots_.spectrum()->proved;
        if (rig.pencil.size() == 0) return true;
        return (rig.stiffness_positive || rig.stiffness_certain) && sense().available.proved;
    }
    struct Mode {
        double conical_height;  ///< in the chain's unit of length
        double error_bound;     ///< relative
        RigWord root;
    };
    /// Returns `many` modes from number `first` on, from 1 for the slowest.
    std::vector<Mode> found(Index first, Index many) const {
        const RigPencil& rig = roots_.rig();
        const bool quadratic = rig.pencil.quadratic;
        std::vector<FoundRoot> roots;
        if (roots_.spectrum()) {
            roots.assign(isolated_.begin() + (first - 1), isolated_.begin() + (first - 1 + many));
        } else if (many > 0) {
            const double length =
                std::ldexp(rig_.chain().total_length(), -rig.units.length_exponent);
            const double guess = quadratic ? std::sqrt(length) : length;
            roots = refined_roots(sense().roots, first - 1, many, guess, {}, {});
        }
        std::vector<Mode> modes;
        for (const FoundRoot& root : roots) {
            const RigWord height = quadratic ? root.unrounded * root.unrounded : root.unrounded;
            modes.push_back({std::ldexp(static_cast<double>(height), rig.units.length_exponent),
                             (quadratic ? 2.01 : 1) * root.error_bound + epsilon<double>(),
                             root.unrounded});
        }
        return modes;
    }
    /// Returns offsets of the pins of a mode, free end first.
    Vector<double> shape(const Mode& mode) const {
        const RigPencil& rig = roots_.rig();
        auto pencil = forward_ ? rig.pencil : rig.pencil.reversed();
        const RigShapeFinder<> finder{rig_.chain(), rig.idle, std::move(pencil), {mode.root}};
        return finder(0, 1, false, nullptr).offset.row(0);
    }

   private:
    const CountedSense& sense() const { return roots_.senses()[forward_ ? 0 : 1]; }

    const Rig& rig_;
    RigRoots roots_;
    bool forward_;
    std::vector<FoundRoot> isolated_;
};

}  // namespace revchain::detail
