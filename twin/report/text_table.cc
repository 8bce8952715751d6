#include "twin/report/text_table.h"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace twinbench::report {
namespace {

constexpr const char* kGap = "  ";
constexpr std::size_t kNarrow = 24;     // as far as other columns give way to whole ones
constexpr std::size_t kNarrowest = 12;  // no column is broken below this

using Row = std::vector<std::string>;

std::vector<std::string> SplitLines(const std::string& cell) {
  std::vector<std::string> lines;
  std::istringstream in(cell);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::size_t WidestLine(const std::string& cell) {
  std::size_t widest = 0;
  for (const std::string& line : SplitLines(cell)) widest = std::max(widest, WidthOf(line));
  return widest;
}

/// The lines of a cell as they fit into its column; what stands in for a blank line stays indented.
std::vector<std::string> Fitted(const std::string& cell, std::size_t width) {
  std::vector<std::string> fitted;
  for (const std::string& line : SplitLines(cell)) {
    const std::string indent(std::min(line.find_first_not_of(' '), width / 2), ' ');
    for (const std::string& part : Lines(line, width - indent.size())) fitted.push_back(indent + part);
  }
  return fitted;
}

std::string Padded(const std::string& text, std::size_t width, bool is_number) {
  const std::string blanks(width - std::min(width, WidthOf(text)), ' ');
  return is_number ? blanks + text : text + blanks;
}

std::string WithoutTail(const std::string& line) {
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

class Layout {
 public:
  Layout(std::vector<TextColumn> columns, std::vector<Row> rows)
      : columns_(std::move(columns)), rows_(std::move(rows)) {
    for (Row& row : rows_) row.resize(columns_.size());
    DropEmpty();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      width_.push_back(WidthOf(columns_[k].title));
      for (const Row& row : rows_) width_[k] = std::max(width_[k], WidestLine(row[k]));
    }
  }

  void FitInto(std::size_t width) {
    Narrow(width, kNarrow, false);
    Narrow(width, kNarrowest, true);
  }

  std::string Text() const {
    Row titles;
    for (const TextColumn& column : columns_) titles.push_back(column.title);
    std::string text = TextOf(titles) + std::string(Total(), '-') + "\n";
    for (const Row& row : rows_) text += TextOf(row);
    return text;
  }

 private:
  /// Takes what is too much from the widest column, then from the next.
  void Narrow(std::size_t width, std::size_t narrowest, bool whole_ones_too) {
    for (std::size_t k = 0; k < width_.size() && Total() > width; ++k) {
      std::size_t widest = 0, at = width_.size();
      for (std::size_t i = 0; i < width_.size(); ++i) {
        if ((columns_[i].is_whole && !whole_ones_too) || width_[i] <= std::max(narrowest, widest)) continue;
        widest = width_[i];
        at = i;
      }
      if (at == width_.size()) return;
      const std::size_t too_much = Total() - width;
      width_[at] = std::max(narrowest, widest - std::min(widest, too_much));
    }
  }

  void DropEmpty() {
    for (std::size_t k = columns_.size(); k-- > 0;) {
      if (std::ranges::any_of(rows_, [k](const Row& row) { return !row[k].empty(); })) continue;
      columns_.erase(columns_.begin() + static_cast<std::ptrdiff_t>(k));
      for (Row& row : rows_) row.erase(row.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

  std::size_t Total() const {
    const std::size_t gaps = std::string(kGap).size() * (width_.size() - 1);
    return std::accumulate(width_.begin(), width_.end(), gaps);
  }

  std::string TextOf(const Row& row) const {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
      cells.push_back(Fitted(row[k], width_[k]));
      height = std::max(height, cells.back().size());
    }
    std::string text;
    for (std::size_t i = 0; i < height; ++i) {
      std::string line;
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::string cell = i < cells[k].size() ? cells[k][i] : "";
        line += (k > 0 ? kGap : "") + Padded(cell, width_[k], columns_[k].is_number);
      }
      text += WithoutTail(line);
    }
    return text;
  }

  std::vector<TextColumn> columns_;
  std::vector<Row> rows_;
  std::vector<std::size_t> width_;
};

}  // namespace

std::size_t WidthOf(const std::string& text) {
  // Every byte of UTF-8 but the continuations, 10xxxxxx, begins a character.
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<std::string> Lines(const std::string& text, std::size_t width) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string word; in >> word;) {
    if (lines.empty() || WidthOf(lines.back()) + 1 + WidthOf(word) > width)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  }
  return lines;
}

std::string Paragraph(const std::string& head, const std::string& text, std::size_t indent, std::size_t width) {
  std::string paragraph;
  for (const std::string& line : Lines(text, width - indent))
    paragraph += (paragraph.empty() ? Padded(head, indent, false) : std::string(indent, ' ')) + line + "\n";
  return paragraph;
}

std::string TextTable(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                      std::size_t width) {
  if (rows.empty()) return "";
  Layout layout(columns, rows);
  layout.FitInto(width);
  return layout.Text();
}

}  // namespace twinbench::report
