#include <algorithm>
#include <cmath>
#include <set>

#include "twin/benches/hob_transmission/diagnosis/family_parts.h"
#include "twin/benches/hob_transmission/format.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::hob {
namespace {

/// A cause that shows in the encoders' m alone, or to the interferometer as well.
Showing Shown(const SignalContext& c, const std::string& effect, const std::string& where, ShownBy shown_by,
              double factor = 1.0) {
  Eigen::VectorXd pattern = Eigen::VectorXd::Zero(c.channels);
  if (shown_by != ShownBy::kByInterferometer) pattern[0] = factor;
  if (c.channels > 1 && shown_by != ShownBy::kByEncoders) pattern[1] = factor;
  return {effect, where, pattern};
}

/// What a ring shows too much, by orders of its own angle.
struct RingPlace {
  std::string where;
  SharedBase orders;  // 1, 2, ...
  double factor;      // seen in m for what it shows
};

/// `count` orders from `first` on, out of a base that has all of them.
SharedBase Part(const SharedBase& orders, int first, int count) {
  auto part = std::make_shared<Base>(*orders);
  part->grid = count;
  part->series = [orders, first](int g) { return orders->series(first - 1 + g); };
  return part;
}

/// Eccentricity, ellipticity, and the orders that these have not.
void AddRing(const SignalContext& c, const RingPlace& ring, Candidates& named) {
  constexpr int kFirst = 3;
  const auto shown = [&](const char* effect) {
    return Shown(c, effect, ring.where, ShownBy::kByEncoders, ring.factor);
  };
  named.AddOrders(shown("eccentricity"), Part(ring.orders, 1, 1), "", {});
  named.AddOrders(shown("ellipticity"), Part(ring.orders, 2, 1), "", {});
  const int count = ring.orders->grid - kFirst + 1;
  if (count < 1) return;
  named.AddOrders(shown("periodic"), Part(ring.orders, kFirst, count), "order",
                  Even(kFirst, kFirst + count - 1.0, count));
}

/// The wave of twice the phase has the size ratio / (2 + ratio), of which the signature is the first order.
Parameters MismatchParameters(const Catalogue& catalogue) {
  return [catalogue](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double less = std::max(1.0 - 0.5 * x[0], 0.1);
    return std::vector{
        catalogue.Estimate("amplitude_mismatch", "ratio", x[0] / less, std::sqrt(cov(0, 0)) / (less * less))};
  };
}

void AddHobSignals(const SignalContext& c, Candidates& named) {
  const Eigen::MatrixXd faults = SignalFaults_rad(c);
  const auto shown = [&](const char* effect) {
    return Shown(c, effect, "", ShownBy::kByEncoders, -c.train.Ratio() / c.hob_lines);
  };
  named.Add(shown("signal_offset"), {"offset_sin", "offset_cos"}, faults.leftCols(2));
  named.Add(shown("amplitude_mismatch"), {"ratio"}, faults.col(2)).parameters =
      MismatchParameters(named.catalogue());
  named.Add(shown("quadrature_error"), {"angle"}, faults.col(3));
}

/// Whether the table runs out over the ramp of the scenario is not sure for readings of somebody else.
void AddHysteresis(const Context& context, Candidates& named) {
  Shape settles{"settles_over", "deg", units::deg, 1.0 * units::deg, 720.0 * units::deg, {}};
  Shape ramp{"ramp", "s", 1.0, 0.0, std::max(context->ramp_s, 1e-9), {}};
  for (const double way_rad : Ratios(3.0 * units::deg, 360.0 * units::deg, 14)) {
    for (const double ramp_s : std::set<double>{0.0, context->ramp_s}) {
      settles.value.push_back(way_rad);
      ramp.value.push_back(ramp_s);
    }
  }
  Family& family = named.AddOver(Shown(*context, "hysteresis", "", ShownBy::kByBoth, -1.0), {"lag"},
                                 {settles, ramp}, [context](const Eigen::VectorXd& shape) {
                                   return Eigen::MatrixXd(Relaxation(*context, shape[0], shape[1]));
                                 });
  family.parameters = [catalogue = named.catalogue()](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                      const Eigen::MatrixXd& cov) {
    return std::vector{catalogue.Estimate("hysteresis", "lag", x[0], std::sqrt(cov(0, 0))),
                       catalogue.Estimate("hysteresis", "settles_over", shape[0], DeviationAt(cov, x.size()))};
  };
}

void AddChain(const Context& context, Candidates& named) {
  const SignalContext& c = *context;
  const auto moved = [&](const char* effect, double factor = 1.0) {
    return Shown(c, effect, "", ShownBy::kByBoth, factor);
  };
  named.AddWave(moved("hob_runout"), c.hob_rad);
  named.AddWave(moved("worm"), c.train.WormOrder() * c.table_rad);
  named.AddWave(moved("gear_mesh"), c.train.hob_starts * c.hob_rad);
  if (c.direction.maxCoeff() > c.direction.minCoeff()) {
    named.Add(moved("backlash", -0.5), {"width"}, c.direction);
    AddHysteresis(context, named);
  }
  if (c.velocity_rad_s.cwiseAbs().maxCoeff() > 0.0)
    named.Add(Shown(c, "latency", "", ShownBy::kByEncoders, -1.0), {"delay"}, c.velocity_rad_s);
}

/// A drift or a vibration may be the table's, or of the way in which its encoder is held: both count as one cause.
void AddTime(const Common& common, Candidates& named) {
  const SignalContext& c = *common.context;
  std::vector<ShownBy> ways = {ShownBy::kByBoth};
  if (c.channels > 1) ways.push_back(ShownBy::kByEncoders);
  for (const ShownBy shown_by : ways) {
    named.AddDrift(Shown(c, "drift", "", shown_by), "rate", c.schedule.time_s);
    named.AddTone(Shown(c, "tone", "", shown_by), common.series);
  }
  named.AddStep(Shown(c, "slip", "table", ShownBy::kByEncoders), "step", common.series);
  named.AddStep(Shown(c, "slip", "hob", ShownBy::kByEncoders, -c.train.Ratio()), "step", common.series);
}

}  // namespace

std::vector<Family> NamedFamilies(const Common& common, double plausible_rad) {
  const SignalContext& c = *common.context;
  Candidates named(Catalogue(benches::hob::Format().effects), c.channels, MeansOf(common.context));
  AddRing(c, {"table", common.ring_orders, 1.0}, named);
  AddRing(c, {"hob", common.hob_orders, -c.train.Ratio()}, named);
  AddHobSignals(c, named);
  AddChain(common.context, named);
  AddTime(common, named);
  std::vector<Family> families = named.Take();
  for (Family& family : families) SetSizesByTrace(c.channels, plausible_rad, family);
  return families;
}

}  // namespace twinbench::diagnose::hob
