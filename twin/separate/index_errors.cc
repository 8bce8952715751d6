#include "twin/separate/index_errors.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr long long kPlaces = 100000000;  // a turn: angles closer than 13 milliarcseconds are one place

long long PlaceAt(double angle_rad) {
  const long long place = std::llround(angle_rad / (2.0 * units::kPi) * kPlaces) % kPlaces;
  return place < 0 ? place + kPlaces : place;
}

/// Readings of one set-up at one place.
struct Cell {
  int place = 0, setup = 0;
  double sum_rad = 0.0;
  int count = 0;
};

/// The readings as a table of places and set-ups, both by running numbers.
struct PlaceTable {
  std::vector<double> angle_rad;  // of the places
  std::vector<Cell> cells;
  int setups = 0;
  double squares_rad2 = 0.0;  // of the readings about the means of their cells
  int readings = 0;
};

PlaceTable Tabulate(const std::vector<IndexReading>& readings) {
  std::map<long long, std::map<int, std::vector<double>>> by_place;
  std::map<int, int> setups;
  for (const IndexReading& r : readings) {
    if (!std::isfinite(r.angle_rad) || !std::isfinite(r.value_rad)) continue;
    by_place[PlaceAt(r.angle_rad)][r.setup].push_back(r.value_rad);
    setups.emplace(r.setup, static_cast<int>(setups.size()));
  }
  PlaceTable table;
  table.setups = static_cast<int>(setups.size());
  for (const auto& [place, by_setup] : by_place) {
    for (const auto& [setup, values_rad] : by_setup) {
      const Eigen::Map<const Eigen::ArrayXd> v(values_rad.data(), std::ssize(values_rad));
      table.cells.push_back(
          {static_cast<int>(table.angle_rad.size()), setups.at(setup), v.sum(), static_cast<int>(v.size())});
      table.squares_rad2 += (v - v.mean()).square().sum();
      table.readings += static_cast<int>(v.size());
    }
    table.angle_rad.push_back(static_cast<double>(place) / kPlaces * 2.0 * units::kPi);
  }
  return table;
}

/// Set-ups that are connected by common places have one number.
std::vector<int> GroupsOf(const PlaceTable& table) {
  std::vector<int> group(static_cast<std::size_t>(table.setups));
  for (std::size_t s = 0; s < group.size(); ++s) group[s] = static_cast<int>(s);
  for (std::size_t c = 1; c < table.cells.size(); ++c) {
    const Cell &a = table.cells[c - 1], &b = table.cells[c];
    if (a.place != b.place) continue;
    const int kept = group[static_cast<std::size_t>(a.setup)], gone = group[static_cast<std::size_t>(b.setup)];
    std::ranges::replace(group, gone, kept);
  }
  return group;
}

/// Constants of the set-ups, those of a group about their mean: the normal equations after the places are
/// eliminated.
Eigen::VectorXd ConstantsOf(const PlaceTable& table) {
  const Eigen::Index n = table.setups;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right_rad = Eigen::VectorXd::Zero(n);
  for (std::size_t begin = 0, end = 0; begin < table.cells.size(); begin = end) {
    double count = 0.0, sum_rad = 0.0;
    for (end = begin; end < table.cells.size() && table.cells[end].place == table.cells[begin].place; ++end) {
      count += table.cells[end].count;
      sum_rad += table.cells[end].sum_rad;
    }
    for (std::size_t a = begin; a < end; ++a) {
      const Cell& cell = table.cells[a];
      normal(cell.setup, cell.setup) += cell.count;
      right_rad[cell.setup] += cell.sum_rad - cell.count * sum_rad / count;
      for (std::size_t b = begin; b < end; ++b)
        normal(cell.setup, table.cells[b].setup) -= cell.count * table.cells[b].count / count;
    }
  }
  constexpr double kSingular = 1e-9;  // the sum of a group's constants is free
  return SolveRanked(normal, right_rad, kSingular).x;
}

}  // namespace

double IndexErrors::NoiseVariance_rad2(std::size_t place) const {
  return std::isfinite(u_reading_rad) ? u_reading_rad * u_reading_rad / count[place] : 0.0;
}

IndexErrors MeansByPlace(const std::vector<IndexReading>& readings) {
  const PlaceTable table = Tabulate(readings);
  const std::vector<int> groups = GroupsOf(table);
  const Eigen::VectorXd constant_rad = ConstantsOf(table);
  const std::size_t n = table.angle_rad.size();
  IndexErrors errors;
  errors.position_rad = table.angle_rad;
  errors.value_rad = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  errors.count.assign(n, 0);
  errors.group.assign(n, 0);
  for (const Cell& cell : table.cells) {
    const auto place = static_cast<std::size_t>(cell.place);
    errors.value_rad[cell.place] += cell.sum_rad - cell.count * constant_rad[cell.setup];
    errors.count[place] += cell.count;
    errors.group[place] = groups[static_cast<std::size_t>(cell.setup)];
  }
  for (std::size_t i = 0; i < n; ++i) errors.value_rad[static_cast<Eigen::Index>(i)] /= errors.count[i];
  double squares_rad2 = table.squares_rad2;
  for (const Cell& cell : table.cells) {
    const double rest_rad = cell.sum_rad / cell.count - constant_rad[cell.setup] - errors.value_rad[cell.place];
    squares_rad2 += cell.count * rest_rad * rest_rad;
  }
  std::vector<int> distinct = groups;
  std::ranges::sort(distinct);
  const auto connected = table.setups - (std::unique(distinct.begin(), distinct.end()) - distinct.begin());
  const auto dof = table.readings - static_cast<long>(n) - connected;
  if (dof <= 0) return errors;
  errors.dof = static_cast<double>(dof);
  errors.u_reading_rad = std::sqrt(squares_rad2 / errors.dof);
  return errors;
}

Eigen::VectorXd AboutGroups(const IndexErrors& errors, const Eigen::VectorXd& value_rad) {
  std::map<int, std::pair<double, int>> sums;
  for (std::size_t i = 0; i < errors.group.size(); ++i) {
    auto& [sum_rad, count] = sums[errors.group[i]];
    sum_rad += value_rad[static_cast<Eigen::Index>(i)];
    ++count;
  }
  Eigen::VectorXd about_rad = value_rad;
  for (std::size_t i = 0; i < errors.group.size(); ++i) {
    const auto& [sum_rad, count] = sums.at(errors.group[i]);
    about_rad[static_cast<Eigen::Index>(i)] -= sum_rad / count;
  }
  return about_rad;
}

double RootMeanSquare(const Eigen::VectorXd& value_rad) {
  return std::sqrt(value_rad.squaredNorm() / static_cast<double>(value_rad.size()));
}

}  // namespace twinbench::separate
