// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "revchain/system/density_pieces.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The weight per unit of length of a chain, as piecewise polynomials of the distance s from its
/// free end, with particles between the pieces.
///
/// Method (`detail::DensityFit`): pieces are halved until a polynomial of degree 12 through Chebyshev
/// points gives the function to its rounding. The two are compared between these points, at the
/// ends, and on a grid of 1021 points over the whole length. A piece narrower than 2^-45 s is not
/// halved. It gets the mean of the function, from the position of a single jump or from 64 values.
/// A jump or a corner costs about fifty pieces. At the free end a piece of 2^-40 of the length holds
/// a power law c s^p.
/// A feature at least 1/1000 of the length wide is always found, and its ends are accurate to
/// rounding. A narrower feature may lie between the grid points and is then not stored, unless its
/// ends are given as `breaks`: pieces end there, and a jump costs nothing.
/// Accuracy: 1e-14 of the largest value on a piece (tests/cpp/finite/cord/continuous_chain.cpp);
/// `error` estimates the error of the integral.
/// Cost: 1200 values of a smooth function, 1500 more for a jump, at most 2 million.
class LineDensity {
   public:
    static constexpr int degree = detail::DensityPiece::degree;
    using Piece = detail::DensityPiece;
    using Coefficients = detail::DensityPiece::Coefficients;
    static constexpr double most_doubt = 1e-6;      // of the total weight
    static constexpr double least_place = 0x1p-20;  // of particles and breaks, over the length

    /// Throws InvalidArgument if the function or the length is not positive and finite, if a break
    /// is not above `least_place` and below the length, if the function is rough at too many
    /// points, or if its integral is not known to `most_doubt`.
    LineDensity(const std::function<double(double)>& weight_per_length, double length,
                std::vector<double> breaks = {})
        : length_(length) {
        detail::require_positive("LineDensity", "length", length);
        for (const double s : breaks) require_inside("breaks", s);
        std::sort(breaks.begin(), breaks.end());
        breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
        breaks.push_back(length);
        pieces_ = detail::DensityFit(weight_per_length, length).pieces(breaks);
        sum_up();
        const auto worst =
            std::max_element(pieces_.begin(), pieces_.end(),
                             [](const Piece& x, const Piece& y) { return x.doubt < y.doubt; });
        if (!(error(length) <= most_doubt))
            detail::DensityFit::throw_rough("has an integral that cannot be resolved",
                                            worst->middle);
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

    /// Returns the density times a factor, with particles at distances from the free end, each
    /// with its weight. Throws InvalidArgument if a weight is negative or not finite, or a place is
    /// not above `least_place` and below the length.
    LineDensity with_particles(double factor, const std::map<double, double>& particles) const {
        std::vector<Piece> pieces = pieces_;
        for (Piece& piece : pieces) {
            piece.doubt *= factor;
            for (double& c : piece.factor) c *= factor;
        }
        for (const auto& [s, weight] : particles) {
            require_inside("weights", s);
            detail::require_not_negative("LineDensity", "weight of a particle", weight);
            auto at = pieces.begin();
            while (at->end() < s * (1 - 0x1p-48)) ++at;
            if (at->end() > s * (1 + 0x1p-48)) at = split(pieces, at, s);
            at->particle += weight;
        }
        return {length_, std::move(pieces)};
    }

    double length() const { return length_; }
    /// Weight, with the particles.
    double total() const { return total_; }
    /// Estimated relative error of the weight below a point, the largest over points at or above s.
    double error(double s) const {
        double doubt = 0, largest = 0;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            doubt += pieces_[i].doubt;
            const double below = i + 1 < pieces_.size() ? hung(pieces_[i + 1]) : total_;
            if (pieces_[i].end() >= s * (1 - 1e-9)) largest = std::max(largest, doubt / below);
        }
        return largest;
    }
    double mean() const { return total_ / length_; }
    /// Relative error that the rounded positions of jumps cause in the weight below a point, the
    /// largest over points at or above s.
    double rounding_at_jumps(double s) const {
        double moved = 0, largest = 0;
        for (std::size_t i = 1; i < pieces_.size(); ++i) {
            const double at = pieces_[i - 1].end();
            const double jump = Piece::polynomial(pieces_[i].factor, -1) -
                                Piece::polynomial(pieces_[i - 1].factor, 1);
            moved += std::abs(jump) * at * epsilon<double>();
            largest = std::max(
                largest, moved / std::max(hung(pieces_[i]), weight_below(std::min(s, length_))));
        }
        return largest;
    }
    const std::vector<Piece>& pieces() const { return pieces_; }

