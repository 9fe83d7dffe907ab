#pragma once

#include <cstdint>
#include <string>

namespace anchord {

/// What the frame log committed last, in a small file beside the database. SQLite takes a WAL with
/// a damaged page for one that ends there, as if the power had gone, and says nothing; by the mark
/// the loss is seen. It is not synced: after a loss of power it may be older than the log, never
/// newer. A write that fails leaves an older mark, or none.
class CommitMark {
 public:
  explicit CommitMark(std::string path) : path_(std::move(path)) {}
  CommitMark(CommitMark&& other) noexcept;
  CommitMark& operator=(CommitMark&&) = delete;
  ~CommitMark();

  /// The sequence that was committed last; 0 if there is no mark, or none that is whole.
  std::int64_t read() const;
  void write(std::int64_t sequence);

 private:
  std::string path_;
  int descriptor_ = -1;  ///< once something was written
};

}  // namespace anchord
