#include <fmt/format.h>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// How long a diagnosis takes.
namespace twinbench::hidden {
namespace {

std::string TimeRow(const std::string& set, const Outcomes& group) {
  const std::vector<double> seconds = Values(group, &Outcome::seconds);
  return fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |\n", set, Quantile(seconds, 0.5), Quantile(seconds, 0.95),
                     Quantile(seconds, 1.0));
}

}  // namespace

std::string TimeSection(const Outcomes& all) {
  return "## Time of one diagnosis\n\n" + TableHead("set | median [s] | 95th percentile [s] | longest [s]") +
         Rows(By(all, &Outcome::set), TimeRow) + "\n";
}

}  // namespace twinbench::hidden
