#include "twin/model/course.h"

#include <algorithm>

namespace twinbench::model {
namespace {

void AddLabels(const Reading& r, Course& c) {
  c.reading.push_back(r.reading);
  c.setup.push_back(r.setup);
  c.pass.push_back(r.pass);
  c.direction.push_back(r.direction);
  c.position.push_back(r.position);
  c.phase.push_back(r.phase);
}

Eigen::VectorXd Column(const std::vector<Reading>& readings, double (*value)(const Reading&)) {
  Eigen::VectorXd column(std::ssize(readings));
  std::transform(readings.begin(), readings.end(), column.begin(), value);
  return column;
}

}  // namespace

Course CourseOf(const std::vector<Reading>& readings) {
  Course c;
  for (const Reading& r : readings) AddLabels(r, c);
  c.time_s = Column(readings, [](const Reading& r) { return ToSeconds(r.time); });
  c.dwell_s = Column(readings, [](const Reading& r) { return r.dwell_s; });
  c.temperature_degC = Column(readings, [](const Reading& r) { return r.temperature_degC; });
  c.target_rad = Column(readings, [](const Reading& r) { return r.target_rad; });
  c.reference_rad = Column(readings, [](const Reading& r) { return r.reference_rad; });
  c.velocity_rad_s = Column(readings, [](const Reading& r) { return r.velocity_rad_s; });
  return c;
}

}  // namespace twinbench::model
