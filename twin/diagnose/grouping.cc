#include "twin/diagnose/grouping.h"

#include <cmath>
#include <complex>
#include <utility>

namespace twinbench::diagnose {
namespace {

bool AreNeighbours(const Schedule& s, std::size_t a, std::size_t b) {
  return s.setup[a] == s.setup[b] && s.pass[a] == s.pass[b] && s.direction[a] == s.direction[b];
}

template <typename Label>
std::vector<Label> Firsts(const std::vector<Label>& of_samples, const Grouping& groups) {
  std::vector<Label> firsts;
  for (Eigen::Index g = 0; g < groups.Groups(); ++g)
    firsts.push_back(of_samples[static_cast<std::size_t>(groups.start[static_cast<std::size_t>(g)])]);
  return firsts;
}

}  // namespace

Eigen::MatrixXd Grouping::Mean(const Eigen::MatrixXd& samples) const {
  if (!Averages()) return samples;
  Eigen::MatrixXd means(Groups(), samples.cols());
  for (Eigen::Index j = 0; j < samples.cols(); ++j) {
    const double* const column = samples.col(j).data();
    for (Eigen::Index g = 0; g < Groups(); ++g) {
      const int first = start[static_cast<std::size_t>(g)], end = first + Size(g);
      double sum = 0.0;
      for (int i = first; i < end; ++i) sum += column[i];
      means(g, j) = sum / Size(g);
    }
  }
  return means;
}

Eigen::MatrixXd Grouping::MeanOfRows(const Eigen::MatrixXd& rows) const {
  if (!Averages()) return rows;
  const Eigen::Index channels = rows.rows() / Samples();
  Eigen::MatrixXd means(Groups() * channels, rows.cols());
  for (Eigen::Index c = 0; c < channels; ++c)
    means(Eigen::seq(c, Eigen::last, channels), Eigen::all) =
        Mean(rows(Eigen::seq(c, Eigen::last, channels), Eigen::all));
  return means;
}

Grouping GroupsOf(const Schedule& schedule, int size) {
  Grouping groups;
  const auto n = static_cast<std::size_t>(schedule.Readings());
  for (std::size_t i = 0; i < n; ++i) {
    const bool full = !groups.start.empty() && static_cast<int>(i) - groups.start.back() >= size;
    if (i == 0 || full || !AreNeighbours(schedule, i - 1, i)) groups.start.push_back(static_cast<int>(i));
  }
  groups.start.push_back(static_cast<int>(n));
  return groups;
}

Schedule Grouped(const Schedule& s, const Grouping& groups) {
  Schedule grouped;
  grouped.reading = Firsts(s.reading, groups);
  grouped.setup = Firsts(s.setup, groups);
  grouped.pass = Firsts(s.pass, groups);
  grouped.direction = Firsts(s.direction, groups);
  grouped.position = Firsts(s.position, groups);
  grouped.phase = Firsts(s.phase, groups);
  for (Eigen::VectorXd Schedule::*value :
       {&Schedule::time_s, &Schedule::dwell_s, &Schedule::temperature_degC, &Schedule::target_rad,
        &Schedule::reference_rad, &Schedule::velocity_rad_s})
    grouped.*value = groups.Mean(s.*value);
  return grouped;
}

double KeptByMean(const Eigen::VectorXd& phase_rad, const Grouping& groups) {
  double kept = 0.0;
  for (Eigen::Index g = 0; g < groups.Groups(); ++g) {
    std::complex<double> sum = 0.0;
    const int first = groups.start[static_cast<std::size_t>(g)];
    for (int i = first; i < first + groups.Size(g); ++i) sum += std::polar(1.0, phase_rad[i]);
    kept += std::norm(sum) / groups.Size(g);
  }
  return std::sqrt(kept / static_cast<double>(groups.Samples()));
}

Grouping LargestGroups(const Schedule& schedule, const Eigen::VectorXd& line_rad,
                       const Eigen::VectorXd& folded_rad) {
  constexpr int kMost = 64;
  constexpr double kLine = 0.8, kFolded = 0.5;
  Grouping groups = GroupsOf(schedule, 1);
  for (int size = 2; size <= kMost; ++size) {
    Grouping larger = GroupsOf(schedule, size);
    if (KeptByMean(line_rad, larger) < kLine) break;
    if (folded_rad.size() == 0 || KeptByMean(folded_rad, larger) >= kFolded) groups = std::move(larger);
  }
  return groups;
}

}  // namespace twinbench::diagnose
