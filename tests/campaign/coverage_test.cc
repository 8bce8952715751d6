#include <gtest/gtest.h>

#include "twin/campaign/summary.h"

/// Whether the stated 95 % intervals hold the truth, on every bench: the studies of scenarios/studies/, fewer trials of them
/// (docs/campaign.md has the figures of all), with the standards' errors drawn where that takes little time.
namespace twinbench::campaign {
namespace {

struct Covered {
  const char* study;
  int trials;
  std::vector<std::string> set;  // besides
  bool standards;
  std::vector<std::string> results;  // that the bench is built for
};

class Coverage : public testing::TestWithParam<Covered> {};

/// Numbers of one trial go together (one draw of a gain moves all), so that few trials leave a share that wanders by
/// several percent; what is wrong by a factor of 1.5 covers 81 %.
TEST_P(Coverage, IsThatOfTheStatedIntervals) {
  Study study = LoadStudy(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/studies/" + GetParam().study);
  study.set.insert(study.set.end(), GetParam().set.begin(), GetParam().set.end());
  study.standards = GetParam().standards;
  const Design design(study);
  Summary summary;
  for (int trial = 0; trial < GetParam().trials; ++trial) summary.Add(RunTrial(study, design, trial));
  EXPECT_TRUE(summary.Lost().empty());
  const auto results = summary.Results();
  for (const std::string& name : GetParam().results) {
    ASSERT_TRUE(results.contains(name)) << name;
    EXPECT_GT(results.at(name).coverage95, 0.87) << name;
    EXPECT_LT(results.at(name).coverage95, 0.995) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryBench, Coverage,
    testing::Values(
        Covered{"coverage_rotary.toml", 40, {}, true, {"score.target.ez_arcsec[]", "score.reference.dy_um[]"}},
        Covered{"coverage_turntable.toml", 60, {}, true, {"score.turntable.ez_arcsec[]", "score.equation 5.ez_arcsec[]"}},
        Covered{"coverage_hob.toml", 4, {}, true, {"score.transmission +1.amplitude_arcsec[]"}},
        Covered{"coverage_circular.toml", 3, {"circular_procedure.points=24"}, false, {"score.path[].dx_um[]"}},
        Covered{"coverage_freeform.toml", 3, {}, false, {"score.error_map.dx_um[]"}},
        Covered{"coverage_encoder.toml", 40, {}, false, {"score.device.ez_arcsec[]"}}),
    [](const auto& of) {
      const std::string study = of.param.study;
      return study.substr(study.find('_') + 1, study.find('.') - study.find('_') - 1);
    });

}  // namespace
}  // namespace twinbench::campaign
