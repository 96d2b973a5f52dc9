// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <map>

#include "revchain/linalg/bisection.hpp"
#include "revchain/linalg/spectrum_samples.hpp"

namespace revchain::linalg::spectrum {

/// The eigenvalues mu number first ... last - 1 (from 0, ascending) lie in [lower, upper), by counts in double.
struct Window {
    double lower = 0, upper = 0;
    Index first = 0, last = 0;

    Index size() const { return last - first; }
};

/// Cuts the spectrum from eigenvalue `first` to `last` (mu = 1/lambda, ascending) into windows of at most `most`
/// eigenvalues each, by counts. Windows end at the ends of the range only where other eigenvalues are cut off, so the
/// first and the last may hold more than was asked. Ascending. Cost: about 2 (last - first)/most counts.
inline std::vector<Window> windows(const PinnedChain& chain, Index first, Index last, Index most) {
    const Index piece = std::max<Index>(most / 5, 1);  // merged at the end: windows are then nearly full
    // all of them: mu from 0 up, by powers of 4 until the count suffices
    double upper = 1;
    Window whole{0, 0, 0, 0};
    for (bool found = false; !found && upper < 0x1p900;) {
        std::vector<double> shifts(sample_lanes);
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
        if (!found) continue;
    }
    std::vector<Window> work{whole}, done;
    std::vector<double> shifts;
    while (!work.empty()) {
        std::vector<std::size_t> pieces;
        shifts.clear();
        for (const Window& w : work) {
            const std::size_t cuts =
                static_cast<std::size_t>(std::clamp<Index>((w.size() + piece - 1) / piece - 1, 1, 31));
            pieces.push_back(cuts);
            const bool wide = w.upper > 4 * w.lower && w.lower > 0;
            for (std::size_t c = 1; c <= cuts; ++c) {
                const double share = static_cast<double>(c) / static_cast<double>(cuts + 1);
                shifts.push_back(wide ? w.lower * std::pow(w.upper / w.lower, share)
                                      : w.lower + (w.upper - w.lower) * share);
            }
        }
        const auto counted = sample_all(chain, shifts);
        std::vector<Window> next;
        std::size_t at = 0;
        for (std::size_t i = 0; i < work.size(); ++i) {
            Window rest = work[i];
            const auto keep = [&](const Window& w) {
                if (w.last <= std::max(first, w.first) || w.first >= last) return;
                const bool wide = w.upper > 4 * w.lower;
                const bool divisible = w.upper - w.lower > 0x1p-40 * w.upper;
                ((w.size() > piece || wide) && divisible ? next : done).push_back(w);
            };
            for (std::size_t c = 0; c < pieces[i]; ++c, ++at) {
                // counts may waver within a few ulp: clamped, no eigenvalue is lost
                const Index below = std::clamp(counted[at].below, rest.first, rest.last);
                keep({rest.lower, shifts[at], rest.first, below});
                rest.lower = shifts[at], rest.first = below;
            }
            keep(rest);
        }
        work = std::move(next);
    }
    std::sort(done.begin(), done.end(), [](const Window& a, const Window& b) { return a.first < b.first; });
    std::vector<Window> merged;
    for (const Window& w : done) {
        Window* last_one = merged.empty() ? nullptr : &merged.back();
        if (last_one != nullptr && last_one->last == w.first && w.last - last_one->first <= most &&
            w.upper <= 4 * last_one->lower)
            last_one->upper = w.upper, last_one->last = w.last;
        else
            merged.push_back(w);
    }
    return merged;
}

/// A polynomial on [-1, 1] by its Chebyshev coefficients.
class Chebyshev {
   public:
    /// From values at node(i), whose number is a multiple of `width`.
    explicit Chebyshev(const std::vector<double>& values) : coefficient_(values.size()) {
        const std::size_t n = values.size();
        std::vector<Pack> twice(n / width), now(n / width), before(n / width);  // value times T_k, T_{k-1}
        for (std::size_t i = 0; i < n; ++i) {
            const double x = node(i, n);
            twice[i / width][i % width] = 2 * x;
            now[i / width][i % width] = values[i];
            before[i / width][i % width] = x * values[i];
        }
        for (std::size_t k = 0; k < n; ++k) {
            Pack sum{};
            for (std::size_t p = 0; p < n / width; ++p) {
                sum += now[p];
                const Pack next = twice[p] * now[p] - before[p];
                before[p] = now[p], now[p] = next;
            }
            double total = 0;
            for (std::size_t i = 0; i < width; ++i) total += sum[i];
            coefficient_[k] = total * (k == 0 ? 1.0 : 2.0) / static_cast<double>(n);
        }
    }
    static double node(std::size_t i, std::size_t n) {
        return std::cos((static_cast<double>(i) + 0.5) * M_PI / static_cast<double>(n));
    }
    /// Value and derivative (Clenshaw).
    void at(Pack x, Pack& value, Pack& slope) const {
        const Pack twice = x + x;
        Pack b1{}, b2{}, d1{}, d2{};
        for (std::size_t k = coefficient_.size(); k-- > 1;) {
            const Pack d = twice * d1 - d2 + 2.0 * b1;
            d2 = d1, d1 = d;
            const Pack b = twice * b1 - b2 + coefficient_[k];
            b2 = b1, b1 = b;
        }
        value = x * b1 - b2 + coefficient_[0];
        slope = b1 + x * d1 - d2;
    }
    Pack at(Pack x) const {
        const Pack twice = x + x;
        Pack b1{}, b2{};
        for (std::size_t k = coefficient_.size(); k-- > 1;) {
            const Pack b = twice * b1 - b2 + coefficient_[k];
            b2 = b1, b1 = b;
        }
        return x * b1 - b2 + coefficient_[0];
    }

