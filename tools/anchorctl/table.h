#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace anchord {

/// What is written on: a terminal or not.
struct Style {
  bool color = false;  ///< escape sequences for bold and dim
  int width = 0;       ///< columns; 0: any number
  int height = 0;      ///< lines; 0: any number
};

/// `text` as one word: a cell that wraps keeps it together.
std::string glued(std::string text);

/// `line` in bold, or dim, where the style has colours.
std::string bold(const std::string& line, const Style& style);
std::string dim(const std::string& line, const Style& style);

/// `line` in at most `width` columns, with "…" at its end if something is missing; 0: all of it.
/// It may hold no escape sequences. Every code point counts as one column.
std::string cut(const std::string& line, int width);

/// Aligned columns, two spaces apart. Where the style's width is too small, the columns that may
/// wrap do, the widest first; what is still too long is cut.
class Table {
 public:
  struct Column {
    std::string header;
    bool wraps = false;
  };
  explicit Table(std::vector<Column> columns);

  /// One row: a cell for each column. `faint` ones are dim where there are colours.
  void add(std::vector<std::string> cells, bool faint = false);
  bool empty() const { return rows_.empty(); }

  /// The header (if any column has one) and the rows, each line with its end.
  std::string text(const Style& style) const;

 private:
  struct Row {
    std::vector<std::string> cells;
    bool faint;
  };
  std::vector<std::size_t> widths(int available) const;
  std::vector<std::string> lines(const std::vector<std::string>& cells,
                                 const std::vector<std::size_t>& widths) const;

  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace anchord
