#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// Own and cross coordinate of each channel as the model places the spot; a channel without a spot has none.
struct Coordinates {
  std::vector<Eigen::VectorXd> own_m, cross_m;  // by channel
};

Coordinates CoordinatesOf(const LinearRun& run, const std::vector<Spot>& spots) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(run.schedule.Readings());
  Coordinates u{std::vector(run.channels.size(), none), std::vector(run.channels.size(), none)};
  for (const auto& [name, x, y] : spots) {
    u.own_m[x] = u.cross_m[y] = Predicted(run, x);
    u.own_m[y] = u.cross_m[x] = Predicted(run, y);
  }
  return u;
}

/// Legendre polynomial of values on [-1, 1], which rounding may have left.
Eigen::MatrixXd Legendre(unsigned degree, const Eigen::VectorXd& u) {
  return u.unaryExpr([degree](double v) { return std::legendre(degree, std::clamp(v, -1.0, 1.0)); });
}

Scan Polynomials(const Coordinates& u) {
  Scan scan{"spot: polynomial"};
  for (const auto& [which, by_channel] : {std::pair("own", u.own_m), std::pair("cross", u.cross_m)}) {
    for (unsigned degree : {2, 3, 4, 5}) {
      std::vector<Eigen::MatrixXd> shape;
      for (const Eigen::VectorXd& u_m : by_channel) shape.push_back(Legendre(degree, Normalised(u_m)));
      scan.Add(std::move(shape), degree, which);
    }
  }
  return scan;
}

/// Frequencies in steps of half a fringe over the range: a fringe between two of them stays within a quarter turn.
Scan Fringes(const Coordinates& u) {
  constexpr double kShortestPeriod_m = 20e-6;  // shorter ones change within the spread of a stop
  constexpr int kMostHalfFringes = 80;
  double range_m = 0.0;
  for (const Eigen::VectorXd& own_m : u.own_m) range_m = std::max(range_m, own_m.maxCoeff() - own_m.minCoeff());
  Scan scan{"spot: periodic", 2};
  for (int k = 4; k <= static_cast<int>(std::min<double>(kMostHalfFringes, 2.0 * range_m / kShortestPeriod_m));
       ++k) {
    const double fringes_m = 0.5 * k / range_m;
    std::vector<Eigen::MatrixXd> shape;
    for (const Eigen::VectorXd& own_m : u.own_m) shape.push_back(Wave(units::turn * fringes_m * own_m));
    scan.Add(std::move(shape), 1e6 / fringes_m);
  }
  return scan;
}

/// Cells of equal size over the area that the model lets a spot reach, row by row.
struct SpotMap {
  int side = 0;
  std::vector<int> cell;  // by reading
};

SpotMap MapOf(const LinearRun& run, const Spot& spot) {
  constexpr int kLeastSide = 3, kMostSide = 8;
  constexpr double kReadingsInACell = 8.0;
  const Eigen::VectorXd x = Normalised(Predicted(run, spot.x)), y = Normalised(Predicted(run, spot.y));
  const double wanted = std::sqrt(static_cast<double>(x.size()) / kReadingsInACell);
  SpotMap map{std::clamp(static_cast<int>(wanted), kLeastSide, kMostSide), {}};
  const auto at = [&](double u) {
    return std::clamp(static_cast<int>(0.5 * (u + 1.0) * map.side), 0, map.side - 1);
  };
  for (Eigen::Index i = 0; i < x.size(); ++i) map.cell.push_back(at(y[i]) * map.side + at(x[i]));
  return map;
}

/// Readings in each cell times the square of the mean levelled residual: cells x columns.
Eigen::MatrixXd Misfit(const Sample& s, const SpotMap& map, int channel) {
  const Eigen::VectorXd count = SumsByGroup(Eigen::VectorXd::Ones(std::ssize(map.cell)), map.cell);
  const Eigen::MatrixXd sums = SumsByGroup(s.levelled(RowsOf(s.run, channel), Eigen::all), map.cell);
  return count.cwiseMax(1.0).cwiseInverse().asDiagonal() * sums.cwiseAbs2();
}

/// The cell that is farthest from zero for its number of readings, in words.
std::string WorstCell(const Sample& s, const Spot& spot, const SpotMap& map, int channel) {
  int cell = 0;
  Misfit(s, map, channel).col(0).maxCoeff(&cell);
  const auto centre = [&](int of, int k) {
    const Eigen::VectorXd u = Predicted(s.run, of);
    return Amount(s.run, of, u.minCoeff() + (k + 0.5) / map.side * (u.maxCoeff() - u.minCoeff()));
  };
  return ItemOf("spot: map", centre(spot.x, cell % map.side), centre(spot.y, cell / map.side));
}

}  // namespace

void TestSpot(const Sample& sample, Tests& tests) {
  const std::vector<Spot> spots = SpotsOf(sample.run);
  if (spots.empty()) return;
  const Coordinates u = CoordinatesOf(sample.run, spots);
  TestScan(sample, Polynomials(u), tests);
  TestScan(sample, Fringes(u), tests);
}

/// Residuals by where the spot stands on its detector: a map of cells, for shapes that no polynomial has.
void TestSpotMap(const Sample& s, Tests& tests) {
  const std::vector<Spot> spots = SpotsOf(s.run);
  if (spots.empty()) return;
  Statistic misfit{"spot: map", {}, Eigen::MatrixXd(2 * std::ssize(spots), s.Columns())};
  for (const Spot& spot : spots) {
    const SpotMap map = MapOf(s.run, spot);
    for (int channel : {spot.x, spot.y}) {
      misfit.values.row(std::ssize(misfit.items)) = Misfit(s, map, channel).colwise().sum();
      misfit.items.push_back(s.run.channels[channel]);
    }
  }
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const Spot& spot = spots[item / 2];
    const int channel = item % 2 == 0 ? spot.x : spot.y;
    const double rms = std::sqrt(std::max(0.0, excess) / s.run.schedule.Readings());
    SetEffect(s.run, channel, rms * s.Unit_SI(channel), test);
    test.reading = ReadingOf(test.name, s.run.channels[channel], WorstCell(s, spot, MapOf(s.run, spot), channel));
  };
  TestMoments(misfit, Sides::kUpper, meaning, tests);
}

}  // namespace twinbench::diagnose::screen
