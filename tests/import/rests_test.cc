#include <random>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"
#include "tests/support/noise.h"

/// A command that jumps, and a servo that takes its time.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

struct Servo {
  double speed_deg_s = 205.0, low_deg = 0.04, noise_deg = 0.01;
  double rest_s = 1.0, last_rest_s = 1.0;
};

/// A square wave of 140 deg, 20 rests, a row every 13 ms.
std::string StepTest(const Servo& servo) {
  test::Noise noise(servo.noise_deg, 4);
  std::string text = "time [s];commanded [deg];measured [deg]\n";
  double time_s = 0.0, at_deg = -60.0;
  for (int k = 0; k < 20; ++k) {
    const double to_deg = k % 2 == 0 ? -60.0 : 80.0, rest_s = k == 19 ? servo.last_rest_s : servo.rest_s;
    for (int i = 0; i < std::lround(rest_s / 0.013); ++i) {
      const double step_deg = 0.013 * servo.speed_deg_s;
      at_deg += std::clamp(to_deg - at_deg, -step_deg, step_deg);
      text += fmt::format("{:.3f};{:.1f};{:.3f}\n", time_s, to_deg, at_deg - servo.low_deg + noise());
      time_s += 0.013;
    }
  }
  return text;
}

TEST_F(Importing, TakesTheEndsOfRestsWhereTheDeviceStands) {
  const Imported imported = TakeReadings(20, StepTest({}));
  for (const Reading& r : imported.readings) {
    // Means of 20 rows of 0.01 deg and more: 0.0022 deg, four times.
    EXPECT_NEAR(Error_deg(r), -0.04, 0.01);
    EXPECT_GE(r.n_samples, 15) << "it stands for the last 0.3 s of each rest";
  }
  EXPECT_GT(imported.readings[5].dwell_s, 0.65) << "it is on its way for 0.68 s";
  EXPECT_THAT(imported.story, HasSubstr("before the device stood"));
  EXPECT_THAT(imported.story, Not(HasSubstr("still on its way")));
}

TEST_F(Importing, KeepsTwoThirdsOfTheRestsOfAFastServo) {
  const Imported imported = TakeReadings(20, StepTest({.speed_deg_s = 2000.0}));
  EXPECT_GE(imported.readings[5].n_samples, 45) << "of 77 rows";
}

/// A sine of 1 Hz that is sent 25 times a second and recorded 500 times: nothing is ever at rest.
TEST_F(Importing, TakesACommandThatIsHeldForAFewRowsAsMotion) {
  test::Noise noise(0.01, 4);
  const auto sine = [](double time_s) { return 20.0 * std::sin(2.0 * units::kPi * time_s); };
  std::string text = "time [s];commanded [deg];measured [deg]\n";
  for (int i = 0; i < 3000; ++i) {
    const double time_s = 0.002 * i, sent_s = 0.04 * (i / 20);
    text += fmt::format("{:.3f};{:.4f};{:.3f}\n", time_s, sine(sent_s), sine(time_s - 0.03) + noise());
  }
  const Imported imported = Take(text);
  ASSERT_EQ(imported.readings.size(), 150u) << "of each value that is new";
  EXPECT_THAT(imported.story, Says("taken as motion", "was held that is not new"));
  for (const Reading& r : imported.readings) EXPECT_NEAR(r.reference_rad / units::deg, sine(ToSeconds(r.time)), 0.001);
}

/// It has arrived all the same: nothing goes on.
TEST_F(Importing, TakesAServoThatHuntsAboutItsPlaceForOneThatArrived) {
  std::string text = "time [s];commanded [deg];measured [deg]\n";
  for (int i = 0; i < 1600; ++i) {
    const double to_deg = i / 80 % 2 == 0 ? 20.0 : 120.0;
    text += fmt::format("{:.2f};{};{}\n", 0.05 * i, to_deg, to_deg == 120.0 && i * i % 7 < 4 ? to_deg - 13.0 : to_deg);
  }
  const Imported imported = TakeReadings(20, text);
  EXPECT_THAT(imported.story, Not(HasSubstr("still on its way")));
}

