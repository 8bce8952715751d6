#include "optics/stl.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace twinbench::optics {
namespace {

static_assert(std::endian::native == std::endian::little, "the fields of a binary STL file are little-endian");

constexpr std::size_t kHeaderBytes = 80, kCountBytes = 4, kTriangleBytes = 50, kNormalBytes = 12;

std::string ReadAll(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

void AddTriangle(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 3>& corners_m) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  mesh.vertices_m.insert(mesh.vertices_m.end(), corners_m.begin(), corners_m.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// --- binary ---

std::size_t CountOf(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeaderBytes + kCountBytes) std::memcpy(&count, bytes.data() + kHeaderBytes, kCountBytes);
  return count;
}

std::size_t SizeFor(std::size_t triangles) {
  return kHeaderBytes + kCountBytes + triangles * kTriangleBytes;
}

TriangleMesh ParseBinary(const std::string& bytes, double unit_m) {
  TriangleMesh mesh;
  for (std::size_t n = 0; n < CountOf(bytes); ++n) {
    std::array<std::array<float, 3>, 3> corners;
    std::memcpy(&corners, bytes.data() + SizeFor(n) + kNormalBytes, sizeof corners);
    const auto corner_m = [&](std::size_t i) -> Eigen::Vector3d {
      return unit_m * Eigen::Vector3d(corners[i][0], corners[i][1], corners[i][2]);
    };
    AddTriangle(mesh, {corner_m(0), corner_m(1), corner_m(2)});
  }
  return mesh;
}

// --- text ---

using Words = std::vector<std::string>;

Words WordsOf(std::string line) {
  std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// One text file on its way through the lines.
class TextStl {
 public:
  TextStl(const std::string& path, double unit_m) : path_(path), unit_m_(unit_m) {}

  void Take(const Words& words) {
    ++line_;
    if (words.empty()) return;
    const std::string& what = words.front();
    if (what == "vertex") {
      TakeVertex(words);
    } else if (what == "facet") {
      corners_m_.clear();
    } else if (what == "endfacet") {
      EndFacet();
    } else if (what == "endsolid") {
      ended_ = true;
    } else if (what != "solid" && what != "outer" && what != "endloop") {
      Refuse("\"" + what + "\" is no word of an STL file");
    }
  }

  TriangleMesh End() const {
    if (!ended_) Refuse("the file ends without endsolid: it is cut off");
    return mesh_;
  }

 private:
  [[noreturn]] void Refuse(const std::string& what) const {
    throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + what);
  }

  void TakeVertex(const Words& words) {
    Eigen::Vector3d corner;
    if (words.size() != 4) Refuse("a vertex has " + std::to_string(words.size() - 1) + " coordinates, not 3");
    for (int i = 0; i < 3; ++i) corner[i] = Number(words[static_cast<std::size_t>(i) + 1]);
    corners_m_.push_back(unit_m_ * corner);
  }

  double Number(const std::string& word) const {
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double number = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || stop != end) Refuse("\"" + word + "\" is no number");
    return number;
  }

  void EndFacet() {
    if (corners_m_.size() != 3) Refuse("a facet has " + std::to_string(corners_m_.size()) + " vertices, not 3");
    AddTriangle(mesh_, {corners_m_[0], corners_m_[1], corners_m_[2]});
  }

  std::string path_;
  double unit_m_;
  int line_ = 0;
  std::vector<Eigen::Vector3d> corners_m_;
  TriangleMesh mesh_;
  bool ended_ = false;
};

TriangleMesh ParseText(const std::string& text, const std::string& path, double unit_m) {
  TextStl stl(path, unit_m);
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) stl.Take(WordsOf(line));
  return stl.End();
}

TriangleMesh Parse(const std::string& bytes, const std::string& path, double unit_m) {
  // Some programs begin binary files with "solid" too: the size decides.
  if (CountOf(bytes) > 0 && bytes.size() == SizeFor(CountOf(bytes))) return ParseBinary(bytes, unit_m);
  const Words first = WordsOf(bytes.substr(0, bytes.find('\n')));
  const bool binary = bytes.find('\0') != std::string::npos;
  if (!binary && !first.empty() && first.front() == "solid") return ParseText(bytes, path, unit_m);
  throw std::runtime_error(path + ": neither a text STL file nor as long as a binary one of " +
                           std::to_string(CountOf(bytes)) + " triangles");
}

}  // namespace

TriangleMesh ReadStl(const std::string& path, double unit_m) {
  const TriangleMesh mesh = Parse(ReadAll(path), path, unit_m);
  if (mesh.triangles.empty()) throw std::runtime_error(path + ": has no triangle");
  const bool finite = std::ranges::all_of(mesh.vertices_m, [](const Eigen::Vector3d& v) { return v.allFinite(); });
  if (!finite) throw std::runtime_error(path + ": a coordinate is not finite");
  return mesh;
}

}  // namespace twinbench::optics
