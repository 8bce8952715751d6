#include "twin/import/formula_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/reading.h"
#include "twin/core/units.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr double kShaftTurn_deg = 360.0;

/// What errors of the first orders of both shafts, and a line, make of an angle of two that go together.
Eigen::RowVectorXd TermsOf(double a_rad, double b_rad) {
  constexpr int kOrders = 3;
  Eigen::RowVectorXd terms(2 + 4 * kOrders);
  terms.head<2>() << 1.0, b_rad;
  for (int k = 1; k <= kOrders; ++k)
    terms.segment<4>(4 * k - 2) << std::cos(k * a_rad), std::sin(k * a_rad), std::cos(k * b_rad), std::sin(k * b_rad);
  return terms;
}

/// How far a goes with b, by least squares beside the errors of the first orders, and how much of its way it goes otherwise.
struct Proportion {
  double ratio = kNaN, loose = kNaN;
  bool has_turns = false;  // enough to tell an order from a line
};

/// Angles of two shafts from their first row on [rad], where both are known.
struct TwoShafts {
  Eigen::VectorXd a_rad, b_rad;
};

TwoShafts ShaftsOf(const std::vector<double>& wrapped_a, const std::vector<double>& wrapped_b) {
  const std::vector<double> a = Unwrapped(wrapped_a, ""), b = Unwrapped(wrapped_b, "");
  std::vector<double> a_rad, b_rad;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (!std::isfinite(a[i] + b[i])) continue;
    a_rad.push_back(a[i] * units::deg);
    b_rad.push_back(b[i] * units::deg);
  }
  const auto from_first = [](const std::vector<double>& x) -> Eigen::VectorXd {
    const auto all = Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
    return x.empty() ? Eigen::VectorXd() : Eigen::VectorXd(all.array() - x.front());
  };
  return {from_first(a_rad), from_first(b_rad)};
}

bool HasTurns(const TwoShafts& shafts) {
  constexpr double kTurnsToTell = 1.5;  // of the slower one; fewer do not tell an order from a line
  return shafts.a_rad.cwiseAbs().cwiseMin(shafts.b_rad.cwiseAbs()).maxCoeff() > kTurnsToTell * units::turn;
}

double SlopeOf(const TwoShafts& shafts) {
  const auto& [a_rad, b_rad] = shafts;
  const Eigen::Index terms = TermsOf(0.0, 0.0).size();
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd products = Eigen::VectorXd::Zero(terms);
  for (Eigen::Index i = 0; i < a_rad.size(); ++i) {
    const Eigen::RowVectorXd row = TermsOf(a_rad[i], b_rad[i]);
    squares += row.transpose() * row;
    products += row.transpose() * a_rad[i];
  }
  const Eigen::Index used = HasTurns(shafts) ? terms : 2;
  return SolveSymmetric(squares.topLeftCorner(used, used), Eigen::VectorXd(products.head(used)))[1];
}

/// A jump from one row to the next that hardly any others have - a tooth that slipped, a reversal - tells nothing of a
/// ratio.
void TakeJumpsOut(TwoShafts& shafts, double slope) {
  constexpr double kOfUsual = 12.0, kOfStep = 0.25;
  constexpr int kMost = 3;  // more of them, or smaller ones, may be the rounding of counts
  const Eigen::Index steps = shafts.a_rad.size() - 1;
  const Eigen::VectorXd otherwise = shafts.a_rad - slope * shafts.b_rad;
  const Eigen::VectorXd gained = otherwise.tail(steps) - otherwise.head(steps);
  const double usual = MedianOf({gained.begin(), gained.end()});
  const Eigen::VectorXd off = (gained.array() - usual).abs();
  const Eigen::VectorXd step = (shafts.a_rad.tail(steps) - shafts.a_rad.head(steps)).cwiseAbs();
  const double most =
      std::max(kOfUsual * MedianOf({off.begin(), off.end()}), kOfStep * MedianOf({step.begin(), step.end()}));
  if ((off.array() > most).count() > kMost) return;
  for (Eigen::Index i = 0; i < steps; ++i)
    if (off[i] > most) shafts.a_rad.tail(steps - i).array() -= gained[i] - usual;
}

