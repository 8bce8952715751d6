#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_case.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"

/// Where a cause shows times its course, against what the twin does when the cause is at work.
namespace twinbench::diagnose::rotary {
namespace {

Scenario BenchOf(const std::string& effect, const std::string& where) {
  Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  scenario.noise_free = true;
  scenario.environment.swing_K = 0.4;
  scenario.environment.swing_period_s = 4000.0;
  if (effect.empty()) return scenario;
  EffectSettings settings;
  settings.name = effect;
  settings.where = where;
  for (const EffectParameter& p : FindEffect(effect, kRotaryBench)->parameters) {
    if (p.BelongsTo(where)) settings.parameters[p.name] = p.default_SI;
  }
  if (effect == "mount_creep") settings.parameters["time_constant"] = 200.0;
  if (effect == "thermal_tilt") settings.parameters["lag"] = 600.0;
  if (effect == "adc_step") settings.parameters["at_voltage"] = 0.02;
  scenario.effects = {settings};
  return scenario;
}

struct Match {
  double cosine2 = 0.0;  // share of the twin's signature that the family has
  Eigen::VectorXd amplitudes;
};

/// Least squares of the twin's difference on each family of that effect and place, after projection; the best.
Match BestMatch(const std::string& effect, const std::string& where) {
  const std::vector<Reading> clean = twinbench::test::RunTwin(BenchOf("", "")).readings;
  const std::vector<Reading> with = twinbench::test::RunTwin(BenchOf(effect, where)).readings;
  const RotaryCase rotary(clean, BenchOf("", ""), {benches::rotary::FollowRecord}, {});
  const LinearRun& run = rotary.Rotary().run;
  const NoiseModel noise{run.sigma, 0.0};
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const RotaryRun disturbed = BuildRun(with, BenchOf("", ""), {benches::rotary::FollowRecord});
  const Eigen::MatrixXd difference = disturbed.run.observed - run.observed;
  const Eigen::MatrixXd y = projector.Apply(noise.Whiten(run, difference));
  Match best;
  for (const Family& family : rotary.Families()) {
    if (family.kind != Kind::kNamed || family.effect != effect || family.where != where) continue;
    for (int g = 0; g < family.grid; ++g) {
      const Eigen::MatrixXd S = projector.Apply(noise.Whiten(run, family.ColumnsAt(g)));
      const Eigen::VectorXd x = SolveShortest(S, Eigen::VectorXd(y.col(0)));
      const double cosine2 = (S * x).squaredNorm() / y.squaredNorm();
      if (cosine2 > best.cosine2) best = {cosine2, x};
    }
  }
  return best;
}

struct EffectCase {
  std::string effect, where;
  double expected;  // first amplitude, SI; NaN: a pair, or one that is drawn
  double least;     // share that must agree: a grid or a second order may cost a little
};

class TwinSignature : public testing::TestWithParam<EffectCase> {};

TEST_P(TwinSignature, IsThatOfTheFamilyOfTheSameName) {
  const auto& [effect, where, expected, least] = GetParam();
  const Match match = BestMatch(effect, where);
  EXPECT_GT(match.cosine2, least) << effect << " " << where;
  if (!std::isfinite(expected)) return;
  EXPECT_NEAR(match.amplitudes[0], expected, 0.06 * std::abs(expected)) << effect;
}

std::vector<EffectCase> Cases() {
  const double arcsec = units::arcsec, um = units::um;
  return {{"psd_gain", "psd_a_x", 0.005, 0.999},
          {"psd_gain", "psd_b_y", 0.005, 0.999},
          {"psd_roll", "psd_a", 5e-3, 0.999},
          {"psd_roll", "psd_b", 5e-3, 0.999},
          {"psd_nonlinearity", "psd_a", 180000.0, 0.999},
          {"stray_light", "psd_b", 0.01, 0.999},
          {"background", "psd_a", 5e-6, 0.999},
          {"psd_distance", "psd_a", 1e-3, 0.999},
          {"wavelength_offset", "", 2e-9, 0.99},
          {"wavelength_temperature", "", 0.25e-9, 0.99},
          {"incidence_offset", "", 5e-3, 0.99},
          {"laser_drift", "yaw", 20e-6 / units::hour, 0.999},
          {"laser_drift", "pitch", 20e-6 / units::hour, 0.999},
          {"mount_creep", "yaw", kNaN, 0.98},
          {"mount_creep", "tilt", kNaN, 0.98},
          {"thermal_tilt", "yaw", 5 * arcsec, 0.99},
          {"thermal_tilt", "tilt", 5 * arcsec, 0.99},
          {"post_growth", "psd_a", 2 * um, 0.99},
          {"post_growth", "psd_b", 2 * um, 0.99},
          {"backlash", "target", 1 * arcsec, 0.999},
          {"backlash", "reference", 1 * arcsec, 0.999},
          {"settling", "", kNaN, 0.95},
          {"bearing_half_frequency", "", 1.5 * arcsec, 0.98},
          {"tone", "all", kNaN, 0.9},
          {"tone", "psd_b_y", kNaN, 0.9},
          {"slip", "yaw", 3 * arcsec, 0.999},
          {"slip", "tilt", 3 * arcsec, 0.999},
          {"slip", "lateral", 5 * um, 0.999},
          {"adc_step", "psd_a_x", 5e-3, 0.9},
          {"crosstalk", "psd_b_x", 0.01, 0.999}};
}

std::string NameOf(const testing::TestParamInfo<EffectCase>& info) {
  return info.param.effect + (info.param.where.empty() ? "" : "_" + info.param.where);
}

INSTANTIATE_TEST_SUITE_P(Rotary, TwinSignature, testing::ValuesIn(Cases()), NameOf);

}  // namespace
}  // namespace twinbench::diagnose::rotary
