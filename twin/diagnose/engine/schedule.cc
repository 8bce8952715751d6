#include "twin/diagnose/engine/schedule.h"

#include <algorithm>

namespace twinbench::diagnose {
namespace {

void AddLabels(const Reading& r, Schedule& s) {
  s.reading.push_back(r.reading);
  s.setup.push_back(r.setup);
  s.pass.push_back(r.pass);
  s.direction.push_back(r.direction);
  s.position.push_back(r.position);
  s.phase.push_back(r.phase);
}

Eigen::VectorXd Column(const std::vector<Reading>& readings, double (*value)(const Reading&)) {
  Eigen::VectorXd column(std::ssize(readings));
  std::transform(readings.begin(), readings.end(), column.begin(), value);
  return column;
}

}  // namespace

Schedule ScheduleOf(const std::vector<Reading>& used) {
  Schedule s;
  for (const Reading& r : used) AddLabels(r, s);
  s.time_s = Column(used, [](const Reading& r) { return ToSeconds(r.time); });
  s.dwell_s = Column(used, [](const Reading& r) { return r.dwell_s; });
  s.temperature_degC = Column(used, [](const Reading& r) { return r.temperature_degC; });
  s.target_rad = Column(used, [](const Reading& r) { return r.target_rad; });
  s.reference_rad = Column(used, [](const Reading& r) { return r.reference_rad; });
  s.velocity_rad_s = Column(used, [](const Reading& r) { return r.velocity_rad_s; });
  return s;
}

}  // namespace twinbench::diagnose
