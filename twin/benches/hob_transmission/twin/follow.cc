#include "twin/benches/hob_transmission/twin/follow.h"

#include <cmath>
#include <map>

#include "mechanics/steady_gear_train.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/course.h"
#include "twin/benches/hob_transmission/twin/encoders.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

using units::arcsec, units::um;

/// What disturbances add to one sample [rad].
struct HobExtra {
  double transmission_rad = 0.0;                          // motion of the table against the hob
  double table_encoder_rad = 0.0, hob_encoder_rad = 0.0;  // shown
  double interferometer_rad = 0.0;
};

using HobPoint = BenchPoint<HobExtra>;

model::Point Angle(const char* name) {
  return {name, "arcsec", arcsec, 1e-2 * arcsec};
}
model::Point Length(const char* name) {
  return {name, "um", um, 0.01 * um};
}

const std::vector<HobPoint>& HobPoints() {
  using E = HobExtra;
  using S = Scenario;
  static const std::vector<HobPoint> points = {
      {Angle("transmission"), [](E& e) -> double& { return e.transmission_rad; }},
      {Angle("table_encoder"), [](E& e) -> double& { return e.table_encoder_rad; }},
      {Angle("hob_encoder"), [](E& e) -> double& { return e.hob_encoder_rad; }},
      {Angle("interferometer"), [](E& e) -> double& { return e.interferometer_rad; }},
      {Angle("worm.backlash"), nullptr, [](S& s) -> double& { return HobOf(s).transmission.backlash_rad; }},
      {{"table.friction", "Nm", 1.0, 1.0},
       nullptr,
       [](S& s) -> double& { return HobOf(s).transmission.friction_Nm; }},
      {Length("table_encoder.eccentricity"), nullptr,
       [](S& s) -> double& { return HobOf(s).table_encoder.eccentricity_m; }},
      {Length("hob_encoder.eccentricity"), nullptr,
       [](S& s) -> double& { return HobOf(s).hob_encoder.eccentricity_m; }}};
  return points;
}

/// The orders that an evaluation takes as unknown are not the scenario's to say.
Scenario WithoutFreeOrders(Scenario scenario) {
  TransmissionSettings& t = HobOf(scenario).transmission;
  WithoutBullet(HobOf(scenario).mechanics);
  std::erase_if(t.harmonics, [&](const HarmonicSettings& h) {
    return h.order == std::round(h.order) && h.order >= 1.0 && h.order <= t.free_orders;
  });
  return scenario;
}

class HobFollow : public PointwiseFollow<HobExtra> {
 public:
  HobFollow(const Scenario& stated, const std::vector<Reading>& its_record)
      : PointwiseFollow(WithoutFreeOrders(Foreseeable(stated, its_record)), its_record, HobPoints()),
        path_(scenario()),
        train_(path_.train()),
        encoders_(path_.actual(), path_.HobSignals()),
        course_(FollowCourse(record(), path_)) {
    for (const Reading& r : record()) {
      if (std::isfinite(r.head_rad)) rings_.try_emplace(r.head_rad, encoders_.TableRing(r.head_rad));
    }
  }

  std::vector<std::string> Unfixed() const override { return course_.unfixed; }

 protected:
  Eigen::MatrixXd Shown(const std::vector<HobExtra>& extra) const override {
    Eigen::MatrixXd shown_rad(std::ssize(extra), 2);
    for (std::size_t i = 0; i < extra.size(); ++i) shown_rad.row(static_cast<Eigen::Index>(i)) = At(i, extra[i]);
    return shown_rad;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<HobFollow>(changed, record());
  }

 private:
  Eigen::RowVector2d At(std::size_t i, const HobExtra& extra) const {
    const HobStop& stop = course_.stops[i];
    const Reading& r = record()[i];
    const double ratio = HobOf(path_.actual()).transmission.Ratio();
    const double hob_shown_rad = stop.hob_shown_rad - extra.hob_encoder_rad;
    if (!std::isfinite(hob_shown_rad) || !std::isfinite(r.head_rad)) return Eigen::RowVector2d::Constant(kNaN);
    const double hob_rad = encoders_.Hob_rad(hob_shown_rad) + stop.zero_rad / ratio;
    const double velocity_rad_s = ratio * stop.hob_speed_rad_s;
    const double table_rad =
        train_.Table_rad(hob_rad, stop.hob_speed_rad_s, stop.direction) + extra.transmission_rad;
    const double scale_rad = rings_.at(r.head_rad).Scale_rad(table_rad);
    const double table_shown_rad =
        encoders_.TableShown_rad(scale_rad, r.head_rad) + stop.added.table_encoder_rad + extra.table_encoder_rad;
    return {table_shown_rad - ratio * r.reference_rad,
            path_.Interferometer_rad(table_rad, hob_rad, velocity_rad_s, r.time) + stop.added.interferometer_rad +
                extra.interferometer_rad};
  }

  HobPath path_;
  mechanics::SteadyGearTrain train_;
  HobEncoders encoders_;
  HobCourse course_;
  std::map<double, mechanics::RingEncoder> rings_;  // of the table, by its head
};

}  // namespace

std::unique_ptr<model::Follow> FollowHob(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<HobFollow>(scenario, record);
}

}  // namespace twinbench::sim
