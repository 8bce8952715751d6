#include "tools/twinbench/next_scenarios.h"
#include "tools/twinbench/passing_run.h"
#include "twin/benches/registry.h"
#include "twin/core/estimator.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {
namespace {

const plan::NextRun kAgain = {"again", "the same run once more", {}, plan::kSameKind};
const plan::NextRun kBothWays = {"both-ways", "the circle with passes + - - +", {"turntable_procedure.passes=[1, -1, -1, 1]"}, plan::kSameKind};
const std::vector<plan::NextRun> kThree = {kAgain, kAgain, kBothWays};

Scenario SmallTurntable() {
  return ParseScenario(
      "bench = \"turntable_autocollimator\"\nseed = 7\nrepeat = 4\n[turntable.random]\nez_arcsec = 4.0\n[multitooth]\nteeth = 72\n"
      "tooth_rms_arcsec = 0.4\n[turntable_procedure]\nphases = [\"full_circle\"]\npositions = 12\nshifts_teeth = [0, 6, 30]\n"
      "tilts_arcsec = [40, 70, 20]\n",
      "small", "");
}

TEST(ScenariosOf, AProgrammeAreFurtherRunsOfTheSameBench) {
  const Scenario own = SmallTurntable();
  const std::vector<Scenario> next = ScenariosOf(kThree, own);
  ASSERT_EQ(next.size(), 3u);
  for (std::size_t k = 0; k < next.size(); ++k) {
    EXPECT_EQ(next[k].seed, own.seed) << "another seed is another bench";
    EXPECT_EQ(next[k].repeat, own.repeat + 1 + static_cast<int>(k)) << "and none is the scenario's own run";
  }
}

TEST(ScenariosOf, WhatHasHappenedOnceStaysInTheRunsAfterIt) {
  const Scenario own = Altered(SmallTurntable(), {"effect=[{name=\"slip\", where=\"x\", at_reading=20}]"});
  for (const Scenario& next : ScenariosOf(kThree, own)) EXPECT_EQ(next.effects.front().parameters.at("at_reading"), 0.0);
}

struct Mean {
  double weighted = 0.0, weight = 0.0, truth = 0.0;
};

/// What a plan adds up: own run and programme carried out, their values together by inverse variances.
TEST(ScenariosOf, AProgrammeAddUpToWhatTheirUncertaintiesSayTogether) {
  std::vector<Scenario> runs = ScenariosOf(kThree, SmallTurntable());
  runs.push_back(SmallTurntable());
  std::map<std::string, Mean> means;
  for (const Scenario& run : runs) {
    const Bench& bench = BenchOf(run);
    for (const report::ScoredValue& v : bench.score(run, ReadingsOfTwin(run), bench.make_twin(run)->Truth(), Estimator::kRigorous).values) {
      if (v.name.find("ez_arcsec") == std::string::npos) continue;
      Mean& mean = means.try_emplace(v.name, Mean{0.0, 0.0, v.truth}).first->second;
      mean.weighted += v.value / (v.u * v.u);
      mean.weight += 1.0 / (v.u * v.u);
      EXPECT_NEAR(v.truth, mean.truth, 1e-9) << v.name << ": the same table in every run";
    }
  }
  double chi2 = 0.0;
  for (const auto& [name, m] : means) chi2 += std::pow(m.weighted / m.weight - m.truth, 2) * m.weight;
  ASSERT_EQ(means.size(), 24u);
  // Of 24 values 22 are independent: a standard deviation of 0.3, three of them.
  EXPECT_NEAR(chi2 / 24.0, 1.0, 0.9);
}

}  // namespace
}  // namespace twinbench::tools
