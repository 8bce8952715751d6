#include "twin/benches/encoder_comparison/diagnosis/steady_reference.h"

#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/model/course.h"
#include "twin/model/motion.h"

namespace twinbench::diagnose::encoder {

std::vector<Reading> OnSteadyCourse(std::vector<Reading> readings, const Scenario& scenario) {
  constexpr Eigen::Index kFewest = 12;
  if (EncoderOf(scenario).encoder_procedure.kind != "sweep") return readings;
  std::vector<Reading*> moved;
  std::vector<Reading> used;
  for (const int k : measure::CompareAngles(readings).used) {
    moved.push_back(&readings[static_cast<std::size_t>(k)]);
    used.push_back(*moved.back());
  }
  if (std::ssize(used) < kFewest) return readings;
  const model::Course course = model::CourseOf(used);
  const model::SteadyCourse steady = model::SteadyCourseOf(course, course.reference_rad);
  if (!steady.is_smoothed) return readings;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    moved[i]->measured_rad += steady.values[at] - moved[i]->reference_rad;
    moved[i]->reference_rad = steady.values[at];
    moved[i]->velocity_rad_s = steady.rate[at];
  }
  return readings;
}

}  // namespace twinbench::diagnose::encoder
