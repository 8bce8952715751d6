#include <Eigen/Dense>

#include "tests/freeform/freeform_run.h"
#include "twin/benches/freeform_five_axis/estimators/identification.h"

// What the readings of the standard path cannot say, against what theory says of chain and probe. That the estimator's
// equations are those of the bench, identification_test.cc and traced_probe_test.cc hold.
namespace twinbench::freeform_test {
namespace {

using namespace benches::freeform::estimators;
using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kSwivel = 12.0 * units::deg;  // t = 1 of the cubics of A and B

/// Values of unknowns by name, um and arcsec; what is not named is 0.
using Values = std::map<std::string, double>;

/// An identification with readings that an ideal machine gives, in units in which all columns are unit vectors; a column that
/// shows nothing stays zero.
struct Path {
  Identification found;
  VectorXd norms;
  MatrixXd columns, null_space;

  VectorXd Scaled(const Values& direction) const {
    const std::vector<std::string> names = estimators::NamesOf(4);
    VectorXd v = VectorXd::Zero(columns.cols());
    for (const auto& [name, value] : direction) {
      const auto at = std::ranges::find(names, name) - names.begin();
      EXPECT_LT(at, std::ssize(names)) << name;
      v[at] = value * norms[at];
    }
    return v.normalized();
  }
  double OutOfNullSpace(const VectorXd& v) const { return (v - null_space * (null_space.transpose() * v)).norm(); }
};

Path PathOf(const std::string& more = "") {
  const Scenario scenario = FreeformScenario("noise_free = true\n" + more);
  const FreeformSettings& settings = FreeformOf(scenario);
  const std::vector<PoseRead> poses = PosesOf(RunOf(scenario, {settings.machine, {}}), settings);
  Path path{Identify(settings, poses), {}, {}, {}};
  path.columns = Jacobian(settings, poses, VectorXd::Zero(path.found.unknowns.size()));
  for (Eigen::Index row = 0; row < path.columns.rows(); ++row)
    path.columns.row(row) /= row % 3 < 2 ? settings.qpd.noise_V : settings.ccd.noise_px;
  path.norms = path.columns.colwise().norm();
  path.norms = (path.norms.array() < 1e-6 * path.norms.maxCoeff()).select(1.0, path.norms);
  path.columns *= path.norms.cwiseInverse().asDiagonal();
  // Of the least solution nothing lies in it.
  const MatrixXd covariance = path.norms.asDiagonal() * path.found.covariance * path.norms.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(covariance);
  const Eigen::Index dimensions = path.norms.size() - path.found.rank;
  path.null_space = eigen.eigenvectors().leftCols(dimensions);
  EXPECT_LT(eigen.eigenvalues()[dimensions - 1], 1e-6 * eigen.eigenvalues()[dimensions]);
  return path;
}

const Path& StandardPath() {
  static const Path path = PathOf();
  return path;
}

TEST(FreeformNullSpace, HasTheTurnsAboutTheBeamTooWithoutADither) {
  // A spot in the middle of the detector stays there when the probe turns about its beam.
  const Path path = PathOf("[freeform_procedure]\ndither_um = 0.0\ndither_deg = 0.0\n");
  EXPECT_EQ(path.found.rank, 110);
  for (const char* turn : {"b.rz0", "b.rz1", "b.rz2", "b.rz3"})
    EXPECT_LT(path.OutOfNullSpace(path.Scaled({{turn, 1.0}})), 1e-3) << turn;
}

/// Directions as theory has them: of a slope along its axis and a squareness, of bodies in a row.
struct Named {
  std::string name;
  Values direction;
};

std::vector<Named> Directions() {
  constexpr double h = kSwivel, kSlope = 0.150 * units::arcsec / units::um, kHeight = 0.100 * units::arcsec / units::um;
  return {
      {"y.tx1 and syx", {{"syx", 1.0}, {"y.tx1", kSlope}}},
      {"z.tx1 and szx", {{"szx", 1.0}, {"z.tx1", -kHeight}, {"z.tx0", -kHeight}}},
      {"z.ty1 and szy", {{"szy", 1.0}, {"z.ty1", kHeight}, {"z.ty0", kHeight}}},
      // An inclined axis of A turns the body by s (0, sin A, cos A - 1), as far as cubics are sines.
      {"a.ry1 and saz", {{"saz", 1.0}, {"a.ry1", -h}, {"a.ry3", h * h * h / 6.0}, {"a.rz2", 0.5 * h * h}}},
      {"a.ry2, a.rz1 and say", {{"say", 1.0}, {"a.ry2", 0.5 * h * h}, {"a.rz1", h}, {"a.rz3", -h * h * h / 6.0}}},
      {"b.rx1 and sbz", {{"sbz", 1.0}, {"b.rx1", h}, {"b.rx3", -h * h * h / 6.0}, {"b.rz2", 0.5 * h * h}}},
      {"b.rx2 and sbx", {{"sbx", 1.0}, {"b.rx2", 0.5 * h * h}, {"b.rz1", -h}, {"b.rz3", h * h * h / 6.0}}},
      {"x.tx0 and y.tx0", {{"x.tx0", 1.0}, {"y.tx0", 1.0}}},
      {"y.rx0, z.rx0 and szy", {{"y.rx0", 1.0}, {"z.rx0", -1.0}, {"szy", -1.0}}},
      {"y.ty0 and z.ty0", {{"z.ty0", 1.0}, {"y.ty0", -1.0}}}};
}

TEST(FreeformNullSpace, HoldsTheDirectionsThatTheoryNames) {
  for (const auto& [name, direction] : Directions()) {
    const VectorXd v = StandardPath().Scaled(direction);
    // Of 1 - cos, where that is all there is, its square leaves h^2 / 12: 0.4 %, most of which a constant takes.
    EXPECT_LT((StandardPath().columns * v).norm(), 2e-3) << name;
    EXPECT_LT(StandardPath().OutOfNullSpace(v), 0.01) << name;
  }
}

TEST(FreeformNullSpace, DoesNotHoldWhatTheReadingsTell) {
  // Else the test above could not fail.
  for (const char* name : {"x.tx2", "y.ty3", "z.tz1", "a.rx1", "b.ry2", "b.rz0", "b.rz3"})
    EXPECT_GT(StandardPath().OutOfNullSpace(StandardPath().Scaled({{name, 1.0}})), 0.1) << name;
}

}  // namespace
}  // namespace twinbench::freeform_test
