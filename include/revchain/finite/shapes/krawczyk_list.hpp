// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/tangent_box.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A list of the zeros of the balance in one posture, each alone in a box; mirror images are one.
template <Real T, class End = OnAxis>
class KrawczykList {
   public:
    struct Zero {
        TangentBox<T> near;  ///< a narrow box that contains the zero
        bool straight = false;
    };

    explicit KrawczykList(const WholeBalance<T, End>& balance) : balance_(balance) {
        if (balance.is_symmetric()) add_straight(balance.posture().size());
    }
    /// Starts with the zeros of the same balance found in fewer digits.
    template <class Fewer, class FewerEnd>
    KrawczykList(const WholeBalance<T, End>& balance, const KrawczykList<Fewer, FewerEnd>& known)
        : balance_(balance) {
        const auto same = [](const TangentBox<Fewer>& x) {
            TangentBox<T> result;
            for (const Interval<Fewer>& t : x) result.push_back({T(t.low), T(t.high)});
            return result;
        };
        for (const auto& zero : known.found_) found_.push_back({same(zero.near), zero.straight});
        for (const auto& zone : known.zones_) zones_.push_back({same(zone.box), zone.zero});
    }

    const std::vector<Zero>& found() const { return found_; }

    /// Returns true if the box has no zero, or one, which is in the list now.
    bool decides(TangentBox<T> box) {
        for (int round = 0; round < 4; ++round) {
            if (is_known(box)) return true;
            const auto narrow = balance_.narrowed(box);
            if (!narrow) return false;
            if (apart(*narrow, box)) return true;
            bool less = false;
            for (std::size_t m = 0; m < box.size(); ++m) {
                const Interval<T> now = common((*narrow)[m], box[m]);
                if (!(now.low <= now.high)) return false;  // nothing is known of the box
                less = less || now.width() < T(0.75) * box[m].width();
                box[m] = now;
            }
            if (!less) break;
        }
        // a zero on the edge of the box, or in a box narrowed to rounding, needs a wider box
        TangentBox<T> wider = box;
        for (int round = 0; round < 3; ++round) {
            using std::abs;
            for (Interval<T>& t : wider) {
                const T off = t.width() / T(2) +
                              T(64) * epsilon<T>() * std::max(abs(t.low), abs(t.high)) +
                              std::numeric_limits<T>::min();
                t = {t.low - off, t.high + off};
            }
            const auto narrow = balance_.narrowed(wider);
            if (!narrow) return false;
            if (strictly_within(*narrow, wider)) return add(wider, *narrow);
            for (std::size_t m = 0; m < box.size(); ++m) {
                if (!((*narrow)[m].width() < T(4) * wider[m].width())) return false;
                wider[m] = hull(wider[m], (*narrow)[m]);
            }
        }
        return false;
    }

   private:
    template <Real, class>
    friend class KrawczykList;
    struct Zone {
        TangentBox<T> box;
        std::size_t zero;
    };

    bool is_known(const TangentBox<T>& box) const {
        for (const Zone& zone : zones_)
            if (within(box, zone.box)) return true;
        return false;
    }

    /// Adds the zero of the box, within `near`. Returns false if it may be one in the list.
    bool add(const TangentBox<T>& box, TangentBox<T> near) {
        for (int round = 0; round < 20; ++round) {
            const auto again = balance_.narrowed(near);
            if (!again) break;
            T before(0), now(0);
            for (std::size_t m = 0; m < box.size(); ++m) {
                before = before + near[m].width();
                near[m] = common(near[m], (*again)[m]);
                now = now + near[m].width();
            }
            if (!(now < T(0.5) * before)) break;
        }
        const bool both = balance_.is_symmetric();
        const TangentBox<T> other = both ? mirror_image(near) : near;
        for (const Zone& zone : zones_) {
            if (!within(near, zone.box) && !within(other, zone.box)) continue;
            zones_.push_back({box, zone.zero});
            return true;
        }
        for (std::size_t i = 0; i < found_.size(); ++i) {
            if (within(found_[i].near, box) ||
                (both && within(found_[i].near, mirror_image(box)))) {
                zones_.push_back({box, i});
                return true;
            }
            if (!apart(near, found_[i].near) || !apart(other, found_[i].near)) return false;
        }
        found_.push_back({near, false});
        zones_.push_back({box, found_.size() - 1});
        return true;
    }

    void add_straight(std::size_t size) {
        for (T reach(0.5); reach > T(1e-12); reach = reach / T(4)) {
            const TangentBox<T> box(size, Interval<T>(-reach, reach));
            const auto narrow = balance_.narrowed(box);
            if (!narrow || !strictly_within(*narrow, box)) continue;
            found_.push_back({TangentBox<T>(size, Interval<T>(T(0))), true});
            zones_.push_back({box, 0});
            return;
        }
    }

    const WholeBalance<T, End>& balance_;
    std::vector<Zero> found_;
    std::vector<Zone> zones_;
};

}  // namespace revchain::finite
