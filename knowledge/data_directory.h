#pragma once

#include <string>

#include "core/result.h"

namespace anchord {

/// Makes the directory, with those above it, if it is not there.
Status make_directory(const std::string& directory);

/// A file whose lock says that the directory is taken; it goes with the process, however it ends.
class DirectoryLock {
 public:
  /// kUnavailable: another process holds it; kIo: the directory cannot be written.
  static Result<DirectoryLock> take(const std::string& directory);
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock& operator=(DirectoryLock&&) = delete;
  ~DirectoryLock();

 private:
  explicit DirectoryLock(int descriptor) : descriptor_(descriptor) {}
  std::string holder() const;
  int descriptor_;
};

}  // namespace anchord
