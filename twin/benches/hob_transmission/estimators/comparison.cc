#include "twin/benches/hob_transmission/estimators/comparison.h"

#include <algorithm>
#include <cmath>

namespace twinbench::separate::hob {
namespace {

double UncertaintyAlong(const Eigen::Matrix2d& cov, Complex direction) {
  const Complex unit = direction / std::abs(direction);
  const Eigen::Vector2d u(unit.real(), unit.imag());
  return std::sqrt(u.dot(cov * u));
}

OrderComparison Compare(int order, const Coefficient& estimated, const Coefficient& reference) {
  OrderComparison c{.order = order, .estimated = estimated, .reference = reference};
  c.difference = {estimated.value - reference.value, estimated.cov + reference.cov};
  c.amplitude_difference_rad = Amplitude(estimated) - Amplitude(reference);
  c.u_amplitude_difference_rad = std::hypot(AmplitudeUncertainty(estimated), AmplitudeUncertainty(reference));
  c.phase_difference_rad = std::arg(estimated.value * std::conj(reference.value));
  c.u_phase_difference_rad = std::hypot(PhaseUncertainty(estimated), PhaseUncertainty(reference));
  c.normalised_error =
      std::abs(c.difference.value) / (2.0 * UncertaintyAlong(c.difference.cov, c.difference.value));
  return c;
}

/// Adds `series`, turned by -shift, as one of `count` equal parts of a mean.
void AddPart(const HarmonicSeries& series, double shift_rad, double count, HarmonicSeries& mean) {
  if (mean.orders.empty()) {
    mean.orders.assign(series.orders.size(), {0.0, Eigen::Matrix2d::Zero()});
    mean.dof = series.dof;
  }
  mean.dof = std::min(mean.dof, series.dof);
  mean.orders.resize(std::min(mean.orders.size(), series.orders.size()));
  for (int k = 1; k <= mean.Highest(); ++k) {
    const Coefficient turned = Shifted(series.At(k), k, shift_rad);
    mean.At(k).value += turned.value / count;
    mean.At(k).cov += turned.cov / (count * count);
  }
}

}  // namespace

std::vector<OrderComparison> CompareOrders(const HarmonicSeries& estimated, const HarmonicSeries& reference,
                                           const std::vector<int>& orders) {
  std::vector<OrderComparison> comparisons;
  const int highest = std::min(estimated.Highest(), reference.Highest());
  for (const int k : orders) {
    if (k < 1 || k > highest || !estimated.At(k).cov.allFinite() || !reference.At(k).cov.allFinite()) continue;
    comparisons.push_back(Compare(k, estimated.At(k), reference.At(k)));
  }
  return comparisons;
}

HarmonicSeries TransmissionByInterferometer(const std::vector<PositionError>& positions, int direction) {
  const auto counts = [direction](const PositionError& p) {
    return p.status == PositionStatus::kOk && p.direction == direction;
  };
  const auto count = static_cast<double>(std::count_if(positions.begin(), positions.end(), counts));
  HarmonicSeries mean;
  for (const PositionError& position : positions) {
    if (counts(position)) AddPart(position.series, 0.0, count, mean);
  }
  return mean;
}

HarmonicSeries EncoderByInterferometer(const std::vector<PositionError>& positions) {
  const auto counts = [](const PositionError& p) { return p.status == PositionStatus::kOk; };
  const auto count = static_cast<double>(std::count_if(positions.begin(), positions.end(), counts));
  HarmonicSeries mean;
  for (const PositionError& position : positions) {
    if (counts(position)) AddPart(position.series, -position.head_rad, count, mean);
  }
  return mean;
}

std::vector<OrderComparison> CompareTransmission(const HeadSeparation& separation, int direction,
                                                 const HarmonicSeries& interferometer,
                                                 const std::vector<int>& orders) {
  auto comparisons = CompareOrders(TransmissionSeries(separation, direction), interferometer, orders);
  for (OrderComparison& c : comparisons) c.status = separation.At(c.order).status;
  return comparisons;
}

std::vector<OrderComparison> CompareEncoder(const HeadSeparation& separation, const HarmonicSeries& interferometer,
                                            const std::vector<int>& orders) {
  return CompareOrders(EncoderSeries(separation), interferometer, orders);
}

}  // namespace twinbench::separate::hob
