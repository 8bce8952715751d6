#include "twin/benches/turntable_autocollimator/diagnosis/unknowns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/units.h"
#include "twin/diagnose/at.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::turntable {
namespace {

using units::arcsec;

constexpr double kFree_rad = 360.0 * arcsec;       // the range of an autocollimator
constexpr double kToothTilt_rad = 5.0 * arcsec;    // of a multi-tooth table
constexpr double kMirrorTilt_rad = 20.0 * arcsec;  // of the mirror against the multi-tooth table's axis
constexpr double kLeast_rad = 1e-4 * arcsec;       // of a prior: nothing is known better

/// Collects columns. X and Y are turns about the turntable's axis and upwards; the instrument shows them by slopes.
class Columns {
 public:
  Columns(const Places& places, const Slopes& slopes, const Schedule& schedule)
      : places_(places), schedule_(schedule), slopes_(slopes) {
    precision_.assign(At(kAxes * places.blocks), 1.0 / (kFree_rad * kFree_rad));
  }

  const Places& places() const { return places_; }
  const Schedule& schedule() const { return schedule_; }
  int Readings() const { return schedule_.Readings(); }

  /// @return the index of a new unknown.
  int New(double prior_sd) {
    precision_.push_back(1.0 / (prior_sd * prior_sd));
    return static_cast<int>(precision_.size()) - 1;
  }
  void ShowX(int reading, int unknown, double value) {
    Put(kAxes * reading + kX, unknown, slopes_.of_turn(reading, kX) * value);
    Put(kAxes * reading + kY, unknown, slopes_.of_turn(reading, kY) * value);
  }
  void ShowY(int reading, int unknown, double value) {
    Put(kAxes * reading + kX, unknown, slopes_.of_tilt(reading, kX) * value);
    Put(kAxes * reading + kY, unknown, slopes_.of_tilt(reading, kY) * value);
  }
  void Put(int row, int unknown, double value) {
    if (value != 0.0) entries_.emplace_back(row, unknown, value);
  }

  Nuisance Take() const {
    Nuisance nuisance;
    nuisance.jacobian.resize(kAxes * Readings(), std::ssize(precision_));
    nuisance.jacobian.setFromTriplets(entries_.begin(), entries_.end());
    nuisance.prior_precision =
        Eigen::Map<const Eigen::VectorXd>(precision_.data(), static_cast<Eigen::Index>(precision_.size()));
    nuisance.blocks = places_.blocks;
    nuisance.block_size = kAxes;
    return nuisance;
  }

