#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/freeform/freeform_run.h"
#include "twin/benches/freeform_five_axis/estimators/identification.h"

// What the readings of the standard path cannot say, derived once more: chain and probe written down here from the
// format's text, differenced and decomposed, sharing no code with the twin or the estimators.
namespace twinbench::freeform_test {
namespace {

using namespace benches::freeform::estimators;
using Eigen::Matrix4d, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kUm = 1e-6, kArcsec = std::numbers::pi / 648000.0, kDegree = std::numbers::pi / 180.0;
constexpr double kNoise_V = 0.010, kNoise_px = 0.05;
constexpr double kSwivel = 12.0 * kDegree;  // t = 1 of the cubics of A and B

Matrix4d Shift(double x, double y, double z) {
  Matrix4d m = Matrix4d::Identity();
  m.col(3) << x, y, z, 1.0;
  return m;
}

/// Right-handed about axis 0, 1 or 2.
Matrix4d About(int axis, double angle) {
  Matrix4d m = Matrix4d::Identity();
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  m(next, next) = m(last, last) = std::cos(angle);
  m(last, next) = std::sin(angle);
  m(next, last) = -m(last, next);
  return m;
}

/// Values of unknowns by name, um and arcsec; what is not named is 0.
using Values = std::map<std::string, double>;

double ValueOf(const Values& values, const std::string& name, double unit) {
  const auto found = values.find(name);
  return found == values.end() ? 0.0 : found->second * unit;
}

/// translation(tx, ty, tz) Rz(rz) Ry(ry) Rx(rx), each a cubic in t ("x.tx0" ...) or, without, a constant
/// ("mount2.tx").
Matrix4d ErrorOf(const Values& values, const std::string& body, const double* t) {
  std::array<double, 6> e{};
  for (std::size_t k = 0; k < 6; ++k) {
    const std::string name = body + "." + std::array{"tx", "ty", "tz", "rx", "ry", "rz"}[k];
    const double unit = k < 3 ? kUm : kArcsec;
    if (!t) e[k] = ValueOf(values, name, unit);
    for (int power = 0; t && power < 4; ++power)
      e[k] += ValueOf(values, name + std::to_string(power), unit) * std::pow(*t, power);
  }
  return Shift(e[0], e[1], e[2]) * About(2, e[5]) * About(1, e[4]) * About(0, e[3]);
}

/// qpd_x, qpd_y, ccd over their noise.
Eigen::Vector3d ReadingOf(const Reading& r, const Values& values) {
  const double X = kCommanded[0](r), Y = kCommanded[1](r), Z = kCommanded[2](r), A = kCommanded[3](r),
               B = kCommanded[4](r);
  const auto squareness = [&](const char* name) { return ValueOf(values, name, kArcsec); };
  const auto error = [&](const char* axis, double t) { return ErrorOf(values, axis, &t); };
  const Eigen::Vector4d dir_y = About(2, squareness("syx")) * Eigen::Vector4d(0, 1, 0, 0);
  const Eigen::Vector4d dir_z =
      About(1, squareness("szx")) * About(0, squareness("szy")) * Eigen::Vector4d(0, 0, 1, 0);
  const Matrix4d S_a = About(2, squareness("saz")) * About(1, squareness("say"));
  const Matrix4d S_b = About(2, squareness("sbz")) * About(0, squareness("sbx"));
  constexpr double kPivot = 0.120;
  const Matrix4d tool = Shift(Y * dir_y[0], Y * dir_y[1], Y * dir_y[2]) * error("y", Y / 0.150) *
                        Shift(Z * dir_z[0], Z * dir_z[1], Z * dir_z[2]) * error("z", (Z - 0.100) / 0.100) *
                        Shift(0, 0, kPivot) * S_a * About(0, A) * S_a.transpose() * error("a", A / kSwivel) * S_b *
                        About(1, B) * S_b.transpose() * error("b", B / kSwivel) * Shift(0, 0, -kPivot);
  const double yaw = r.setup == 1 ? 90.0 * kDegree : 0.0;
  const Matrix4d work = Shift(X, 0, 0) * error("x", X / 0.150) * Shift(0, 0, 0.060 * r.setup) * About(2, yaw) *
                        ErrorOf(values, "mount" + std::to_string(r.setup), nullptr);
  const Matrix4d in_artefact = work.inverse() * tool;
  const int i = static_cast<int>(kCellI(r)), j = static_cast<int>(kCellJ(r));
  const double R = (i + j) % 2 == 0 ? 0.040 : 0.080;
  const Eigen::Vector3d p = in_artefact.block<3, 1>(0, 3) - 0.020 * Eigen::Vector3d(i, j, 0);
  const Eigen::Vector3d d = -in_artefact.block<3, 1>(0, 2);
  // (p + t d) on z = (x^2 + y^2) / 2 R: a quadratic, of whose roots the near one.
  const double a = d.x() * d.x() + d.y() * d.y(), b = p.x() * d.x() + p.y() * d.y() - R * d.z(),
               c = p.x() * p.x() + p.y() * p.y() - 2.0 * R * p.z();
  const double t = -c / (b + std::sqrt(b * b - a * c));
  const Eigen::Vector3d hit = p + t * d, n = Eigen::Vector3d(-hit.x() / R, -hit.y() / R, 1.0).normalized();
  const Eigen::Vector3d reflected = in_artefact.block<3, 3>(0, 0).transpose() * (d - 2.0 * d.dot(n) * n);
  const auto side = [](double at) { return 0.5 * (1.0 - std::erf(std::sqrt(2.0) * (0.01e-3 - at) / 0.25e-3)); };
  const double u = 0.050 * reflected.x() / reflected.z(), v = 0.050 * reflected.y() / reflected.z();
  const double px = side(u), mx = side(-u), py = side(v), my = side(-v);
  const double alpha = 30.0 * kDegree, beta = std::atan(std::tan(alpha));
  const double s = 0.060 * t * std::sin(alpha) / (0.060 * std::sin(beta) + t * std::sin(alpha + beta));
  return {5.0 * (px - mx) * (py + my) / kNoise_V, 5.0 * (py - my) * (px + mx) / kNoise_V, s / 7e-6 / kNoise_px};
}

/// Unit columns; a column that shows nothing stays zero.
struct Design {
  std::vector<std::string> names;
  VectorXd norms;
  MatrixXd columns;
  Eigen::SelfAdjointEigenSolver<MatrixXd> eigen;  // of columns' columns: squares of the singular values
  Eigen::Index rank = 0;

