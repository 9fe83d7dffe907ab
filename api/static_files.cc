#include "api/static_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

namespace anchord {
namespace {

constexpr char kPolicy[] =
    "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

std::string type_of(std::string_view name) {
  static constexpr std::pair<std::string_view, const char*> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".txt", "text/plain; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"}};
  for (const auto& [end, type] : kTypes)
    if (name.ends_with(end)) return type;
  return "application/octet-stream";
}

/// Tells one content from the next: FNV-1a, 64 bits, and the size.
std::string etag_of(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string tag = "\"";
  for (int shift = 60; shift >= 0; shift -= 4) tag += kDigits[hash >> shift & 15];
  return tag + "-" + std::to_string(bytes.size()) + "\"";
}

bool is_plain(std::string_view name) {
  return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  });
}

struct CloseDirectory {
  void operator()(DIR* directory) const { closedir(directory); }
};

}  // namespace

/// Goes from folder to folder by descriptors, and follows no link.
class FolderReader {
 public:
  explicit FolderReader(StaticFiles& into) : into_(into) {}

  /// Takes `folder`, an open one; `path` is what its files' paths begin with.
  Status read(int folder, const std::string& path, std::size_t depth) {
    const std::unique_ptr<DIR, CloseDirectory> entries(fdopendir(folder));
    if (!entries) {
      close(folder);
      return failed(path);
    }
    while (const dirent* entry = readdir(entries.get())) {
      if (!is_plain(entry->d_name)) continue;
      const int file = openat(dirfd(entries.get()), entry->d_name,
                              O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
      if (file < 0 && (errno == ELOOP || errno == ENXIO)) continue;  // a link; a socket
      if (file < 0) return failed(path + entry->d_name);
      if (Status taken = take(file, path + entry->d_name, depth); !taken) return taken;
    }
    return Done{};
  }

 private:
  static Error failed(const std::string& path) {
    return invalid("", "cannot read " + path + " in it: " + std::strerror(errno));
  }

  /// Takes `file`, an open one, and closes it.
  Status take(int file, const std::string& path, std::size_t depth) {
    struct stat found {};
    if (fstat(file, &found) == 0 && S_ISDIR(found.st_mode) && depth < StaticFiles::kDepth)
      return read(file, path + "/", depth + 1);
    Status taken = Done{};
    if (S_ISREG(found.st_mode)) taken = take_bytes(file, path);
    close(file);
    return taken;
  }

  Status take_bytes(int file, const std::string& path) {
    std::string bytes;
    char piece[64 * 1024];
    for (;;) {
      const ssize_t got = ::read(file, piece, sizeof piece);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return failed(path);
      if (got == 0) break;
      bytes.append(piece, static_cast<std::size_t>(got));
      if (bytes.size() + bytes_ > StaticFiles::kMostBytes)
        return invalid(
            "", "its files have more than " + std::to_string(StaticFiles::kMostBytes) + " bytes");
    }
    bytes_ += bytes.size();
    if (into_.files_.size() == StaticFiles::kMostFiles)
      return invalid("", "has more than " + std::to_string(StaticFiles::kMostFiles) + " files");
    std::string tag = etag_of(bytes);
    into_.files_.emplace(path, StaticFiles::File{type_of(path), std::move(tag), std::move(bytes)});
    return Done{};
  }

  StaticFiles& into_;
  std::size_t bytes_ = 0;
};

Result<StaticFiles> StaticFiles::read(const std::string& folder) {
  const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return invalid(folder, std::string("cannot be read: ") + std::strerror(errno));
  StaticFiles files;
  if (Status taken = FolderReader(files).read(opened, "/", 0); !taken)
    return invalid(folder, taken.error().message);
  return files;
}

const StaticFiles::File* StaticFiles::find(std::string_view path) const {
  auto found = files_.find(path);
  if (path.ends_with('/')) found = files_.find(std::string(path) + "index.html");
  return found == files_.end() ? nullptr : &found->second;
}

std::optional<HttpResponse> StaticFiles::answer(std::string_view path,
                                                std::string_view if_none_match) const {
  const File* file = find(path);
  if (!file) return std::nullopt;
  HttpResponse response{200,
                        file->type,
                        {},
                        {{"ETag", file->etag},
                         {"Cache-Control", "no-cache"},
                         {"X-Content-Type-Options", "nosniff"},
                         {"Referrer-Policy", "no-referrer"},
                         {"Content-Security-Policy", kPolicy}}};
  if (if_none_match == "*" || if_none_match.find(file->etag) != std::string_view::npos)
    response.status = 304;
  else
    response.body = file->bytes;
  return response;
}

}  // namespace anchord
