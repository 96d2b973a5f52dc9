// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>
#include <vector>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Columns of the links of a tapered chain, for `Chain`, lowest first.
template <Real T>
struct TaperedLinks {
    std::vector<T> weight, centroid;
    std::vector<Wide<T>> gyration_ratio;
};

/// Returns true if `term` is too small to matter in `sum`.
template <class S>
bool is_lost(const S& term, const S& sum) {
    using std::abs;
    return static_cast<Narrow<S>>(abs(term)) <=
           operation_error<S>() / 4 * static_cast<Narrow<S>>(abs(sum));
}

/// Returns e^-x - 1 and e^-x for x >= 0. Taylor's series of x/2^n is followed by n doublings. They
/// keep the relative error of the first number and multiply that of the second by 2^n.
template <class S>
std::pair<S, S> decay(S x) {
    using std::ldexp;
    int doublings = 0;
    for (; x > S(0.25); ++doublings) x = ldexp(x, -1);
    S term = -x, fall = term;
    for (double n = 2; n < 40 && !is_lost(term, fall); ++n)
        fall = fall + (term = -(term * x) / S(n));
    S rest = S(1) + fall;
    for (; doublings > 0; --doublings) fall = fall * (S(2) + fall), rest = rest * rest;
    return {fall, rest};
}

/// Returns the mean and variance of t for the density (1 + u t)^exponent over -1 < t < 1, 0 < u <=
/// 1/3, by the binomial series. All even terms that matter have one sign, and so have all odd ones.
template <class S>
std::pair<S, S> mean_and_variance(double exponent, const S& u) {
    S term(1), whole(2), first(0), second = S(2) / S(3);
    for (int n = 1; n < 4000 && !(is_lost(term, whole) && 2 * n > exponent); ++n) {
        const double place = n;
        term = term * ((S(exponent) - S(place - 1)) / S(place) * u);
        if (n % 2 == 0) {
            whole = whole + term * S(2) / S(place + 1);
            second = second + term * S(2) / S(place + 3);
        } else {
            first = first + term * S(2) / S(place + 2);
        }
    }
    const S mean = first / whole;
    return {mean, second / whole - mean * mean};
}

/// Cuts a cord with line density proportional to x^exponent, x from its free end, into `count`
/// straight links of length `link`. With q = exponent + 1 and u = 1/(2m + 1), each weight below a
/// pin is ((1-u)/(1+u))^q times that below the next higher pin. Weights are computed from the
/// support down, without differences of neighbours.
/// Accuracy: weights and centroids 0.51 ulp, gyration ratios 3e-28, in double up to a million links
/// (tests/cpp/system/tapered.cpp). If `Wide<T>` is T, the weights are off by as many ulps as there
/// are links. Cost: 0.5 to 2 microseconds a link.
template <Real T>
TaperedLinks<T> tapered_links(Index count, const T& link, double exponent, const T& weight) {
    using S = Wide<T>;
    TaperedLinks<T> links;
    const auto n = static_cast<std::size_t>(count);
    links.weight.resize(n), links.centroid.resize(n), links.gyration_ratio.resize(n);
    const S q = S(exponent) + S(1);
    S hung(weight);
    for (std::size_t m = n - 1; m > 0; --m) {
        if (m % 64 == 0) check_interrupt();
        const S u = S(1) / S(2 * static_cast<double>(m) + 1), u2 = u * u;
        S power = u, area = u;  // artanh u
        for (double odd = 3; odd < 200 && !is_lost(power, area); odd += 2)
            area = area + (power = power * u2) / S(odd);
        const auto [fall, rest] = decay<S>(S(2) * q * area);
        const auto [mean, variance] = mean_and_variance<S>(exponent, u);
        links.weight[m] = static_cast<T>(-(hung * fall));
        links.centroid[m] = static_cast<T>(S(link) * (S(1) - mean) / S(2));
        links.gyration_ratio[m] = variance / S(4);
        hung = hung * rest;
    }
    links.weight[0] = static_cast<T>(hung);
    links.centroid[0] = static_cast<T>(S(link) / (q + S(1)));
    links.gyration_ratio[0] = q / ((q + S(1)) * (q + S(1)) * (q + S(2)));
    return links;
}

}  // namespace revchain::detail