  MatrixXd NullSpace() const { return eigen.eigenvectors().leftCols(columns.cols() - rank); }
  /// The largest is 1, and first.
  VectorXd SingularValues() const {
    const VectorXd& squares = eigen.eigenvalues();
    return (squares.reverse() / squares.maxCoeff()).cwiseMax(0.0).cwiseSqrt();
  }

  /// In units in which the columns are unit vectors, of length 1.
  VectorXd Scaled(const Values& direction) const {
    VectorXd v = VectorXd::Zero(columns.cols());
    for (const auto& [name, value] : direction) {
      const auto at = std::ranges::find(names, name) - names.begin();
      EXPECT_LT(at, std::ssize(names)) << name;
      v[at] = value * (norms[at] > 0.0 ? norms[at] : 1.0);
    }
    return v.normalized();
  }
};

Design StandardPath(const std::string& more = "") {
  Design design;
  for (const char* axis : {"x", "y", "z", "a", "b"}) {
    for (const char* error : {"tx", "ty", "tz", "rx", "ry", "rz"}) {
      for (int power = 0; power < 4; ++power)
        design.names.push_back(std::string(axis) + "." + error + std::to_string(power));
    }
  }
  for (const char* name : {"syx", "szx", "szy", "say", "saz", "sbx", "sbz"}) design.names.push_back(name);
  for (int setup = 0; setup < 4; ++setup) {
    for (const char* error : {"tx", "ty", "tz", "rx", "ry", "rz"})
      design.names.push_back("mount" + std::to_string(setup) + "." + error);
  }
  std::vector<Reading> poses = procedure::FreeformSchedule(FreeformScenario(more));
  std::erase_if(poses, [](const Reading& r) { return r.pass != 0; });  // back are the same again
  design.columns.resize(3 * std::ssize(poses), std::ssize(design.names));
  for (Eigen::Index k = 0; k < design.columns.cols(); ++k) {
    const std::string& name = design.names[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < poses.size(); ++i)
      design.columns.block<3, 1>(3 * static_cast<Eigen::Index>(i), k) =
          0.5 * (ReadingOf(poses[i], {{name, 1.0}}) - ReadingOf(poses[i], {{name, -1.0}}));
  }
  design.norms = design.columns.colwise().norm();
  const double least = 1e-6 * design.norms.maxCoeff();
  for (Eigen::Index k = 0; k < design.columns.cols(); ++k) {
    if (design.norms[k] < least) design.norms[k] = 0.0;
    design.columns.col(k) *= design.norms[k] > 0.0 ? 1.0 / design.norms[k] : 0.0;
  }
  design.eigen.compute(design.columns.transpose() * design.columns);
  design.rank = (design.SingularValues().array() > 3e-4).count();
  return design;
}

const Design& Path() {
  static const Design design = StandardPath();
  return design;
}

TEST(FreeformNullSpace, HasThirtySevenOf151DimensionsByTheFormatsOwnEquations) {
  ASSERT_EQ(Path().columns.cols(), 151);
  EXPECT_EQ(Path().rank, 114);
  EXPECT_EQ(Path().NullSpace().cols(), 37);
  // The rank hangs on no chance: a clear step at the limit of 3e-4.
  const VectorXd s = Path().SingularValues();
  EXPECT_GT(s[113], 2.0 * s[114]);
}

TEST(FreeformNullSpace, HasTheTurnsAboutTheBeamTooWithoutADither) {
  // A spot in the middle of the detector stays there when the probe turns about its beam.
  const Design design = StandardPath("[freeform_procedure]\ndither_um = 0.0\ndither_deg = 0.0\n");
  EXPECT_EQ(design.rank, 110);
  const MatrixXd null_space = design.NullSpace();
  for (const char* turn : {"b.rz0", "b.rz1", "b.rz2", "b.rz3"}) {
    const VectorXd v = design.Scaled({{turn, 1.0}});
    EXPECT_LT((v - null_space * (null_space.transpose() * v)).norm(), 1e-3) << turn;
  }
}

TEST(FreeformNullSpace, IsTheEstimators) {
  // Of readings that an ideal machine gives, so that both look at the same point.
  const Scenario scenario = FreeformScenario("noise_free = true\n");
  const sim::DrawnBench ideal{FreeformOf(scenario).machine, {}};
  const Identification found =
      Identify(FreeformOf(scenario), PosesOf(RunOf(scenario, ideal), FreeformOf(scenario)));
  ASSERT_EQ(found.rank, Path().rank);
  const VectorXd scale = Path().norms.array().max(1e-300);
  MatrixXd covariance = scale.asDiagonal() * found.covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(covariance);
  const MatrixXd theirs = eigen.eigenvectors().leftCols(37), products = theirs.transpose() * Path().NullSpace();
  EXPECT_LT(eigen.eigenvalues()[36], 1e-6 * eigen.eigenvalues()[37]);
  const double least_cosine2 = Eigen::SelfAdjointEigenSolver<MatrixXd>(products.transpose() * products).eigenvalues()[0];
  // Differences of one um or arcsec leave 1e-9 of a column; over the step at the limit that is 1e-5 rad.
  EXPECT_LT(std::sqrt(std::max(0.0, 1.0 - least_cosine2)), 1e-4);
}

/// Directions as theory has them: of a slope along its axis and a squareness, of bodies in a row.
struct Named {
  std::string name;
  Values direction;
};

std::vector<Named> Directions() {
  constexpr double h = kSwivel, kSlope = 0.150 * kArcsec / kUm, kHeight = 0.100 * kArcsec / kUm;
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
  const MatrixXd null_space = Path().NullSpace();
  for (const auto& [name, direction] : Directions()) {
    const VectorXd v = Path().Scaled(direction);
    // Of 1 - cos, where that is all there is, its square leaves h^2 / 12: 0.4 %, most of which a constant takes.
    EXPECT_LT((Path().columns * v).norm(), 2e-3) << name;
    EXPECT_LT((v - null_space * (null_space.transpose() * v)).norm(), 0.01) << name;
  }
}

TEST(FreeformNullSpace, DoesNotHoldWhatTheReadingsTell) {
  // Else the test above could not fail.
  const MatrixXd null_space = Path().NullSpace();
  for (const char* name : {"x.tx2", "y.ty3", "z.tz1", "a.rx1", "b.ry2", "b.rz0", "b.rz3"}) {
    const VectorXd v = Path().Scaled({{name, 1.0}});
    EXPECT_GT((v - null_space * (null_space.transpose() * v)).norm(), 0.1) << name;
  }
}

}  // namespace
}  // namespace twinbench::freeform_test
