// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain.hpp"

/// Functions that make a chain from another one: they attach a weight, insert a thread, or clamp
/// two links together. Joined bodies are computed in two words; weight and centroid are then
/// rounded once. Conical heights differ from those of the exact body by at most 3 ulp, measured
/// (tests/cpp/system/edit.cpp). Cost O(N).
namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// A rigid body of a link, with lengths in units of the link's length.
template <Real T>
struct Body {
    T weight{};
    Wide<T> centroid{};
    Wide<T> gyration_ratio{};
};

/// Returns two bodies, rigidly joined, as one link of this length. Its moment of inertia about the
/// common centroid is the sum of the bodies' moments and a term of their distance, all positive.
template <Real T>
Link<T> joined(const T& length, const Body<T>& one, const Body<T>& other) {
    using std::frexp, std::ldexp;
    using S = Wide<T>;
    const T weight = one.weight + other.weight;
    if (weight == T(0)) return plummet<T>(weight, length);
    int exponent = 0;
    frexp(weight, &exponent);
    const S w1(ldexp(one.weight, -exponent)), w2(ldexp(other.weight, -exponent)), both = w1 + w2;
    const S share = w2 / both, rest = w1 / both, apart = other.centroid - one.centroid;
    const S centroid = one.centroid + share * apart;
    const S gyration =
        rest * one.gyration_ratio + share * other.gyration_ratio + share * rest * apart * apart;
    return {weight, length, times_length<T>(centroid, length), gyration};
}

template <Real T>
Body<T> body(const Link<T>& link) {
    return {link.weight, in_lengths<T>(link.centroid, link.length), link.gyration_ratio};
}

template <Real T>
std::vector<Link<T>> links_of(const Chain<T>& chain) {
    std::vector<Link<T>> links;
    links.reserve(static_cast<std::size_t>(chain.size()) + 1);
    for (Index m = 0; m < chain.size(); ++m) links.push_back(chain.link(m));
    return links;
}

}  // namespace detail

/// Returns the chain with a body fixed to the link above `pin`, its centre of gravity in that pin.
/// Pin 0 is the free end; links number `pin` and `pin` + 1 share any other pin. The body turns with
/// that link.
/// Throws InvalidArgument for a pin that does not exist or is the support, a weight that is not
/// positive, a negative radius of gyration, and if the result is not a valid chain.
template <Real T>
Chain<T> with_weight(const Chain<T>& chain, const T& weight, Index pin = 0,
                     const T& radius_of_gyration = T(0)) {
    constexpr std::string_view place = "with_weight";
    detail::require_positive(place, "weight", weight);
    if (pin < 0 || pin >= chain.size())
        detail::throw_invalid(
            place, "pin must be from 0, the free end, to " + std::to_string(chain.size() - 1), pin);
    auto links = detail::links_of(chain);
    Link<T>& link = links[static_cast<std::size_t>(pin)];
    const Wide<T> gyration =
        detail::gyration_from_radius<T>(place, link.length, radius_of_gyration);
    link = detail::joined<T>(link.length, detail::body(link), {weight, Wide<T>(T(1)), gyration});
    return Chain<T>(links);
}

/// Returns the chain with a massless thread inserted above link number `pin`, counted from 1. The
/// thread is below the next link or, if `pin` is the number of links, below the support.
/// Throws InvalidArgument for other pins and for a length that is not positive.
template <Real T>
Chain<T> with_thread(const Chain<T>& chain, const T& length, Index pin) {
    constexpr std::string_view place = "with_thread";
    detail::require_positive(place, "length", length);
    if (pin < 1 || pin > chain.size())
        detail::throw_invalid(
            place, "pin must be from 1 to " + std::to_string(chain.size()) + ", the support", pin);
    auto links = detail::links_of(chain);
    links.insert(links.begin() + pin, plummet<T>(T(0), length));
    return Chain<T>(links);
}

/// Returns the chain with the links at index `link` and `link` + 1 locked in line as one rigid
/// link. Its conical heights lie between the chain's: lambda(k + 1) <= clamped lambda(k) <=
/// lambda(k).
/// Throws InvalidArgument for an index outside 0 ... N - 2.
template <Real T>
Chain<T> clamped(const Chain<T>& chain, Index link) {
    if (link < 0 || link + 1 >= chain.size())
        detail::throw_invalid(
            "clamped",
            "link must be from 0 to " + std::to_string(chain.size() - 2) + ", the next to highest",
            link);
    auto links = detail::links_of(chain);
    const auto at = static_cast<std::size_t>(link);
    const Link<T> lower = links[at], upper = links[at + 1];
    using S = Wide<T>;
    const T length = lower.length + upper.length;
    const S ratio = detail::in_lengths<T>(lower.length, length);
    const S upper_ratio = detail::in_lengths<T>(upper.length, length);
    const detail::Body<T> above{upper.weight, detail::in_lengths<T>(upper.centroid, length),
                                upper.gyration_ratio * (upper_ratio * upper_ratio)};
    const detail::Body<T> below{lower.weight,
                                upper_ratio + detail::in_lengths<T>(lower.centroid, length),
                                lower.gyration_ratio * (ratio * ratio)};
    links[at + 1] = detail::joined<T>(length, above, below);
    links.erase(links.begin() + link);
    return Chain<T>(links);
}

}  // namespace revchain
