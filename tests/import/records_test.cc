#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// Records in JSON, in the shapes in which programs write them.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr;

double Goal_rad(int i) { return 1.5 * std::sin(0.02 * i); }

/// A servo that is where it was told 0.06 s ago, every 0.02 s.
std::string Record(int i) {
  return fmt::format(R"({{"position": {:.5f}, "goal_position": {:.5f}, "temp": 37.0, "on": true, "timestamp": {:.2f}}})", Goal_rad(i - 3),
                     Goal_rad(i), 0.02 * i);
}

void ExpectServo(const Imported& imported) {
  ASSERT_EQ(imported.readings.size(), 400u);
  const Reading& r = imported.readings.at(100);
  EXPECT_NEAR(ToSeconds(r.time), 2.0, 1e-9);
  EXPECT_NEAR(r.reference_rad, Goal_rad(100), 1e-5) << "programs count in rad";
  EXPECT_NEAR(r.measured_rad, Goal_rad(97), 1e-5);
  EXPECT_THAT(imported.story, HasSubstr("motion that is read while it goes on"));
}

TEST_F(Importing, ReadsAnObjectALineAndCountsALastOneThatWasCutOff) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += Record(i) + "\n";
  ExpectServo(Take(text));
  EXPECT_THAT(Take(text).story, HasSubstr("its unit is not said and taken as rad"));
  const Imported cut = Take(text + R"({"position": 0.1, "goal_)");
  ExpectServo(cut);
  EXPECT_THAT(cut.story, HasSubstr("left out: 1 lines that are no object in JSON"));
}

TEST_F(Importing, ReadsAListOfObjectsWhereverItIs) {
  std::string list;
  for (int i = 0; i < 400; ++i) list += (i > 0 ? ",\n" : "") + Record(i);
  ExpectServo(Take("[" + list + "]"));
  ExpectServo(Take(R"({"kp": 32, "gains": [1, 2, 3], "log": {"entries": [)" + list + "]}}"));
}

/// One recording in a list of recordings, and the rate among the settings.
TEST_F(Importing, ReadsListsOfOneLengthInAListOfOne) {
  std::string goal, position;
  for (int i = 0; i < 400; ++i) {
    goal += fmt::format("{}{:.5f}", i > 0 ? ", " : "", Goal_rad(i));
    position += fmt::format("{}{:.5f}", i > 0 ? ", " : "", Goal_rad(i - 3));
  }
  ExpectServo(Take(R"({"config": {"control_hz": 50, "limits": [-1.6, 1.6]}, "data": [{"kind": "sine", "marks": [], "goal": [)" + goal +
                   R"(], "sensor_data": [)" + position + "]}]}"));
}

TEST_F(Importing, ReadsListsOfOneLength) {
  std::string goal, position, time, rows;
  for (int i = 0; i < 400; ++i) {
    const char* comma = i > 0 ? ", " : "";
    goal += fmt::format("{}{:.5f}", comma, Goal_rad(i));
    position += fmt::format("{}{:.5f}", comma, Goal_rad(i - 3));
    time += fmt::format("{}{:.2f}", comma, 0.02 * i);
    rows += fmt::format(", [{:.2f}, {:.5f}, {:.5f}]", 0.02 * i, Goal_rad(i), Goal_rad(i - 3));
  }
  ExpectServo(Take(fmt::format(R"({{"rate": 50, "goal": [{}], "position": [{}], "t": [{}]}})", goal, position, time)));
  ExpectServo(Take(R"([["t", "goal", "position"])" + rows + "]"));
}

TEST_F(Importing, NamesWhatStandsFurtherDownWithADot) {
  std::string text;
  for (int i = 0; i < 400; ++i)
    text += fmt::format(R"({{"t": {:.2f}, "command": {{"q": [{:.5f}]}}, "state": {{"q": [{:.5f}, 7], "dq": NaN}}}})", 0.02 * i, Goal_rad(i),
                        Goal_rad(i - 3)) + "\n";
  ExpectServo(Take(text, "[columns]\nreference_rad = \"command.q\"\nmeasured_rad = \"state.q.0\"\n"));
}

