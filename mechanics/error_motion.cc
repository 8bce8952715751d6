#include "mechanics/error_motion.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace twinbench::mechanics {
namespace {

Eigen::Matrix<double, kErrorComponents, Eigen::Dynamic> Columns(const ErrorTable& table) {
  const auto n = static_cast<Eigen::Index>(table.angle_rad.size());
  Eigen::Matrix<double, kErrorComponents, Eigen::Dynamic> value(kErrorComponents, n);
  value.setZero();
  for (int c = 0; c < kErrorComponents; ++c) {
    const std::vector<double>& column = table.value[static_cast<std::size_t>(c)];
    if (column.empty()) continue;
    if (column.size() != table.angle_rad.size())
      throw std::invalid_argument("error table: a column has a wrong length");
    value.row(c) = Eigen::Map<const Eigen::RowVectorXd>(column.data(), n);
  }
  return value;
}

std::vector<Harmonic> Whirl(const HalfFrequencyMotion& half) {
  const double back = -0.5 * std::numbers::pi;  // cos(x - pi/2) = sin(x)
  std::vector<Harmonic> whirl;
  if (half.tilt_rad != 0.0) {
    whirl.push_back({0, half.order, half.tilt_rad, 0.0});
    whirl.push_back({1, half.order, half.tilt_rad, back});
  }
  if (half.radial_m != 0.0) {
    whirl.push_back({3, half.order, half.radial_m, 0.0});
    whirl.push_back({4, half.order, half.radial_m, back});
  }
  return whirl;
}

/// Draws one component: coefficients a/k and b/k of orders 1..K, scaled to `rms` (the mean square of
/// a cos + b sin over a turn is (a^2 + b^2)/2).
void AppendRandomComponent(int component, double rms, int orders, const std::function<double()>& normal,
                           std::vector<Harmonic>& out) {
  std::vector<std::complex<double>> phasor;
  double mean_square = 0.0;
  for (int k = 1; k <= orders; ++k) {
    const double a = normal() / k;
    const double b = normal() / k;
    phasor.emplace_back(a, b);
    mean_square += 0.5 * std::norm(phasor.back());
  }
  if (rms == 0.0 || mean_square == 0.0) return;
  const double scale = rms / std::sqrt(mean_square);
  for (int k = 1; k <= orders; ++k) {
    const std::complex<double> p = phasor[static_cast<std::size_t>(k - 1)];
    out.push_back({component, static_cast<double>(k), scale * std::abs(p), std::arg(p)});
  }
}

}  // namespace

ErrorMotion::ErrorMotion(const std::vector<Harmonic>& harmonics, const ErrorTable& table,
                         const HalfFrequencyMotion& half)
    : spline_(table.angle_rad, Columns(table)) {
  for (const Harmonic& harmonic : harmonics) Add(harmonic);
  for (const Harmonic& harmonic : Whirl(half)) Add(harmonic);
  std::sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.order < b.order; });
  double previous = 0.0;
  for (Line& line : lines_) {
    line.next = line.order == previous + 1.0;
    previous = line.order;
  }
}

void ErrorMotion::Add(const Harmonic& harmonic) {
  if (harmonic.component < 0 || harmonic.component >= kErrorComponents) {
    throw std::invalid_argument("harmonic: component must be 0 (ex) to 5 (dz)");
  }
  if (!std::isfinite(harmonic.order) || !std::isfinite(harmonic.amplitude) || !std::isfinite(harmonic.phase_rad)) {
    throw std::invalid_argument("harmonic: order, amplitude and phase must be finite");
  }
  const double order = std::abs(harmonic.order);
  const double phase_rad = harmonic.order < 0.0 ? -harmonic.phase_rad : harmonic.phase_rad;
  auto line = std::find_if(lines_.begin(), lines_.end(), [&](const Line& l) { return l.order == order; });
  if (line == lines_.end()) {
    Line fresh;
    fresh.order = order;
    line = lines_.insert(lines_.end(), fresh);
  }
  line->cosine[harmonic.component] += harmonic.amplitude * std::cos(phase_rad);
  line->sine[harmonic.component] -= harmonic.amplitude * std::sin(phase_rad);
}

ErrorMotion::Vector6 ErrorMotion::SumLines(double unwrapped_rad) const {
  Vector6 sum = Vector6::Zero();
  const double c1 = std::cos(unwrapped_rad);
  const double s1 = std::sin(unwrapped_rad);
  double c = 1.0;
  double s = 0.0;
  for (const Line& line : lines_) {
    if (line.next) {
      const double turned = c * c1 - s * s1;
      s = s * c1 + c * s1;
      c = turned;
    } else {
      c = std::cos(line.order * unwrapped_rad);
      s = std::sin(line.order * unwrapped_rad);
    }
    sum += c * line.cosine + s * line.sine;
  }
  return sum;
}

PoseError ErrorMotion::Evaluate(double unwrapped_rad) const {
  Vector6 sum = spline_.Evaluate(unwrapped_rad);
  if (!lines_.empty()) sum += SumLines(unwrapped_rad);
  return {sum[0], sum[1], sum[2], sum[3], sum[4], sum[5]};
}

std::vector<Harmonic> MakeRandomHarmonics(const std::array<double, kErrorComponents>& rms, int orders,
                                          const std::function<double()>& normal) {
  if (orders < 1) throw std::invalid_argument("random harmonics: at least one order");
  std::vector<Harmonic> harmonics;
  for (int c = 0; c < kErrorComponents; ++c) {
    AppendRandomComponent(c, rms[static_cast<std::size_t>(c)], orders, normal, harmonics);
  }
  return harmonics;
}

}  // namespace twinbench::mechanics
