// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <sstream>
#include <stdexcept>  // std::invalid_argument
#include <string>
#include <string_view>

#include "revchain/numeric/scalar.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// The exception for a wrong call (in Python: ValueError). Its message has function, rule and
/// value: "revchain::Chain: links[2]: length must be positive, got -0.5". Arguments are unchanged.
class InvalidArgument : public std::invalid_argument {
   public:
    using std::invalid_argument::invalid_argument;
};

/// The exception if the caller stopped a running computation. (In Python: revchain.Cancelled.)
class Cancelled : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// The outcome of a computation.
enum class Status {
    success,            ///< a proved bound meets the requested tolerance
    tolerance_not_met,  ///< no proved bound meets it; `error_bound` is the bound reached
};

inline std::string_view to_string(Status status) {
    return status == Status::success ? "success" : "tolerance_not_met";
}

namespace detail {

template <class T>
[[gnu::cold]] std::string in_digits(const T& value) {
    const auto written = [&](int digits) {
        std::ostringstream text;
        text.precision(digits);
        text << value;
        return text.str();
    };
    using Limits = std::numeric_limits<T>;
    // These are the fewest digits that give the same number when read back.
    if constexpr (std::is_floating_point_v<T>)
        for (int digits = 6; digits < Limits::max_digits10; ++digits) {
            T back{};
            if (std::istringstream(written(digits)) >> back && back == value)
                return written(digits);
        }
    return written(Limits::is_specialized ? Limits::max_digits10 : 17);
}

// Functions that throw are marked cold: a compiler optimizes them for size, which takes less time.
template <class T>
[[noreturn, gnu::cold, gnu::noinline]] void throw_invalid(std::string_view function,
                                                          std::string_view sentence,
                                                          const T& value) {
    const bool named = sentence.ends_with(" is") || sentence.ends_with(" has") ||
                       sentence.ends_with(" are") || sentence.ends_with(" at");
    throw InvalidArgument("revchain::" + std::string(function) + ": " + std::string(sentence) +
                          (named ? " " : ", got ") + in_digits(value));
}

[[noreturn, gnu::cold, gnu::noinline]] inline void throw_invalid(std::string_view function,
                                                                 std::string_view sentence) {
    throw InvalidArgument("revchain::" + std::string(function) + ": " + std::string(sentence));
}

template <class T>
[[noreturn]] void throw_rule(std::string_view function, std::string_view name,
                             std::string_view rule, const T& value) {
    throw_invalid(function, std::string(name) + " must be " + std::string(rule), value);
}

/// Throws InvalidArgument unless every value is finite and `good`. Names and values are in pairs.
template <class Good, Real T, class... Rest>
void require(const Good& good, std::string_view rule, std::string_view function,
             std::string_view name, const T& value, const Rest&... rest) {
    using std::isfinite;
    if (!isfinite(value) || !good(value)) throw_rule(function, name, rule, value);
    if constexpr (sizeof...(rest) > 0) require(good, rule, function, rest...);
}

/// These throw InvalidArgument unless every value is finite and as the name says (same arguments).
template <class... Pairs>
void require_finite(std::string_view function, const Pairs&... pairs) {
    require([](const auto&) { return true; }, "finite", function, pairs...);
}
template <class... Pairs>
void require_positive(std::string_view function, const Pairs&... pairs) {
    require([]<class T>(const T& x) { return x > T(0); }, "positive and finite", function,
            pairs...);
}
template <class... Pairs>
void require_not_negative(std::string_view function, const Pairs&... pairs) {
    require([]<class T>(const T& x) { return !(x < T(0)); }, "finite and not negative", function,
            pairs...);
}

}  // namespace detail
}  // namespace revchain