TEST_F(Importing, RefusesJsonWithoutRecords) {
  for (const char* text : {R"({"kp": 32, "ki": 1})", R"([{"a": 1}, {"a": 2)", R"([[1, 2, 3], [3, 4, 8], [5, 6, 9]])"})
    EXPECT_KEPT(MessageOf([&] { Take(text); }));
}

// Logs of a controller on a circle, which say nothing but where the axes were sent and where they were.

constexpr double kRadius_mm = 50.0, kOutwards_um = 5.0, kStep_s = 0.01, kRate_rad_s = 1.0;  // 3000 mm/min

/// Once round each way about (x, y) mm, a second of rest before each and behind it; the axes are 5 um further out than sent.
std::string Log(const std::string& names, double x_mm, double y_mm) {
  std::string text = names + "\n";
  double time_s = 0.0;
  const auto row = [&](double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad), out_mm = kRadius_mm + kOutwards_um / 1000.0;
    text += fmt::format("{:.3f};{:.6f};{:.6f};{:.6f};{:.6f}\n", time_s, x_mm + kRadius_mm * c, y_mm + kRadius_mm * s, x_mm + out_mm * c, y_mm + out_mm * s);
    time_s += kStep_s;
  };
  for (const int direction : {1, -1}) {
    for (int k = 0; k < 100; ++k) row(0.0);
    for (int k = 1; k <= 628; ++k) row(direction * kRate_rad_s * kStep_s * k);
    for (int k = 0; k < 100; ++k) row(direction * kRate_rad_s * kStep_s * 628);
  }
  return text;
}

class XyLog : public Importing {
 protected:
  static void Expect(const Imported& taken) {
    const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, feed_m_s{"feed_mm_min"}, at_x_m{"grid_x_mm"}, at_y_m{"grid_y_mm"};
    EXPECT_EQ(taken.bench, "circular_motion");
    // None of the rows at rest is a reading, nor are those of the 60 ms behind them, in which an axis takes its lag up.
    EXPECT_NEAR(static_cast<double>(taken.readings.size()), 2.0 * (628.0 - 6.0), 4.0) << taken.story;
    double rows[2] = {0.0, 0.0};
    for (const Reading& r : taken.readings) {
      // The highest place of such steps is (0.005 rad)^2 / 2 of the radius below the circle's, at most.
      EXPECT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, kRadius_mm, 1e-3);
      EXPECT_NEAR(feed_m_s(r) * 60.0 / units::mm, 3000.0, 1e-6);
      EXPECT_NEAR((std::hypot(at_x_m(r), at_y_m(r)) - std::hypot(x_m(r), y_m(r))) / units::um, kOutwards_um, 0.01);
      rows[r.direction > 0 ? 0 : 1] += 1.0;
    }
    EXPECT_NEAR(rows[0], rows[1], 4.0);
    EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
  }
};

TEST_F(XyLog, HasCentreRadiusFeedAndDirectionOfTheCommandedCircle) {
  Expect(Take(Log("time_s;cmd_x_mm;cmd_y_mm;act_x_mm;act_y_mm", 0.0, 0.0)));
  Expect(Take(Log("t [s];Soll X [mm];Soll Y [mm];Ist X [mm];Ist Y [mm]", -160.0, -198.0)));
}

TEST_F(XyLog, MayBeOfOtherPlanes) {
  Expect(Take(Log("time [s];commanded Y (mm);commanded Z (mm);actual Y (mm);actual Z (mm)", 10.0, 300.0)));
}

