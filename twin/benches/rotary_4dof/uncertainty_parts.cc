#include "twin/benches/rotary_4dof/uncertainty_parts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/core/table_errors.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::rotary {
namespace {

using separate::Table;
using separate::TableName;

/// Shares of the random variance.
struct OfScatter {
  double quantisation = 0.0, repeatability = 0.0;
};

/// Mean share that a step of the converter has of a block's variance; nothing if no block states one.
std::optional<double> QuantisationShare(const std::vector<Reading>& readings, Phase phase,
                                        const measure::BenchGeometry& geometry) {
  double sum = 0.0;
  int count = 0;
  for (const Reading& r : readings) {
    const auto variance_m2 = measure::SpotVariances(r, geometry);
    if (r.phase != phase || r.status != ReadingStatus::kOk || !variance_m2) continue;
    for (int c = 0; c < kChannels; ++c) {
      const double step_V = geometry.adc_step_V, std_V = r.std_V[static_cast<std::size_t>(c)];
      const double averaged = std_V < step_V ? 1.0 : r.n_samples;  // noise of more than a step dithers it
      const double of_step_m = step_V / geometry.sensitivity_V_m[static_cast<std::size_t>(c / 2)];
      sum += of_step_m * of_step_m / 12.0 / averaged / (*variance_m2)[c];
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return std::min(1.0, sum / count);
}

double ScaleOf(const separate::Separation& separation, Component component) {
  for (std::size_t d = 0; d < separate::kComponentOf.size(); ++d) {
    if (separate::kComponentOf[d] == component) return separation.scale[static_cast<Eigen::Index>(d)];
  }
  return separation.scale[static_cast<Eigen::Index>(measure::Dof::kDy)];
}

double BiasOf(const separate::MethodBias& bias, Table table, Component component) {
  for (const separate::ComponentBias& b : bias) {
    if (b.table == table && b.component == component && std::isfinite(b.rms)) return b.rms;
  }
  return 0.0;
}

uncertainty::Joint JointOf(const std::string& name, const separate::TableEstimate& estimate) {
  uncertainty::Joint joint{name, {}, estimate.cov.ToDense() + estimate.cov_systematic.ToDense()};
  const std::size_t n = estimate.value.position_rad.size();
  Eigen::VectorXd over_unit(joint.cov.rows());
  for (const Component c : estimate.components) {
    for (std::size_t i = 0; i < n; ++i) {
      over_unit[std::ssize(joint.names)] = 1.0 / (IsAngle(c) ? units::arcsec : units::um);
      joint.names.push_back(name + "." + ColumnOf(c).name + "[" + std::to_string(i) + "]");
    }
  }
  joint.cov = over_unit.asDiagonal() * joint.cov * over_unit.asDiagonal();
  return joint;
}

nlohmann::json PartsOf(const separate::TableEstimate& estimate, std::size_t block, double bias,
                       const OfScatter& scatter) {
  const std::vector<double>& u = estimate.u[estimate.components[block]];
  std::vector<double> u2;
  report::VariancePart noise{"noise", {}}, steps{"quantisation", {}}, passes{"repeatability", {}},
      calibration{"calibration", {}}, second{"second order", {}}, model{"model", {}},
      bearing{"asynchronous motion", {}};
  const double asynchronous = estimate.asynchronous[static_cast<std::size_t>(estimate.components[block])];
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(block * u.size() + i);
    const double systematic = estimate.cov_systematic(row, row), stated = estimate.cov(row, row);
    const double random = std::isfinite(stated) ? stated : u[i] * u[i] - bias * bias;
    u2.push_back(u[i] * u[i]);
    const double of_blocks = (1.0 - scatter.repeatability) * random;
    noise.variance.push_back((1.0 - scatter.quantisation) * of_blocks);
    steps.variance.push_back(scatter.quantisation * of_blocks);
    passes.variance.push_back(scatter.repeatability * random);
    second.variance.push_back(std::isfinite(stated) ? estimate.second_order * random : 0.0);
    model.variance.push_back(bias * bias);
    bearing.variance.push_back(asynchronous * asynchronous);
    const double known = second.variance.back() + model.variance.back() + bearing.variance.back();
    calibration.variance.push_back(std::isfinite(systematic) ? std::max(0.0, systematic - known) : 0.0);
  }
  return report::PartsJson(u2, {noise, steps, passes, calibration, second, model, bearing});
}

/// @param k  Of gains and rolls.
nlohmann::json CalibrationParts(const measure::Calibration& calibration, Eigen::Index k, double of_steps) {
  const double prior = calibration.of_prior[k], standard = calibration.of_autocollimator[k], detectors = 1.0 - prior - standard;
  return report::PartsJson({{"noise", (1.0 - of_steps) * detectors},
                            {"quantisation", of_steps * detectors},
                            {"standard", standard},
                            {"prior", prior}});
}

}  // namespace

void AddCalibrationParts(const Analysis& analysis, const std::vector<Reading>& readings, const Scenario& scenario,
                         nlohmann::json& calibration) {
  const double of_steps = QuantisationShare(readings, Phase::kCalibration, measure::NominalGeometry(scenario)).value_or(0.0);
  for (int c = 0; c < kChannels; ++c)
    calibration["gain"][kChannelNames[c]]["u_parts"] = CalibrationParts(analysis.calibration, c, of_steps);
  for (int p = 0; p < 2; ++p)
    calibration["roll_mrad"][p == 0 ? "psd_a" : "psd_b"]["u_parts"] = CalibrationParts(analysis.calibration, kChannels + p, of_steps);
}

std::vector<uncertainty::Joint> JointsOf(const separate::Separation& separation) {
  return {JointOf("separation.target", separation.target), JointOf("separation.reference", separation.reference)};
}

void AddParts(const Analysis& analysis, const std::vector<Reading>& readings, const Scenario& scenario,
              nlohmann::json& separation) {
  const std::optional<double> of_steps = QuantisationShare(readings, Phase::kFullCircle, measure::NominalGeometry(scenario));
  for (const Table table : {Table::kTarget, Table::kReference}) {
    const separate::TableEstimate& estimate =
        table == Table::kTarget ? analysis.separation->target : analysis.separation->reference;
    nlohmann::json& parts = separation[TableName(table)]["u_parts"];
    for (std::size_t block = 0; block < estimate.components.size(); ++block) {
      const Component component = estimate.components[block];
      const double scale = ScaleOf(*analysis.separation, component);
      parts[ColumnOf(component).name] = PartsOf(estimate, block, BiasOf(analysis.method_bias, table, component),
                           {of_steps.value_or(0.0), of_steps ? std::max(0.0, 1.0 - 1.0 / (scale * scale)) : 0.0});
    }
  }
}

}  // namespace twinbench::benches::rotary
