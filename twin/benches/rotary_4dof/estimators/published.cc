#include "twin/benches/rotary_4dof/estimators/published.h"

#include <cmath>
#include <utility>

#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

/// One of the two full circles by the paper's stop number: mean motion of all passes, [ez, ex, ey, dy].
struct Test {
  Eigen::MatrixXd mean;      // n x 4
  Eigen::MatrixXd variance;  // n x 4, of the mean
};

/// The paper's target turns clockwise.
int PaperStop(int target, int n) {
  return (n - target) % n;
}

Test MeanTest(const std::vector<Motion>& motions, const Layout& layout, int setup) {
  const int n = layout.design.n;
  Test test{Eigen::MatrixXd::Zero(n, 4), Eigen::MatrixXd::Zero(n, 4)};
  Eigen::VectorXd count = Eigen::VectorXd::Zero(n);
  for (const Sample& sample : layout.samples) {
    if (sample.setup != setup) continue;
    const int i = PaperStop(sample.target, n);
    test.mean.row(i) += motions[sample.motion].Values();
    test.variance.row(i) += motions[sample.motion].cov.diagonal();
    ++count[i];
  }
  for (int i = 0; i < n; ++i) {  // 0 / 0 is NaN: a stop without a reading
    test.mean.row(i) /= count[i];
    test.variance.row(i) /= count[i] * count[i];
  }
  test.mean.rowwise() -= test.mean.colwise().mean();
  return test;
}

/// Test 1 is the set-up from which the other is one step on in the reference's sense of travel.
std::pair<int, int> FindTests(const Design& design) {
  for (std::size_t b = 1; b < design.setups.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const int difference = (design.setups[b].shift - design.setups[a].shift + design.n) % design.n;
      if (difference == 1) return {static_cast<int>(a), static_cast<int>(b)};
      if (difference == design.n - 1) return {static_cast<int>(b), static_cast<int>(a)};
    }
  }
  throw InputError("readings", "no two mountings differ by one step", "the two tests of the published method");
}

/// Values of one sector from those at its two ends, all around.
Eigen::MatrixXd SectorMatrix(int n) {
  Eigen::MatrixXd D = -Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) D(i, (i + 1) % n) += 1.0;
  return D;
}

Eigen::MatrixXd Centring(Eigen::Index n) {
  return Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
}

/// Adds sectors up to positions of zero mean.
Eigen::MatrixXd SummingMatrix(int n) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (int i = 1; i < n; ++i) sum.row(i).head(i).setOnes();
  return Centring(n) * sum;
}

/// The linear map from the stacked readings [m1; m2] to [t; r], mean-free, for position values or by way of
/// sectors.
Eigen::MatrixXd ReadingsToErrors(int n, bool sectors) {
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n), Zero = Eigen::MatrixXd::Zero(n, n);
  const Eigen::MatrixXd in = sectors ? SectorMatrix(n) : Centring(n);
  const Eigen::MatrixXd out = sectors ? SummingMatrix(n) : Centring(n);
  Eigen::MatrixXd test_1(n, 2 * n), test_2(n, 2 * n);
  test_1 << in, Zero;
  test_2 << Zero, in;
  const Eigen::MatrixXd solved = SolvePublished(test_1, test_2);
  Eigen::MatrixXd map(2 * n, 2 * n);
  map << out * solved.topRows(n), out * solved.bottomRows(n);
  return map;
}

TableEstimate EmptyEstimate(const Design& design, Table table) {
  TableEstimate estimate;
  for (int i = 0; i < design.n; ++i) {
    const double angle_rad = table == Table::kTarget ? design.TargetAngle_rad(i) : design.ReferenceAngle_rad(i);
    estimate.value.position_rad.push_back(angle_rad);
  }
  for (auto& column : estimate.value.value) column.assign(static_cast<std::size_t>(design.n), kNaN);
  estimate.u = estimate.value;
  estimate.components = {Component::kEx, Component::kEy, Component::kEz, Component::kDy};
  estimate.cov_systematic = CurveCovariance::Dense(Eigen::MatrixXd::Zero(4 * design.n, 4 * design.n));
  return estimate;
}

std::size_t BlockOf(const TableEstimate& estimate, Component component) {
  const auto& all = estimate.components;
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), component) - all.begin());
}