    /// The end of the piece that contains s; infinity beyond the chain.
    double end_of_piece(double s) const {
        return nudged(s) >= length_ ? std::numeric_limits<double>::infinity() : piece_at(s).end();
    }
    /// Coefficients of the density in powers of the distance from s, on the piece to the right of
    /// s.
    Coefficients about(double s) const {
        if (nudged(s) >= length_) return {mean()};
        const Piece& piece = piece_at(s);
        if (piece.power != 0) return {piece.factor[0] * std::pow(s / piece.end(), piece.power)};
        const double t = (s - piece.middle) / piece.half;
        Coefficients c = piece.factor;
        shift_to(c, t);
        double scale = 1;
        for (double& x : c) x *= scale, scale /= piece.half;
        return c;
    }
    /// Weight of the chain below s, with the particle at s. Beyond its end the chain continues with
    /// its mean density.
    double weight_below(double s) const { return cord_below(s) + particles_below(s); }
    /// Weight of the particles at or below s.
    double particles_below(double s) const {
        return s == 0                 ? 0.0
               : nudged(s) >= length_ ? pieces_.back().particles_below
                                      : piece_at(s).particles_below;
    }
    /// Weight of the particles above one place, at or below another: without the rounding of those
    /// below both.
    double particles_between(double from, double to) const {
        double sum = 0;
        if (nudged(from) >= length_) return sum;
        for (const Piece* piece = &piece_at(from);
             piece <= &pieces_.back() && piece->end() <= nudged(to); ++piece)
            sum += piece->particle;
        return sum;
    }
    /// Weight of the chain below s without its particles.
    double cord_below(double s) const {
        if (nudged(s) >= length_)
            return total_ - pieces_.back().particles_below + mean() * (s - length_);
        if (s == 0) return 0;
        const Piece& piece = piece_at(s);
        if (piece.power != 0)
            return piece.factor[0] * s / (piece.power + 1) * std::pow(s / piece.end(), piece.power);
        // near the free end the weight needs a small relative error
        if (&piece == &pieces_.front()) return Piece::polynomial(at_tip_, s) * s;
        return piece.below + weight_within(piece, (s - piece.middle) / piece.half);
    }
    /// The point below which the density is a power of s instead of a polynomial; mostly 0.
    double end_of_power() const { return pieces_.front().power != 0 ? pieces_.front().end() : 0.0; }
    /// First moment of the chain below s about the free end, divided by s times the weight below s,
    /// where no particle is below s. The density is taken as a power of s, which is right to first
    /// order near the free end.
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
            positive &= piece.particle >= 0 && std::isfinite(piece.particle);
            for (int i = 0; piece.power == 0 && i <= degree; ++i) {
                const double value =
                    Piece::polynomial(piece.factor, std::cos(std::numbers::pi * i / degree));
                positive &= value >= -10 * detail::DensityFit::rounding * size;
            }
            at = piece.end();
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
        double particles = 0;
        for (Piece& piece : pieces_) {
            piece.below = total_, piece.particles_below = particles;
            total_ += piece.power == 0 ? weight_within(piece, 1)
                                       : piece.factor[0] * 2 * piece.half / (piece.power + 1);
            particles += piece.particle;
        }
        total_ += particles;
    }
    void require_inside(const std::string& name, double s) const {
        if (!(s >= least_place * length_ && s < length_ * (1 - 0x1p-40)))
            detail::throw_invalid("LineDensity",
                                  name +
                                      " must lie above the free end and below the support, at "
                                      "distances from the free end below the length " +
                                      detail::in_digits(length_) +
                                      " (what is at the free end is its tip)",
                                  s);
    }
    static double hung(const Piece& piece) { return piece.below + piece.particles_below; }
    /// Splits a piece at s and returns its lower part. Both have the same polynomial.
    static std::vector<Piece>::iterator split(std::vector<Piece>& pieces,
                                              std::vector<Piece>::iterator at, double s) {
        const Piece whole = *at;
        const double low = whole.middle - whole.half, high = whole.end();
        const auto part = [&](double from, double to) {
            Piece piece = whole;
            piece.middle = from + (to - from) / 2, piece.half = (to - from) / 2;
            piece.doubt = whole.doubt * piece.half / whole.half, piece.particle = 0;
            // c_k of t = shift + ratio x
            const double shift = (piece.middle - whole.middle) / whole.half;
            shift_to(piece.factor, shift);
            double scale = 1;
            for (double& c : piece.factor) c *= scale, scale *= piece.half / whole.half;
            return piece;
        };
        Piece upper = part(s, high);
        upper.particle = whole.particle;
        *at = part(low, s);
        return pieces.insert(at + 1, upper) - 1;
    }
    /// Turns the coefficients of a polynomial of t into those of the same polynomial of t - from.
    static void shift_to(Coefficients& c, double from) {
        for (std::size_t i = 0; i < degree; ++i)
            for (std::size_t k = degree; k-- > i;) c[k] += from * c[k + 1];
    }

    /// Moves s up a little, so that the end of a piece, even if rounded, belongs to the next piece.
    static double nudged(double s) { return s * (1 + 0x1p-48); }
    const Piece& piece_at(double s) const {
        const auto after =
            std::upper_bound(pieces_.begin(), pieces_.end(), nudged(s),
                             [](double x, const Piece& piece) { return x < piece.end(); });
        return after == pieces_.end() ? pieces_.back() : *after;
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

    double length_, total_ = 0;
    std::vector<Piece> pieces_;
    Coefficients at_tip_{};  // those of (weight below s)/s on the lowest piece
};

}  // namespace revchain
