#include "lcmtypes/walk.h"

#include <string_view>
#include <utility>

namespace anchord {

Walk::Walk(std::span<const std::uint8_t> bytes, std::size_t max_bytes) : rest_(bytes) {
  if (bytes.size() > max_bytes) {
    error_ = Error{ErrorCode::kTooLarge, "",
                   "the message has more than " + std::to_string(max_bytes >> 20) + " MiB"};
    rest_ = {};
  }
}

bool Walk::fingerprint(std::int64_t expected) {
  std::int64_t found = 0;
  if (!integer(Field(), 8, found)) return false;
  return found == expected ||
         refuse(Field(), "the fingerprint is not that of this message type and version");
}

bool Walk::skip(const Field& field, std::size_t bytes) {
  if (bytes > rest_.size()) return refuse(field, "the message ends before it");
  rest_ = rest_.subspan(bytes);
  return true;
}

bool Walk::flag(const Field& field, bool& value) {
  std::int64_t found = 0;
  if (!integer(field, 1, found)) return false;
  value = found == 1;
  return found == 0 || found == 1 || refuse(field, "must be 0 or 1");
}

bool Walk::flag(const Field& field) {
  bool unused = false;
  return flag(field, unused);
}

bool Walk::enumerator(const Field& field, int least, int most, int& value) {
  std::int64_t found = 0;
  if (!integer(field, 1, found)) return false;
  if (found < least || found > most) return refuse(field, "is not one of the type's constants");
  value = static_cast<int>(found);
  return true;
}

bool Walk::whole(const Field& field, std::size_t most, std::size_t& value) {
  std::int64_t found = 0;
  if (!integer(field, 4, found)) return false;
  if (found < 0) return refuse(field, "must not be negative");
  value = static_cast<std::size_t>(found);
  return value <= most || refuse(field, "must be at most " + std::to_string(most));
}

bool Walk::count(const Field& field, std::size_t most, std::size_t bytes_each, std::size_t& value) {
  if (!whole(field, most, value)) return false;
  return value * bytes_each <= rest_.size() || refuse(field, "says more than the message holds");
}

bool Walk::count_of(const Field& field, std::initializer_list<std::size_t> allowed,
                    std::size_t& value) {
  if (!count(field, kMaxMessageBytes, kNumberBytes, value)) return false;
  std::string list;
  for (const std::size_t one : allowed) {
    if (value == one) return true;
    list += (list.empty() ? "" : " or ") + std::to_string(one);
  }
  return refuse(field, "must be " + list);
}

bool Walk::text(const Field& field, std::size_t max_bytes) {
  return read_text(field, max_bytes, true);
}

bool Walk::name(const Field& field) { return read_text(field, kMaxNameBytes, false); }

bool Walk::refuse(const Field& field, std::string message) {
  if (!error_) error_ = invalid(field.text(), std::move(message));
  return false;
}

bool Walk::integer(const Field& field, std::size_t bytes, std::int64_t& value) {
  const auto start = rest_;
  if (!skip(field, bytes)) return false;
  std::uint64_t bits = start[0] >= 0x80 ? ~std::uint64_t{0} : 0;
  for (std::size_t i = 0; i < bytes; ++i) bits = bits << 8 | start[i];
  value = static_cast<std::int64_t>(bits);
  return true;
}

bool Walk::read_text(const Field& field, std::size_t max_bytes, bool may_be_empty) {
  std::int64_t length = 0;  // counts the NUL
  if (!integer(field, 4, length)) return false;
  if (length < 1) return refuse(field, "has a length below 1");
  const auto start = rest_;
  if (!skip(field, static_cast<std::size_t>(length))) return false;
  const std::string_view value(reinterpret_cast<const char*>(start.data()),
                               static_cast<std::size_t>(length) - 1);
  if (start[value.size()] != 0) return refuse(field, "does not end with NUL");
  if (value.empty() && !may_be_empty) return refuse(field, "must not be empty");
  const char* fault = text_fault(value, max_bytes);
  return !fault || refuse(field, fault);
}

}  // namespace anchord
