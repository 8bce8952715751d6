#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The words of SCPI-99 (IEEE 488.2): headers, parameters, the error queue.
namespace twinbench::hw {

/// A program message unit taken apart: "ROT1:ANGL? 2,3".
struct ScpiUnit {
  std::vector<std::string> header;  // "ROT1", "ANGL"; a common command has one, "*IDN"
  bool rooted = false;              // began with ':' or '*'
  bool query = false;
  std::vector<std::string> parameters;
};

/// @return nothing if it is no such unit.
std::optional<ScpiUnit> ParseScpiUnit(const std::string& text);

/// Whether a keyword is the long or the short form (capitals) of `pattern`, in any case. A '#' at the end of the
/// pattern stands for a number (1 if it is left out).
/// @return the number (0 where there is none), or nothing if it does not match.
std::optional<int> MatchKeyword(std::string_view pattern, std::string_view keyword);

/// The same for a header; `pattern` as "ROTation#:ANGLe". @return the number of the keyword that has one, or 0.
std::optional<int> MatchHeader(std::string_view pattern, const std::vector<std::string>& header);

/// What a command did wrong.
struct ScpiError {
  int number;
  std::string detail;
};
const char* ScpiErrorText(int number);

/// Oldest first; when it is full the newest entry says so.
class ScpiErrorQueue {
 public:
  void Add(const ScpiError& error);
  std::string Next();  // "0,\"No error\"" if there is none
  void Clear() { entries_.clear(); }
  bool Empty() const { return entries_.empty(); }

 private:
  std::deque<ScpiError> entries_;
};

}  // namespace twinbench::hw
