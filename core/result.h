#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace anchord {

/// What kind of refusal an Error is. The fronts turn it into an HTTP status or an exit code.
enum class ErrorCode {
  kInvalid,      ///< the input is wrong: 400
  kUnknown,      ///< names something that does not exist: 404
  kConflict,     ///< contradicts what was accepted before: 409
  kTooLarge,     ///< over a limit: 413
  kUnavailable,  ///< cannot be answered now, try again: 503
  kIo,           ///< the machine failed (disk, network): 500
  kStorage,      ///< it cannot be stored (disk full, or it fails), try again: 507
};

/// A refusal: what is wrong (`message`, one sentence, says what would be right) and where
/// (`field`, a path such as `detections[3].covariance`; empty if there is no single place).
struct Error {
  ErrorCode code = ErrorCode::kInvalid;
  std::string field;
  std::string message;

  /// "field: message", or the message alone.
  std::string text() const { return field.empty() ? message : field + ": " + message; }
};

inline Error invalid(std::string field, std::string message) {
  return {ErrorCode::kInvalid, std::move(field), std::move(message)};
}

/// Either a value or an Error. It cannot be ignored, and reading the wrong side aborts: asking
/// for the value of a refusal is a programmer's error.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  T& value() {
    require();
    return std::get<0>(content_);
  }
  const T& value() const {
    require();
    return std::get<0>(content_);
  }
  const Error& error() const {
    if (ok()) std::fputs("Result::error() of a success\n", stderr), std::abort();
    return std::get<1>(content_);
  }

 private:
  void require() const {
    if (!ok()) {
      std::fprintf(stderr, "Result::value() of a refusal: %s\n", error().text().c_str());
      std::abort();
    }
  }
  std::variant<T, Error> content_;
};

struct Done {};
/// The outcome of something that has no value: `return Done{};` or `return invalid(...)`.
using Status = Result<Done>;

}  // namespace anchord
