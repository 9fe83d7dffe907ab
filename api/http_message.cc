#include "api/http_message.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "lcmtypes/names.h"

namespace anchord {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Nothing if an escape is broken.
std::optional<std::string> decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
      const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
      if (low < 0) return std::nullopt;
      decoded.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      decoded.push_back(plus_is_space && text[i] == '+' ? ' ' : text[i]);
    }
  }
  return decoded;
}

Result<std::string> decode_part(std::string_view text, bool is_parameter, std::string_view what) {
  auto decoded = decode(text, is_parameter);
  if (!decoded)
    return invalid("target", "has an escape in its " + std::string(what) +
                                 " that is not '%' and two hexadecimal digits");
  if (const char* fault = text_fault(*decoded, text.size()))
    return invalid("target", "its " + std::string(what) + " " + fault);
  return *std::move(decoded);
}

struct Kind {
  int status;
  const char* code;
};

Kind kind_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalid:
      return {400, "invalid"};
    case ErrorCode::kUnknown:
      return {404, "unknown"};
    case ErrorCode::kConflict:
      return {409, "conflict"};
    case ErrorCode::kTooLarge:
      return {413, "too_large"};
    case ErrorCode::kUnavailable:
      return {503, "unavailable"};
    case ErrorCode::kStorage:
      return {507, "insufficient_storage"};
    case ErrorCode::kIo:
      break;
  }
  return {500, "internal"};
}

}  // namespace

Result<HttpTarget> parse_target(std::string_view target) {
  for (std::string_view scheme : {"http://", "https://"}) {
    if (!target.starts_with(scheme)) continue;
    const auto end = target.find_first_of("/?", scheme.size());
    target.remove_prefix(end == std::string_view::npos ? target.size() : end);
    if (target.empty()) target = "/";
    break;
  }
  const auto mark = target.find('?');
  const std::string_view raw_path = target.substr(0, mark);
  if (raw_path != "*" && !raw_path.starts_with('/'))
    return invalid("target", "must begin with '/', as in /v1/objects");
  auto path = decode_part(raw_path, false, "path");
  if (!path) return path.error();
  HttpTarget parsed{*std::move(path), {}};
  if (mark == std::string_view::npos) return parsed;

  std::string_view rest = target.substr(mark + 1);
  while (!rest.empty()) {
    const auto end = rest.find('&');
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (part.empty()) continue;
    const auto equals = part.find('=');
    auto name = decode_part(part.substr(0, equals), true, "parameters");
    if (!name) return name.error();
    auto value =
        decode_part(equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1),
                    true, "parameters");
    if (!value) return value.error();
    parsed.parameters.emplace_back(*std::move(name), *std::move(value));
  }
  return parsed;
}

HttpResponse http_error(int status, std::string_view code, std::string_view message,
                        std::string_view field) {
  nlohmann::ordered_json error = {{"code", code}, {"message", message}};
  if (!field.empty()) error["field"] = field;
  // A message may quote what somebody sent: what is no UTF-8 in it is replaced.
  using Json = nlohmann::ordered_json;
  return {status,
          "application/json",
          Json{{"error", error}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n",
          {}};
}

HttpResponse http_error(const Error& error) {
  const Kind kind = kind_of(error.code);
  return http_error(kind.status, kind.code, error.message, error.field);
}

}  // namespace anchord
