#include "twin/benches/encoder_comparison/diagnosis/second_order.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/core/linear_algebra.h"
#include "twin/model/motion.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// A wave of the device's angle.
struct AngleWave {
  int order = 0;
  double size_rad = 0.0;
};

double SizeOf(const EffectSettings& effect, const char* parameter) {
  const auto found = effect.parameters.find(parameter);
  return found == effect.parameters.end() ? 0.0 : std::abs(found->second);
}

std::vector<AngleWave> WavesOf(const std::vector<EffectSettings>& effects, int periods) {
  std::vector<AngleWave> waves;
  for (const EffectSettings& e : effects) {
    if (e.name == "eccentricity") waves.push_back({1, SizeOf(e, "amplitude")});
    if (e.name == "ellipticity") waves.push_back({2, SizeOf(e, "amplitude")});
    if (e.name == "periodic")
      waves.push_back({static_cast<int>(std::lround(SizeOf(e, "order"))), SizeOf(e, "amplitude")});
    if (e.name == "signal_offset")
      waves.push_back({periods, std::hypot(SizeOf(e, "offset_sin"), SizeOf(e, "offset_cos")) / periods});
    if (e.name == "amplitude_mismatch") waves.push_back({2 * periods, 0.5 * SizeOf(e, "ratio") / periods});
    if (e.name == "quadrature_error") waves.push_back({2 * periods, 0.5 * SizeOf(e, "angle") / periods});
  }
  return waves;
}

/// By order, the size of half the slope of the square of their sum: E dE/dangle.
std::map<int, double> ProductsOf(const std::vector<AngleWave>& waves) {
  std::map<int, double> size_rad;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto& [a, b] = std::minmax(waves[i].order, waves[j].order);
      const double both = 0.5 * waves[i].size_rad * waves[j].size_rad * (i == j ? 0.5 : 1.0);
      size_rad[a + b] += both * (a + b);
      if (b > a) size_rad[b - a] += both * (b - a);
    }
  }
  return size_rad;
}

void Append(const Eigen::MatrixXd& columns, Eigen::MatrixXd& all) {
  const Eigen::Index had = all.cols();
  all.conservativeResize(columns.rows(), had + columns.cols());
  all.rightCols(columns.cols()) = columns.rowwise() - columns.colwise().mean();
}

}  // namespace

SecondOrder::SecondOrder(const std::vector<EffectSettings>& effects, const EncoderRun& encoder) {
  constexpr double kHardly = 0.1;  // of the noise of a reading
  const SignalContext& c = encoder.context;
  const double least_rad = kHardly * encoder.run.sigma.minCoeff();
  const int last = LargestOrder(c);
  for (const auto& [order, size_rad] : ProductsOf(WavesOf(effects, c.device.signal_periods))) {
    if (order >= 1 && order <= last && size_rad > least_rad)
      Append(size_rad * model::Wave(order * c.device_rad), columns_);
  }
  double delay_s = 0.0;
  for (const EffectSettings& e : effects) delay_s += e.name == "latency" ? SizeOf(e, "delay") + SizeOf(e, "time_constant") : 0.0;
  if (!(delay_s > 0.0) || !c.Moves()) return;
  Append(0.5 * delay_s * delay_s * model::RateOfChange(encoder.run.schedule, c.velocity_rad_s), columns_);
  speed_ = (c.velocity_rad_s.array() - c.velocity_rad_s.mean()).matrix().normalized();
  for (auto column : columns_.colwise()) column -= speed_ * speed_.dot(column);
}

/// About their mean, without what a latency takes.
Eigen::VectorXd SecondOrder::Own(const Eigen::VectorXd& rows) const {
  const Eigen::VectorXd own = rows.array() - rows.mean();
  return speed_.size() > 0 ? Eigen::VectorXd(own - speed_ * speed_.dot(own)) : own;
}

bool SecondOrder::MayBe(const Eigen::VectorXd& rows) const {
  constexpr double kLike = 0.6, kLargest = 1.5;  // share of its power; of what is expected
  if (IsNothing()) return false;
  const Eigen::VectorXd own = Own(rows), sizes = SolveShortest(columns_, own);
  return (own - columns_ * sizes).squaredNorm() < (1.0 - kLike) * own.squaredNorm() &&
         sizes.cwiseAbs().maxCoeff() < kLargest;
}

Eigen::VectorXd SecondOrder::Beside(const Eigen::VectorXd& rows) const {
  if (IsNothing()) return rows;
  return rows - columns_ * SolveShortest(columns_, Own(rows));
}

}  // namespace twinbench::diagnose::encoder
