#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <set>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// Devices that follow late, or not all the way.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

using Wave = std::function<double(int row)>;

std::string Beside(const char* names, int rows, const Wave& reference, const Wave& measured) {
  std::string text = std::string(names) + "\n";
  for (int i = 0; i < rows; ++i) text += fmt::format("{:.2f};{:.3f};{:.3f}\n", 0.02 * i, reference(i), measured(i));
  return text;
}

double Triangle(int row) {
  const int in_period = ((row % 400) + 400) % 400;
  return 0.3 * (in_period < 200 ? in_period : 400 - in_period);
}

TEST_F(Importing, TakesAServoThatLagsAndSaysByHowMuch) {
  const Wave late = [](int i) { return Triangle(i - 90); };
  EXPECT_THAT(Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, late)).story, HasSubstr("about 90 rows (1.8 s) later\n"));
  EXPECT_THAT(Take(Beside("sample;goal [deg];position [deg]", 2400, Triangle, late)).story, HasSubstr("about 90 rows later\n"));
  const Wave coarse = [](int i) { return 20.0 * std::round(Triangle(i - 90) / 20.0); };
  EXPECT_THAT(Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, coarse)).story, HasSubstr(" later\n"));
  EXPECT_THAT(Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, [](int i) { return Triangle(i - 3); })).story,
              Not(HasSubstr("later"))) << "it goes with its command as it is";
}

/// A quarter of a period behind and against it: at three quarters it would go with it.
TEST_F(Importing, RefusesWhatGoesAgainstItsReferenceBeforeItGoesWithIt) {
  const auto refusal = [this](const Wave& measured) { return MessageOf([&] { Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, measured)); }); };
  EXPECT_THAT(refusal([](int i) { return 60.0 - Triangle(i - 95); }), HasSubstr("does not follow"));
  EXPECT_THAT(refusal([](int i) { return 30.0 * std::sin(0.0371 * i); }), HasSubstr("does not follow")) << "another frequency";
  EXPECT_KEPT(refusal([](int i) { return 30.0 * std::sin(0.0371 * i); }));
}

/// A speed that the servo does not reach: it turns back before it arrives.
TEST_F(Importing, TakesAServoThatIsTooSlow) {
  double at = 0.0;
  const Wave slow = [&at](int i) { return at += std::clamp(Triangle(i) - at, -0.12, 0.12); };
  EXPECT_KEPT(Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, slow)).story);
}

/// Play of 30 deg under moves of 60: what is left is half, on no line.
TEST_F(Importing, TakesAnAxisOfWhichPlayEatsAPart) {
  double at = 0.0;
  const Wave loose = [&at](int i) { return at = std::clamp(at, Triangle(i) - 15.0, Triangle(i) + 15.0); };
  EXPECT_THAT(Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, loose)).story, HasSubstr("times as far, on no line: play"));
}

TEST_F(Importing, RefusesAGearByItsStraightLine) {
  EXPECT_THAT(MessageOf([&] { Take(Beside("time [s];goal [deg];position [deg]", 2400, Triangle, [](int i) { return Triangle(i) / 1.5; })); }),
              HasSubstr("measured_deg follows reference_deg times 0.666"));
}

/// 30 rows of a place each; there is one step each way.
TEST_F(Importing, GivesThePiecesOfARestTheSenseInWhichItWasReached) {
  const Wave command = [](int i) { return i / 30 == 1 ? 20.0 : 10.0; };
  const Wave servo = [](int i) { return i / 30 == 1 ? 19.9 : i / 30 == 0 ? 10.0 : 10.2; };
  const Imported imported = Take(Beside("time [s];goal [deg];position [deg]", 90, command, servo));
  EXPECT_THAT(imported.story, HasSubstr("taken as stops"));
  ASSERT_GT(imported.readings.size(), 12u);
  for (const Reading& r : imported.readings) {
    const double error_deg = (r.measured_rad - r.reference_rad) / units::deg;
    EXPECT_EQ(r.direction, error_deg > 0.1 ? -1 : 1) << "10.2 was come to from above; where it began the next step counts";
  }
}

TEST_F(Importing, SaysWhatARecordingOfOneStepLacks) {
  const Wave step = [](int i) { return i < 40 ? 0.0 : 20.0; }, servo = [](int i) { return i < 40 ? 0.0 : 20.0 - 15.0 * std::exp(-0.2 * (i - 40)); };
  EXPECT_KEPT(MessageOf([&] { Take(Beside("time [s];goal [deg];position [deg]", 200, step, servo)); }));
}

}  // namespace
}  // namespace twinbench::imports
