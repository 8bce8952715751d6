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
using separate::harmonics::HarmonicSeries;

double StepShareOf(const DeviceError& device, const DeviceSettings& settings) {
  return StepShare(device.residual_rms_rad, settings);
}

/// Where white noise makes this share of a variance.
nlohmann::json WithWhiteShare(double white, double of_steps) {
  return report::PartsJson(
      {{"noise", (1.0 - of_steps) * white}, {"quantisation", of_steps * white}, {"repeatability", 1.0 - white}});
}

std::vector<double> ListOf(const Eigen::ArrayXd& values) {
  return {values.begin(), values.end()};
}

/// Variance of a single reading beside the mean at its angle, all angles pooled.
double PooledVariance_rad2(const separate::encoder::AngleMeans& means) {
  double squares = 0.0, dof = 0.0;
  for (std::size_t i = 0; i < means.count.size(); ++i) {
    if (means.count[i] < 2) continue;
    const double of_one = means.count[i] - 1.0;
    squares += of_one * means.count[i] * means.u_rad[i] * means.u_rad[i];
    dof += of_one;
  }
  return squares / dof;
}

}  // namespace

double StepShare(double reading_rad, const DeviceSettings& settings) {
  const double of_step = std::pow(settings.resolution_rad / reading_rad, 2) / 12.0;
  return std::isfinite(of_step) ? std::min(1.0, of_step) : 0.0;
}

nlohmann::json CurveParts(const separate::harmonics::HarmonicSeries& series, const DeviceError& device,
                          const DeviceSettings& settings, int points) {
  const double of_steps = StepShareOf(device, settings);
  const Eigen::ArrayXd u2 = Curve(series, points).u_rad.array().square(),
                       white = Curve(OfWhiteNoise(series, device), points).u_rad.array().square();
  return report::PartsJson(ListOf(u2), {{"noise", ListOf((1.0 - of_steps) * white)},
                                      {"quantisation", ListOf(of_steps * white)},
                                      {"repeatability", ListOf(u2 - white)}});
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
  return WithWhiteShare(device.white_share.at(static_cast<std::size_t>(order - 1)), StepShareOf(device, settings));
}

nlohmann::json ReversalParts(const DeviceError& device, const DeviceSettings& settings) {
  return WithWhiteShare(device.reversal.white_share, StepShareOf(device, settings));
}

nlohmann::json MeansParts(const separate::encoder::AngleMeans& means, const DeviceError& device, const DeviceSettings& settings) {
  const double pooled_rad2 = PooledVariance_rad2(means);
  if (!(pooled_rad2 > 0.0)) return nlohmann::json::object();
  return WithWhiteShare(std::min(1.0, device.residual_rms_rad * device.residual_rms_rad / pooled_rad2), StepShareOf(device, settings));
}

nlohmann::json PublishedCurveParts(const HarmonicSeries& series, const HarmonicSeries& by_noise, double of_steps, int points) {
  const Eigen::ArrayXd u2 = Curve(series, points).u_rad.array().square(), noise = Curve(by_noise, points).u_rad.array().square();
  return report::PartsJson(ListOf(u2), {{"noise", ListOf((1.0 - of_steps) * noise)},
                                        {"quantisation", ListOf(of_steps * noise)},
                                        {"model", ListOf(u2 - noise)}});
}

void AddPublishedOrderParts(const HarmonicSeries& series, const HarmonicSeries& by_noise, double of_steps, nlohmann::json& lines) {
  for (nlohmann::json& line : lines) {
    const int order = line.at("order");
    const double noise = by_noise.At(order).cov.trace() / series.At(order).cov.trace();
    line["u_parts"] = report::PartsJson({{"noise", (1.0 - of_steps) * noise}, {"quantisation", of_steps * noise}, {"model", 1.0 - noise}});
  }
}

}  // namespace twinbench::benches::encoder
