// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <sstream>
#include <stdexcept>  // std::invalid_argument
#include <string>
#include <string_view>

#include "revchain/numeric/scalar.hpp"

namespace revchain {

/// A wrong call: function, sentence and value, as in "revchain::Chain: link 3: length must be positive, got -0.5".
/// The arguments are left as they were. (In Python: ValueError.)
class InvalidArgument : public std::invalid_argument {
   public:
    using std::invalid_argument::invalid_argument;
};

/// The caller asked a running computation to stop. (In Python: revchain.Cancelled.)
class Cancelled : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// Outcome of a computation; the figures reached stand beside it in the result.
enum class Status {
    success,            ///< the tolerance asked for is met by a proved bound
    tolerance_not_met,  ///< it is not; `error_bound` says what was reached
};

inline std::string_view to_string(Status status) { return status == Status::success ? "success" : "tolerance_not_met"; }

namespace detail {

template <class T>
std::string in_digits(const T& value) {
    std::ostringstream text;
    text.precision(std::numeric_limits<T>::is_specialized ? std::numeric_limits<T>::max_digits10 : 17);
    text << value;
    // 17 digits where 6 say the same number: people should read back what they wrote.
    if constexpr (std::is_floating_point_v<T>) {
        for (int digits = 6; digits < std::numeric_limits<T>::max_digits10; ++digits) {
            std::ostringstream shorter;
            shorter.precision(digits);
            shorter << value;
            T back{};
            if (std::istringstream(shorter.str()) >> back && back == value) return shorter.str();
        }
    }
    return text.str();
}

template <class T>
[[noreturn]] void throw_invalid(std::string_view function, std::string_view sentence, const T& value) {
    throw InvalidArgument("revchain::" + std::string(function) + ": " + std::string(sentence) + ", got " +
                          in_digits(value));
}

[[noreturn]] inline void throw_invalid(std::string_view function, std::string_view sentence) {
    throw InvalidArgument("revchain::" + std::string(function) + ": " + std::string(sentence));
}

/// Throws InvalidArgument unless the value is positive and finite; then the same for further pairs of name and value.
template <Real T, class... Rest>
void require_positive(std::string_view function, std::string_view name, const T& value, const Rest&... rest) {
    using std::isfinite;
    if (!isfinite(value) || !(value > T(0)))
        throw_invalid(function, std::string(name) + " must be positive and finite", value);
    if constexpr (sizeof...(rest) > 0) require_positive(function, rest...);
}

}  // namespace detail
}  // namespace revchain
