// SPDX-License-Identifier: MPL-2.0
// Defines what held.hpp declares.
#pragma once

#include "revchain/finite/held/proof.hpp"
#include "revchain/finite/held/search.hpp"
#include "revchain/finite/held/shape.hpp"
#include "revchain/linear/counted_roots.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Shapes of a chain held at both ends.
struct HeldShapes {
    std::vector<HeldShape> shapes;            ///< by half waves
    std::vector<int> missing;                 ///< numbers of half waves without a shape found
    bool complete = false;                    ///< proved: none is missing in the plane
    std::vector<InclinationRange> undecided;  ///< of the lowest link, for further planar shapes
    long cells = 0;                           ///< number of cells examined
};

namespace finite {

/// The supports of both ends, and the height at which springs are evaluated, if not the shape's.
struct HeldSupports {
    Support lower{}, upper{};
    std::optional<Fine> height{};

    bool plain() const { return lower == Support{} && upper == Support{}; }
};

/// Returns the supports at a height, in units of a chain, with radii and compliances times `part`.
/// The parameter of the derivatives is the height; with `by_part` it is the part.
template <class T>
HeldEnds<T> held_ends(const HeldSupports& supports, const ChainUnits& units, const T& height,
                      double part = 1, bool by_part = false) {
    HeldEnds<T> result;
    if (supports.plain()) return result;
    if (by_part) result.height_change = T(0);
    for (const bool above : {false, true}) {
        const Support& support = above ? supports.upper : supports.lower;
        SupportEnd<T>& end = above ? result.upper : result.lower;
        const T radius(std::ldexp(support.radius, -units.length_exponent));
        end.radius = radius * T(part), end.symmetric = part == 0 || support.radius == 0;
        if (by_part) result.radius_change[above] = radius;
        if (support.is_firm() || (part == 0 && !by_part)) continue;
        const T at = supports.height ? static_cast<T>(*supports.height) : height;
        const T stiffness =
            at *
            static_cast<T>(ldexp(support.stiffness, units.length_exponent - units.weight_exponent));
        end.firm = false, end.stiffness = stiffness / T(part > 0 ? part : 1),
        end.compliance = T(part) / stiffness;
        end.carriage = T(std::ldexp(support.carriage_weight, -units.weight_exponent));
        if (by_part)
            result.compliance_change[above] = T(1) / stiffness;
        else if (!supports.height)
            result.compliance_change[above] = -(end.compliance / height);
    }
    return result;
}

/// A chain held at both ends, and the directions of its links in the last kept state.
class HeldChain {
   public:
    using S = Fine;

    explicit HeldChain(const Chain<double>& chain, const HeldSupports& supports = {})
        : chain_(chain),
          wide_(links_of(chain)),
          links_(rounded<double>(wide_.links)),
          supports_(supports) {
        for (const Link<S>& link : wide_.links)
            length_ = length_ + link.length, weight_ = weight_ + link.moment + link.rest;
        if (supports.height)
            supports_.height = ldexp(*supports.height, -wide_.units.length_exponent);
        straighten();
    }
    HeldChain(const HeldChain&) = delete;
    HeldChain& operator=(const HeldChain&) = delete;

    const Links<S>& links() const { return wide_; }
    const S& length() const { return length_; }

    /// Returns the upper end for given forces, with links starting from the last kept state.
    /// Derivatives are by the height, or after `vary_part(true)` by the part of the supports.
    HeldEnd<double> operator()(const HeldForces<double>& forces, bool keep) {
        trial_ = kept_;
        const HeldEnds<double> held = ends(forces.height, forces.part);
        const HeldEnd<double> end = held_sweep(links_, held, forces, trial_);
        if (end.known && keep) kept_ = trial_;
        return end;
    }
    void vary_part(bool part) { by_part_ = part; }
    /// Fixes the height at which springs are evaluated. Without it, each state uses its own height.
    void springs_at(const std::optional<S>& height) { supports_.height = height; }

