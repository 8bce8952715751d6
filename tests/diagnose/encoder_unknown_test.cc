#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/twin_runs.h"
#include "twin/benches/encoder_comparison/settings.h"

// The generic families for what the catalogue has not.
namespace twinbench::diagnose::encoder {
namespace {

using test::EncoderScenario;
using units::deg;

/// Readings of an ideal device with a signal on them, as a function of the reading [rad].
template <class Signal>
EncoderRun RunWith(const std::string& kind, Signal signal) {
  const Scenario scenario = EncoderScenario(kind);
  auto readings = twinbench::test::RunEncoderTwin(scenario).readings;
  for (Reading& r : readings) r.measured_rad += signal(r);
  return RunOf(readings, scenario);
}

/// What the best family of a sort leaves, and its words for it.
std::pair<double, std::string> BestOfSort(const EncoderRun& encoder, const std::string& sort,
                                          const std::vector<std::string>& excluded = {}) {
  double left = 2.0;
  std::string words;
  for (const Family& family : Families(encoder, excluded)) {
    if (family.group != sort) continue;
    const test::Fit fit = test::BestFit(family, encoder.run);
    if (fit.left >= left) continue;
    left = fit.left;
    words = family.describe(fit.grid_point, fit.amplitudes);
  }
  return {left, words};
}

struct Structure {
  const char *kind, *sort;
  std::function<double(const Reading&)> signal;
  double left;        // at most
  const char* words;  // a regular expression
};

TEST(EncoderUnknown, FindsLinesMapsTonesWanderPassesAndWhatGrowsWithTimeOrSpeed) {
  const auto direction_map = [](const Reading& r) { return 1e-4 * r.direction * std::sin(3.0 * r.reference_rad); };
  const auto tone = [](const Reading& r) { return 1e-4 * std::cos(2.0 * units::kPi * 0.0313 * ToSeconds(r.time)); };
  const auto wander = [](const Reading& r) { return 1e-4 * std::cos(2.0 * units::kPi * r.reading / 575.0); };
  const auto one_pass = [](const Reading& r) { return r.pass == 1 ? 1e-4 * std::cos(r.reference_rad) : 0.0; };
  const auto growing = [](const Reading& r) { return 1e-7 * r.reading * std::cos(5.0 * r.reference_rad); };
  const auto with_speed = [](const Reading& r) {
    return 1e-4 * r.velocity_rad_s * std::sin(4.0 * r.reference_rad);
  };
  const char* map_words =
      ".*direction times order 3 synchronous with reference angle, odd in direction, on angle, amplitude 0.0057 deg.*";
  const Structure structures[] = {
      // The next grid point is at most 0.025 away: 0.3 rad of phase at the ends of two turns.
      {"stops", "line", [](const Reading& r) { return 1e-4 * std::cos(4.508 * r.reference_rad); }, 0.15,
       "line at 4[.](49|50|51|52)[0-9] per turn synchronous with reference angle, .*deg"},
      {"stops", "direction harmonic", direction_map, 1e-6, map_words},
      {"sweep", "direction harmonic", direction_map, 1e-6, map_words},
      // Up to a quarter of the resolution away; the engine refines it.
      {"stops", "tone", tone, 0.5, ".*Hz, function of time.*"},
      {"stops", "wander", wander, 0.01, ".*"},
      {"stops", "pass", [](const Reading& r) { return r.pass == 2 ? 1e-4 : 0.0; }, 1e-6, ".*"},
      {"stops", "pass harmonic", one_pass, 1e-6, ".*"},
      {"stops", "growing harmonic", growing, 1e-6, ".*"},
      {"sweep", "speed", [](const Reading& r) { return 1e-4 * std::abs(r.velocity_rad_s); }, 1e-6, ".*"},
      {"sweep", "speed harmonic", with_speed, 1e-6, ".*"},
      {"sweep", "harmonic", [](const Reading& r) { return 1e-4 * std::cos(7.0 * r.reference_rad); }, 1e-3,
       ".*harmonic of order 7 synchronous with reference angle, same in both directions.*"}};
  for (const Structure& structure : structures) {
    const auto [left, words] = BestOfSort(RunWith(structure.kind, structure.signal), structure.sort);
    EXPECT_LT(left, structure.left) << structure.kind << " " << structure.sort;
    EXPECT_THAT(words, testing::MatchesRegex(structure.words));
  }
}

TEST(EncoderUnknown, FindsAHysteresisAlsoWithoutItsName) {
  for (const char* kind : {"stops", "sweep"}) {
    const Scenario scenario = EncoderScenario(kind);
    const auto hysteresis = test::EncoderEffect("hysteresis", {{"lag", 1e-5}, {"settles_over", 30.0 * deg}});
    const EncoderRun encoder = RunOf(test::ReadingsWith(scenario, hysteresis), scenario);
    const auto [left, words] = BestOfSort(encoder, "transition", {"hysteresis"});
    const double offset_alone = BestOfSort(encoder, "direction offset").first;
    // The first pass begins in the middle, not on the other side as all others do; the grid's ways differ by 1.49.
    EXPECT_LT(left, 0.5 * offset_alone) << kind;
    EXPECT_THAT(words, testing::MatchesRegex("offset, function of direction that is reached over .* deg behind each "
                                             "reversal, odd in direction, on angle, .*"));
  }
}

TEST(EncoderUnknown, CountsLessWhereACauseOfTheCatalogueHasTheSameShape) {
  for (const Family& family : Families(RunWith("sweep", [](const Reading&) { return 0.0; }))) {
    const bool same = family.effect == "harmonic" || family.effect == "step" ||
                      family.effect == "direction offset" || family.effect == "transition";
    const bool own = family.kind == Kind::kNamed || family.effect == "line";
    EXPECT_TRUE(!own || family.prior_weight == 1.0) << family.effect;
    EXPECT_TRUE(!same || family.prior_weight < 1.0) << family.effect;
  }
}

TEST(EncoderUnknown, HasNoShapesInTimeNorLinesInOneTurn) {
  Scenario scenario = EncoderScenario("stops");
  EncoderOf(scenario).encoder_procedure.passes = {1};
  EncoderOf(scenario).encoder_procedure.turns = 1.0;
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  for (const char* name : {"wander", "tone", "growing harmonic", "direction harmonic", "backlash", "hysteresis"})
    EXPECT_FALSE(test::HasFamily(families, name)) << name;
  for (const char* name : {"eccentricity", "periodic", "scale", "drift"})
    EXPECT_TRUE(test::HasFamily(families, name)) << name;
  // In one turn whole orders imitate every line between them.
  EXPECT_FALSE(test::HasFamily(families, "line"));
}

TEST(EncoderUnknown, LooksForOrdersThatTheSpacingCanShow) {
  // Stops every 5 deg: orders below 36. Readings every 0.96 deg at the lower speed: 187.
  EXPECT_EQ(LargestOrder(RunWith("stops", [](const Reading&) { return 0.0; }).context), 35);
  EXPECT_EQ(LargestOrder(RunWith("sweep", [](const Reading&) { return 0.0; }).context), 187);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
