#include "twin/diagnose/hob/family_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/format.h"
#include "twin/core/units.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose::hob {
namespace {

const EffectParameter& Entry(const std::string& effect, const std::string& parameter) {
  return CatalogueParameter(benches::hob::Format().effects, effect, parameter);
}

/// Typical way of the table from one sample to the next.
double SampleSpacing_rad(const SignalContext& c) {
  std::vector<double> steps_rad;
  for (Eigen::Index i = 1; i < c.Samples(); ++i) steps_rad.push_back(std::abs(c.table_rad[i] - c.table_rad[i - 1]));
  std::nth_element(steps_rad.begin(), steps_rad.begin() + std::ssize(steps_rad) / 2, steps_rad.end());
  return std::max(steps_rad[steps_rad.size() / 2], 1e-9);
}

}  // namespace

SharedBase BaseOf(const Context& context, int grid, const Series& series) {
  auto base = std::make_shared<Base>();
  base->grid = grid;
  base->channels = context->channels;
  base->series = [context, series](int g) { return context->groups.Mean(series(g)); };
  return base;
}

SharedBase OrdersOf(const Context& context, const Eigen::VectorXd& angle_rad, int first, int count,
                    const Eigen::VectorXd& factor) {
  const auto waves = std::make_shared<const model::WaveGrid>(angle_rad, first, 1.0, count);
  return BaseOf(context, count, [waves, factor](int g) -> Eigen::MatrixXd {
    if (factor.size() == 0) return waves->At(g);
    return waves->At(g).array().colwise() * factor.array();
  });
}

Eigen::MatrixXd Shown(const SignalContext& context, Eigen::Index columns, Seen seen, double factor) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(columns * context.channels, columns);
  if (seen != Seen::kByInterferometer) map.topRows(columns).diagonal().setConstant(factor);
  if (context.channels > 1 && seen != Seen::kByEncoders) map.bottomRows(columns).diagonal().setConstant(factor);
  return map;
}

void Use(const Context& context, const Source& source, Family& family) {
  family.base = source.base;
  family.grid = source.base->grid;
  family.map = Shown(*context, std::ssize(family.amplitudes), source.seen, source.factor);
}

std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> RowsAt(const Context& context, const SeriesAt& at, Seen seen,
                                                              double factor) {
  return
      [=](const Eigen::VectorXd& shape) -> Eigen::MatrixXd { return factor * AsRows(*context, at(shape), seen); };
}

Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, kPriorToBeSet, p.lower_SI, p.upper_SI};
}

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI) {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, p.lower_SI, p.upper_SI, std::move(values_SI)};
}

ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u) {
  return EstimateOf(Entry(effect, parameter), value, u);
}

std::vector<Amplitude> WaveAmplitudes(const std::string& effect) {
  std::vector<Amplitude> waves(2, AmplitudeOf(effect, "amplitude"));
  waves[0].name = "cosine";
  waves[1].name = "sine";
  return waves;
}

Parameters WaveParameters(const std::string& effect, const std::string& shape_name) {
  return [=](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    std::vector<ParameterEstimate> estimates = {Estimate(effect, "amplitude", polar.size, polar.u_size),
                                                Estimate(effect, "phase", polar.phase_rad, polar.u_phase_rad)};
    if (!shape_name.empty())
      estimates.insert(estimates.begin(), Estimate(effect, shape_name, shape[0], 0.0));  // whole number
    return estimates;
  };
}

/// Orders by turns of the hob that the samples resolve, and the means over groups keep to some extent.
int HobOrders(const SignalContext& c) {
  constexpr double kKept = 0.3;
  const int most = static_cast<int>(units::kPi / SampleSpacing_rad(c) / c.train.HobOrder());
  int last = 2;
  while (last < most && KeptByMean((last + 1) * c.hob_rad, c.groups) >= kKept) ++last;
  return last;
}

Common CommonOf(const Context& context, int largest_order) {
  Common common;
  common.context = context;
  const int last = std::max(largest_order, 3);
  common.ring_orders = OrdersOf(context, context->ring_rad, 1, last);
  common.table_orders = OrdersOf(context, context->table_rad, 1, last);
  common.hob_orders = OrdersOf(context, context->hob_rad, 1, HobOrders(*context));
  common.series = TimeSeriesOf(
      context->schedule, context->schedule.setup, context->channels,
      [context](const Eigen::MatrixXd& samples) { return context->groups.Mean(samples); },
      Grouped(context->schedule, context->groups).time_s);
  return common;
}

}  // namespace twinbench::diagnose::hob
