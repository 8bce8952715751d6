#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// Causes of the catalogue: found, and by their right name?
namespace twinbench::hidden {
namespace {

std::string SetRow(const std::string& set, const Outcomes& group) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", set, group.size(),
                     Percent(ShareOf(group, &Outcome::Detected)), Count(group, Graded(Grade::kRight)),
                     Count(group, Graded(Grade::kTie)), WithInterval(ShareOf(group, &Outcome::RightOrTie)),
                     Count(group, Graded(Grade::kAnsweredUnknown)), Count(group, Graded(Grade::kWrong)),
                     WithInterval(ShareOf(group, IsConfidentlyWrong)));
}

std::string TieSizes(const Outcomes& listed) {
  const auto is_tie = [](const Outcome& o) { return o.verdict == diagnose::Verdict::kTie; };
  const std::vector<double> sizes = Values(Only(listed, is_tie), &Outcome::members);
  return fmt::format("Ties: {}, median size {:.0f}, largest {:.0f}.\n", sizes.size(), Quantile(sizes, 0.5),
                     Quantile(sizes, 1.0));
}

std::string EffectRow(const std::string& key, const Outcomes& group) {
  std::string row = fmt::format("| {} | {} | {}", key, group.size(), Percent(ShareOf(group, &Outcome::Detected)));
  for (const Grade g : {Grade::kRight, Grade::kRightAndMore, Grade::kTie, Grade::kLargeTie, Grade::kPartly,
                        Grade::kAnsweredUnknown, Grade::kWrong, Grade::kMissed})
    row += fmt::format(" | {}", Count(group, Graded(g)));
  return row + " |\n";
}

std::string RhoRow(const std::string& set, double from, double to, const Outcomes& bin) {
  return fmt::format("| {} | {:.0f}-{:.0f} | {} | {} | {} |\n", set, from, to, bin.size(),
                     Percent(ShareOf(bin, &Outcome::Detected)), WithInterval(ShareOf(bin, &Outcome::RightOrTie)));
}

/// One row a range of rho that has cases.
std::string RhoRows(const std::string& set, const Outcomes& group) {
  constexpr std::array kEdges = {0.0, 5.0, 7.0, 10.0, 14.0, 20.0, 31.0};
  std::string rows;
  for (std::size_t k = 0; k + 1 < kEdges.size(); ++k) {
    const double from = kEdges[k], to = kEdges[k + 1];
    const Outcomes bin = Only(group, [&](const Outcome& o) { return o.hidden.rho >= from && o.hidden.rho < to; });
    if (!bin.empty()) rows += RhoRow(set, from, to, bin);
  }
  return rows;
}

}  // namespace

std::string SetSection(const Outcomes& all) {
  const Outcomes listed = Only(all, IsListed);
  return "## Answers by set\n\n" +
         TableHead(
             "set | cases | detected | right name | tie with the truth | right or tie | answered unknown "
             "| wrong name | stated >= 0.9 and wrong") +
         Rows(By(listed, &Outcome::set), SetRow) + "\n" + TieSizes(listed) + "\n";
}

std::string EffectSection(const Outcomes& all) {
  const Outcomes single = Only(all, [](const Outcome& o) { return IsListed(o) && o.hidden.causes.size() == 1; });
  return "## Answers by cause\n\n" +
         TableHead(
             "set | cause | cases | detected | right | right and more | tie | large tie | partly "
             "| answered unknown | wrong | missed") +
         Rows(By(single, WithinSet(EffectsOf)), EffectRow) + "\n";
}

std::string RhoSection(const Outcomes& all) {
  const Outcomes sized = Only(all, [](const Outcome& o) { return IsListed(o) && std::isfinite(o.hidden.rho); });
  return "## Answers by size\n\nrho is the intended length of the signature after projection, in units of "
         "noise.\n\n" +
         TableHead("set | rho | cases | detected | right or tie") + Rows(By(sized, &Outcome::set), RhoRows) + "\n";
}

}  // namespace twinbench::hidden
