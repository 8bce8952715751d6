#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/order_blocks.h"
#include "twin/core/table_errors.h"

namespace twinbench::separate {

enum class Table { kTarget, kReference };
const char* TableName(Table table);  // "target", "reference"

/// A part of one table's errors that the readings cannot tell from something else.
struct NotSeparable {
  Table table = Table::kTarget;
  /// Two components (ex, ey or dx, dy) are one complex series ex + j ey in the table's own angle, and `orders` are
  /// signed: +1 turns with the angle, -1 against it. One component is a real series: its order k means cos and sin.
  std::vector<Component> components;
  std::vector<int> orders;
  bool all = false;  // the whole component is lost; orders is empty
  std::string what;  // "target ex,ey order +1"
  std::string why;   // in plain words
};

/// What a design can and cannot see.
struct Separability {
  std::vector<NotSeparable> lost;
  std::vector<OrderBlock> orders;  // the equations behind it, of the orders 0 to n/2
};

/// Finds the null space of a design, order by order.
///
/// The null space of each order's block (9 series x cos, sin; 4 motions x set-ups, plus the mounting constants at
/// order 0 and the seats at order 1) comes from a singular value decomposition; a component is lost if its unit
/// vector has a part in it. Reference: docs/theory.md 3, 4.
Separability FindSeparability(const Design& design);

/// Takes out of `errors` what cannot be separated: least squares over the finite positions of each series, so that
/// the truth and an estimate with the same gaps lose the same. Components lost entirely become NaN.
TableErrors RemoveNotSeparable(const TableErrors& errors, Table table, const std::vector<NotSeparable>& lost);

/// Orthonormal basis of the lost directions in stacked series: row s * n + i is component series[s] at position i.
/// Rows with `usable` false are zero (that value is not available).
Eigen::MatrixXd LostBasis(Table table, const std::vector<NotSeparable>& lost, const std::vector<Component>& series,
                          const std::vector<double>& position_rad, const std::vector<bool>& usable);

}  // namespace twinbench::separate
