#include "twin/benches/encoder_comparison/uncertainty_parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/units.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::encoder {
namespace {

using separate::encoder::Curve;
using separate::encoder::DeviceError;
using separate::encoder::OfWhiteNoise;

/// Share that steps of the reading have of white noise.
double StepShare(const DeviceError& device, const DeviceSettings& settings) {
  const double of_step = std::pow(settings.resolution_rad / device.residual_rms_rad, 2) / 12.0;
  return std::isfinite(of_step) ? std::min(1.0, of_step) : 0.0;
}

}  // namespace

nlohmann::json CurveParts(const separate::harmonics::HarmonicSeries& series, const DeviceError& device,
                          const DeviceSettings& settings, int points) {
  const double of_steps = StepShare(device, settings);
  const Eigen::ArrayXd u2 = Curve(series, points).u_rad.array().square(),
                       white = Curve(OfWhiteNoise(series, device), points).u_rad.array().square();
  const auto list = [](const Eigen::ArrayXd& values) { return std::vector<double>(values.begin(), values.end()); };
  return report::PartsJson(list(u2), {{"noise", list((1.0 - of_steps) * white)},
                                      {"quantisation", list(of_steps * white)},
                                      {"repeatability", list(u2 - white)}});
}

uncertainty::Joint CurveJoint(const std::string& name, const separate::harmonics::HarmonicSeries& series, int points) {
  uncertainty::Joint joint{name, {}, Eigen::MatrixXd::Zero(points, points)};
  for (int i = 0; i < points; ++i) joint.names.push_back(fmt::format("{}.ez_arcsec[{}]", name, i));
  for (int k = 1; k <= series.Highest(); ++k) {
    const Eigen::Matrix2d& cov = series.At(k).cov;
    if (!cov.allFinite()) continue;
    Eigen::MatrixXd wave(points, 2);  // Re(C exp(j k th)) by both parts of C
    for (int i = 0; i < points; ++i) {
      const double angle_rad = units::turn * k * i / points;
      wave.row(i) << std::cos(angle_rad), -std::sin(angle_rad);
    }
    joint.cov += wave * cov * wave.transpose() / (units::arcsec * units::arcsec);
  }
  return joint;
}

nlohmann::json OrderParts(int order, const DeviceError& device, const DeviceSettings& settings) {
  const double of_steps = StepShare(device, settings),
               white = device.white_share.at(static_cast<std::size_t>(order - 1));
  return report::PartsJson(
      {{"noise", (1.0 - of_steps) * white}, {"quantisation", of_steps * white}, {"repeatability", 1.0 - white}});
}

}  // namespace twinbench::benches::encoder
