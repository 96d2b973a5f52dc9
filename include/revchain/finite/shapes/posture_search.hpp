// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/isolation.hpp"
#include "revchain/finite/shapes/krawczyk_list.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// An undecided range of tangents of the lowest link along one choice of branches.
template <class T>
struct OpenPart {
    std::vector<MonotoneBranch> choice;
    T low, high;
};
template <class T>
bool goes_on(const OpenPart<T>& part, const OpenPart<T>& next) {
    return part.high == next.low && part.choice == next.choice;
}

/// Searches steady shapes with every link in a given posture. A choice is one branch for each link.
/// Along it all tangents are functions of the lowest one, by the upward sweep of Greenhill (1908)
/// §8 (4), (12). They are differentiable away from joints. Parts of a choice are excluded by the
/// offset of the support or split, until `KrawczykList` decides the box of all tangents.
template <Real T, class End = OnAxis>
class PostureSearch {
   public:
    /// `fewer_digits` is optionally the same search in fewer digits, whose zeros are known.
    template <class... Search>
    PostureSearch(const EnclosedLinks<T>& links, const Interval<T>& height,
                  const std::vector<Posture>& posture, const End& support,
                  const Search&... fewer_digits)
        : links_(links),
          support_(support),
          balance_(links, height, posture, support),
          zeros_(balance_, fewer_digits.zeros_...),
          box_(links.size()) {
        for (std::size_t m = 0; m < links.size(); ++m)
            response_.emplace_back(links[m], height, posture[m]);
    }
    PostureSearch(const PostureSearch&) = delete;
    PostureSearch& operator=(const PostureSearch&) = delete;

    const WholeBalance<T, End>& balance() const { return balance_; }
    const std::vector<typename KrawczykList<T, End>::Zero>& zeros() const { return zeros_.found(); }
    const std::vector<OpenPart<T>>& open() const { return open_; }

    /// Returns the first choice; the lowest link needs no branch.
    std::vector<MonotoneBranch> first_choice() const {
        std::vector<MonotoneBranch> choice(links_.size(), MonotoneBranch::whole);
        for (std::size_t m = 1; m < choice.size(); ++m)
            if (!response_[m].is_single()) choice[m] = MonotoneBranch::right;
        return choice;
    }
    /// Sets the next choice. Returns false after the last.
    bool next_choice(std::vector<MonotoneBranch>& choice) const {
        for (std::size_t m = 1; m < choice.size(); ++m) {
            if (choice[m] == MonotoneBranch::whole) continue;
            if (choice[m] == MonotoneBranch::left) {
                choice[m] = MonotoneBranch::right;
                continue;
            }
            choice[m] =
                choice[m] == MonotoneBranch::right ? MonotoneBranch::middle : MonotoneBranch::left;
            return true;
        }
        return false;
    }

    /// Decides a part of a choice, or leaves parts of it open as `split` does. Returns the number
    /// of parts, plus N^3/256 for each test of the whole chain.
    long search(const OpenPart<T>& whole, const T& last, const T& narrowest, long budget) {
        const bool straight =
            support_.is_symmetric() &&
            std::none_of(whole.choice.begin(), whole.choice.end(), [](MonotoneBranch p) {
                return p == MonotoneBranch::right || p == MonotoneBranch::left;
            });
        return split(
            Bracket<T>{whole.low, whole.high}, last, narrowest, budget,
            [&](const Bracket<T>& part, long& cells) {
                return classify(whole.choice, part, straight && part.low == T(0), cells);
            },
            [&](const Bracket<T>& part) {
                open_.push_back({whole.choice, part.low, part.high});
            });
    }

   private:
    template <Real, class>
    friend class PostureSearch;

    /// Classifies a part: it is decided if every shape in it is in the list.
    Seen classify(const std::vector<MonotoneBranch>& choice, const Bracket<T>& part,
                  bool holds_straight, long& cells) {
        const Cell<T, 1> cell(Interval<T>(part.low, part.high));
        Sweep rules{*this, choice, cell};
        const auto end = sweep_up(links_, cell.first(), rules);
        if (!end.reached) return Seen::decided;
        const bool smooth = rules.smooth;
        Taylor<T, 1> y = end.offset;
        if constexpr (is_support<End>) y = rules.tighten(support_.miss(y, end.sum));
        if (holds_straight ? smooth && !y.slope[0].may_vanish() : !y.value.may_vanish())
            return Seen::decided;
        cells += static_cast<long>(links_.size() * links_.size() * links_.size() / 256);
        if (zeros_.decides(box_)) return Seen::decided;
        const bool rounding =
            smooth && (holds_straight ? rounding_rules(y.slope[0], y.centre_slope[0])
                                      : rounding_rules(y.value, y.centre_value));
        return rounding ? Seen::ruled_by_rounding : Seen::open;
    }

    /// The sweep along a choice. Near a joint it has no derivatives above the first link there.
    struct Sweep {
        PostureSearch& search;
        const std::vector<MonotoneBranch>& choice;
        const Cell<T, 1>& cell;
        bool smooth = true;

        Taylor<T, 1> tighten(const Taylor<T, 1>& f) const { return smooth ? cell.centred(f) : f; }
        bool propagate(std::size_t m, const Taylor<T, 1>& R, Taylor<T, 1>& t) {
            const Response<T>& response = search.response_[m];
            const LoadedTangents<T> over = response.met(choice[m], R.value);
            t.value = over.tangent;
            smooth = smooth && over.smooth;
            if (!over.possible || !smooth) return over.possible;
            if (response.is_plummet()) {
                t = R / response.stiffness();
                return true;
            }
            const LoadedTangents<T> centre = response.met(choice[m], R.centre_value);
            t.centre_value = centre.tangent;
            smooth = centre.possible && centre.smooth &&
                     derive(response.stiffness(), response.turning(), R, t);
            return true;
        }
        Taylor<T, 1> sine(std::size_t m, const Taylor<T, 1>& t) const {
            Taylor<T, 1> s;
            if (smooth)
                s = sine_at(t);
            else
                s.value = sine_at(t.value);
            return search.balance_.posture()[m] == Posture::hangs ? s : Interval<T>(T(-1)) * s;
        }
        Taylor<T, 1> upright(const Taylor<T, 1>& t) const {
            return search.response_[0].stiffness() * t;
        }
        void pass(std::size_t m, const Taylor<T, 1>& t, const Taylor<T, 1>&) {
            search.box_[m] = t.value;
        }
    };

    const EnclosedLinks<T>& links_;
    [[no_unique_address]] End support_;
    WholeBalance<T, End> balance_;
    KrawczykList<T, End> zeros_;
    TangentBox<T> box_;
    std::vector<Response<T>> response_;
    std::vector<OpenPart<T>> open_;
};

}  // namespace revchain::finite
