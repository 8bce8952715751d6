#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/gain.h"
#include "twin/separate/design.h"

namespace twinbench::diagnose {
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

}  // namespace twinbench::diagnose
