#include "tests/diagnose/found_causes.h"
#include "tests/hidden/known_wrong.h"
#include "tests/hidden/twin_cases.h"
#include "tests/support/thresholds.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"

// Changes of the readings or the model that must change the answer.
namespace twinbench::hidden {
namespace {

using diagnose::Cause, diagnose::Diagnosis;
using units::arcsec;

constexpr std::uint64_t kSeed = 71;

EffectSettings Effect(const std::string& name, const std::string& where,
                      const std::map<std::string, double>& parameters) {
  EffectSettings effect = WithDefaults(name, where, kRotaryBench);
  for (const auto& [key, value] : parameters) effect.parameters.at(key) = value;
  return effect;
}

std::vector<Reading> ReadingsWith(const EffectSettings& effect) {
  Scenario actual = Drawn(Design::kRotary, kSeed);
  actual.effects = {effect};
  return TakeReadings(actual);
}

Diagnosis Diagnosed(const std::vector<Reading>& readings, const Scenario& believed = Believed(Design::kRotary),
                    Estimator model = Estimator::kRigorous) {
  diagnose::DiagnoseOptions options = test::QuickOptions();
  options.model = model;
  return diagnose::Diagnose(readings, believed, options).diagnosis;
}

const Cause* Find(const Diagnosis& d, const std::string& effect, const std::string& where) {
  const auto found =
      std::ranges::find_if(d.causes, [&](const Cause& c) { return c.effect == effect && c.where == where; });
  return found == d.causes.end() ? nullptr : &*found;
}

bool Names(const Diagnosis& d, const std::string& effect) {
  return std::ranges::any_of(d.causes, [&](const Cause& c) { return c.effect == effect && c.probability > 0.5; });
}

using Shuffle = std::function<void(Reading&, Reading&)>;

/// Exchanges one field between readings at random; the rest stays where it is.
std::vector<Reading> Shuffled(std::vector<Reading> readings, const Shuffle& exchange) {
  Stream stream(kSeed, "hidden.shuffle");
  for (std::size_t i = readings.size(); i > 1; --i)
    exchange(readings[i - 1], readings[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(i))]);
  return readings;
}

const Shuffle kTimes = [](Reading& a, Reading& b) { std::swap(a.time, b.time); };
const Shuffle kDirections = [](Reading& a, Reading& b) { std::swap(a.direction, b.direction); };
const Shuffle kTemperatures = [](Reading& a, Reading& b) { std::swap(a.temperature_degC, b.temperature_degC); };

TEST(Controls, WhatGoesByTimeDirectionOrTemperatureIsNotFoundWhenTheseAreShuffled) {
  const std::pair<EffectSettings, Shuffle> cases[] = {
      {Effect("laser_drift", "pitch", {{"drift", 30e-6 / units::hour}}), kTimes},
      {Effect("backlash", "target", {{"half_width", 1.0 * arcsec}}), kDirections},
      {Effect("thermal_tilt", "tilt", {{"tilt_per_kelvin", 10.0 * arcsec}}), kTemperatures},
      {Effect("post_growth", "psd_a", {{"growth_per_kelvin", 5.0 * units::um}}), kTemperatures},
      {Effect("post_growth", "psd_b", {{"growth_per_kelvin", 5.0 * units::um}}), kTemperatures}};
  for (const auto& [effect, shuffle] : cases) {
    const auto readings = ReadingsWith(effect);
    const Diagnosis as_it_is = Diagnosed(readings);
    const bool is_gap = Find(as_it_is, "backlash", "target") || Find(as_it_is, "backlash", "reference");  // a tie
    EXPECT_TRUE(effect.name == "backlash" ? is_gap : Names(as_it_is, effect.name)) << effect.name;
    EXPECT_FALSE(Names(Diagnosed(Shuffled(readings, shuffle)), effect.name)) << effect.name;
    if (const Cause* post = Find(as_it_is, "post_growth", effect.where)) {
      EXPECT_NEAR(post->parameters.at(0).value, 5.0 * units::um, 4.0 * post->parameters.at(0).u) << effect.where;
      EXPECT_LT(post->parameters.at(0).u, 1.0 * units::um);
    }
  }
}

// With a laser of constant power a background is stray light, and both are nearly a PSD that stands too far off.
TEST(Controls, ABackgroundTiesWithStrayLight) {
  const Diagnosis d = Diagnosed(ReadingsWith(Effect("background", "psd_b", {{"current", 10e-6}})));
  SCOPED_TRACE(Judge({}, d).answer);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kTie);
  const Cause* const background = Find(d, "background", "psd_b");
  const Cause* const stray = Find(d, "stray_light", "psd_b");
  ASSERT_TRUE(background != nullptr && stray != nullptr);
  EXPECT_NEAR(background->probability, stray->probability, 0.1);
  // One of both was fitted: the current, or its share of that of the light.
  const bool is_fitted = !background->parameters.empty();
  const diagnose::ParameterEstimate& size = (is_fitted ? background : stray)->parameters.at(0);
  EXPECT_NEAR(size.value, is_fitted ? 10e-6 : 10e-6 / (0.45 * 5e-3 * 0.339), 4.0 * size.u);
  const auto is_stray = [](const diagnose::Rival& rival) { return rival.effect == "stray_light"; };
  const auto rival = std::ranges::find_if(background->indistinguishable_from, is_stray);
  ASSERT_NE(rival, background->indistinguishable_from.end());
  EXPECT_GT(rival->overlap, 0.99);
  EXPECT_THAT(background->next_measurement, testing::HasSubstr("power"));
}

