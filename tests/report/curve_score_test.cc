#include "twin/report/curve_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace twinbench::report {
namespace {

TEST(CurveScore, TellsTheLargestErrorOfEitherSignAndLeavesOutWhatIsNotKnown) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const CurveScore curve{"turntable", "ez_arcsec", "position_deg", {0.0, 90.0, 180.0, 270.0}, {1.0, -2.5, 0.5, kNaN},
                         {0.5, 0.5, 0.5, 0.5}, {0.0, 0.5, 0.0, 0.0}};
  const nlohmann::json score = ToJson({curve})["turntable"]["ez"];
  EXPECT_DOUBLE_EQ(score["worst_error_arcsec"].get<double>(), 3.0);
  EXPECT_NEAR(score["rms_error_arcsec"].get<double>(), std::sqrt((1.0 + 9.0 + 0.25) / 3.0), 1e-12);
}

}  // namespace
}  // namespace twinbench::report
