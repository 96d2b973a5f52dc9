// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/spectrum/chebyshev.hpp"
#include "revchain/pencil/spectrum/samples.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// A range of shifts mu = 1/lambda. By count, the eigenvalues number `first` ... `last - 1` (from
/// 0, with mu ascending, so with the conical height lambda descending) lie in [lower, upper).
struct Window {
    double lower = 0, upper = 0;
    Index first = 0, last = 0;

    Index size() const { return last - first; }
};

/// Cuts each window at n = `cuts(window)` shifts `at(window, i, n)`, i = 1 ... n ascending. Omits
/// pieces without eigenvalues.
template <class Cuts, class At>
std::vector<Window> cut(const LumpedChain& chain, const std::vector<Window>& windows,
                        const Cuts& cuts, const At& at) {
    std::vector<double> shifts;
    for (const Window& w : windows)
        for (int c = 1; c <= cuts(w); ++c) shifts.push_back(at(w, c, cuts(w)));
    const auto counted = sample_all(chain, shifts);
    std::vector<Window> pieces;
    std::size_t next = 0;
    for (const Window& w : windows) {
        Window rest = w;
        for (int c = 1; c <= cuts(w); ++c, ++next) {
            // Rounding may shift counts within a few ulp. Clamping prevents the loss of
            // eigenvalues.
            const Index below = std::clamp(counted[next].below, rest.first, rest.last);
            if (below > rest.first) pieces.push_back({rest.lower, shifts[next], rest.first, below});
            rest.lower = shifts[next], rest.first = below;
        }
        if (rest.size() > 0) pieces.push_back(rest);
    }
    return pieces;
}

/// Returns windows of at most `most` eigenvalues that together hold the eigenvalues `first` ...
/// `last - 1`, by counts. The windows at the two ends may also hold eigenvalues outside of this
/// range. A window has more than `most` if it is too narrow to be cut. Cost: about
/// 2 (last - first)/most counts.
inline std::vector<Window> windows(const LumpedChain& chain, Index first, Index last, Index most) {
    const Index piece = std::max<Index>(most / 5, 1);  // pieces are merged at the end
    // The whole range: mu grows by powers of 4 until the count suffices. It does not start at 1: at
    // round numbers the lower part of a chain of equal links may have an eigenvalue, and then the
    // count is not certain.
    double upper = 1 + 0x1.b7p-7;
    Window whole{0, 0, 0, 0};
    for (bool found = false; !found && upper < 0x1p900;) {
        std::vector<double> shifts(24);
        for (double& s : shifts) s = upper, upper *= 4;
        const auto counted = sample_all(chain, shifts);
        for (std::size_t i = 0; i < shifts.size() && !found; ++i) {
            if (counted[i].below >= last) {
                whole.upper = shifts[i], whole.last = counted[i].below;
                found = true;
            } else if (counted[i].below <= first && counted[i].below >= whole.first) {
                whole.lower = shifts[i], whole.first = counted[i].below;
            }
        }
    }
    const auto spans_factor_4 = [](const Window& w) { return w.upper > 4 * w.lower; };
    const auto cuts = [&](const Window& w) {
        return static_cast<int>(std::clamp<Index>((w.size() + piece - 1) / piece - 1, 1, 31));
    };
    const auto at = [&](const Window& w, int number, int of) {
        const double share = number / static_cast<double>(of + 1);
        const bool in_ratio = spans_factor_4(w) && w.lower > 0;
        return in_ratio ? w.lower * std::pow(w.upper / w.lower, share)
                        : w.lower + (w.upper - w.lower) * share;
    };
    std::vector<Window> work{whole}, done;
    while (!work.empty()) {
        std::vector<Window> next;
        for (const Window& w : cut(chain, work, cuts, at)) {
            if (w.last <= first || w.first >= last) continue;
            const bool divisible = w.upper - w.lower > 0x1p-40 * w.upper;
            ((w.size() > piece || spans_factor_4(w)) && divisible ? next : done).push_back(w);
        }
        work = std::move(next);
    }
    std::sort(done.begin(), done.end(),
              [](const Window& a, const Window& b) { return a.first < b.first; });
    std::vector<Window> merged;
    for (const Window& w : done) {
        Window* before = merged.empty() ? nullptr : &merged.back();
        if (before != nullptr && before->last == w.first && w.last - before->first <= most &&
            w.upper <= 4 * before->lower)
            before->upper = w.upper, before->last = w.last;
        else
            merged.push_back(w);
    }
    return merged;
}

/// Returns the number of nodes at which a window with that number of modes is sampled, a multiple
/// of 8. Interpolation of a sine needs pi/2 nodes for each zero. Here it is 1.65, and a margin that
/// grows as the cube root.
inline std::size_t node_count(Index modes) {
    const double c = 1.65 * static_cast<double>(modes);
    return (static_cast<std::size_t>(c + 8 * std::cbrt(c)) + 8 + 7) / 8 * 8;
}

