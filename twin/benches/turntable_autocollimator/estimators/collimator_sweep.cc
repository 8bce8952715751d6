#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kByChance = 0.001;
constexpr double kSingularSweep = 1e-9;
constexpr double kOversampled = 5.0;  // frequencies that are tried by those that the sweep resolves
constexpr int kMostFrequencies = 6000;
constexpr int kMostTerms = 8;          // beyond the line
constexpr double kNothingLeft = 1e-9;  // of the readings' own size: rounding

/// The readings of one axis.
struct SweptReadings {
  Eigen::VectorXd reference_rad, shown_rad;
  std::vector<int> pass, direction;  // pass: numbered from 0

  Eigen::Index Count() const { return shown_rad.size(); }
};

SweptReadings AxisOf(const std::vector<Reading>& readings, double Reading::*shown) {
  std::vector<double> reference, values;
  std::map<std::pair<int, int>, int> passes;
  SweptReadings axis;
  for (const Reading& r : readings) {
    if (r.phase != Phase::kCalibration || !std::isfinite(r.*shown) || !std::isfinite(r.target_rad)) continue;
    reference.push_back(r.target_rad);
    values.push_back(r.*shown);
    axis.pass.push_back(passes.emplace(std::pair(r.setup, r.pass), std::ssize(passes)).first->second);
    axis.direction.push_back(r.direction);
  }
  axis.reference_rad = Eigen::Map<const Eigen::VectorXd>(reference.data(), std::ssize(reference));
  axis.shown_rad = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  return axis;
}

/// What the fit of an axis is made of, term by term.
class SweepFit {
 public:
  explicit SweepFit(const SweptReadings& axis) : axis_(axis) {
    const double low = axis.reference_rad.minCoeff(), high = axis.reference_rad.maxCoeff();
    middle_rad_ = 0.5 * (low + high);
    half_rad_ = 0.5 * (high - low);
    along_ = (axis.reference_rad.array() - middle_rad_) / half_rad_;
    const int passes = 1 + *std::ranges::max_element(axis.pass);
    columns_ = Eigen::MatrixXd::Zero(axis.Count(), passes + 1);
    for (Eigen::Index i = 0; i < axis.Count(); ++i) columns_(i, axis.pass[static_cast<std::size_t>(i)]) = 1.0;
    line_ = passes;
    columns_.col(line_) = along_;
    Refit();
  }

  /// Takes terms as long as chance does not explain what they take away.
  void Grow() {
    for (int k = 0; k < kMostTerms; ++k) {
      if (!(squares_ > std::pow(kNothingLeft * axis_.shown_rad.norm(), 2))) return;
      Term best;
      for (const int power : {2, 3}) {
        if (std::ranges::count(powers_, power) == 0)
          Consider({power, 0.0, LeftBeyond(along_.array().pow(power)), 2.0}, best);
      }
      Consider(BestWave(), best);
      if (!(ByChance(best) < kByChance)) return;
      Take(best);
    }
  }

  SweptAxis Result() const;

 private:
  /// Power of the angle, or a wave (power 0).
  struct Term {
    int power = 0;
    double per_half = 0.0;   // waves: radians of phase by half the sweep
    double left = INFINITY;  // sum of squares with it
    double tried = 1.0;
  };

  double Dof() const { return static_cast<double>(axis_.Count() - columns_.cols()); }

  /// (S'/S)^(dof'/2) is the F test's of two unknowns; one unknown is rarer, a frequency among many more likely.
  double ByChance(const Term& term) const {
    const double dof = Dof() - (term.power > 0 ? 1.0 : 3.0);
    return dof >= 2.0 && term.left < squares_ ? term.tried * std::exp(0.5 * dof * std::log(term.left / squares_))
                                              : 1.0;
  }
  void Consider(const Term& term, Term& best) const {
    if (ByChance(term) < ByChance(best)) best = term;
  }

  Eigen::MatrixXd Wave(double per_half) const {
    Eigen::MatrixXd wave(axis_.Count(), 2);
    wave.col(0) = (per_half * along_.array()).cos();
    wave.col(1) = (per_half * along_.array()).sin();
    return wave;
  }

  double LeftBeyond(const Eigen::MatrixXd& more) const {
    const Eigen::MatrixXd own = OrthonormalBasisOf(more - basis_ * (basis_.transpose() * more), kSingularSweep);
    return std::max(0.0, squares_ - (own.transpose() * residual_).squaredNorm());
  }

  /// From the steps of the reference as they usually are.
  double HighestPerHalf() const {
    std::vector<double> at(along_.begin(), along_.end()), steps;
    std::ranges::sort(at);
    for (std::size_t i = 1; i < at.size(); ++i) {
      if (at[i] - at[i - 1] > 1e-6) steps.push_back(at[i] - at[i - 1]);
    }
    return steps.empty() ? 0.0 : units::kPi / Median(steps);
  }

