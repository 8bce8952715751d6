#include "twin/benches/turntable_autocollimator/estimators/index_errors.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/turntable_autocollimator/estimators/one_axis.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_analysis.h"
#include "twin/benches/turntable_autocollimator/estimators/turntable_bench.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"

namespace twinbench::separate::turntable {
namespace {

/// Error of the tooth on which a stop stands, 0 where it was not separated from the turntable.
double ToothError_rad(const AngleSeries& multitooth, double multitooth_rad) {
  constexpr double kSame_rad = 1e-6;
  for (std::size_t i = 0; i < multitooth.position_rad.size(); ++i) {
    const double away_rad = std::remainder(multitooth_rad - multitooth.position_rad[i], units::turn);
    if (std::abs(away_rad) > kSame_rad) continue;
    const double value_rad = multitooth.value_rad[static_cast<Eigen::Index>(i)];
    return std::isfinite(value_rad) ? value_rad : 0.0;
  }
  return 0.0;
}

/// What the uncertainty of the roll does to a reading, root mean square: the tilts turn it into an error of
/// order 1.
double RollError_rad(const Roll& roll, const std::vector<IndexReading>& tilts) {
  if (roll.status != RollStatus::kOk || tilts.empty()) return 0.0;
  const IndexErrors means = MeansByPlace(tilts);
  return roll.u_gamma_rad * RootMeanSquare(AboutGroups(means, means.value_rad));
}

/// Errors of the encoder wherever a face was nulled, the faces' taken out; every clamping has a constant of its
/// own.
IndexErrors PolygonIndexErrors(const Scenario& scenario, const std::vector<Reading>& readings) {
  const PolygonAnalysis analysis = AnalysePolygon(readings, scenario, Estimator::kRigorous);
  if (!analysis.closure)
    throw InputError("readings", analysis.not_separated, "clampings that separate encoder and faces");
  const PolygonClosure& closure = *analysis.closure;
  std::map<int, double> face_rad;
  for (std::size_t i = 0; i < closure.face.size(); ++i)
    face_rad[closure.face[i]] = closure.polygon.value_rad[static_cast<Eigen::Index>(i)];
  std::vector<IndexReading> values;
  for (const FaceReading& r : FaceReadings(readings, scenario))
    values.push_back({r.clamping, r.angle_rad, r.value_rad - face_rad.at(r.face)});
  IndexErrors errors = MeansByPlace(values);
  errors.table = "turntable";
  errors.u_place_rad = std::sqrt(closure.polygon.cov_rad2.diagonal().mean());
  errors.commanded = TurntableOf(scenario).turntable.compensation;
  return errors;
}

}  // namespace

IndexErrors TurntableIndexErrors(const Scenario& scenario, const std::vector<Reading>& as_read) {
  const TurntableSettings& own = TurntableOf(scenario);
  if (own.HasPolygon()) return PolygonIndexErrors(scenario, as_read);
  const std::vector<Reading> readings = WithTilt(as_read);
  const TurntableAnalysis analysis = AnalyseTurntable(readings, scenario, Estimator::kRigorous);
  if (!analysis.separation) throw InputError("readings", analysis.not_separated, "readings of a full-circle test");
  std::vector<IndexReading> values, tilts;
  for (const std::vector<TurntableStop>& stops : {analysis.stops, StopsOf(readings, scenario, Phase::kVerification)}) {
    for (const TurntableStop& stop : stops) {
      if (!std::isfinite(stop.x_rad)) continue;  // left out
      values.push_back({stop.setup, stop.turntable_rad,
                        analysis.separation->roll.Correct(stop.x_rad, stop.y_rad) -
                            ToothError_rad(analysis.separation->multitooth, stop.multitooth_rad)});
      tilts.push_back({stop.setup, stop.turntable_rad, stop.y_rad});
    }
  }
  IndexErrors errors = MeansByPlace(values);
  errors.table = "turntable";
  errors.u_place_rad = own.Tooth_rad();
  errors.u_between_rad = RollError_rad(analysis.separation->roll, tilts);
  errors.commanded = own.turntable.compensation;
  return errors;
}

}  // namespace twinbench::separate::turntable
