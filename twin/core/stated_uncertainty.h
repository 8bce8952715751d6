#pragma once

#include <limits>
#include <string>

namespace twinbench {

enum class Distribution { kNormal, kUniform, kTriangular };

/// How well a value of a scenario is known, from its certificate or data sheet (GUM, type B): `u_distance_mm = 0.1`
/// beside `distance_mm`, or `u_distance_mm = { half_width = 0.2, distribution = "uniform" }`. Each number of a list
/// is known so well, independently of the others.
struct StatedUncertainty {
  std::string key;  // "psd_a.distance_mm"
  double u = 0.0;   // standard uncertainty, SI of the key
  Distribution distribution = Distribution::kNormal;
  double dof = std::numeric_limits<double>::infinity();  // behind u
};

}  // namespace twinbench
