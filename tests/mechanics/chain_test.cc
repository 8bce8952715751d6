#include "mechanics/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/mechanics/test_units.h"

namespace twinbench::mechanics {
namespace {

using Row = std::map<std::string, double>;

struct OracleRow {
  bool reclamp = false;
  Row value;
};

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell.substr(0, cell.find('\r')));
  return cells;
}

std::vector<OracleRow> ReadOracle(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = Split(line);
  std::vector<OracleRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = Split(line);
    OracleRow row;
    row.reclamp = cells[0] == "reclamp";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (names[i] != "mode" && names[i] != "phase") row.value[names[i]] = std::stod(cells[i]);
    }
    rows.push_back(row);
  }
  return rows;
}

PoseError ErrorOf(const Row& row, const std::string& table) {
  const auto angle = [&](const char* name) { return row.at(table + name) * kArcsec; };
  const auto length = [&](const char* name) { return row.at(table + name) * kMicrometre; };
  return {angle("_ex_arcsec"), angle("_ey_arcsec"), angle("_ez_arcsec"),
          length("_dx_um"),    length("_dy_um"),    length("_dz_um")};
}

Pose OraclePose(const OracleRow& row, ErrorFrame frame) {
  const double shift_rad = row.value.at("shift_deg") * kDegree;
  ChainGeometry geometry;
  (row.reclamp ? geometry.clamp_rad : geometry.reseat_rad) = row.reclamp ? shift_rad : -shift_rad;
  ChainState state;
  state.target_rad = row.value.at("target_deg") * kDegree;
  state.reference_rad = row.value.at("reference_deg") * kDegree;
  state.target_error = ErrorOf(row.value, "target");
  state.reference_error = ErrorOf(row.value, "reference");
  state.reference_frame = frame;
  return Chain(geometry).GratingPose(state);
}

/// Where an order meets its PSD: vector grating equation, then ray and plane. `side` is +1 for PSD A, -1 for B.
Eigen::Vector2d Spot(const Pose& X_LG, double side) {
  const Vector3 source(0.0, 0.2, 0.0);
  const Vector3 d(0.0, -1.0, 0.0);
  const Vector3 g = X_LG.linear().col(0);
  const Vector3 n = X_LG.linear().col(1);
  const Vector3 hit = source + d * n.dot(X_LG.translation() - source) / n.dot(d);
  const Vector3 across = d - d.dot(n) * n + side * 650e-9 * 600e3 * g;
  const Vector3 k = across + std::sqrt(1.0 - across.squaredNorm()) * n;
  const double sine = 0.39;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Vector3 normal(side * sine, cosine, 0.0);
  const Vector3 centre = 0.120 * normal;
  const Vector3 u(cosine, -side * sine, 0.0);
  const Vector3 spot = hit + k * normal.dot(centre - hit) / normal.dot(k) - centre;
  return {spot.dot(u), spot.z()};
}

TEST(Chain, AgreesWithTheIndependentSpotsToANanometre) {
  int n_other = 0;
  for (const OracleRow& row : ReadOracle(TWINBENCH_TEST_DATA "/oracle/poses.csv")) {
    const Pose X_LG = OraclePose(row, ErrorFrame::kBase);
    const Eigen::Vector2d a = Spot(X_LG, 1.0) / kMicrometre;
    const Eigen::Vector2d b = Spot(X_LG, -1.0) / kMicrometre;
    // The file prints 1e-9 um; 1 nm is the agreement promised.
    EXPECT_NEAR(a.x(), row.value.at("psd_a_u_um"), 1e-3);
    EXPECT_NEAR(a.y(), row.value.at("psd_a_v_um"), 1e-3);
    EXPECT_NEAR(b.x(), row.value.at("psd_b_u_um"), 1e-3);
    EXPECT_NEAR(b.y(), row.value.at("psd_b_v_um"), 1e-3);
    n_other += (Spot(OraclePose(row, ErrorFrame::kRotor), 1.0) / kMicrometre - a).norm() > 1e-3;
  }
  EXPECT_GT(n_other, 250);  // the other reading of the reference's frame would be seen in nearly every row
}

std::vector<PoseError> Errors(const nlohmann::json& rows) {
  std::vector<PoseError> errors;
  for (const auto& e : rows) {
    errors.push_back({e.at(0).get<double>() * kArcsec, e.at(1).get<double>() * kArcsec,
                      e.at(2).get<double>() * kArcsec, e.at(3).get<double>() * kMicrometre,
                      e.at(4).get<double>() * kMicrometre, e.at(5).get<double>() * kMicrometre});
  }
  return errors;
}

std::size_t Position(double angle_deg, std::size_t n) {
  const long step = std::lround(angle_deg / 360.0 * static_cast<double>(n));
  const long count = static_cast<long>(n);
  return static_cast<std::size_t>(((step % count) + count) % count);
}