/// A servo goes to 180 deg three times; there a hand pushes it to and fro, and it stays where it is pushed.
/// @param push  How far, in counts of 0.1 deg; how long is seven rows.
std::string Held(int push, int places = 1) {
  std::string text = "time [s],target [deg],position [deg]\n";
  int row = 0;
  const auto add = [&](double at_deg, int counts) {
    text += fmt::format("{:.1f},{},{:.1f}\n", 0.1 * row++, at_deg, at_deg + 0.1 * counts);
  };
  for (int rest = 0; rest < 3; ++rest) {
    for (int i = 0; i < 11; ++i) add(171.0, 4);
    const double at_deg = 180.0 + 9.0 * (rest % places);
    for (const int counts : {-90, -60, -20}) add(at_deg, counts);
    for (int i = 0; i < 56; ++i) add(at_deg, (i / 7 % 2 == 0 ? push : -push) + (i % 3 == 0 ? 1 : 0));
  }
  return text;
}

TEST_F(Importing, TellsWhichWayADeviceIsPushedWhileItsCommandRests) {
  const Imported held = Take(Held(4)), elsewhere = Take(Held(4, 3));
  EXPECT_NEAR(static_cast<double>(held.readings.size()), 3.0 * 56.0, 3.0)
      << "without the rests elsewhere and the rows on the way";
  EXPECT_EQ(held.readings.back().pass, 3 * 8 - 1) << "each push, and each rest";
  for (const Reading& r : held.readings) EXPECT_EQ(r.direction, r.measured_rad > r.reference_rad ? -1 : 1);
  EXPECT_EQ(elsewhere.readings.size(), held.readings.size());
  EXPECT_NEAR(elsewhere.readings.back().reference_rad / units::deg, 198.0, 1e-9);
  EXPECT_THAT(held.story, HasSubstr("the direction of a row is the side on which the device stands"));
}

TEST_F(Importing, TakesNeighbouringCountsForNoPush) {
  EXPECT_THAT(Take(Held(0)).story, Not(HasSubstr("pushed to and fro")));
}

TEST_F(Importing, SaysWhichRestsADeviceNeverReached) {
  const Imported some = TakeReadings(19, StepTest({.last_rest_s = 0.5}));
  EXPECT_THAT(some.story, HasSubstr("rows of 1 rests of the command at whose end the device was still on its way"));
}

/// A servo of 130 deg/s goes to and fro, and is where it was told at the beginning only.
TEST_F(Importing, RefusesStepsOfWhichNoneIsReached) {
  EXPECT_KEPT(MessageOf([&] { Take(StepTest({.speed_deg_s = 130.0})); }));
}

// The commonest test of backlash: one place, from both sides.

void ExpectBothSides(const Imported& imported, int readings) {
  ASSERT_EQ(std::ssize(imported.readings), readings);
  for (int i = 0; i < readings; ++i) {
    const Reading& r = imported.readings[static_cast<std::size_t>(i)];
    EXPECT_EQ(r.direction, i % 2 == 0 ? 1 : -1);
    EXPECT_EQ(r.pass, i);
    EXPECT_EQ(r.position, 0);
    EXPECT_NEAR(r.measured_rad / units::deg, i % 2 == 0 ? -0.052 - 0.001 * (i / 2) : -0.040, 1e-9) << "a degree a millimetre";
  }
}

std::string OnePlace(const char* names, const char* up, const char* down, int pairs) {
  std::string text = std::string(names) + "\n";
  for (int i = 0; i < pairs; ++i) text += fmt::format("0;{:.3f};{}\n0;-0.040;{}\n", -0.052 - 0.001 * i, up, down);
  return text;
}

