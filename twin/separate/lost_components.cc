#include "twin/separate/lost_components.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace twinbench::separate {
namespace {

constexpr double kTouch = 1e-6;  // part of a unit vector in the null space that counts

constexpr const char* kNotRead = "no detector of the bench reads this direction";
constexpr const char* kOneAzimuth =
    "the set-ups show the reference's rotor in one azimuth only (or opposite ones), and only motion along y is "
    "read";
constexpr const char* kConstant = "a constant of a table looks like the mounting constants of the set-ups";
constexpr const char* kSeat =
    "tilt or eccentricity of the reference's body on the target's rotor turns with the target in the same way";
constexpr const char* kShifts =
    "the set-ups do not tell it from the same order of other components: some combination of them changes no "
    "reading";

/// One table's component, or pair of components, with the series it is made of.
struct Group {
  Table table;
  std::vector<Component> components;
  std::vector<Series> series;
  bool IsPair() const { return series.size() == 2; }
};

Eigen::VectorXd UnitPart(const OrderNull& null, Series series, int part) {
  return Eigen::VectorXd::Unit(null.vectors.rows(), static_cast<int>(series) * null.parts + part);
}

bool Touches(const OrderNull& null, const Eigen::VectorXd& unit) {
  return null.vectors.cols() > 0 && (null.vectors.transpose() * unit).norm() > kTouch;
}

bool RealIsLost(const OrderNull& null, Series series) {
  return Touches(null, UnitPart(null, series, 0)) || (null.parts == 2 && Touches(null, UnitPart(null, series, 1)));
}

/// x + j y = X e^{jk theta} with X = 1 and X = j; sign is that of k.
bool SignedIsLost(const OrderNull& null, const Group& group, int sign) {
  const Series x = group.series[0], y = group.series[1];
  if (null.parts == 1) return RealIsLost(null, x) || RealIsLost(null, y);
  const Eigen::VectorXd at_1 = (UnitPart(null, x, 0) + sign * UnitPart(null, y, 1)) / std::sqrt(2.0);
  const Eigen::VectorXd at_j = (UnitPart(null, y, 0) - sign * UnitPart(null, x, 1)) / std::sqrt(2.0);
  return Touches(null, at_1) || Touches(null, at_j);
}

const char* Reason(const Group& group, int order) {
  if (order == 0) return kConstant;
  const int with_target = group.table == Table::kTarget ? 1 : -1;
  const bool is_radial = group.components.back() == Component::kDy;
  if (group.IsPair() ? order == with_target : is_radial && order == 1) return kSeat;
  return kShifts;
}

std::string Name(const Group& group) {
  std::string name = TableName(group.table);
  name += ' ';
  for (const Component c : group.components) {
    if (name.back() != ' ') name += ',';
    name += kComponentNames[static_cast<std::size_t>(c)];
  }
  return name;
}

std::string OrdersText(const Group& group, const std::vector<int>& orders) {
  std::string text = orders.size() == 1 ? " order" : " orders";
  for (std::size_t i = 0; i < orders.size(); ++i) {
    text += i == 0 ? " " : ", ";
    text += (group.IsPair() && orders[i] > 0 ? "+" : "") + std::to_string(orders[i]);
  }
  return text;
}

/// Adds an order to the entry of its reason.
void AddOrder(std::vector<NotSeparable>& entries, const Group& group, int order) {
  const std::string why = Reason(group, order);
  auto entry = std::find_if(entries.begin(), entries.end(), [&why](const NotSeparable& e) { return e.why == why; });
  if (entry == entries.end()) {
    entries.push_back({group.table, group.components, {}, false, "", why});
    entry = entries.end() - 1;
  }
  entry->orders.push_back(order);
}

/// Entries of one group; one entry with `all` set if no order is left.
std::vector<NotSeparable> ListGroup(const std::vector<OrderNull>& nulls, const Group& group) {
  std::vector<NotSeparable> entries;
  bool all = true;
  for (const OrderNull& null : nulls) {
    const bool two_signs = group.IsPair() && null.parts == 2;
    for (int sign = 1; sign >= (two_signs ? -1 : 1); sign -= 2) {
      const bool lost = group.IsPair() ? SignedIsLost(null, group, sign) : RealIsLost(null, group.series[0]);
      if (lost) AddOrder(entries, group, sign * null.order);
      all = all && lost;
    }
  }
  if (all) return {{group.table, group.components, {}, true, Name(group), kShifts}};
  for (NotSeparable& e : entries) e.what = Name(group) + OrdersText(group, e.orders);
  return entries;
}

bool IsLostInAllOrders(const std::vector<OrderNull>& nulls, Series series) {
  return std::all_of(nulls.begin(), nulls.end(), [series](const OrderNull& n) { return RealIsLost(n, series); });
}

std::vector<Group> Groups(bool radial_pair) {
  std::vector<Group> groups = {
      {Table::kTarget, {Component::kEx, Component::kEy}, {Series::kTargetEx, Series::kTargetEy}},
      {Table::kTarget, {Component::kEz}, {Series::kTargetEz}},
      {Table::kTarget, {Component::kDy}, {Series::kTargetDy}},
      {Table::kReference, {Component::kEx, Component::kEy}, {Series::kRefEx, Series::kRefEy}},
      {Table::kReference, {Component::kEz}, {Series::kRefEz}}};
  if (radial_pair) {
    groups.push_back({Table::kReference, {Component::kDx, Component::kDy}, {Series::kRefDx, Series::kRefDy}});
  } else {
    groups.push_back({Table::kReference, {Component::kDy}, {Series::kRefDy}});
  }
  return groups;
}

NotSeparable Whole(Table table, Component component, const char* why) {
  return {table, {component}, {}, true, Name({table, {component}, {}}), why};
}

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

const char* TableName(Table table) {
  return table == Table::kTarget ? "target" : "reference";
}

std::vector<NotSeparable> ListLostComponents(const std::vector<OrderNull>& nulls) {
  const bool radial_pair = !IsLostInAllOrders(nulls, Series::kRefDx);
  std::vector<NotSeparable> lost = {Whole(Table::kTarget, Component::kDx, kNotRead),
                                    Whole(Table::kTarget, Component::kDz, kNotRead),
                                    Whole(Table::kReference, Component::kDz, kNotRead)};
  if (!radial_pair) lost.push_back(Whole(Table::kReference, Component::kDx, kOneAzimuth));
  for (const Group& group : Groups(radial_pair)) {
    const std::vector<NotSeparable> entries = ListGroup(nulls, group);
    lost.insert(lost.end(), entries.begin(), entries.end());
  }
  return lost;
}

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
  if (columns.cols() == 0) return columns;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-9);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
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
