// SPDX-License-Identifier: MPL-2.0
// Floating point with 5120 bits and any exponent, for verdicts that no built-in type can give: counts of heights of
// small chains whose weights span the whole range of a scalar. Sums, products, and quotients by one double.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "revchain/chain.hpp"

namespace support {

class BigFloat {
   public:
    BigFloat() = default;
    BigFloat(double x) {  // NOLINT(google-explicit-constructor)
        if (x == 0) return;
        int exponent = 0;
        digits_.back() = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 64));
        exponent_ = exponent;
        sign_ = x < 0 ? -1 : 1;
    }
    int sign() const { return sign_; }

    friend BigFloat operator-(BigFloat x) {
        x.sign_ = -x.sign_;
        return x;
    }
    friend BigFloat operator+(const BigFloat& x, const BigFloat& y) {
        if (x.sign_ == 0) return y;
        if (y.sign_ == 0) return x;
        if (!larger(x, y)) return larger(y, x) || x.sign_ == y.sign_ ? sum(y, x) : BigFloat();
        return sum(x, y);
    }
    friend BigFloat operator-(const BigFloat& x, const BigFloat& y) { return x + (-y); }
    friend BigFloat operator*(const BigFloat& x, const BigFloat& y) {
        BigFloat z;
        if (x.sign_ == 0 || y.sign_ == 0) return z;
        std::array<std::uint64_t, 2 * limbs> product{};
        for (std::size_t i = 0; i < limbs; ++i) {
            if (x.digits_[i] == 0) continue;
            Wide carry = 0;
            for (std::size_t j = 0; j < limbs; ++j) {
                carry += static_cast<Wide>(x.digits_[i]) * y.digits_[j] + product[i + j];
                product[i + j] = static_cast<std::uint64_t>(carry);
                carry >>= 64;
            }
            product[i + limbs] = static_cast<std::uint64_t>(carry);
        }
        std::copy(product.begin() + limbs, product.end(), z.digits_.begin());
        z.sign_ = x.sign_ * y.sign_;
        z.exponent_ = x.exponent_ + y.exponent_;
        if (!(z.digits_.back() >> 63)) z.shift_up(product[limbs - 1] >> 63);
        return z;
    }
    friend BigFloat operator/(const BigFloat& x, double divisor) {
        BigFloat z;
        int exponent = 0;
        const auto d = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(divisor), &exponent), 53));
        Wide rest = 0;
        for (std::size_t i = limbs; i-- > 0;) {
            rest = (rest << 64) | x.digits_[i];
            z.digits_[i] = static_cast<std::uint64_t>(rest / d);
            rest %= d;
        }
        z.exponent_ = x.exponent_ - exponent + 53;
        z.sign_ = divisor < 0 ? -x.sign_ : x.sign_;
        while (z.sign_ != 0 && !(z.digits_.back() >> 63)) z.shift_up(0);
        return z;
    }

   private:
    static constexpr std::size_t limbs = 80;
    __extension__ using Wide = unsigned __int128;

    static bool larger(const BigFloat& x, const BigFloat& y) {  // in size
        if (x.exponent_ != y.exponent_) return x.exponent_ > y.exponent_;
        for (std::size_t i = limbs; i-- > 0;)
            if (x.digits_[i] != y.digits_[i]) return x.digits_[i] > y.digits_[i];
        return false;
    }
    /// x is the larger.
    static BigFloat sum(const BigFloat& x, const BigFloat& y) {
        const std::int64_t apart = x.exponent_ - y.exponent_;
        if (apart >= static_cast<std::int64_t>(64 * limbs)) return x;
        const auto whole = static_cast<std::size_t>(apart / 64), bits = static_cast<std::size_t>(apart % 64);
        BigFloat z = x;
        const bool add = x.sign_ == y.sign_;
        Wide carry = 0;
        for (std::size_t i = 0; i < limbs; ++i) {
            const std::size_t from = i + whole;
            std::uint64_t digit = from < limbs ? y.digits_[from] >> bits : 0;
            if (bits != 0 && from + 1 < limbs) digit |= y.digits_[from + 1] << (64 - bits);
            carry = add ? Wide(x.digits_[i]) + digit + carry : Wide(x.digits_[i]) - digit - carry;
            z.digits_[i] = static_cast<std::uint64_t>(carry);
            carry = (carry >> 64) & 1;
        }
        if (add && carry != 0) {
            for (std::size_t i = 0; i < limbs; ++i)
                z.digits_[i] = (z.digits_[i] >> 1) | ((i + 1 < limbs ? z.digits_[i + 1] : 1) << 63);
            ++z.exponent_;
        }
        while (!add && !(z.digits_.back() >> 63)) z.shift_up(0);
        return z;
    }
    void shift_up(std::uint64_t bit) {
        for (std::size_t i = limbs; i-- > 1;) digits_[i] = (digits_[i] << 1) | (digits_[i - 1] >> 63);
        digits_[0] = (digits_[0] << 1) | bit;
        --exponent_;
    }

    std::array<std::uint64_t, limbs> digits_{};  // lowest first; the leading bit is set
    std::int64_t exponent_ = 0;                  // value = 0.digits 2^exponent
    int sign_ = 0;
};

/// How many conical heights of a chain of doubles exceed height (1 + margin): sign changes among the leading minors of
/// the assembled lambda K - M, without a division but by the lengths.
inline revchain::Index count_in_big_floats(const revchain::Chain<double>& chain, double height, double margin) {
    const BigFloat shift = BigFloat(height) + BigFloat(height) * BigFloat(margin);
    const auto n = static_cast<std::size_t>(chain.size());
    std::vector<BigFloat> diagonal(n + 1), off(n + 1);
    BigFloat below;
    for (std::size_t m = 0; m < n; ++m) {
        const auto link = chain.link(static_cast<revchain::Index>(m));
        const BigFloat W(link.weight), p = BigFloat(link.centroid) / link.length;
        const BigFloat q = (BigFloat(link.length) - BigFloat(link.centroid)) / link.length;
        const BigFloat r = BigFloat(link.gyration_ratio.high) + BigFloat(link.gyration_ratio.low);
        const BigFloat k = shift * ((W * p + below) / link.length);
        below = below + W;
        diagonal[m] = diagonal[m] + k - W * (p * p + r);
        off[m + 1] = -k - W * (p * q - r);
        diagonal[m + 1] = k - W * (q * q + r);
    }
    revchain::Index changes = 0;
    BigFloat before(1.0), minor = diagonal[0];
    int sign = 1;
    for (std::size_t m = 0; m < n; ++m) {
        if (m > 0) {
            const BigFloat next = diagonal[m] * minor - off[m] * off[m] * before;
            before = minor;
            minor = next;
        }
        const int now = minor.sign() == 0 ? sign : minor.sign();
        if (now != sign) ++changes;
        sign = now;
    }
    return changes;
}

}  // namespace support
