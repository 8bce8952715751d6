#include "twin/benches/encoder_comparison/twin/twin.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/units.h"
#include "twin/model/motion.h"
#include "twin/model/signals.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

/// What disturbances add to one reading.
struct AngleExtra {
  double shaft_rad = 0.0, device_rad = 0.0;
};
using AnglePoint = BenchPoint<AngleExtra>;

const std::vector<AnglePoint>& AnglePoints() {
  static const std::vector<AnglePoint> points = {
      {{"shaft", "deg", units::deg, 1.0 * units::arcsec}, [](AngleExtra& e) -> double& { return e.shaft_rad; }},
      {{"device", "deg", units::deg, 1.0 * units::arcsec}, [](AngleExtra& e) -> double& { return e.device_rad; }}};
  return points;
}

/// Nobody foresees how a scale was made.
Scenario WithoutGraduation(Scenario scenario) {
  EncoderOf(scenario).device.graduation_rad = 0.0;
  return scenario;
}

/// Half the usual way between the stops that were recorded, from far away to a place that was reached again and again
/// from both sides; none if the shaft moved while it was read.
double RunUp_rad(const std::vector<Reading>& record, const Scenario& scenario) {
  const auto moves = [](const Reading& r) { return std::isfinite(r.velocity_rad_s) && r.velocity_rad_s != 0.0; };
  if (EncoderOf(scenario).encoder_procedure.kind != "stops" || std::ranges::any_of(record, moves)) return 0.0;
  const model::Course course = model::CourseOf(record);
  const double step_rad = model::TypicalStep_rad(course, course.reference_rad);
  const auto is_in = [&course](int direction) { return std::ranges::count(course.direction, direction) > 0; };
  const bool is_one_place = step_rad == 0.0 && is_in(1) && is_in(-1);
  return 0.5 * (is_one_place ? units::turn : step_rad);
}

/// Of a reading in motion behind others that were left out the next one tells how the shaft gains speed.
double BehindGap_rad_s2(const std::vector<Reading>& record, std::size_t i) {
  if (i == 0 || i + 1 >= record.size() || record[i].velocity_rad_s == 0.0) return kNaN;
  const Reading &before = record[i - 1], &at = record[i], &next = record[i + 1];
  const double step_s = ToSeconds(next.time - at.time);
  const bool is_behind_gap = next.setup == at.setup && step_s > 0.0 && ToSeconds(at.time - before.time) > model::kLongestStep * step_s;
  return is_behind_gap ? (next.velocity_rad_s - at.velocity_rad_s) / step_s : kNaN;
}

class EncoderFollow : public PointwiseFollow<AngleExtra> {
 public:
  EncoderFollow(const Scenario& stated, const std::vector<Reading>& record)
      : PointwiseFollow(WithoutGraduation(Foreseeable(stated, record)), record, AnglePoints()) {}

  std::vector<std::string> Unfixed() const override {
    return {"angles of the device on the shaft: free in every mounting"};
  }

 protected:
  Eigen::MatrixXd Shown(const std::vector<AngleExtra>& extra) const override {
    EncoderTwin twin(scenario(), RunUp_rad(record(), scenario()));  // anew: its effects have memories
    Eigen::VectorXd shown_rad(std::ssize(extra));
    for (std::size_t i = 0; i < extra.size(); ++i)
      shown_rad[static_cast<Eigen::Index>(i)] =
          twin.DeviceAt_rad(record()[i], extra[i].shaft_rad, BehindGap_rad_s2(record(), i)) + extra[i].device_rad;
    return shown_rad;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<EncoderFollow>(changed, record());
  }
};

}  // namespace

std::unique_ptr<model::Follow> FollowEncoder(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<EncoderFollow>(scenario, record);
}

}  // namespace twinbench::sim
