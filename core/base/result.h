// Result<T>: a value or an Error. Input errors are values in pmesh, never exceptions: the decoder
// is built without them. Misuse (reading the value of a failed Result) is an assert.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace pmesh {

/// What kind of thing went wrong. The command line maps each code to an exit status.
enum class ErrorCode : std::uint8_t {
  runtime,           ///< The outside world failed: a file, a socket, a peer.
  usage,             ///< The caller asked for something that makes no sense.
  bad_input,         ///< A mesh file or message that breaks its format; what is no PM file.
  verification,      ///< A PM file that is damaged (its claims do not hold) or incomplete.
  out_of_resources,  ///< A limit or the machine's memory or disk is exceeded.
};

struct Error {
  ErrorCode code = ErrorCode::runtime;
  std::string message;  ///< One line, without a final period: where, then what.
};

inline Error bad_input(std::string message) { return {ErrorCode::bad_input, std::move(message)}; }
inline Error damaged(std::string message) { return {ErrorCode::verification, std::move(message)}; }
inline Error runtime_error(std::string message) { return {ErrorCode::runtime, std::move(message)}; }

/// `error` with "where: " put before its message.
inline Error prefixed(const std::string& where, Error error) {
  error.message = where + ": " + error.message;
  return error;
}

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT: implicit
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return *checked(std::get_if<0>(&state_)); }
  const T& value() const& { return *checked(std::get_if<0>(&state_)); }
  T&& value() && { return std::move(*checked(std::get_if<0>(&state_))); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return *checked(std::get_if<1>(&state_)); }

 private:
  template <class P>
  static P* checked(P* pointer) {
    assert(pointer != nullptr);
    return pointer;
  }
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error. `Status{}` is success.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : failed_(true), error_(std::move(error)) {}  // NOLINT: implicit

  bool ok() const { return !failed_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const {
    assert(failed_);
    return error_;
  }

 private:
  bool failed_ = false;
  Error error_;
};

using Status = Result<void>;

}  // namespace pmesh