/// Largest difference [um] between the spots of an oracle run and the chain's.
double WorstOfFullCircle(const std::string& mode, ErrorFrame frame) {
  const std::string folder = TWINBENCH_TEST_DATA "/oracle/full_circle_";
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(folder + mode + "_truth.json"));
  const std::vector<PoseError> target = Errors(truth.at("target"));
  const std::vector<PoseError> reference = Errors(truth.at("reference_rotor_frame"));
  double worst_um = 0.0;
  for (const OracleRow& row : ReadOracle(folder + mode + ".csv")) {
    const double target_deg = row.value.at("target_deg");
    const double reference_deg = row.value.at("reference_deg");
    const double shift_rad = (target_deg + reference_deg) * kDegree;
    ChainGeometry geometry;
    (mode == "reclamp" ? geometry.clamp_rad : geometry.reseat_rad) = mode == "reclamp" ? shift_rad : -shift_rad;
    ChainState state;
    state.target_rad = target_deg * kDegree;
    state.reference_rad = reference_deg * kDegree;
    state.target_error = target[Position(target_deg, target.size())];
    state.reference_error = reference[Position(-reference_deg, reference.size())];
    state.reference_frame = frame;
    const Pose X_LG = Chain(geometry).GratingPose(state);
    Eigen::Vector4d spots;
    spots << Spot(X_LG, 1.0), Spot(X_LG, -1.0);
    const Eigen::Vector4d volts(row.value.at("psd_a_x_V"), row.value.at("psd_a_y_V"), row.value.at("psd_b_x_V"),
                                row.value.at("psd_b_y_V"));
    worst_um = std::max(worst_um, (spots - volts / 2000.0).cwiseAbs().maxCoeff() / kMicrometre);
  }
  return worst_um;
}

TEST(Chain, TakesTheReferencesErrorsInItsRotorFrame) {
  for (const char* mode : {"reclamp", "reseat"}) {
    EXPECT_LT(WorstOfFullCircle(mode, ErrorFrame::kRotor), 1e-6);  // the file prints 1e-9 V = 5e-7 um
    EXPECT_GT(WorstOfFullCircle(mode, ErrorFrame::kBase), 1.0);    // the other reading would be seen
  }
}

TEST(Chain, BringsTheGratingToTheOriginWhenNothingIsWrong) {
  ChainState state;
  state.target_rad = 130.0 * kDegree;
  state.reference_rad = -130.0 * kDegree;
  const Pose X_LG = Chain(ChainGeometry{}).GratingPose(state);
  EXPECT_LT((X_LG.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-15);  // rounding of a few products near one
}

TEST(Chain, EqualsTheProductOfItsFactorsForEveryInput) {
  ChainGeometry g;
  g.p_RG_m = Vector3(0.01, 0.03, 0.05);
  g.centring_m = {20e-6, -30e-6};
  g.mount_tilt_rad = {1e-4, -2e-4};
  g.reseat_rad = -0.7;
  g.clamp_rad = 0.3;
  ChainState s;
  s.target_rad = 1.1;
  s.reference_rad = -2.3;
  s.target_error = {1e-5, 2e-5, -3e-5, 1e-6, 2e-6, 3e-6};
  s.reference_error = {-2e-5, 1e-5, 4e-5, -3e-6, 1e-6, 2e-6};
  s.target_bearing = {1e-6, 2e-6, -3e-6, 2e-6, -5e-6};
  s.reference_bearing = {-2e-6, 1e-6, -1e-6, 3e-6, 1e-6};
  s.goniometer_yaw_rad = 1e-3;
  s.goniometer_tilt_rad = -2e-3;

  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  const auto bearing = [&](const BearingPose& b) {
    return Translation3d(b.x_m, b.y_m, b.z_m) * AngleAxisd(b.rx_rad, x) * AngleAxisd(b.ry_rad, y);
  };
  const auto error = [&](const PoseError& e) {
    return Translation3d(e.dx_m, e.dy_m, e.dz_m) * AngleAxisd(e.ez_rad, z) * AngleAxisd(e.ey_rad, y) *
           AngleAxisd(e.ex_rad, x);
  };
  const Eigen::Rotation2Dd turn(s.reference_rad);
  PoseError base = s.reference_error;
  const Eigen::Vector2d tilt = turn * Eigen::Vector2d(base.ex_rad, base.ey_rad);
  const Eigen::Vector2d radial = turn * Eigen::Vector2d(base.dx_m, base.dy_m);
  base = {tilt.x(), tilt.y(), base.ez_rad, radial.x(), radial.y(), base.dz_m};
  const Eigen::Affine3d expected = Eigen::Affine3d(AngleAxisd(s.goniometer_yaw_rad, z)) *
                                   AngleAxisd(s.goniometer_tilt_rad, x) * Translation3d(-0.01, -0.03, -0.13) *
                                   bearing(s.target_bearing) * error(s.target_error) * AngleAxisd(s.target_rad, z) *
                                   Translation3d(20e-6, -30e-6, 0.08) * AngleAxisd(-2e-4, y) * AngleAxisd(1e-4, x) *
                                   AngleAxisd(-0.7, z) * bearing(s.reference_bearing) * error(base) *
                                   AngleAxisd(s.reference_rad, z) * AngleAxisd(-0.3, z) * Translation3d(g.p_RG_m);
  // Two orders of multiplying a dozen matrices of size one: 1e-15 each.
  EXPECT_LT((Chain(g).GratingPose(s).matrix() - expected.matrix()).norm(), 5e-15);
}

TEST(Chain, GoniometerTurnsTheNormalAboutTheLaserSpot) {
  ChainState state;
  state.goniometer_yaw_rad = 100.0 * kArcsec;
  state.goniometer_tilt_rad = 200.0 * kArcsec;
  const Pose X_LG = Chain(ChainGeometry{}).GratingPose(state);
  EXPECT_LT(X_LG.translation().norm(), 1e-16);
  // Counter-clockwise yaw takes the normal y towards -x; second order 100" x 200" = 0.1" of 1e-3 rad.
  EXPECT_NEAR(X_LG.linear()(0, 1), -100.0 * kArcsec, 1e-9);
  EXPECT_NEAR(X_LG.linear()(2, 1), 200.0 * kArcsec, 1e-9);
}

}  // namespace
}  // namespace twinbench::mechanics
