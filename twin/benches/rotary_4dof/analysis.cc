#include "twin/benches/rotary_4dof/analysis.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace twinbench::benches::rotary {
namespace {

using measure::Vector4;

bool HasFullCircle(const std::vector<measure::Motion>& motions) {
  return std::any_of(motions.begin(), motions.end(), [](const measure::Motion& m) {
    return m.phase == Phase::kFullCircle && m.status == ReadingStatus::kOk;
  });
}

/// [ez, ex, ey, dy] with the units of files.
nlohmann::json Motion4(const Vector4& v) {
  return {{"ez_arcsec", v[0] / units::arcsec},
          {"ex_arcsec", v[1] / units::arcsec},
          {"ey_arcsec", v[2] / units::arcsec},
          {"dy_um", v[3] / units::um}};
}

nlohmann::json ToJson(const measure::Calibration& calibration) {
  nlohmann::json json = {
      {"measured", calibration.measured}, {"readings", calibration.readings}, {"dof", calibration.dof}};
  for (int c = 0; c < kChannels; ++c) {
    json["gain"][kChannelNames[c]] = {{"value", calibration.gain[c]}, {"u", std::sqrt(calibration.cov(c, c))}};
  }
  for (int p = 0; p < 2; ++p) {
    json["roll_mrad"][p == 0 ? "psd_a" : "psd_b"] = {{"value", calibration.roll_rad[p] / units::mrad},
                                                     {"u", std::sqrt(calibration.cov(4 + p, 4 + p)) / units::mrad}};
  }
  if (calibration.published_l1_m) json["published_l1_mm"] = *calibration.published_l1_m / units::mm;
  json["notes"] = calibration.notes;
  return json;
}

nlohmann::json ToJson(const measure::Stability& stability) {
  return {{"readings", stability.readings},
          {"left_out", stability.left_out},
          {"duration_s", stability.duration_s},
          {"range", Motion4(stability.range)},
          {"standard_deviation", Motion4(stability.deviation)},
          {"u_standard_deviation", Motion4(stability.u_deviation)},
          {"noise", Motion4(stability.noise)},
          {"wavelength_range_pm", stability.wavelength_range_m / units::pm}};
}

nlohmann::json ToJson(const measure::Verification& v) {
  return {{"readings", v.readings},
          {"rms_yaw_arcsec", v.rms_yaw_rad / units::arcsec},
          {"max_yaw_arcsec", v.max_yaw_rad / units::arcsec},
          {"u_yaw_arcsec", v.u_yaw_rad / units::arcsec},
          {"rms_tilt_arcsec", v.rms_tilt_rad / units::arcsec},
          {"max_tilt_arcsec", v.max_tilt_rad / units::arcsec},
          {"u_tilt_arcsec", v.u_tilt_rad / units::arcsec}};
}

nlohmann::json CountByStatus(const std::vector<measure::Motion>& motions) {
  std::map<std::string, int> counts;
  for (const measure::Motion& motion : motions) ++counts[ReadingStatusName(motion.status)];
  return counts;
}

/// The rigorous result from the same readings, which says how far the published equations hold on this bench.
separate::MethodBias JudgePublished(const std::vector<Reading>& readings, const measure::BenchGeometry& geometry,
                                    separate::SeparateOptions options, const measure::Calibration& calibration,
                                    separate::Separation& published) {
  options.estimator = Estimator::kRigorous;
  const std::vector<measure::Motion> motions =
      measure::Measure(readings, geometry, calibration, Estimator::kRigorous);
  return separate::ApplyMethodBias(separate::Separate(motions, geometry, options), published);
}

}  // namespace

Analysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  const measure::BenchGeometry geometry = measure::NominalGeometry(scenario);
  Analysis analysis;
  analysis.estimator = estimator;
  analysis.calibration = measure::Calibrate(readings, geometry);
  analysis.motions = measure::Measure(readings, geometry, analysis.calibration, estimator);
  analysis.stability = measure::SummariseStability(analysis.motions, geometry);
  analysis.verification = measure::SummariseVerification(analysis.motions, readings, geometry.autocollimator_gain);
  if (!HasFullCircle(analysis.motions)) {
    analysis.not_separated = "there are no usable full-circle readings";
    return analysis;
  }
  separate::SeparateOptions options = separate::OptionsFrom(scenario);
  options.estimator = estimator;
  options.cov_calibration = analysis.calibration.cov;
  analysis.separation = separate::Separate(analysis.motions, geometry, options);
  if (estimator == Estimator::kPublished)
    analysis.method_bias = JudgePublished(readings, geometry, options, analysis.calibration, *analysis.separation);
  return analysis;
}

nlohmann::json ToJson(const Analysis& analysis) {
  nlohmann::json json = {{"estimator", EstimatorName(analysis.estimator)},
                         {"readings_by_status", CountByStatus(analysis.motions)},
                         {"calibration", ToJson(analysis.calibration)}};
  if (analysis.stability.readings > 0) json["stability"] = ToJson(analysis.stability);
  if (analysis.verification.readings > 0) json["verification"] = ToJson(analysis.verification);
  if (analysis.separation) {
    json["separation"] = separate::ToJson(*analysis.separation);
    if (!analysis.method_bias.empty()) json["method_bias"] = separate::ToJson(analysis.method_bias);
  } else {
    json["not_separated"] = analysis.not_separated;
  }
  return json;
}

}  // namespace twinbench::benches::rotary
