// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>
#include <ostream>

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Two doubles as a scalar of 106 bits: `Chain<DoubleDouble>`, `modes`, ... to about 32 digits.
/// DoubleWord<double> is the arithmetic that certifies results in double, with sizes, errors and
/// weights in double (`Narrow`). In a DoubleDouble all of these have two words: its `Wide` and
/// `Narrow` are DoubleDouble, and bounds grow with the number of links. Accuracy of one operation:
/// that of DoubleWord, at most 15 u^2 = 1.9e-31; `epsilon` is 64 u^2 = 7.9e-31. Exponents are those
/// of double. The second word is lost below 1e-292.
class DoubleDouble {
   public:
    constexpr DoubleDouble() = default;
    /// Converts a built-in number, exactly unless it is a long double of more than 106 bits.
    template <class Number>
    requires std::is_arithmetic_v<Number>
    constexpr DoubleDouble(Number x)
        : word_(split(x)) {}  // NOLINT(google-explicit-constructor): like a built-in number
    constexpr explicit DoubleDouble(const DoubleWord<double>& word) : word_(word) {}
    /// Makes high + low, in any order of size.
    constexpr DoubleDouble(double high, double low) : word_(two_sum(high, low)) {}

    constexpr double high() const { return word_.high; }
    constexpr double low() const { return word_.low; }
    constexpr const DoubleWord<double>& word() const { return word_; }
    constexpr explicit operator double() const { return word_.high; }
    constexpr explicit operator float() const { return static_cast<float>(word_.high); }
    constexpr explicit operator long double() const {
        return static_cast<long double>(word_.high) + word_.low;
    }

    friend constexpr DoubleDouble operator-(const DoubleDouble& x) {
        return DoubleDouble(-x.word_);
    }
    friend constexpr DoubleDouble operator+(DoubleDouble x, DoubleDouble y) {
        return DoubleDouble(x.word_ + y.word_);
    }
    friend constexpr DoubleDouble operator-(DoubleDouble x, DoubleDouble y) {
        return DoubleDouble(x.word_ - y.word_);
    }
    friend DoubleDouble operator*(DoubleDouble x, DoubleDouble y) {
        return DoubleDouble(x.word_ * y.word_);
    }
    friend DoubleDouble operator/(DoubleDouble x, DoubleDouble y) {
        return DoubleDouble(x.word_ / y.word_);
    }
    DoubleDouble& operator+=(const DoubleDouble& y) { return *this = *this + y; }
    DoubleDouble& operator-=(const DoubleDouble& y) { return *this = *this - y; }
    DoubleDouble& operator*=(const DoubleDouble& y) { return *this = *this * y; }
    DoubleDouble& operator/=(const DoubleDouble& y) { return *this = *this / y; }

    friend constexpr bool operator==(const DoubleDouble& x, const DoubleDouble& y) = default;
    friend constexpr std::partial_ordering operator<=>(const DoubleDouble& x,
                                                       const DoubleDouble& y) = default;

    friend DoubleDouble abs(const DoubleDouble& x) { return DoubleDouble(abs(x.word_)); }
    friend DoubleDouble sqrt(const DoubleDouble& x) { return DoubleDouble(sqrt(x.word_)); }
    friend DoubleDouble ldexp(const DoubleDouble& x, int exponent) {
        return DoubleDouble(ldexp(x.word_, exponent));
    }
    friend DoubleDouble frexp(const DoubleDouble& x, int* exponent) {
        return DoubleDouble(frexp(x.word_, exponent));
    }
    friend bool isfinite(const DoubleDouble& x) { return isfinite(x.word_); }
    /// Writes the leading double, which is enough for messages.
    friend std::ostream& operator<<(std::ostream& out, const DoubleDouble& x) {
        const std::streamsize asked = out.precision(std::numeric_limits<double>::max_digits10);
        out << x.word_.high;
        out.precision(asked);
        return out;
    }

   private:
    template <class Number>
    static constexpr DoubleWord<double> split(Number x) {
        if constexpr (std::is_integral_v<Number> && sizeof(Number) > 4) {
            const Number low = x % (Number(1) << 32);  // both parts are whole numbers below 2^53
            return two_sum(static_cast<double>(x - low), static_cast<double>(low));
        } else if constexpr (std::is_same_v<Number, long double>) {
            const double high = static_cast<double>(x);
            const bool ordinary = high - high == 0;
            return {high, ordinary ? static_cast<double>(x - static_cast<long double>(high)) : 0.0};
        } else {
            return {static_cast<double>(x)};
        }
    }

    DoubleWord<double> word_;
};

}  // namespace revchain

template <>
struct std::numeric_limits<revchain::DoubleDouble>
    : std::numeric_limits<revchain::DoubleWord<double>> {
    using Word = std::numeric_limits<revchain::DoubleWord<double>>;
    static constexpr revchain::DoubleDouble min() { return revchain::DoubleDouble(Word::min()); }
    static constexpr revchain::DoubleDouble max() { return revchain::DoubleDouble(Word::max()); }
    static constexpr revchain::DoubleDouble lowest() {
        return revchain::DoubleDouble(Word::lowest());
    }
    static constexpr revchain::DoubleDouble infinity() {
        return revchain::DoubleDouble(Word::infinity());
    }
    static constexpr revchain::DoubleDouble quiet_NaN() {
        return revchain::DoubleDouble(Word::quiet_NaN());
    }
    static constexpr revchain::DoubleDouble epsilon() {
        return revchain::DoubleDouble(Word::epsilon());
    }
};

template <>
inline constexpr revchain::DoubleDouble std::numbers::pi_v<revchain::DoubleDouble>{
    0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

template <>
struct Eigen::NumTraits<revchain::DoubleDouble> : Eigen::GenericNumTraits<revchain::DoubleDouble> {
    enum { ReadCost = 2, AddCost = 20, MulCost = 20 };
};
