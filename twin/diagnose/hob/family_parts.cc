#include "twin/diagnose/hob/family_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/format.h"
#include "twin/core/units.h"
#include "twin/diagnose/encoder/wave_grid.h"

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
  const auto waves = std::make_shared<const encoder::WaveGrid>(angle_rad, first, 1.0, count);
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

std::vector<double> Onsets(const SignalContext& c) {
  constexpr std::size_t kMost = 1500;
  const std::vector<int>& readings = c.schedule.reading;
  const std::size_t every = 1 + readings.size() / kMost;
  std::vector<double> onsets;
  for (std::size_t i = every / 2 + 1; i < readings.size(); i += every) onsets.push_back(readings[i]);
  return onsets;
}

SharedBase StepsOf(const Context& context, const std::vector<double>& onsets) {
  return BaseOf(context, static_cast<int>(onsets.size()), [context, onsets](int g) {
    return Eigen::MatrixXd(StepSignal(*context, onsets[static_cast<std::size_t>(g)]));
  });
}

std::vector<double> ToneFrequencies_Hz(const SignalContext& c) {
  constexpr int kMost = 1500;
  constexpr double kSpacing = 0.7;  // of the resolution: a wave between two keeps four fifths
  const double longest_s = std::max(SinceMounting_s(c).maxCoeff(), 1e-6);
  const Schedule rows = Grouped(c.schedule, c.groups);
  std::vector<double> steps_s;
  for (int i = 1; i < rows.Readings(); ++i) steps_s.push_back(rows.time_s[i] - rows.time_s[i - 1]);
  std::nth_element(steps_s.begin(), steps_s.begin() + std::ssize(steps_s) / 2, steps_s.end());
  const double last_Hz = 0.5 / std::max(steps_s[steps_s.size() / 2], 1e-6), first_Hz = 3.0 / longest_s;
  const double step_Hz = std::max(kSpacing / longest_s, (last_Hz - first_Hz) / kMost);
  std::vector<double> frequencies_Hz;
  for (int k = 0; first_Hz + k * step_Hz < last_Hz; ++k) frequencies_Hz.push_back(first_Hz + k * step_Hz);
  return frequencies_Hz;
}

Eigen::MatrixXd InEachSetUp(const Eigen::MatrixXd& series, const Eigen::MatrixXd& setups) {
  Eigen::MatrixXd columns(series.rows(), series.cols() * setups.cols());
  for (Eigen::Index k = 0; k < setups.cols(); ++k)
    columns.middleCols(k * series.cols(), series.cols()) = series.array().colwise() * setups.col(k).array();
  return columns;
}

Eigen::MatrixXd Tone(const SignalContext& c, double frequency_Hz) {
  return InEachSetUp(Wave(2.0 * units::kPi * frequency_Hz * c.schedule.time_s), SetUps(c));
}

SharedBase TonesOf(const Context& context, const std::vector<double>& frequencies_Hz) {
  const int count = static_cast<int>(frequencies_Hz.size());
  const double step_Hz = count > 1 ? frequencies_Hz[1] - frequencies_Hz[0] : 1.0;
  const auto waves = std::make_shared<const encoder::WaveGrid>(2.0 * units::kPi * context->schedule.time_s,
                                                               frequencies_Hz[0], step_Hz, count);
  return BaseOf(context, count,
                [waves, setups = SetUps(*context)](int g) { return InEachSetUp(waves->At(g), setups); });
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
  common.frequencies_Hz = ToneFrequencies_Hz(*context);
  if (!common.frequencies_Hz.empty()) common.tones = TonesOf(context, common.frequencies_Hz);
  common.onsets = Onsets(*context);
  common.steps = StepsOf(context, common.onsets);
  return common;
}

}  // namespace twinbench::diagnose::hob
