#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/diagnose/unknown/design.h"

namespace twinbench::diagnose::encoder {

namespace {

/// What looks like a clock that runs fast and is none.
std::vector<Family> GrowingSpeeds(const SignalContext& c, const unknown::Design& design) {
  if (!c.Moves()) return {};
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  const Eigen::ArrayXd v = c.velocity_rad_s, t = c.since_start_s;
  collect.Add("growing speed", model::Unit(v * v.abs() * t),
              "proportional to the square of the speed that grows with time, odd in direction");
  collect.Add("growing speed", model::Unit(v.abs() * t),
              "proportional to the speed that grows with time, even in direction");
  return collect.Take();
}

/// What a reversal leaves may be another thing at every target; that of all together is play or its like. Of free errors
/// of targets, orders of their angle would be no smaller a description.
std::vector<Family> ReversalsByTarget(const Eigen::MatrixXd& targets, const unknown::Design& design) {
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  Eigen::MatrixXd beside_mean = targets.leftCols(targets.cols() - 1);
  beside_mean.rowwise() -= beside_mean.colwise().mean().eval();
  collect.Add("direction by target", model::Times(beside_mean, std::sqrt(targets.cols()) * design.senses.front()),
              fmt::format("direction times an error of its own at each of {} targets, synchronous with reference "
                          "angle, odd in direction", targets.cols()));
  return collect.Take();
}

}  // namespace

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
  design.above_K = c.above_K;
  design.twin_is_warm = true;
  design.series = series;
  design.unit = encoder.run.unit;
  design.to_SI = encoder.run.to_SI;
  design.plausible = plausible_rad;
  design.may_be_touched = true;
  design.named = {{"harmonic", ""}, {"direction offset", ""}, {"transition", ""}, {"step", "slip"}, {"trend", ""}, {"temperature", "zero_temperature"}};
  if (!c.has_clock) design.named.erase("trend");  // no drift is tried
  // Of one pass in each direction, what differs from pass to pass is what a reversal leaves.
  const bool is_turned_once = std::ranges::max(c.pass) - std::ranges::min(c.pass) == 1;
  if (is_turned_once && design.senses.front().maxCoeff() > design.senses.front().minCoeff()) design.named.emplace("pass", "");
  std::vector<Family> families = unknown::Families(design);
  // Without a clock nothing has a frequency or a time constant.
  if (!c.has_clock)
    std::erase_if(families, [](const Family& family) { return family.effect == "tone" || family.effect == "restart"; });
  if (encoder.targets.size() > 0) {
    std::erase_if(families, [](const Family& family) { return family.effect == "direction harmonic"; });
    std::ranges::move(ReversalsByTarget(encoder.targets, design), std::back_inserter(families));
  }
  std::ranges::move(GrowingSpeeds(c, design), std::back_inserter(families));
  std::ranges::move(LostCountFamilies(c, design), std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::encoder