 private:
  const Places& places_;
  const Schedule& schedule_;
  const Slopes& slopes_;
  std::vector<double> precision_;
  std::vector<Eigen::Triplet<double>> entries_;
};

void AddPositions(Columns& columns) {
  for (int i = 0; i < columns.Readings(); ++i) {
    const int block = columns.places().block[At(i)];
    columns.ShowX(i, kAxes * block + kX, 1.0);
    columns.ShowY(i, kAxes * block + kY, 1.0);
  }
}

/// For each set-up: two constants, then the wave of the tilted axis.
void AddSetUps(Columns& columns) {
  const int first = columns.New(kFree_rad);
  for (int k = 1; k < 4 * columns.places().setups; ++k) columns.New(kFree_rad);
  for (int i = 0; i < columns.Readings(); ++i) {
    const int setup = columns.places().setup[At(i)];
    if (setup < 0) continue;
    const int at = first + 4 * setup;
    const double mirror_rad = columns.schedule().reference_rad[i];
    columns.ShowX(i, at, 1.0);
    columns.ShowY(i, at + 1, 1.0);
    columns.ShowY(i, at + 2, std::cos(mirror_rad));
    columns.ShowY(i, at + 3, std::sin(mirror_rad));
  }
}

void AddTeeth(Columns& columns, double u_tooth_rad) {
  const int teeth = columns.places().teeth;
  if (teeth == 0) return;
  const int index = columns.New(std::max(u_tooth_rad, kLeast_rad));
  for (int k = 1; k < teeth; ++k) columns.New(std::max(u_tooth_rad, kLeast_rad));
  const int tilt = columns.New(kToothTilt_rad);
  for (int k = 1; k < teeth; ++k) columns.New(kToothTilt_rad);
  for (int i = 0; i < columns.Readings(); ++i) {
    const int tooth = columns.places().tooth[At(i)];
    if (tooth < 0) continue;
    columns.ShowX(i, index + tooth, 1.0);
    columns.ShowY(i, tilt + tooth, 1.0);
  }
}

/// An axis tilted by b turns a mirror that leans by m about it: x moves by b m once and b^2 / 4 twice a turn.
void AddSecondOrder(Columns& columns, const std::vector<double>& tilts_rad) {
  double tilt_rad = 0.0;
  for (const double t : tilts_rad) tilt_rad = std::max(tilt_rad, std::abs(t));
  for (int order = 1; order <= 2; ++order) {
    const double size_rad = tilt_rad * (order == 1 ? kMirrorTilt_rad : 0.25 * tilt_rad);
    const int first = columns.New(std::max(size_rad, kLeast_rad));
    for (int k = 1; k < 2 * columns.places().setups; ++k) columns.New(std::max(size_rad, kLeast_rad));
    for (int i = 0; i < columns.Readings(); ++i) {
      const int setup = columns.places().setup[At(i)];
      if (setup < 0) continue;
      const double angle_rad = order * columns.schedule().reference_rad[i];
      columns.ShowX(i, first + 2 * setup, std::cos(angle_rad));
      columns.ShowX(i, first + 2 * setup + 1, std::sin(angle_rad));
    }
  }
}

/// Slope of the turntable's index error between neighbouring positions, rms; of x where they were read last.
double TypicalSlope(const Places& places, const SignalContext& context) {
  constexpr double kUnknown = 1e-4;                  // 20 arcsec a radian: a table of some seconds
  std::map<int, std::pair<double, double>> last_at;  // block -> angle and x
  for (Eigen::Index i = 0; i < context.Readings(); ++i) {
    const int block = places.block[static_cast<std::size_t>(i)];
    if (block < places.circle_blocks) last_at[block] = {context.schedule.target_rad[i], context.shown_rad(i, kX)};
  }
  std::map<double, double> x_rad;
  for (const auto& [block, at] : last_at) x_rad.insert(at);
  double sum2 = 0.0, count = 0.0;
  for (auto a = x_rad.begin(), b = a; a != x_rad.end(); a = b) {
    if (++b == x_rad.end()) break;
    sum2 += std::pow((b->second - a->second) / (b->first - a->first), 2);
    count += 1.0;
  }
  return count > 2.0 ? std::max(kUnknown, std::sqrt(sum2 / count)) : kUnknown;
}

void AddSlopes(Columns& columns, double slope) {
  const Places& places = columns.places();
  if (places.sweeps == 0) return;
  const int first = columns.New(slope);
  for (int k = 1; k < places.sweeps; ++k) columns.New(slope);
  for (int i = 0; i < columns.Readings(); ++i) {
    const int sweep = places.sweep[At(i)];
    if (sweep >= 0)
      columns.ShowX(i, first + sweep, columns.schedule().target_rad[i] - places.sweep_centre_rad[At(sweep)]);
  }
}

void AddInterpolation(Columns& columns, double amplitude_rad, const SignalContext& context) {
  if (amplitude_rad <= 0.0) return;
  for (int axis = 0; axis < kAxes; ++axis) {
    const int first = columns.New(amplitude_rad);
    columns.New(amplitude_rad);
    const Eigen::MatrixXd wave = model::Wave(2.0 * units::kPi / context.pixel_rad * context.shown_rad.col(axis));
    for (int i = 0; i < columns.Readings(); ++i) {
      columns.Put(kAxes * i + axis, first, wave(i, 0));
      columns.Put(kAxes * i + axis, first + 1, wave(i, 1));
    }
  }
}

/// A zero that follows a temperature is told from the thermometer's, whose noise looks like a wrong coefficient: by
/// the share that noise has of what was logged (errors in variables).
void AddThermometer(Columns& columns, const SignalContext& context, const Scenario& scenario,
                    const Eigen::MatrixXd& per_K) {
  if (!context.HasTemperature()) return;
  const Eigen::VectorXd logged_K = context.above_K.array() - context.above_K.mean();
  const double variance = logged_K.squaredNorm() / static_cast<double>(logged_K.size());
  const double noise = std::pow(scenario.environment.sensor_noise_K, 2);
  if (per_K.isZero() || noise == 0.0 || variance == 0.0) return;
  const int share = columns.New(std::min(1.0, noise / variance));
  for (int i = 0; i < columns.Readings(); ++i) {
    for (int axis = 0; axis < kAxes; ++axis) columns.Put(kAxes * i + axis, share, per_K(i, axis) * logged_K[i]);
  }
}

}  // namespace

Slopes StraightSlopes(Eigen::Index readings) {
  return {Eigen::RowVector2d(1.0, 0.0).replicate(readings, 1), Eigen::RowVector2d(0.0, 1.0).replicate(readings, 1)};
}

Nuisance FreeUnknowns(const Places& places, const Slopes& slopes, const Schedule& schedule) {
  Columns columns(places, slopes, schedule);
  AddPositions(columns);
  AddSetUps(columns);
  return columns.Take();
}

Nuisance AllUnknowns(const Places& places, const Slopes& slopes, const SignalContext& context,
                     const Scenario& scenario, const Eigen::MatrixXd& per_K) {
  Columns columns(places, slopes, context.schedule);
  AddPositions(columns);
  AddSetUps(columns);
  AddTeeth(columns, TurntableOf(scenario).HasPolygon() ? kFree_rad : TurntableOf(scenario).multitooth.u_tooth_rad);
  AddSecondOrder(columns, TurntableOf(scenario).turntable_procedure.tilts_rad);
  AddSlopes(columns, TypicalSlope(places, context));
  AddInterpolation(columns, TurntableOf(scenario).collimator.interpolation_error_px * context.pixel_rad, context);
  AddThermometer(columns, context, scenario, per_K);
  return columns.Take();
}

}  // namespace twinbench::diagnose::turntable
