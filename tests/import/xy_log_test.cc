#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/import/importing.h"
#include "twin/core/reading_column.h"

// Logs of a controller on a circle, which say nothing but where the axes were sent and where they were.
namespace twinbench::imports {
namespace {

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
    // Of the rows at rest none is a reading; the first in motion may be taken for one.
    EXPECT_NEAR(static_cast<double>(taken.readings.size()), 2.0 * 628.0, 4.0) << taken.story;
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

}  // namespace
}  // namespace twinbench::imports
