#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/benches/encoder_comparison/diagnosis/taken.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr int kAngles = 400;  // that are tried

/// How far each reading is beyond the angle. @param sense  +1: above it.
Eigen::VectorXd Beyond_rad(const Eigen::VectorXd& device_rad, double end_rad, double sense) {
  return (sense * (device_rad.array() - end_rad)).max(0.0);
}

double Angle_rad(const Eigen::VectorXd& device_rad, int g) {
  const double least_rad = device_rad.minCoeff(), range_rad = device_rad.maxCoeff() - least_rad;
  return least_rad + range_rad * (g + 0.5) / kAngles;
}

/// All that lies beyond one of the angles is missing, which is more than half of what there is.
bool Ends(const EncoderRun& encoder, const Taken& taken, double sense) {
  constexpr double kMostly = 0.5, kAll = 0.1;
  const Eigen::VectorXd& device_rad = encoder.context.device_rad;
  double most = 0.0, size = 0.0;
  for (int g = 0; g < kAngles; ++g) {
    const Eigen::VectorXd beyond_rad = Beyond_rad(device_rad, Angle_rad(device_rad, g), sense);
    if (const double takes = taken.By(beyond_rad); takes > most) {
      most = takes;
      size = taken.SizeOf(beyond_rad);
    }
  }
  return most > kMostly * taken.All() && std::abs(sense * size + 1.0) < kAll;
}

}  // namespace

std::vector<Family> RangeEndFamilies(const EncoderRun& encoder, const unknown::Design& design) {
  const Eigen::VectorXd device_rad = encoder.context.device_rad, shown_rad = encoder.run.observed;
  const Taken taken(encoder);
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  for (const double sense : {1.0, -1.0}) {
    if (!Ends(encoder, taken, sense)) continue;
    Shape end{"angle", design.unit, design.to_SI, Angle_rad(device_rad, 0), Angle_rad(device_rad, kAngles - 1), {}};
    for (int g = 0; g < kAngles; ++g) end.value.push_back(Angle_rad(device_rad, g));
    const auto beyond = [=](const Eigen::VectorXd& at) {
      return Eigen::MatrixXd(model::Unit(Beyond_rad(device_rad, at[0], sense)));
    };
    const double shows_rad = sense > 0.0 ? shown_rad.maxCoeff() : shown_rad.minCoeff();
    collect.AddOver("range", end, beyond, [=, to_SI = design.to_SI, unit = design.unit](int) {
      return fmt::format("range that ends at {:.4g} {}, {} which nothing is read, synchronous with device angle",
                         shows_rad / to_SI, unit, sense > 0.0 ? "above" : "below");
    });
  }
  return collect.Take();
}

}  // namespace twinbench::diagnose::encoder
