#include "tests/separate/bench.h"
#include "twin/benches/rotary_4dof/estimators/order_inverse.h"
#include "twin/benches/rotary_4dof/estimators/separability.h"
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

using testing::ElementsAre;
constexpr int kAll = -999;

std::vector<NotSeparable> Lost(int n, const std::vector<int>& shifts, Clamping clamping) {
  return FindSeparability(MakeDesign(n, shifts, clamping, Bench())).lost;
}

TEST(FindSeparability, FindsVectorsThatChangeNoReading) {
  for (const Clamping clamping : {Clamping::kReclamp, Clamping::kReseat}) {
    for (const int n : {12, 15}) {
      const Design design = MakeDesign(n, {0, 3}, clamping, Bench());
      const Eigen::MatrixXd null = NullSpace(design, FindSeparability(design).orders);
      ASSERT_GT(null.cols(), 0);
      const auto identity = Eigen::MatrixXd::Identity(null.cols(), null.cols());
      EXPECT_LT((null.transpose() * null - identity).cwiseAbs().maxCoeff(), 1e-12);  // rounding
      for (int setup = 0; setup < 2; ++setup) {
        for (int target = 0; target < n; ++target) {
          const StopModel model = ModelStop(design, setup, target);
          Eigen::MatrixXd reading = Eigen::MatrixXd::Zero(4, null.cols());
          for (int c = 0; c < model.columns; ++c) reading += model.d.col(c) * null.row(model.column[c]);
          EXPECT_LT(reading.cwiseAbs().maxCoeff(), 1e-12);
        }
      }
    }
  }
}

std::vector<std::string> Texts(const std::vector<NotSeparable>& lost) {
  std::vector<std::string> texts;
  for (const NotSeparable& e : lost) texts.push_back(e.what);
  return texts;
}

TEST(FindSeparability, LosesTheDefinitionalOrdersWhatNobodyReadsAndTheLateralMotionOfAReseatedReference) {
  EXPECT_THAT(Texts(Lost(36, {0, 1, 7, 11}, Clamping::kReseat)),
              ElementsAre("target dx", "target dz", "reference dz", "reference dx", "target ex,ey order 0",
                          "target ex,ey order +1", "target ez order 0", "target dy order 0", "target dy order 1",
                          "reference ex,ey order 0", "reference ex,ey order -1", "reference ez order 0",
                          "reference dy order 0", "reference dy order 1"));
  EXPECT_THAT(Texts(Lost(36, {0, 1, 7, 11}, Clamping::kReclamp)),
              ElementsAre("target dx", "target dz", "reference dz", "target ex,ey order 0", "target ex,ey order +1",
                          "target ez order 0", "target dy order 0", "target dy order 1", "reference ex,ey order 0",
                          "reference ex,ey order -1", "reference ez order 0", "reference dx,dy order 0",
                          "reference dx,dy order -1"));
  for (const NotSeparable& e : Lost(12, {0, 1, 4}, Clamping::kReclamp)) EXPECT_FALSE(e.why.empty());
}

TEST(FindSeparability, LosesMultiplesOfTheOrderThatAllShiftsShareAndListsThoseOfOneReasonTogether) {
  // gcd(4, 12) = 4 steps: orders that repeat three times a turn look alike in all set-ups (section 2.2).
  const auto lost = Lost(12, {0, 4, 8}, Clamping::kReseat);
  EXPECT_THAT(LostOrders(lost, Table::kTarget, Component::kEz), ElementsAre(0, 3, 6));
  EXPECT_THAT(LostOrders(lost, Table::kReference, Component::kEz), ElementsAre(0, 3, 6));
  EXPECT_THAT(Texts(lost), testing::IsSupersetOf({"target ez order 0", "target ez orders 3, 6", "target ex,ey orders +3, -3, +6"}));
}

struct RankCase {
  const char* name;
  std::vector<int> shifts;  // n/4 and n/2 are written as -4 and -2
  Clamping clamping;
  bool solvable;
};

/// Ranks found by an independent study for the radial error of the target.
TEST(FindSeparability, AgreesWithTheRankTableForOneRadialComponent) {
  const std::vector<RankCase> cases = {
      {"A{0,1}", {0, 1}, Clamping::kReclamp, false},     {"B{0,1}", {0, 1}, Clamping::kReseat, true},
      {"B{0,1,4}", {0, 1, 4}, Clamping::kReseat, true},  {"A{0,1,n/4}", {0, 1, -4}, Clamping::kReclamp, true},
      {"A{0,1,2}", {0, 1, 2}, Clamping::kReclamp, true}, {"A{0,1,n/2}", {0, 1, -2}, Clamping::kReclamp, false}};
  for (const int n : {12, 36}) {
    for (const RankCase& c : cases) {
      std::vector<int> shifts = c.shifts;
      for (int& s : shifts) s = s < 0 ? n / -s : s;
      const auto orders = LostOrders(Lost(n, shifts, c.clamping), Table::kTarget, Component::kDy);
      const bool only_definitional = orders == std::vector<int>{0, 1};
      EXPECT_EQ(only_definitional, c.solvable) << c.name << " n=" << n;
    }
  }
}

TEST(FindSeparability, LosesEveryOrderOfTheRadialErrorWithTwoReclampedSetUps) {
  for (const int n : {12, 36}) {
    const auto lost = Lost(n, {0, 1}, Clamping::kReclamp);
    EXPECT_THAT(LostOrders(lost, Table::kTarget, Component::kDy), ElementsAre(kAll));
    EXPECT_THAT(LostOrders(lost, Table::kTarget, Component::kEx), ElementsAre(0, 1));  // the wobble is not touched
  }
}

TEST(FindSeparability, IsCuredByOneReseatedRun) {
  const auto motions = EmptyMotions(36, {0, 1, 1}, 1, Matrix4::Identity());
  const LayoutOptions options{36, Clamping::kReclamp, {{2, Clamping::kReseat}}};
  const auto lost = FindSeparability(FindLayout(motions, Bench(), options).design).lost;
  EXPECT_THAT(LostOrders(lost, Table::kTarget, Component::kDy), ElementsAre(0, 1));
}

TEST(RemoveNotSeparable, TakesTheLostOrdersAndLeavesTheOthers) {
  const int n = 12;
  const auto lost = Lost(n, {0, 1, 4}, Clamping::kReclamp);
  TableErrors e = ZeroErrors(n);
  for (std::size_t i = 0; i < 12; ++i) {
    const double a = e.position_rad[i];
    e[Component::kEx][i] = 1.0 + std::cos(a + 0.3) + std::cos(a);  // constant, forward and backward once per turn
    e[Component::kEy][i] = 2.0 + std::sin(a + 0.3) - std::sin(a);
  }
  const TableErrors left = RemoveNotSeparable(e, Table::kTarget, lost);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(left[Component::kEx][i], std::cos(e.position_rad[i]), 1e-14);  // rounding
    EXPECT_NEAR(left[Component::kEy][i], -std::sin(e.position_rad[i]), 1e-14);
    EXPECT_TRUE(std::isnan(left[Component::kDz][i]));
  }
}

}  // namespace
}  // namespace twinbench::separate
