#include "twin/benches/turntable_autocollimator/estimators/shift_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/benches/turntable_autocollimator/estimators/lost_harmonics.h"
#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kComesBack = 1e-6;  // of unknowns of size one

/// Value of the curves at which an unknown [T; R] stands, and the other way round: teeth run backwards.
Eigen::Index ValueOf(Eigen::Index unknown, Eigen::Index n) {
  return unknown < n ? unknown : unknown / n * n + (n - unknown % n) % n;
}

/// Number of positions at which each set-up was read.
std::vector<int> PlacesRead(const StopGrid& grid) {
  std::vector<std::vector<bool>> read(grid.setups.size(), std::vector<bool>(static_cast<std::size_t>(grid.n), false));
  for (const GridStop& stop : grid.stops)
    read[static_cast<std::size_t>(stop.setup)][static_cast<std::size_t>(stop.position)] = true;
  std::vector<int> places;
  for (const auto& of_setup : read) places.push_back(static_cast<int>(std::ranges::count(of_setup, true)));
  return places;
}

/// The set-ups that were read at more than one place: a single reading tells its set-up's constant alone.
struct Telling {
  std::vector<Eigen::Index> column;  // of each set-up; -1: tells nothing
  shifts::ShiftSet set;
};

Telling FindTelling(const StopGrid& grid) {
  Telling telling{{}, {grid.n, {}, {}}};
  const std::vector<int> places = PlacesRead(grid);
  for (std::size_t s = 0; s < grid.setups.size(); ++s) {
    const bool tells = places[s] > 1;
    telling.column.push_back(tells ? std::ssize(telling.set.shifts) : -1);
    if (!tells) continue;
    telling.set.shifts.push_back(-grid.setups[s].shift);
    telling.set.weights.push_back(1.0);
    telling.set.rows.push_back(grid.setups[s].row);
  }
  return telling;
}

/// Whether set-ups tell something of every row.
bool TellOfAllRows(const Telling& telling, const StopGrid& grid) {
  for (std::size_t row = 0; row < grid.row_offset_rad.size(); ++row) {
    if (std::ranges::count(telling.set.rows, static_cast<int>(row)) == 0) return false;
  }
  return true;
}

Eigen::VectorXd NormalValues(Eigen::Index count) {
  Stream random(1, "turntable.shift_probe");
  Eigen::VectorXd values(count);
  for (double& v : values) v = random.Normal();
  return values;
}

}  // namespace

ShiftFit::ShiftFit(const StopGrid& grid) : grid_(grid), common_steps_(CommonSteps(grid)) {
  const Telling telling = FindTelling(grid);
  column_ = telling.column;
  if (!TellOfAllRows(telling, grid)) return;
  readings_ = Eigen::MatrixXd::Zero(grid.n, std::ssize(telling.set.shifts));
  std::vector<bool> read(static_cast<std::size_t>(grid.n + grid.Teeth()), false);
  int used = 0;
  for (const GridStop& stop : grid.stops) {
    read[static_cast<std::size_t>(stop.position)] = true;
    read[static_cast<std::size_t>(ValueOf(grid.n + stop.tooth, grid.n))] = true;
    if (Setup(stop) < 0) continue;
    readings_(stop.position, Setup(stop)) += 1.0;
    ++used;
  }
  const shifts::ShiftSet& set = telling.set;
  convention_.emplace(set, read);
  separation_.emplace(set.shifts, readings_, 2000, set.rows);
  dof_ = separation_->dof() + used - static_cast<double>((readings_.array() > 0.0).count());
  determined_ = ComesBack();
  if (determined_) inverse_ = shifts::NearlyEvenInverse::Of(set.shifts, set.rows, readings_);
}

/// Whether unknowns drawn at random are found from readings of them, but for what the convention chooses.
bool ShiftFit::ComesBack() const {
  if (separation_->IsEven()) return true;
  const Eigen::Index values = grid_.n + grid_.Teeth();
  const Eigen::VectorXd drawn = NormalValues(values);
  Eigen::MatrixXd shown = Eigen::MatrixXd::Zero(readings_.rows(), readings_.cols());
  for (const GridStop& stop : grid_.stops) {
    if (Setup(stop) >= 0)
      shown(stop.position, Setup(stop)) = drawn[stop.position] + drawn[ValueOf(grid_.n + stop.tooth, grid_.n)];
  }
  const Eigen::VectorXd found = separation_->Solve(shown).unknowns.head(values);
  return (convention_->Applied(found) - convention_->Applied(drawn)).cwiseAbs().maxCoeff() < kComesBack;
}

/// Means of the values at each stop of each set-up.
Eigen::MatrixXd ShiftFit::CellMeans(const Eigen::VectorXd& values) const {
  Require(values.size() == std::ssize(grid_.stops), "one value a stop of the grid");
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(readings_.rows(), readings_.cols());
  for (std::size_t k = 0; k < grid_.stops.size(); ++k) {
    const GridStop& stop = grid_.stops[k];
    if (Setup(stop) >= 0) means(stop.position, Setup(stop)) += values[static_cast<Eigen::Index>(k)];
  }
  return (readings_.array() > 0.0).select(means.cwiseQuotient(readings_), 0.0);
}

