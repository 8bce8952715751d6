#include "twin/report/page/curves.h"

#include <cmath>
#include <complex>
#include <utility>

#include "twin/core/reading.h"
#include "twin/separate/fourier.h"

namespace twinbench::report {
namespace {

constexpr int kLeastSteps = 8;

bool GoesRoundInEqualSteps(const FigureSeries& series) {
  const std::size_t n = series.x.size();
  if (n < kLeastSteps) return false;
  const double step_deg = 360.0 / static_cast<double>(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double expected_deg = series.x[0] + static_cast<double>(k) * step_deg;
    if (!std::isfinite(series.y[k]) || !(std::abs(series.x[k] - expected_deg) < 1e-3 * step_deg)) return false;
  }
  return true;
}

/// Of the amplitude of any order, where the points are independent.
double OfIndependent(const std::vector<double>& u) {
  double squares = 0.0;
  for (const double one : u) squares += one * one;
  return std::sqrt(2.0 * squares) / static_cast<double>(u.size());
}

FigureSeries AmplitudesOf(const FigureSeries& curve) {
  const int n = static_cast<int>(curve.y.size());
  separate::Fourier transform(n);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(curve.y.data(), n);
  const Eigen::VectorXcd lines = transform.Forward(values.cast<std::complex<double>>());
  FigureSeries bars{curve.name, curve.role, {}, {}, {}};
  for (int order = 1; order <= (n - 1) / 2; ++order) {
    bars.x.push_back(order);
    bars.y.push_back(2.0 * std::abs(lines[order]) / n);
    const auto k = static_cast<std::size_t>(order) - 1;
    if (!curve.u_order.empty()) bars.u.push_back(k < curve.u_order.size() ? curve.u_order[k] : kNaN);
    else if (!curve.u.empty()) bars.u.push_back(OfIndependent(curve.u));
  }
  return bars;
}

}  // namespace

void AddNoiseLimit(Figure& spectrum) {
  const double in_u = std::sqrt(-2.0 * std::log(0.05));  // 95th percentile of Rayleigh's distribution
  FigureSeries limit{"95 % of noise", SeriesRole::kExpected, {}, {}, {}};
  for (const FigureSeries& series : spectrum.series) {
    if (series.u.empty()) continue;
    if (limit.x.empty()) limit.x = series.x, limit.y.assign(series.x.size(), kNaN);
    for (std::size_t k = 0; k < series.u.size() && k < limit.y.size(); ++k) limit.y[k] = std::fmax(limit.y[k], in_u * series.u[k]);
  }
  if (!limit.x.empty()) spectrum.series.push_back(std::move(limit));
}

std::optional<Figure> HarmonicsOf(const Figure& curve) {
  Figure figure{FigureForm::kBars, curve.title + ": amplitude spectrum", "of the plotted points",
                {"order", ""},     {"amplitude", curve.y.unit}, {}, {}, curve.file.empty() ? "" : curve.file + ": spectrum"};
  for (const FigureSeries& series : curve.series) {
    if (GoesRoundInEqualSteps(series)) figure.series.push_back(AmplitudesOf(series));
  }
  AddNoiseLimit(figure);
  return figure.series.empty() ? std::nullopt : std::optional(figure);
}

}  // namespace twinbench::report
