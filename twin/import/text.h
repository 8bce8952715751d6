#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Text files of unknown making: bytes, lines, fields.
namespace twinbench::imports {

/// The whole file as UTF-8 without a byte order mark; UTF-16, and bytes that are no UTF-8 (Latin 1), are translated.
/// @throws InputError if it cannot be read, is empty or is no text.
std::string LoadText(const std::string& path);

/// Takes lines off a text one by one; without their ends, whichever of the three kinds they have.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool Next(std::string_view& line);
  int Number() const { return number_; }  // of the line that was taken last, from 1

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// How fields stand in a line.
struct Fields {
  char separator = ',';  // ' ': any run of blanks
  bool decimal_comma = false;
};

/// @param fields  Filled anew; views into `line`, without blanks and quotes around them.
void Split(std::string_view line, char separator, std::vector<std::string_view>& fields);

std::string_view Trimmed(std::string_view text);

/// The number that a field is, all of it; nothing if it is none or not finite. Marks of thousands are taken where a
/// decimal mark leaves no doubt: "1.234,5", "1,234.5", "1 234,5".
std::optional<double> FieldNumber(std::string_view field, bool decimal_comma);

/// A number with a unit in its cell: "12.5 deg", "3 mm", degrees with minutes and seconds ("12° 30' 4.5\"", in deg). The unit
/// is empty of a mere number.
struct Cell {
  double number = 0.0;
  std::string_view unit;
};
std::optional<Cell> CellOf(std::string_view field, bool decimal_comma);

/// Degrees of "123:30:15.5", which may be a time of day as well: what the column is called decides.
std::optional<double> DegreesOfColons(std::string_view field, bool decimal_comma);

/// "tab", "comma", ... of a separator, and back; 0 if there is no such name.
std::string SeparatorName(char separator);
char SeparatorNamed(const std::string& name);

}  // namespace twinbench::imports
