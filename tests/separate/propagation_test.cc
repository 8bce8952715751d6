#include "tests/separate/bench.h"
#include "tests/separate/shift_formulas.h"
#include "tests/support/night.h"
#include "twin/benches/rotary_4dof/estimators/harmonic_u.h"
#include "twin/benches/rotary_4dof/estimators/prediction.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

constexpr double kSigma_rad = 1e-6;

/// Equal, independent noise on ez, ex, ey [rad] and, in units of 1 m, on dy.
Matrix4 EqualNoise() { return kSigma_rad * kSigma_rad * Matrix4::Identity(); }

TableEstimate TargetOf(int n, const std::vector<int>& shifts, Clamping clamping, const BenchGeometry& geometry = Bench()) {
  const auto motions = EmptyMotions(n, shifts, 1, EqualNoise());
  return Separator(motions, geometry, Options(n, clamping)).Separate(motions).target;
}

Eigen::MatrixXd BlockOf(const TableEstimate& estimate, Component component, int n) {
  const auto found = std::find(estimate.components.begin(), estimate.components.end(), component);
  const auto first = n * (found - estimate.components.begin());
  return estimate.cov.ToDense().block(first, first, n, n);
}

TEST(Separator, PropagatesTheNoiseOfEzAsTheClosedFormAndTheShiftTablesSay) {
  const std::tuple<int, std::vector<int>, double> tabled[] = {
      {12, {0, 1}, 1.409},        {36, {0, 1}, 2.449},           {72, {0, 1}, 3.464},
      {12, {0, 1, 4}, 0.674},     {12, {0, 1, 4, 6}, 0.531},     {36, {0, 1, 6}, 0.781},
      {36, {0, 1, 7, 11}, 0.579}, {36, {0, 1, 9, 11, 15}, 0.491}};
  for (const Clamping clamping : {Clamping::kReclamp, Clamping::kReseat}) {
    for (const auto& [n, shifts, gain] : tabled) {
      const Eigen::MatrixXd cov =
          BlockOf(TargetOf(n, shifts, clamping), Component::kEz, n) / (kSigma_rad * kSigma_rad);
      for (int k = 1; k < n; ++k)
        EXPECT_NEAR(HarmonicVariance(cov, k) / ShiftVariance(n, shifts, k), 1.0, 1e-6)
            << k;  // asked for by the task
      EXPECT_LT(HarmonicVariance(cov, 0), 1e-12 * ShiftVariance(n, shifts, 1));               // zero mean
      EXPECT_NEAR(RootMeanGain(cov, 1.0), gain, 6e-4) << n;  // three printed digits
    }
  }
}

TEST(Separator, HasTheNoiseGainsOfOneRadialComponent) {
  // Noise gains of an independent study, without levers; two digits are printed.
  const std::tuple<int, std::vector<int>, Clamping, double> printed[] = {
      {12, {0, 1}, Clamping::kReseat, 0.86},    {36, {0, 1}, Clamping::kReseat, 1.53},
      {12, {0, 1, 4}, Clamping::kReseat, 0.60}, {36, {0, 1, 9}, Clamping::kReclamp, 1.46},
      {36, {0, 1, 2}, Clamping::kReclamp, 7.0}, {36, {0, 1, 4, 12}, Clamping::kReclamp, 0.69}};
  for (const auto& [n, shifts, clamping, gain] : printed) {
    const Eigen::MatrixXd cov = BlockOf(TargetOf(n, shifts, clamping, FlatBench()), Component::kDy, n);
    EXPECT_NEAR(RootMeanGain(cov, kSigma_rad), gain, gain > 2 ? 0.06 : 0.006) << n;
  }
}

TEST(HarmonicUncertainties, AreThoseOfTheClosedFormOfTheShiftsAndNotKnownOfAComponentThatIsNotDetermined) {
  const std::vector<double> u = HarmonicUncertainties(TargetOf(12, {0, 1, 4}, Clamping::kReseat), Component::kEz);
  ASSERT_EQ(u.size(), 6u);
  for (int k = 1; k < 6; ++k) {
    const double expected = kSigma_rad * std::sqrt(2.0 * ShiftVariance(12, std::vector{0, 1, 4}, k));
    EXPECT_NEAR(u[static_cast<std::size_t>(k) - 1], expected, 1e-3 * expected) << k;
  }
  for (const double none : HarmonicUncertainties(TargetOf(12, {0, 1}, Clamping::kReclamp), Component::kDy))
    EXPECT_TRUE(std::isnan(none));
}

TEST(Separator, UsesTheRankForItsDegreesOfFreedom) {
  const auto motions = EmptyMotions(12, {0, 1, 4}, 2, EqualNoise());
  const Separator separator(motions, Bench(), Options(12, Clamping::kReclamp));
  const int rank = separator.design().Unknowns() -
                   static_cast<int>(NullSpace(separator.design(), separator.separability().orders).cols());
  const Separation found = separator.Separate(motions);
  EXPECT_EQ(found.dof, 4 * 72 - rank);
  EXPECT_NEAR(found.dof_of.sum(), found.dof, 1e-6);  // rounding of traces
}

