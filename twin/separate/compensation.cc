#include "twin/separate/compensation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr int kFewestPoints = 8;
constexpr int kPointsOfADegree = 360;  // entries come at fractions of a degree that people can read
constexpr int kPointsAPeriod = 22;     // straight lines leave 0.75 % of a wave of so many entries
constexpr double kMostLeft = 0.5;      // of a wave, by the table's straight lines

int PointsFor(const LineFit& fit) {
  int highest = 1;
  for (const IndexLine& line : fit.lines) {
    if (line.is_certain) highest = std::max(highest, line.order);
  }
  const int degrees = (kPointsAPeriod * highest + kPointsOfADegree - 1) / kPointsOfADegree;
  return degrees * kPointsOfADegree;
}

LineFate FateOf(const IndexLine& line, int points) {
  if (!line.is_certain) return LineFate::kAliased;
  if (line.changes) return LineFate::kChanging;
  return LeftByInterpolation(line.order, points) > kMostLeft ? LineFate::kTooFine : LineFate::kCompensated;
}

double ErrorAt(const std::vector<CompensatedLine>& lines, double angle_rad) {
  double sum_rad = 0.0;
  for (const auto& [line, fate] : lines) {
    if (fate == LineFate::kCompensated) sum_rad += line.At(angle_rad);
  }
  return sum_rad;
}

CompensationTable TableOf(const std::vector<CompensatedLine>& lines, int points,
                          const std::optional<CompensationTable>& commanded) {
  CompensationTable table;
  for (int i = 0; i < points; ++i) {
    const double angle_rad = i * (2.0 * units::kPi / points);
    const double before_rad = commanded ? commanded->At(angle_rad) : 0.0;
    table.position_rad.push_back(angle_rad);
    table.correction_rad.push_back(before_rad - ErrorAt(lines, angle_rad));
  }
  return table;
}

/// The table as if no line had been found.
CompensationTable Unchanged(const IndexErrors& errors) {
  return errors.commanded ? *errors.commanded : CompensationTable{{0.0, units::kPi}, {0.0, 0.0}};
}

/// What the values would have been with another table at work.
Eigen::VectorXd WithTable(const IndexErrors& errors, const CompensationTable& table) {
  Eigen::VectorXd rest_rad = errors.value_rad;
  for (Eigen::Index i = 0; i < rest_rad.size(); ++i) {
    const double angle_rad = errors.position_rad[static_cast<std::size_t>(i)];
    rest_rad[i] += table.At(angle_rad);
    if (errors.commanded) rest_rad[i] -= errors.commanded->At(angle_rad);
  }
  return rest_rad;
}

/// Diagonal of the matrix that takes the values to what constants and compensated lines make of them.
Eigen::VectorXd Leverage(const IndexErrors& errors, const Compensation& compensation) {
  const Eigen::MatrixXd constants = GroupColumns(errors);
  const std::size_t width = static_cast<std::size_t>(constants.cols()) + 2 * compensation.lines.size();
  Eigen::MatrixXd design(errors.Count(), static_cast<Eigen::Index>(width));
  Eigen::MatrixXd used = Eigen::MatrixXd::Zero(design.rows(), design.cols());
  design.leftCols(constants.cols()) = used.leftCols(constants.cols()) = constants;
  Eigen::Index c = constants.cols();
  for (const auto& [line, fate] : compensation.lines) {
    design.middleCols(c, 2) = ColumnsOf(errors, line.order);
    if (fate == LineFate::kCompensated) used.middleCols(c, 2) = design.middleCols(c, 2);
    c += 2;
  }
  const Eigen::VectorXd root = WeightRootsOf(errors);
  constexpr double kSingular = 1e-9;
  const Eigen::MatrixXd to_unknowns =
      SolveRanked(root.asDiagonal() * design, Eigen::MatrixXd(root.asDiagonal()), kSingular).x;
  return (used.array() * to_unknowns.transpose().array()).rowwise().sum();
}

/// Expected square of the same measurement again, place by place, about the mean.
Eigen::VectorXd PredictedSquares_rad2(const IndexErrors& errors, const Compensation& compensation) {
  const Eigen::VectorXd left_rad = WithTable(errors, compensation.table);
  const Eigen::VectorXd leverage = Leverage(errors, compensation);
  Eigen::VectorXd squares_rad2 = AboutGroups(errors, left_rad).array().square();
  for (Eigen::Index i = 0; i < left_rad.size(); ++i)
    squares_rad2[i] += 2.0 * leverage[i] * errors.NoiseVariance_rad2(static_cast<std::size_t>(i));
  squares_rad2.array() += 2.0 * errors.u_between_rad * errors.u_between_rad;  // of both measurements
  return squares_rad2;
}

/// One standard deviation of a root mean square of so many values.
double U_rad(double rms_rad, Eigen::Index count) {
  return rms_rad / std::sqrt(2.0 * static_cast<double>(count));
}

