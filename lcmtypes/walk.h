#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "core/result.h"
#include "lcmtypes/field.h"
#include "lcmtypes/names.h"

namespace anchord {

inline constexpr std::size_t kNumberBytes = 8;     ///< of a double or int64_t
inline constexpr std::size_t kLeastTextBytes = 5;  ///< length and NUL

/// Walks over an encoded message before lcm-gen's decoder does. Every step returns whether it went
/// well; the first that does not leaves its error, and the walk ends there.
class Walk {
 public:
  explicit Walk(std::span<const std::uint8_t> bytes, std::size_t max_bytes = kMaxMessageBytes);

  Status outcome() const { return error_ ? Status(*error_) : Status(Done{}); }

  /// That of the message's type: lcm-gen's getHash().
  bool fingerprint(std::int64_t expected);

  /// 8 bytes each, whatever they are.
  bool numbers(const Field& field, std::size_t count) { return skip(field, count * kNumberBytes); }

  bool skip(const Field& field, std::size_t bytes);

  /// A boolean: 0 or 1.
  bool flag(const Field& field, bool& value);
  bool flag(const Field& field);

  /// One of the constants `least` to `most`, an int8_t.
  bool enumerator(const Field& field, int least, int most, int& value);

  /// A whole number of 4 bytes, 0 to `most`.
  bool whole(const Field& field, std::size_t most, std::size_t& value);

  /// A count of things that take at least `bytes_each`, and all are yet to come.
  bool count(const Field& field, std::size_t most, std::size_t bytes_each, std::size_t& value);

  /// A count of numbers, one of `allowed`.
  bool count_of(const Field& field, std::initializer_list<std::size_t> allowed, std::size_t& value);

  /// Text as text_fault() allows it.
  bool text(const Field& field, std::size_t max_bytes = kMaxNameBytes);
  /// As text(), and not empty.
  bool name(const Field& field);

  bool end() { return rest_.empty() || refuse(Field(), "bytes follow the end of the message"); }

  /// Ends the walk; false.
  bool refuse(const Field& field, std::string message);

 private:
  /// A signed big-endian integer.
  bool integer(const Field& field, std::size_t bytes, std::int64_t& value);
  bool read_text(const Field& field, std::size_t max_bytes, bool may_be_empty);

  std::span<const std::uint8_t> rest_;
  std::optional<Error> error_;
};

}  // namespace anchord
