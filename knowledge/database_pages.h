#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace anchord {

/// The pages of a SQLite database and its WAL as they stand on the disk, damaged or not; for what
/// SQLite itself would not open. Reads alone. The formats: https://sqlite.org/fileformat.html.
class DatabasePages {
 public:
  static constexpr std::int64_t kSize =
      4096;  ///< that of SQLite's default, with which logs are made
  using Page = std::array<std::uint8_t, kSize>;

  /// The database at `path`, and `path`-wal if there is one. kIo: it cannot be read.
  static Result<DatabasePages> open(const std::string& path);
  DatabasePages(DatabasePages&& other) noexcept;
  DatabasePages& operator=(DatabasePages&&) = delete;
  ~DatabasePages();

  /// Images of pages: all of the database's, then those of the WAL, in the order in which they were
  /// written. The WAL's of before its first damage were committed; those behind, up to the last end
  /// of a transaction, may be of transactions that failed as well.
  std::int64_t images() const { return database_pages_ + std::ssize(wal_); }
  bool committed(std::int64_t image) const { return image < database_pages_ + whole_; }
  std::int64_t page_of(std::int64_t image) const;  ///< its number, from 1
  std::optional<Page> image(std::int64_t image) const;

  /// The newest image of a page; nothing if there is none.
  std::optional<Page> page(std::int64_t number) const;

 private:
  DatabasePages() = default;
  void read_wal(const std::string& path);
  struct WalImage {
    std::int64_t page, offset;
  };

  int database_ = -1, wal_file_ = -1;
  std::int64_t database_pages_ = 0;
  std::vector<WalImage> wal_;
  std::int64_t whole_ = 0;                       ///< of these, before the first damage
  std::map<std::int64_t, std::int64_t> newest_;  ///< image of a page that the WAL has
};

}  // namespace anchord
