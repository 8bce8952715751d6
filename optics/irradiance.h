#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Irradiance on a detector as a picture with physical size, and its OpenEXR file.
namespace twinbench::optics {

/// Row 0 is at the top of the picture, which is the largest v; +u is to the right.
struct IrradianceMap {
  std::string name = "psd";  // part of the file: "psd.p1", "psd.m1"
  int width = 0;             // pixels
  int height = 0;
  double pitch_m = std::numeric_limits<double>::quiet_NaN();
  std::vector<float> irradiance_W_m2 = {};                 // row by row, width * height
  Eigen::Isometry3d X_LP = Eigen::Isometry3d::Identity();  // pose of the detector
  double wavelength_m = std::numeric_limits<double>::quiet_NaN();
  double power_W = 0.0;  // of the light that made the map
  int order = 0;         // diffraction order

  float At(int row, int column) const { return irradiance_W_m2[static_cast<std::size_t>(row) * width + column]; }
  double U(int column) const { return (column + 0.5 - 0.5 * width) * pitch_m; }
  double V(int row) const { return (0.5 * height - row - 0.5) * pitch_m; }
};

struct MapCentroid {
  double u_m = std::numeric_limits<double>::quiet_NaN();
  double v_m = std::numeric_limits<double>::quiet_NaN();
  double power_W = 0.0;
};

/// Irradiance-weighted mean position; NaN for a dark map.
MapCentroid Centroid(const IrradianceMap& map);

/// Writes one multi-part OpenEXR file: channel Y (FLOAT, W/mm^2), ZIP (lossless), a part for each map. The header
/// holds pixel pitch [um], size and position [mm], wavelength, power, order and pose, centroid in um.
///
/// @throws std::runtime_error that names the file, if it cannot be written.
/// @throws std::invalid_argument if a map's size and data disagree or two maps have the same name.
void WriteIrradianceMaps(const std::string& path, const std::vector<IrradianceMap>& maps);

/// Reads what WriteIrradianceMaps wrote, or any OpenEXR file with a channel Y and a pixel pitch
/// (`sensorPhotositePitch` in um, else `xDensity` in pixels per inch).
///
/// @throws std::runtime_error that names the file: not there, not OpenEXR, damaged, no channel Y, no pixel pitch,
///         a value that is negative or not finite.
std::vector<IrradianceMap> ReadIrradianceMaps(const std::string& path);

}  // namespace twinbench::optics
