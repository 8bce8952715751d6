#include "twin/benches/turntable_autocollimator/estimators/stops.h"

#include <cmath>
#include <set>
#include <string>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kGridTolerance = 1e-3;  // of a step

bool IsUsable(const TurntableStop& stop) {
  return std::isfinite(stop.x_rad) && std::isfinite(stop.y_rad);
}

double Wrapped(double angle_rad, double period_rad) {
  const double rest_rad = std::fmod(angle_rad, period_rad);
  return rest_rad < 0.0 ? rest_rad + period_rad : rest_rad;
}

int CountPositions(const std::vector<TurntableStop>& stops) {
  std::set<long long> distinct;  // millionths of a turn
  for (const TurntableStop& stop : stops) {
    if (std::isfinite(stop.turntable_rad))
      distinct.insert(std::llround(Wrapped(stop.turntable_rad, units::turn) / units::turn * 1e6) % 1000000);
  }
  return static_cast<int>(distinct.size());
}

/// Angle of the grid's first line in [0, step): 0 unless `angle_rad` lies visibly off a multiple of the step.
double GridOffset(double angle_rad, double step_rad) {
  const double rest_rad = Wrapped(angle_rad, step_rad);
  return std::min(rest_rad, step_rad - rest_rad) < kGridTolerance * step_rad ? 0.0 : rest_rad;
}

std::string NameOf(std::size_t stop) {
  return "reading " + std::to_string(stop);
}

/// Index of the grid line at this angle; -1 if there is none.
int GridIndex(double angle_rad, double offset_rad, const StopGrid& grid) {
  const double steps = (angle_rad - offset_rad) / grid.Step_rad();
  if (!(std::abs(steps - std::round(steps)) < kGridTolerance)) return -1;
  return static_cast<int>(((std::llround(steps) % grid.n) + grid.n) % grid.n);
}

/// Row of teeth that this multi-tooth angle belongs to; a new one if need be.
int FindRow(StopGrid& grid, double multitooth_rad) {
  for (std::size_t row = 0; row < grid.row_offset_rad.size(); ++row) {
    if (GridIndex(multitooth_rad, grid.row_offset_rad[row], grid) >= 0) return static_cast<int>(row);
  }
  grid.row_offset_rad.push_back(GridOffset(multitooth_rad, grid.Step_rad()));
  return static_cast<int>(grid.row_offset_rad.size()) - 1;
}

/// Index of the stop's set-up; makes it at its first stop.
int FindSetUp(StopGrid& grid, std::size_t index, const SetUp& found) {
  for (std::size_t s = 0; s < grid.setups.size(); ++s) {
    const SetUp& known = grid.setups[s];
    if (known.label != found.label) continue;
    if (known.row == found.row && known.shift == found.shift) return static_cast<int>(s);
    throw InputError(NameOf(index),
                     "turntable + multi-tooth angle differs inside mounting " + std::to_string(found.label),
                     "a multi-tooth table that turns back by the turntable's step");
  }
  grid.setups.push_back(found);
  return static_cast<int>(grid.setups.size()) - 1;
}

void AddStop(StopGrid& grid, const TurntableStop& stop, std::size_t index) {
  const int position = GridIndex(stop.turntable_rad, grid.offset_rad, grid);
  if (position < 0 || !std::isfinite(stop.multitooth_rad)) {
    throw InputError(NameOf(index), "an angle that is not on the grid of positions",
                     "turntable angles in steps of 360 deg / " + std::to_string(grid.n));
  }
  const int row = FindRow(grid, stop.multitooth_rad);
  const double row_rad = grid.row_offset_rad[static_cast<std::size_t>(row)];
  const int tooth = GridIndex(stop.multitooth_rad, row_rad, grid);
  const int setup = FindSetUp(grid, index, {stop.setup, row, (position + tooth) % grid.n});
  grid.stops.push_back({index, setup, position, row * grid.n + tooth});
}

}  // namespace

double StopGrid::Step_rad() const {
  return units::turn / n;
}

double StopGrid::Tooth_rad(int tooth) const {
  return row_offset_rad[static_cast<std::size_t>(tooth / n)] + tooth % n * Step_rad();
}

StopGrid FindGrid(const std::vector<TurntableStop>& stops, int positions) {
  StopGrid grid;
  grid.n = positions > 0 ? positions : CountPositions(stops);
  if (grid.n < kFewestPositions) throw InputError("readings", "fewer than 3 positions", "a full circle");
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!IsUsable(stops[i])) continue;
    if (grid.stops.empty()) grid.offset_rad = GridOffset(stops[i].turntable_rad, grid.Step_rad());
    AddStop(grid, stops[i], i);
  }
  if (grid.stops.empty()) throw InputError("readings", "no usable measuring position", "at least one mounting");
  return grid;
}

Readings Collect(const std::vector<TurntableStop>& stops, const StopGrid& grid) {
  const auto count = std::ssize(grid.stops);
  Readings readings{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const TurntableStop& stop = stops[grid.stops[static_cast<std::size_t>(k)].stop];
    readings.x_rad[k] = stop.x_rad;
    readings.y_rad[k] = stop.y_rad;
  }
  return readings;
}

}  // namespace twinbench::separate::turntable
