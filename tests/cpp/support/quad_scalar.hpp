// SPDX-License-Identifier: MPL-2.0
// A scalar that is none of the built-in ones: quadruple precision behind a class with no implicit conversions but from
// built-in numbers. What compiles and is right with it asks of a scalar only what the concept Real says.
#pragma once

#include <quadmath.h>

#include <Eigen/Core>
#include <compare>
#include <limits>
#include <ostream>

namespace support {

class QuadScalar {
   public:
    QuadScalar() = default;
    template <class Number>
    requires std::is_arithmetic_v<Number> QuadScalar(Number x) : value_(x) {}  // NOLINT(google-explicit-constructor)
    explicit QuadScalar(__float128 x) : value_(x) {}
    explicit operator double() const { return static_cast<double>(value_); }
    __float128 value() const { return value_; }

    friend QuadScalar operator+(QuadScalar x, QuadScalar y) { return QuadScalar(x.value_ + y.value_); }
    friend QuadScalar operator-(QuadScalar x, QuadScalar y) { return QuadScalar(x.value_ - y.value_); }
    friend QuadScalar operator*(QuadScalar x, QuadScalar y) { return QuadScalar(x.value_ * y.value_); }
    friend QuadScalar operator/(QuadScalar x, QuadScalar y) { return QuadScalar(x.value_ / y.value_); }
    friend QuadScalar operator-(QuadScalar x) { return QuadScalar(-x.value_); }
    QuadScalar& operator+=(QuadScalar y) { return *this = *this + y; }
    QuadScalar& operator-=(QuadScalar y) { return *this = *this - y; }
    QuadScalar& operator*=(QuadScalar y) { return *this = *this * y; }
    QuadScalar& operator/=(QuadScalar y) { return *this = *this / y; }
    friend bool operator==(QuadScalar x, QuadScalar y) { return x.value_ == y.value_; }
    friend std::partial_ordering operator<=>(QuadScalar x, QuadScalar y) {
        return x.value_ < y.value_    ? std::partial_ordering::less
               : x.value_ > y.value_  ? std::partial_ordering::greater
               : x.value_ == y.value_ ? std::partial_ordering::equivalent
                                      : std::partial_ordering::unordered;
    }
    friend QuadScalar abs(QuadScalar x) { return QuadScalar(fabsq(x.value_)); }
    friend QuadScalar sqrt(QuadScalar x) { return QuadScalar(sqrtq(x.value_)); }
    friend QuadScalar ldexp(QuadScalar x, int e) { return QuadScalar(ldexpq(x.value_, e)); }
    friend QuadScalar frexp(QuadScalar x, int* e) { return QuadScalar(frexpq(x.value_, e)); }
    friend bool isfinite(QuadScalar x) { return finiteq(x.value_) != 0; }
    friend std::ostream& operator<<(std::ostream& out, QuadScalar x) { return out << static_cast<double>(x); }

   private:
    __float128 value_ = 0;
};

}  // namespace support

template <>
struct std::numeric_limits<support::QuadScalar> : std::numeric_limits<long double> {
    static constexpr int digits = 113;
    static constexpr int digits10 = 33;
    static constexpr int max_digits10 = 36;
    static support::QuadScalar epsilon() { return support::QuadScalar(ldexpq(__float128(1), -112)); }
    static support::QuadScalar min() { return support::QuadScalar(ldexpq(__float128(1), -16382)); }
    static support::QuadScalar max() { return std::numeric_limits<long double>::max(); }
    static support::QuadScalar infinity() { return std::numeric_limits<double>::infinity(); }
    static support::QuadScalar quiet_NaN() { return std::numeric_limits<double>::quiet_NaN(); }
};

template <>
struct Eigen::NumTraits<support::QuadScalar> : Eigen::GenericNumTraits<support::QuadScalar> {
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 0,
        ReadCost = 2,
        AddCost = 40,
        MulCost = 40
    };
};
