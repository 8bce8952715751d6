#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/diagnose/turntable_bench.h"
#include "tests/diagnose/turntable_twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/turntable_autocollimator/diagnosis/families.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/effect_catalogue.h"

// The signatures of the causes against differences of readings of the independent bench.
namespace twinbench::diagnose::turntable {
namespace {

using test::BenchReadings;
using test::Wrong;
using units::arcsec;
using units::deg;

constexpr std::uint64_t kSeed = 3;

Scenario Quiet() {
  Scenario scenario = test::CarefulScenario();
  scenario.noise_free = true;
  TurntableOf(scenario).turntable_procedure.eccentricities_m = {50e-6, 900e-6};
  TurntableOf(scenario).turntable_procedure.shifts = {0, 25};
  return scenario;
}

Eigen::VectorXd RowsOf(const std::vector<Reading>& readings) {
  Eigen::VectorXd rows(2 * std::ssize(readings));
  for (Eigen::Index i = 0; i < std::ssize(readings); ++i) {
    const Reading& r = readings[static_cast<std::size_t>(i)];
    rows.segment<2>(2 * i) << r.autocollimator_yaw_rad, r.autocollimator_tilt_rad;
  }
  return rows;
}

/// Change of all readings from one bench to the other.
Eigen::VectorXd Difference(const Wrong& from, const Wrong& to) {
  return RowsOf(BenchReadings(Quiet(), to, kSeed)) - RowsOf(BenchReadings(Quiet(), from, kSeed));
}

const TurntableRun& QuietRun() {
  static const TurntableRun run = RunOf(BenchReadings(Quiet(), {}, kSeed), Quiet());
  return run;
}

const Family& FamilyOf(const std::string& effect, const std::string& where, std::size_t amplitudes = 1) {
  static const std::vector<Family> families = Families(QuietRun());
  for (const Family& family : families) {
    if (family.effect == effect && family.where == where && family.amplitudes.size() == amplitudes) return family;
  }
  throw std::runtime_error("there is no family " + effect);
}

/// Largest difference of two signatures in units of the larger one.
double Apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

Eigen::VectorXd Shape(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

TEST(TurntableFamilies, HaveTheSlopesOfTheInstrument) {
  Wrong roll, gain, flat;
  roll.roll_rad = 1e-4;
  gain.gain_error = 1e-4;
  flat.sag_m = 100e-9;
  // The prediction holds the teeth at zero: 0.1 to 0.2 arcsec of 100.
  EXPECT_LT(Apart(FamilyOf("autocollimator_roll", "").ColumnsAt(0) * 1e-4, Difference({}, roll)), 3e-3);
  EXPECT_LT(Apart(FamilyOf("autocollimator_scale", "").ColumnsAt(0) * 1e-4, Difference({}, gain)), 3e-3);
  EXPECT_LT(Apart(FamilyOf("mirror_flatness", "").ColumnsAt(0) * 100e-9, Difference({}, flat)), 1e-3);
}

TEST(TurntableFamilies, HaveTheCubeOfTheAngleRadiallyAndForEachAxis) {
  Wrong cubic;
  cubic.at_edge_rad = 0.1 * arcsec;
  std::vector<Eigen::MatrixXd> columns;  // radially, then for each axis
  for (const Family& family : Families(QuietRun())) {
    if (family.effect == "autocollimator_nonlinearity") columns.push_back(family.ColumnsAt(0));
  }
  ASSERT_EQ(columns.size(), 2u);
  // The bench has a twentieth of fifth order at the edge; at half the range this is an eightieth of the third.
  EXPECT_LT(Apart(columns[1] * cubic.at_edge_rad, Difference({}, cubic)), 0.02);
  // Radially the same where one axis is near zero: within (100 / 200)^2 of the largest value.
  EXPECT_LT(Apart(columns[0] * cubic.at_edge_rad, Difference({}, cubic)), 0.3);
}

TEST(TurntableFamilies, HaveTheWavesOfTheReadings) {
  const double period_rad = 1.7 * arcsec, phase_rad = 2.0, amplitude_rad = 1e-3 * arcsec;
  for (const int axis : {0, 1}) {
    Wrong ripple;
    ripple.ripple_rad[static_cast<std::size_t>(axis)] = amplitude_rad;
    const Family& family = FamilyOf("autocollimator_periodic", axis == 0 ? "x" : "y", 2);
    const Eigen::Vector2d amplitudes = amplitude_rad * Eigen::Vector2d(std::cos(phase_rad), -std::sin(phase_rad));
    // The teeth (0.1 arcsec) are held at zero in the prediction, and set-up constants shift all phases by a pixel's
    // share: compared is what one constant phase leaves.
    const Eigen::VectorXd made = Difference({}, ripple), expected = family.at(Shape(period_rad)) * amplitudes;
    EXPECT_GT(made.dot(expected) / made.norm() / expected.norm(), 0.9) << axis;
  }
}

TEST(TurntableFamilies, HaveTheCoursesInTime) {
  for (const std::size_t axis : {0u, 1u}) {
    const std::string where = axis == 0 ? "x" : "y";
    Wrong drift, creep, slip, tone, warm;
    drift.drift_rad_s[axis] = 0.5 * arcsec / 3600.0;
    drift.curvature = 0.4;
    creep.creep_rad[axis] = 0.1 * arcsec;
    slip.slip_rad[axis] = 0.1 * arcsec;
    tone.tone_rad[axis] = 0.1 * arcsec;
    warm.kelvin_rad[axis] = 0.1 * arcsec;
    const double rate = drift.drift_rad_s[axis];
    EXPECT_LT(Apart(FamilyOf("autocollimator_drift", where, 2).ColumnsAt(0) * Eigen::Vector2d(rate, 0.4 * rate),
                    Difference({}, drift)),
              1e-9);
    // The mounting is taken to end a short move and a stop before the first reading: some seconds of 60.
    EXPECT_LT(Apart(FamilyOf("mount_creep", where).at(Shape(60.0)) * 0.1 * arcsec, Difference({}, creep)), 0.02);
    const Family& step = FamilyOf("slip", where);
    for (int g = 0; g < step.grid; ++g) {
      if (step.ShapeAt(g)[0] != 100.0) continue;
      EXPECT_LT(Apart(step.ColumnsAt(g) * 0.1 * arcsec, Difference({}, slip)), 1e-9);
    }
    const Eigen::Vector2d wave = 0.1 * arcsec * Eigen::Vector2d(std::cos(0.7), -std::sin(0.7));
    EXPECT_LT(Apart(FamilyOf("tone", where, 2).at(Shape(1.0 / 900.0)) * wave, Difference({}, tone)), 1e-9);
    EXPECT_LT(
        Apart(FamilyOf("autocollimator_temperature", where).ColumnsAt(0) * 0.1 * arcsec, Difference({}, warm)),
        1e-9);
  }
}

TEST(TurntableFamilies, HaveTheTurntableBehindOnTheSideItCameFrom) {
  Wrong gap, late;
  gap.backlash_rad = 0.1 * arcsec;
  late.settling_rad = 0.1 * arcsec;
  late.settling_s = 5.0;
  // First order of the tilts, 1e-3 rad.
  EXPECT_LT(Apart(FamilyOf("backlash", "").ColumnsAt(0) * 0.1 * arcsec, Difference({}, gap)), 1e-3);
  // Counted as what is left at the soonest reading: a lift of 4 s, of which the move takes 0.6, and a dwell of 0.5.
  const double left_rad = 0.1 * arcsec * std::exp(-3.9 / 5.0);
  EXPECT_LT(Apart(FamilyOf("settling", "").at(Shape(5.0)) * left_rad, Difference({}, late)), 1e-3);
}

TEST(TurntableFamilies, AreAllThatTheCatalogueListsButForTheNoise) {
  std::set<std::string> names;
  for (const Family& family : Families(QuietRun())) {
    if (family.kind == Kind::kNamed) names.insert(family.effect);
  }
  for (const EffectEntry& effect : EffectCatalogue(kTurntableBench)) {
    const bool noise = effect.name == "multitooth_seating" || effect.name == "outliers";
    EXPECT_EQ(names.contains(effect.name), !noise) << effect.name;
  }
}

TEST(TurntableFamilies, LeaveOutWhatWasNotRecorded) {
  std::vector<Reading> readings = BenchReadings(Quiet(), {}, kSeed);
  for (Reading& r : readings) r.temperature_degC = r.dwell_s = kNaN;
  for (const Family& family : Families(RunOf(readings, Quiet()))) {
    EXPECT_NE(family.effect, "autocollimator_temperature");
    EXPECT_NE(family.effect, "temperature");
    EXPECT_NE(family.effect, "settling");
    EXPECT_NE(family.effect, "dwell");
  }
}

TEST(TurntableFamilies, HaveTheSameShapesWithoutANameWhateverIsStruck) {
  const auto unknown = [](const std::vector<std::string>& excluded) {
    std::vector<std::string> names;
    for (const Family& family : Families(QuietRun(), excluded)) {
      if (family.kind == Kind::kUnknown) names.push_back(family.effect + " on " + family.where);
    }
    return names;
  };
  EXPECT_EQ(unknown({}), unknown({"backlash", "slip", "tone", "autocollimator_roll"}));
  EXPECT_THAT(unknown({}), testing::IsSupersetOf({"direction harmonic on x", "interaction on y", "wander on x, y",
                                                  "reading on x", "pass on y", "gain changes on y"}));
}

}  // namespace
}  // namespace twinbench::diagnose::turntable
