// Expected failures are values.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace milepost::vehicle {

enum class ErrorCode {
  invalid_input,  // the caller or a file of the user is wrong; trying again does not help
  unsupported,    // sound, but not built yet: nothing of it is ignored
  not_found,      // the named thing does not exist
  gone,           // it existed in an older build of the map
  corrupt,        // stored or received bytes break their format
  io,             // the disk or the operating system refused
  unavailable,    // the server cannot be reached or is busy; trying again later may help
  cancelled,      // stopped on request
  timed_out,      // the deadline was over
};

// One failure, told in one line: "WHERE: WHAT; MEND".
struct Error {
  ErrorCode code = ErrorCode::invalid_input;
  std::string where;  // a file and the place in it, a URL, or a parameter
  std::string what;   // what is wrong there
  std::string mend;   // what to do about it; may be empty

  std::string line() const {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!mend.empty()) text += "; " + mend;
    return text;
  }
};

// A value or an Error. REQUIRES: value, * and -> only when ok(), error() only when not.
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
