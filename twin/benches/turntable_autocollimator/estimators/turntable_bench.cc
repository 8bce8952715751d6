#include "twin/benches/turntable_autocollimator/estimators/turntable_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "twin/benches/turntable_autocollimator/estimators/collimator_scale.h"
#include "twin/benches/turntable_autocollimator/estimators/disturbed_stops.h"
#include "twin/benches/turntable_autocollimator/estimators/one_axis.h"
#include "twin/benches/turntable_autocollimator/estimators/tilt_squared.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/units.h"

namespace twinbench::separate::turntable {
namespace {

TurntableStop StopOf(const Reading& r, const Scenario& scenario) {
  const Eigen::Vector2d mirror_rad =
      MirrorAngles_rad({r.autocollimator_yaw_rad, r.autocollimator_tilt_rad}, scenario);
  const double walk_rad = BeamWalk_rad(TurntableOf(scenario), r.setup, r.target_rad);
  return {r.setup, r.pass, r.direction, r.target_rad, r.reference_rad, mirror_rad.x() - walk_rad, mirror_rad.y()};
}

bool IsStop(const Reading& r, Phase phase) {
  return r.phase == phase && r.status == ReadingStatus::kOk;
}

struct SetUpPair {
  int first, second;
};

/// Two set-ups of equal shift whose tilts differ most, by the range of the difference of their y.
std::optional<SetUpPair> PairForEquation5(const StopGrid& grid, const Readings& readings) {
  const auto y_of = [&](int setup) {
    Eigen::VectorXd y = Eigen::VectorXd::Constant(grid.n, kNaN);
    for (std::size_t i = 0; i < grid.stops.size(); ++i) {
      if (grid.stops[i].setup == setup) y[grid.stops[i].position] = readings.y_rad[static_cast<Eigen::Index>(i)];
    }
    return y;
  };
  std::optional<SetUpPair> best;
  double largest_rad = 0.0;
  const int set_ups = static_cast<int>(grid.setups.size());
  for (int a = 0; a < set_ups; ++a) {
    for (int b = a + 1; b < set_ups; ++b) {
      const SetUp &first = grid.setups[static_cast<std::size_t>(a)],
                  &second = grid.setups[static_cast<std::size_t>(b)];
      if (first.shift != second.shift || first.row != second.row) continue;
      const Eigen::VectorXd difference = y_of(b) - y_of(a);
      const ErrorSize size = DescribeErrors(difference);
      if (!(size.peak_to_valley_rad > largest_rad)) continue;
      largest_rad = size.peak_to_valley_rad;
      best = {first.label, second.label};
    }
  }
  return best;
}

/// A value of equation 5 holds the error of its tooth less that of the first; and near a pole it is a number but no
/// result: nothing that propagates noise describes how it scatters.
void MakeHonest(double u_multitooth_rad, TurntableAnalysis& analysis) {
  int invalid = 0;
  for (PointwiseError& point : analysis.pointwise) {
    const bool is_start = point.value_rad == 0.0 && point.u_rad == 0.0;
    if (point.status == PointStatus::kNearPole && !is_start) {
      point.u_rad = kNaN;
      ++invalid;
    } else if (!is_start) {
      point.u_rad = std::hypot(point.u_rad, std::numbers::sqrt2 * u_multitooth_rad);
    }
  }
  if (invalid > 0)
    analysis.separation->notes.push_back(fmt::format(
        "equation 5: INVALID at {} of {} positions, where the two tilts look alike", invalid, analysis.pointwise.size()));
}

/// One disturbed reading would shift its place by more than any uncertainty says, and widen that of all others.
std::vector<std::string> LeaveOutDisturbed(const std::vector<Reading>& readings, const Scenario& scenario, TurntableAnalysis& analysis) {
  std::vector<int> numbers;
  for (const Reading& r : readings)
    if (IsStop(r, Phase::kFullCircle)) numbers.push_back(r.reading);
  const StopGrid grid = FindGrid(analysis.stops, TurntableOf(scenario).turntable_procedure.positions);
  std::vector<std::string> notes;
  for (const DisturbedStop& disturbed : DisturbedStops(analysis.stops, grid, TurntableOf(scenario).ReadingNoise_rad())) {
    TurntableStop& stop = analysis.stops[disturbed.stop];
    notes.push_back(fmt::format("reading {} is left out of the errors: {:.2f} arcsec at {:.6g} deg lies {:.3g} times the scatter from all others of its place",
                                numbers[disturbed.stop], stop.x_rad / units::arcsec, stop.turntable_rad / units::deg, disturbed.times));
    stop.x_rad = kNaN;
    --analysis.used;
  }
  return notes;
}

/// What equation 5 gave, as a series that a model can be fitted to; without uncertainty.
AngleSeries SeriesOf(const std::vector<PointwiseError>& pointwise) {
  AngleSeries series;
  std::vector<double> values_rad;
  for (const PointwiseError& point : pointwise) {
    if (!std::isfinite(point.value_rad)) continue;
    series.position_rad.push_back(point.turntable_rad);
    values_rad.push_back(point.value_rad);
  }
  const auto n = static_cast<Eigen::Index>(values_rad.size());
  series.value_rad = Eigen::Map<const Eigen::VectorXd>(values_rad.data(), n);
  if (n > 0) series.value_rad.array() -= series.value_rad.mean();
  series.cov_rad2 = CurveCovariance::Circulant(Eigen::VectorXd::Constant(n, kNaN), 1);
  return series;
}

void AddModel(const AngleSeries& series, TurntableAnalysis& analysis) {
  if (std::ssize(series.position_rad) < kFewestPositions) {
    analysis.not_separated = "no two mountings of equal shift and different tilt: equation 5 has nothing to work on";
    return;
  }
  analysis.model = FitHarmonics(series, ChooseHighestOrder(series));
}

void AddCheck(const std::vector<Reading>& readings, const Scenario& scenario, TurntableAnalysis& analysis) {
  const std::vector<TurntableStop> stops = StopsOf(readings, scenario, Phase::kVerification);
  if (stops.empty() || !analysis.model) return;
  const IndexingSeparation& separation = *analysis.separation;
  // The published way knows no roll; its check was done with instruments levelled with care.
  analysis.check = CheckModel(*analysis.model, stops, separation.roll,
                              {separation.noise.u_x_rad, TurntableOf(scenario).Tooth_rad()});
}

}  // namespace

std::vector<TurntableStop> StopsOf(const std::vector<Reading>& readings, const Scenario& scenario, Phase phase) {
  std::vector<TurntableStop> stops;
  std::vector<TiltReading> tilts;
  for (const Reading& reading : readings) {
    if (!IsStop(reading, phase)) continue;
    const TurntableStop& stop = stops.emplace_back(StopOf(reading, scenario));
    tilts.push_back({stop.setup, 0, stop.turntable_rad, stop.y_rad});
  }
  const Eigen::VectorXd of_tilt_rad = TiltSquared_rad(tilts);
  for (std::size_t i = 0; i < stops.size(); ++i) stops[i].x_rad -= of_tilt_rad[static_cast<Eigen::Index>(i)];
  return stops;
}

TurntableAnalysis AnalyseTurntable(const std::vector<Reading>& as_read, const Scenario& scenario,
                                   Estimator estimator) {
  const std::vector<Reading> readings = WithTilt(as_read);
  TurntableAnalysis analysis;
  analysis.estimator = estimator;
  analysis.left_out = static_cast<int>(
      std::ranges::count_if(readings, [](const Reading& r) { return r.status != ReadingStatus::kOk; }));
  analysis.stops = StopsOf(readings, scenario, Phase::kFullCircle);
  const std::vector<TurntableStop>& stops = analysis.stops;
  analysis.used = static_cast<int>(stops.size());
  if (stops.empty()) {
    analysis.not_separated = "there are no usable full-circle readings";
    return analysis;
  }
  const std::vector<std::string> disturbed = LeaveOutDisturbed(readings, scenario, analysis);
  const int positions = TurntableOf(scenario).turntable_procedure.positions;
  IndexingOptions options;
  options.positions = positions;
  options.u_multitooth_rad = TurntableOf(scenario).Tooth_rad();
  analysis.separation = SeparateIndexing(stops, options);
  analysis.separation->notes.insert(analysis.separation->notes.end(), disturbed.begin(), disturbed.end());
  const StopGrid grid = FindGrid(stops, positions);
  if (const auto pair = PairForEquation5(grid, Collect(stops, grid)))
    analysis.pointwise = SolveEquation5(stops, pair->first, pair->second, analysis.separation->noise, positions);
  MakeHonest(options.u_multitooth_rad, analysis);
  const bool published = estimator == Estimator::kPublished;
  const AngleSeries series = published ? SeriesOf(analysis.pointwise) : analysis.separation->turntable;
  analysis.before = DescribeErrors(series.value_rad);
  AddModel(series, analysis);
  AddCheck(readings, scenario, analysis);
  return analysis;
}

}  // namespace twinbench::separate::turntable
