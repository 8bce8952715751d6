#include <gtest/gtest.h>

#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/hob_chain.h"
#include "tests/diagnose/hob_twin_run.h"
#include "twin/benches/hob_transmission/diagnosis/families.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

/// Each named family against noise-free readings that were made without it (tests/diagnose/hob_chain.cc).
namespace twinbench::diagnose::hob {
namespace {

using test::BestFit;
using test::Fit;
using test::HiddenCause;
using test::HobChain;
using test::ParametersOf;
using units::arcsec;
using units::deg;

HobChain QuietHeads() {
  HobChain chain;
  chain.table_noise_arcsec = chain.hob_noise_arcsec = chain.interferometer_noise_arcsec = 0.0;
  chain.hob_steps = false;
  chain.turns = 2;
  chain.heads_deg = {0.0, 120.0};
  chain.interferometer = true;
  return chain;
}

const Family& FamilyAt(const std::vector<Family>& families, const std::string& effect, const std::string& where) {
  for (const Family& family : families) {
    if (family.effect == effect && family.where == where) return family;
  }
  throw std::runtime_error("there is no family " + effect + " at " + where);
}

/// A cause may have several: a drift with a bend and one without.
std::pair<const Family*, Fit> BestOf(const std::vector<Family>& families, const std::string& effect,
                                     const std::string& where, const LinearRun& run) {
  std::pair<const Family*, Fit> best{nullptr, {}};
  for (const Family& family : families) {
    if (family.effect != effect || family.where != where) continue;
    const Fit fit = BestFit(family, run);
    if (!best.first || fit.left < best.second.left) best = {&family, fit};
  }
  return best;
}

struct FamilyTrial {
  HiddenCause cause;
  double left = 0.01;     // share of the signal that may stay
  double worst = 0.01;    // relative error of a parameter
  std::string wave = "";  // its parameter that is a phase
};

void PrintTo(const FamilyTrial& trial, std::ostream* out) {
  *out << trial.cause.name << " " << trial.cause.where;
}

class HobFamily : public ::testing::TestWithParam<FamilyTrial> {};

/// The free orders and constants are fitted beside it, so that only what they cannot have is compared.
TEST_P(HobFamily, FitsWhatIndependentFormulasMakeOfItsCause) {
  const FamilyTrial& trial = GetParam();
  HobChain chain = QuietHeads();
  chain.hidden = {trial.cause};
  const Scenario scenario = ScenarioOf(chain);
  const HobRun hob = RunOf(ReadingsOf(chain), scenario);
  const std::vector<Family> families = Families(hob);
  // What is left without the cause: the free orders, to rounding and the second order of the errors.
  const Eigen::MatrixXd free = hob.run.nuisance.jacobian.toDense();
  const Eigen::VectorXd signal =
      hob.run.residual - free * SolveShortest(free, hob.run.residual);
  const auto [family, fit] = BestOf(families, trial.cause.name, trial.cause.where, hob.run);
  EXPECT_LT(fit.left * hob.run.residual.norm(), trial.left * signal.norm());
  std::map<std::string, double> found = ParametersOf(*family, fit);
  for (const auto& [name, value] : trial.cause.value) {
    const double error =
        name == "phase" ? std::remainder(found.at(name) - value, 2.0 * units::kPi) : found.at(name) - value;
    EXPECT_LT(std::abs(error), trial.worst * (name == "phase" ? 1.0 : std::abs(value))) << name;
  }
}

// 1 %: rows are means over three samples, rings are circles, signals are arc tangents; neither is of the first
// order.
INSTANTIATE_TEST_SUITE_P(
    Causes, HobFamily,
    ::testing::Values(
        FamilyTrial{{"eccentricity", "table", {{"amplitude", 6.0 * arcsec}, {"phase", 1.0}}}},
        FamilyTrial{{"eccentricity", "hob", {{"amplitude", 40.0 * arcsec}, {"phase", 5.0}}}},
        FamilyTrial{{"ellipticity", "table", {{"amplitude", 2.0 * arcsec}, {"phase", 2.0}}}},
        FamilyTrial{{"ellipticity", "hob", {{"amplitude", 20.0 * arcsec}, {"phase", 0.3}}}},
        FamilyTrial{{"periodic", "table", {{"order", 7.0}, {"amplitude", 1.0 * arcsec}, {"phase", 4.0}}}},
        FamilyTrial{{"periodic", "hob", {{"order", 3.0}, {"amplitude", 20.0 * arcsec}, {"phase", 4.0}}}},
        // the faults bend as much as they are large: 2 % of an amplitude
        FamilyTrial{{"signal_offset", "", {{"offset_sin", 0.02}, {"offset_cos", -0.01}}}, 0.05, 0.02},
        FamilyTrial{{"amplitude_mismatch", "", {{"ratio", 0.04}}}, 0.05, 0.05},
        FamilyTrial{{"quadrature_error", "", {{"angle", 0.04}}}, 0.05, 0.05},
        FamilyTrial{{"hob_runout", "", {{"amplitude", 2.0 * arcsec}, {"phase", 6.0}}}},
        FamilyTrial{{"worm", "", {{"amplitude", 2.0 * arcsec}, {"phase", 2.5}}}},
        FamilyTrial{{"gear_mesh", "", {{"amplitude", 2.0 * arcsec}, {"phase", 2.5}}}},
        FamilyTrial{{"backlash", "", {{"width", 5.0 * arcsec}}}},
        FamilyTrial{{"backlash", "", {{"width", -5.0 * arcsec}}}},
        // the grid of ways has ratios of 1.44; between its points a tenth of the transition stays
        FamilyTrial{{"hysteresis", "", {{"lag", 5.0 * arcsec}, {"settles_over", 20.0 * deg}}}, 0.1, 0.25},
        FamilyTrial{{"latency", "", {{"delay", 1e-4}}}},
        FamilyTrial{{"drift", "", {{"rate", 20.0 * arcsec / units::hour}, {"curvature", 0.5}}}, 0.01, 0.02},
        FamilyTrial{{"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 4000.0}}}, 0.05, 0.01},
        FamilyTrial{{"slip", "hob", {{"step", 144.0 * arcsec}, {"at_reading", 1000.0}}}, 0.05, 0.01}));

TEST(HobFamilies, OfATableThatIsNotWatchedHaveTheSameColumnsForDriveAndEncoderOfTheHob) {
  HobChain chain = QuietHeads();
  chain.interferometer = false;
  const HobRun hob = RunOf(ReadingsOf(chain), ScenarioOf(chain));
  const std::vector<Family> families = Families(hob);
  const Family& drive = FamilyAt(families, "hob_runout", "");
  const Family& encoder = FamilyAt(families, "eccentricity", "hob");
  // ShownBy 2 / 44 times, with the other sign.
  EXPECT_LT((22.0 * encoder.ColumnsAt(0) + drive.ColumnsAt(0)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(encoder.amplitudes[0].prior_sd / drive.amplitudes[0].prior_sd, 22.0, 1e-6);
}

TEST(HobFamilies, OfTheEncodersDoNotShowToTheInterferometer) {
  const HobChain chain = QuietHeads();
  const HobRun hob = RunOf(ReadingsOf(chain), ScenarioOf(chain));
  ASSERT_EQ(hob.run.channels, (std::vector<std::string>{"transmission", "interferometer"}));
  const std::vector<Family> families = Families(hob);
  const auto seen = [&](const char* effect, const char* where) {
    const Eigen::VectorXd column = FamilyAt(families, effect, where).ColumnsAt(0).col(0);
    return Eigen::Map<const Eigen::MatrixXd>(column.data(), 2, column.size() / 2).row(1).cwiseAbs().maxCoeff() >
           0.0;
  };
  for (const char* effect : {"eccentricity", "ellipticity", "periodic", "slip"}) {
    EXPECT_FALSE(seen(effect, "table")) << effect;
    EXPECT_FALSE(seen(effect, "hob")) << effect;
  }
  EXPECT_FALSE(seen("latency", ""));
  for (const char* effect : {"hob_runout", "worm", "gear_mesh", "backlash", "hysteresis"})
    EXPECT_TRUE(seen(effect, "")) << effect;
}

}  // namespace
}  // namespace twinbench::diagnose::hob