Proportion ProportionOf(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr Eigen::Index kFewest = 8;
  TwoShafts shafts = ShaftsOf(a, b);
  if (shafts.a_rad.size() < 2) return {};
  const Eigen::VectorXd way_rad = shafts.a_rad;
  double slope = SlopeOf(shafts);
  if (shafts.a_rad.size() >= kFewest) {
    TakeJumpsOut(shafts, slope);
    slope = SlopeOf(shafts);
  }
  const Eigen::VectorXd otherwise = way_rad - slope * shafts.b_rad;
  return {slope, (otherwise.maxCoeff() - otherwise.minCoeff()) / way_rad.cwiseAbs().maxCoeff(), HasTurns(shafts)};
}

}  // namespace

std::vector<double> Unwrapped(std::vector<double> x, const std::string&) {
  constexpr double kWithinATurn_deg = 1.02 * kShaftTurn_deg;
  const auto [low, high] = std::ranges::minmax(x);
  if (high - low > kWithinATurn_deg) return x;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(x[i - 1])) x[i] = x[i - 1] + std::remainder(x[i] - x[i - 1], kShaftTurn_deg);
  }
  return x;
}

std::vector<double> Ratio(const std::vector<double>& a, const std::vector<double>& b, const std::string&) {
  return {ProportionOf(a, b).ratio};
}

std::vector<double> Beside(const std::vector<double>& a, const std::vector<double>& b, const std::string&) {
  constexpr double kOneToOne = 0.01;
  std::vector<double> beside = a;
  const bool goes_along = std::abs(ProportionOf(a, b).ratio - 1.0) < kOneToOne;
  for (std::size_t i = 0; goes_along && i < std::min(a.size(), b.size()); ++i) beside[i] -= b[i];
  return beside;
}

std::vector<double> StatedRatio(const std::vector<double>& stated, const std::vector<double>& found, const std::string&) {
  constexpr double kSame = 0.02;
  const double ratio = std::abs(stated.at(0)), goes = std::abs(found.at(0));
  for (const double meant : {ratio, 1.0 / ratio})
    if (std::abs(meant / goes - 1.0) < kSame) return {meant};
  throw InputError("the ratio", fmt::format("the file states a ratio of {:.6g}, and its angles go {:.6g} to one", ratio, goes),
                   "angles of both shafts in their units, and the ratio of these two");
}

std::vector<double> WholeTurns(const std::vector<double>& a, const std::vector<double>& b, const std::string& where) {
  constexpr int kMostTurns = 1000;       // of the slower one
  constexpr double kLeastLoose = 1e-8;   // a file has no more digits
  constexpr double kOfLoose = 0.25, kOfOrder = 1.0;  // of the ratio, that is a standard deviation; where an order of one turn is in the line
  const bool a_is_slower = std::abs(ProportionOf(a, b).ratio) < 1.0;
  const Proportion found = a_is_slower ? ProportionOf(b, a) : ProportionOf(a, b);
  const double ratio = std::abs(found.ratio), sd = std::max(kLeastLoose, (found.has_turns ? kOfLoose : kOfOrder) * found.loose);
  double best = kNaN, least = std::numeric_limits<double>::infinity();
  for (int slower = 1; slower <= kMostTurns; ++slower) {
    const double faster = std::round(ratio * slower), off = (faster / (ratio * slower) - 1.0) / sd;
    const double cost = off * off + 2.0 * std::log(slower);  // small numbers are more likely
    if (!(cost < least)) continue;
    least = cost;
    best = a_is_slower ? slower : faster;
  }
  if (!std::isfinite(best)) throw InputError(where, "the two angles do not go together", "the angles of two shafts of one train");
  return {best};
}

}  // namespace twinbench::imports
