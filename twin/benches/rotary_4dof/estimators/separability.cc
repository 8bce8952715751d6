#include "twin/benches/rotary_4dof/estimators/separability.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "twin/core/last_answer.h"

namespace twinbench::separate {
namespace {

/// Null vectors of one real order: row series * parts + part (cos, sin), one column a vector.
struct OrderNull {
  int order = 0;
  int parts = 2;
  Eigen::MatrixXd vectors;
};

constexpr double kTouch = 1e-6;  // part of a unit vector in the null space that counts

constexpr const char* kNotRead = "no detector of the bench reads this direction";
constexpr const char* kOneAzimuth =
    "the mountings show the reference's rotor in one azimuth only (or opposite ones), and only motion along y is "
    "read";
constexpr const char* kConstant = "a constant of a table looks like the constants of the mountings";
constexpr const char* kSeat =
    "tilt or eccentricity of the reference's body on the target's rotor turns with the target in the same way";
constexpr const char* kShifts =
    "the mountings do not separate it from the same order of other components: some combination of them changes no "
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
  std::vector<std::string> names;
  for (const int order : orders) {
    names.push_back(fmt::format("{}{}", group.IsPair() && order > 0 ? "+" : "", order));
  }
  return fmt::format(" {} {}", orders.size() == 1 ? "order" : "orders", fmt::join(names, ", "));
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

/// Names the elementary components that null vectors touch. Wobble, and the reference's radial motion if both its
/// components are seen, are complex series with signed orders; everything else is real. The target's dx and both dz
/// are never read and always listed.
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

Separability Found(const Design& design) {
  Separability result;
  result.orders = OrderBlocks(design);
  std::vector<OrderNull> nulls;
  for (const OrderBlock& block : result.orders) {
    nulls.push_back({block.basis.order, block.basis.parts, block.null.topRows(kSeries * block.basis.parts)});
  }
  result.lost = ListLostComponents(nulls);
  return result;
}

/// All that a design is.
std::vector<double> NumbersOf(const Design& d) {
  std::vector<double> numbers = {static_cast<double>(d.n), d.target_offset_rad, d.reference_offset_rad, d.target_height_m, d.reference_height_m};
  for (const SetUp& s : d.setups)
    numbers.insert(numbers.end(), {static_cast<double>(s.label), static_cast<double>(s.shift), s.rho_rad, static_cast<double>(s.clamping)});
  return numbers;
}

}  // namespace

const char* TableName(Table table) {
  return table == Table::kTarget ? "target" : "reference";
}

Separability FindSeparability(const Design& design) {
  static LastAnswer<std::vector<double>, Separability> last;
  return *last.To(NumbersOf(design), [&] { return Found(design); });
}

}  // namespace twinbench::separate
