#include "twin/benches/rotary_4dof/diagnosis/change_of_tables.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "twin/benches/rotary_4dof/estimators/design.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/accepted_columns.h"

namespace twinbench::diagnose::rotary {
namespace {

using separate::Series;

constexpr Component ComponentOf(Series series) {
  switch (series) {
    case Series::kTargetEx:
    case Series::kRefEx:
      return Component::kEx;
    case Series::kTargetEy:
    case Series::kRefEy:
      return Component::kEy;
    case Series::kTargetEz:
    case Series::kRefEz:
      return Component::kEz;
    case Series::kRefDx:
      return Component::kDx;
    case Series::kTargetDy:
    case Series::kRefDy:
      break;
  }
  return Component::kDy;
}

nlohmann::json RmsJson(const std::array<double, kComponents>& rms) {
  nlohmann::json out = nlohmann::json::object();
  for (int c = 0; c < kComponents; ++c) {
    const bool angle = IsAngle(static_cast<Component>(c));
    const double value = rms[static_cast<std::size_t>(c)];
    const std::string key = std::string(kComponentNames[static_cast<std::size_t>(c)]) + (angle ? "_arcsec" : "_um");
    if (std::isfinite(value)) out[key] = value / (angle ? units::arcsec : units::um);
  }
  return out;
}

}  // namespace

ChangeOfUnknowns ChangeOfTables(const LinearRun& run, const NoiseModel& noise,
                                const std::vector<Accepted>& accepted, int positions) {
  const LeftOver fitted = FitAll(run, noise, accepted);
  const Eigen::VectorXd change = fitted.unknowns_after - fitted.unknowns_before;
  Require(change.size() >= separate::kSeries * positions, "a rotary run begins with the errors of both tables");
  separate::Design design;
  design.n = positions;
  ChangeOfUnknowns result;
  result.target_rms.fill(kNaN);
  result.reference_rms.fill(kNaN);
  for (int s = 0; s < separate::kSeries; ++s) {
    const auto series = static_cast<Series>(s);
    const Component component = ComponentOf(series);
    double sum = 0.0;
    for (int i = 0; i < positions; ++i) sum += std::pow(change[design.Column(series, i)], 2);
    auto& table = s < separate::kTargetSeries ? result.target_rms : result.reference_rms;
    table[static_cast<std::size_t>(component)] =
        std::sqrt(sum / positions) * (IsAngle(component) ? 1.0 : separate::kLengthUnit_m);
  }
  return result;
}

nlohmann::json ToJson(const ChangeOfUnknowns& change) {
  return {{"target", RmsJson(change.target_rms)}, {"reference", RmsJson(change.reference_rms)}};
}

}  // namespace twinbench::diagnose::rotary