/// Returns approximate eigenvalues of a window, ascending, from samples of the characteristic
/// polynomial f at its Chebyshev nodes. They are zeros of the interpolant of f exp(-trend); the
/// trend, quadratic in the shift, removes the exponential growth of f. The result is empty if their
/// number differs from the counts or, with `sure`, if one is less certain than 1/1000 of its
/// distance to the next.
inline std::vector<double> interpolated(const Window& window, const Sample* samples, std::size_t n,
                                        bool sure) {
    std::vector<double> values(n), nodes(n);
    std::vector<int> exponents(n);
    double t0 = 0, t1 = 0, t2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
        values[i] = std::frexp(samples[i].value, &exponents[i]);
        exponents[i] += samples[i].exponent;
        const double x = nodes[i] = Chebyshev::node(i, n);
        const double size = std::log2(std::abs(values[i]) + 1e-30) + exponents[i];
        t0 += size, t1 += size * x, t2 += size * (2 * x * x - 1);
    }
    const double count = static_cast<double>(n);
    const int level = static_cast<int>(t0 / count);
    t1 *= 2 / count, t2 *= 2 / count;
    for (std::size_t i = 0; i < n; ++i)  // large exponents cancel before any rounding
        values[i] *= std::exp2((exponents[i] - level) -
                               (t1 * nodes[i] + t2 * (2 * nodes[i] * nodes[i] - 1)));
    std::vector<double> roots;
    simd([&](auto registers) REVCHAIN_INLINED {
        // The lanes fill the latency of one fused multiply-add and fit in registers.
        using V = Pack<double, registers.doubles, registers.bytes / 16>;
        const Chebyshev p = interpolant<V>(values);
        roots = zeros<V>(p, window.size());
        if (sure && !certain<V>(p, roots)) roots.clear();
    });
    if (static_cast<Index>(roots.size()) != window.size()) return {};
    for (double& x : roots) x = window.lower + (window.upper - window.lower) * 0.5 * (1 + x);
    return roots;
}

/// Finds approximate shifts of the eigenvalues `first` ... `last - 1`, and of all others in their
/// windows. Fills `found` with the windows and `candidates`, ascending, with a shift and a place
/// (see the function `place`) for each eigenvalue. Windows whose interpolant has too few or too
/// many zeros are cut. Returns false if the windows do not cover the range.
template <class Candidate>
bool isolate_eigenvalues(const LumpedChain& chain, Index first, Index last,
                         std::vector<Window>& found, std::vector<Candidate>& candidates) {
    found = windows(chain, first, last, 48);
    if (found.empty() || found.front().first > first || found.back().last < last) return false;
    const Index begin = found.front().first;
    candidates.assign(static_cast<std::size_t>(found.back().last - begin), {});
    std::vector<Window> work = found;
    // 1 % beside the quarters: at round fractions a count is more likely to hit an eigenvalue
    const auto quarter = [](const Window& w, int number, int) {
        return w.lower + (w.upper - w.lower) * (0.25 * number + 0.01);
    };
    for (int round = 0; round < 12 && !work.empty(); ++round) {
        if (round > 0)
            work = cut(
                chain, work, [](const Window&) { return 3; }, quarter);
        std::vector<double> shifts;
        std::vector<std::size_t> starts;
        for (const Window& w : work) {
            const std::size_t n = node_count(w.size());
            starts.push_back(shifts.size());
            for (std::size_t i = 0; i < n; ++i)
                shifts.push_back(w.lower + (w.upper - w.lower) * 0.5 * (1 + Chebyshev::node(i, n)));
        }
        std::vector<std::uint64_t> history;
        const auto samples = sample_all(chain, shifts, &history);
        const std::size_t words = history_words(chain.size());
        std::vector<Window> failed;
        struct Neighbours {
            std::size_t number, below, above;  // of the candidate and the samples beside it
        };
        std::vector<Neighbours> placed;
        std::vector<double> between_roots;
        std::vector<std::vector<double>> roots_of(work.size());
        revchain::detail::parallel_for(work.size(), 1, [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k)
                roots_of[k] = interpolated(work[k], &samples[starts[k]], node_count(work[k].size()),
                                           round < 3);
        });
        for (std::size_t k = 0; k < work.size(); ++k) {
            const Window& w = work[k];
            const std::vector<double>& roots = roots_of[k];
            const std::size_t at = starts[k];
            if (static_cast<Index>(roots.size()) != w.size()) {
                failed.push_back(w);
                continue;
            }
            std::size_t cell = node_count(w.size()) - 1;  // nodes descend
            for (std::size_t i = 0; i < roots.size(); ++i) {
                const std::size_t before = cell;
                while (cell > 1 && shifts[at + cell - 1] < roots[i]) --cell;
                const std::size_t number = static_cast<std::size_t>(w.first - begin) + i;
                candidates[number].shift = roots[i];
                Neighbours around{number, at + cell, at + cell - 1};
                if (i > 0 && before == cell) {  // two roots between nodes: a sample between them
                    placed.back().above = around.below = samples.size() + between_roots.size();
                    between_roots.push_back(roots[i - 1] + 0.5 * (roots[i] - roots[i - 1]));
                }
                placed.push_back(around);
            }
        }
        std::vector<std::uint64_t> more;
        sample_all(chain, between_roots, &more);
        history.resize(samples.size() * words);
        history.insert(history.end(), more.begin(), more.end());
        for (const Neighbours& i : placed)
            candidates[i.number].place =
                place(&history[i.below * words], &history[i.above * words], chain.size());
        work = std::move(failed);
    }
    // The remaining windows are too narrow for the interpolant: counts must separate their zeros.
    for (const Window& w : work)
        for (Index j = w.first; j < w.last; ++j)
            candidates[static_cast<std::size_t>(j - begin)].shift =
                w.lower + (w.upper - w.lower) / 2;
    return true;
}

}  // namespace revchain::pencil::spectrum