// Whatever turns the grating as a function of one table's angle is that table's error, as far as readings go.
TEST(Controls, AFormOfTheGratingAndAnEncodersSubdivisionAreSaidToHideInTheTables) {
  Scenario actual = Drawn(Design::kRotary, kSeed);
  Scenario believed = Believed(Design::kRotary);
  for (Scenario* s : {&actual, &believed}) {
    RotaryOf(*s).mechanics.encoder_periods = 36001;  // at 36 stops as once a turn
    RotaryOf(*s).centring_m = {40e-6, 20e-6};
  }
  const EffectSettings subdivision = Effect("encoder_subdivision", "target", {{"amplitude", 2.0 * arcsec}});
  const EffectSettings sphere = Effect("grating_form", "sphere", {{"height", 600.0 * units::nm}});
  for (const EffectSettings& effect : {subdivision, sphere}) {
    actual.effects = {effect};
    const Diagnosis d = Diagnosed(TakeReadings(actual), believed);
    SCOPED_TRACE(Judge({}, d).answer);
    EXPECT_EQ(d.verdict, diagnose::Verdict::kNone) << effect.name;
    EXPECT_THAT(diagnose::test::CouldBias(d, "encoder_subdivision", "target"), testing::HasSubstr("target.ez"));
    EXPECT_THAT(diagnose::test::CouldBias(d, "encoder_subdivision", "reference"), testing::HasSubstr("ez"));
    for (const char* form : {"sphere", "astigmatism"})
      EXPECT_THAT(diagnose::test::CouldBias(d, "grating_form", form), testing::HasSubstr("arcsec")) << form;
  }
}

// Unless it is so large that the seats, some 10 um apart, lead the beam over it in another way in every set-up.
TEST(Controls, AFormOfManyWavesIsSeenAndNotNamed) {
  Scenario actual = Drawn(Design::kRotary, kSeed);
  actual.effects = {Effect("grating_form", "sphere", {{"height", 20.0 * units::um}})};
  EXPECT_EQ(Diagnosed(TakeReadings(actual)).verdict, diagnose::Verdict::kUnknown);
}

TEST(Controls, ACauseAHundredTimesItsUsualSizeIsNotPassedOverInSilence) {
  const Diagnosis d = Diagnosed(ReadingsWith(Effect("psd_roll", "psd_b", {{"roll", 0.3}})));
  EXPECT_NE(d.verdict, diagnose::Verdict::kNone);
  EXPECT_LT(d.alarm_p, 1e-3);
}

/// Readings without noise, evaluated with the published equations.
Diagnosis PublishedAgainstExact(const std::string& clamping) {
  Scenario scenario = Drawn(Design::kRotary, kSeed);
  scenario.noise_free = true;
  RotaryOf(scenario).procedure.clamping = clamping;
  Scenario believed = Believed(Design::kRotary);
  RotaryOf(believed).procedure.clamping = clamping;
  return Diagnosed(TakeReadings(scenario), believed, Estimator::kPublished);
}

TEST(PublishedEquations, HaveTheWrongSensitivitiesOfYawAndTiltAndAddTheWobbleOfAReclampedRunInTheWrongFrame) {
  const Diagnosis d = PublishedAgainstExact("reseat");
  SCOPED_TRACE(Judge({}, d).answer);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed);
  EXPECT_TRUE(Find(d, "published_sensitivity", "yaw, tilt"));
  EXPECT_TRUE(Find(PublishedAgainstExact("reclamp"), "reclamp_frame", ""));
}

}  // namespace
}  // namespace twinbench::hidden
