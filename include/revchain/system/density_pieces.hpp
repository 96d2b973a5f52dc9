// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// The density between two points, as a polynomial or, at the free end, as a power of s, and the
/// particle at the upper point.
struct DensityPiece {
    static constexpr int degree = 12;
    using Coefficients = std::array<double, degree + 1>;  ///< those of powers, the constant first

    double middle, half;
    Coefficients factor;  ///< of powers of (s - middle)/half
    double power =
        0;  ///< if not 0: exponent of a power law, with factor[0] its value at the right end
    double below = 0;     ///< weight of the chain below the piece, without particles
    double doubt = 0;     ///< estimated error of the weight of the piece
    double particle = 0;  ///< weight of the particle at the right end
    double particles_below = 0;

    double end() const { return middle + half; }
    static double polynomial(const Coefficients& factor, double t) {
        double sum = 0;
        for (std::size_t k = degree + 1; k-- > 0;) sum = sum * t + factor[k];
        return sum;
    }
};

/// Finds pieces that give a function to its rounding; the method is described at `LineDensity`.
class DensityFit {
   public:
    using Piece = DensityPiece;
    using Coefficients = DensityPiece::Coefficients;
    static constexpr int degree = DensityPiece::degree;
    static constexpr double rounding = 8e-15;  // below what functions of a dozen operations give
    static constexpr int least_halvings = 2, max_at_tip = 40;
    static constexpr double narrowest = 0x1p-45;  // of pieces, over the distance from the free end
    static constexpr std::size_t max_pieces = 20'000;
    static constexpr int grid = 1021;  // a prime: some of evenly spaced beads lie on the grid

    DensityFit(const std::function<double(double)>& weight_per_length, double length)
        : length_(length), given_{weight_per_length, {}, 0} {
        for (int i = 0; i < grid; ++i)
            given_.on_grid[static_cast<std::size_t>(i)] = given_(on_grid(i));
        given_.largest = *std::max_element(given_.on_grid.begin(), given_.on_grid.end());
    }

    /// Returns the pieces between the free end and places, of which the last is the length.
    std::vector<Piece> pieces(const std::vector<double>& places) {
        double from = 0;
        for (const double to : places) divide(given_, from, to, 0), from = to;
        std::sort(pieces_.begin(), pieces_.end(),
                  [](const Piece& x, const Piece& y) { return x.middle < y.middle; });
        return std::move(pieces_);
    }

    [[noreturn]] static void throw_rough(const std::string& how, double s) {
        throw_invalid("LineDensity",
                      "weight per length " + how +
                          " (use a chain of many short links instead of a cord); near s",
                      s);
    }

   private:
    /// The checked function and its values on the grid.
    struct Given {
        const std::function<double(double)>& function;
        std::array<double, grid> on_grid;
        double largest;

        double operator()(double s) const {
            const double value = function(s);
            if (!(value > 0 && std::isfinite(value)))
                throw_invalid("LineDensity",
                              "weight per length must be positive and finite; at " + in_digits(s),
                              value);
            return value;
        }
    };
    double on_grid(int i) const { return length_ * (i + 0.5) / grid; }

