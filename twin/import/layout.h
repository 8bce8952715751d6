#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/import/text.h"

namespace twinbench::imports {

/// [file] of a map: how the text is laid out. What is left open is found from the text itself.
struct Layout {
  std::string kind = "auto";       // table | changes | scope | array | cycles | records
  std::string separator = "auto";  // tab | semicolon | comma | bar | space
  std::string decimal = "auto";    // point | comma
  std::string header;              // what the line of the names begins with; empty: found
  std::string section;             // what a line begins with that opens a part; empty: one part
  std::string moved_by;            // what lines begin with between the rows that say by how much the zero of the readings moved
  std::vector<std::string> names;  // of the columns of a file without names
  std::string array;               // of a program text: the array's name; empty: the longest
  bool columns_are_open = true;    // no map names columns: numbers alone may be a list, runs up and down a positioning test
};

/// Of a text that was written anew with tabs between its fields.
Layout WithTabs(Layout layout);

/// Lines from the beginning, enough to judge by.
std::vector<std::string_view> FirstLines(std::string_view text, std::size_t most = 600);

/// The kind of a text whose map does not say it.
/// @param columns_are_open  See Layout.
std::string FindKind(const std::vector<std::string_view>& lines, bool columns_are_open = true);

/// Separator and decimal mark under which most lines are rows of numbers.
/// @return separator '\0' if no line is.
Fields FindFields(const std::vector<std::string_view>& lines, const Layout& layout);

/// True of a line that is drawn: "|---|---|", "=====".
bool IsRule(std::string_view line);

/// True of a line that is no part of the table.
bool IsComment(std::string_view line);

}  // namespace twinbench::imports