Eigen::VectorXd ShiftFit::Solve(const Eigen::VectorXd& values) const {
  const Eigen::Index count = grid_.n + grid_.Teeth();
  Eigen::VectorXd unknowns = Eigen::VectorXd::Constant(count, kNaN);
  if (!determined_) return unknowns;
  const Eigen::VectorXd curves =
      convention_->Applied(separation_->Solve(CellMeans(values)).unknowns.head(count));
  for (Eigen::Index u = 0; u < count; ++u) {
    const Eigen::Index at = ValueOf(u, grid_.n);
    if (convention_->Read(at)) unknowns[u] = curves[at];
  }
  return unknowns;
}

Eigen::VectorXd ShiftFit::Residuals(const Eigen::VectorXd& values) const {
  if (!determined_) return Eigen::VectorXd::Constant(values.size(), kNaN);
  const Eigen::MatrixXd means = CellMeans(values), left = separation_->Solve(means).residuals;
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(values.size());
  for (std::size_t k = 0; k < grid_.stops.size(); ++k) {
    const GridStop& stop = grid_.stops[k];
    const auto i = static_cast<Eigen::Index>(k);
    if (Setup(stop) >= 0)
      rest[i] = values[i] - means(stop.position, Setup(stop)) + left(stop.position, Setup(stop));
  }
  return rest;
}

/// The curves' part of the normal matrix' inverse.
Eigen::VectorXd ShiftFit::Inverse(const Eigen::VectorXd& curves) const {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(curves.size() + readings_.cols());
  right.head(curves.size()) = curves;
  const Eigen::VectorXd x = inverse_ ? inverse_->Apply(right) : separation_->SolveNormalEquations(right);
  return x.head(curves.size());
}

/// Covariance of an unknown with all values of the curves.
Eigen::VectorXd ShiftFit::CofactorColumn(int unknown) const {
  Eigen::VectorXd one = Eigen::VectorXd::Zero(grid_.n + grid_.Teeth());
  one[ValueOf(unknown, grid_.n)] = 1.0;
  return convention_->Applied(Inverse(convention_->Transposed(one)));
}

/// All of T, or all of the only row of R, and nothing was missed altogether: stops are alike then.
bool ShiftFit::IsWholeCurve(const std::vector<int>& unknowns) const {
  if (!inverse_ || !convention_->AllRead() || std::ssize(unknowns) != grid_.n) return false;
  if (unknowns.front() != 0 && (unknowns.front() != grid_.n || grid_.row_offset_rad.size() > 1)) return false;
  for (std::size_t k = 1; k < unknowns.size(); ++k) {
    if (unknowns[k] != unknowns[k - 1] + 1) return false;
  }
  return true;
}

CurveCovariance ShiftFit::WholeCurve(int first) const {
  const Eigen::Index n = grid_.n, values = n + grid_.Teeth();
  Eigen::VectorXd one = Eigen::VectorXd::Zero(inverse_->even().unknowns());
  one[first] = 1.0;
  one.head(values) = convention_->Transposed(one.head(values));
  const Eigen::VectorXd column = convention_->Applied(inverse_->even().Apply(one).head(values));
  CurveCovariance whole = CurveCovariance::Circulant(column.segment(first, n), 1);
  const auto in_order = [&](const Eigen::MatrixXd& factor) {
    Eigen::MatrixXd rows(n, factor.cols());
    for (Eigen::Index c = 0; c < factor.cols(); ++c) {
      const Eigen::VectorXd chosen = convention_->Applied(factor.col(c).head(values));
      for (Eigen::Index i = 0; i < n; ++i) rows(i, c) = chosen[ValueOf(first + i, n)];
    }
    return rows;
  };
  whole.AddProduct(in_order(inverse_->lacking()));
  whole.SubtractProduct(in_order(inverse_->added()));
  return whole;
}

CurveCovariance ShiftFit::Cofactor(const std::vector<int>& unknowns) const {
  const auto count = std::ssize(unknowns);
  if (!determined_) return CurveCovariance::Circulant(Eigen::VectorXd::Constant(count, kNaN), 1);
  if (IsWholeCurve(unknowns)) return WholeCurve(unknowns.front());
  Eigen::MatrixXd dense(count, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const Eigen::VectorXd column = CofactorColumn(unknowns[static_cast<std::size_t>(c)]);
    for (Eigen::Index r = 0; r < count; ++r) dense(r, c) = column[ValueOf(unknowns[static_cast<std::size_t>(r)], grid_.n)];
  }
  return CurveCovariance::Dense(std::move(dense));
}

}  // namespace twinbench::separate::turntable
