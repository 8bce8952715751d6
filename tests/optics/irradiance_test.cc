#include "optics/irradiance.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"

namespace twinbench::optics {
namespace {

using ::testing::HasSubstr;

IrradianceMap SpotMap(const std::string& name, double u_m, double v_m) {
  IrradianceMap map;
  map.name = name;
  map.width = 200;
  map.height = 120;
  map.pitch_m = 10e-6;
  map.wavelength_m = 650e-9;
  map.power_W = 1.7e-3;
  map.order = -1;
  map.X_LP = Eigen::Translation3d(0.1, -0.2, 1.0 / 3.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double r2 = std::pow(map.U(column) - u_m, 2) + std::pow(map.V(row) - v_m, 2);
      map.irradiance_W_m2.push_back(static_cast<float>(1e4 * std::exp(-r2 / (2 * 0.1e-3 * 0.1e-3))));
    }
  }
  return map;
}

TEST(IrradianceMaps, ComeBackFromTheirFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("round_trip.exr");
  const std::vector<IrradianceMap> written = {SpotMap("psd.p1", 12e-6, -7e-6), SpotMap("psd.m1", -100e-6, 30e-6)};
  WriteIrradianceMaps(path, written);
  const std::vector<IrradianceMap> read = ReadIrradianceMaps(path);
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, written[i].name);
    EXPECT_EQ(read[i].width, 200);
    EXPECT_EQ(read[i].height, 120);
    EXPECT_NEAR(read[i].pitch_m, 10e-6, 1e-20);
    EXPECT_NEAR(read[i].wavelength_m, 650e-9, 1e-21);
    EXPECT_EQ(read[i].power_W, 1.7e-3);
    EXPECT_EQ(read[i].order, -1);
    EXPECT_EQ(read[i].X_LP.matrix(), written[i].X_LP.matrix());
    // 1e-6 um: float pixels lose 6e-8 each, averaged over ten thousand of them.
    EXPECT_NEAR(Centroid(read[i]).u_m, Centroid(written[i]).u_m, 1e-12);
    EXPECT_NEAR(Centroid(read[i]).v_m, Centroid(written[i]).v_m, 1e-12);
  }
}

TEST(IrradianceMaps, HavePositiveVAtTheTop) {
  const IrradianceMap map = SpotMap("psd", 0.0, 0.4e-3);
  EXPECT_GT(map.At(20, 100), map.At(100, 100));
  EXPECT_NEAR(map.V(0), 0.595e-3, 1e-18);
  EXPECT_GT(Centroid(map).v_m, 0.3e-3);
}

std::string MessageOfReading(const std::string& path) {
  try {
    ReadIrradianceMaps(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(IrradianceMaps, NameTheFileThatCannotBeReadOrIsCutShortOrHasNegativeLight) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("text.exr", "this is no picture"), cut = folder.File("cut.exr");
  EXPECT_THAT(MessageOfReading("/nowhere/beam.exr"), HasSubstr("/nowhere/beam.exr"));
  EXPECT_THAT(MessageOfReading(path), HasSubstr(path));
  IrradianceMap map = SpotMap("psd", 0, 0);
  WriteIrradianceMaps(cut, {map});
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
  EXPECT_THAT(MessageOfReading(cut), HasSubstr(cut));
  map.irradiance_W_m2[77] = -1.0f;
  WriteIrradianceMaps(path, {map});
  EXPECT_KEPT(MessageOfReading(path));
}

/// The file of a map with the bytes behind `before` replaced.
std::string WithHeader(const std::string& before, std::size_t behind, const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.File("header.exr");
  WriteIrradianceMaps(path, {SpotMap("psd", 0, 0)});
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  std::string file = text.str();
  file.replace(file.find(before) + before.size() + behind, bytes.size(), bytes);
  std::ofstream(path, std::ios::binary) << file;
  return MessageOfReading(path);
}

TEST(IrradianceMaps, AreRefusedBeforeTheyAreGivenMemoryThatTheFileCannotFill) {
  const std::string window("dataWindow\0box2i\0", 17), units("bench:units\0string\0", 19);
  // 16000 x 16000 and -2^31 to 2^31 - 1, behind the attribute's own size of four bytes.
  EXPECT_KEPT(WithHeader(window, 12, std::string("\x7f\x3e\0\0\x7f\x3e\0\0", 8)));
  EXPECT_KEPT(WithHeader(window, 4, std::string("\0\0\0\x80\0\0\0\x80\xff\xff\xff\x7f\xff\xff\xff\x7f", 16)));
  EXPECT_KEPT(WithHeader(units, 0, std::string("\0\0\0\x30", 4)));
}

TEST(IrradianceMaps, CannotBeWrittenWhereThereIsNoFolder) {
  EXPECT_THROW(WriteIrradianceMaps("/nowhere/at/all.exr", {SpotMap("psd", 0, 0)}), std::runtime_error);
  EXPECT_THROW(WriteIrradianceMaps(TemporaryFolder().File("x.exr"), {SpotMap("a", 0, 0), SpotMap("a", 0, 0)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
