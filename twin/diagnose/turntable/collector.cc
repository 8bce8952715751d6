#include "twin/diagnose/turntable/collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/units.h"

namespace twinbench::diagnose::turntable {

using units::arcsec;

Family& Collector::New(const std::string& sort, const std::string& where, Eigen::Index amplitudes,
                       const Words& words) {
  constexpr double kPlausible_rad = 0.5 * arcsec;
  Family& family = families_.emplace_back();
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = where;
  family.amplitudes.assign(static_cast<std::size_t>(amplitudes), {"amplitude", "arcsec", arcsec, kPlausible_rad});
  family.describe = [where, words](int g, const Eigen::VectorXd& x) {
    return fmt::format("{}, on {}, amplitude {:.2g} arcsec", words(g), where, x.norm() / arcsec);
  };
  return family;
}

void Collector::Add(const std::string& sort, int grid, const Signals& signals, const Words& words) {
  const auto base = std::make_shared<Base>();
  base->grid = grid;
  base->channels = kAxes;
  base->series = signals;
  const auto k = static_cast<int>(signals(0).cols());
  const auto add = [&](const std::string& where, const Eigen::MatrixXd& map) {
    Family& family = New(sort, where, map.cols(), words);
    family.grid = grid;
    family.base = base;
    family.map = map;
  };
  for (const int axis : {kX, kY}) add(kAxisNames[static_cast<std::size_t>(axis)], MapOfAxis(axis, k));
  add(kBothAxes, Eigen::MatrixXd::Identity(kAxes * k, kAxes * k));
}

void Collector::Add(const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words) {
  if (signals.cols() == 0 || signals.cwiseAbs().maxCoeff() == 0.0) return;
  Add(
      sort, 1, [signals](int) { return signals; }, [words](int) { return words; });
}

void Collector::AddOn(int axis, const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words) {
  Family& family =
      New(sort, kAxisNames[static_cast<std::size_t>(axis)], signals.cols(), [words](int) { return words; });
  family.columns = [rows = OnAxis(signals, axis)](int) { return rows; };
}

Eigen::VectorXd Unit(const Eigen::VectorXd& signal) {
  const double rms =
      std::sqrt(signal.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, signal.size())));
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor) {
  return columns.array().colwise() * factor.array();
}

Eigen::MatrixXd Indicators(const Collector& collect, const std::vector<int>& label) {
  const std::vector<int>& sweep = collect.turntable().places.sweep;
  std::set<int> values;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (sweep[i] < 0) values.insert(label[i]);
  }
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(std::ssize(label), std::ssize(values));
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (sweep[i] < 0)
      columns(static_cast<Eigen::Index>(i), std::distance(values.begin(), values.find(label[i]))) = 1.0;
  }
  return columns;
}

Eigen::VectorXd Fraction(const Schedule& s) {
  const double first_s = s.time_s.minCoeff();
  return (s.time_s.array() - first_s) / std::max(1.0, s.time_s.maxCoeff() - first_s);
}

int LargestOrder(const TurntableRun& turntable) {
  constexpr int kMost = 12;
  return std::clamp((turntable.places.circle_blocks - 1) / 2, 0, kMost);
}

}  // namespace twinbench::diagnose::turntable
