#include "twin/benches/turntable_autocollimator/estimators/shift_fit.h"

#include <Eigen/Dense>
#include <numeric>

#include "twin/core/stream.h"

namespace twinbench::separate::turntable {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

struct FitCase {
  const char* name = "";
  int n = 0;
  std::vector<int> shifts = {}, rows = {};
  int readings = 1;      // of each stop
  double missing = 0.0;  // part of the readings
  std::vector<int> unread = {};  // positions
};

StopGrid GridOf(const FitCase& c) {
  StopGrid grid;
  grid.n = c.n;
  const std::set<int> rows(c.rows.begin(), c.rows.end());
  for (std::size_t r = 0; r < rows.size(); ++r) grid.row_offset_rad.push_back(0.01 * static_cast<double>(r));
  Stream random(3, c.name);
  for (std::size_t s = 0; s < c.shifts.size(); ++s) {
    grid.setups.push_back({static_cast<int>(s), c.rows[s], c.shifts[s]});
    for (int i = 0; i < c.n; ++i) {
      const bool unread = std::ranges::count(c.unread, i) > 0;
      for (int k = 0; k < c.readings; ++k) {
        if (unread || random.Uniform() < c.missing) continue;
        const int tooth = ((c.shifts[s] - i) % c.n + c.n) % c.n;
        grid.stops.push_back({grid.stops.size(), static_cast<int>(s), i, c.rows[s] * c.n + tooth});
      }
    }
  }
  return grid;
}

/// The whole problem as one matrix of all unknowns that were read, least squares within the choices by a basis of
/// their null space: nothing here knows of harmonics.
class DenseFit {
 public:
  explicit DenseFit(const StopGrid& grid) {
    const int teeth = grid.n * static_cast<int>(grid.row_offset_rad.size()), rows = teeth / grid.n;
    const int all = grid.n + teeth + static_cast<int>(grid.setups.size()), common = Common(grid);
    MatrixXd design = MatrixXd::Zero(std::ssize(grid.stops), all), choices = MatrixXd::Zero(1 + rows + common, all);
    for (std::size_t k = 0; k < grid.stops.size(); ++k) {
      const GridStop& stop = grid.stops[k];
      const Eigen::Index row = static_cast<Eigen::Index>(k), tooth = grid.n + stop.tooth;
      design(row, stop.position) = design(row, tooth) = design(row, grid.n + teeth + stop.setup) = 1.0;
      choices(0, stop.position) = choices(1 + stop.tooth / grid.n, tooth) = 1.0;
      choices(1 + rows + stop.position % common, tooth) = 1.0;
    }
    std::vector<Eigen::Index> seen;
    for (Eigen::Index u = 0; u < all; ++u) {
      if (design.col(u).norm() == 0.0) continue;
      seen.push_back(u);
      if (u < grid.n + teeth) unknowns.push_back(static_cast<int>(u));
    }
    design_ = design(Eigen::all, seen);
    const Eigen::FullPivLU<MatrixXd> lu(MatrixXd(choices(Eigen::all, seen)));
    const MatrixXd within = lu.kernel();
    const MatrixXd reduced = design_ * within;
    determined = Eigen::FullPivLU<MatrixXd>(reduced.transpose() * reduced).rank() == within.cols();
    const MatrixXd inverse = (reduced.transpose() * reduced).inverse();
    cofactor = within * inverse * within.transpose();
    dof = static_cast<double>(design_.rows() - within.cols());
  }
  VectorXd Solve(const VectorXd& values) const { return cofactor * (design_.transpose() * values); }
  VectorXd Residuals(const VectorXd& values) const { return values - design_ * Solve(values); }

  std::vector<int> unknowns;  // of T and R that were read
  MatrixXd cofactor;
  double dof = 0.0;
  bool determined = false;

