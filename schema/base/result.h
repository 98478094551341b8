// Expected failures are values: Result<T> holds a T or an Error with context for the user.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace milepost {

enum class ErrorCode {
  invalid_input,  // the caller or a file of the user is wrong; a retry does not help
  not_found,      // the named thing does not exist
  gone,           // it existed in an older build of the map
  corrupt,        // stored or received bytes violate FORMAT.md
  io,             // the file system or the operating system failed
  unavailable,    // the server cannot be reached or is busy; a later retry may succeed
  cancelled,      // stopped on request
};

// One failure, reported in one line: "WHERE: WHAT; HINT".
struct Error {
  ErrorCode code = ErrorCode::invalid_input;
  std::string where;  // file and the location in it, or URL
  std::string what;   // what is wrong there
  std::string hint;   // what the user can do about it; may be empty

  std::string line() const {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!hint.empty()) text += "; " + hint;
    return text;
  }
};

// A value or an Error. REQUIRES: value() only when ok(), error() only when not.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(Error error)
      : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  const T& value() const& { return std::get<0>(state_); }
  T& value() & { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

// Success or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

inline Status ok_status() { return {}; }

}  // namespace milepost
