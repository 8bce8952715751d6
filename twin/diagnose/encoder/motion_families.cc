#include <algorithm>
#include <set>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/named_parts.h"

namespace twinbench::diagnose::encoder {
namespace {

/// To first order half the gap behind the motion, with the sense remembered in one of several ways.
Family Backlash(const Context& context) {
  const std::vector<Eigen::VectorXd> senses = Senses(*context);
  Family family = Named("backlash");
  family.amplitudes = {AmplitudeOf("backlash", "width")};
  family.grid = static_cast<int>(senses.size());
  family.columns = [senses](int g) { return Eigen::MatrixXd(-0.5 * senses[static_cast<std::size_t>(g)]); };
  family.shapes = {{"memory", "1", 1.0, 0.0, 2.0, {}}};
  for (int g = 0; g < family.grid; ++g) family.shapes[0].value.push_back(g);
  family.parameters = ReportOnly("backlash", "width");
  return family;
}

/// The lag in steady motion, and what is left of an unknown state at the beginning: that is no larger than the lag.
Family Hysteresis(const Context& context, double plausible_rad) {
  Family family = Named("hysteresis");
  Amplitude lag = AmplitudeOf("hysteresis", "lag");
  lag.prior_sd = plausible_rad;
  Amplitude start = lag;
  start.name = "start";
  family.amplitudes = {lag, start};
  Shape settles = ShapeOf("hysteresis", "settles_over", {});
  settles.lower = 2.0 * units::deg;
  settles.upper = 360.0 * units::deg;
  Shape run_up{"run_up", "deg", units::deg, 0.0, std::max(RunUp_rad(*context), 1e-9), {}};
  for (const double way_rad : Ratios(3.0 * units::deg, 180.0 * units::deg, 14)) {
    for (const double approach_rad : std::set<double>{0.0, RunUp_rad(*context)}) {
      settles.value.push_back(way_rad);
      run_up.value.push_back(approach_rad);
    }
  }
  family.shapes = {settles, run_up};
  family.grid = static_cast<int>(settles.value.size());
  family.at = [context](const Eigen::VectorXd& shape) {
    return Eigen::MatrixXd(-Relaxation(*context, shape[0], shape[1]));
  };
  family.columns = [settles, run_up, at = family.at](int g) {
    const auto k = static_cast<std::size_t>(g);
    return at(Eigen::Vector2d(settles.value[k], run_up.value[k]));
  };
  family.parameters = ReportOnly("hysteresis", "lag", "settles_over");
  return family;
}

}  // namespace

void AddMotion(const Context& context, double plausible_rad, std::vector<Family>& families) {
  const SignalContext& c = *context;
  const Eigen::VectorXd sense = Sense(c, true);
  if (c.Moves()) families.push_back(Linear("latency", {"delay"}, -c.velocity_rad_s));
  if (sense.size() > 0 && sense.maxCoeff() > sense.minCoeff()) {
    families.push_back(Backlash(context));
    families.push_back(Hysteresis(context, plausible_rad));
  }
  families.push_back(Linear("scale", {"ratio"}, c.reference_rad));
}

}  // namespace twinbench::diagnose::encoder
