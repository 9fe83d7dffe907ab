#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "knowledge/database_pages.h"

namespace anchord {

/// One value of a row as SQLite stores it.
struct StoredValue {
  enum class Kind { kNull, kInteger, kText, kBytes, kReal };
  Kind kind = Kind::kNull;
  std::int64_t integer = 0;
  std::span<const std::uint8_t> bytes;  ///< of a text or of bytes; as long as the row
  double real = 0;                      ///< of a real; SQLite stores one that is whole as integer

  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Every row that can be made out on a page, by its number (rowid), if the page is a leaf of a
/// table. Rows that are longer than a page are put together from `pages`. Anything may stand on
/// the page: rows that cannot be are left out, but one that merely holds other values comes
/// through.
void for_each_row(
    const DatabasePages::Page& page, const DatabasePages& pages,
    const std::function<void(std::int64_t number, std::span<const StoredValue>)>& row);

}  // namespace anchord
