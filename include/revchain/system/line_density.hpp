// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The weight per unit of length of a chain, as piecewise polynomials of the distance s from its
/// free end.
///
/// Method: pieces are halved until a polynomial of degree 12 through Chebyshev points gives the
/// function to its rounding. The two are compared between these points, at the ends, and on a grid
/// of 1021 points over the whole length. A piece narrower than 2^-45 s is not halved. It gets the
/// mean of the function, from the position of a single jump or from 64 values. A jump or a corner
/// costs about fifty pieces. At the free end a piece of 2^-40 of the length holds a power law c
/// s^p.
/// A feature at least 1/1000 of the length wide is always found, and its ends are accurate to
/// rounding. A narrower feature may lie between the grid points and is then not stored.
/// Accuracy: 1e-14 of the largest value on a piece (tests/cpp/finite/cord/continuous_chain.cpp);
/// `error` estimates the error of the integral.
/// Cost: 1200 values of a smooth function, 1500 more for a jump, at most 2 million.
class LineDensity {
   public:
    static constexpr int degree = 12;
    using Coefficients = std::array<double, degree + 1>;  ///< those of powers, the constant first
    static constexpr double rounding = 8e-15;  // below what functions of a dozen operations give
    static constexpr int least_halvings = 2, max_at_tip = 40;
    static constexpr double narrowest = 0x1p-45;  // of pieces, over the distance from the free end
    static constexpr std::size_t max_pieces = 20'000;
    static constexpr int grid = 1021;  // a prime: some of evenly spaced beads lie on the grid
    static constexpr double most_doubt = 1e-6;  // of the total weight

    /// The density between two points, as a polynomial or, at the free end, as a power of s.
    struct Piece {
        double middle, half;
        Coefficients factor;  ///< of powers of (s - middle)/half
        double power =
            0;  ///< if not 0: exponent of a power law, with factor[0] its value at the right end
        double below = 0;  ///< weight of the chain below the piece
        double doubt = 0;  ///< estimated error of the weight of the piece
    };

    /// Throws InvalidArgument if the function or the length is not positive and finite, if the
    /// function is rough at too many points, or if its integral is not known to `most_doubt`.
    LineDensity(const std::function<double(double)>& weight_per_length, double length)
        : length_(length) {
        detail::require_positive("LineDensity", "length", length);
        Given given{weight_per_length, {}, 0};
        for (int i = 0; i < grid; ++i)
            given.on_grid[static_cast<std::size_t>(i)] = given(on_grid(i));
        given.largest = *std::max_element(given.on_grid.begin(), given.on_grid.end());
        divide(given, 0, length, 0);
        std::sort(pieces_.begin(), pieces_.end(),
                  [](const Piece& x, const Piece& y) { return x.middle < y.middle; });
        sum_up();
        const auto worst =
            std::max_element(pieces_.begin(), pieces_.end(),
                             [](const Piece& x, const Piece& y) { return x.doubt < y.doubt; });
        if (!(error(length) <= most_doubt))
            throw_rough("has an integral that cannot be resolved", worst->middle);
    }
    /// Makes a density from the pieces of another one; `below` is computed. Throws InvalidArgument
    /// if the pieces are not contiguous from 0 to `length`, or if the density is not positive and
    /// finite.
    LineDensity(double length, std::vector<Piece> pieces)
        : length_(length), pieces_(std::move(pieces)) {
        detail::require_positive("LineDensity", "length", length);
        check_pieces();
        sum_up();
    }

