#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kLeastSide = 3, kMostSide = 8;
constexpr double kReadingsInACell = 8.0;

/// Cells of equal size over the area that the model lets a spot reach.
struct SpotMap {
  int side = 0;
  std::vector<int> cell;  // by reading
  Eigen::VectorXd count;  // readings in each cell
};

SpotMap MapOf(const LinearRun& run, const Spot& spot) {
  const Eigen::VectorXd x = Normalised(Predicted(run, spot.x)), y = Normalised(Predicted(run, spot.y));
  const double wanted = std::sqrt(static_cast<double>(x.size()) / kReadingsInACell);
  SpotMap map{std::clamp(static_cast<int>(wanted), kLeastSide, kMostSide), {}, {}};
  map.count = Eigen::VectorXd::Zero(map.side * map.side);
  const auto at = [&](double u) {
    return std::clamp(static_cast<int>(0.5 * (u + 1.0) * map.side), 0, map.side - 1);
  };
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    map.cell.push_back(at(y[i]) * map.side + at(x[i]));
    map.count[map.cell.back()] += 1.0;
  }
  return map;
}

/// Mean of the levelled residual in each cell: cells x columns.
Eigen::MatrixXd Means(const Sample& s, const SpotMap& map, int channel) {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(map.count.size(), s.Columns());
  for (std::size_t i = 0; i < map.cell.size(); ++i)
    means.row(map.cell[i]) += s.levelled.row(static_cast<Eigen::Index>(i) * s.run.Channels() + channel);
  return map.count.cwiseMax(1.0).cwiseInverse().asDiagonal() * means;
}

/// The cell that is farthest from zero for its number of readings, in words.
std::string WorstCell(const LinearRun& run, const Spot& spot, const SpotMap& map, const Eigen::VectorXd& means) {
  Eigen::Index cell = 0;
  (means.cwiseAbs2().cwiseProduct(map.count)).maxCoeff(&cell);
  const auto centre = [&](int channel, Eigen::Index k) {
    const Eigen::VectorXd u = Predicted(run, channel);
    return Amount(run, u.minCoeff() + (static_cast<double>(k) + 0.5) / map.side * (u.maxCoeff() - u.minCoeff()));
  };
  return fmt::format("x = {}, y = {}", centre(spot.x, cell % map.side), centre(spot.y, cell / map.side));
}

}  // namespace

/// Residuals by where the spot stands on its detector: a map of cells, for shapes that no polynomial has.
Tests TestSpotMap(const Sample& s) {
  const LinearRun& run = s.run;
  const std::vector<Spot> spots = SpotsOf(run);
  if (spots.empty()) return {};
  Eigen::MatrixXd values(2 * std::ssize(spots), s.Columns());
  std::vector<std::string> names;
  std::vector<int> channels;
  for (const Spot& spot : spots) {
    const SpotMap map = MapOf(run, spot);
    for (int channel : {spot.x, spot.y}) {
      values.row(std::ssize(channels)) = map.count.transpose() * Means(s, map, channel).cwiseAbs2();
      names.push_back(run.channels[static_cast<std::size_t>(channel)]);
      channels.push_back(channel);
    }
  }
  auto found = TestMoments(values, names, "spot: map", Sides::kUpper);
  if (!found) return {};
  const auto item = static_cast<std::size_t>(found->item);
  const Spot& spot = spots[item / 2];
  const SpotMap map = MapOf(run, spot);
  const double rms = std::sqrt(std::max(0.0, found->excess) / run.schedule.Readings());
  SetEffect(run, channels[item], rms * s.level[channels[item]] * TypicalSigma(run, channels[item]), found->test);
  found->test.reading =
      fmt::format("residual of {} depends on where the spot stands, most at {}: dirt, an edge or uneven response",
                  names[item], WorstCell(run, spot, map, Means(s, map, channels[item]).col(0)));
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
