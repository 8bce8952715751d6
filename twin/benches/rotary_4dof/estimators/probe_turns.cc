#include "twin/benches/rotary_4dof/estimators/probe_turns.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/distributions.h"
#include "twin/core/units.h"

namespace twinbench::separate::rotary {
namespace {

constexpr double kAtTheAngle = 0.02;  // of a step: no interpolation is needed
constexpr int kFewestAngles = 8;
constexpr double kWidestGap = 3.0;  // in steps: a turn with a wider one is none

/// Readings of a pass by ascending angle, unwrapped.
struct Course {
  std::vector<double> angle_rad;
  std::vector<const Reading*> reading;
};

Course CourseOfPass(const std::vector<const Reading*>& pass) {
  Course course;
  for (const Reading* r : pass) {
    const double before = course.angle_rad.empty() ? r->target_rad : course.angle_rad.back();
    course.angle_rad.push_back(before + std::remainder(r->target_rad - before, units::turn));
    course.reading.push_back(r);
  }
  if (course.angle_rad.back() < course.angle_rad.front()) {
    std::ranges::reverse(course.angle_rad);
    std::ranges::reverse(course.reading);
  }
  return course;
}

double UsualStep_rad(const std::vector<Course>& courses) {
  std::vector<double> steps;
  for (const Course& c : courses) {
    for (std::size_t i = 1; i < c.angle_rad.size(); ++i)
      steps.push_back(std::abs(c.angle_rad[i] - c.angle_rad[i - 1]));
  }
  return steps.empty() ? units::turn : Median(std::move(steps));
}

/// Value of a column at an angle, between the readings on both sides; NaN beyond them, and across a gap.
double ValueAt(const Course& course, const Quantity& column, double angle_rad, double step_rad, bool& is_between) {
  const auto above = std::ranges::lower_bound(course.angle_rad, angle_rad - kAtTheAngle * step_rad);
  if (above == course.angle_rad.end()) return kNaN;
  const auto next = static_cast<std::size_t>(above - course.angle_rad.begin());
  if (std::abs(*above - angle_rad) <= kAtTheAngle * step_rad) return column(*course.reading[next]);
  if (next == 0) return kNaN;
  const double before_rad = course.angle_rad[next - 1];
  if (*above - before_rad > kWidestGap * step_rad) return kNaN;
  is_between = true;
  const double part = (angle_rad - before_rad) / (*above - before_rad);
  return (1.0 - part) * column(*course.reading[next - 1]) + part * column(*course.reading[next]);
}

/// Takes the whole turns of one pass.
class Taker {
 public:
  Taker(ProbeTurns& turns, const std::vector<Quantity>& columns, double step_rad)
      : turns_(turns), columns_(columns), step_rad_(step_rad) {}

  void Take(const Course& course) {
    const auto n = turns_.angle_rad.size();
    const double first_rad = course.angle_rad.front();
    const double begin = std::ceil((first_rad - turns_.angle_rad[0]) / step_rad_ - kAtTheAngle);
    for (double from = begin; turns_.angle_rad[0] + (from + static_cast<double>(n) - 1.0) * step_rad_ <=
                              course.angle_rad.back() + kAtTheAngle * step_rad_;
         from += static_cast<double>(n))
      TakeTurn(course, static_cast<long>(from));
  }

 private:
  void TakeTurn(const Course& course, long from) {
    const Eigen::Index n = turns_.angle_rad.size();
    bool is_taken = false;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      Eigen::RowVectorXd turn(n);
      bool is_between = false;
      for (Eigen::Index k = 0; k < n; ++k) {
        const long at = from + k;
        turn[((at % n) + n) % n] = ValueAt(
            course, columns_[c], turns_.angle_rad[0] + static_cast<double>(at) * step_rad_, step_rad_, is_between);
      }
      if (!turn.allFinite()) continue;
      is_taken = true;
      turns_.is_interpolated |= is_between;
      Eigen::MatrixXd& shown = turns_.shown[c];
      shown.conservativeResize(shown.rows() + 1, n);
      shown.bottomRows(1) = turn;
    }
    if (!is_taken) ++turns_.incomplete;
  }

  ProbeTurns& turns_;
  const std::vector<Quantity>& columns_;
  double step_rad_;
};

}  // namespace

int ProbeTurns::Turns() const {
  Eigen::Index most = 0;
  for (const Eigen::MatrixXd& column : shown) most = std::max(most, column.rows());
  return static_cast<int>(most);
}

std::vector<ProbeTurns> TurnsOf(const std::vector<Reading>& readings, const std::vector<Quantity>& columns) {
  std::map<int, std::map<int, std::vector<const Reading*>>> passes;
  for (const Reading& r : readings) {
    if (r.status == ReadingStatus::kOk && std::isfinite(r.target_rad)) passes[r.setup][r.pass].push_back(&r);
  }
  std::vector<ProbeTurns> all;
  for (const auto& [setup, of_setup] : passes) {
    std::vector<Course> courses;
    for (const auto& [pass, rows] : of_setup) courses.push_back(CourseOfPass(rows));
    const auto n = static_cast<Eigen::Index>(std::lround(units::turn / UsualStep_rad(courses)));
    if (n < kFewestAngles) continue;
    const double step_rad = units::turn / static_cast<double>(n);
    ProbeTurns turns;
    turns.setup = setup;
    const double first_rad = courses.front().angle_rad.front();
    turns.angle_rad = Eigen::VectorXd::LinSpaced(n, 0.0, units::turn - step_rad).array() +
                      std::fmod(std::fmod(first_rad, step_rad) + step_rad, step_rad);
    turns.shown.resize(columns.size());
    for (const Course& course : courses) Taker(turns, columns, step_rad).Take(course);
    if (turns.Turns() > 0) all.push_back(std::move(turns));
  }
  return all;
}

}  // namespace twinbench::separate::rotary
