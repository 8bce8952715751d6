#include <fmt/format.h>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// Causes that the catalogue lacks, or was made to lack.
namespace twinbench::hidden {
namespace {

std::string UnlistedRow(const std::string& key, const Outcomes& group) {
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {} |\n", key, group.size(), Percent(ShareOf(group, &Outcome::Detected)),
      WithInterval(ShareOf(group, Graded(Grade::kUnknown))), Count(group, Graded(Grade::kUnknownMisplaced)),
      Count(group, Graded(Grade::kWrong)), Count(group, IsConfidentlyWrong));
}

bool IsStructural(const Outcome& o) {
  return o.confident_wrong && o.confident_alike;
}

std::string LeaveOneOutRow(const std::string& key, const Outcomes& group) {
  const auto answered = [&](diagnose::Verdict verdict) {
    return Count(group, [verdict](const Outcome& o) { return o.verdict == verdict; });
  };
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", key, group.size(),
                     WithInterval(ShareOf(group, IsConfidentlyWrong)), Count(group, IsStructural),
                     answered(diagnose::Verdict::kUnknown), answered(diagnose::Verdict::kTie),
                     answered(diagnose::Verdict::kNone));
}

}  // namespace

std::string UnlistedSection(const Outcomes& all) {
  const Outcomes unlisted = Only(all, [](const Outcome& o) { return !o.hidden.unlisted.empty(); });
  return "## Causes that the catalogue lacks\n\n" +
         TableHead(
             "set | cause | cases | detected | unknown, right lock and channels | unknown, others | named "
             "| stated >= 0.9") +
         RowsBySetAnd([](const Outcome& o) { return o.hidden.unlisted; }, unlisted, UnlistedRow) + "\n";
}

std::string LeaveOneOutSection(const Outcomes& all) {
  const Outcomes excluded = Only(all, IsLeaveOneOut);
  return "## Leave one cause out\n\nThe true cause is excluded from the catalogue; every name is wrong. "
         "`structural`: wrong names that these readings cannot tell from the truth.\n\n" +
         TableHead("cause | cases | named above 0.9 | of these structural | unknown | tie | none") +
         Rows(By(excluded, EffectsOf), LeaveOneOutRow) + LeaveOneOutRow("all", excluded) + "\n";
}

}  // namespace twinbench::hidden