TEST_F(Importing, TakesOnePlaceFromBothSidesByItsDirections) {
  ExpectBothSides(Take(OnePlace("commanded [mm];dial [mm];direction", "1", "-1", 10)), 20);
  ExpectBothSides(Take(OnePlace("Soll [mm];Messuhr [mm];Richtung", "vorwärts", "rückwärts", 10)), 20);
  ExpectBothSides(Take(OnePlace("target [mm];gauge [mm];approach", "+", "-", 2)), 4);
}

TEST_F(Importing, TakesOnePlaceInTwoColumns) {
  std::string text = "# dial at 0 mm\nup [mm];down [mm]\n";
  for (int i = 0; i < 3; ++i) text += fmt::format("{:.3f};-0.040\n", -0.052 - 0.001 * i);
  ExpectBothSides(Take(text), 6);
}

TEST_F(Importing, TakesOnePlaceByTheClock) {
  const Imported held = Take("time [s];target [mm];position [mm]\n0.0;5;5.01\n0.1;5;5.02\n0.2;5;5.01\n0.3;5;5.03\n");
  ASSERT_EQ(held.readings.size(), 4U);
  EXPECT_NEAR(ToSeconds(held.readings[3].time), 0.3, 1e-9);
}

TEST_F(Importing, SaysWhatAReferenceThatNeverMovesWouldNeed) {
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm]\n0;-0.052\n0;-0.040\n0;-0.063\n0;-0.045\n"); }));
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm];direction\n0;-0.052;1\n0;-0.040;1\n0;-0.063;1\n0;-0.045;1\n"); }));
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm];direction\n0;-0.052;1\n0;-0.040;-1\n"); }));
}

// Tables that a firmware interpolated without regard to the wrap.

constexpr int kStops = 200, kWrapsAt = 120;  // 1.8 deg a row

/// From 0 to 360 or from -180 to 180, with `between` rows on the straight line from one end of the wrap to the other.
std::vector<double> Interpolated(int between, double lowest) {
  std::vector<double> x;
  for (int i = 0; i < kStops; ++i) x.push_back(lowest + 360.0 * (i + kStops - kWrapsAt < kStops ? i + kStops - kWrapsAt : i - kWrapsAt) / kStops);
  const std::size_t first = kWrapsAt - 1, last = first + static_cast<std::size_t>(between) + 1;
  for (std::size_t i = first + 1; i < last; ++i)
    x[i] = x[first] + (x[last] - x[first]) * static_cast<double>(i - first) / static_cast<double>(last - first);
  return x;
}

std::string Table(const std::vector<double>& reference, const std::vector<double>& measured) {
  std::string text = "reference [deg],measured [deg]\n";
  for (std::size_t i = 0; i < reference.size(); ++i) text += fmt::format("{:.2f},{:.3f}\n", reference[i], measured[i]);
  return text;
}

std::vector<double> RoundOnce() {
  std::vector<double> x(kStops);
  std::iota(x.begin(), x.end(), 0.0);
  for (double& one : x) one *= 1.8;
  return x;
}

TEST_F(Importing, LeavesOutValuesBetweenTheEndsOfAWrap) {
  for (const int between : {1, 2, 5}) {
    for (const double lowest : {0.0, -180.0}) {
      const std::vector<double> broken = Interpolated(between, lowest);
      for (const bool in_reference : {true, false}) {
        const Imported imported = Take(in_reference ? Table(broken, RoundOnce()) : Table(RoundOnce(), broken));
        EXPECT_EQ(std::ssize(imported.readings), kStops - between) << imported.story;
        EXPECT_LT(Worst_deg(imported.readings), 0.01) << "the rounding of the file";
      }
    }
  }
  EXPECT_KEPT(Take(Table(Interpolated(5, 0.0), RoundOnce())).story);
}

TEST_F(Importing, LeavesOutValuesBetweenTheEndsOfAFallingWrap) {
  std::vector<double> falling = Interpolated(3, 0.0), other = RoundOnce();
  std::ranges::reverse(falling);
  std::ranges::reverse(other);
  EXPECT_EQ(std::ssize(Take(Table(falling, other)).readings), kStops - 3);
}