TEST(Separator, CarriesTheCalibrationIntoASystematicPart) {
  auto motions = ReadExactly(12, {0, 1, 4}, Clamping::kReseat).motions;
  for (Motion& m : motions) m.d_calibration.col(0) = -m.Values();  // one gain that scales all four motions
  SeparateOptions options = Options(12, Clamping::kReseat);
  options.cov_calibration(0, 0) = 0.01 * 0.01;
  const Separation found = Separate(motions, Bench(), options);
  for (int i = 0; i < 12; ++i) {
    // 1 % of the value itself (second order: 1e-4 of it and of its neighbours).
    EXPECT_NEAR(std::sqrt(found.target.cov_systematic(i, i)),
                0.01 * std::abs(found.target.value[Component::kEx][static_cast<std::size_t>(i)]), 1e-9);
  }
}

void AddNoise(std::vector<Motion>& motions, const Matrix4& cov, Stream& stream) {
  const Vector4 sd = cov.diagonal().cwiseSqrt();
  for (Motion& m : motions) {
    Vector4 z;
    for (int d = 0; d < 4; ++d) z[d] = stream.Normal();
    m.SetValues(m.Values() + sd.cwiseProduct(z));
  }
}

TEST(Separate, ScalesUncertaintiesWhenTheResidualsExceedTheStatedNoise) {
  Stream stream(22, "test.noise");
  auto motions = EmptyMotions(12, {0, 1, 4}, 2, ReadingCovariance());
  const Vector4 factor(1.0, 3.0, 1.0, 1.0);
  AddNoise(motions, Matrix4(factor.asDiagonal() * ReadingCovariance() * factor.asDiagonal()), stream);
  const Separation found = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_NEAR(found.scale[1], 3.0, 0.9);  // about 20 degrees of freedom: 16 % standard deviation
  EXPECT_EQ(found.scale[0], 1.0);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("ex"), std::string::npos);
}

TEST(Separate, TakesTheResidualScatterWhenNoNoiseIsStated) {
  Stream stream(23, "test.noise");
  auto motions = EmptyMotions(12, {0, 1, 4}, 4, ReadingCovariance());
  const Separation stated = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  AddNoise(motions, ReadingCovariance(), stream);
  for (Motion& m : motions) {
    m.covariance_known = false;
    m.cov.setConstant(kNaN);
  }
  const Separation found = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  for (const Component c : found.target.components) {
    // More than 90 degrees of freedom a motion: 8 % standard deviation, three of them.
    EXPECT_NEAR(found.target.u[c][3] / stated.target.u[c][3], 1.0, 0.25);
  }
}

struct ChangedTable {
  int n, passes, highest;  // orders by which the table's ez differs from set-up to set-up; 0: from stop to stop
  double times_noise;
};

TEST(Separate, ScalesByWhatAllPassesOfASetUpRepeat) {
  const int seeds = test::ByNight(60, 12);
  const double noise_rad = std::sqrt(ReadingCovariance()(0, 0));
  for (const ChangedTable& c : {ChangedTable{12, 2, 0, 3.0}, {24, 4, 3, 2.0}, {24, 4, 0, 0.5}, {36, 8, 5, 1.0}, {24, 4, 0, 0.0}}) {
    double chi2 = 0.0;
    for (int seed = 0; seed < seeds; ++seed) {
      Stream stream(static_cast<std::uint64_t>(seed), "test.noise");
      auto motions = EmptyMotions(c.n, {0, 1, 5, 7}, c.passes, ReadingCovariance());
      AddNoise(motions, ReadingCovariance(), stream);
      for (int setup = 0; setup < 4; ++setup) {
        Eigen::VectorXd change = Eigen::VectorXd::Zero(c.n);
        for (int i = 0; i < c.n && c.highest == 0; ++i) change[i] = stream.Normal();
        for (int k = 1; k <= c.highest; ++k) {
          const double cosine = stream.Normal() / std::sqrt(c.highest), sine = stream.Normal() / std::sqrt(c.highest);
          for (int i = 0; i < c.n; ++i)
            change[i] += cosine * std::cos(units::turn * k * i / c.n) + sine * std::sin(units::turn * k * i / c.n);
        }
        for (Motion& m : motions) m.ez_rad += m.setup == setup ? c.times_noise * noise_rad * change[m.position] : 0.0;
      }
      const Separation found = Separate(motions, Bench(), Options(c.n, Clamping::kReseat));
      for (std::size_t i = 0; i < static_cast<std::size_t>(c.n); ++i)
        chi2 += std::pow(found.target.value[Component::kEz][i] / found.target.u[Component::kEz][i], 2) / (c.n * seeds);
    }
    EXPECT_GT(chi2, 0.5) << c.n << ", " << c.passes << ", " << c.highest;
    EXPECT_LT(chi2, 2.0) << c.n << ", " << c.passes << ", " << c.highest;
  }
}

void Lose(Motion& m, ReadingStatus status) {
  m.status = status;
  m.SetValues(Vector4::Constant(kNaN));
}

