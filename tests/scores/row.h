#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

/// What a score keeps of each case, in memory and in its file.
namespace twinbench::scores {

/// What is asked of an answer.
enum Mark { kRight, kSureWrong, kSecondSilent, kSecondRunSilent, kGainRight };
inline constexpr std::array<const char*, 5> kMarkNames = {"right", "sure_wrong", "second_silent",
                                                          "second_run_silent", "gain_right"};
/// Of a name that is not there that is good news if it is not so.
inline bool IsGood(std::size_t mark, bool is_so) {
  return is_so != (mark == kSureWrong);
}

struct Row {
  std::string set, bench, name;                                   // without quotes or line ends
  std::string hidden = {};                                        // in words; "none"
  std::array<std::optional<bool>, kMarkNames.size()> marks = {};  // nothing: not asked of this case
  std::string answer = {};                                        // in words, short
  double seconds = 0.0;                                           // of one processor

  std::string Key() const { return set + "," + bench + "," + name; }
};
using Rows = std::vector<Row>;

/// As a field between quotes can hold it.
std::string Unquoted(std::string text);

/// One row a case below a line of names; all but the seconds are the same for the same seed.
std::string Csv(const Rows& rows);

/// @param path  For messages.
/// @throws InputError with the line that is no row, or if two rows are of one case.
Rows ParseRows(const std::string& text, const std::string& path);
/// @throws InputError if it cannot be read.
Rows ReadRows(const std::string& path);

/// Beside the file, then renamed: who reads it sees the old or the new one.
void WriteWhole(const std::string& path, const std::string& text);

}  // namespace twinbench::scores
