#include "twin/sim/environment.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

constexpr double kWalkStep_s = 60.0;

double Interpolate(double left, double right, double share) {
  return left + (right - left) * share;
}

}  // namespace

Environment::Environment(const EnvironmentSettings& settings, std::uint64_t seed)
    : settings_(settings), walk_steps_(seed, "environment.walk"), sensor_noise_(seed, "environment.sensor") {
  if (!settings_.temperature_file.empty()) ReadRecord(ReadCsv(settings_.temperature_file));
}

void Environment::ReadRecord(const CsvTable& table) {
  const auto time = table.Column("time_s"), temperature = table.Column("temperature_degC");
  if (!time || !temperature)
    throw InputError(table.WhereHeader(), "a column is missing", "columns time_s and temperature_degC");
  for (const CsvTable::Row& row : table.rows) {
    const double t_s = CsvNumber(table, row, *time, 1.0);
    if (!record_s_.empty() && t_s <= record_s_.back())
      throw InputError(table.Where(row), "time does not increase", "rows in time order");
    record_s_.push_back(t_s);
    record_K_.push_back(CsvNumber(table, row, *temperature, 1.0));
  }
  if (record_s_.empty()) throw InputError(table.name, "holds no rows", "rows of time_s and temperature_degC");
}

double Environment::Temperature_degC(Time now) {
  const double t_s = ToSeconds(now);
  const double level_degC = record_s_.empty() ? settings_.temperature_degC : Recorded_K(t_s);
  const double swing_K = settings_.swing_K == 0.0
                             ? 0.0
                             : settings_.swing_K * std::sin(2.0 * units::kPi * t_s / settings_.swing_period_s);
  return level_degC + settings_.drift_K_h * t_s / units::hour + swing_K + RandomWalk_K(t_s);
}

double Environment::Measure_degC(Time now) {
  const double noise_K = settings_.sensor_noise_K > 0.0 ? settings_.sensor_noise_K * sensor_noise_.Normal() : 0.0;
  return Temperature_degC(now) + noise_K;
}

double Environment::RandomWalk_K(double t_s) {
  if (settings_.random_walk_K_sqrt_h == 0.0) return 0.0;
  const double steps = std::max(0.0, t_s / kWalkStep_s);
  const auto index = static_cast<std::size_t>(steps);
  const double sd_K = settings_.random_walk_K_sqrt_h * std::sqrt(kWalkStep_s / units::hour);
  while (walk_K_.size() <= index + 1) walk_K_.push_back(walk_K_.back() + sd_K * walk_steps_.Normal());
  return Interpolate(walk_K_[index], walk_K_[index + 1], steps - static_cast<double>(index));
}

double Environment::Recorded_K(double t_s) const {
  const auto after = std::upper_bound(record_s_.begin(), record_s_.end(), t_s);
  if (after == record_s_.begin()) return record_K_.front();
  if (after == record_s_.end()) return record_K_.back();
  const std::size_t k = static_cast<std::size_t>(after - record_s_.begin());
  return Interpolate(record_K_[k - 1], record_K_[k], (t_s - record_s_[k - 1]) / (record_s_[k] - record_s_[k - 1]));
}

}  // namespace twinbench::sim
