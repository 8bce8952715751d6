#include "optics/stl.h"

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/support/kept_text.h"

namespace twinbench::optics {
namespace {

/// Corners that float holds exactly, so that both forms of the file keep every bit.
TriangleMesh Box() {
  return BoxMesh({-1.5, -2.0, -0.25}, {1.5, 2.0, 0.25});
}

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
    try {
      Read(bytes);
    } catch (const std::runtime_error& error) {
      const std::string what = error.what();
      EXPECT_THAT(what, testing::StartsWith(path_ + ":"));
      return what.substr(path_.size());
    }
    return "(no error)";
  }
  ~StlFile() override { std::filesystem::remove(path_); }

  std::string path_ =
      testing::TempDir() + "twinbench_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".stl";
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