    /// Returns the supports at a height, with radii and compliances times `part`.
    template <class T>
    HeldEnds<T> ends(const T& height, double part = 1) const {
        return held_ends(supports_, wide_.units, height, part, by_part_);
    }
    bool is_symmetric() const { return supports_.lower.radius == 0 && supports_.upper.radius == 0; }
    /// Returns false with two arms: a torque about the axis may bend the chain out of its plane.
    bool planar() const { return supports_.lower.radius == 0 || supports_.upper.radius == 0; }

    const std::vector<Direction<double>>& kept() const { return kept_; }
    void keep(std::vector<Direction<double>> directions) { kept_ = std::move(directions); }

    HeldCurve<HeldChain> curve() {
        return {*this, as_double(length_), as_double(weight_), is_symmetric()};
    }

    /// Returns the state with `half_waves` half waves; see `HeldCurve::from_straight`. Without
    /// mirror images `outwards` tells whether the lowest link of the straight chain leads outwards.
    std::optional<HeldState> at_height(int half_waves, const S& span, double height,
                                       bool outwards = true) {
        // Without gravity the nearly straight chain has the shape y of a mode under tension 1. The
        // height of the mode is the force along the axis.
        const detail::LowerEnd unit{.tension = ldexp(S(1.0), wide_.units.weight_exponent),
                                    .weightless = true};
        const auto taut = detail::counted_heights(rig_pencil({chain_, {}}, 1.0, unit));
        if (half_waves > taut.available.count) return {};
        const auto guess = as_double(weight_ * length_);
        const auto bracket = taut.roots.brackets(half_waves - 1, 1, guess, {}).front();
        const double along = pencil::between(bracket.lower, bracket.upper);
        std::vector<double> y{0.0};
        for (const S& offset : taut.roots.vector(S(along))) y.push_back(as_double(offset));
        double short_of = 0;  // the difference of the chain's length from the span of y
        for (std::size_t m = 0; m < links_.size(); ++m)
            short_of += std::pow(y[m] - y[m + 1], 2) / (2 * links_[m].length);
        const double pull = std::abs((along / links_[0].length + links_[0].cross) * y[1]);
        straighten();
        const double across = outwards ? -1 : 1, part = supports_.plain() ? 1 : 0;
        return curve().from_straight(
            as_double(length_ - span), as_double(span), height, [&](double slack) {
                return HeldForces<double>{across * pull * std::sqrt(slack / short_of), along, 0,
                                          part};
            });
    }

    /// Returns the shape at a span and height: Newton's method in double-double from a double
    /// state.
    std::optional<HeldShape> finished(const HeldState& state, const S& span, const S& height,
                                      bool prove) const {
        const HeldEnds<S> held = ends(height);
        HeldForces<S> forces{S(state.forces.across), S(state.forces.along), height};
        std::vector<Direction<S>> direction;
        for (const Direction<double>& d : kept_) {  // scaled to unit length in double-double
            const S sine(d.sine), cosine(d.cosine), size = sqrt(sine * sine + cosine * cosine);
            direction.push_back({sine / size, cosine / size});
        }
        if (is_symmetric() && kept_.front().sine > 0) {  // turn the lowest link outwards
            forces.across = -forces.across;
            for (Direction<S>& d : direction) d.sine = -d.sine;
        }
        const auto sweep = [&](const HeldForces<S>& at) {
            return held_sweep(wide_.links, held, at, direction);
        };
        if (!find_forces(forces, span, is_symmetric(), 1e-29, 1e-18, sweep)) return {};
        HeldShape shape = described(wide_, held, forces, span, direction);
        if (prove) {
            std::vector<Direction<Far>> found;
            for (const Direction<S>& d : direction) found.push_back({Far(d.sine), Far(d.cosine)});
            const double error =
                held_error(enclosed<Far>(wide_.links), enclosed<Far>(held), enclosed<Far>(height),
                           enclosed<Far>(span), {Far(forces.across), Far(forces.along)}, found);
            shape.proved = error < 1e-3;
            if (shape.proved)
                shape.error_bound =
                    error + 1.001 * 0x1p-53 * shape.inclination.cwiseAbs().maxCoeff();
        }
        return shape;
    }

