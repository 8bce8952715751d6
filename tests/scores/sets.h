#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What is scored: sets of cases, each made and judged when its turn comes. What a score keeps of each case, in memory
/// and in its file.
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

/// Of `lost` cases that got worse and `won` that got better: how probable so uneven a split is if the change made
/// no difference. Exact and two-sided (McNemar 1947; the binomial with one half).
double McNemar(int lost, int won);

/// One mark of all cases that both scores asked for it.
struct Changes {
  std::vector<std::string> lost, won;  // "hidden rotary_4dof rotary:tone:all:9: <answer now>"
  double p() const { return McNemar(static_cast<int>(std::ssize(lost)), static_cast<int>(std::ssize(won))); }
  /// More lost than won, and no chance at 5 %.
  bool IsWorse() const { return lost.size() > won.size() && p() <= 0.05; }
};

struct Comparison {
  std::array<Changes, kMarkNames.size()> all;
  std::vector<std::pair<std::string, std::array<Changes, kMarkNames.size()>>> of_bench;  // by name
  int only_now = 0, only_before = 0;                                                     // cases
  bool IsWorse() const;  // any mark of all cases together
};
Comparison Compare(const Rows& now, const Rows& before);

std::string InWords(const Comparison& comparison);

/// Counts by set and bench with 95 % intervals, by what is hidden, and the answers that are not right; Markdown.
std::string Summary(const Rows& rows);

struct Plan {
  std::string set, bench, name;
  std::function<void(Row&)> examine;  // fills in what is hidden, the marks and the answer
};
using Plans = std::vector<Plan>;

struct Amount {
  std::uint64_t first_seed = 1;
  bool is_long = false;  // for the night: some four times as much
};

struct Set {
  std::string name, words;
  Plans (*plans)(const std::string& bench, const Amount& amount);
};
const std::vector<Set>& Sets();

Plans HiddenSet(const std::string& bench, const Amount& amount);
Plans ChallengeSet(const std::string& bench, const Amount& amount);
Plans CleanSet(const std::string& bench, const Amount& amount);
Plans UnlistedSet(const std::string& bench, const Amount& amount);
Plans ForeignSet(const std::string& bench, const Amount& amount);
Plans TwoRunsSet(const std::string& bench, const Amount& amount);
Plans OwnScenarioSet(const std::string& bench, const Amount& amount);
Plans InvestigateSet(const std::string& bench, const Amount& amount);
Plans ShelfSet(const std::string& bench, const Amount& amount);

inline void Append(const Plans& more, Plans& plans) {
  plans.insert(plans.end(), more.begin(), more.end());
}

}  // namespace twinbench::scores
