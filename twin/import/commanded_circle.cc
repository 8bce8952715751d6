#include "twin/import/formula_functions.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/reading.h"
#include "twin/core/units.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

using SentTo = std::vector<Eigen::Vector2d>;

struct Circle {
  Eigen::Vector2d middle;
  double radius = 0.0;

  bool Has(const Eigen::Vector2d& place) const {
    constexpr double kOff = 1e-3;  // of the radius
    return std::abs((place - middle).norm() - radius) < kOff * radius;
  }
};

/// Where the axes were sent, without the rows at which they stayed; no more than are needed to find a circle.
SentTo PlacesSentTo(const std::vector<double>& x, const std::vector<double>& y) {
  constexpr std::size_t kMost = 2000;
  SentTo moved;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const Eigen::Vector2d place(x[i], y[i]);
    if (place.allFinite() && (moved.empty() || place != moved.back())) moved.push_back(place);
  }
  SentTo some;
  const std::size_t step = 1 + moved.size() / kMost;
  for (std::size_t i = 0; i < moved.size(); i += step) some.push_back(moved[i]);
  return some;
}

/// Least squares of x^2 + y^2 = 2 a x + 2 b y + c (Kasa 1976) about the first place.
Circle Through(const SentTo& places) {
  Eigen::MatrixX3d terms(std::ssize(places), 3);
  Eigen::VectorXd squares(terms.rows());
  for (Eigen::Index i = 0; i < terms.rows(); ++i) {
    const Eigen::Vector2d from_first = places[static_cast<std::size_t>(i)] - places.front();
    terms.row(i) << 2.0 * from_first.x(), 2.0 * from_first.y(), 1.0;
    squares[i] = from_first.squaredNorm();
  }
  const Eigen::Vector3d fit = SolveShortest(terms, squares);
  return {places.front() + fit.head<2>(), std::sqrt(std::max(0.0, fit[2] + fit.head<2>().squaredNorm()))};
}

SentTo On(const Circle& circle, const SentTo& places) {
  SentTo on;
  for (const Eigen::Vector2d& place : places)
    if (circle.Has(place)) on.push_back(place);
  return on;
}

/// Of circles through three rows, near each other and far apart, the one on which most lie.
std::optional<Circle> CircleOf(const SentTo& places) {
  constexpr std::size_t kBegins = 48;
  constexpr double kLeastShare = 0.3;
  SentTo best;
  for (const std::size_t part : {24, 12, 6, 3}) {
    const std::size_t apart = places.size() / part, step = 1 + places.size() / kBegins;
    for (std::size_t i = 0; apart > 0 && i + 2 * apart < places.size(); i += step) {
      SentTo on = On(Through({places[i], places[i + apart], places[i + 2 * apart]}), places);
      if (on.size() > best.size()) best = std::move(on);
    }
  }
  if (best.size() < 3 || static_cast<double>(best.size()) < kLeastShare * static_cast<double>(places.size())) return std::nullopt;
  return Through(best);
}

Circle CommandedCircle(const std::vector<double>& x, const std::vector<double>& y, const std::string& where) {
  const auto circle = CircleOf(PlacesSentTo(x, y));
  if (!circle) throw InputError(where, "the commanded places are on no circle", "a log of a circle, or --column 'radius_mm=...' of each row");
  return *circle;
}

/// What of the round the places go through [rad]: a line is a piece of a large circle.
double ArcOf(const Circle& circle, const SentTo& places) {
  std::vector<double> at_rad;
  for (const Eigen::Vector2d& place : places) at_rad.push_back(std::atan2(place.y() - circle.middle.y(), place.x() - circle.middle.x()));
  std::ranges::sort(at_rad);
  double widest_rad = units::turn - (at_rad.back() - at_rad.front());
  for (std::size_t i = 1; i < at_rad.size(); ++i) widest_rad = std::max(widest_rad, at_rad[i] - at_rad[i - 1]);
  return units::turn - widest_rad;
}

}  // namespace

double AwayFromCircle(const std::vector<double>& x, const std::vector<double>& y) {
  const SentTo places = PlacesSentTo(x, y);
  const auto circle = CircleOf(places);
  if (!circle) return kNaN;
  constexpr double kLeastArc = units::turn / 6.0;
  const SentTo on = On(*circle, places);
  if (on.empty() || ArcOf(*circle, on) < kLeastArc) return kNaN;
  std::vector<double> away;
  for (const Eigen::Vector2d& place : on) away.push_back(std::abs((place - circle->middle).norm() / circle->radius - 1.0));
  return MedianOf(std::move(away));
}

std::vector<double> CircleMiddle(const std::vector<double>& x, const std::vector<double>& y, const std::string& where) {
  return {CommandedCircle(x, y, where).middle.x()};
}

std::vector<double> CircleRadius(const std::vector<double>& x, const std::vector<double>& y, const std::string& where) {
  const double radius = CommandedCircle(x, y, where).radius, digit = std::pow(10.0, std::floor(std::log10(radius)) - 5.0);
  return {digit * std::round(radius / digit)};
}

}  // namespace twinbench::imports