    /// Returns lambda times the tension at the upper end.
    double top_pull(const HeldForces<double>& forces) {
        return std::hypot((*this)(forces, false).across,
                          forces.along + forces.height * as_double(weight_));
    }

    /// Sets the directions of links by the pulls on them under forces at the lower end.
    void draw(const HeldForces<double>& forces) {
        straighten();
        std::vector<Direction<double>> drawn;
        const auto at_pull = [&](std::size_t m, double R, double V, Direction<double>& way) {
            const double pull = std::hypot(R, V);
            way = {R / pull, V / pull};
            const double stiffness = find_direction(links_[m], R, V, way);
            drawn.push_back(way);
            return stiffness;
        };
        if (held_sweep<2>(links_, ends(forces.height), forces, at_pull).known) kept_ = drawn;
    }

    /// Returns a state near given forces with a wanted tension at the upper end times height.
    std::optional<HeldState> under(HeldForces<double> forces, double wanted) {
        const auto sweep = [&](const HeldForces<double>& at) {
            HeldEnd<double> end = (*this)(at, true);
            const double along = at.along + at.height * as_double(weight_);
            // `find_forces` solves for a rise; here the tension is in its place
            end.rise = std::hypot(end.across, along);
            end.rise_change[0] = end.across_change[0] * end.across / end.rise;
            end.rise_change[1] = (end.across_change[1] * end.across + along) / end.rise;
            return end;
        };
        if (!find_forces(forces, wanted, is_symmetric(), 1e-15, 1e-12, sweep)) return {};
        return HeldState{forces, (*this)(forces, true).rise};
    }

   private:
    void straighten() { kept_.assign(links_.size(), {0.0, 1.0}); }

    Chain<double> chain_;
    Links<S> wide_;
    std::vector<Link<double>> links_;
    HeldSupports supports_;
    bool by_part_ = false;
    S length_{0}, weight_{0};
    std::vector<Direction<double>> kept_, trial_;
};

/// Returns ascending ranges of the lowest link's inclination that contain cells.
REVCHAIN_LAZY
std::vector<InclinationRange> inclinations(const std::vector<HeldCell>& cells) {
    std::vector<InclinationRange> result;
    for (const HeldCell& cell : cells) {
        const double low = 2 * std::atan(cell.at[1].low), high = 2 * std::atan(cell.at[1].high),
                     by = 1e-15;
        constexpr double pi = std::numbers::pi;
        if (cell.leads_up) {
            result.push_back({-high - by, -low + by});
            continue;
        }
        if (high >= 0) result.push_back({std::max(low, 0.0) - by - pi, high + by - pi});
        if (low < 0) result.push_back({low - by + pi, std::min(high, 0.0) + by + pi});
    }
    std::sort(result.begin(), result.end(),
              [](const auto& x, const auto& y) { return x.low < y.low; });
    std::vector<InclinationRange> apart;
    for (const InclinationRange& range : result)
        if (!apart.empty() && range.low <= apart.back().high)
            apart.back().high = std::max(apart.back().high, range.high);
        else
            apart.push_back(range);
    return apart;
}

struct HeldListOptions {
    int max_half_waves;
    bool prove;
    long budget;
};

REVCHAIN_LAZY
void sort_by_half_waves(std::vector<HeldShape>& shapes) {
    const auto before = [](const HeldShape& x, const HeldShape& y) {
        return x.half_waves < y.half_waves;
    };
    std::stable_sort(shapes.begin(), shapes.end(), before);
}
REVCHAIN_LAZY
bool has(const std::vector<HeldShape>& shapes, int half_waves) {
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const auto& x) { return x.half_waves == half_waves; });
}
REVCHAIN_LAZY
bool has(const std::vector<HeldShape>& shapes, const HeldShape& shape) {
    return std::any_of(shapes.begin(), shapes.end(), [&](const HeldShape& other) {
        return (other.inclination - shape.inclination).cwiseAbs().maxCoeff() < 1e-8;
    });
}

