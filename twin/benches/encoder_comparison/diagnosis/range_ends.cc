#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// How far each reading is beyond the angle. @param sense  +1: above it.
Eigen::VectorXd Beyond_rad(const Eigen::VectorXd& angle_rad, double end_rad, double sense) {
  return (sense * (angle_rad.array() - end_rad)).max(0.0);
}

/// The way over which the device shows nothing but the end of its range.
double WayAtEnd_rad(const EncoderRun& encoder, double sense) {
  constexpr double kSame = 5.0;  // deviations of the noise
  const Eigen::ArrayXd shown_rad = sense * encoder.run.observed.array(),
                       angle_rad = sense * encoder.context.device_rad.array();
  const double same_rad = kSame * encoder.run.sigma.mean(), end_rad = shown_rad.maxCoeff() - same_rad;
  const double first_rad = (shown_rad >= end_rad).select(angle_rad, angle_rad.maxCoeff()).minCoeff();
  const bool is_all = ((angle_rad > first_rad + 2.0 * same_rad).select(shown_rad, end_rad) >= end_rad).all();
  return is_all ? angle_rad.maxCoeff() - first_rad - same_rad : 0.0;
}

}  // namespace

std::vector<Family> RangeEndFamilies(const EncoderRun& encoder, const unknown::Design& design) {
  constexpr int kAngles = 400;     // that are tried
  constexpr double kLeast = 0.02;  // of the way that is gone
  const Eigen::VectorXd device_rad = encoder.context.device_rad, shown_rad = encoder.run.observed;
  const double least_rad = device_rad.minCoeff(), range_rad = device_rad.maxCoeff() - least_rad;
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  for (const double sense : {1.0, -1.0}) {
    if (!(WayAtEnd_rad(encoder, sense) > kLeast * range_rad)) continue;
    Shape end{"angle", design.unit, design.to_SI, least_rad, least_rad + range_rad, {}};
    for (int g = 0; g < kAngles; ++g) end.value.push_back(least_rad + range_rad * (g + 0.5) / kAngles);
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
