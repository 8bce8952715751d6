#include <fmt/format.h>

#include <algorithm>

#include "tests/foreign/foreign_sections.h"

// What was answered, against what is so.
namespace twinbench::foreign {
namespace {

using hidden::TableHead;
using hidden::WithInterval;

std::string SummaryRow(const std::string& what, const std::string& asked, const hidden::Share& share) {
  return fmt::format("| {} | {} | {} |\n", what, asked, WithInterval(share));
}

std::string KindRow(const std::string& key, const Answers& group) {
  const int cases = static_cast<int>(std::ssize(group));
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", key, cases, cases - CountOf(group, IsAlarm),
                     CountOf(group, IsUnknown), CountOf(group, NamesNear), CountOf(group, IsNamedWrongly),
                     CountOf(group, IsWrongSurely));
}

std::string KindOf(const Answer& a) {
  return a.set + " | " + a.truth.kind;
}

std::string StressOf(const Answer& a) {
  return a.set + " | " + a.truth.stress;
}

std::string SeveralRow(const std::string& set, const Answers& group) {
  const auto one = std::ranges::count(group, 1, &Answer::missing);
  const hidden::Share whole = ShareOf(group, IsAny, SaysAll);
  return fmt::format("| {} | {} | {} | {} | {} | {} |\n", set, group.size(), WithInterval(whole), one,
                     whole.of - whole.count - one, CountOf(group, IsWrongSurely));
}

std::string CleanRow(const std::string& key, const Answers& group) {
  return fmt::format("| {} | {} | {} | {} |\n", key, group.size(), WithInterval(ShareOf(group, IsAny, IsAlarm)),
                     CountOf(group, IsSureAlarm));
}

}  // namespace

std::string SummarySection(const Answers& all) {
  struct Asked {
    const char *what, *limit;
    Condition of, holds;
  };
  const std::vector<Asked> table = {
      {"a name that is not there, stated at 0.8 or more", "<= 3 %", IsFaulty, IsWrongSurely},
      {"the same at 0.9 or more", "", IsFaulty, IsWrongVerySurely},
      {"warm-up, touch, speed bias, both distances named wrongly", "0", MayNeverBeWrong, IsNamedWrongly},
      {"several causes: all found or said", ">= 90 %", HasSeveral, SaysAll},
      {"alarms on machines in order", "<= 1 %", IsClean, IsAlarm},
      {"the same stated at 0.9 or more", "0", IsClean, IsSureAlarm},
      {"second diagnosis with the written file silent", ">= 98 %", WasExtended, IsSilentThen},
      {"stated gain within 0.05 of the file's on another run", "all", HasGain, GainHolds}};
  std::string text = "## Against what is asked\n\n" + TableHead("what | asked | is");
  for (const Asked& row : table) text += SummaryRow(row.what, row.limit, ShareOf(all, row.of, row.holds));
  return text + "\n";
}

std::string KindSection(const Answers& answers) {
  return "## Causes that the catalogue lacks\n\nnear: a name in the answer that is honest, if not the cause. "
         "wrong: a name that is neither, at 0.5 or more, or a tie of such.\n\n" +
         TableHead("set | cause | cases | silent | unknown | near | wrong | wrong at 0.8") +
         RowsOf(GroupsOf(answers, IsSingleKind, KindOf), KindRow) + "\n";
}

std::string SeveralSection(const Answers& answers) {
  return "## Several causes at once\n\nEach must be named, be among what a named one cannot be told from, or have "
         "an unknown part of its own.\n\n" +
         TableHead("set | cases | all found or said | one missing | more missing | wrong at 0.8") +
         RowsOf(GroupsOf(answers, HasSeveral, SetOf), SeveralRow) + "\n";
}

std::string CleanSection(const Answers& answers) {
  return "## Machines in order, under stress\n\n" +
         TableHead("set | what is unusual | runs | alarms | at 0.9 or more") +
         RowsOf(GroupsOf(answers, IsClean, StressOf), CleanRow) +
         RowsOf(GroupsOf(answers, IsClean, [](const Answer& a) { return a.set + " | all"; }), CleanRow) + "\n";
}

}  // namespace twinbench::foreign