RemainingError RemainingOf(const IndexErrors& errors, const Compensation& compensation) {
  RemainingError remaining;
  remaining.before_rms_rad = RootMeanSquare(AboutGroups(errors, errors.value_rad));
  remaining.predicted_rms_rad = std::sqrt(PredictedSquares_rad2(errors, compensation).mean());
  remaining.u_predicted_rms_rad = U_rad(remaining.predicted_rms_rad, errors.Count());
  double refused_rad2 = 0.0, noise_rad2 = 0.0;
  for (const auto& [line, fate] : compensation.lines) {
    if (fate != LineFate::kCompensated) refused_rad2 += 0.5 * std::pow(line.Amplitude_rad(), 2);
  }
  for (std::size_t i = 0; i < errors.count.size(); ++i) noise_rad2 += errors.NoiseVariance_rad2(i);
  remaining.refused_rms_rad = std::sqrt(refused_rad2);
  if (std::isfinite(errors.u_reading_rad))
    remaining.noise_rms_rad = std::sqrt(noise_rad2 / static_cast<double>(errors.Count()));
  return remaining;
}

/// But for the last bit, which not every decimal number of a file brings back.
bool IsSame(const CompensationTable& a, const std::optional<CompensationTable>& b) {
  const auto near = [](double x_rad, double y_rad) { return std::abs(x_rad - y_rad) < 1e-12; };
  return b && std::ranges::equal(a.position_rad, b->position_rad, near) &&
         std::ranges::equal(a.correction_rad, b->correction_rad, near);
}

/// Index of the place at this angle; -1 if it was not read.
int PlaceOf(const IndexErrors& errors, double angle_rad) {
  constexpr double kSame_rad = 1e-6;
  for (std::size_t i = 0; i < errors.position_rad.size(); ++i) {
    if (std::abs(errors.position_rad[i] - angle_rad) < kSame_rad) return static_cast<int>(i);
  }
  return -1;
}

/// Mean of squares that belong to the places of the first measurement, over the places of another one.
/// Their noise is exchanged for that of the other's number of readings.
double MeanAtPlaces_rad2(const IndexErrors& first, const Eigen::VectorXd& squares_rad2, const IndexErrors& again) {
  double sum_rad2 = 0.0;
  for (std::size_t i = 0; i < again.position_rad.size(); ++i) {
    const int place = PlaceOf(first, again.position_rad[i]);
    sum_rad2 += place < 0 ? squares_rad2.mean() : squares_rad2[place];
    if (place < 0 || !std::isfinite(first.u_reading_rad)) continue;
    sum_rad2 += first.u_reading_rad * first.u_reading_rad / again.count[i] -
                first.NoiseVariance_rad2(static_cast<std::size_t>(place));
  }
  return std::max(0.0, sum_rad2 / static_cast<double>(again.position_rad.size()));
}

}  // namespace

std::vector<int> Compensation::Orders(LineFate fate) const {
  std::vector<int> orders;
  for (const CompensatedLine& line : lines) {
    if (line.fate == fate) orders.push_back(line.line.order);
  }
  return orders;
}

Compensation Compensate(const IndexErrors& errors, const CompensationOptions& options) {
  if (options.points != 0 && options.points < kFewestPoints)
    throw InputError("points of the compensation", std::to_string(options.points),
                     "at least " + std::to_string(kFewestPoints) + ", or 0 for as many as are needed");
  Compensation compensation;
  compensation.fit = FindLines(errors, options.search);
  const int points = options.points > 0 ? options.points : PointsFor(compensation.fit);
  for (const IndexLine& line : compensation.fit.lines) compensation.lines.push_back({line, FateOf(line, points)});
  compensation.table = TableOf(compensation.lines, points, errors.commanded);
  compensation.remaining = RemainingOf(errors, compensation);
  if (compensation.remaining.predicted_rms_rad < compensation.remaining.before_rms_rad) return compensation;
  for (CompensatedLine& line : compensation.lines) {
    if (line.fate == LineFate::kCompensated) line.fate = LineFate::kNoGain;
  }
  compensation.table = Unchanged(errors);
  compensation.remaining = RemainingOf(errors, compensation);
  return compensation;
}

double LeftByInterpolation(int order, int points) {
  // Straight lines between samples of a wave: <f g> = sinc^2(u), <g^2> = (2 + cos 2 u) / 3 of <f^2>.
  const double u = units::kPi * order / points;
  const double sinc = u == 0.0 ? 1.0 : std::sin(u) / u;
  return std::sqrt(std::max(0.0, 1.0 - 2.0 * sinc * sinc + (2.0 + std::cos(2.0 * u)) / 3.0));
}

CompensationCheck CheckCompensation(const IndexErrors& first, const Compensation& compensation,
                                    const IndexErrors& again) {
  if (!IsSame(compensation.table, again.commanded))
    throw InputError("the check", "it was not measured with this compensation at work",
                     "a run whose scenario has the table that these readings give");
  CompensationCheck check;
  check.places = static_cast<int>(again.Count());
  const Eigen::VectorXd before_rad2 = AboutGroups(first, first.value_rad).array().square();
  check.before_rms_rad = std::sqrt(MeanAtPlaces_rad2(first, before_rad2, again));
  check.predicted_rms_rad = std::sqrt(MeanAtPlaces_rad2(first, PredictedSquares_rad2(first, compensation), again));
  check.remeasured_rms_rad = RootMeanSquare(AboutGroups(again, again.value_rad));
  check.u_ratio = check.Ratio() / std::sqrt(static_cast<double>(check.places));
  return check;
}

}  // namespace twinbench::separate
