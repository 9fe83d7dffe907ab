#include "tools/anchor_tune/recording.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "tools/frame_source.h"

namespace anchord::tuning {
namespace {

std::vector<std::string> cells_of(std::string line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// The rows of a CSV file, read by the names of its columns.
class Table {
 public:
  static Result<Table> open(const std::string& path, const std::vector<std::string>& needed) {
    Table table;
    table.path_ = path;
    table.file_.open(path);
    std::string line;
    if (!table.file_ || !std::getline(table.file_, line))
      return Error{ErrorCode::kIo, "", path + " cannot be read"};
    table.columns_ = cells_of(line);
    for (const std::string& name : needed)
      if (table.column(name) < 0) return invalid(path + ":1", "has no column \"" + name + "\"");
    return table;
  }

  /// Whether there is one more row; empty lines are passed over.
  bool next() {
    std::string line;
    do {
      if (!std::getline(file_, line)) return false;
      ++line_;
    } while (line.find_first_not_of(" \r\t") == std::string::npos);
    cells_ = cells_of(line);
    return true;
  }

  bool has(const std::string& name) const { return column(name) >= 0; }

  std::string text(const std::string& name) const {
    const int at = column(name);
    return at >= 0 && at < static_cast<int>(cells_.size()) ? cells_[at] : "";
  }

  template <typename Number>
  Result<Number> number(const std::string& name) const {
    const std::string cell = text(name);
    Number value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    bool good = error == std::errc() && end == cell.data() + cell.size();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good) return invalid(position(), "\"" + cell + "\" is no number (column " + name + ")");
    return value;
  }

  std::string position() const { return path_ + ":" + std::to_string(line_); }

 private:
  int column(const std::string& name) const {
    const auto it = std::find(columns_.begin(), columns_.end(), name);
    return it == columns_.end() ? -1 : static_cast<int>(it - columns_.begin());
  }

  std::string path_;
  std::ifstream file_;
  std::vector<std::string> columns_, cells_;
  std::size_t line_ = 1;
};

Result<TruthRow> row_of(const Table& table) {
  TruthRow row;
  row.id = table.text("id");
  row.class_name = table.text("class");
  int i = 0;
  for (const char* axis : {"x", "y", "z"}) {
    if (!table.has(axis)) continue;
    const auto value = table.number<double>(axis);
    if (!value) return value.error();
    row.position[i++] = *value;
  }
  if (table.has("ignore")) {
    const auto ignore = table.number<int>("ignore");
    if (!ignore) return ignore.error();
    row.neutral = *ignore != 0;
  }
  return row;
}

}  // namespace

Result<std::vector<Frame>> read_frames(const std::string& path, int dims) {
  auto source = FrameSource::open(path, dims);
  if (!source) return source.error();
  std::vector<Frame> frames;
  while (true) {
    auto next = (*source)->next();
    if (!next)
      return Error{next.error().code, "", (*source)->position() + ": " + next.error().text()};
    if (!*next) break;
    if (auto* frame = std::get_if<Frame>(&**next)) frames.push_back(std::move(*frame));
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const Frame& a, const Frame& b) { return a.utime < b.utime; });
  return frames;
}

Result<Truth> read_truth(const std::string& truth, const std::string& index) {
  auto stamps = Table::open(index, {"utime", "frame"});
  if (!stamps) return stamps.error();
  Truth out;
  std::map<std::int64_t, Utime> utime_of;
  while (stamps->next()) {
    const auto utime = stamps->number<Utime>("utime");
    const auto frame = stamps->number<std::int64_t>("frame");
    if (!utime) return utime.error();
    if (!frame) return frame.error();
    utime_of[*frame] = *utime;
    out[*utime];
  }
  auto rows = Table::open(truth, {"frame", "id", "x", "y"});
  if (!rows) return rows.error();
  while (rows->next()) {
    const auto frame = rows->number<std::int64_t>("frame");
    if (!frame) return frame.error();
    const auto at = utime_of.find(*frame);
    if (at == utime_of.end())
      return invalid(rows->position(),
                     "frame " + std::to_string(*frame) + " is not in the index " + index);
    auto row = row_of(*rows);
    if (!row) return row.error();
    out[at->second].push_back(*std::move(row));
  }
  return out;
}

}  // namespace anchord::tuning
