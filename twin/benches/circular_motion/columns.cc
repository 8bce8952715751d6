#include "twin/benches/circular_motion/columns.h"

#include <cmath>
#include <map>

#include "twin/benches/circular_motion/format.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::benches::circular {
namespace {

constexpr double kMillimetreAMinute = units::mm / 60.0;

ReadingColumn Required(const Quantity& quantity, double to_SI) {
  return NumberColumn(quantity.column, to_SI, ColumnRole::kRequired, quantity);
}

/// A set-up has only some of these.
ReadingColumn Shown(const Quantity& quantity, double to_SI) {
  return NumberColumn(quantity.column, to_SI, ColumnRole::kShownToo, quantity);
}

bool SamePass(const Reading& a, const Reading& b) {
  return a.setup == b.setup && a.pass == b.pass;
}

}  // namespace

std::vector<ReadingColumn> Columns() {
  using units::mm, units::um, units::deg;
  const std::vector<ReadingColumn> own = {
      Required(kCommandedX_m, mm), Required(kCommandedY_m, mm), Required(kFeed_m_s, kMillimetreAMinute),
      Shown(kBar_m, um),           Shown(kEncoder_rad, deg),    Shown(kGridX_m, mm),
      Shown(kGridY_m, mm)};
  const ReadingColumn temperature = NumberColumn(
      "temperature_degC", 1.0, ColumnRole::kOptional, [](auto& r) -> auto& { return r.temperature_degC; });
  return Joined({CommonColumns(false), own, {temperature}});
}

void AboutItsCentre(std::vector<Reading>& readings) {
  constexpr double kOff = 1e-3, kRound = 1e-4;  // of the radius: files are written to less
  std::map<std::pair<int, int>, std::vector<Reading*>> circles;
  for (Reading& r : readings)
    if (std::isfinite(Radius_m(r))) circles[{r.setup, r.pass}].push_back(&r);
  for (const auto& [pass, circle] : circles) {
    Eigen::MatrixX3d plane(std::ssize(circle), 3);  // x^2 + y^2 = 2 a x + 2 b y + c of a circle about (a, b)
    Eigen::VectorXd squares(std::ssize(circle));
    for (Eigen::Index k = 0; k < squares.size(); ++k) {
      const Reading& r = *circle[static_cast<std::size_t>(k)];
      plane.row(k) << 2.0 * kCommandedX_m(r), 2.0 * kCommandedY_m(r), 1.0;
      squares[k] = std::pow(Radius_m(r), 2);
    }
    const std::optional<Eigen::Vector3d> solved = SolveThree(plane, squares);
    if (!solved) continue;
    const Eigen::Vector3d& found = *solved;
    const double radius2_m2 = found[2] + found.head<2>().squaredNorm();
    const bool is_round = ((plane * found - squares).array().abs() < 2.0 * kRound * radius2_m2).all();
    if (!is_round || found.head<2>().norm() < kOff * std::sqrt(radius2_m2)) continue;
    for (Reading* r : circle) {
      kCommandedX_m(*r) -= found[0], kCommandedY_m(*r) -= found[1];
      if (!IsOfBar(*r)) kGridX_m(*r) -= found[0], kGridY_m(*r) -= found[1];
    }
  }
}

Reading WithAngle(const Reading* before, Reading r) {
  r.target_rad = std::atan2(kCommandedY_m(r), kCommandedX_m(r));
  r.velocity_rad_s = r.direction * kFeed_m_s(r) / Radius_m(r);
  if (before && SamePass(*before, r))
    r.target_rad = before->target_rad + std::remainder(r.target_rad - before->target_rad, units::turn);
  return r;
}

std::vector<Reading> WithAngles(std::vector<Reading> readings) {
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i] = WithAngle(i == 0 ? nullptr : &readings[i - 1], std::move(readings[i]));
  return readings;
}

Deviation DeviationOf(const Reading& r) {
  if (IsOfBar(r)) return {kBar_m(r), Radius_m(r) * std::remainder(kEncoder_rad(r) - r.target_rad, units::turn)};
  const double dx_m = kGridX_m(r) - kCommandedX_m(r), dy_m = kGridY_m(r) - kCommandedY_m(r);
  const double c = std::cos(r.target_rad), s = std::sin(r.target_rad);
  return {c * dx_m + s * dy_m, -s * dx_m + c * dy_m};
}

double Radius_m(const Reading& r) {
  return std::hypot(kCommandedX_m(r), kCommandedY_m(r));
}

bool IsOfBar(const Reading& r) {
  return !std::isfinite(kGridX_m(r));
}

bool ShowsAngle(const Reading& r) {
  return !IsOfBar(r) || std::isfinite(kEncoder_rad(r));
}

std::vector<DesiredColumn> Desired() {
  return {{"encoder_deg", ShowsAngle,
           "only the radius is known there: servo_lag and what the encoder does cannot be named; beside readings with both they "
           "are left out"},
          {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "thermal_growth, drift and bar_expansion cannot be named"}};
}

std::string Addition(int /*setups*/) {
  return "the other direction, as in circular_procedure.directions = [1, -1], and a mounting of another radius";
}

}  // namespace twinbench::benches::circular
