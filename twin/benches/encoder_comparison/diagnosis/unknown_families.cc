#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/diagnose/unknown/design.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {

std::vector<Family> UnknownFamilies(const EncoderRun& encoder, const TimeSeries& series, double plausible_rad) {
  const SignalContext& c = encoder.context;
  unknown::Design design;
  design.course = encoder.run.schedule;
  design.channels = encoder.run.channels;
  design.places = {{"angle", "angle", Eigen::MatrixXd::Ones(1, 1)}};
  design.angles = {{"reference angle", c.device_rad, LargestOrder(c), LeastOrder(c), "harmonic", "device"}};
  design.continued_rad = c.device_rad;
  design.moved = Eigen::VectorXd::Ones(c.Readings());
  design.senses = Senses(c);
  design.travel_rad = TravelSinceReversal_rad(c);
  design.velocity = c.velocity_rad_s;
  if (model::HasTemperature(design.course)) {
    const Eigen::VectorXd T = model::Above_K(design.course, 0.0);
    design.above_K = T.array() - T.mean();
  }
  design.series = series;
  design.unit = encoder.run.unit;
  design.to_SI = encoder.run.to_SI;
  design.plausible = plausible_rad;
  design.may_be_touched = true;
  design.named = {"harmonic", "direction offset", "transition", "step", "trend"};
  return unknown::Families(design);
}

}  // namespace twinbench::diagnose::encoder
