#include <fmt/format.h>

#include <cmath>

#include "tests/foreign/foreign_sections.h"
#include "tests/hidden/outcome_groups.h"

// What the written scenarios are worth.
namespace twinbench::foreign {
namespace {

using hidden::Quantile;
using hidden::TableHead;
using hidden::WithInterval;

std::string SecondRow(const std::string& set, const Answers& group) {
  return fmt::format("| {} | {} | {} |\n", set, group.size(), WithInterval(ShareOf(group, IsAny, IsSilentThen)));
}

bool IsInInterval(const Answer& a) {
  return a.file_gain >= a.stated_interval[0] - kGainTolerance &&
         a.file_gain <= a.stated_interval[1] + kGainTolerance;
}

std::string GainRow(const std::string& set, const Answers& group) {
  std::vector<double> differences, stated, of_file;
  for (const Answer& a : group) {
    differences.push_back(std::abs(a.stated_gain - a.file_gain));
    stated.push_back(a.stated_gain);
    of_file.push_back(a.file_gain);
  }
  return fmt::format("| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", set, group.size(),
                     WithInterval(ShareOf(group, IsAny, GainHolds)), CountOf(group, IsInInterval),
                     Quantile(stated, 0.5), Quantile(of_file, 0.5), Quantile(of_file, 0.1),
                     Quantile(differences, 0.9));
}

}  // namespace

std::string SecondSection(const Answers& answers) {
  return "## Second diagnosis of the same readings with the written scenario\n\n" +
         TableHead("set | scenarios written | silent") + RowsOf(GroupsOf(answers, WasExtended, SetOf), SecondRow) +
         "\n";
}

std::string GainSection(const Answers& answers) {
  return "## Stated gain against the file's\n\nThe file's gain is the share that it explains of what the same "
         "faults "
         "add to the readings of another run, which has other stops, times, tables and room, and no noise. Faults "
         "that another run does not repeat are left out. Interval: the file's gain inside the stated 95 % "
         "interval, "
         "give or take 0.05.\n\n" +
         TableHead(
             "set | cases | within 0.05 | in interval | median stated | median of files | their 10th "
             "percentile | 90th percentile of the difference") +
         RowsOf(GroupsOf(answers, HasGain, SetOf), GainRow) + "\n";
}

}  // namespace twinbench::foreign
