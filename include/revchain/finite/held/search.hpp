// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/held/cells.hpp"
#include "revchain/finite/shapes/isolation.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A cell of the lowest link's pull and tangent that contains exactly one shape.
struct HeldRoot {
    HeldCell cell;
    double pull, tangent;  ///< of the shape, to about 1e-10
};

/// All starts of chains that meet the upper end, and the undecided cells.
struct HeldRoots {
    std::vector<HeldRoot> roots;
    std::vector<HeldCell> undecided;
    long cells = 0;
};

/// Splits a rectangle of starts until each cell contains one shape or none, by Krawczyk's test.
class HeldSearch {
   public:
    using Span = Interval<double>;

    HeldSearch(const HeldCells& chain, long budget) : chain_(chain), budget_(budget) {}

    HeldRoots operator()() {
        const Span pulls = chain_.pulls();
        scale_ = pulls.high;
        const Span tangents(chain_.is_symmetric() ? 0.0 : -1.0, 1.0);
        const std::deque<HeldCell> whole{{{pulls, tangents}, false}, {{pulls, tangents}, true}};
        each_cell<1, true>(
            whole, [&] { return budget_ <= 0; },
            [&](const std::vector<HeldCell>& one, const auto& wait) { visit(one[0], wait); },
            [&](const HeldCell& cell) { found_.undecided.push_back(cell); });
        return found_;
    }

   private:
    struct Image {
        std::array<Span, 2> at;
        bool regular, inside, none;
    };

    /// Encloses the roots of a cell by Krawczyk's operator.
    static std::optional<Image> image(const HeldCell& cell, const HeldReach& reach) {
        const double a = reach.side_change[0].middle(), b = reach.side_change[1].middle(),
                     c = reach.gap_change[0].middle(), d = reach.gap_change[1].middle(),
                     det = a * d - b * c;
        if (!(std::abs(det) > 0) || !std::isfinite(1 / det)) return {};
        const std::array<double, 4> inverse{d / det, -b / det, -c / det, a / det};
        Image result{{}, true, true, false};
        for (std::size_t i = 0; i < 2; ++i) {
            const Span p(inverse[2 * i]), q(inverse[2 * i + 1]);
            Span next = Span(cell.at[i].middle()) - (p * reach.side + q * reach.gap);
            double norm = 0;
            for (std::size_t j = 0; j < 2; ++j) {
                const Span entry =
                    Span(i == j ? 1.0 : 0.0) - (p * reach.side_change[j] + q * reach.gap_change[j]);
                const Span off = cell.at[j] - Span(cell.at[j].middle());
                next = next + entry * off;
                // weighted by the cell's widths, so that rows are comparable
                norm += entry.size() * (cell.at[j].width() / cell.at[i].width());
            }
            if (!(next.low <= next.high)) return {};
            result.regular = result.regular && norm < 1;
            result.inside =
                result.inside && cell.at[i].low < next.low && next.high < cell.at[i].high;
            result.none = result.none || next.high < cell.at[i].low || next.low > cell.at[i].high;
            result.at[i] = common(next, cell.at[i]);
        }
        return result;
    }

    template <class Wait>
    void visit(const HeldCell& cell, const Wait& wait) {
        const HeldReach reach = sweep(cell);
        if (reach.none) return;
        std::size_t widest = relative(cell, 0) > relative(cell, 1) ? 0 : 1;
        if (reach.known) {
            const auto weight = [&](std::size_t i) {
                return cell.at[i].width() *
                       (std::abs(reach.side_change[i].middle()) / chain_.length().high +
                        std::abs(reach.gap_change[i].middle()));
            };
            // split the direction that moves the upper end more; in a long cell slopes mean little
            const std::size_t other = 1 - widest;
            if (weight(other) > 4 * weight(widest) &&
                relative(cell, other) > relative(cell, widest) / 16)
                widest = other;
            const auto next = image(cell, reach);
            if (next) {
                if (next->none) return;
                if (next->regular && isolated(HeldCell{next->at, cell.leads_up})) return;
                const HeldCell less{next->at, cell.leads_up};
                if (less.at[0].width() < 0.5 * cell.at[0].width() ||
                    less.at[1].width() < 0.5 * cell.at[1].width()) {
                    wait(less);
                    return;
                }
            }
        }
        if (relative(cell, 0) < least_ && relative(cell, 1) < least_) {
            found_.undecided.push_back(cell);
            return;
        }
        HeldCell low = cell, high = cell;
        const double middle = cell.at[widest].middle();
        low.at[widest].high = high.at[widest].low = middle;
        wait(low), wait(high);
    }

    /// Returns true if a slightly larger cell contains exactly one shape. It is then listed.
    bool isolated(const HeldCell& cell) {
        HeldCell about = cell;
        for (Span& x : about.at) {
            const double by = 0.1 * x.width() + 1e-14 * x.size() + 1e-300;
            x = {x.low - by, x.high + by};
        }
        if (chain_.is_symmetric()) about.at[1].low = std::max(about.at[1].low, 0.0);
        HeldReach reach = sweep(about);
        if (!reach.known) return false;
        auto next = image(about, reach);
        if (!next || !next->regular || !next->inside) return false;
        HeldCell near{next->at, cell.leads_up};
        for (int round = 0; round < 5; ++round) {
            reach = sweep(near);
            if (!reach.known) break;
            next = image(near, reach);
            if (!next || next->none) break;
            near.at = next->at;
        }
        for (const HeldRoot& other : found_.roots)
            if (within(near, other.cell)) return true;
        found_.roots.push_back({about, near.at[0].middle(), near.at[1].middle()});
        return true;
    }
    static bool within(const HeldCell& cell, const HeldCell& other) {
        Span tangent = cell.at[1];
        if (cell.leads_up != other.leads_up) tangent = Span(1.0) / tangent;
        return other.at[0].low <= cell.at[0].low && cell.at[0].high <= other.at[0].high &&
               other.at[1].low <= tangent.low && tangent.high <= other.at[1].high;
    }
    double relative(const HeldCell& cell, std::size_t i) const {
        return cell.at[i].width() / (i == 0 ? cell.at[0].size() + 1e-3 * scale_ : 1);
    }
    HeldReach sweep(const HeldCell& cell) {
        ++found_.cells;
        const bool fine = relative(cell, 0) < fine_ && relative(cell, 1) < fine_;
        const HeldReach reach = chain_(cell, fine ? arcs_ : 0);
        budget_ -= reach.looked;
        return reach;
    }

    static constexpr double least_ = 1e-9;  // relative width of cells that are not split
    static constexpr double fine_ = 0.02;   // relative width of cells with arcs for slack links
    static constexpr long arcs_ = 300;
    const HeldCells& chain_;
    long budget_;
    double scale_ = 1;
    HeldRoots found_;
};

}  // namespace revchain::finite
