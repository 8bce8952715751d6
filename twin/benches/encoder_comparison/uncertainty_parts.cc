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
using separate::encoder::OfShare;
using separate::harmonics::HarmonicSeries;

double StepShareOf(const DeviceError& device, const DeviceSettings& settings) {
  return StepShare(device.residual_rms_rad, settings);
}

/// Where white noise makes this share of a variance, and rounding that repeats another.
nlohmann::json WithWhiteShare(double white, double of_steps, double rounding = 0.0, double folded = 0.0) {
  return report::PartsJson({{"noise", (1.0 - of_steps) * white},
                            {"quantisation", of_steps * white + rounding},
                            {"model", folded},
                            {"repeatability", 1.0 - white - rounding - folded}});
}

std::vector<double> ListOf(const Eigen::ArrayXd& values) {
  return {values.begin(), values.end()};
}

/// Variance of a single reading beside the mean at its angle, all angles pooled; and what rounding that repeats would
/// be in it, to make the mean as uncertain as it does.
struct Pooled {
  double all_rad2 = 0.0, rounded_rad2 = 0.0;
};
Pooled PooledVariance(const separate::encoder::AngleMeans& means) {
  double squares = 0.0, rounded = 0.0, dof = 0.0;
  for (std::size_t i = 0; i < means.count.size(); ++i) {
    if (means.count[i] < 2) continue;
    const double of_one = means.count[i] - 1.0;
    squares += of_one * means.count[i] * means.u_rad[i] * means.u_rad[i];
    rounded += of_one * means.rounded_rad2 * std::min<double>(means.count[i], means.visits);
    dof += of_one;
  }
  return {squares / dof, rounded / dof};
}

}  // namespace

separate::encoder::ScaleSteps StepsOf(const EncoderSettings& settings) {
  return {settings.device.resolution_rad, static_cast<double>(settings.encoder_procedure.ReadingsAtOnce())};
}

separate::encoder::DeviceOptions DeviceOptionsOf(const EncoderSettings& settings) {
  separate::encoder::DeviceOptions options{.steps = StepsOf(settings)};
  for (const int once : {settings.device.lines, settings.device.teeth, settings.device.signal_periods}) {
    for (const int order : {once, 2 * once})
      if (order > 0) options.of_lines.push_back(order);
  }
  return options;
}

double StepShare(double reading_rad, const DeviceSettings& settings) {
  const double of_step = std::pow(settings.resolution_rad / reading_rad, 2) / 12.0;
  return std::isfinite(of_step) ? std::min(1.0, of_step) : 0.0;
}

nlohmann::json CurveParts(const separate::harmonics::HarmonicSeries& series, const DeviceError& device,
                          const DeviceSettings& settings, int points) {
  const double of_steps = StepShareOf(device, settings);
  const Eigen::ArrayXd u2 = Curve(series, points).u_rad.array().square(),
                       white = Curve(OfShare(series, device.white_share), points).u_rad.array().square(),
                       rounding = Curve(OfShare(series, device.rounding_share), points).u_rad.array().square(),
                       folded = Curve(OfShare(series, device.folded_share), points).u_rad.array().square() +
                                series.unresolved_rad2;
  return report::PartsJson(ListOf(u2), {{"noise", ListOf((1.0 - of_steps) * white)},
                                        {"quantisation", ListOf(of_steps * white + rounding)},
                                        {"model", ListOf(folded)},
                                        {"repeatability", ListOf(u2 - white - rounding - folded)}});
}

uncertainty::Joint CurveJoint(const std::string& name, const separate::harmonics::HarmonicSeries& series, int points) {
  uncertainty::Joint joint{
      name,
      {},
      Eigen::MatrixXd::Identity(points, points) * series.unresolved_rad2 / (units::arcsec * units::arcsec)};
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
  const auto at = static_cast<std::size_t>(order - 1);
  return WithWhiteShare(device.white_share.at(at), StepShareOf(device, settings), device.rounding_share.at(at),
                        device.folded_share.at(at));
}

nlohmann::json ReversalParts(const DeviceError& device, const DeviceSettings& settings) {
  return WithWhiteShare(device.reversal.white_share, StepShareOf(device, settings), device.reversal.rounding_share);
}

nlohmann::json MeansParts(const separate::encoder::AngleMeans& means, const DeviceError& device, const DeviceSettings& settings) {
  const Pooled pooled = PooledVariance(means);
  if (!(pooled.all_rad2 > 0.0)) return nlohmann::json::object();
  const double rounding = pooled.rounded_rad2 / pooled.all_rad2;
  const double white = std::min(1.0 - rounding, device.residual_rms_rad * device.residual_rms_rad / pooled.all_rad2);
  return WithWhiteShare(white, StepShareOf(device, settings), rounding);
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