    const std::vector<double>& coefficients() const { return coefficient_; }

   private:
    std::vector<double> coefficient_;
};

/// Zeros between `low` and `high`, where `p` has different signs: Newton's steps, halves where they leave the bracket.
inline std::vector<double> refined(const Chebyshev& p, const std::vector<double>& low,
                                   const std::vector<double>& high) {
    std::vector<double> root(low.size());
    for (std::size_t begin = 0; begin < low.size(); begin += width) {
        Pack a{}, b{}, value, slope;
        for (std::size_t j = 0; j < width; ++j) {
            const std::size_t i = std::min(begin + j, low.size() - 1);
            a[j] = low[i], b[j] = high[i];
        }
        const Pack left = p.at(a), right = p.at(b);
        Pack at = a + (b - a) * (left / (left - right));
        for (int step = 0; step < 60; ++step) {
            p.at(at, value, slope);
            const Mask same = ~((value < 0.0) ^ (left < 0.0));
            a = same ? at : a;
            b = same ? b : at;
            const Pack newton = at - value / slope;
            const Pack next = (newton >= a) & (newton <= b) ? newton : 0.5 * (a + b);
            const Pack change = magnitude(next - at);
            at = next;
            if (!any(change > 1e-9)) break;  // the next would be its square
        }
        for (std::size_t j = 0; j < width && begin + j < low.size(); ++j) root[begin + j] = at[j];
    }
    return root;
}

/// The zeros of `p` besides `known` in (a, b), where |q|, q = p/product of (x - known), has a least value: a pair.
inline void find_pair(const Chebyshev& p, double a, double b, std::vector<double>& known) {
    const std::size_t count = known.size();
    struct Point {
        bool negative;
        double slope;  // q'/q
    };
    const auto at = [&](double x) {
        Pack value, derivative;
        p.at(filled(x), value, derivative);
        bool negative = value[0] < 0;
        double slope = derivative[0] / value[0];
        for (std::size_t i = 0; i < count; ++i) negative ^= x < known[i], slope -= 1 / (x - known[i]);
        return Point{negative, slope};
    };
    const Point left = at(a), right = at(b);
    if (left.negative != right.negative || !(left.slope < 0) || !(right.slope > 0)) return;
    double low = a, high = b;
    for (int step = 0; step < 50; ++step) {
        const double middle = low + (high - low) / 2;
        const Point q = at(middle);
        if (q.negative == left.negative) {
            (q.slope < 0 ? low : high) = middle;
            continue;
        }
        for (const double end : {a, b}) {
            double same = end, other = middle, x = (end + middle) / 2;
            for (int newton = 0; newton < 60; ++newton) {
                const Point here = at(x);
                (here.negative == left.negative ? same : other) = x;
                double next = x - 1 / here.slope;
                if (!(next > std::min(same, other) && next < std::max(same, other))) next = (same + other) / 2;
                const double change = std::abs(next - x);
                x = next;
                if (change < 1e-13) break;
            }
            known.push_back(x);
        }
        return;
    }
}

/// All zeros of the polynomial on [-1, 1] if there are `count` of them, ascending; else what was found.
inline std::vector<double> zeros(const Chebyshev& p, Index count) {
    const std::size_t points = (static_cast<std::size_t>(8 * count + 8) + width - 1) / width * width;
    std::vector<double> x(points), f(points), low, high;
    for (std::size_t i = 0; i < points; i += width) {
        Pack at{};
        for (std::size_t j = 0; j < width; ++j)
            at[j] = x[i + j] = -std::cos(static_cast<double>(i + j) * M_PI / static_cast<double>(points - 1));
        const Pack value = p.at(at);
        for (std::size_t j = 0; j < width; ++j) f[i + j] = value[j];
    }
    for (std::size_t i = 1; i < points; ++i)
        if ((f[i - 1] < 0) != (f[i] < 0)) low.push_back(x[i - 1]), high.push_back(x[i]);
    std::vector<double> root = refined(p, low, high);
    for (std::size_t before = points; before != root.size() && static_cast<Index>(root.size()) < count;) {
        before = root.size();
        for (std::size_t i = 0; i < points; i += width) {  // the logarithmic slope, without the zeros known
            Pack at, value, slope;
            for (std::size_t j = 0; j < width; ++j) at[j] = x[i + j];
            p.at(at, value, slope);
            slope = slope / value;
            for (const double known : root) slope -= 1.0 / (at - known);
            for (std::size_t j = 0; j < width; ++j) f[i + j] = slope[j];
        }
        for (std::size_t i = 1; i < points && static_cast<Index>(root.size()) < count; ++i)
            if (f[i - 1] < 0 && f[i] > 0) find_pair(p, x[i - 1], x[i], root);
    }
    std::sort(root.begin(), root.end());
    return root;
}

/// Nodes for a window: a sine with as many zeros needs pi/2 each and a margin that grows with the cube root.
inline std::size_t node_count(Index modes) {
    const double c = 1.65 * static_cast<double>(modes);
    return (static_cast<std::size_t>(c + 8 * std::cbrt(c)) + 8 + width - 1) / width * width;
}

/// Approximate eigenvalues of a window from samples of the characteristic polynomial at its Chebyshev nodes, ascending:
/// the zeros of the interpolant of f exp(-trend), where the trend, quadratic in the shift, takes the exponential growth
/// out of f and leaves its zeros where they are. Empty where their number is not that of the counts, or where one is
/// less certain than 1/1000 of its distance to the next: then `sure` windows have to be smaller.
inline std::vector<double> interpolated(const Window& window, const Sample* samples, std::size_t n, bool sure) {
    std::vector<double> values(n), nodes(n);
    std::vector<int> exponents(n);
    double t0 = 0, t1 = 0, t2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
        values[i] = std::frexp(samples[i].value, &exponents[i]);
        exponents[i] += samples[i].exponent;
        const double size = std::log2(std::abs(values[i]) + 1e-30) + exponents[i], x = nodes[i] = Chebyshev::node(i, n);
        t0 += size, t1 += size * x, t2 += size * (2 * x * x - 1);
    }
    const double count = static_cast<double>(n);
    const int level = static_cast<int>(t0 / count);
    t1 *= 2 / count, t2 *= 2 / count;
    for (std::size_t i = 0; i < n; ++i)  // the large exponents cancel before anything is rounded
        values[i] *= std::exp2((exponents[i] - level) - (t1 * nodes[i] + t2 * (2 * nodes[i] * nodes[i] - 1)));
    const Chebyshev p(values);
    std::vector<double> roots = zeros(p, window.size());
    if (static_cast<Index>(roots.size()) != window.size()) return {};
    if (sure) {
        double noise = 0;
        for (const double c : p.coefficients()) noise = std::max(noise, 1e-14 * std::abs(c));
        for (std::size_t k = n - 4; k < n; ++k) noise = std::max(noise, std::abs(p.coefficients()[k]));
        for (std::size_t i = 0; i < roots.size(); i += width) {
            Pack at{}, value, slope;
            for (std::size_t j = 0; j < width; ++j) at[j] = roots[std::min(i + j, roots.size() - 1)];
            p.at(at, value, slope);
            for (std::size_t j = 0; j < width && i + j < roots.size(); ++j) {
                const double below = i + j > 0 ? roots[i + j] - roots[i + j - 1] : 1.0;
                const double above = i + j + 1 < roots.size() ? roots[i + j + 1] - roots[i + j] : 1.0;
                if (!(noise < 1e-3 * std::min(below, above) * std::abs(slope[j]))) return {};
            }
        }
    }
    for (double& x : roots) x = window.lower + (window.upper - window.lower) * 0.5 * (1 + x);
    return roots;
}

