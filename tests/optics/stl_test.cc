#include "optics/stl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

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

TEST_F(StlFile, OfTextComesBackToTheSameBits) {
  ExpectSameTriangles(Read(TextOf(Box()), 1e-3), Box(), 1e-3);
}

TEST_F(StlFile, OfBytesComesBackToTheSameBits) {
  ExpectSameTriangles(Read(BinaryOf(Box()), 25.4e-3), Box(), 25.4e-3);
}

TEST_F(StlFile, ThatBeginsWithSolidIsBinaryIfItsSizeSaysSo) {
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

TEST_F(StlFile, ThatIsNoneOrCutOffIsNamed) {
  const std::string binary = BinaryOf(Box()), text = TextOf(Box());
  EXPECT_EQ(ErrorOf(""), ": neither a text STL file nor as long as a binary one of 0 triangles");
  EXPECT_EQ(ErrorOf("ply\nformat ascii 1.0\n"),
            ": neither a text STL file nor as long as a binary one of 0 triangles");
  EXPECT_EQ(ErrorOf(binary.substr(0, binary.size() - 1)),
            ": neither a text STL file nor as long as a binary one of 12 triangles");
  EXPECT_EQ(ErrorOf(binary + "x"), ": neither a text STL file nor as long as a binary one of 12 triangles");
  EXPECT_EQ(ErrorOf(text.substr(0, text.find("endsolid"))),
            ":85: the file ends without endsolid: it is cut off");  // 1 + 12 triangles of 7 lines
  EXPECT_EQ(ErrorOf("solid empty\nendsolid empty\n"), ": has no triangle");
  EXPECT_THROW(ReadStl("/nowhere/a.stl", 1.0), std::runtime_error);
}

TEST_F(StlFile, WithABadLineGivesItsNumber) {
  const auto facet = [](const std::string& vertices) {
    return "solid x\nfacet normal 0 0 1\nouter loop\n" + vertices + "endloop\nendfacet\nendsolid x\n";
  };
  EXPECT_EQ(ErrorOf(facet("vertex 1 2\n")), ":4: a vertex has 2 coordinates, not 3");
  EXPECT_EQ(ErrorOf(facet("vertex 1 2 3\nvertex 1 2 3mm\n")), ":5: \"3mm\" is no number");
  EXPECT_EQ(ErrorOf(facet("vertex 1 2 3\nvertex 1 2 3\n")), ":7: a facet has 2 vertices, not 3");
  EXPECT_EQ(ErrorOf(facet("color 1 2 3\n")), ":4: \"color\" is no word of an STL file");
}

TEST_F(StlFile, WithACoordinateThatIsNotFiniteIsRefused) {
  TriangleMesh mesh = Box();
  mesh.vertices_m[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ErrorOf(BinaryOf(mesh)), ": a coordinate is not finite");
  EXPECT_EQ(ErrorOf(TextOf(mesh)), ": a coordinate is not finite");
}

}  // namespace
}  // namespace twinbench::optics
