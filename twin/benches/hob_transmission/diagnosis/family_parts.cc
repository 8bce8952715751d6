#include "twin/benches/hob_transmission/diagnosis/family_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose::hob {
namespace {

/// Typical way of the table from one sample to the next.
double SampleSpacing_rad(const SignalContext& c) {
  std::vector<double> steps_rad;
  for (Eigen::Index i = 1; i < c.Samples(); ++i) steps_rad.push_back(std::abs(c.table_rad[i] - c.table_rad[i - 1]));
  return std::max(Median(std::move(steps_rad)), 1e-9);
}

/// Waves of the first whole orders of an angle.
SharedBase OrdersOf(const Context& context, const Eigen::VectorXd& angle_rad, int count) {
  const auto waves = std::make_shared<const model::WaveGrid>(angle_rad, 1.0, 1.0, count);
  auto base = std::make_shared<Base>();
  base->grid = count;
  base->channels = context->channels;
  base->series = [context, waves](int g) { return context->groups.Mean(waves->At(g)); };
  return base;
}

/// Orders by turns of the hob that the samples resolve, and the means over groups keep to some extent.
int HobOrders(const SignalContext& c) {
  constexpr double kKept = 0.3;
  const int most = static_cast<int>(units::kPi / SampleSpacing_rad(c) / c.train.HobOrder());
  int last = 2;
  while (last < most && KeptByMean((last + 1) * c.hob_rad, c.groups) >= kKept) ++last;
  return last;
}

}  // namespace

ToRows MeansOf(const Context& context) {
  return [context](const Eigen::MatrixXd& samples) { return context->groups.Mean(samples); };
}

Common CommonOf(const Context& context, int largest_order) {
  Common common;
  common.context = context;
  const int last = std::max(largest_order, 3);
  common.ring_orders = OrdersOf(context, context->ring_rad, last);
  common.table_orders = OrdersOf(context, context->table_rad, last);
  common.hob_orders = OrdersOf(context, context->hob_rad, HobOrders(*context));
  common.series = TimeSeriesOf(context->schedule, context->schedule.setup, context->channels, MeansOf(context),
                               Grouped(context->schedule, context->groups).time_s);
  return common;
}

}  // namespace twinbench::diagnose::hob
