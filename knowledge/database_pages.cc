#include "knowledge/database_pages.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace anchord {
namespace {

constexpr std::int64_t kWalHeader = 32, kImageHeader = 24;

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

std::int64_t size_of(int file) {
  struct stat info {};
  return ::fstat(file, &info) == 0 ? info.st_size : 0;
}

bool read_at(int file, std::int64_t offset, std::span<std::uint8_t> out) {
  return ::pread(file, out.data(), out.size(), offset) == std::ssize(out);
}

/// The WAL's running checksum. SQLite writes it, on a machine such as this, over little-endian
/// words.
struct Sum {
  std::uint32_t a = 0, b = 0;
  void add(std::span<const std::uint8_t> bytes) {
    for (std::size_t i = 0; i + 8 <= bytes.size(); i += 8) {
      std::uint32_t words[2];
      std::memcpy(words, &bytes[i], sizeof words);
      a += words[0] + b;
      b += words[1] + a;
    }
  }
  bool stands_at(const std::uint8_t* bytes) const {
    return a == big_endian(bytes) && b == big_endian(bytes + 4);
  }
};

}  // namespace

Result<DatabasePages> DatabasePages::open(const std::string& path) {
  DatabasePages pages;
  pages.database_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (pages.database_ < 0)
    return Error{ErrorCode::kIo, "", path + " cannot be read: " + std::strerror(errno)};
  pages.database_pages_ = size_of(pages.database_) / kSize;
  pages.read_wal(path + "-wal");
  return pages;
}

DatabasePages::DatabasePages(DatabasePages&& other) noexcept
    : database_(std::exchange(other.database_, -1)),
      wal_file_(std::exchange(other.wal_file_, -1)),
      database_pages_(other.database_pages_),
      wal_(std::move(other.wal_)),
      whole_(other.whole_),
      newest_(std::move(other.newest_)) {}

DatabasePages::~DatabasePages() {
  if (database_ >= 0) ::close(database_);
  if (wal_file_ >= 0) ::close(wal_file_);
}

void DatabasePages::read_wal(const std::string& path) {
  wal_file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::array<std::uint8_t, kWalHeader> header;
  if (wal_file_ < 0 || !read_at(wal_file_, 0, header)) return;
  Sum sum;
  sum.add(std::span(header).first(24));
  bool whole = sum.stands_at(&header[24]);
  std::array<std::uint8_t, kImageHeader + kSize> bytes;
  std::optional<std::array<std::uint8_t, 8>> salts;  // of this WAL's life; other images are older
  std::size_t end = 0;                               // of the last transaction
  std::size_t whole_end = 0;
  for (std::int64_t offset = kWalHeader; read_at(wal_file_, offset, bytes);
       offset += std::ssize(bytes)) {
    if (!salts) {  // where the header is damaged, the first image tells
      salts.emplace();
      std::memcpy(salts->data(), whole ? &header[16] : &bytes[8], 8);
    }
    if (std::memcmp(salts->data(), &bytes[8], 8) != 0) {
      whole = false;
      continue;
    }
    sum.add(std::span(bytes).first(8));
    sum.add(std::span(bytes).subspan(kImageHeader));
    whole = whole && sum.stands_at(&bytes[16]);
    wal_.push_back({big_endian(&bytes[0]), offset + kImageHeader});
    if (big_endian(&bytes[4]) == 0) continue;
    end = wal_.size();
    if (whole) whole_end = end;
  }
  wal_.resize(end);
  whole_ = static_cast<std::int64_t>(whole_end);
  for (std::int64_t i = 0; i < std::ssize(wal_); ++i)
    newest_[wal_[static_cast<std::size_t>(i)].page] = database_pages_ + i;
}

std::int64_t DatabasePages::page_of(std::int64_t image) const {
  return image < database_pages_ ? image + 1
                                 : wal_[static_cast<std::size_t>(image - database_pages_)].page;
}

std::optional<DatabasePages::Page> DatabasePages::image(std::int64_t image) const {
  Page page;
  const bool read =
      image < database_pages_
          ? read_at(database_, image * kSize, page)
          : read_at(wal_file_, wal_[static_cast<std::size_t>(image - database_pages_)].offset,
                    page);
  if (!read) return {};
  return page;
}

std::optional<DatabasePages::Page> DatabasePages::page(std::int64_t number) const {
  const auto in_wal = newest_.find(number);
  if (in_wal != newest_.end()) return image(in_wal->second);
  if (number < 1 || number > database_pages_) return {};
  return image(number - 1);
}

}  // namespace anchord