  Term BestWave() const {
    const double lowest = units::turn / 2.0 / 1.5, highest = 0.98 * HighestPerHalf();  // a sweep is 2 long
    const double resolved = std::max(1.0, (highest - lowest) / units::kPi);
    const int tried = static_cast<int>(std::min<double>(kMostFrequencies, kOversampled * resolved));
    const double step = (highest - lowest) / std::max(1, tried);
    Term best{0, 0.0, INFINITY, 2.0 * resolved};
    if (!(step > 0.0) || Dof() < 5.0) return best;
    const auto look = [&](double per_half) {
      const double left = LeftBeyond(Wave(per_half));
      if (left < best.left) best = {0, per_half, left, 2.0 * resolved};
    };
    for (int k = 0; k <= tried; ++k) look(lowest + k * step);
    for (double way = 0.5 * step; way > 1e-6 * step; way *= 0.5) {
      const double at = best.per_half;
      look(at - way);
      look(at + way);
    }
    return best;
  }

  void Take(const Term& term) {
    if (term.power > 0) {
      powers_.push_back(term.power);
      power_at_.push_back(columns_.cols());
      Append(along_.array().pow(term.power).matrix());
    } else {
      waves_.push_back(term.per_half);
      wave_at_.push_back(columns_.cols());
      Append(Wave(term.per_half));
    }
    Refit();
  }

  void Append(const Eigen::MatrixXd& more) {
    columns_.conservativeResize(Eigen::NoChange, columns_.cols() + more.cols());
    columns_.rightCols(more.cols()) = more;
  }

  void Refit() {
    basis_ = OrthonormalBasisOf(columns_, kSingularSweep);
    residual_ = axis_.shown_rad - basis_ * (basis_.transpose() * axis_.shown_rad);
    squares_ = residual_.squaredNorm();
  }

  /// With a column for the frequency of each wave, to first order.
  Eigen::MatrixXd Linearised(const Eigen::VectorXd& fitted) const {
    Eigen::MatrixXd all(axis_.Count(), columns_.cols() + std::ssize(waves_));
    all.leftCols(columns_.cols()) = columns_;
    for (std::size_t k = 0; k < waves_.size(); ++k) {
      const Eigen::MatrixXd wave = Wave(waves_[k]);
      const double a = fitted[wave_at_[k]], b = fitted[wave_at_[k] + 1];
      all.col(columns_.cols() + static_cast<Eigen::Index>(k)) =
          along_.array() * (b * wave.col(0) - a * wave.col(1)).array();
    }
    return all;
  }

  SweptValue Slope(const Eigen::VectorXd& of, const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov) const {
    return {of.dot(fitted) / half_rad_,
            std::sqrt(of.dot(cov.topLeftCorner(of.size(), of.size()) * of)) / half_rad_};
  }

  /// What of each coefficient goes into the slope of the line of least squares.
  Eigen::VectorXd IntoLine() const {
    Eigen::VectorXd into = Eigen::VectorXd::Zero(columns_.cols());
    into[line_] = 1.0;
    const Eigen::MatrixXd line = columns_.leftCols(line_ + 1);
    for (const Eigen::Index at : power_at_) into[at] = SolveLeastSquares(line, columns_.col(at))(line_, 0);
    return into;
  }

