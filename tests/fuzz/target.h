#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What the program reads of others, one function each, to be fed with whatever there may be.
namespace twinbench::fuzz {

struct Target {
  const char* name;
  /// Reads `bytes` as a file or as all that a client says. An InputError, a BenchError or, where a header says so, another
  /// std::runtime_error is a right answer and stays within; whatever else leaves it is a fault of ours.
  void (*read)(std::string_view bytes);
  /// Where it begins: files and folders from the root of the sources, separated by blanks; beside them tests/data/fuzz/<name>.
  const char* seeds;
  /// More of them, where it is this program that writes such files; null: none.
  std::vector<std::string> (*made_seeds)() = nullptr;
};

/// All there are.
std::span<const Target> Targets();
/// @return null if there is none of that name.
const Target* TargetOf(std::string_view name);

std::span<const Target> TextTargets();
std::span<const Target> FileTargets();
std::span<const Target> ConversationTargets();
std::span<const Target> JsonTargets();

}  // namespace twinbench::fuzz
