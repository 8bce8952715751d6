#pragma once

#include <string>
#include <vector>

namespace twinbench::report {

/// Letters of a line of text as a terminal counts them: UTF-8, one column a character.
std::size_t WidthOf(const std::string& text);

/// The words of `text` in lines of at most `width` letters; a longer word stands alone. No line is empty.
std::vector<std::string> Lines(const std::string& text, std::size_t width);

/// Lines of at most `width` letters with `indent` blanks before each, the first one aside that begins with `head`.
std::string Paragraph(const std::string& head, const std::string& text, std::size_t indent, std::size_t width);

struct TextColumn {
  std::string title;
  bool is_number = false;  // to the right
  bool is_whole = false;   // broken only when the others are as narrow as they may be
};

/// A table of aligned columns. A cell may hold several lines; where the table is wider than `width`, the widest
/// column is broken at words until it fits. Columns whose cells are all empty are left out.
/// @param rows  A cell a column; a row of fewer cells has empty ones at its end.
/// @return titles, a line of `-`, rows; "" without rows.
std::string TextTable(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                      std::size_t width);

}  // namespace twinbench::report