 private:
  static int Common(const StopGrid& grid) {
    int common = grid.n;
    for (const SetUp& a : grid.setups) {
      for (const SetUp& b : grid.setups) common = a.row == b.row ? std::gcd(common, a.shift - b.shift) : common;
    }
    return common;
  }
  MatrixXd design_;
};

VectorXd Values(Eigen::Index count) {
  Stream random(4, "test.shift_fit");
  VectorXd values(count);
  for (double& v : values) v = random.Normal();
  return values;
}

class ShiftFitAgainstDense : public testing::TestWithParam<FitCase> {};
INSTANTIATE_TEST_SUITE_P(
    Cases, ShiftFitAgainstDense,
    testing::Values(FitCase{"complete", 12, {0, 1, 5}, {0, 0, 0}}, FitCase{"lost_orders", 12, {0, 4, 6}, {0, 0, 0}, 2},
                    FitCase{"missing", 15, {0, 1, 5, 8}, {0, 0, 0, 0}, 2, 0.1},
                    FitCase{"prime", 67, {3, -1, 75, 75}, {0, 0, 0, 0}, 2, 0.05},
                    FitCase{"unread_position", 14, {0, 1, 5, 9}, {0, 0, 0, 0}, 1, 0.0, {3, 4}},
                    FitCase{"one_shift_and_unread", 9, {2, 2}, {0, 0}, 1, 0.0, {4}},
                    FitCase{"rows", 12, {0, 1, 3, 8}, {0, 0, 1, 1}, 2, 0.05},
                    FitCase{"rows_and_lost_orders", 12, {0, 4, 3, 6}, {0, 0, 1, 2}, 1},
                    FitCase{"rows_missing_and_lost_orders", 12, {0, 4, 8, 2, 3}, {0, 0, 0, 0, 1}, 2, 0.08}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(ShiftFitAgainstDense, HasTheSameUnknownsResidualsAndCovariance) {
  const StopGrid grid = GridOf(GetParam());
  const ShiftFit fit(grid);
  const DenseFit dense(grid);
  ASSERT_TRUE(dense.determined);
  ASSERT_TRUE(fit.determined());
  EXPECT_EQ(fit.dof(), dense.dof);
  const VectorXd values = Values(std::ssize(grid.stops));
  const auto read = std::ssize(dense.unknowns);
  const VectorXd found = fit.Solve(values);
  // Rounding, here and below.
  EXPECT_LT((found(dense.unknowns) - dense.Solve(values).head(read)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((fit.Residuals(values) - dense.Residuals(values)).cwiseAbs().maxCoeff(), 1e-11);
  for (const bool of_teeth : {false, true}) {
    std::vector<int> unknowns;
    std::vector<Eigen::Index> rows;
    for (std::size_t k = 0; k < dense.unknowns.size(); ++k) {
      if ((dense.unknowns[k] >= grid.n) != of_teeth) continue;
      unknowns.push_back(dense.unknowns[k]);
      rows.push_back(static_cast<Eigen::Index>(k));
    }
    const MatrixXd expected = dense.cofactor(rows, rows);
    const CurveCovariance cofactor = fit.Cofactor(unknowns);
    EXPECT_LT((cofactor.ToDense() - expected).cwiseAbs().maxCoeff(), 1e-11) << of_teeth;
    const MatrixXd columns = Values(3 * std::ssize(unknowns)).reshaped(std::ssize(unknowns), 3);
    EXPECT_LT((cofactor.Times(columns) - expected * columns).cwiseAbs().maxCoeff(), 1e-11) << of_teeth;
  }
}

TEST(ShiftFit, HearsNothingFromASetUpThatWasReadOnce) {
  StopGrid with = GridOf({"four", 12, {0, 1, 5, 7}, {0, 0, 0, 0}});
  with.stops.resize(37);
  StopGrid without = with;
  without.stops.pop_back();
  without.setups.pop_back();
  const VectorXd values = Values(37);
  EXPECT_LT((ShiftFit(with).Solve(values) - ShiftFit(without).Solve(values.head(36))).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShiftFit, BearsAStopThatWasReadOnceMoreThanThousandsOfOthers) {
  const FitCase fine{"fine", 2000, {0, 1, 59, 700}, {0, 0, 0, 0}};
  StopGrid grid = GridOf(fine);
  grid.stops.push_back(grid.stops.front());
  const ShiftFit fit(grid);
  std::vector<int> positions(2000);
  for (int i = 0; i < 2000; ++i) positions[static_cast<std::size_t>(i)] = i;
  const VectorXd variance = fit.Cofactor(positions).diagonal();
  // At the position read five times in place of four the noise is smaller, far from it as if nothing had happened.
  const double common = ShiftFit(GridOf(fine)).Cofactor(positions).diagonal()[1000];
  EXPECT_LT(variance[0], 0.97 * common);
  EXPECT_NEAR(variance[1000] / common, 1.0, 1e-3);
}

}  // namespace
}  // namespace twinbench::separate::turntable