/// Removes repeated shapes and sorts. Several curves may lead to one shape, or change half waves.
REVCHAIN_LAZY
void keep_different(HeldShapes& list, int max_half_waves) {
    std::vector<HeldShape> kept;
    for (const HeldShape& shape : list.shapes)
        if (shape.half_waves <= max_half_waves && !has(kept, shape)) kept.push_back(shape);
    list.shapes = std::move(kept), list.missing.clear();
    sort_by_half_waves(list.shapes);
    for (int k = 1; k <= max_half_waves; ++k)
        if (!has(list.shapes, k)) list.missing.push_back(k);
}

/// Adds all other planar shapes to those found by branches, and the ranges that may contain more.
REVCHAIN_LAZY
void complete(HeldShapes& list, HeldChain& held, const Fine& height, const HeldGoal& goal,
              const HeldListOptions& options) {
    const EnclosedLinks<double> links = enclosed<double>(held.links().links);
    const HeldCells cells(links, enclosed<double>(held.ends(height)), enclosed<double>(height),
                          goal, options.max_half_waves);
    HeldRoots found = HeldSearch(cells, options.budget)();
    for (const HeldRoot& root : found.roots) {
        const HeldForces<double> forces = cells.forces(root.pull, root.tangent, root.cell.leads_up);
        held.draw(forces);
        std::optional<HeldShape> shape;
        if (goal.is_span) {
            const double span = goal.value.middle();
            shape = held.finished({forces, span}, Fine(span), height, options.prove);
        } else if (const auto state = held.under(forces, goal.value.middle())) {
            if (state->span < 0) continue;  // the upper end is the lower one
            shape = held.finished(*state, Fine(state->span), height, options.prove);
        }
        if (!shape)
            found.undecided.push_back(root.cell);
        else if (!has(list.shapes, *shape))
            list.shapes.push_back(*shape);
    }
    sort_by_half_waves(list.shapes);
    std::erase_if(list.missing, [&](int k) { return has(list.shapes, k); });
    list.undecided = inclinations(found.undecided);
    list.complete = held.planar() && found.undecided.empty(), list.cells = found.cells;
}

/// Returns shapes of up to `max_half_waves` half waves at a span and a height (0: no gravity).
REVCHAIN_LAZY
HeldShapes held_shapes(const Chain<double>& chain, const HeldSupports& supports, double span,
                       const Fine& height, const HeldListOptions& options) {
    HeldChain held(chain, supports);
    const int exponent = held.links().units.length_exponent;
    const double apart = std::ldexp(span, -exponent);
    const Fine lambda = ldexp(height, -exponent);
    auto list = each_half_wave<HeldShapes>(options.max_half_waves, [&](int k, const auto& add) {
        for (const bool outwards : {true, false}) {
            if (!outwards && held.is_symmetric()) break;
            if (const auto state = held.at_height(k, Fine(apart), as_double(lambda), outwards))
                add(held.finished(*state, Fine(apart), lambda, options.prove));
        }
    });
    keep_different(list, options.max_half_waves);
    if (options.prove)
        complete(list, held, lambda, {.value = Interval<double>(apart), .is_span = true}, options);
    return list;
}

/// Returns shapes of up to `max_half_waves` half waves with a given upper tension times height.
REVCHAIN_LAZY
HeldShapes held_shapes_under_tension(const Chain<double>& chain, const HeldSupports& supports,
                                     const Fine& height_times_tension, const Fine& conical_height,
                                     const HeldListOptions& options) {
    HeldChain held(chain, supports);
    const ChainUnits units = held.links().units;
    const Fine wanted = ldexp(height_times_tension, -units.length_exponent - units.weight_exponent),
               lambda = ldexp(conical_height, -units.length_exponent);
    auto list = each_half_wave<HeldShapes>(options.max_half_waves, [&](int k, const auto& add) {
        each_under(held, k, lambda.high, wanted.high, [&](const HeldState& found) {
            add(held.finished(found, Fine(found.span), lambda, options.prove));
        });
    });
    keep_different(list, options.max_half_waves);
    if (options.prove)
        complete(list, held, lambda, {.value = enclosed<double>(wanted), .is_span = false},
                 options);
    return list;
}

}  // namespace finite
}  // namespace revchain
