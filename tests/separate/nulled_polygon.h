#pragma once

#include <cmath>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/polygon_readings.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

/// A turntable's encoder and a polygon written down in a few lines, independent of the program.
namespace twinbench::separate::turntable {

struct TrueWave {
  int order = 0;
  double cos_rad = 0.0, sin_rad = 0.0;
};

struct NulledPolygon {
  int faces = 24;
  std::vector<double> offsets_deg;
  std::vector<TrueWave> encoder;
  std::vector<double> face_rad;  // zero mean
  double noise_rad = 0.0;
  int passes = 1;

  double Encoder_rad(double angle_rad) const {
    double sum_rad = 0.0;
    for (const TrueWave& w : encoder)
      sum_rad += w.cos_rad * std::cos(w.order * angle_rad) + w.sin_rad * std::sin(w.order * angle_rad);
    return sum_rad;
  }

  /// Constants of the clampings: 5, -10, 15 ... arcsec.
  std::vector<FaceReading> Read(Stream& noise) const {
    std::vector<FaceReading> readings;
    for (std::size_t c = 0; c < offsets_deg.size(); ++c) {
      for (int pass = 0; pass < passes; ++pass) {
        for (int face = 0; face < faces; ++face) {
          const double angle_rad = (offsets_deg[c] + face * 360.0 / faces) * units::deg;
          const double constant_rad = (c % 2 == 0 ? 5.0 : -5.0) * static_cast<double>(c + 1) * units::arcsec;
          readings.push_back({static_cast<int>(c), face, 1, angle_rad,
                              Encoder_rad(angle_rad) + face_rad[static_cast<std::size_t>(face)] + constant_rad +
                                  noise_rad * noise.Normal()});
        }
      }
    }
    return readings;
  }
};

/// So many clampings evenly round the circle.
inline std::vector<double> EvenOffsets(int clampings) {
  std::vector<double> offsets_deg;
  for (int c = 0; c < clampings; ++c) offsets_deg.push_back(c * 360.0 / clampings);
  return offsets_deg;
}

/// Waves of these orders, faces of half an arcsecond.
inline NulledPolygon AnyPolygon(int faces, const std::vector<double>& offsets_deg, const std::vector<int>& orders,
                                Stream& truth) {
  NulledPolygon polygon;
  polygon.faces = faces;
  polygon.offsets_deg = offsets_deg;
  for (const int order : orders)
    polygon.encoder.push_back({order, units::arcsec * truth.Normal(), units::arcsec * truth.Normal()});
  double mean_rad = 0.0;
  for (int face = 0; face < faces; ++face) {
    polygon.face_rad.push_back(0.5 * units::arcsec * truth.Normal());
    mean_rad += polygon.face_rad.back() / faces;
  }
  for (double& error_rad : polygon.face_rad) error_rad -= mean_rad;
  return polygon;
}

}  // namespace twinbench::separate::turntable