  void AddBend(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const;
  void AddRipples(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const;
  void AddReversal(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const;

  const SweptReadings& axis_;
  double middle_rad_ = 0.0, half_rad_ = 1.0;
  Eigen::VectorXd along_;  // the reference, from -1 to 1
  Eigen::Index line_ = 0;
  std::vector<int> powers_;
  std::vector<double> waves_;
  std::vector<Eigen::Index> power_at_, wave_at_;  // columns
  Eigen::MatrixXd columns_, basis_;
  Eigen::VectorXd residual_;
  double squares_ = 0.0;
};

void SweepFit::AddBend(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const {
  if (powers_.empty()) return;
  Eigen::VectorXd in_middle = Eigen::VectorXd::Zero(columns_.cols());
  in_middle[line_] = 1.0;
  result.scale_in_middle = Slope(in_middle, fitted, cov);
  const Eigen::MatrixXd line = columns_.leftCols(line_ + 1);
  Eigen::MatrixXd beyond = Eigen::MatrixXd::Zero(columns_.rows(), columns_.cols());
  for (const Eigen::Index at : power_at_)
    beyond.col(at) = columns_.col(at) - line * SolveLeastSquares(line, columns_.col(at));
  const Eigen::VectorXd bend = beyond * fitted;
  Eigen::Index farthest = 0;
  bend.cwiseAbs().maxCoeff(&farthest);
  const Eigen::VectorXd row = beyond.row(farthest);
  result.bend_rad = {std::abs(bend[farthest]), std::sqrt(row.dot(cov.topLeftCorner(row.size(), row.size()) * row))};
}

void SweepFit::AddRipples(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const {
  for (std::size_t k = 0; k < waves_.size(); ++k) {
    const Eigen::Vector2d size = fitted.segment<2>(wave_at_[k]);
    const double amplitude = size.norm();
    const Eigen::Vector2d along = size / amplitude;
    const Eigen::Index frequency = columns_.cols() + static_cast<Eigen::Index>(k);
    const double period = units::turn / waves_[k] * half_rad_;
    result.ripples.push_back(
        {{period, period / waves_[k] * std::sqrt(cov(frequency, frequency))},
         {amplitude, std::sqrt(along.dot(cov.block<2, 2>(wave_at_[k], wave_at_[k]) * along))}});
  }
  std::ranges::sort(result.ripples, std::greater(), [](const SweptRipple& r) { return r.amplitude_rad.value; });
}

void SweepFit::AddReversal(const Eigen::VectorXd& fitted, const Eigen::MatrixXd& cov, SweptAxis& result) const {
  Eigen::VectorXd forward = Eigen::VectorXd::Zero(line_), backward = forward;
  for (std::size_t i = 0; i < axis_.pass.size(); ++i)
    (axis_.direction[i] < 0 ? backward : forward)[axis_.pass[i]] = 1.0;
  if (forward.sum() == 0.0 || backward.sum() == 0.0 || forward.dot(backward) > 0.0) return;
  const Eigen::VectorXd apart = forward / forward.sum() - backward / backward.sum();
  result.reversal_rad = {apart.dot(fitted.head(line_)),
                         std::sqrt(apart.dot(cov.topLeftCorner(line_, line_) * apart))};
}

SweptAxis SweepFit::Result() const {
  const Eigen::VectorXd fitted = SolveLeastSquares(columns_, axis_.shown_rad);
  SweptAxis result;
  result.dof = Dof() - static_cast<double>(waves_.size());
  result.residual_rms_rad = std::sqrt(squares_ / static_cast<double>(axis_.Count()));
  result.u_reading_rad = result.dof > kLeastDof ? std::sqrt(squares_ / result.dof) : kNaN;
  result.shortest_period_rad = units::turn / HighestPerHalf() * half_rad_;
  const Eigen::MatrixXd all = Linearised(fitted);
  const Eigen::MatrixXd cov = std::pow(result.u_reading_rad, 2) * GeneralInverseOf(all.transpose() * all);
  result.scale = Slope(IntoLine(), fitted, cov);
  AddBend(fitted, cov, result);
  AddRipples(fitted, cov, result);
  AddReversal(fitted, cov, result);
  return result;
}

std::optional<SweptAxis> AnalyseAxis(const SweptReadings& axis) {
  if (axis.Count() < kFewestSwept || !(axis.reference_rad.maxCoeff() > axis.reference_rad.minCoeff()))
    return std::nullopt;
  SweepFit fit(axis);
  fit.Grow();
  return fit.Result();
}

}  // namespace

int SweptAxis::Sense() const {
  constexpr double kSure = 5.0;  // standard uncertainties
  if (!(std::abs(scale.value) > kSure * scale.u)) return 0;
  return scale.value > 0.0 ? 1 : -1;
}

std::optional<CollimatorSweep> AnalyseSweep(const std::vector<Reading>& readings) {
  const SweptReadings x = AxisOf(readings, &Reading::autocollimator_yaw_rad),
                      y = AxisOf(readings, &Reading::autocollimator_tilt_rad);
  const std::optional<SweptAxis> of_x = AnalyseAxis(x), of_y = AnalyseAxis(y);
  if (!of_x && !of_y) return std::nullopt;
  CollimatorSweep sweep;
  sweep.is_along_y = of_y && (!of_x || std::abs(of_y->scale.value) > std::abs(of_x->scale.value));
  const SweptReadings& used = sweep.is_along_y ? y : x;
  sweep.axis = sweep.is_along_y ? *of_y : *of_x;
  sweep.readings = static_cast<int>(used.Count());
  sweep.lowest_rad = used.reference_rad.minCoeff();
  sweep.highest_rad = used.reference_rad.maxCoeff();
  const std::optional<SweptAxis>& other = sweep.is_along_y ? of_x : of_y;
  if (other && sweep.axis.Sense() != 0)
    sweep.crosstalk = {other->scale.value / sweep.axis.scale.value,
                       std::abs(other->scale.u / sweep.axis.scale.value)};
  return sweep;
}

}  // namespace twinbench::separate::turntable
