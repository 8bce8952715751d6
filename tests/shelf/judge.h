#pragma once

#include "tests/shelf/truth.h"

/// A diagnosis held against what is known to be in a recording; and recordings as people have them, imported by a
/// plain guess, then diagnosed, as the two commands do it.
namespace twinbench::shelf {

inline constexpr double kNamed = 0.5;  // a cause, with all that these readings cannot tell from it
inline constexpr double kSure = 0.8;   // from here on what is not there must not be said

struct Judged {
  bool is_right = false;
  bool is_sure_wrong = false;  // something is stated as sure that is not there
  std::string why;             // in words, of what is not right; empty if all is
};

/// Right if every cause above a twentieth of the variance is named - alone or in a tie, that is named together -
/// with its size within three standard uncertainties or 5 % (10 % where the truth is approximate), or is told of as
/// an unmodelled part if the catalogue lacks it; and if nothing else is stated as sure. The size of a cause of a
/// tie that is told without one is not asked for. Of readings in which nothing is, nothing may be named.
Judged Judge(const Truth& truth, const diagnose::Diagnosis& diagnosis);

/// "latency", "order 4", "direction times order 72".
std::string InWords(const Expected& expected);
std::string InWords(const Truth& truth);

/// Numbers of the files in tests/data/shelf, in order.
std::vector<std::string> CaseNames();

struct Answer {
  Judged judged;
  std::string truth, words;  // in words; of a file that is refused, why
  std::optional<std::string>
      second;  // what a second diagnosis with the written file says; nothing: it was not asked
};

/// @param asks_again  Diagnose the same readings with the written file, with thresholds that are kept.
Answer Examine(const std::string& name, bool asks_again);

}  // namespace twinbench::shelf