/// Puts stop-ordered values and their covariance where the table's own angle ascends.
/// @param whole  Covariance of all of the table's components.
void Place(const Eigen::VectorXd& value, const Eigen::MatrixXd& cov, const std::vector<int>& place,
           Component component, TableEstimate& estimate, Eigen::MatrixXd& whole) {
  const auto n = static_cast<int>(place.size());
  const int first = n * static_cast<int>(BlockOf(estimate, component));
  for (int i = 0; i < n; ++i) {
    const auto to = static_cast<std::size_t>(place[static_cast<std::size_t>(i)]);
    estimate.value[component][to] = value[i];
    estimate.u[component][to] = std::sqrt(cov(i, i));
    for (int k = 0; k < n; ++k) {
      whole(first + static_cast<int>(to), first + place[static_cast<std::size_t>(k)]) = cov(i, k);
    }
  }
}

/// Where the paper's stop i lies on each table: reference stop i is the one that test 1 pairs with target stop i.
struct Places {
  std::vector<int> target;
  std::vector<int> reference;
};

Places FindPlaces(const Design& design, int test_1) {
  Places places;
  for (int i = 0; i < design.n; ++i) {
    places.target.push_back(PaperStop(i, design.n));
    places.reference.push_back(
        design.ReferencePosition(design.setups[static_cast<std::size_t>(test_1)], places.target.back()));
  }
  return places;
}

/// Constants are lost in both tables, and so is whatever nobody reads. The method itself believes no more is lost.
std::vector<NotSeparable> PublishedLosses() {
  const char* not_read = "no detector of the bench reads this direction";
  const char* constant = "a constant of a table looks like the constants of the mountings";
  std::vector<NotSeparable> lost;
  for (const Table table : {Table::kTarget, Table::kReference}) {
    const std::string name = TableName(table);
    lost.push_back({table, {Component::kDx}, {}, true, name + " dx", not_read});
    lost.push_back({table, {Component::kDz}, {}, true, name + " dz", not_read});
    lost.push_back({table, {Component::kEx, Component::kEy}, {0}, false, name + " ex,ey order 0", constant});
    lost.push_back({table, {Component::kEz}, {0}, false, name + " ez order 0", constant});
    lost.push_back({table, {Component::kDy}, {0}, false, name + " dy order 0", constant});
  }
  return lost;
}

/// What the two-test solution leaves of the readings: nothing but the closing difference of the dropped row.
void AddResiduals(const Eigen::MatrixXd& errors, const Test& test_1, const Test& test_2, int d,
                  Separation& result) {
  const Eigen::Index n = test_1.mean.rows();
  double squares = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    squares += std::pow(errors(i, 0) + errors(n + i, 0) - test_1.mean(i, d), 2);
    squares += std::pow(errors(i, 0) + errors(n + (i + 1) % n, 0) - test_2.mean(i, d), 2);
  }
  result.residual_rms[d] = std::sqrt(squares / (2.0 * static_cast<double>(n)));
}

}  // namespace

Separation SeparatePublished(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                             const LayoutOptions& options) {
  const Layout layout = FindLayout(motions, geometry, options);
  const auto tests = FindTests(layout.design);
  const Test test_1 = MeanTest(motions, layout, tests.first), test_2 = MeanTest(motions, layout, tests.second);
  const Places places = FindPlaces(layout.design, tests.first);
  Separation result;
  result.target = EmptyEstimate(layout.design, Table::kTarget);
  result.reference = EmptyEstimate(layout.design, Table::kReference);
  result.not_separable = PublishedLosses();
  result.readings = static_cast<int>(layout.samples.size());
  result.residuals.assign(motions.size(), Vector4::Constant(kNaN));
  const int n = layout.design.n;
  Eigen::MatrixXd cov_target = Eigen::MatrixXd::Zero(4 * n, 4 * n), cov_reference = cov_target;
  for (int d = 0; d < measure::kDofs; ++d) {
    const Eigen::MatrixXd map = ReadingsToErrors(n, d == 0);
    Eigen::VectorXd readings(2 * n), variance(2 * n);
    readings << test_1.mean.col(d), test_2.mean.col(d);
    variance << test_1.variance.col(d), test_2.variance.col(d);
    const Eigen::VectorXd errors = map * readings;
    const Eigen::MatrixXd cov = map * variance.asDiagonal() * map.transpose();
    const Component c = kComponentOf[static_cast<std::size_t>(d)];
    Place(errors.head(n), cov.topLeftCorner(n, n), places.target, c, result.target, cov_target);
    Place(errors.tail(n), cov.bottomRightCorner(n, n), places.reference, c, result.reference, cov_reference);
    AddResiduals(errors, test_1, test_2, d, result);
  }
  result.target.cov = CurveCovariance::Dense(std::move(cov_target));
  result.reference.cov = CurveCovariance::Dense(std::move(cov_reference));
  if (layout.design.setups.size() > 2) result.notes.push_back("published method: only two of the mountings are used");
  return result;
}

}  // namespace twinbench::separate
