#include "knowledge/configuration_file.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "knowledge/json_reader.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t kLargestFile = 4'000'000;  // bytes
constexpr int kDeepest = 40;                        // nesting: merging and copying recurse
constexpr std::size_t kMostIncludes = 100;

/// Stops the parser; what() says why.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Refuses what a JSON parser lets pass: keys that stand twice in an object, and deep nesting.
class Strictness {
 public:
  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    if (depth > kDeepest) throw Refused("is nested more than 40 deep");
    if (event == json::parse_event_t::object_start) keys_.emplace_back();
    if (event == json::parse_event_t::object_end) keys_.pop_back();
    if (event == json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!keys_.back().insert(key).second) {
        throw Refused("the key \"" + key.substr(0, 100) + "\" stands twice in one object");
      }
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

/// Without the parser's own code in brackets.
std::string readable(const std::string& what) {
  const std::size_t end = what.find("] ");
  return what.rfind("[json.", 0) == 0 && end != std::string::npos ? what.substr(end + 2) : what;
}

/// Puts `over` over `under`: objects merge, the arrays `places` are joined, else `over` wins.
void merge(json& under, const json& over, bool top) {
  for (const auto& [key, value] : over.items()) {
    const auto member = under.find(key);
    if (member == under.end()) {
      under[key] = value;
    } else if (member->is_object() && value.is_object()) {
      merge(*member, value, false);
    } else if (top && key == "places" && member->is_array() && value.is_array()) {
      member->insert(member->end(), value.begin(), value.end());
    } else {
      *member = value;
    }
  }
}

class Loader {
 public:
  explicit Loader(ConfigurationMistakes& mistakes) : mistakes_(mistakes) {}

  /// `said_at` is the path of the include that asks for the file; empty for the first.
  std::optional<json> file(const fs::path& path, const std::string& said_at) {
    std::error_code error;
    const fs::path name = fs::weakly_canonical(path, error);
    if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
      return refuse(said_at, path.string() + " includes itself");
    }
    if (!loaded_.insert(name).second) return json::object();
    if (loaded_.size() > kMostIncludes) return refuse(said_at, "leads to over 100 files");
    if (!fs::is_regular_file(path, error)) {
      return refuse(said_at, path.string() + (fs::exists(path, error) ? " is no regular file"
                                                                      : " does not exist"));
    }
    if (fs::file_size(path, error) > kLargestFile || error) {
      return refuse(said_at, path.string() + " has over 4 MB; a configuration is smaller");
    }
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    if (!stream) return refuse(said_at, path.string() + " cannot be read");
    open_.push_back(name);
    const fs::path parent = path.parent_path();
    auto document =
        text(content.str(), parent.empty() ? "." : parent, path.string() + ": ", said_at);
    open_.pop_back();
    return document;
  }

  /// `source` begins each message about the text.
  std::optional<json> text(std::string_view content, const fs::path& directory,
                           const std::string& source, const std::string& said_at) {
    if (content.size() > kLargestFile) return refuse(said_at, source + "has over 4 MB");
    json document;
    Strictness strictness;
    try {
      document = json::parse(content, std::ref(strictness), true, /*ignore_comments=*/true);
    } catch (const json::exception& error) {
      return refuse(said_at, source + readable(error.what()));
    } catch (const Refused& refused) {
      return refuse(said_at, source + refused.what());
    }
    if (!document.is_object()) {
      return refuse(said_at, source + "must be one object {...}");
    }
    const auto include = document.find("include");
    if (include == document.end()) return document;
    json merged = json::object();
    const bool complete = take_in(*include, directory, source, merged);
    document.erase(include);
    merge(merged, document, true);
    if (!complete) return std::nullopt;
    return merged;
  }

 private:
  /// Merges the files that `include` names; false where one of them cannot be had.
  bool take_in(const json& include, const fs::path& directory, const std::string& source,
               json& merged) {
    const bool single = include.is_string();
    const json list = single ? json::array({include}) : include;
    if (!list.is_array()) {
      refuse("include", source + "must be a path or an array of paths");
      return false;
    }
    bool complete = true;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string said_at = single ? "include" : "include[" + std::to_string(i) + "]";
      if (!list[i].is_string() || list[i].get_ref<const std::string&>().empty()) {
        refuse(said_at, source + "must be a path");
        complete = false;
      } else if (directory.empty()) {
        refuse(said_at, "files can be included from a file only");
        complete = false;
      } else if (const auto below = file(directory / list[i].get<std::string>(), said_at)) {
        merge(merged, *below, true);
      } else {
        complete = false;
      }
    }
    return complete;
  }

  std::nullopt_t refuse(const std::string& path, std::string message) {
    mistakes_.push_back({path, std::move(message)});
    return std::nullopt;
  }

  ConfigurationMistakes& mistakes_;
  std::vector<fs::path> open_;  // the files that are being read, each included by the one before
  std::set<fs::path> loaded_;
};

}  // namespace

std::optional<json> load_document(const fs::path& file, ConfigurationMistakes& mistakes) {
  return Loader(mistakes).file(file, "");
}

std::optional<json> load_document(std::string_view text, const fs::path& directory,
                                  ConfigurationMistakes& mistakes) {
  return Loader(mistakes).text(text, directory, "", "");
}

}  // namespace anchord
