#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/diagnose/unknown/design.h"
#include "twin/model/signals.h"

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

/// Whether the means of passes that all go one way lie on two sides of a parabola over the passes, by their direction: one pass
/// that is off does not make them.
bool ShowsReversal(const std::vector<int>& pass, const Eigen::VectorXd& sense, const Eigen::VectorXd& error_rad) {
  constexpr Eigen::Index kFewest = 6;
  constexpr double kClearly = 5.0;  // of its uncertainty
  const Eigen::MatrixXd passes = model::Indicators(pass);
  const Eigen::VectorXd readings = passes.colwise().sum(), way = (passes.transpose() * sense).cwiseQuotient(readings);
  const Eigen::Index count = passes.cols();
  if (count < kFewest || way.cwiseAbs().minCoeff() < 1.0 || way.minCoeff() == way.maxCoeff()) return false;
  const Eigen::VectorXd mean_rad = (passes.transpose() * error_rad).cwiseQuotient(readings);
  const Eigen::ArrayXd number = Eigen::ArrayXd::LinSpaced(count, -1.0, 1.0);
  Eigen::MatrixXd columns(count, 4);
  columns << Eigen::VectorXd::Ones(count), number.matrix(), number.square().matrix(), way;
  const Eigen::VectorXd sizes = SolveShortest(columns, mean_rad);
  const double left = (mean_rad - columns * sizes).squaredNorm() / static_cast<double>(count - columns.cols());
  const double u = std::sqrt(left * GeneralInverseOf(columns.transpose() * columns)(3, 3));
  return std::abs(sizes[3]) > kClearly * u;
}

/// Passes that all go one way have what a reversal leaves in their offsets, and a course in time goes to and fro with them; it
/// has a name of its own, and is none of each.
void LeaveReversalsToNamed(const Eigen::VectorXd& sense, std::vector<Family>& families) {
  for (Family& family : families) {
    if (!family.base || (family.effect != "pass" && family.effect != "wander")) continue;
    auto beside = std::make_shared<Base>(*family.base);
    beside->series = [series = family.base->series, sense](int g) -> Eigen::MatrixXd {
      const Eigen::MatrixXd all = series(g);
      return all - sense * (sense.transpose() * all) / sense.squaredNorm();
    };
    family.base = beside;
  }
}

}  // namespace

std::vector<Family> UnknownFamilies(const EncoderRun& encoder, const TimeSeries& series, double plausible_rad) {
  const SignalContext& c = encoder.context;
  unknown::Design design;
  design.course = encoder.run.schedule;
  design.channels = encoder.run.channels;
  design.places = {{"angle", "angle", Eigen::MatrixXd::Ones(1, 1)}};
  design.angles = {{"reference angle", c.device_rad, LargestOrder(c), LeastOrder(c), "harmonic", "device", true, LeastOrder(c),
                    WholeOrders(c, LeastOrder(c))}};
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
  design.named = {{"harmonic", ""}, {"direction offset", ""}, {"transition", ""}, {"step", "slip"}, {"trend", ""}, {"slope", "scale"}, {"temperature", "zero_temperature"}};
  // No drift is tried; in one pass it is the slope.
  if (!c.has_clock && !unknown::TimeFollowsAngle(design)) design.named.erase("trend");
  // Of one pass in each direction, what differs from pass to pass is what a reversal leaves.
  const bool is_turned_once = std::ranges::max(c.pass) - std::ranges::min(c.pass) == 1;
  if (is_turned_once && design.senses.front().maxCoeff() > design.senses.front().minCoeff()) design.named.emplace("pass", "");
  const bool is_one_place = FinestSpacing_rad(c) == 0.0 && !c.Moves();
  if (is_one_place) design.named["direction offset"] = "backlash";  // which is then nothing else
  std::vector<Family> families = unknown::Families(design);
  if (is_one_place)
    // How far it is pushed each time is another force.
    std::erase_if(families, [](const Family& family) { return family.effect == "transition" || family.effect == "reversal" || family.effect == "pass"; });
  // Without a clock nothing has a frequency or a time constant.
  if (!c.has_clock)
    std::erase_if(families, [](const Family& family) { return family.effect == "tone" || family.effect == "restart" || family.effect == "temperature rate"; });
  // Nor has anything a course in time that goes with the angle.
  if (!c.has_clock && unknown::TimeFollowsAngle(design))
    std::erase_if(families, [](const Family& family) { return family.effect == "wander"; });
  if (encoder.targets.size() > 0) {
    std::erase_if(families, [](const Family& family) { return family.effect == "direction harmonic"; });
    if (encoder.targets.cols() > 1) std::ranges::move(ReversalsByTarget(encoder.targets, design), std::back_inserter(families));
  }
  if (ShowsReversal(c.pass, design.senses.front(), encoder.run.residual)) LeaveReversalsToNamed(design.senses.front(), families);
  std::ranges::move(GrowingSpeeds(c, design), std::back_inserter(families));
  std::ranges::move(LostCountFamilies(c, design), std::back_inserter(families));
  std::ranges::move(CodeDigitFamilies(encoder, design), std::back_inserter(families));
  std::ranges::move(RangeEndFamilies(encoder, design), std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::encoder
