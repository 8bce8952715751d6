#include "twin/core/sampled_curve.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"

namespace twinbench {
namespace {

TEST(SampledCurve, IsStraightBetweenPlacesAndLevelBeyondTheEndsAndReadFromItsColumnsInSIUnits) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("inl.csv", "error_mV,voltage_V\n2,-1\n4,1\n");
  EXPECT_DOUBLE_EQ(ReadSampledCurve(path, {"voltage_V"}, {"error_mV", 1e-3}).At(0.0), 3e-3);
  for (const double place : {-1.0, 3.0, 4.0}) EXPECT_EQ(SampledCurve({3.0}, {7.0}).At(place), 7.0) << "one place";
  const SampledCurve curve({1.0, 2.0, 4.0}, {10.0, 20.0, 0.0});
  const std::vector<std::pair<double, double>> expected = {{-5.0, 10.0}, {1.0, 10.0}, {1.5, 15.0}, {2.0, 20.0},
                                                           {3.0, 10.0},  {4.0, 0.0},  {9.0, 0.0}};
  for (const auto& [place, value] : expected) EXPECT_DOUBLE_EQ(curve.At(place), value) << place;
}

TEST(SampledCurve, AFileThatCannotBeUsedIsNamedWithItsLine) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    return MessageOf([&] { ReadSampledCurve(folder.Write("room.csv", text), {"time_s"}, {"temperature_degC"}); });
  };
  ExpectRefused(folder.File("room.csv"), message,
                {{1, "time_s\n1\n"}, {4, "time_s,temperature_degC\n0,20\n5,21\n5,22\n"}});
  EXPECT_KEPT(message("time_s,temperature_degC\n"));
}

}  // namespace
}  // namespace twinbench
