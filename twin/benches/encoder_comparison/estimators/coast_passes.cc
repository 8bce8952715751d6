#include "twin/benches/encoder_comparison/estimators/coast_passes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "twin/core/linear_algebra.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

const Quantity kStamp{"stamp_s"};

bool IsStamp(const Reading& r) {
  return r.status == ReadingStatus::kOk && std::isfinite(kStamp(r)) && std::isfinite(r.reference_rad);
}

/// From the usual distance of two lines.
int LinesOfTurn(const std::vector<const Reading*>& stamps) {
  std::vector<double> steps_rad;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i]->pass == stamps[i - 1]->pass)
      steps_rad.push_back(std::abs(stamps[i]->reference_rad - stamps[i - 1]->reference_rad));
  }
  if (steps_rad.empty()) return 0;
  std::ranges::nth_element(steps_rad, steps_rad.begin() + std::ssize(steps_rad) / 2);
  const double step_rad = steps_rad[steps_rad.size() / 2];
  return step_rad > 0.0 ? static_cast<int>(std::lround(units::turn / step_rad)) : 0;
}

int PlaceOf(long line, int lines) {
  return static_cast<int>((line % lines + lines) % lines);
}

/// exp(-j 2 pi k / lines)
std::vector<std::complex<double>> Roots(int lines) {
  std::vector<std::complex<double>> roots;
  for (int k = 0; k < lines; ++k) roots.push_back(std::polar(1.0, -units::turn * k / lines));
  return roots;
}

/// Mean over the turns at each place of the ring, less its own mean.
Eigen::VectorXd Repeating(const CoastPass& pass, int lines, const Eigen::VectorXd& off_rad) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(lines), count = Eigen::VectorXd::Zero(lines);
  for (Eigen::Index i = 0; i < off_rad.size(); ++i) {
    const int place = PlaceOf(pass.line[static_cast<std::size_t>(i)], lines);
    sum[place] += off_rad[i];
    count[place] += 1.0;
  }
  const Eigen::VectorXd mean = sum.array() / count.array().max(1.0);
  return mean.array() - mean.mean();
}

/// Chebyshev's polynomials of the time from -1 to 1: rows x (degree + 1).
Eigen::MatrixXd TimeColumns(const CoastPass& pass, int degree) {
  const auto rows = std::ssize(pass.time_s);
  const double begin_s = pass.time_s.front(), length_s = pass.time_s.back() - begin_s;
  Eigen::MatrixXd columns(rows, degree + 1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double u = 2.0 * (pass.time_s[static_cast<std::size_t>(i)] - begin_s) / length_s - 1.0;
    columns(i, 0) = 1.0;
    columns(i, 1) = u;
    for (int d = 2; d <= degree; ++d) columns(i, d) = 2.0 * u * columns(i, d - 1) - columns(i, d - 2);
  }
  return columns;
}

Eigen::VectorXd LineAngles(const CoastPasses& coast, const CoastPass& pass) {
  Eigen::VectorXd angle_rad(std::ssize(pass.line));
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i)
    angle_rad[i] = static_cast<double>(pass.line[static_cast<std::size_t>(i)] - pass.line.front()) * coast.Step_rad();
  return angle_rad;
}

}  // namespace

double CoastPasses::Step_rad() const {
  return units::turn / lines;
}

CoastPasses SortCoast(const std::vector<Reading>& readings) {
  std::vector<const Reading*> stamps;
  for (const Reading& r : readings) {
    if (IsStamp(r)) stamps.push_back(&r);
  }
  CoastPasses coast;
  coast.left_out = static_cast<int>(readings.size() - stamps.size());
  coast.lines = LinesOfTurn(stamps);
  if (coast.lines == 0) return coast;
  coast.zero_rad = stamps.front()->reference_rad;
  std::map<int, CoastPass> by_pass;
  for (const Reading* r : stamps) {
    CoastPass& pass = by_pass[r->pass];
    pass.pass = r->pass;
    pass.direction = r->direction;
    pass.line.push_back(std::lround((r->reference_rad - coast.zero_rad) / coast.Step_rad()));
    pass.time_s.push_back(kStamp(*r));
  }
  for (auto& [number, pass] : by_pass) coast.passes.push_back(std::move(pass));
  return coast;
}

bool HaveStamps(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) { return std::isfinite(kStamp(r)); });
}

