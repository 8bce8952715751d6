#include "twin/diagnose/screen/textbook.h"

#include <cmath>

namespace twinbench::diagnose::screen {
namespace {

constexpr double kNothing = 1e-300;  // keeps logarithms and quotients of nothing finite

}  // namespace

double RunsScore(const Eigen::VectorXd& series) {
  const auto n = static_cast<double>(series.size());
  const auto is_above = (series.array() > 0.0).eval();
  const auto above = static_cast<double>(is_above.count()), pairs = 2.0 * above * (n - above);
  double runs = 1.0;
  for (Eigen::Index i = 1; i < series.size(); ++i) runs += is_above[i] != is_above[i - 1];
  const double variance = pairs * (pairs - n) / (n * n * (n - 1.0));
  return variance > 0.0 ? (runs - 1.0 - pairs / n) / std::sqrt(variance) : 0.0;
}

Eigen::VectorXd Autocorrelation(const Eigen::VectorXd& series, int lags) {
  const double squares = std::max(series.squaredNorm(), kNothing);
  return Eigen::VectorXd::NullaryExpr(lags, [&](Eigen::Index k) {
    const Eigen::Index pairs = series.size() - k - 1;
    return series.head(pairs).dot(series.tail(pairs)) / squares;
  });
}

double LjungBox(const Eigen::VectorXd& autocorrelation, Eigen::Index readings) {
  const auto n = static_cast<double>(readings);
  const Eigen::Index lags = autocorrelation.size();
  const Eigen::ArrayXd pairs = n - Eigen::ArrayXd::LinSpaced(lags, 1.0, static_cast<double>(lags));
  return n * (n + 2.0) * (autocorrelation.array().square() / pairs).sum();
}

LombScargle::LombScargle(const Eigen::VectorXd& at, double step, int count) : sums_(at, step, step, count) {
  const Eigen::ArrayXcd twice =
      model::WaveSums(at, 2.0 * step, 2.0 * step, count).Of(Eigen::VectorXd::Ones(at.size())).col(0).array();
  const double half = 0.5 * static_cast<double>(at.size());
  const auto inverse = [half](double squares) { return squares > 1e-9 * half ? 1.0 / squares : 0.0; };
  turn_ = twice.unaryExpr([](const std::complex<double>& sum) { return std::polar(1.0, -0.5 * std::arg(sum)); });
  per_cosine_ = (half + 0.5 * twice.abs()).unaryExpr(inverse);
  per_sine_ = (half - 0.5 * twice.abs()).unaryExpr(inverse);
}

Eigen::MatrixXd LombScargle::Of(const Eigen::MatrixXd& series) const {
  const Eigen::MatrixXcd sums = sums_.Of(series);
  Eigen::MatrixXd power(sums.rows(), sums.cols());
  for (Eigen::Index j = 0; j < sums.cols(); ++j) {
    const Eigen::ArrayXcd turned = sums.col(j).array() * turn_;
    const double mean_square = std::max(series.col(j).squaredNorm() / static_cast<double>(series.rows()), kNothing);
    power.col(j) =
        (turned.real().square() * per_cosine_ + turned.imag().square() * per_sine_) / (2.0 * mean_square);
  }
  return power;
}

Shape ShapeOf(const Eigen::VectorXd& values) {
  const Eigen::ArrayXd from_mean = values.array() - values.mean(), square = from_mean.square();
  const double variance = square.mean();
  if (!(variance > 0.0)) return {};
  return {(square * from_mean).mean() / std::pow(variance, 1.5), square.square().mean() / (variance * variance)};
}

double JarqueBera(const Shape& shape, Eigen::Index readings) {
  const double excess = shape.kurtosis - 3.0;
  return static_cast<double>(readings) / 6.0 * (shape.skewness * shape.skewness + 0.25 * excess * excess);
}

double Bartlett(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& dof) {
  const double all = dof.sum(), pooled = std::max(squares.sum() / all, kNothing);
  const double spread = all * std::log(pooled) - (dof * (squares / dof).max(kNothing).log()).sum();
  const double groups = static_cast<double>(dof.size());
  return spread / (1.0 + (dof.inverse().sum() - 1.0 / all) / (3.0 * (groups - 1.0)));
}

double NormalScore(double chi2, double dof) {
  const double variance = 2.0 / (9.0 * dof);
  return (std::cbrt(chi2 / dof) - 1.0 + variance) / std::sqrt(variance);
}

}  // namespace twinbench::diagnose::screen
