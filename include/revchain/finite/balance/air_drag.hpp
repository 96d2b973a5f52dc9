// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A vector in space.
template <class S>
struct Space {
    S x{0.0}, y{0.0}, z{0.0};

    friend Space operator+(const Space& p, const Space& q) {
        return {p.x + q.x, p.y + q.y, p.z + q.z};
    }
    friend Space operator-(const Space& p, const Space& q) {
        return {p.x - q.x, p.y - q.y, p.z - q.z};
    }
    friend Space operator*(const S& c, const Space& p) { return {c * p.x, c * p.y, c * p.z}; }
    friend S dot(const Space& p, const Space& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
    /// The velocity of the point if the figure turns about z with the speed 1.
    Space turned() const { return {-y, x, S(0.0)}; }
};

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

template <class S>
Vector3 as_vector(const Space<S>& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Drag coefficients of a link: force over (length times velocity squared) of the cylinder, and
/// force over velocity squared of the body at the share `at` of the length below the upper pin.
struct LinkDrag {
    double line = 0, body = 0, at = 0;
    bool is_none() const { return line == 0 && body == 0; }
};

/// The drag on a link: its sum, and the sum of force times distance from the upper pin over the
/// length, so that the moment about that pin is length direction x lever.
template <class S>
struct DragForces {
    Space<S> force{}, lever{};
};

/// Derivatives of `DragForces` to the upper pin's place (horizontal) and to the direction.
struct DragSlopes {
    Matrix32 force_pin = Matrix32::Zero(), lever_pin = Matrix32::Zero();
    Matrix3 force_direction = Matrix3::Zero(), lever_direction = Matrix3::Zero();
};

using GaussRule = std::vector<std::pair<double, double>>;

/// Calls add(share of the link, weight) for the points of a rule on parts of 0 ... 1. The velocity
/// from + share along is nowhere too small for the rule in a part, but in parts that are as short
/// as 2^-18 of the link.
template <class Add>
void along_link(const GaussRule& rule, const Space<double>& from, const Space<double>& along,
                const Add& add) {
    const double square = dot(along, along);
    const double slowest = square > 0 ? std::clamp(-dot(from, along) / square, 0.0, 1.0) : 0.0;
    const auto part = [&](auto&& self, double begin, double end) -> void {
        if (!(begin < end)) return;
        const double half = (end - begin) / 2, middle = begin + half;
        const Space<double> v = from + middle * along;
        if (dot(v, v) < 8.9 * half * half * square && half > 0x1p-19) {
            self(self, begin, middle), self(self, middle, end);
            return;
        }
        for (const auto& [x, weight] : rule) add(begin + 2 * half * x, 2 * half * weight);
    };
    part(part, 0, slowest), part(part, slowest, 1);
}

/// Returns the drag on a link of length a from its upper pin `pin` in the direction u, in a figure
/// that turns with the speed 1. Adds derivatives to `slopes`, if given.
///
/// A point at the distance s moves with v = z x (pin + s u). Its part across the link is
/// v - u (u . z x pin), because u . z x u = 0. The drag of the cylinder is that of this part.
template <class S>
DragForces<S> drag_on_link(const LinkDrag& drag, const GaussRule& rule, const S& a,
                           const Space<S>& pin, const Space<S>& u, DragSlopes* slopes = nullptr) {
    DragForces<S> sum;
    if (drag.is_none()) return sum;
    const Space<S> moves = pin.turned(), turn = a * u.turned();
    const S slip = dot(u, moves);
    const Space<S> across = moves - slip * u;
    Matrix3 size[3] = {Matrix3::Zero(), Matrix3::Zero(), Matrix3::Zero()};  // by power of the share
    const auto act = [&](double share, double factor, const Space<S>& v) {
        using std::sqrt;
        const S speed = sqrt(dot(v, v));
        const Space<S> f = S(-factor) * (speed * v);
        sum.force = sum.force + f, sum.lever = sum.lever + S(share) * f;
        const double value = static_cast<double>(speed);
        if (slopes == nullptr || value == 0) return;
        const Vector3 w = as_vector(v);
        Matrix3 slope = (-factor / value) * (w * w.transpose());
        slope.diagonal().array() -= factor * value;
        size[0] += slope, size[1] += share * slope, size[2] += share * share * slope;
    };
    Matrix3 z = Matrix3::Zero();
    z(0, 1) = -1, z(1, 0) = 1;
    const double length = static_cast<double>(a);
    const auto add_slopes = [&](const Matrix3& to_pin, const Matrix3& to_direction) {
        if (slopes == nullptr) return;
        const Matrix3 pins = to_pin * z, turns = length * z;
        slopes->force_pin += (size[0] * pins).leftCols<2>();
        slopes->lever_pin += (size[1] * pins).leftCols<2>();
        slopes->force_direction += size[1] * turns + size[0] * to_direction;
        slopes->lever_direction += size[2] * turns + size[1] * to_direction;
    };
    if (drag.line != 0) {
        const auto rounded = [](const Space<S>& p) {
            const Vector3 v = as_vector(p);
            return Space<double>{v[0], v[1], v[2]};
        };
        along_link(rule, rounded(across), rounded(turn), [&](double share, double weight) {
            act(share, drag.line * length * weight, across + S(share) * turn);
        });
        const Vector3 direction = as_vector(u), moved = as_vector(moves);
        add_slopes(
            Matrix3::Identity() - direction * direction.transpose(),
            -static_cast<double>(slip) * Matrix3::Identity() - direction * moved.transpose());
        for (Matrix3& each : size) each.setZero();
    }
    if (drag.body != 0) {
        act(drag.at, drag.body, moves + S(drag.at) * turn);
        add_slopes(Matrix3::Identity(), Matrix3::Zero());
    }
    return sum;
}

}  // namespace revchain::finite
