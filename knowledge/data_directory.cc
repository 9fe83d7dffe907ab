#include "knowledge/data_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace anchord {
namespace {

Error io(std::string message) { return {ErrorCode::kIo, "", std::move(message)}; }

}  // namespace

Status make_directory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && !std::filesystem::is_directory(directory, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    return io("cannot make the data directory " + directory + ": " + error.message() +
              "; name one that this user can write with --data");
  return Done{};
}

Result<DirectoryLock> DirectoryLock::take(const std::string& directory) {
  const std::string path = directory + "/anchord.lock";
  DirectoryLock lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (lock.descriptor_ < 0)
    return io("cannot write in the data directory " + directory + ": " + std::strerror(errno) +
              "; give this user the right to write there, or name another directory with --data");
  if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    if (reason != EWOULDBLOCK) return io("cannot lock " + path + ": " + std::strerror(reason));
    return Error{ErrorCode::kUnavailable, "",
                 "the data directory " + directory + " is in use by another process" +
                     lock.holder() + "; stop that one, or name another directory with --data"};
  }
  // For whoever comes next and is refused. A full disk, on which it cannot be written, is no reason
  // not to start: questions can be answered.
  const std::string pid = std::to_string(::getpid());
  const ssize_t size = ::pwrite(lock.descriptor_, pid.data(), pid.size(), 0);
  if (::ftruncate(lock.descriptor_, std::max<ssize_t>(size, 0)) != 0)
    return io("cannot write " + path + ": " + std::strerror(errno));
  return lock;
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// " (1234)" if the holder has written its number.
std::string DirectoryLock::holder() const {
  char digits[16];
  const ssize_t size = ::pread(descriptor_, digits, sizeof digits, 0);
  return size > 0 ? " (" + std::string(digits, static_cast<std::size_t>(size)) + ")" : "";
}

}  // namespace anchord
