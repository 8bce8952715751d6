#include "twin/report/page/harmonics_of.h"

#include <cmath>
#include <complex>

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

FigureSeries AmplitudesOf(const FigureSeries& curve) {
  const int n = static_cast<int>(curve.y.size());
  separate::Fourier transform(n);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(curve.y.data(), n);
  const Eigen::VectorXcd lines = transform.Forward(values.cast<std::complex<double>>());
  FigureSeries bars{curve.name, curve.role, {}, {}, {}};
  for (int order = 1; order <= (n - 1) / 2; ++order) {
    bars.x.push_back(order);
    bars.y.push_back(2.0 * std::abs(lines[order]) / n);
  }
  return bars;
}

}  // namespace

std::optional<Figure> HarmonicsOf(const Figure& curve) {
  Figure figure{FigureForm::kBars, curve.title + ": harmonics", "amplitudes of the plotted points",
                {"order", ""},     {"amplitude", curve.y.unit}, {}, {}, curve.file.empty() ? "" : curve.file + ": harmonics"};
  for (const FigureSeries& series : curve.series) {
    if (GoesRoundInEqualSteps(series)) figure.series.push_back(AmplitudesOf(series));
  }
  return figure.series.empty() ? std::nullopt : std::optional(figure);
}

}  // namespace twinbench::report
