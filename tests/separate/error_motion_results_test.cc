#include "twin/benches/rotary_4dof/parts_of_results.h"

#include "tests/separate/bench.h"

/// ISO 230-7 of both tables, from motions made by the exact chain.
namespace twinbench::benches::rotary {
namespace {

using namespace separate;

constexpr int kPositions = 36;

Eigen::ArrayXd Angles(Eigen::Index n) {
  return Eigen::ArrayXd::LinSpaced(n, 0.0, units::turn * (1.0 - 1.0 / static_cast<double>(n)));
}

Eigen::ArrayXd ArrayOf(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), std::ssize(values));
}

/// Width of a contour on evenly spread angles about its least-squares circle: without orders 0 and 1.
double WidthAboutCircle(const Eigen::ArrayXd& contour) {
  const Eigen::ArrayXd cosine = Angles(contour.size()).cos(), sine = Angles(contour.size()).sin();
  const Eigen::ArrayXd left = contour - 2.0 * ((contour * cosine).mean() * cosine + (contour * sine).mean() * sine);
  return left.maxCoeff() - left.minCoeff();
}

/// x cos + y sin of `sense` times the angle.
Eigen::ArrayXd Turned(const std::vector<double>& x, const std::vector<double>& y, double sense) {
  const Eigen::ArrayXd angle = sense * Angles(std::ssize(x));
  return ArrayOf(x) * angle.cos() + ArrayOf(y) * angle.sin();
}

struct Evaluated {
  Truth truth;
  Separation separation;
  nlohmann::json json;

  const nlohmann::json& Of(const std::string& table, const std::string& motion) const {
    for (const nlohmann::json& one : json)
      if (one.at("table") == table && one.at("motion") == motion) return one;
    throw std::runtime_error("no " + motion);
  }
  double Synchronous(const std::string& table, const std::string& motion, const std::string& unit) const {
    return Of(table, motion).at("values").at("synchronous").at("value_" + unit);
  }
};

/// @param scatter_rad  That the first pass shows more of ex everywhere, and the second less.
Evaluated Evaluate(double scatter_rad) {
  auto [truth, motions] = ReadExactly(kPositions, {0, 1, 7, 11}, Clamping::kReclamp, 2);
  Evaluated e{truth, {}, {}};
  for (Motion& m : motions) m.ex_rad += m.pass % 2 == 0 ? scatter_rad : -scatter_rad;
  e.separation = Separate(motions, Bench(), Options(kPositions, Clamping::kReclamp));
  e.json = EvaluateErrorMotions(e.separation, motions).json;
  return e;
}

TEST(ErrorMotions, SynchronousOnesAreThoseOfTheTrueCurves) {
  const Evaluated e = Evaluate(0.0);
  const TableErrors &t = e.truth.target, &r = e.truth.reference;
  // The chain's second order reaches 0.005 arcsec and um rms (Separate.DoesWithoutSomeReadings); a width has two ends.
  constexpr double kNear = 0.03;
  const auto expect = [&](const char* table, const char* motion, const Eigen::ArrayXd& contour, bool is_angle) {
    const double unit = is_angle ? units::arcsec : units::um;
    EXPECT_NEAR(e.Synchronous(table, motion, is_angle ? "arcsec" : "um"), WidthAboutCircle(contour) / unit, kNear) << table << " " << motion;
  };
  expect("target", "radial_fixed_y", ArrayOf(t[Component::kDy]), false);
  expect("target", "tilt_fixed_x", ArrayOf(t[Component::kEx]), true);
  expect("target", "tilt_fixed_y", ArrayOf(t[Component::kEy]), true);
  expect("target", "tilt_rotating_x", Turned(t[Component::kEx], t[Component::kEy], 1.0), true);
  expect("reference", "radial_rotating_y", ArrayOf(r[Component::kDy]), false);
  expect("reference", "radial_fixed_x", Turned(r[Component::kDx], r[Component::kDy], -1.0), false);
  expect("reference", "tilt_fixed_x", Turned(r[Component::kEx], r[Component::kEy], -1.0), true);
}

// Two set-ups of one pass leave something to judge one of the tilts by and nothing the other: no scatter of a direction
// that turns through both.
TEST(ErrorMotions, OfTwoSetUpsOfOnePassAreSynchronousOnly) {
  const auto motions = ReadExactly(kPositions, {0, 1}, Clamping::kReseat).motions;
  const Separation separation = Separate(motions, Bench(), Options(kPositions, Clamping::kReseat));
  const nlohmann::json json = EvaluateErrorMotions(separation, motions).json;
  const auto turning = std::ranges::find_if(json, [](const nlohmann::json& one) {
    return one.at("table") == "target" && one.at("motion") == "tilt_rotating_x";
  });
  ASSERT_NE(turning, json.end());
  EXPECT_TRUE(turning->at("values").contains("synchronous"));
  EXPECT_FALSE(turning->at("values").contains("asynchronous"));
}

TEST(ErrorMotions, AsynchronousOnesAreWhatPassesShowBeyondTheModel) {
  const double scatter_rad = 0.5 * units::arcsec;
  const Evaluated e = Evaluate(scatter_rad);
  const nlohmann::json& tilt = e.Of("target", "tilt_fixed_x");
  const double dof = e.separation.dof_of[static_cast<int>(measure::Dof::kEx)];
  EXPECT_NEAR(tilt.at("values").at("asynchronous").at("value_arcsec"), 2.0 * 0.5 * std::sqrt(e.separation.readings / dof), 0.02)
      << "both passes of every mounting, for the unknowns that were fitted";
  EXPECT_EQ(tilt.at("turns"), 8) << "two passes of four mountings";
  EXPECT_LT(e.Of("target", "tilt_fixed_y").at("values").at("asynchronous").at("value_arcsec"), 0.05);
  const nlohmann::json& total = tilt.at("values").at("total");
  EXPECT_GT(total.at("value_arcsec"), tilt.at("values").at("synchronous").at("value_arcsec"));
  EXPECT_GT(total.at("u_arcsec"), 0.0);
  EXPECT_FALSE(e.Of("reference", "tilt_fixed_x").at("values").contains("asynchronous")) << "nothing tells it from the target's";
  double shares = 0.0;
  for (const auto& [name, share] : total.at("u_parts").items()) shares += share.get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-9);
}

}  // namespace
}  // namespace twinbench::benches::rotary
