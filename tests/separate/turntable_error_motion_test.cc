#include "twin/benches/turntable_autocollimator/parts_of_results.h"

#include "twin/core/units.h"

/// ISO 230-7 of a turntable's tilt, from stops whose y is written down.
namespace twinbench::benches::turntable {
namespace {

using separate::turntable::IndexingSeparation, separate::turntable::TurntableStop;

constexpr int kPositions = 36, kTilts = 2;
constexpr double kHalf_arcsec = 3.0;  // of the turntable's tilt, twice a turn: its extremes lie on positions

struct Course {
  std::vector<int> shifts = {0, 1, 7, 11};  // steps
  double teeth_arcsec = 2.0;                // of the multi-tooth table, three times a turn
  double apart_arcsec = 0.0;                // every second pass shows so much more
  double roll_rad = 0.0;
};

std::vector<TurntableStop> Stops(const Course& course) {
  std::vector<TurntableStop> stops;
  for (std::size_t setup = 0; setup < course.shifts.size(); ++setup) {
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i < kPositions; ++i) {
        const double step_rad = units::turn / kPositions, angle_rad = i * step_rad, tooth_rad = course.shifts[setup] * step_rad - angle_rad;
        const double lean_arcsec = 60.0 * std::cos(angle_rad - static_cast<double>(setup)) + 10.0 * static_cast<double>(setup);
        const double y_rad = units::arcsec * (kHalf_arcsec * std::cos(kTilts * angle_rad) + course.teeth_arcsec * std::cos(3.0 * tooth_rad) +
                                              lean_arcsec + pass * course.apart_arcsec);
        const double x_rad = 9.0 * units::arcsec * std::cos(5.0 * angle_rad), c = std::cos(course.roll_rad), s = std::sin(course.roll_rad);
        stops.push_back({static_cast<int>(setup), 2 * static_cast<int>(setup) + pass, 1, angle_rad, tooth_rad, c * x_rad + s * y_rad, c * y_rad - s * x_rad});
      }
    }
  }
  return stops;
}

nlohmann::json TiltOf(const Course& course) {
  IndexingSeparation separation;
  separation.roll.gamma_rad = course.roll_rad;
  if (course.shifts.size() > 1) separation.multitooth.position_rad = {0.0};
  return EvaluateTilt(Stops(course), kPositions, separation, 0.1 * units::arcsec).json;
}

double Value(const nlohmann::json& json, const char* name) {
  return json.at(0).at("values").at(name).at("value_arcsec");
}

TEST(TurntableTilt, IsToldFromTheTeethFromHowTheirAxisLeansAndFromTheRollOfTheCrosshair) {
  const nlohmann::json tilt = TiltOf({});
  EXPECT_EQ(tilt.at(0).at("motion"), "tilt_fixed_x");
  EXPECT_NEAR(Value(tilt, "synchronous"), 2.0 * kHalf_arcsec, 1e-9);
  EXPECT_NEAR(Value(tilt, "asynchronous"), 0.0, 1e-9);
  EXPECT_NEAR(Value(tilt, "total"), 2.0 * kHalf_arcsec, 1e-9);
  EXPECT_EQ(tilt.at(0).at("missing").size(), 1u) << "it stood, and nothing else";
  EXPECT_NEAR(Value(TiltOf({.roll_rad = 5e-3}), "synchronous"), 2.0 * kHalf_arcsec, 1e-9);
}

TEST(TurntableTilt, OfOneShiftHasTheTeethInItAndSaysSo) {
  const nlohmann::json tilt = TiltOf({.shifts = {0}});
  double most = -1e9, least = 1e9;
  for (int i = 0; i < kPositions; ++i) {
    const double angle_rad = i * units::turn / kPositions, both = kHalf_arcsec * std::cos(2.0 * angle_rad) + 2.0 * std::cos(-3.0 * angle_rad);
    most = std::max(most, both), least = std::min(least, both);
  }
  EXPECT_NEAR(Value(tilt, "synchronous"), most - least, 1e-9);
  EXPECT_EQ(tilt.at(0).at("missing").size(), 2u);
}

TEST(TurntableTilt, OfPassesThatLieApartIsAsynchronousMotion) {
  const double apart_arcsec = 0.4;
  const nlohmann::json tilt = TiltOf({.apart_arcsec = apart_arcsec});
  // 288 readings; 36 positions and 36 teeth, each but for a mean, a constant and the two of a circle for each of four set-ups.
  const double readings = 8.0 * kPositions, dof = readings - (2.0 * (kPositions - 1) + 4.0) - 8.0;
  EXPECT_NEAR(Value(tilt, "asynchronous"), apart_arcsec * std::sqrt(readings / dof), 1e-9);
  EXPECT_EQ(tilt.at(0).at("dof"), dof);
  EXPECT_NEAR(Value(tilt, "synchronous"), 2.0 * kHalf_arcsec, 1e-9);
  EXPECT_NEAR(Value(tilt, "total"), 2.0 * kHalf_arcsec + Value(tilt, "asynchronous"), 1e-9);
  EXPECT_EQ(tilt.at(0).at("turns"), 8);
}

TEST(ErrorMotionJson, OfAnAxialMotionHasFundamentalAndResidual) {
  const Eigen::VectorXd angle_rad = Eigen::VectorXd::LinSpaced(kPositions, 0.0, units::turn * (kPositions - 1) / kPositions);
  Eigen::MatrixXd turns(2, kPositions);
  turns.row(0) = 1e-6 * (4.0 * angle_rad.array().cos() + 1.5 * (2.0 * angle_rad.array()).cos()).transpose();
  turns.row(1) = turns.row(0).array() + 0.5e-6;
  report::ErrorMotionTexts told;
  separate::ErrorMotionDraws draws;
  report::DirectedMotion axial{"axial", false, separate::OfTurns(angle_rad, turns), {}, separate::PlotCentre::kPolarChart};
  AppendErrorMotions("spindle", {axial}, {}, draws, told);
  const nlohmann::json& values = told.json.at(0).at("values");
  EXPECT_NEAR(values.at("fundamental").at("value_um"), 8.0, 1e-9);
  EXPECT_NEAR(values.at("residual").at("value_um"), 3.0, 1e-9);
  EXPECT_NEAR(values.at("asynchronous").at("value_um"), 0.5, 1e-9);
  EXPECT_NEAR(values.at("total").at("value_um").get<double>(), values.at("synchronous").at("value_um").get<double>() + 0.5, 1e-9);
}

}  // namespace
}  // namespace twinbench::benches::turntable
