#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/benches/rotary_4dof/estimators/prediction.h"
#include "twin/benches/rotary_4dof/estimators/residuals.h"

namespace twinbench::separate {
namespace {

class NoNoiseStated : public testing::TestWithParam<Clamping> {};
INSTANTIATE_TEST_SUITE_P(BothWays, NoNoiseStated, testing::Values(Clamping::kReclamp, Clamping::kReseat));

struct ExactCircles {
  Truth truth;
  std::vector<Motion> motions;
};

/// Exact readings that state no noise, of tables that move in all six components.
ExactCircles ExactRun(int n, const std::vector<int>& shifts, Clamping clamping) {
  Stream stream(31, "test.truth");
  ExactCircles run{RandomTruth(n, stream), EmptyMotions(n, shifts, 2, Matrix4::Constant(kNaN))};
  FillExact(run.motions, run.truth, Layouts(n, clamping), Bench());
  for (Motion& m : run.motions) m.covariance_known = false;
  return run;
}

/// rms of (estimate - truth) over rms of the stated uncertainty.
double ErrorOverU(const TableEstimate& estimate, Table table, const TableErrors& truth,
                  const std::vector<NotSeparable>& lost, Component c) {
  const TableErrors visible = RemoveNotSeparable(truth, table, lost);
  const std::vector<double> zero(visible[c].size(), 0.0);
  return RmsDifference(estimate.value[c], visible[c]) / RmsDifference(estimate.u[c], zero);
}

TEST_P(NoNoiseStated, LosesNoPositionThoughTheResidualsAreNothing) {
  const ExactCircles run = ExactRun(36, {0, 1, 7, 11}, GetParam());
  const Separation found = Separate(run.motions, Bench(), Options(36, GetParam()));
  for (const TableEstimate* table : {&found.target, &found.reference}) {
    for (const Component c : table->components) {
      for (const double v : table->value[c]) EXPECT_TRUE(std::isfinite(v));
    }
  }
  EXPECT_EQ(found.notes.size(), 1u) << "that the noise is not known, and nothing else";
}

TEST_P(NoNoiseStated, StatesAnUncertaintyOfTheSizeOfTheSecondOrderTerms) {
  const ExactCircles run = ExactRun(36, {0, 1, 7, 11}, GetParam());
  const Separation found = Separate(run.motions, Bench(), Options(36, GetParam()));
  for (const Table table : {Table::kTarget, Table::kReference}) {
    const TableEstimate& estimate = table == Table::kTarget ? found.target : found.reference;
    const TableErrors& truth = table == Table::kTarget ? run.truth.target : run.truth.reference;
    for (const Component c : estimate.components) {
      const double ratio = ErrorOverU(estimate, table, truth, found.not_separable, c);
      // A measure of size that knows nothing of the terms' pattern: a factor of three. Index errors have none.
      EXPECT_LT(ratio, 3.0) << TableName(table) << ' ' << kComponentNames[static_cast<std::size_t>(c)];
      EXPECT_GT(ratio, 0.02) << TableName(table) << ' ' << kComponentNames[static_cast<std::size_t>(c)];
    }
  }
}

TEST(SecondOrder, IsNothingBesideRealNoise) {
  Stream stream(32, "test.truth");
  auto motions = EmptyMotions(36, {0, 1, 7, 11}, 4, ReadingCovariance());
  FillExact(motions, RandomTruth(36, stream), Layouts(36, Clamping::kReseat), Bench());
  const Separation found = Separate(motions, Bench(), Options(36, Clamping::kReseat));
  for (const Component c : found.target.components) {
    const auto block = std::find(found.target.components.begin(), found.target.components.end(), c);
    const auto row = 36 * (block - found.target.components.begin());
    // (5 arcsec)^2 = 6e-10 rad beside 0.3 um / 0.23 m / sqrt(4 passes) = 5e-7 rad: a millionth of the variance.
    EXPECT_NEAR(found.target.u[c][0] / std::sqrt(found.target.cov(row, row)), 1.0, 1e-5);
  }
}

TEST(UnreadSecondOrder, IsTheSquareOfTheAnglesAndTheirProductsWithLengths) {
  const Design design = MakeDesign(12, {0, 1, 4}, Clamping::kReseat, Bench());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(design.Unknowns());
  for (int i = 0; i < 12; ++i) {
    for (const Series s : {Series::kTargetEx, Series::kTargetEy, Series::kTargetEz}) x[design.Column(s, i)] = 2e-5;
    for (const Series s : {Series::kTargetDy, Series::kRefDy}) x[design.Column(s, i)] = 3e-6 / kLengthUnit_m;
  }
  // Three of six angular series: a^2 = 2e-10 rad^2, l = 3 um, lever 0.130 m.
  const Vector4 u = UnreadSecondOrder(design, x);
  EXPECT_NEAR(u[0], 2e-10, 1e-20);  // rounding
  EXPECT_NEAR(u[3], 0.130 * 2e-10 + std::sqrt(2e-10) * 3e-6, 1e-20);
}

TEST(InvertNormal, FindsTheSameRankWhateverTheWeightsOfTheMotions) {
  const auto motions = EmptyMotions(36, {0, 1, 7, 11}, 1, ReadingCovariance());
  for (const Clamping clamping : {Clamping::kReclamp, Clamping::kReseat}) {
    const Layout layout = FindLayout(motions, Bench(), Layouts(36, clamping));
    const Eigen::MatrixXd null = NullSpace(layout.design, FindSeparability(layout.design).orders);
    for (const Vector4& scale : {Vector4(1, 1, 1, 1), Vector4(1, 1e-4, 1e-4, 1), Vector4(1e-4, 1, 1, 1e-4)}) {
      const Weights weights = CollectWeights(motions, layout, Bench(), scale);
      std::vector<StopModel> models;
      for (const Cell& cell : weights.cells) models.push_back(ModelStop(layout.design, cell.setup, cell.target));
      EXPECT_EQ(InvertNormal(layout.design, weights.cells, models, null).extra_null.cols(), 0) << scale.transpose();
    }
  }
}

TEST(InvertNormal, InvertsWhatTheReadingsDetermine) {
  auto motions = EmptyMotions(12, {0, 1, 4}, 1, ReadingCovariance());
  motions[5].status = motions[17].status = ReadingStatus::kMissing;
  const Layout layout = FindLayout(motions, Bench(), Layouts(12, Clamping::kReclamp));
  const Weights weights = CollectWeights(motions, layout, Bench(), Vector4::Ones());
  std::vector<StopModel> models;
  for (const Cell& cell : weights.cells) models.push_back(ModelStop(layout.design, cell.setup, cell.target));
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(layout.design.Unknowns(), layout.design.Unknowns());
  for (std::size_t k = 0; k < models.size(); ++k) {
    const std::vector<int> columns(models[k].column.begin(), models[k].column.begin() + models[k].columns);
    const Eigen::MatrixXd d = models[k].d.leftCols(models[k].columns);
    normal(columns, columns) += d.transpose() * weights.cells[k].weight * d;
  }
  const Eigen::MatrixXd null = NullSpace(layout.design, FindSeparability(layout.design).orders);
  const Eigen::MatrixXd inverse = InvertNormal(layout.design, weights.cells, models, null).inverse;
  // N G N = N is the definition; 1e-16 times the condition of these designs, 1e3.
  EXPECT_LT((normal * inverse * normal - normal).cwiseAbs().maxCoeff(), 1e-11 * normal.maxCoeff());
}

Separation WithScatter(const Vector4& ratio) {
  Separation result;
  result.dof_of.setConstant(100.0);
  result.dof = 400;
  result.chi2 = 100.0 * ratio.cwiseAbs2();
  result.second_order.setZero();
  return result;
}

TEST(AssumedNoiseScale, FollowsTheResidualsButNotBelowAHundredthOfTheLargest) {
  EXPECT_LT((AssumedNoiseScale(WithScatter({0.5, 2, 1, 0.1}), Bench()) - Vector4(0.5, 2, 1, 0.1)).norm(), 1e-14);
  EXPECT_LT((AssumedNoiseScale(WithScatter({1e-7, 2, 1, 1e-3}), Bench()) - Vector4(0.02, 2, 1, 0.02)).norm(),
            1e-14);  // rounding
}

TEST(AssumedNoiseScale, IsNotBelowTheSecondOrder) {
  Separation result = WithScatter(Vector4::Constant(1e-6));
  const Vector4 assumed = AssumedCovariance(Bench()).diagonal().cwiseSqrt();
  result.second_order = 0.01 * assumed;
  EXPECT_LT((AssumedNoiseScale(result, Bench()) - Vector4::Constant(0.01)).norm(), 1e-14);
}

TEST(Rescale, IsTheSameWithAndWithoutFactorisingAgain) {
  const auto motions = EmptyMotions(12, {0, 1, 4}, 2, ReadingCovariance());
  Separator at_once(motions, Bench(), Options(12, Clamping::kReclamp)), in_steps = at_once;
  at_once.Rescale(motions, Vector4::Constant(3.0));
  in_steps.Rescale(motions, {2, 6, 3, 1});
  in_steps.Rescale(motions, {1.5, 0.5, 1, 3});
  const Separation a = at_once.Separate(motions), b = in_steps.Separate(motions);
  EXPECT_EQ(a.scale, b.scale);
  const Eigen::MatrixXd cov = a.target.cov.ToDense();
  EXPECT_LT((cov - b.target.cov.ToDense()).cwiseAbs().maxCoeff(), 1e-10 * cov.maxCoeff());  // rounding
  EXPECT_LT((a.dof_of - b.dof_of).norm(), 1e-8);
}

}  // namespace
}  // namespace twinbench::separate
