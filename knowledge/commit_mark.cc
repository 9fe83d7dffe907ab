#include "knowledge/commit_mark.h"

#include <fcntl.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cstring>
#include <utility>

namespace anchord {
namespace {

/// The sequence and its checksum, as the machine has them: the mark stays on it.
struct Record {
  std::int64_t sequence = 0;
  std::uint64_t checksum = 0;
};

std::uint64_t checksum(std::int64_t sequence) {
  boost::crc_32_type crc;
  crc.process_bytes(&sequence, sizeof sequence);
  return crc.checksum();
}

}  // namespace

CommitMark::CommitMark(CommitMark&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

CommitMark::~CommitMark() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::int64_t CommitMark::read() const {
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  Record record;
  const ssize_t size = ::pread(descriptor, &record, sizeof record, 0);
  ::close(descriptor);
  return size == sizeof record && record.checksum == checksum(record.sequence) ? record.sequence
                                                                               : 0;
}

void CommitMark::write(std::int64_t sequence) {
  if (descriptor_ < 0) descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  const Record record{sequence, checksum(sequence)};
  // By half, it is no mark: that is what is promised of a failure.
  [[maybe_unused]] const ssize_t size = ::pwrite(descriptor_, &record, sizeof record, 0);
}

}  // namespace anchord
