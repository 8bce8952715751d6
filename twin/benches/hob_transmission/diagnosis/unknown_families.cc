#include <algorithm>

#include "twin/benches/hob_transmission/diagnosis/family_parts.h"
#include "twin/diagnose/unknown/design.h"

namespace twinbench::diagnose::hob {
namespace {

/// On both channels together, on the encoders' alone and on the interferometer's alone, as far as they are there.
std::vector<unknown::Place> GenericPlaces(const SignalContext& c) {
  if (c.channels == 1) return {{kTransmission, kTransmission, Eigen::MatrixXd::Ones(1, 1)}};
  const std::string both = std::string(kTransmission) + ", " + kInterferometer;
  return {{both, both, Eigen::Vector2d::Ones()},
          {kTransmission, kTransmission, Eigen::Vector2d::UnitX()},
          {kInterferometer, kInterferometer, Eigen::Vector2d::UnitY()}};
}

/// Low orders of the table are free as far as nobody else sees them; orders of the ring and the hob are its own, or
/// those of named causes.
std::vector<unknown::Angle> GenericAngles(const Common& common) {
  const SignalContext& c = *common.context;
  const int first = c.channels > 1 ? 1 : c.train.free_orders + 1;
  return {{"table angle", c.table_rad, common.table_orders->grid, first, "harmonic", "table"},
          {"the table's ring and head", c.ring_rad, common.ring_orders->grid, 1, "ring harmonic", "", false},
          {"hob angle", c.hob_rad, common.hob_orders->grid, 1, "hob harmonic", "", false}};
}

}  // namespace

std::vector<Family> UnknownFamilies(const HobRun& hob, const Common& common, double plausible_rad) {
  const SignalContext& c = *common.context;
  unknown::Design design;
  design.course = c.schedule;
  design.channels = hob.run.channels;
  design.places = GenericPlaces(c);
  design.angles = GenericAngles(common);
  design.continued_rad = c.table_rad;
  design.moved = Eigen::VectorXd::Ones(c.Samples());
  design.senses = {c.direction};
  design.travel_rad = TravelSinceReversal_rad(c);
  design.velocity = c.velocity_rad_s;
  design.series = common.series;
  design.unit = hob.run.unit;
  design.to_SI = hob.run.to_SI;
  design.plausible = plausible_rad;
  design.named = {{"ring harmonic", ""}, {"hob harmonic", ""}, {"direction offset", ""}, {"transition", ""},
                  {"speed", ""},         {"trend", ""},        {"step", "slip"},         {"tone", "tone"}};
  design.rows = MeansOf(common.context);
  return unknown::Families(design);
}

}  // namespace twinbench::diagnose::hob
