#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

/// Heights of a surface above its nominal form, as a picture with physical size in an OpenEXR file.
namespace twinbench::optics {

/// Row 0 is at the top of the picture, which is the largest y; +x is to the right, the origin in the middle.
struct HeightMap {
  int width = 0, height = 0;  // pixels
  double pitch_m = std::numeric_limits<double>::quiet_NaN();
  std::vector<float> height_um;  // row by row

  float At(int row, int column) const {
    return height_um[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column)];
  }
};

/// Height [m] and its slope at a place.
struct HeightAt {
  double height_m = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

/// Cubic between pixels (Catmull and Rom), so that the slope, which a beam sees, has no steps; beyond the outermost
/// pixels as at the edge.
HeightAt Interpolate(const HeightMap& map, double x_m, double y_m);

/// One part, channel Y (FLOAT, um), ZIP (lossless), with its pixel pitch.
/// @throws std::runtime_error that names the file, if it cannot be written.
/// @throws std::invalid_argument if size, pitch and number of values disagree.
void WriteHeightMap(const std::string& path, const HeightMap& map);

/// Reads what WriteHeightMap wrote, or any OpenEXR file with a channel Y in um and a pixel pitch
/// (`sensorPhotositePitch` in um, else `xDensity` in pixels per inch).
/// @throws std::runtime_error that names the file: not there, not OpenEXR, damaged, no channel Y, no pixel pitch,
///         a height that is not finite.
HeightMap ReadHeightMap(const std::string& path);

}  // namespace twinbench::optics