void ExpectTruth(const Separation& found, const ExactCircles& c) {
  const auto tables = test::BothTables(found, c.truth);
  for (const test::SeparatedTable& t : tables) {
    // The chain's dz and the unseen dx enter in second order: 3 um / 0.1 m * 5 arcsec = 1e-4 arcsec, amplified
    // by 30.
    for (const Component k : {Component::kEx, Component::kEy, Component::kEz})
      EXPECT_LT(t.RmsError(k), 0.005 * units::arcsec) << t.Name(k);
  }
  EXPECT_LT(tables[0].RmsError(Component::kDy), 0.005 * units::um);
}

TEST(Separate, DoesWithoutSomeReadings) {
  ExactCircles c = ReadExactly(36, {0, 1, 7, 11}, Clamping::kReclamp);
  for (const std::size_t i : {3u, 40u, 41u, 75u, 100u, 143u}) Lose(c.motions[i], ReadingStatus::kSaturated);
  const Separation found = Separate(c.motions, Bench(), Options(36, Clamping::kReclamp));
  ExpectTruth(found, c);
  EXPECT_EQ(found.readings, 138);
  EXPECT_TRUE(std::isnan(found.residuals[40][0]));
}

TEST(Separate, MarksAPositionThatNobodyVisited) {
  ExactCircles c = ReadExactly(12, {0, 1, 4}, Clamping::kReseat);
  for (Motion& m : c.motions) {
    if (m.position == 5) Lose(m, ReadingStatus::kNoLight);
  }
  for (auto& column : c.truth.target.value) column[5] = kNaN;
  const Separation found = Separate(c.motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_TRUE(std::isnan(found.target.value[Component::kEz][5]));
  EXPECT_TRUE(std::isfinite(found.target.value[Component::kEz][6]));
  EXPECT_FALSE(found.notes.empty());
  EXPECT_TRUE(ToJson(found)["target"]["ez_arcsec"][5].is_null());
  ExpectTruth(found, c);
}

TEST(Separate, LosesEverythingThatATornRingLeavesOpen) {
  // Two set-ups close one ring of n links; without one link its slope (the set-up's constant) is free.
  ExactCircles c = ReadExactly(12, {0, 1}, Clamping::kReseat);
  Lose(c.motions[4], ReadingStatus::kMissing);
  const Separation found = Separate(c.motions, Bench(), Options(12, Clamping::kReseat));
  int lost = 0;
  for (const double v : found.target.value[Component::kEz]) lost += std::isnan(v) ? 1 : 0;
  EXPECT_GE(lost, 11);  // one position may lie where the open slope crosses zero
}

TEST(Separate, RefusesAnglesOffTheGridAReferenceThatDoesNotTurnBackAndAnEmptyRecord) {
  const std::vector<Motion> right = ReadExactly(12, {0, 1}, Clamping::kReseat).motions;
  std::vector<Motion> off_grid = right, not_back = right;
  off_grid[3].target_rad += 0.01;
  for (Motion& m : not_back) m.reference_rad = m.target_rad;
  for (const std::vector<Motion>& motions : {off_grid, not_back, {}})
    EXPECT_THROW(Separate(motions, Bench(), Options(12, Clamping::kReseat)), InputError) << motions.size();
}

TEST(Separator, KnowsWhichMotionsFitItsLayout) {
  ExactCircles c = ReadExactly(12, {0, 1, 4}, Clamping::kReseat);
  const Separator separator(c.motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_TRUE(separator.Fits(c.motions));
  Lose(c.motions[7], ReadingStatus::kOverrun);
  EXPECT_FALSE(separator.Fits(c.motions));
  EXPECT_THROW(separator.Separate(c.motions), std::logic_error);
}

TEST(SecondOrder, IsNothingBesideRealNoise) {
  const auto motions = ReadExactly(36, {0, 1, 7, 11}, Clamping::kReseat, 4).motions;
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
    for (const Vector4& scale : {Vector4(1, 1, 1, 1), Vector4(1, 1e-4, 1e-4, 1), Vector4(1e-4, 1, 1, 1e-4)}) {
      const WeightedStops stops = Weigh(motions, Layouts(36, clamping), scale);
      EXPECT_EQ(InvertNormal(stops.layout.design, stops.weights.cells, stops.models, stops.Null()).extra_null.cols(), 0)
          << scale.transpose();
    }
  }
}

Separation WithScatter(const Vector4& ratio) {
  Separation result;
  result.dof_of.setConstant(100.0);
  result.dof = 400;
  result.chi2 = 100.0 * ratio.cwiseAbs2();
  result.second_order.setZero();
  return result;
}

TEST(AssumedNoiseScale, FollowsTheResidualsButNotBelowAHundredthOfTheLargestOrTheSecondOrder) {
  EXPECT_LT((AssumedNoiseScale(WithScatter({0.5, 2, 1, 0.1}), Bench()) - Vector4(0.5, 2, 1, 0.1)).norm(), 1e-14);
  EXPECT_LT((AssumedNoiseScale(WithScatter({1e-7, 2, 1, 1e-3}), Bench()) - Vector4(0.02, 2, 1, 0.02)).norm(),
            1e-14);  // rounding
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
