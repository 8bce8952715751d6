#include <gmock/gmock.h>

#include "optics/irradiance.h"
#include "optics/stl.h"
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
  return MessageOf<std::runtime_error>([&] { ReadIrradianceMaps(path); });
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
  std::string file = Contents(path);
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

/// Corners that float holds exactly, so that both forms of the file keep every bit.
TriangleMesh Box() { return BoxMesh({-1.5, -2.0, -0.25}, {1.5, 2.0, 0.25}); }

std::string TextOf(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "solid a box\n";
  for (const auto& triangle : mesh.triangles) {
    out << "  facet normal 0 0 0\n    outer loop\n";
    for (const auto i : triangle) out << "      vertex " << mesh.vertices_m[i].transpose() << "\n";
    out << "    endloop\n  endfacet\n";
  }
  out << "endsolid a box\n";
  return out.str();
}

std::string BinaryOf(const TriangleMesh& mesh, const std::string& header = "a box") {
  std::string bytes = header + std::string(80 - header.size(), ' ');
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    append(std::array<float, 3>{});
    for (const auto i : triangle) append(Eigen::Vector3f(mesh.vertices_m[i].cast<float>()));
    append(std::uint16_t{0});
  }
  return bytes;
}

/// A file that goes with its test.
class StlFile : public ::testing::Test {
 protected:
  TriangleMesh Read(const std::string& bytes, double unit_m = 1.0) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return ReadStl(path_, unit_m);
  }
  /// What is said about the file, without its path.
  std::string ErrorOf(const std::string& bytes) {
    const std::string what = MessageOf<std::runtime_error>([&] { Read(bytes); });
    EXPECT_THAT(what, testing::StartsWith(path_ + ":"));
    return what.substr(path_.size());
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.File("file.stl");
};

void ExpectSameTriangles(const TriangleMesh& read, const TriangleMesh& written, double unit_m) {
  ASSERT_EQ(read.triangles.size(), written.triangles.size());
  for (std::size_t t = 0; t < read.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(read.vertices_m[read.triangles[t][i]], unit_m * written.vertices_m[written.triangles[t][i]]);
  }
}

TEST_F(StlFile, OfTextOrBytesComesBackToTheSameBits) {
  ExpectSameTriangles(Read(TextOf(Box()), 1e-3), Box(), 1e-3);
  ExpectSameTriangles(Read(BinaryOf(Box()), 25.4e-3), Box(), 25.4e-3);
  // One that begins with "solid" is binary if its size says so.
  ExpectSameTriangles(Read(BinaryOf(Box(), "solid made by a CAD program")), Box(), 1.0);
}

TEST_F(StlFile, OfTextMayHaveCapitalsAndForeignLineEnds) {
  const std::string text =
      "SOLID x\r\n\r\nFACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX +1.0E+1 0 0\r\nVERTEX 0 -2e-1 0\r\nVERTEX 0 0 "
      "3\r\n"
      "ENDLOOP\r\nENDFACET\r\nENDSOLID x\r\n";
  const TriangleMesh mesh = Read(text);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices_m[0], Eigen::Vector3d(10.0, 0.0, 0.0));
  EXPECT_EQ(mesh.vertices_m[1], Eigen::Vector3d(0.0, -0.2, 0.0));
}

TEST_F(StlFile, ThatIsNoneOrCutOffOrHasABadLineIsNamedWithIt) {
  const std::string binary = BinaryOf(Box()), text = TextOf(Box());
  TriangleMesh infinite = Box();
  infinite.vertices_m[3].y() = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& bytes :
       {std::string(), std::string("ply\nformat ascii 1.0\n"), binary.substr(0, binary.size() - 1), binary + "x",
        std::string("solid empty\nendsolid empty\n"), BinaryOf(infinite), TextOf(infinite)}) {
    EXPECT_THAT(ErrorOf(bytes), testing::StartsWith(": "));
    EXPECT_KEPT(ErrorOf(bytes));
  }
  const std::pair<int, std::string> vertices[] = {{4, "vertex 1 2\n"}, {5, "vertex 1 2 3\nvertex 1 2 3mm\n"},
                                                  {7, "vertex 1 2 3\nvertex 1 2 3\n"}, {4, "color 1 2 3\n"}};
  for (const auto& [line, lines] : vertices) {
    const std::string facet =
        "solid x\nfacet normal 0 0 1\nouter loop\n" + lines + "endloop\nendfacet\nendsolid x\n";
    EXPECT_THAT(ErrorOf(facet), testing::StartsWith(":" + std::to_string(line) + ": "));
    EXPECT_KEPT(ErrorOf(facet));
  }
  const std::string cut = text.substr(0, text.find("endsolid"));
  EXPECT_THAT(ErrorOf(cut), testing::StartsWith(":85: "));  // 1 + 12 triangles of 7 lines
  EXPECT_KEPT(ErrorOf(cut));
  EXPECT_THROW(ReadStl("/nowhere/a.stl", 1.0), std::runtime_error);
}

}  // namespace
}  // namespace twinbench::optics
