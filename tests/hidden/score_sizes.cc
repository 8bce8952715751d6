#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// Fitted parameters of causes that were named rightly, against their truth.
namespace twinbench::hidden {
namespace {

using Checks = std::vector<ParameterCheck>;

/// Values with an uncertainty, by set and by parameter.
std::map<std::string, Checks> ChecksByKey(const Outcomes& outcomes) {
  std::map<std::string, Checks> checks;
  for (const Outcome* o : outcomes) {
    for (const ParameterCheck& p : o->parameters) {
      if (!std::isfinite(p.u)) continue;
      checks[o->set + " | all"].push_back(p);
      checks[fmt::format("{} | {} {}", o->set, EffectsOf(*o), p.name)].push_back(p);
    }
  }
  return checks;
}

double MedianRatio(const Checks& checks) {
  std::vector<double> ratios;
  for (const ParameterCheck& p : checks) ratios.push_back((p.truth + p.Error()) / p.truth);
  return Quantile(ratios, 0.5);
}

std::string SizeRow(const std::string& key, const Checks& checks) {
  const auto covered = std::ranges::count_if(checks, &ParameterCheck::Covers);
  return fmt::format("| {} | {} | {} | {:.3f} |\n", key, checks.size(),
                     WithInterval({static_cast<int>(covered), static_cast<int>(checks.size())}),
                     MedianRatio(checks));
}

}  // namespace

std::string SizeSection(const Outcomes& all) {
  std::string text = "## Sizes of the causes found\n\n" +
                     TableHead("set | parameter | values | truth within 95 % interval | median value/truth");
  for (const auto& [key, checks] : ChecksByKey(Only(all, std::not_fn(IsLeaveOneOut)))) text += SizeRow(key, checks);
  return text + "\n";
}

}  // namespace twinbench::hidden
