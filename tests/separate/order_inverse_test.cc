#include "twin/benches/rotary_4dof/estimators/order_inverse.h"

#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/benches/rotary_4dof/estimators/residuals.h"
#include "twin/benches/rotary_4dof/estimators/table_part.h"

namespace twinbench::separate {
namespace {

/// One design of complete circles, inverted as one matrix and order by order.
struct BothInverses {
  Layout layout;
  Separability separability;
  Weights weights;
  std::vector<StopModel> models;
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
  BothInverses both;
  both.layout = FindLayout(motions, Bench(), options);
  both.separability = FindSeparability(both.layout.design);
  both.weights = CollectWeights(motions, both.layout, Bench(), Vector4::Ones());
  for (const Cell& cell : both.weights.cells) {
    both.models.push_back(ModelStop(both.layout.design, cell.setup, cell.target));
  }
  const Eigen::MatrixXd null = NullSpace(both.layout.design, both.separability.orders);
  both.whole = InvertNormal(both.layout.design, both.weights.cells, both.models, null);
  both.by_order = OrderInverse::Of(both.layout.design, both.separability.orders, both.weights.cells);
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
  return {{12, {0, 1, 4}, Layouts(12, Clamping::kReseat)},
          {12, {0, 1, 4, 6}, Layouts(12, Clamping::kReclamp)},
          {15, {0, 1, 4, 6}, mixed},
          {12, {0, 1}, Layouts(12, Clamping::kReclamp)},
          {12, {0, 2, 8}, Layouts(12, Clamping::kReseat)},
          {36, {0, 1, 7, 11}, Layouts(36, Clamping::kReseat)}};
}

TEST(OrderInverse, IsTheInverseOfTheWholeMatrix) {
  for (const Circles& c : CircleDesigns()) {
    const BothInverses both = InvertBothWays(c.n, c.shifts, c.options);
    ASSERT_TRUE(both.by_order.has_value());
    const Eigen::Index unknowns = both.whole.inverse.rows();
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(unknowns, unknowns);
    // 1e-16 times the condition of these designs, up to 1e5; the same choices where no reading decides.
    EXPECT_LT(Difference(*both.by_order * unit, both.whole.inverse), 1e-9) << c.n << ' ' << c.shifts.size();
  }
}

TEST(OrderInverse, GivesTheSameCovarianceToBothTables) {
  for (const Circles& c : CircleDesigns()) {
    const BothInverses both = InvertBothWays(c.n, c.shifts, c.options);
    for (const Table table : {Table::kTarget, Table::kReference}) {
      const TablePart whole = MakeTablePart(both.layout.design, table, both.separability.lost, both.whole);
      const TablePart by_order = MakeTablePart(both.layout.design, table, both.separability.lost, *both.by_order);
      ASSERT_EQ(whole.columns, by_order.columns);
      EXPECT_EQ(by_order.usable, whole.usable);
      EXPECT_LT(Difference(by_order.cov.ToDense(), whole.cov.ToDense()), 1e-9) << c.n << ' ' << TableName(table);
    }
  }
}

TEST(OrderInverse, LeavesTheSameDegreesOfFreedom) {
  for (const Circles& c : CircleDesigns()) {
    const BothInverses both = InvertBothWays(c.n, c.shifts, c.options);
    const Vector4 whole = DegreesOfFreedom(both.weights, both.models, both.whole);
    EXPECT_LT((DegreesOfFreedom(both.weights, both.models, *both.by_order) - whole).norm(), 1e-8) << c.n;
  }
}

TEST(OrderInverse, TakesOutWhatIsMissing) {
  // One pass of stop 5 and both of stop 7 of the first set-up, one of stop 3 of the second; n = 12, two passes
  // each.
  const BothInverses both = InvertBothWays(12, {0, 1, 4}, Layouts(12, Clamping::kReseat), {5, 7, 19, 27});
  ASSERT_TRUE(both.by_order.has_value());
  EXPECT_EQ(both.by_order->Missing().cols(), 12);
  const Vector4 dof = DegreesOfFreedom(both.weights, both.models, both.whole);
  EXPECT_LT((DegreesOfFreedom(both.weights, both.models, *both.by_order) - dof).norm(), 1e-8);
  for (const Table table : {Table::kTarget, Table::kReference}) {
    const TablePart whole = MakeTablePart(both.layout.design, table, both.separability.lost, both.whole);
    const TablePart by_order = MakeTablePart(both.layout.design, table, both.separability.lost, *both.by_order);
    EXPECT_EQ(by_order.usable, whole.usable);
    EXPECT_LT(Difference(by_order.cov.ToDense(), whole.cov.ToDense()), 1e-9) << TableName(table);
  }
}

TEST(OrderInverse, InvertsWhatTheReadingsThatAreLeftDetermine) {
  const BothInverses both = InvertBothWays(12, {0, 1, 4}, Layouts(12, Clamping::kReclamp), {5, 7, 19, 27});
  ASSERT_TRUE(both.by_order.has_value());
  const Eigen::Index unknowns = both.whole.inverse.rows();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (std::size_t k = 0; k < both.models.size(); ++k) {
    const StopModel& m = both.models[k];
    const std::vector<int> columns(m.column.begin(), m.column.begin() + m.columns);
    const Eigen::MatrixXd d = m.d.leftCols(m.columns);
    normal(columns, columns) += d.transpose() * both.weights.cells[k].weight * d;
  }
  // N G N = N is the definition.
  EXPECT_LT(Difference(normal * (*both.by_order * normal), normal), 1e-9);
}

TEST(OrderInverse, IsNoneWhereWhatIsMissingLeavesSomethingOpen) {
  // Two set-ups close one ring of links; a stop that nobody visits opens it, one that is visited once less does
  // not.
  EXPECT_FALSE(InvertBothWays(12, {0, 1}, Layouts(12, Clamping::kReseat), {4, 16}).by_order.has_value());
  EXPECT_TRUE(InvertBothWays(12, {0, 1}, Layouts(12, Clamping::kReseat), {4}).by_order.has_value());
}

TEST(OrderInverse, IsNoneWhereMuchIsMissing) {
  EXPECT_FALSE(InvertBothWays(12, {0, 1, 4}, Layouts(12, Clamping::kReseat), {0, 12, 1, 13, 26, 38, 30, 42, 55, 67})
                   .by_order.has_value());
}

TEST(CurveCovariance, HoldsLagsProductsAndVariances) {
  Eigen::MatrixXd lags(3, 4);  // two curves at three positions
  lags << 4.0, 0.5, 0.5, 6.0,  //
      1.0, 0.2, 0.3, 2.0,      //
      1.0, 0.3, 0.2, 2.0;
  CurveCovariance cov = CurveCovariance::Circulant(lags, 2) * 4.0;
  EXPECT_EQ(cov(0, 1), 4.0);
  EXPECT_EQ(cov(1, 5), 4.0 * 0.2);  // curve 0 at 1, curve 1 at 2
  EXPECT_EQ(cov(5, 1), cov(1, 5));
  cov.AddProduct(Eigen::VectorXd::LinSpaced(6, 1.0, 6.0));
  cov.AddVariance(2, 7.0);
  EXPECT_EQ(cov(2, 2), 16.0 + 9.0 + 7.0);
  EXPECT_EQ((cov * 4.0)(0, 1), 4.0 * (4.0 + 2.0));
  EXPECT_EQ(cov.diagonal(), cov.ToDense().diagonal());
  EXPECT_EQ(cov.ToDense(), cov.ToDense().transpose());
}

}  // namespace
}  // namespace twinbench::separate
