#include "knowledge/page_rows.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace anchord {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::int64_t kSize = DatabasePages::kSize;
/// Messages have at most 8 MiB; what claims much more is damaged.
constexpr std::int64_t kLongest = 64 << 20;

std::int64_t big_endian(Bytes bytes) {
  // The first byte bears the sign.
  std::int64_t value = bytes.empty() ? 0 : static_cast<std::int8_t>(bytes[0]);
  for (std::size_t i = 1; i < bytes.size(); ++i)
    value = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << 8 | bytes[i]);
  return value;
}

std::int64_t unsigned_at(Bytes bytes, std::size_t at, std::size_t size) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Takes a variable-length integer off the front.
std::optional<std::int64_t> take_varint(Bytes& bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 9 && i < bytes.size(); ++i) {
    value = i == 8 ? value << 8 | bytes[i] : value << 7 | (bytes[i] & 0x7f);
    if (i < 8 && (bytes[i] & 0x80) != 0) continue;
    bytes = bytes.subspan(i + 1);
    return static_cast<std::int64_t>(value);
  }
  return {};
}

/// Of a row's `size` bytes, how many stand on the leaf itself.
std::int64_t local_size(std::int64_t size) {
  constexpr std::int64_t kMost = kSize - 35, kLeast = (kSize - 12) * 32 / 255 - 23;
  if (size <= kMost) return size;
  const std::int64_t some = kLeast + (size - kLeast) % (kSize - 4);
  return some <= kMost ? some : kLeast;
}

/// The rest of a row, page by page.
bool add_overflow(const DatabasePages& pages, std::int64_t number, std::int64_t size,
                  std::vector<std::uint8_t>& out) {
  while (size > 0) {
    const auto page = pages.page(number);
    if (!page) return false;
    const std::int64_t here = std::min(size, kSize - 4);
    out.insert(out.end(), page->begin() + 4, page->begin() + 4 + here);
    number = unsigned_at(*page, 0, 4);
    size -= here;
  }
  return true;
}

/// A value of the kind that the row's head tells, taken off the front; nothing if there is not
/// enough, or it is none that the log has.
std::optional<StoredValue> take_value(std::int64_t kind, Bytes& bytes) {
  using Kind = StoredValue::Kind;
  if (kind == 0) return StoredValue{};
  if (kind == 8 || kind == 9) return StoredValue{Kind::kInteger, kind - 8, {}};
  constexpr std::size_t kNumbers[] = {0, 1, 2, 3, 4, 6, 8, 8};
  if (kind < 0 || (kind > 7 && kind < 12)) return {};
  const auto size = kind <= 7 ? kNumbers[kind] : static_cast<std::size_t>(kind - 12) / 2;
  if (size > bytes.size()) return {};
  const Bytes value = bytes.first(size);
  bytes = bytes.subspan(size);
  if (kind <= 6) return StoredValue{Kind::kInteger, big_endian(value), {}};
  if (kind == 7) return StoredValue{Kind::kReal, 0, {}, std::bit_cast<double>(big_endian(value))};
  return StoredValue{kind % 2 == 0 ? Kind::kBytes : Kind::kText, 0, value};
}

std::optional<std::vector<StoredValue>> values_of(Bytes record) {
  Bytes head = record;
  const auto head_size = take_varint(head);
  if (!head_size || *head_size < 1 || *head_size > std::ssize(record)) return {};
  const auto taken = record.size() - head.size();
  if (*head_size < static_cast<std::int64_t>(taken)) return {};
  head = record.subspan(taken, static_cast<std::size_t>(*head_size) - taken);
  Bytes body = record.subspan(static_cast<std::size_t>(*head_size));
  std::vector<StoredValue> values;
  while (!head.empty()) {
    const auto kind = take_varint(head);
    if (!kind) return {};
    auto value = take_value(*kind, body);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

}  // namespace

void for_each_row(
    const DatabasePages::Page& page, const DatabasePages& pages,
    const std::function<void(std::int64_t number, std::span<const StoredValue>)>& row) {
  constexpr std::uint8_t kTableLeaf = 13;
  if (page[0] != kTableLeaf) return;
  const std::int64_t cells = std::min(unsigned_at(page, 3, 2), (kSize - 8) / 2);
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    const std::int64_t at = unsigned_at(page, static_cast<std::size_t>(8 + 2 * cell), 2);
    if (at < 8 || at >= kSize) continue;
    Bytes bytes = Bytes(page).subspan(static_cast<std::size_t>(at));
    const auto size = take_varint(bytes);
    const auto number = take_varint(bytes);
    if (!size || !number || *size < 0 || *size > kLongest) continue;
    const std::int64_t local = local_size(*size);
    if (local + (local < *size ? 4 : 0) > std::ssize(bytes)) continue;
    std::vector<std::uint8_t> record(bytes.begin(), bytes.begin() + local);
    if (local < *size &&
        !add_overflow(pages, unsigned_at(bytes, static_cast<std::size_t>(local), 4), *size - local,
                      record))
      continue;
    if (const auto values = values_of(record)) row(*number, *values);
  }
}

}  // namespace anchord
