#include "tools/anchorctl/table.h"

#include <algorithm>
#include <cstdlib>

namespace anchord {
namespace {

constexpr char kGlue = '\x01';  ///< a space at which no cell wraps; printable() lets none in
constexpr std::size_t kGap = 2;

bool starts_code_point(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; }

std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_code_point));
}

/// Breaks at spaces; a word longer than `width` gets a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && columns_of(line) + 1 + columns_of(word) > width) {
      lines.push_back(line);
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  lines.push_back(line);
  return lines;
}

}  // namespace

std::string glued(std::string text) {
  std::replace(text.begin(), text.end(), ' ', kGlue);
  return text;
}

std::string bold(const std::string& line, const Style& style) {
  return style.color ? "\x1b[1m" + line + "\x1b[0m" : line;
}

std::string dim(const std::string& line, const Style& style) {
  return style.color ? "\x1b[2m" + line + "\x1b[0m" : line;
}

std::string cut(const std::string& line, int width) {
  const auto most = static_cast<std::size_t>(std::max(width, 0));
  if (width <= 0 || columns_of(line) <= most) return line;
  std::size_t end = 0;
  for (std::size_t kept = 0; end < line.size(); ++end) {
    if (starts_code_point(line[end]) && ++kept == most) break;
  }
  return line.substr(0, end) + "…";
}

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::add(std::vector<std::string> cells, bool faint) {
  if (cells.size() != columns_.size()) std::abort();
  rows_.push_back({std::move(cells), faint});
}

std::vector<std::size_t> Table::widths(int available) const {
  std::vector<std::size_t> widths, least;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    widths.push_back(columns_of(columns_[i].header));
    least.push_back(widths[i]);
    for (const Row& row : rows_) {
      widths[i] = std::max(widths[i], columns_of(row.cells[i]));
      for (const auto& word : wrapped(row.cells[i], 1)) {
        least[i] = std::max(least[i], columns_of(word));
      }
    }
  }
  if (available <= 0) return widths;
  std::size_t total = kGap * (widths.size() - 1);
  for (const std::size_t width : widths) total += width;
  for (; total > static_cast<std::size_t>(available); --total) {
    std::size_t* widest = nullptr;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const bool may = columns_[i].wraps && widths[i] > least[i];
      if (may && (!widest || widths[i] > *widest)) widest = &widths[i];
    }
    if (!widest) break;
    --*widest;
  }
  return widths;
}

std::vector<std::string> Table::lines(const std::vector<std::string>& cells,
                                      const std::vector<std::size_t>& widths) const {
  std::vector<std::vector<std::string>> parts;
  std::size_t height = 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    parts.push_back(columns_[i].wraps ? wrapped(cells[i], widths[i])
                                      : std::vector<std::string>{cells[i]});
    height = std::max(height, parts.back().size());
  }
  std::vector<std::string> lines(height);
  for (std::size_t row = 0; row < height; ++row) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string part = row < parts[i].size() ? parts[i][row] : "";
      const std::size_t used = columns_of(part);
      lines[row] += part + std::string(widths[i] > used ? widths[i] - used : 0, ' ');
      if (i + 1 < parts.size()) lines[row] += std::string(kGap, ' ');
    }
    lines[row].erase(lines[row].find_last_not_of(' ') + 1);
    std::replace(lines[row].begin(), lines[row].end(), kGlue, ' ');
  }
  return lines;
}

std::string Table::text(const Style& style) const {
  const auto fitted = widths(style.width);
  std::string text;
  std::vector<std::string> headers;
  bool any = false;
  for (const Column& column : columns_) {
    headers.push_back(column.header);
    any |= !column.header.empty();
  }
  if (any) {
    for (const auto& line : lines(headers, fitted)) {
      text += bold(cut(line, style.width), style) + "\n";
    }
  }
  for (const Row& row : rows_) {
    for (const auto& line : lines(row.cells, fitted)) {
      const std::string fitting = cut(line, style.width);
      text += (row.faint ? dim(fitting, style) : fitting) + "\n";
    }
  }
  return text;
}

}  // namespace anchord
