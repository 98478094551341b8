// Expected failures are returned as values.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace milepost::vehicle {

enum class ErrorCode {
  invalid_input,  // an argument or a file of the caller is wrong; retrying does not help
  not_found,      // the named object does not exist
  gone,           // it belongs to a build of the map that was replaced
  corrupt,        // stored or received bytes violate their format
  io,             // an operation of the file system or the operating system failed
  unavailable,    // the server cannot be reached or is busy; retrying later may help
  cancelled,      // stopped on request
  timed_out,      // the deadline has passed
};

// One failure. line() formats it as "WHERE: WHAT; HINT".
struct Error {
  ErrorCode code = ErrorCode::invalid_input;
  std::string where;  // a file and position, a URL, or a parameter
  std::string what;   // what is wrong there
  std::string hint;   // what to do about it; may be empty

  std::string line() const {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!hint.empty()) text += "; " + hint;
    return text;
  }
};

// A value or an Error. REQUIRES: value access (* and ->) only if ok(), error() only if not.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}

  bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }

  T& operator*() {
    assert(ok());
    return *value_;
  }
  const T& operator*() const {
    assert(ok());
    return *value_;
  }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  const Error& error() const {
    assert(!ok());
    return error_;
  }

 private:
  std::optional<T> value_;
  Error error_;
};

// Success or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const {
    assert(!ok());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace milepost::vehicle