    void divide(const Given& f, double low, double high, int halvings) {
        constexpr std::size_t count = degree + 1;
        Piece piece{low + (high - low) / 2, (high - low) / 2, {}};
        Coefficients sample{}, chebyshev{};
        const auto cosine = [](std::size_t k, std::size_t i) {
            return std::cos(std::numbers::pi * static_cast<double>(k) *
                            (static_cast<double>(i) + 0.5) / count);
        };
        for (std::size_t i = 0; i < count; ++i)
            sample[i] = f(piece.middle + piece.half * cosine(1, i));
        double largest = *std::max_element(sample.begin(), sample.end());
        double least = *std::min_element(sample.begin(), sample.end());
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t i = 0; i < count; ++i) chebyshev[k] += sample[i] * cosine(k, i);
            chebyshev[k] = chebyshev[k] * (k == 0 ? 1.0 : 2.0) / count;
        }
        const auto largest_of = [&](std::size_t from, std::size_t to) {
            double most = 0;
            for (std::size_t k = from; k < to; ++k) most = std::max(most, std::abs(chebyshev[k]));
            return most;
        };
        // error of the function because s is rounded
        const double by_place = epsilon<double>() * high / (high - low) * (largest - least);
        double tolerance = rounding * largest + 2 * by_place;
        const double tail = largest_of(count - 2, count), before = largest_of(count - 6, count - 2);
        // Coefficients that no longer fall are rounding errors of larger terms.
        if (tail > tolerance && tail > 0.03 * before && before <= 8 * epsilon<double>() * f.largest)
            tolerance = std::max(tolerance, 8 * epsilon<double>() * f.largest);
        // At the free end, where little hangs below, the density needs a small relative error.
        bool good =
            halvings >= least_halvings && tail <= tolerance && (low > 0 || least > 0.02 * largest);
        if (good) {
            for (std::size_t k = count;
                 k-- > 1 && std::abs(chebyshev[k]) <= 0.25 * rounding * largest;)
                chebyshev[k] = 0;
            piece.factor = in_powers(chebyshev);
            good = agrees(f, low, high, piece, 10 * rounding * largest, 10 * tolerance);
        }
        const bool smallest = low == 0 ? halvings >= max_at_tip : high - low <= narrowest * high;
        if (!good && !smallest) {
            divide(f, low, piece.middle, halvings + 1);
            divide(f, piece.middle, high, halvings + 1);
            return;
        }
        if (pieces_.size() == max_pieces) throw_rough("is rough at too many places", piece.middle);
        if (low == 0 && !good) {
            piece.factor = {f(high)};
            piece.power = std::log2(f(high) / f(high / 2));
            if (!(piece.power > -1))
                throw_invalid("LineDensity",
                              "the weight near the free end must be finite; weight per "
                              "length goes like s^p, p",
                              piece.power);
            if (piece.power == 0) piece.power = 1e-30;
            const double turned = std::abs(std::log2(f(high / 2) / f(high / 4)) - piece.power),
                         grown = piece.power + 1;
            piece.doubt = 8 * turned * piece.factor[0] * high / (grown * grown);
        } else if (!good && !is_jump(f, low, high, piece)) {
            constexpr int parts = 64;
            double sum = 0;
            for (int i = 0; i < parts; ++i) {
                const double value = f(low + (high - low) * ((i + 0.5) / parts));
                sum += value, largest = std::max(largest, value), least = std::min(least, value);
            }
            piece.factor = {sum / parts};
            piece.doubt = (largest - least) / parts * (high - low);
        }
        pieces_.push_back(piece);
    }

    /// Returns true if the function jumps once within a narrow piece; the piece then gets the exact
    /// mean.
    static bool is_jump(const Given& f, double low, double high, Piece& piece) {
        const double first = std::nextafter(low, high), last = std::nextafter(high, low);
        const double lower = f(first), upper = f(last), jump = std::abs(upper - lower);
        const auto side = [&](double at) { return std::abs(f(at) - lower) < jump / 2 ? -1 : 1; };
        const double above = halved(first, last, side).second;
        for (double at = std::nextafter(low, high); at < high; at += 0x1p-48 * high)
            if (!(std::abs(f(at) - (at < above ? lower : upper)) <= 1e-3 * jump)) return false;
        piece.factor = {(lower * (above - low) + upper * (high - above)) / (high - low)};
        return true;
    }

    /// Returns true if a polynomial gives the function within a tolerance between its Chebyshev
    /// points, at the ends and on the grid. Sets `doubt`, the error of the integral, from the
    /// values between or, if one differs by more than the rounding, from the largest difference.
    bool agrees(const Given& f, double low, double high, Piece& piece, double rounded,
                double tolerance) const {
        const auto off = [&](double s, double value) {
            return Piece::polynomial(piece.factor, (s - piece.middle) / piece.half) - value;
        };
        double most = 0;
        const auto alike = [&](double difference) {
            most = std::max(most, std::abs(difference));
            return std::abs(difference) <= tolerance;
        };
        const double first = std::nextafter(low, high), last = std::nextafter(high, low);
        if (low > 0 && !alike(off(first, f(first)))) return false;
        if (!alike(off(last, f(last)))) return false;
        const int from = std::max(0, static_cast<int>(std::ceil(low / length_ * grid - 0.5)));
        for (int i = from; i < grid && on_grid(i) < high; ++i)
            if (!alike(off(on_grid(i), f.on_grid[static_cast<std::size_t>(i)]))) return false;
        double sum = 0, shares = 0;
        for (std::size_t i = 1; i <= degree; ++i) {
            const double angle = std::numbers::pi * static_cast<double>(i) / (degree + 1);
            const double s = piece.middle + piece.half * std::cos(angle), difference = off(s, f(s));
            if (!alike(difference)) return false;
            sum += std::sin(angle) * difference, shares += std::sin(angle);
        }
        piece.doubt = (most > rounded ? most : std::abs(sum / shares)) * 2 * piece.half;
        return true;
    }

    /// Converts coefficients of Chebyshev polynomials to those of powers; stable, because they
    /// fall.
    static Coefficients in_powers(const Coefficients& chebyshev) {
        Coefficients sum{chebyshev[0]}, before{1}, now{0, 1};
        for (std::size_t k = 1; k <= degree; ++k) {
            Coefficients next{};
            for (std::size_t i = 0; i <= degree; ++i) {
                sum[i] += chebyshev[k] * now[i];
                next[i] = (i > 0 ? 2 * now[i - 1] : 0.0) - before[i];
            }
            before = now, now = next;
        }
        return sum;
    }

    double length_;
    Given given_;
    std::vector<Piece> pieces_;
};

}  // namespace revchain::detail
