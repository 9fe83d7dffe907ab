#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.h"

namespace anchord {

/// The secret that lets a request in: `Authorization: Bearer TOKEN` (RFC 6750).
class BearerToken {
 public:
  static constexpr std::size_t kLeast = 16, kMost = 256;  ///< characters

  /// Reads a token file: a regular file that only its owner may read (mode 0600 or 0400), with one
  /// line of kLeast to kMost printable ASCII characters without a space; one newline may end it.
  /// Errors (kInvalid): names the file, and says what would be right. The token is in no message.
  ///
  /// A file in `$CREDENTIALS_DIRECTORY` may show a group that reads it: systemd lets the service's
  /// user in by an access list, whose mask stat() tells as the group's bits.
  static Result<BearerToken> read(const std::string& file);

  /// The token itself, as in a file without its newline. Errors (kInvalid): as above.
  static Result<BearerToken> parse(std::string_view token);

  /// Whether an Authorization field's value has this token. What is compared is always kMost
  /// characters, whatever differs and wherever: how long it takes depends on `authorization` alone.
  bool admits(std::string_view authorization) const;

  /// The value of the Authorization field that a client sends.
  std::string authorization() const;

 private:
  explicit BearerToken(std::string_view token);
  std::array<unsigned char, kMost> padded_{};  ///< with zeros, which no token has
};

}  // namespace anchord