/// On a radius towards the circle, as fast as on it, behind a second and a half at rest: what the axes lag by changes where it
/// ends, and the names are those of a controller.
TEST_F(XyLog, LeavesARunInOutThatIsAsFastAsTheCircle) {
  std::string text = "Zeit [ms];X Soll [mm];Y Soll [mm];X Ist [mm];Y Ist [mm]\n";
  std::vector<std::pair<double, double>> sent(800, {60.0, 20.0});
  for (int k = 1; k <= 20; ++k) sent.emplace_back(60.0 - 0.5 * k, 20.0);
  for (int k = 1; k <= 628; ++k) sent.emplace_back(50.0 * std::cos(0.01 * k), 20.0 + 50.0 * std::sin(0.01 * k));
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const auto [late_x, late_y] = sent[i > 0 ? i - 1 : 0];
    text += fmt::format("{};{:.6f};{:.6f};{:.6f};{:.6f}\n", 10 * i, sent[i].first, sent[i].second, late_x, late_y);
  }
  const Imported taken = Take(text);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map xy_log"));
  EXPECT_NEAR(static_cast<double>(taken.readings.size()), 628.0 - 6.0, 3.0) << taken.story;
  const Quantity x_m{"grid_x_mm"}, y_m{"grid_y_mm"};
  for (const Reading& r : taken.readings) EXPECT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, 50.0, 0.01);
}

// All that goes before, between and behind the circles is in such logs too.

/// Rows of a tool that goes from angle to angle on 40 mm about (-160, 75) mm, all of them one after the other.
class DriveLog : public Importing {
 protected:
  void Arc(double from_rad, double to_rad, double feed_mm_min) {
    constexpr double radius_mm = 40.0, step_s = 0.004;
    const double rate = feed_mm_min / 60.0 / radius_mm, way = std::abs(to_rad - from_rad);
    for (double gone = 0.0; gone < way; gone += rate * step_s) {
      const double at = from_rad + std::copysign(gone, to_rad - from_rad);
      const double x = -160.0 + radius_mm * std::cos(at), y = 75.0 + radius_mm * std::sin(at);
      text_ += fmt::format("{:.4f}\t{:.6f}\t{:.6f}\t{:.6f}\t{:.6f}\n", time_s_ += step_s, x, y,
                           x + 0.001 * std::cos(2.0 * at), y);
    }
  }
  /// At a steadily changing feed.
  void Ramp(double at_rad, double from_mm_min, double to_mm_min, int sense) {
    double angle = at_rad;
    for (int k = 0; k < 30; ++k) {
      const double feed = from_mm_min + (to_mm_min - from_mm_min) * k / 30.0,
                   next = angle + sense * feed / 60.0 / 40.0 * 0.004;
      Arc(angle, next, feed);
      angle = next;
    }
  }
  std::string text_ = "Zeit [s]\tSoll Y [mm]\tSoll Z [mm]\tIst Y [mm]\tIst Z [mm]\n";
  double time_s_ = 0.0;
};

TEST_F(DriveLog, MayHaveSeveralFeedsOneAfterTheOther) {
  for (const double feed_mm_min : {1000.0, 4000.0}) {
    for (const int sense : {1, -1}) {
      Ramp(0.0, 10.0, feed_mm_min, sense);
      Arc(0.0, sense * units::turn, feed_mm_min);
    }
  }
  const Imported taken = Take(text_);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map xy_log"));
  EXPECT_THAT(taken.set, Contains("circular_procedure.feeds_mm_min=[1000, 4000]"));
  EXPECT_THAT(taken.set, Contains(HasSubstr("instrument=\"drive\"")));
  const Quantity feed_m_s{"feed_mm_min"};
  std::set<std::pair<int, long>> passes;
  for (const Reading& r : taken.readings) passes.insert({r.direction, std::lround(feed_m_s(r) * 60.0 / units::mm)});
  EXPECT_EQ(passes, (std::set<std::pair<int, long>>{{-1, 1000}, {-1, 4000}, {1, 1000}, {1, 4000}}));
}

}  // namespace
}  // namespace twinbench::imports
