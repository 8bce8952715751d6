#include "tools/twinbench/light_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "optics/irradiance.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPixels = 120;       // of a side
constexpr double kDark = 1e-4;         // of the largest value
constexpr double kPerMm2 = 1e-6;       // W/m^2 -> W/mm^2

/// Rows and columns, the last not included.
struct Window {
  int top, bottom, left, right;
};

Window LitWindow(const optics::IrradianceMap& map) {
  const float largest = *std::max_element(map.irradiance_W_m2.begin(), map.irradiance_W_m2.end());
  Window window{map.height, 0, map.width, 0};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (!(map.At(row, column) > kDark * largest)) continue;
      window = {std::min(window.top, row), std::max(window.bottom, row + 1), std::min(window.left, column), std::max(window.right, column + 1)};
    }
  }
  return window.top < window.bottom ? window : Window{0, map.height, 0, map.width};
}

/// With dark about the light, so that its edge can be seen; a fine beam is one pixel.
Window WithMargin(Window window, const optics::IrradianceMap& map) {
  constexpr int kLeast = 20;
  const int margin = std::max({kLeast, (window.bottom - window.top) / 5, (window.right - window.left) / 5});
  return {std::max(0, window.top - margin), std::min(map.height, window.bottom + margin), std::max(0, window.left - margin),
          std::min(map.width, window.right + margin)};
}

/// Mean over `factor` by `factor` pixels.
double CoarsePixel(const optics::IrradianceMap& map, int row, int column, int factor) {
  double sum = 0.0;
  int n = 0;
  for (int r = row; r < std::min(row + factor, map.height); ++r) {
    for (int c = column; c < std::min(column + factor, map.width); ++c) sum += map.At(r, c), ++n;
  }
  return n > 0 ? sum / n : 0.0;
}

/// Four digits are more than colours show.
double Rounded(double value) {
  return std::stod(fmt::format("{:.4g}", value));
}

report::PageImage PictureOf(const optics::IrradianceMap& map, const std::string& file) {
  const Window window = WithMargin(LitWindow(map), map);
  const int size = std::max(window.bottom - window.top, window.right - window.left);
  const int factor = std::max(1, (size + kMostPixels - 1) / kMostPixels);
  report::PageImage image{map.name + ", " + file, "", 0, 0, map.pitch_m * 1e3 * factor, "W/mm2", {}};
  const optics::MapCentroid centroid = Centroid(map);
  image.note = fmt::format("{:.4g} mW, centroid at ({:.4f}, {:.4f}) mm", centroid.power_W * 1e3, centroid.u_m * 1e3, centroid.v_m * 1e3);
  for (int row = window.top; row < window.bottom; row += factor) {
    ++image.height;
    for (int column = window.left; column < window.right; column += factor) image.values.push_back(Rounded(CoarsePixel(map, row, column, factor) * kPerMm2));
  }
  image.width = static_cast<int>(image.values.size()) / image.height;
  return image;
}

}  // namespace

std::vector<report::PageImage> LightPictures(const std::string& folder) {
  if (!fs::is_directory(folder)) return {};
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".exr") files.insert(entry.path());
  }
  std::vector<report::PageImage> images;
  for (const fs::path& file : files) {
    for (const optics::IrradianceMap& map : optics::ReadIrradianceMaps(file.string())) {
      if (!map.irradiance_W_m2.empty()) images.push_back(PictureOf(map, file.filename().string()));
    }
  }
  return images;
}

}  // namespace twinbench::tools