    double length() const { return length_; }
    double total() const { return total_; }
    /// Estimated relative error of the weight below a point, the largest over points at or above s.
    double error(double s) const {
        double doubt = 0, largest = 0;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            doubt += pieces_[i].doubt;
            const double below = i + 1 < pieces_.size() ? pieces_[i + 1].below : total_;
            if (end(pieces_[i]) >= s * (1 - 1e-9)) largest = std::max(largest, doubt / below);
        }
        return largest;
    }
    double mean() const { return total_ / length_; }
    /// Relative error that the rounded positions of jumps cause in the weight below a point, the
    /// largest over points at or above s.
    double rounding_at_jumps(double s) const {
        double moved = 0, largest = 0;
        for (std::size_t i = 1; i < pieces_.size(); ++i) {
            const double at = end(pieces_[i - 1]);
            const double jump =
                polynomial(pieces_[i].factor, -1) - polynomial(pieces_[i - 1].factor, 1);
            moved += std::abs(jump) * at * epsilon<double>();
            largest = std::max(
                largest, moved / std::max(pieces_[i].below, weight_below(std::min(s, length_))));
        }
        return largest;
    }
    const std::vector<Piece>& pieces() const { return pieces_; }

    /// The end of the piece that contains s; infinity beyond the chain.
    double end_of_piece(double s) const {
        return nudged(s) >= length_ ? std::numeric_limits<double>::infinity() : end(piece_at(s));
    }
    /// Coefficients of the density in powers of the distance from s, on the piece to the right of
    /// s.
    Coefficients about(double s) const {
        if (nudged(s) >= length_) return {mean()};
        const Piece& piece = piece_at(s);
        if (piece.power != 0) return {piece.factor[0] * std::pow(s / end(piece), piece.power)};
        const double t = (s - piece.middle) / piece.half;
        Coefficients c = piece.factor;
        for (std::size_t i = 0; i < degree; ++i)
            for (std::size_t k = degree; k-- > i;) c[k] += t * c[k + 1];
        double scale = 1;
        for (double& x : c) x *= scale, scale /= piece.half;
        return c;
    }
    /// Weight of the chain below s. Beyond its end the chain continues with its mean density.
    double weight_below(double s) const {
        if (nudged(s) >= length_) return total_ + mean() * (s - length_);
        if (s == 0) return 0;
        const Piece& piece = piece_at(s);
        if (piece.power != 0)
            return piece.factor[0] * s / (piece.power + 1) * std::pow(s / end(piece), piece.power);
        // near the free end the weight needs a small relative error
        if (&piece == &pieces_.front()) return polynomial(at_tip_, s) * s;
        return piece.below + weight_within(piece, (s - piece.middle) / piece.half);
    }
    /// The point below which the density is a power of s instead of a polynomial; mostly 0.
    double end_of_power() const { return pieces_.front().power != 0 ? end(pieces_.front()) : 0.0; }
    /// First moment of the chain below s about the free end, divided by s times the weight below s.
    /// The density is taken as a power of s, which is right to first order near the free end.
    double first_moment(double s) const {
        const double power = about(s)[0] * s / weight_below(s) - 1;
        return (power + 1) / (power + 2);
    }

   private:
    void check_pieces() const {
        const double gap = 4 * std::numeric_limits<double>::epsilon() * length_;
        double at = 0;
        for (const Piece& piece : pieces_) {
            const double begin = piece.middle - piece.half;
            if (!(piece.half > 0 && std::abs(begin - at) <= gap))
                detail::throw_invalid(
                    "LineDensity",
                    "a piece must begin where the one before ends, at " + detail::in_digits(at),
                    begin);
            double size = 0;
            for (const double c : piece.factor) size += std::abs(c);
            bool positive = size > 0 && std::isfinite(size);
            if (piece.power != 0)
                positive &= at == 0 && piece.factor[0] > 0 && piece.power > -1 &&
                            std::isfinite(piece.power);
            for (int i = 0; piece.power == 0 && i <= degree; ++i) {
                const double value =
                    polynomial(piece.factor, std::cos(std::numbers::pi * i / degree));
                positive &= value >= -10 * rounding * size;
            }
            at = end(piece);
            if (!positive)
                detail::throw_invalid(
                    "LineDensity", "weight per length must be positive and finite from " +
                                       detail::in_digits(begin) + " to " + detail::in_digits(at));
        }
        if (!(std::abs(at - length_) <= gap))
            detail::throw_invalid("LineDensity",
                                  "the pieces must end at the length " + detail::in_digits(length_),
                                  at);
    }
    void sum_up() {
        if (pieces_.front().power == 0) at_tip_ = about(0);
        for (std::size_t k = 0; k <= degree; ++k) at_tip_[k] /= static_cast<double>(k + 1);
        for (Piece& piece : pieces_) {
            piece.below = total_;
            total_ += piece.power == 0 ? weight_within(piece, 1)
                                       : piece.factor[0] * 2 * piece.half / (piece.power + 1);
        }
    }

    static double end(const Piece& piece) { return piece.middle + piece.half; }
    /// Moves s up a little, so that the end of a piece, even if rounded, belongs to the next piece.
    static double nudged(double s) { return s * (1 + 0x1p-48); }
    const Piece& piece_at(double s) const {
        const auto after =
            std::upper_bound(pieces_.begin(), pieces_.end(), nudged(s),
                             [](double x, const Piece& piece) { return x < end(piece); });
        return after == pieces_.end() ? pieces_.back() : *after;
    }
    static double polynomial(const Coefficients& factor, double t) {
        double sum = 0;
        for (std::size_t k = degree + 1; k-- > 0;) sum = sum * t + factor[k];
        return sum;
    }
    /// Weight of the piece from its left end to t.
    static double weight_within(const Piece& piece, double t) {
        double right = 0, left = 0;
        for (std::size_t k = degree + 1; k-- > 0;) {
            const double c = piece.factor[k] / static_cast<double>(k + 1);
            right = right * t + c;
            left = -left + c;
        }
        return piece.half * (right * t + left);
    }

    /// The checked function and its values on the grid.
    struct Given {
        const std::function<double(double)>& function;
        std::array<double, grid> on_grid;
        double largest;

        double operator()(double s) const {
            const double value = function(s);
            if (!(value > 0 && std::isfinite(value)))
                detail::throw_invalid(
                    "LineDensity",
                    "weight per length must be positive and finite; at " + detail::in_digits(s),
                    value);
            return value;
        }
    };
    double on_grid(int i) const { return length_ * (i + 0.5) / grid; }

    [[noreturn]] static void throw_rough(const std::string& how, double s) {
        detail::throw_invalid("LineDensity",
                              "weight per length " + how +
                                  " (use a chain of many short links instead of a cord); near s",
                              s);
    }

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
                detail::throw_invalid("LineDensity",
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
        const double above = detail::halved(first, last, side).second;
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
            return polynomial(piece.factor, (s - piece.middle) / piece.half) - value;
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

    double length_, total_ = 0;
    std::vector<Piece> pieces_;
    Coefficients at_tip_{};  // those of (weight below s)/s on the lowest piece
};

}  // namespace revchain
