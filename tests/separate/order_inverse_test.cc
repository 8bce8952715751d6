#include "twin/benches/rotary_4dof/estimators/order_inverse.h"

#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/benches/rotary_4dof/estimators/table_part.h"

namespace twinbench::separate {
namespace {

/// One design of complete circles, inverted as one matrix and order by order.
struct BothInverses {
  WeightedStops stops;
  Separability separability;
  NormalInverse whole;
  std::optional<OrderInverse> by_order;
};

/// @param missing  Motions that are not there.
BothInverses InvertBothWays(int n, const std::vector<int>& shifts, const LayoutOptions& options,
                            const std::vector<std::size_t>& missing = {}) {
  auto motions = EmptyMotions(n, shifts, 2, ReadingCovariance());
  Matrix4 correlated = ReadingCovariance();
  correlated(0, 3) = correlated(3, 0) = 0.3 * std::sqrt(correlated(0, 0) * correlated(3, 3));
  for (Motion& m : motions) {
    m.target_rad += 0.01;  // position 0 is not at zero
    if (m.setup == 1) m.cov = 2.0 * correlated;
  }
  for (const std::size_t i : missing) motions[i].status = ReadingStatus::kMissing;
  BothInverses both{Weigh(motions, options), {}, {}, {}};
  const auto& [layout, weights, models] = both.stops;
  both.separability = FindSeparability(layout.design);
  both.whole = InvertNormal(layout.design, weights.cells, models, both.stops.Null());
  both.by_order = OrderInverse::Of(layout.design, both.separability.orders, weights.cells);
  return both;
}

/// Largest difference, as a part of the largest value.
double Difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

struct Circles {
  int n;
  std::vector<int> shifts;
  LayoutOptions options;
};

std::vector<Circles> CircleDesigns() {
  LayoutOptions mixed = Layouts(15, Clamping::kReclamp);
  mixed.clamping_of_setup[2] = Clamping::kReseat;
  return {{12, {0, 1, 4}, Layouts(12, Clamping::kReseat)}, {12, {0, 1, 4, 6}, Layouts(12, Clamping::kReclamp)},
          {15, {0, 1, 4, 6}, mixed}, {12, {0, 1}, Layouts(12, Clamping::kReclamp)},
          {12, {0, 2, 8}, Layouts(12, Clamping::kReseat)}, {36, {0, 1, 7, 11}, Layouts(36, Clamping::kReseat)}};
}

void ExpectSameCovarianceAndDegreesOfFreedom(const BothInverses& both) {
  const Vector4 dof = DegreesOfFreedom(both.stops.weights, both.stops.models, both.whole);
  EXPECT_LT((DegreesOfFreedom(both.stops.weights, both.stops.models, *both.by_order) - dof).norm(), 1e-8);
  for (const Table table : {Table::kTarget, Table::kReference}) {
    const TablePart whole = MakeTablePart(both.stops.layout.design, table, both.separability.lost, both.whole);
    const TablePart by_order = MakeTablePart(both.stops.layout.design, table, both.separability.lost, *both.by_order);
    ASSERT_EQ(whole.columns, by_order.columns);
    EXPECT_EQ(by_order.usable, whole.usable);
    EXPECT_LT(Difference(by_order.cov.ToDense(), whole.cov.ToDense()), 1e-9) << TableName(table);
  }
}

TEST(OrderInverse, IsTheInverseOfTheWholeMatrixAndGivesTheSameCovarianceAndDegreesOfFreedom) {
  for (const Circles& c : CircleDesigns()) {
    SCOPED_TRACE(testing::Message() << c.n << ' ' << c.shifts.size());
    const BothInverses both = InvertBothWays(c.n, c.shifts, c.options);
    ASSERT_TRUE(both.by_order.has_value());
    const Eigen::Index unknowns = both.whole.inverse.rows();
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(unknowns, unknowns);
    // 1e-16 times the condition of these designs, up to 1e5; the same choices where no reading decides.
    EXPECT_LT(Difference(*both.by_order * unit, both.whole.inverse), 1e-9);
    ExpectSameCovarianceAndDegreesOfFreedom(both);
  }
}

TEST(OrderInverse, TakesOutWhatIsMissing) {
  // One pass of stop 5 and both of stop 7 of the first set-up, one of stop 3 of the second; n = 12, two passes
  // each.
  const BothInverses both = InvertBothWays(12, {0, 1, 4}, Layouts(12, Clamping::kReseat), {5, 7, 19, 27});
  ASSERT_TRUE(both.by_order.has_value());
  EXPECT_EQ(both.by_order->Missing().cols(), 12);
  ExpectSameCovarianceAndDegreesOfFreedom(both);
}

TEST(OrderInverse, InvertsWhatTheReadingsThatAreLeftDetermine) {
  const BothInverses both = InvertBothWays(12, {0, 1, 4}, Layouts(12, Clamping::kReclamp), {5, 7, 19, 27});
  ASSERT_TRUE(both.by_order.has_value());
  const Eigen::MatrixXd normal = both.stops.Normal();
  // N G N = N is the definition.
  EXPECT_LT(Difference(normal * (*both.by_order * normal), normal), 1e-9);
}

TEST(OrderInverse, IsNoneWhereMuchIsMissingOrLeavesSomethingOpen) {
  const auto is_there = [](const std::vector<int>& shifts, const std::vector<std::size_t>& missing) {
    return InvertBothWays(12, shifts, Layouts(12, Clamping::kReseat), missing).by_order.has_value();
  };
  // Two set-ups close one ring of links; a stop that nobody visits opens it, one that is visited once less does
  // not.
  EXPECT_FALSE(is_there({0, 1}, {4, 16}));
  EXPECT_TRUE(is_there({0, 1}, {4}));
  EXPECT_FALSE(is_there({0, 1, 4}, {0, 12, 1, 13, 26, 38, 30, 42, 55, 67}));
}

}  // namespace
}  // namespace twinbench::separate
