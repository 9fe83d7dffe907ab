#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "api/http_message.h"
#include "core/result.h"

namespace anchord {

/// The files of a folder as they were when it was read: served from memory and by exact name, so
/// that no request's path ever reaches the file system.
class StaticFiles {
 public:
  static constexpr std::size_t kMostFiles = 1024, kMostBytes = 32 << 20, kDepth = 8;

  /// No files.
  StaticFiles() = default;
  /// Reads a folder and those in it. Left out are links, whatever they point to, what is no regular
  /// file, folders kDepth deep, and names that begin with a dot or have characters other than
  /// letters, digits and
  /// `._-`. Errors (kInvalid): it cannot be read, or is over a limit (kMostBytes: all together).
  static Result<StaticFiles> read(const std::string& folder);

  std::size_t size() const { return files_.size(); }
  /// Whether there is a file of this path: "/a/b.js"; for a folder, "/a/", its index.html.
  bool has(std::string_view path) const { return find(path) != nullptr; }
  /// The file with its type and ETag, and what keeps a browser from making more of it than that (no
  /// sniffing, a policy by which pages load and ask nothing but this server). 304 where
  /// `if_none_match`, that field's value, has its ETag. Nothing where there is no such file.
  std::optional<HttpResponse> answer(std::string_view path, std::string_view if_none_match) const;

 private:
  struct File {
    std::string type, etag, bytes;
  };
  const File* find(std::string_view path) const;

  std::map<std::string, File, std::less<>> files_;
  friend class FolderReader;
};

}  // namespace anchord
