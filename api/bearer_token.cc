#include "api/bearer_token.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace anchord {
namespace {

constexpr std::string_view kScheme = "bearer ";
constexpr char kMend[] =
    "; make one with (umask 077; head -c 24 /dev/urandom | base64 > FILE), and chmod 600 FILE";

/// Reads no more than one byte beyond what a token file may have.
Result<std::string> read_all(int file, const std::string& name) {
  std::string text(BearerToken::kMost + 2, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = ::read(file, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return invalid(name, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  return text;
}

bool is_credential(const std::string& name) {
  const char* directory = std::getenv("CREDENTIALS_DIRECTORY");
  return directory && *directory && name.starts_with(std::string(directory) + "/") &&
         name.find("/..") == std::string::npos;
}

Status check_kind(int file, const std::string& name) {
  struct stat found {};
  if (fstat(file, &found) != 0)
    return invalid(name, std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(found.st_mode)) return invalid(name, "is no regular file; a token file is one");
  const mode_t forbidden = is_credential(name) ? S_IRWXO : S_IRWXG | S_IRWXO;
  if (found.st_mode & forbidden)
    return invalid(name, "is open to others than its owner; chmod 600 it, and make a new token");
  return Done{};
}

}  // namespace

BearerToken::BearerToken(std::string_view token) {
  std::copy(token.begin(), token.end(), padded_.begin());
}

Result<BearerToken> BearerToken::parse(std::string_view token) {
  if (token.size() < kLeast || token.size() > kMost)
    return invalid("", "a token has " + std::to_string(kLeast) + " to " + std::to_string(kMost) +
                           " characters" + kMend);
  if (!std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c <= '~'; }))
    return invalid("", std::string("a token is one word of printable ASCII characters") + kMend);
  return BearerToken(token);
}

Result<BearerToken> BearerToken::read(const std::string& name) {
  // Not to wait for a FIFO's writer.
  const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0)
    return invalid(name, std::string("cannot be read: ") + std::strerror(errno) + kMend);
  const Status good = check_kind(file, name);
  auto text = good ? read_all(file, name) : Result<std::string>(good.error());
  close(file);
  if (!text) return text.error();
  if (text->ends_with('\n')) text->pop_back();
  auto token = parse(*text);
  if (!token) return invalid(name, token.error().message);
  return token;
}

bool BearerToken::admits(std::string_view authorization) const {
  if (authorization.size() < kScheme.size()) return false;
  for (std::size_t i = 0; i < kScheme.size(); ++i)  // a scheme's case does not matter
    if ((authorization[i] | 0x20) != kScheme[i]) return false;
  std::string_view given = authorization.substr(kScheme.size());
  while (given.starts_with(' ')) given.remove_prefix(1);
  if (given.size() > kMost) return false;
  std::array<unsigned char, kMost> padded{};
  std::copy(given.begin(), given.end(), padded.begin());
  // Volatile, so that no compiler ends the loop at the first difference. A zero in `given` would
  // pass for padding.
  volatile unsigned char differs = given.find('\0') != std::string_view::npos ? 1 : 0;
  for (std::size_t i = 0; i < kMost; ++i) differs = differs | (padded[i] ^ padded_[i]);
  return differs == 0;
}

std::string BearerToken::authorization() const {
  return "Bearer " + std::string(reinterpret_cast<const char*>(padded_.data()),
                                 strnlen(reinterpret_cast<const char*>(padded_.data()), kMost));
}

}  // namespace anchord