/// Cuts a window in four by counts.
inline std::vector<Window> quartered(const PinnedChain& chain, const std::vector<Window>& windows) {
    std::vector<double> shifts;
    for (const Window& w : windows)
        for (int i = 1; i < 4; ++i) shifts.push_back(w.lower + (w.upper - w.lower) * (0.25 * i + 0.01));
    const auto counts = sample_all(chain, shifts);
    std::vector<Window> result;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        Window rest = windows[i];
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            const Index below = std::clamp(counts[c].below, rest.first, rest.last);
            if (below > rest.first) result.push_back({rest.lower, shifts[c], rest.first, below});
            rest.lower = shifts[c], rest.first = below;
        }
        if (rest.size() > 0) result.push_back(rest);
    }
    return result;
}

/// Approximate shifts of the eigenvalues `first` ... `last - 1` and those that share their windows, into
/// `candidates[.].shift`, ascending, and the links below where they live into `.place`. Windows whose interpolant has not as many zeros as counts say are cut up; false if
/// that does not end.
template <class Candidate>
bool isolate(const PinnedChain& chain, Index first, Index last, std::vector<Window>& found,
             std::vector<Candidate>& candidates) {
    found = windows(chain, first, last, 48);
    if (found.empty() || found.front().first > first || found.back().last < last) return false;
    const Index begin = found.front().first;
    candidates.assign(static_cast<std::size_t>(found.back().last - begin), {});
    std::vector<Window> work = found;
    for (int round = 0; round < 12 && !work.empty(); ++round) {
        if (round > 0) work = quartered(chain, work);
        std::vector<double> shifts;
        for (const Window& w : work) {
            const std::size_t n = node_count(w.size());
            for (std::size_t i = 0; i < n; ++i)
                shifts.push_back(w.lower + (w.upper - w.lower) * 0.5 * (1 + Chebyshev::node(i, n)));
        }
        std::vector<std::uint64_t> history;
        const auto samples = sample_all(chain, shifts, &history);
        const std::size_t words = history_words(chain.size());
        std::vector<Window> failed;
        struct Neighbours {
            std::size_t number, below, above;  // of the candidate, and of samples with no other zero between
        };
        std::vector<Neighbours> placed;
        std::vector<double> between_roots;
        std::size_t at = 0;
        for (const Window& w : work) {
            const std::size_t n = node_count(w.size());
            const auto roots = interpolated(w, &samples[at], n, round < 3);
            if (static_cast<Index>(roots.size()) != w.size()) {
                failed.push_back(w);
            } else {
                std::size_t cell = n - 1;  // nodes descend
                for (std::size_t i = 0; i < roots.size(); ++i) {
                    const std::size_t before = cell;
                    while (cell > 1 && shifts[at + cell - 1] < roots[i]) --cell;
                    const std::size_t number = static_cast<std::size_t>(w.first - begin) + i;
                    candidates[number].shift = roots[i];
                    Neighbours around{number, at + cell, at + cell - 1};
                    if (i > 0 && before == cell) {  // two between the same nodes: another sample between them
                        placed.back().above = around.below = samples.size() + between_roots.size();
                        between_roots.push_back(roots[i - 1] + 0.5 * (roots[i] - roots[i - 1]));
                    }
                    placed.push_back(around);
                }
            }
            at += n;
        }
        std::vector<std::uint64_t> more;
        sample_all(chain, between_roots, &more);
        history.resize(samples.size() * words);
        history.insert(history.end(), more.begin(), more.end());
        for (const Neighbours& i : placed)
            candidates[i.number].place = place(&history[i.below * words], &history[i.above * words], chain.size());
        work = std::move(failed);
    }
    // What is left has a bracket too narrow for the interpolant to tell its zeros apart: counts will have to.
    for (const Window& w : work)
        for (Index j = w.first; j < w.last; ++j)
            candidates[static_cast<std::size_t>(j - begin)].shift = w.lower + (w.upper - w.lower) / 2;
    return true;
}

}  // namespace revchain::linalg::spectrum