/// An axis that drives back to its start in a few rows was there: its device shows it.
TEST_F(Importing, KeepsAFastWayBack) {
  std::vector<double> there_and_back = RoundOnce();
  for (const double x : {300.0, 200.0, 100.0}) there_and_back.push_back(x);
  for (const double x : RoundOnce()) there_and_back.push_back(x);
  const Imported imported = Take(Table(there_and_back, there_and_back));
  EXPECT_EQ(std::ssize(imported.readings), 2 * kStops + 3);
  EXPECT_THAT(imported.story, Not(HasSubstr("interpolated")));
}

// Devices that follow late, or not all the way.

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
  EXPECT_THAT(Take(Beside("sample;goal [deg];position [deg]", 2400, Triangle, late)).story, HasSubstr("about 90 rows later: taken as motion"));
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
  for (const Reading& r : imported.readings)
    EXPECT_EQ(r.direction, Error_deg(r) > 0.1 ? -1 : 1) << "10.2 was come to from above; where it began the next step counts";
}

/// A servo that goes on swinging through its place by a third of the way.
TEST_F(Importing, TakesAServoThatSwingsThroughItsPlaceForNoPush) {
  constexpr int kRest = 500;
  const Wave command = [](int i) { return i / kRest % 2 == 1 ? 90.0 : 0.0; };
  const Wave servo = [&command](int i) {
    const double since = i % kRest, from = i < kRest ? 0.0 : 90.0 - command(i);
    return command(i) + 0.35 * (from - command(i)) * (std::cos(0.05 * since) > 0.0 ? 1.0 : -1.0);
  };
  EXPECT_THAT(Take(Beside("time [s];goal [deg];position [deg]", 8 * kRest, command, servo)).story, Not(HasSubstr("pushed")));
}

/// A row a second, each of another place within a turn.
TEST_F(Importing, TakesACommandThatEveryRowSendsElsewhereForAPlaceARow) {
  std::string text = "time [s];commanded [deg];feedback [deg]\n";
  std::mt19937 random(3);
  for (int i = 0; i < 120; ++i) {
    const double place = 0.1 * static_cast<double>(random() % 3600);
    text += fmt::format("{};{:.1f};{:.1f}\n", i, place, place + (i == 50 ? 20.0 : 0.0));
  }
  const Imported imported = TakeReadings(120, text);
  EXPECT_THAT(imported.story, HasSubstr("taken as stops"));
  EXPECT_NEAR(Worst_deg(imported.readings), 20.0 * 119 / 120, 1e-6);
}

/// Two encoders of a gear in counts, at rest for two thirds: rests close together say nothing of the whole way, and counts go round nowhere.
TEST_F(Importing, TellsARatioByTheWholeWay) {
  const Wave motor = [](int i) { return i < 1600 ? 30.0 * (i / 30 % 3) : 6000.0 * std::sin(0.5 * (i - 1600)); };
  const Wave output = [&motor](int i) { return i < 1600 ? 0.05 * motor(i) : 0.087 * motor(i) + 60.0 * std::sin(7.0 * i); };
  EXPECT_THAT(MessageOf([&] { Take(Beside("time [s];goal [deg];position [deg]", 2400, motor, output)); }), testing::ContainsRegex("times 0\\.0[89]"));
}

TEST_F(Importing, SaysWhatARecordingOfOneStepLacks) {
  const Wave step = [](int i) { return i < 40 ? 0.0 : 20.0; }, servo = [](int i) { return i < 40 ? 0.0 : 20.0 - 15.0 * std::exp(-0.2 * (i - 40)); };
  EXPECT_KEPT(MessageOf([&] { Take(Beside("time [s];goal [deg];position [deg]", 200, step, servo)); }));
}

}  // namespace
}  // namespace twinbench::imports
