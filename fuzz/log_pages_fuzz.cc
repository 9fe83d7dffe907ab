#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fuzz/require.h"
#include "knowledge/database_pages.h"
#include "knowledge/page_rows.h"

// Whatever stands in a damaged database and its WAL, rows are read within its bytes or left out.
// The first byte of the input says how many pages the database has; the rest is the WAL.

namespace {

/// Goes with its files when the program ends.
struct Folder {
  std::string name = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/dev/shm";
  Folder() {
    name += "/log_pages_XXXXXX";
    require(mkdtemp(name.data()) != nullptr);
  }
  ~Folder() {
    for (const char* file : {"/a.db", "/a.db-wal"}) ::unlink((name + file).c_str());
    ::rmdir(name.c_str());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

void write(const std::string& path, const std::uint8_t* data, std::size_t size) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  require(file && std::fwrite(data, 1, size, file) == size && std::fclose(file) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const Folder folder;
  const std::string path = folder.name + "/a.db";
  const std::size_t database = std::min(size - 1, data[0] * std::size_t{4096});
  write(path, data + 1, database);
  write(path + "-wal", data + 1 + database, size - 1 - database);
  const auto pages = anchord::DatabasePages::open(path);
  require(pages.ok());
  std::uint64_t sum = 0;
  for (std::int64_t i = 0; i < pages->images(); ++i) {
    const auto page = pages->image(i);
    require(page.has_value());
    anchord::for_each_row(*page, *pages, [&](std::int64_t, auto row) {
      for (const auto& value : row)
        for (const std::uint8_t byte : value.bytes) sum += byte;
    });
  }
  [[maybe_unused]] static volatile std::uint64_t kept;
  kept = sum;  // so that the bytes are read
  return 0;
}
