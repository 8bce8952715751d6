#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/estimators/separability.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

using ComponentIndex = std::vector<Eigen::Index>;

/// Row of a component in the stacked series, or -1.
Eigen::Index StackedAt(const std::vector<Component>& series, Component component, std::size_t n) {
  const auto found = std::find(series.begin(), series.end(), component);
  return found == series.end() ? -1 : static_cast<Eigen::Index>(n) * (found - series.begin());
}

/// Two columns for one order of an entry: X = 1 and X = j, or cos and sin.
void FillColumns(const NotSeparable& lost, int order, const ComponentIndex& at,
                 const std::vector<double>& position_rad, Eigen::Ref<Eigen::MatrixXd> columns) {
  for (std::size_t i = 0; i < position_rad.size(); ++i) {
    const double c = std::cos(order * position_rad[i]), s = std::sin(order * position_rad[i]);
    const auto row = static_cast<Eigen::Index>(i);
    columns.row(at[0] + row) << c, -s;
    if (lost.components.size() == 2) columns.row(at[1] + row) << s, c;
  }
}

}  // namespace

Eigen::MatrixXd LostBasis(Table table, const std::vector<NotSeparable>& lost, const std::vector<Component>& series,
                          const std::vector<double>& position_rad, const std::vector<bool>& usable) {
  const std::size_t n = position_rad.size();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n * series.size()), 0);
  for (const NotSeparable& entry : lost) {
    ComponentIndex at;
    for (const Component c : entry.components) at.push_back(StackedAt(series, c, n));
    if (entry.table != table || *std::min_element(at.begin(), at.end()) < 0) continue;
    for (const int order : entry.orders) {
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 2);
      columns.rightCols(2).setZero();
      FillColumns(entry, order, at, position_rad, columns.rightCols(2));
    }
  }
  for (Eigen::Index r = 0; r < columns.rows(); ++r) {
    if (!usable[static_cast<std::size_t>(r)]) columns.row(r).setZero();
  }
  return columns.cols() == 0 ? columns : OrthonormalBasisOf(columns, 1e-9);
}

TableErrors RemoveNotSeparable(const TableErrors& errors, Table table, const std::vector<NotSeparable>& lost) {
  std::vector<Component> series;
  TableErrors left = errors;
  const std::size_t n = errors.position_rad.size();
  for (int c = 0; c < kComponents; ++c) {
    if (errors.value[static_cast<std::size_t>(c)].size() == n) series.push_back(static_cast<Component>(c));
  }
  Eigen::VectorXd stacked(static_cast<Eigen::Index>(n * series.size()));
  std::vector<bool> usable(n * series.size());
  for (std::size_t r = 0; r < usable.size(); ++r) {
    const double value = errors[series[r / n]][r % n];
    usable[r] = std::isfinite(value);
    stacked[static_cast<Eigen::Index>(r)] = usable[r] ? value : 0.0;
  }
  const Eigen::MatrixXd basis = LostBasis(table, lost, series, errors.position_rad, usable);
  stacked -= basis * (basis.transpose() * stacked);
  for (std::size_t r = 0; r < usable.size(); ++r) {
    if (usable[r]) left[series[r / n]][r % n] = stacked[static_cast<Eigen::Index>(r)];
  }
  for (const NotSeparable& entry : lost) {
    if (entry.table != table || !entry.all) continue;
    for (const Component c : entry.components) left[c].assign(n, kNaN);
  }
  return left;
}

}  // namespace twinbench::separate
