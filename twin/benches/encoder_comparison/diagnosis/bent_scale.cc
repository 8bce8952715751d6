#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

double ValueOf(const Cause& cause, const char* name) {
  const auto p = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
  return p == cause.parameters.end() ? 0.0 : p->value;
}

}  // namespace

void TellMeanRatio(DiagnosisRun& result) {
  const Eigen::ArrayXd angle_rad = result.run.schedule.reference_rad, about_rad = angle_rad - angle_rad.mean();
  for (const Cause& cause : result.diagnosis.causes) {
    const double curvature = ValueOf(cause, "curvature");
    if (cause.effect != "scale" || curvature == 0.0) continue;
    const Eigen::ArrayXd shown_rad = ValueOf(cause, "ratio") * (1.0 + curvature * angle_rad / units::turn) * angle_rad;
    const double mean = (shown_rad * about_rad).sum() / about_rad.square().sum();
    result.diagnosis.notes.push_back(fmt::format("scale: {:.3g} in the mean over the readings, by a straight line; its ratio above is that at 0", mean));
  }
}

}  // namespace twinbench::diagnose::encoder