std::vector<CoastTurn> TurnsOf(const CoastPasses& coast, const CoastPass& pass, const Eigen::VectorXd& off_rad,
                               int highest) {
  const std::vector<std::complex<double>> roots = Roots(coast.lines);
  std::vector<CoastTurn> turns;
  const auto lines = static_cast<std::size_t>(coast.lines);
  for (std::size_t begin = 0; begin + lines < pass.line.size();) {
    // A line that is missing makes the turn begin anew behind it.
    const bool whole = std::abs(pass.line[begin + lines] - pass.line[begin]) == coast.lines &&
                       off_rad.segment(static_cast<Eigen::Index>(begin), coast.lines).allFinite();
    if (!whole) {
      ++begin;
      continue;
    }
    CoastTurn turn{pass.pass, pass.direction,
                   units::turn / (pass.time_s[begin + lines] - pass.time_s[begin]),
                   Eigen::VectorXcd::Zero(highest)};
    for (std::size_t i = begin; i < begin + lines; ++i) {
      const auto place = static_cast<std::size_t>(PlaceOf(pass.line[i], coast.lines));
      const double value_rad = 2.0 / coast.lines * off_rad[static_cast<Eigen::Index>(i)];
      for (std::size_t k = 1, at = place; k <= static_cast<std::size_t>(highest); ++k, at = (at + place) % lines)
        turn.order[static_cast<Eigen::Index>(k - 1)] += value_rad * roots[at];
    }
    // From the first line's place to the scale's zero.
    for (int k = 1; k <= highest; ++k) turn.order[k - 1] *= std::polar(1.0, -k * coast.zero_rad);
    turns.push_back(std::move(turn));
    begin += lines;
  }
  return turns;
}

Eigen::VectorXd OffSmoothCourse(const CoastPasses& coast, const CoastPass& pass, int degree) {
  const Eigen::MatrixXd columns = TimeColumns(pass, degree);
  const Eigen::MatrixXd normal = columns.transpose() * columns;
  const Eigen::VectorXd angle_rad = LineAngles(coast, pass);
  Eigen::VectorXd off_rad = angle_rad, repeating = Eigen::VectorXd::Zero(coast.lines);
  constexpr int kRounds = 6;  // each leaves of what repeats the part that a polynomial can follow: a hundredth
  Eigen::VectorXd course = Eigen::VectorXd::Zero(degree + 1);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::VectorXd left = off_rad;
    for (Eigen::Index i = 0; i < left.size(); ++i)
      left[i] -= repeating[PlaceOf(pass.line[static_cast<std::size_t>(i)], coast.lines)];
    course += SolveSymmetric(normal, Eigen::VectorXd(columns.transpose() * left));
    off_rad = angle_rad - columns * course;
    repeating = Repeating(pass, coast.lines, off_rad);
  }
  return off_rad;
}

Eigen::VectorXd OffClosedTurns(const CoastPasses& coast, const CoastPass& pass) {
  const auto lines = static_cast<std::size_t>(coast.lines);
  Eigen::VectorXd off_rad = Eigen::VectorXd::Constant(std::ssize(pass.line), kNaN);
  for (std::size_t begin = 0; begin + 2 * lines < pass.line.size(); begin += lines) {
    const long turn = pass.line[begin + lines] - pass.line[begin];
    if (std::abs(turn) != coast.lines || pass.line[begin + 2 * lines] - pass.line[begin] != 2 * turn) continue;
    // Newton's form: 0, 1 and 2 turns at the times 0, b and c.
    const double a = pass.time_s[begin], b = pass.time_s[begin + lines] - a, c = pass.time_s[begin + 2 * lines] - a;
    const double way_rad = static_cast<double>(turn) * coast.Step_rad();
    const double speed = way_rad / b, bend = (way_rad / (c - b) - speed) / c;
    for (std::size_t i = begin; i < begin + lines; ++i) {
      const double t = pass.time_s[i] - a;
      const double gone_rad = static_cast<double>(pass.line[i] - pass.line[begin]) * coast.Step_rad();
      off_rad[static_cast<Eigen::Index>(i)] = gone_rad - t * (speed + bend * (t - b));
    }
  }
  return off_rad;
}

std::vector<Reading> AsComparison(const std::vector<Reading>& readings, int places) {
  constexpr int kDegree = 6;
  const CoastPasses coast = SortCoast(readings);
  std::vector<Reading> compared;
  int setup = 0;
  for (const CoastPass& pass : coast.passes) {
    const Eigen::VectorXd mean_rad = Repeating(pass, coast.lines, OffSmoothCourse(coast, pass, kDegree));
    const int stride = std::max(1, coast.lines / places);
    for (int i = 0; i < coast.lines && i < static_cast<int>(pass.line.size()); i += stride) {
      const auto at = static_cast<std::size_t>(i);
      Reading r;
      r.reading = static_cast<int>(compared.size());
      r.time = Time(FromSeconds(pass.time_s[at]));
      r.setup = setup;
      r.pass = pass.pass;
      r.direction = pass.direction;
      r.position = i / stride;
      r.measured_rad = coast.zero_rad + static_cast<double>(pass.line[at]) * coast.Step_rad();
      r.reference_rad = r.measured_rad - mean_rad[PlaceOf(pass.line[at], coast.lines)];
      r.velocity_rad_s = pass.direction * units::turn * static_cast<double>(pass.line.size() - 1) /
                         (coast.lines * (pass.time_s.back() - pass.time_s.front()));
      compared.push_back(r);
    }
    ++setup;
  }
  return compared;
}

}  // namespace twinbench::separate::encoder
