#include "twin/diagnose/still_far.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/distributions.h"
#include "twin/diagnose/same_pass.h"

namespace twinbench::diagnose {
namespace {

/// A row less the middle of the readings around it, on the same channel and in the same pass.
double OffNeighbours(const LinearRun& run, const Eigen::VectorXd& left, int row) {
  constexpr int kAround = 2;
  std::vector<double> around;
  for (int behind = -kAround; behind <= kAround; ++behind) {
    const int other = row + behind * run.Channels();
    if (other < 0 || other >= run.Rows() || !SamePass(run.schedule, run.ReadingOf(row), run.ReadingOf(other))) continue;
    around.push_back(left[other]);
  }
  return left[row] - Median(std::move(around));
}

/// Of one channel, that of a normal distribution with such a middle size.
double ScaleOf(const LinearRun& run, const Eigen::VectorXd& values, int channel) {
  constexpr double kMedianOfNormal = 0.6745;
  std::vector<double> sizes;
  for (int row = channel; row < run.Rows(); row += run.Channels()) sizes.push_back(std::abs(values[row]));
  return Median(std::move(sizes)) / kMedianOfNormal;
}

}  // namespace

std::vector<int> StillFar(std::vector<int> rows, const LinearRun& run, const Eigen::VectorXd& left) {
  constexpr double kFar = 3.0;  // standard deviations
  Eigen::VectorXd off(run.Rows());
  for (int row = 0; row < run.Rows(); ++row) off[row] = OffNeighbours(run, left, row);
  // Several in a row are far from all others, one beside noise that wanders from its neighbours.
  std::erase_if(rows, [&](int row) {
    const int channel = run.ChannelOf(row);
    return std::abs(left[row]) < kFar * ScaleOf(run, left, channel) && std::abs(off[row]) < kFar * ScaleOf(run, off, channel);
  });
  return rows;
}

double SizeOfFar(const std::vector<int>& rows, const LinearRun& run, const Eigen::VectorXd& left) {
  std::map<int, double> largest;
  for (const int row : rows) {
    double& of_reading = largest[run.ReadingOf(row)];
    of_reading = std::max(of_reading, std::abs(left[row]) / run.sigma[row]);
  }
  double squares = 0.0;
  for (const auto& [reading, size] : largest) squares += size * size;
  return largest.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(largest.size()));
}

}  // namespace twinbench::diagnose
