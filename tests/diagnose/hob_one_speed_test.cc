#include "tests/support/twin_run.h"
#include "twin/benches/hob_transmission/told_orders.h"
#include "twin/core/time.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::hob {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

/// A hob of 16 starts at 1.9375 revolutions a second that cuts a gear of 31 teeth: the table turns once a second.
Scenario TrainOfOneSpeed() {
  return LoadScenario(twinbench::test::ScenarioPath("hob_transmission.toml"),
                      {"transmission.gear_teeth=31", "transmission.hob_starts=16"});
}

std::vector<Reading> SamplesAt(const std::vector<double>& hob_Hz) {
  std::vector<Reading> readings;
  for (std::size_t pass = 0; pass < hob_Hz.size(); ++pass) {
    for (int k = 0; k < 880; ++k) {
      Reading& r = readings.emplace_back();
      r.pass = static_cast<int>(pass);
      r.time = Time(FromSeconds(0.0025 * k + 60.0 * static_cast<double>(pass)));
      r.reference_rad = units::turn * hob_Hz[pass] * 0.0025 * k;
      r.velocity_rad_s = units::turn * hob_Hz[pass];
    }
  }
  return readings;
}

Diagnosis AfterTone(double frequency_Hz, const std::vector<double>& hob_Hz) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::kNamed;
  Cause& tone = diagnosis.causes.emplace_back();
  tone.effect = "tone";
  tone.probability = 0.96;
  tone.rho = 3000.0;
  tone.parameters = {{.name = "amplitude", .unit = "arcsec", .value = 90.0 * units::arcsec, .u = units::arcsec},
                     {.name = "frequency", .unit = "Hz", .value = frequency_Hz, .u = 1e-4}};
  benches::hob::TellOrdersOfTones(SamplesAt(hob_Hz), TrainOfOneSpeed(), diagnosis);
  return diagnosis;
}

std::vector<std::string> NamesInOrder(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const Cause& cause : diagnosis.causes) names.push_back(cause.effect + (cause.where.empty() ? "" : " ") + cause.where);
  return names;
}

TEST(HobAtOneSpeed, ToneAndWhatErrsWithTheMeshAreOneThingWithSeveralNames) {
  const Diagnosis d = AfterTone(31.00005, {1.9375});
  EXPECT_EQ(d.verdict, Verdict::kTie);
  ASSERT_THAT(NamesInOrder(d), ElementsAre("tone", "gear_mesh", "periodic table", "periodic hob"));
  EXPECT_THAT(d.causes.front().indistinguishable_from, testing::SizeIs(3));
  EXPECT_THAT(d.causes.front().next_measurement, HasSubstr("twice the speed"));
  const ParameterEstimate& at_hob = d.causes.back().parameters.back();  // seen on the table smaller by the ratio
  EXPECT_NEAR(at_hob.value / units::arcsec, 90.0 * 31.0 / 16.0, 1e-9);
  for (const Cause& cause : d.causes) EXPECT_DOUBLE_EQ(cause.probability, 0.24);
}

TEST(HobAtOneSpeed, AToneBetweenTheOrdersIsNotedWithThem) {
  const Diagnosis d = AfterTone(5.1, {-1.9375});
  EXPECT_EQ(d.verdict, Verdict::kNamed);
  EXPECT_THAT(NamesInOrder(d), ElementsAre("tone"));
  EXPECT_THAT(d.notes, ElementsAre(HasSubstr("order 5.1 of the table's turn or 2.632 of the hob's")));
}

TEST(HobAtOneSpeed, TwoSpeedsTellAToneFromAnOrder) {
  const Diagnosis d = AfterTone(31.0, {1.9375, 1.2});
  EXPECT_EQ(d.verdict, Verdict::kNamed);
  EXPECT_THAT(NamesInOrder(d), ElementsAre("tone"));
  EXPECT_THAT(d.notes, IsEmpty());
}

Diagnosis NamedAt(const std::string& effect, const std::string& where, double order) {
  Diagnosis diagnosis;
  Cause& cause = diagnosis.causes.emplace_back();
  cause.effect = effect;
  cause.where = where;
  cause.parameters = {{.name = "order", .unit = "1", .value = order}};
  benches::hob::TellGearsBesideRing(diagnosis);
  return diagnosis;
}

TEST(HobRing, IsNoSurerThanGearsThatErrAsOften) {
  EXPECT_THAT(NamedAt("ellipticity", "hob", 2.0).notes, ElementsAre(HasSubstr("gears that err 2 times per turn of the hob")));
  EXPECT_THAT(NamedAt("periodic", "hob", 5.0).notes, ElementsAre(HasSubstr("gears that err 5 times per turn of the hob")));
  EXPECT_THAT(NamedAt("ellipticity", "table", 2.0).notes, IsEmpty());
}

}  // namespace
}  // namespace twinbench::diagnose::hob
