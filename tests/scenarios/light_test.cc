#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"

// Light is traced unless a scenario says otherwise, and traced light says what the formula says.
namespace twinbench {
namespace {

std::vector<std::string> RotaryScenarios() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(test::ScenarioPath(""))) {
    if (entry.path().extension() != ".toml") continue;
    if (LoadScenario(entry.path()).bench == kRotaryBench) names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class RotaryLight : public ::testing::TestWithParam<std::string> {};

TEST_P(RotaryLight, IsTracedByDefaultAndAgreesWithTheClosedFormToANanometre) {
  Scenario scenario = LoadScenario(test::ScenarioPath(GetParam()));
  scenario.noise_free = true;
  ASSERT_EQ(RotaryOf(scenario).optics.fidelity, "traced");
  const test::TwinRun traced = test::RunTwin(scenario);
  // The chief ray alone is four: to the grating among all that rides on it and all that stands in the laboratory,
  // and two orders from there.
  EXPECT_GE(traced.rays_traced, 4u * traced.readings.size());

  RotaryOf(scenario).optics.fidelity = "closed";
  const test::TwinRun closed = test::RunTwin(scenario);
  EXPECT_EQ(closed.rays_traced, 0u);

  // What a rounding turns over: one code of one conversion in a block's mean.
  const AdcSettings& adc = RotaryOf(scenario).adc;
  const double code_V = 2.0 * adc.range_V / (1 << adc.bits) / adc.samples;
  const double one_nm_V = units::nm * RotaryOf(scenario).psd_a.sensitivity_V_m;
  ASSERT_EQ(traced.readings.size(), closed.readings.size());
  for (std::size_t k = 0; k < closed.readings.size(); ++k) {
    ASSERT_EQ(traced.readings[k].status, closed.readings[k].status);
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(traced.readings[k].mean_V[c], closed.readings[k].mean_V[c], one_nm_V + code_V) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(InFolder, RotaryLight, ::testing::ValuesIn(RotaryScenarios()), [](const auto& param_info) {
  return param_info.param.substr(0, param_info.param.find('.'));
});

}  // namespace
}  // namespace twinbench
