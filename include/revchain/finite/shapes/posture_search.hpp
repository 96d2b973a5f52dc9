// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/isolation.hpp"
#include "revchain/finite/shapes/krawczyk_list.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::finite {

/// What is left open: tangents of the lowest link along one path.
template <class T>
struct OpenPart {
    std::vector<Piece> path;
    T low, high;
};

/// Steady shapes with every link in a given posture. A path is one piece for each link: along it the tangents of all
/// links are functions of that of the lowest, by the upward sweep of Greenhill (1908) §8 (4), (12), with derivatives
/// wherever no link comes near a joint of its pieces. Parts of a path that the offset of the support rules out are
/// dropped, the others split, until what they leave of the tangents of all links is a box that `Zeros` settles.
template <Real T, class End = OnAxis>
class PostureSearch {
   public:
    PostureSearch(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height,
                  const std::vector<Posture>& posture, const End& support = {})
        : links_(links),
          support_(support),
          balance_(links, height, posture, support),
          zeros_(balance_),
          box_(links.size()) {
        respond(height);
    }
    /// The same in more digits.
    template <class Fewer, class FewerEnd>
    PostureSearch(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height,
                  const PostureSearch<Fewer, FewerEnd>& before, const End& support = {})
        : links_(links),
          support_(support),
          balance_(links, height, before.balance_.posture(), support),
          zeros_(balance_, before.zeros_),
          box_(links.size()) {
        respond(height);
    }
    PostureSearch(const PostureSearch&) = delete;
    PostureSearch& operator=(const PostureSearch&) = delete;

    const WholeBalance<T, End>& balance() const { return balance_; }
    const std::vector<typename Zeros<T, End>::Zero>& zeros() const { return zeros_.found(); }
    const std::vector<OpenPart<T>>& open() const { return open_; }

    /// The first path: the lowest link needs no pieces, its tangent is given.
    std::vector<Piece> first_path() const {
        std::vector<Piece> path(links_.size(), Piece::whole);
        for (std::size_t m = 1; m < path.size(); ++m)
            if (!response_[m].is_single()) path[m] = Piece::right;
        return path;
    }
    /// The one after; false after the last.
    bool next_path(std::vector<Piece>& path) const {
        for (std::size_t m = 1; m < path.size(); ++m) {
            if (path[m] == Piece::whole) continue;
            if (path[m] == Piece::left) {
                path[m] = Piece::right;
                continue;
            }
            path[m] = path[m] == Piece::right ? Piece::middle : Piece::left;
            return true;
        }
        return false;
    }

    /// Settles low ... high of a path, but parts narrower than `narrowest` of their upper end (next to 0 of `last` and
    /// of 1), those in which rounding rules, and what is beyond the budget, which it leaves open. Returns the parts
    /// looked at, and N^3/256 for each test of the whole chain.
    long search(const OpenPart<T>& whole, const T& last, const T& narrowest, long budget) {
        const bool straight =
            support_.is_symmetric() && std::none_of(whole.path.begin(), whole.path.end(),
                                                    [](Piece p) { return p == Piece::right || p == Piece::left; });
        std::vector<std::pair<T, T>> stack{{whole.low, whole.high}};
        detail::Cutting<T> cutting;
        long cells = 0;
        while (!stack.empty()) {
            revchain::detail::look();
            const auto [low, high] = stack.back();
            stack.pop_back();
            if (cells >= budget) {
                open_.push_back({whole.path, low, high});
                continue;
            }
            ++cells;
            cells_of_tests_ = 0;
            const Part part = judged(whole.path, low, high, straight && low == T(0));
            cells += cells_of_tests_;
            if (part == Part::settled) continue;
            const auto cut = cutting.between(low, high, narrowest, last);
            if (!cut || part == Part::ruled_by_rounding) {
                open_.push_back({whole.path, low, high});
                continue;
            }
            stack.push_back({*cut, high});
            stack.push_back({low, *cut});
        }
        return cells;
    }

   private:
    template <Real, class>
    friend class PostureSearch;

    void respond(const Interval<T>& height) {
        for (std::size_t m = 0; m < links_.size(); ++m)
            response_.emplace_back(links_[m], height, balance_.posture()[m]);
    }

    /// Of a part of a path: holds no shape that is not in the list; may show more if split; will not.
    enum class Part { settled, open, ruled_by_rounding };
    Part judged(const std::vector<Piece>& path, const T& low, const T& high, bool holds_straight) {
        const Cell<T, 1> cell(Interval<T>(low, high));
        Sweep rules{*this, path, cell};
        const auto end = sweep_up(links_, cell.first(), rules);
        if (!end.reached) return Part::settled;
        const bool smooth = rules.smooth;
        Taylor<T, 1> y = end.offset;
        if constexpr (is_held<End>) {
            if (smooth)
                y = support_.miss(cell, y, end.sum);
            else
                y.value = support_.miss(y.value, end.sum.value);
        }
        if (holds_straight ? smooth && !y.slope[0].may_vanish() : !y.value.may_vanish()) return Part::settled;
        cells_of_tests_ = static_cast<long>(links_.size() * links_.size() * links_.size() / 256);
        if (zeros_.settles(box_)) return Part::settled;
        const bool rounding = smooth && (holds_straight ? detail::rounding_rules(y.slope[0], y.centre_slope[0])
                                                        : detail::rounding_rules(y.value, y.centre_value));
        return rounding ? Part::ruled_by_rounding : Part::open;
    }

    /// The sweep along a path; without derivatives from the first link on that comes near a joint.
    struct Sweep {
        PostureSearch& search;
        const std::vector<Piece>& path;
        const Cell<T, 1>& cell;
        bool smooth = true;

        Taylor<T, 1> tighten(const Taylor<T, 1>& f) const { return smooth ? cell.centred(f) : f; }
        bool carry(std::size_t m, const Taylor<T, 1>& R, Taylor<T, 1>& t) {
            const Response<T>& response = search.response_[m];
            const Met<T> over = response.met(path[m], R.value);
            t.value = over.tangent;
            smooth = smooth && over.smooth;
            if (!over.possible || !smooth) return over.possible;
            if (response.is_plummet()) {
                t = R / response.stiffness();
                return true;
            }
            const Met<T> centre = response.met(path[m], R.centre_value);
            t.centre_value = centre.tangent;
            smooth = centre.possible && centre.smooth &&
                     detail::derive(response.stiffness(), response.stiffness(), response.turning(), {}, R, t);
            return true;
        }
        Taylor<T, 1> sine(std::size_t m, const Taylor<T, 1>& t) const {
            Taylor<T, 1> s;
            if (smooth)
                s = detail::sine_at(t);
            else
                s.value = detail::sine_at(t.value);
            return search.balance_.posture()[m] == Posture::hangs ? s : Interval<T>(T(-1)) * s;
        }
        Taylor<T, 1> upright(const Taylor<T, 1>& t) const { return search.response_[0].stiffness() * t; }
        void pass(std::size_t m, const Taylor<T, 1>& t, const Taylor<T, 1>&) { search.box_[m] = t.value; }
    };

    const std::vector<Link<Interval<T>>>& links_;
    [[no_unique_address]] End support_;
    WholeBalance<T, End> balance_;
    Zeros<T, End> zeros_;
    Box<T> box_;
    std::vector<Response<T>> response_;
    std::vector<OpenPart<T>> open_;
    long cells_of_tests_ = 0;
};

}  // namespace revchain::finite
