#include "twin/diagnose/redundancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/fewest_readings.h"

namespace twinbench::diagnose {
namespace {

constexpr double kFewestShare = 0.01;

std::string Count(int count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

void RefuseTooFew(std::size_t used, std::size_t all) {
  if (used < kFewestToDiagnose)
    throw InputError("readings", fmt::format("{} of {} have a value", used, all),
                     fmt::format("at least {}", kFewestToDiagnose));
}

DesignCount CountDesign(const LinearRun& run, const Eigen::VectorXd& redundancy) {
  Require(redundancy.size() == run.Rows(), "there is a redundancy for every row");
  DesignCount design;
  std::map<int, std::set<int>> passes;
  for (int k = 0; k < run.Rows(); ++k) {
    const auto i = static_cast<std::size_t>(run.ReadingOf(k));
    if (run.schedule.phase[i] != Phase::kFullCircle) continue;
    passes[run.schedule.setup[i]].insert(run.schedule.pass[i]);
    ++design.rows;
    design.redundancy += redundancy[k];
  }
  design.setups = static_cast<int>(passes.size());
  for (const auto& [setup, of_setup] : passes)
    design.passes = std::max(design.passes, static_cast<int>(of_setup.size()));
  return design;
}

void RefuseWithoutRedundancy(const LinearRun& run, const Eigen::VectorXd& redundancy) {
  const DesignCount design = CountDesign(run, redundancy);
  if (design.rows == 0 || design.redundancy >= kFewestShare * design.rows) return;
  throw InputError(
      "readings",
      fmt::format("{} with {} each leave {:.0f} degrees of freedom in {} values: whatever is wrong goes "
                  "into the separated errors and nothing can be found",
                  Count(design.setups, "mounting", "mountings"), Count(design.passes, "pass", "passes"),
                  std::max(design.redundancy, 0.0), design.rows),
      FormatOf(run.bench).smallest_addition(design.setups));
}

}  // namespace twinbench::diagnose
