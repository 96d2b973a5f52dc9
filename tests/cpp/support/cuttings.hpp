// SPDX-License-Identifier: MPL-2.0
// Ways of cutting a uniform chain into N equal links, and how fast each tends to the uncut chain: the relative error of
// the conical height of mode k is  law / M^order  to leading order, M the chain's length in links (N, or N + 1/2).
//
// The laws come from the residual that the uncut chain's mode J_0(z), z = 2 sqrt(x / lambda), leaves in each row of the
// pencil, weighted by the mode itself: j is the k-th zero of J_0 and J = J_1(j), q = j^2/4 the length over the height.
// A link of pendulum length l and centroid in the middle has mo = (1 - l/a)/2:
//     law = 1/24 - q [ (1/12 - mo) + (mo - 1/8)/J^2 ],
// the 1/24 from the support, the term in J^-2 from the free end, where the pull vanishes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "revchain/chain.hpp"

namespace support {

/// Mode number, zero j of J_0, and J_1(j), to 25 digits (mpmath).
template <class T>
struct BesselZero {
    int mode;
    T j, J;
};

template <class T>
inline constexpr std::array<BesselZero<T>, 5> bessel_zeros = {{
    {1, static_cast<T>(2.404825557695772768621632L), static_cast<T>(0.5191474972894667881402026L)},
    {2, static_cast<T>(5.520078110286310649596604L), static_cast<T>(-0.3402648065583681485649119L)},
    {3, static_cast<T>(8.653727912911012216954199L), static_cast<T>(0.2714522999283819203880728L)},
    {5, static_cast<T>(14.93091770848778594776259L), static_cast<T>(0.2065464330779960268290550L)},
    {10, static_cast<T>(30.63460646843197511754958L), static_cast<T>(-0.1441659776963696170470063L)},
}};

/// Height of the uncut chain over its length.
template <class T>
T uncut_height(const BesselZero<T>& zero) {
    return T(4) / (zero.j * zero.j);
}

template <class T>
struct Cutting {
    std::string name;
    std::string plain;                            ///< the same for people who do not know the letters
    revchain::Chain<T> (*make)(revchain::Index);  ///< N links of length 1
    T (*law)(T j, T J);                           ///< coefficient of the relative error of the HEIGHT
    int order = 2;
    T excess = T(0);               ///< M - N
    revchain::Index smallest = 1;  ///< least N
};

namespace detail {

using revchain::Chain;
using revchain::Index;
using revchain::Link;
using revchain::Wide;

/// N links with the centroid in the middle; `numerator / denominator` is rho^2.
template <class T>
Chain<T> rigid(Index count, T numerator, T denominator) {
    return Chain<T>(count, T(1), T(1), T(0.5), Wide<T>(numerator) / Wide<T>(denominator));
}

/// The law in the comment at the top.
template <class T>
T rigid_law(T j, T J, T mo) {
    const T q = j * j / T(4);
    return T(1) / T(24) - q * ((T(1) / T(12) - mo) + (mo - T(1) / T(8)) / (J * J));
}

template <class T>
Chain<T> half_thread_on_top(Index count) {
    std::vector<Link<T>> links(static_cast<std::size_t>(count), revchain::plummet<T>(T(1), T(1)));
    links.back().length = links.back().centroid = T(0.5);
    return Chain<T>(links);
}

/// h (a - l) = a^2/12 in every link, h = a/2 but for the ends: 11 a/24 below, 13 a/24 on top (rho^2 = 95/576 in both).
template <class T>
Chain<T> shifted_ends(Index count) {
    std::vector<Link<T>> links(static_cast<std::size_t>(count),
                               Link<T>{T(1), T(1), T(0.5), Wide<T>(T(1)) / Wide<T>(T(6))});
    for (auto [link, share] : {std::pair{&links.front(), T(11)}, std::pair{&links.back(), T(13)}}) {
        link->centroid = share / T(24);
        const Wide<T> h(link->centroid);
        link->gyration_ratio = h - h * h - Wide<T>(T(1)) / Wide<T>(T(12));
    }
    return Chain<T>(links);
}

}  // namespace detail

template <class T>
std::vector<Cutting<T>> cuttings() {
    using revchain::Chain;
    using revchain::Index;
    using revchain::Wide;
    return {
        {"lower pins", "weights at the lower pins",
         [](Index n) { return Chain<T>(n, T(1), T(1), T(1), Wide<T>(T(0))); }, [](T, T) { return T(0.5); }, 1},
        // The weight at the support never moves and the lowest thread hangs idle: N - 1 plummets, N lengths.
        {"upper pins", "weights at the upper pins",
         [](Index n) { return Chain<T>(n - 1, T(1), T(1), T(1), Wide<T>(T(0))); }, [](T, T) { return T(-0.5); }, 1,
         T(0), 2},
        {"cell centres", "weights in the middle of their cells, whole thread on top",
         [](Index n) { return Chain<T>(n, T(1), T(1), T(1), Wide<T>(T(0))); },
         [](T j, T) { return (T(2) - j * j) / T(48); }, 2, T(0.5)},
        {"cell centres, half thread", "weights in the middle of their cells, half a thread on top",
         &detail::half_thread_on_top<T>, [](T j, T) { return -(j * j + T(4)) / T(48); }},
        {"l = a", "half a weight at either pin (l = a)", [](Index n) { return detail::rigid<T>(n, T(1), T(4)); },
         [](T j, T J) { return detail::rigid_law(j, J, T(0)); }},
        {"l = 5a/6", "rigid links, l = 5a/6", [](Index n) { return detail::rigid<T>(n, T(1), T(6)); },
         [](T j, T J) { return detail::rigid_law(j, J, T(1) / T(12)); }},
        {"l = 3a/4", "rigid links, l = 3a/4", [](Index n) { return detail::rigid<T>(n, T(1), T(8)); },
         [](T j, T) { return (j * j + T(4)) / T(96); }},
        {"rods", "uniform rods (l = 2a/3)", [](Index n) { return detail::rigid<T>(n, T(1), T(12)); },
         [](T j, T J) { return detail::rigid_law(j, J, T(1) / T(6)); }},
        {"l = a/2", "weight in the middle of a rigid link (l = a/2)",
         [](Index n) { return detail::rigid<T>(n, T(0), T(1)); },
         [](T j, T J) { return detail::rigid_law(j, J, T(1) / T(4)); }},
        // The law above vanishes here. That of third order was found by fitting (to 8 digits), not derived.
        {"shifted ends", "l = 5a/6 with the end links' weights shifted by a/24", &detail::shifted_ends<T>,
         [](T j, T J) {
             const T q = j * j / T(4);
             return q * q / (T(24) * J * J) + q / T(24) - T(23) / T(576);
         },
         3, T(0), 2},
    };
}

}  // namespace support
