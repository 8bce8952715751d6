#pragma once

#include <map>
#include <string>

/// Which recordings are diagnosed rightly today: tests/data/shelf/right.txt.
namespace twinbench::shelf {

struct Known {
  bool is_right = false;
  bool is_slow = false;  // above some 3 s of a processor: only tests/scores runs it
  bool operator==(const Known&) const = default;
};
/// By the number of the case; one that is not in the list is neither.
using KnownCases = std::map<std::string, Known>;

/// Lines "05 right", "09 slow", "11 right slow"; # begins a comment.
/// @throws InputError with the line that is none.
KnownCases ParseKnownCases(const std::string& text, const std::string& path);
std::string InLines(const KnownCases& known);

KnownCases ReadKnownCases();
void WriteKnownCases(const KnownCases& known);

}  // namespace twinbench::shelf
