#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/units.h"
#include "twin/diagnose/hob/family_parts.h"

namespace twinbench::diagnose::hob {
namespace {

Family Line(const Context& context, const std::string& effect, const Eigen::VectorXd& phase_rad) {
  Family family = NamedFamily(effect);
  family.amplitudes = WaveAmplitudes(effect);
  Use(context, {BaseOf(context, 1, [wave = Wave(phase_rad)](int) { return wave; }), Seen::kByBoth}, family);
  family.parameters = WaveParameters(effect);
  return family;
}

Family Single(const Context& context, const std::string& effect, const std::string& parameter,
              const Eigen::VectorXd& signal, Seen seen) {
  Family family = NamedFamily(effect);
  family.amplitudes = {AmplitudeOf(effect, parameter)};
  Use(context, {BaseOf(context, 1, [signal](int) { return Eigen::MatrixXd(signal); }), seen}, family);
  return family;
}

/// The catalogue's parameters: first amplitude, first shape.
Parameters LagParameters() {
  return [](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{Estimate("hysteresis", "lag", x[0], std::sqrt(cov(0, 0))),
                       Estimate("hysteresis", "settles_over", shape[0], DeviationAt(cov, x.size()))};
  };
}

/// Whether the table runs out over the ramp of the scenario is not sure for readings of somebody else.
Family Hysteresis(const Context& context) {
  Family family = NamedFamily("hysteresis");
  family.amplitudes = {AmplitudeOf("hysteresis", "lag")};
  Shape settles = ShapeOf("hysteresis", "settles_over", {});
  settles.lower = 1.0 * units::deg;
  settles.upper = 720.0 * units::deg;
  Shape ramp{"ramp", "s", 1.0, 0.0, std::max(context->ramp_s, 1e-9), {}};
  for (const double way_rad : Ratios(3.0 * units::deg, 360.0 * units::deg, 14)) {
    for (const double ramp_s : std::set<double>{0.0, context->ramp_s}) {
      settles.value.push_back(way_rad);
      ramp.value.push_back(ramp_s);
    }
  }
  family.shapes = {settles, ramp};
  const SeriesAt states = [context](const Eigen::VectorXd& shape) {
    return Eigen::MatrixXd(Relaxation(*context, shape[0], shape[1]));
  };
  const auto on_grid = [settles, ramp, states](int g) {
    const auto k = static_cast<std::size_t>(g);
    return states(Eigen::Vector2d(settles.value[k], ramp.value[k]));
  };
  Use(context, {BaseOf(context, static_cast<int>(settles.value.size()), on_grid), Seen::kByBoth, -1.0}, family);
  family.at = RowsAt(context, states, Seen::kByBoth, -1.0);
  family.parameters = LagParameters();
  return family;
}

}  // namespace

void AddChain(const Common& common, std::vector<Family>& families) {
  const Context& context = common.context;
  const SignalContext& c = *context;
  families.push_back(Line(context, "hob_runout", c.hob_rad));
  families.push_back(Line(context, "worm", c.train.WormOrder() * c.table_rad));
  families.push_back(Line(context, "gear_mesh", c.train.hob_starts * c.hob_rad));
  if (c.direction.maxCoeff() > c.direction.minCoeff()) {
    families.push_back(Single(context, "backlash", "width", -0.5 * c.direction, Seen::kByBoth));
    families.push_back(Hysteresis(context));
  }
  if (c.velocity_rad_s.cwiseAbs().maxCoeff() > 0.0)
    families.push_back(Single(context, "latency", "delay", -c.velocity_rad_s, Seen::kByEncoders));
}

}  // namespace twinbench::diagnose::hob
