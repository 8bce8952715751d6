#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/benches/turntable_autocollimator/estimators/one_axis.h"
#include "twin/benches/turntable_autocollimator/ripples.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/factory.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/products.h"
#include "twin/model/local_level.h"
#include "twin/model/signals.h"

namespace twinbench::benches::turntable {
namespace {

using diagnose::TwinComparison;
using units::arcsec;

constexpr double kFree_rad = 360.0 * arcsec;       // the range of an autocollimator
constexpr double kToothTilt_rad = 5.0 * arcsec;    // of a multi-tooth table
constexpr double kLeastNoise_rad = 1e-4 * arcsec;  // nothing is known better
constexpr int kParts = 1000000;                    // of a turn, in which angles are told apart

int InTurn(double angle_rad) {
  const auto part = static_cast<int>(std::lround(angle_rad / units::turn * kParts) % kParts);
  return part < 0 ? part + kParts : part;
}

/// What a face would have shown at its nominal angle: where a polygon is nulled the encoder, with its scatter,
/// shows what the autocollimator does not, on a crosshair that is rolled, and what is regressed on must be without it.
std::vector<Reading> AtNominal(std::vector<Reading> readings, const TurntableSettings& own) {
  if (!own.HasPolygon()) return readings;
  for (Reading& r : readings) {
    if (IsInSweep(r) || !std::isfinite(r.target_rad) || !std::isfinite(r.reference_rad)) continue;
    const int setup = std::clamp(r.setup, 0, own.turntable_procedure.SetUps() - 1);
    const int face = static_cast<int>(std::lround(-r.reference_rad / own.Pitch_rad()));
    const double nominal_rad = own.FaceAngle_rad(setup, face);
    const double beside_rad = std::remainder(r.target_rad - nominal_rad, units::turn);
    r.autocollimator_yaw_rad -= beside_rad * std::cos(own.collimator.roll_rad);
    r.autocollimator_tilt_rad += beside_rad * std::sin(own.collimator.roll_rad);
    r.target_rad = nominal_rad;
  }
  return readings;
}

/// A sweep alone, so that x goes with the reference, as the twin's does: whoever made it turned the instrument as he liked.
std::vector<Reading> AlongTheReference(std::vector<Reading> readings, std::vector<std::string>& notes) {
  const auto sweep = separate::turntable::AnalyseSweep(readings);
  if (!sweep || !std::ranges::all_of(readings, IsInSweep)) return readings;
  const bool is_against = sweep->axis.Sense() < 0;
  if (sweep->is_along_y) notes.emplace_back("y follows the reference: it is diagnosed as x, and x as y");
  if (is_against) notes.emplace_back("the autocollimator counts against the reference: it is diagnosed with the other sign");
  for (Reading& r : readings) {
    if (sweep->is_along_y) std::swap(r.autocollimator_yaw_rad, r.autocollimator_tilt_rad);
    if (!is_against) continue;
    r.autocollimator_yaw_rad *= -1.0;
    r.autocollimator_tilt_rad *= -1.0;
  }
  return readings;
}

/// Of the turntable's position. Sweeps, whose small moves are no positions of their own, have one each behind all
/// others.
int PlaceOf(const Reading& r) {
  constexpr int kMostPasses = 1000;
  return IsInSweep(r) ? kParts + kMostPasses * r.setup + r.pass : InTurn(r.target_rad);
}

std::vector<int> PlacesOf(const std::vector<Reading>& readings) {
  std::vector<int> places;
  for (const Reading& r : readings) places.push_back(PlaceOf(r));
  return places;
}

/// 1 where a tooth is met, or a face: readings x teeth. One that meets one position only, which meets no other,
/// cannot be told from the position.
Eigen::MatrixXd Teeth(const std::vector<Reading>& readings) {
  std::map<int, std::set<int>> places_of, teeth_at;
  for (const Reading& r : readings) {
    if (IsInSweep(r)) continue;
    places_of[InTurn(r.reference_rad)].insert(PlaceOf(r));
    teeth_at[PlaceOf(r)].insert(InTurn(r.reference_rad));
  }
  constexpr int kNone = -1;
  std::vector<int> teeth;
  for (const Reading& r : readings) {
    const int tooth = InTurn(r.reference_rad);
    const bool is_told = !IsInSweep(r) && (places_of[tooth].size() > 1 || teeth_at[PlaceOf(r)].size() > 1);
    teeth.push_back(is_told ? tooth : kNone);
  }
  const Eigen::MatrixXd met = model::Indicators(teeth);
  return met.rightCols(met.cols() - (std::ranges::count(teeth, kNone) > 0 ? 1 : 0));
}

/// The way from the middle of each sweep: readings x sweeps.
Eigen::MatrixXd Sweeps_rad(const std::vector<Reading>& readings) {
  std::map<int, std::vector<std::size_t>> sweeps;
  for (std::size_t i = 0; i < readings.size(); ++i)
    if (IsInSweep(readings[i])) sweeps[PlaceOf(readings[i])].push_back(i);
  Eigen::MatrixXd way_rad = Eigen::MatrixXd::Zero(std::ssize(readings), std::ssize(sweeps));
  Eigen::Index sweep = 0;
  for (const auto& [place, members] : sweeps) {
    double middle_rad = 0.0;
    for (const std::size_t i : members) middle_rad += readings[i].target_rad / static_cast<double>(members.size());
    for (const std::size_t i : members)
      way_rad(static_cast<Eigen::Index>(i), sweep) = readings[i].target_rad - middle_rad;
    ++sweep;
  }
  return way_rad;
}

/// Of the turntable's error between neighbouring positions, rms, of x where they were read last.
double TypicalSlope(const std::vector<Reading>& readings) {
  constexpr double kUnknown = 1e-4;  // 20 arcsec a radian: a table of some seconds
  std::map<int, double> x_rad;
  for (const Reading& r : readings)
    if (r.phase == Phase::kFullCircle && std::isfinite(r.autocollimator_yaw_rad))
      x_rad[InTurn(r.target_rad)] = r.autocollimator_yaw_rad;
  double sum2 = 0.0;
  for (auto a = x_rad.begin(), b = a; a != x_rad.end(); a = b)
    if (++b != x_rad.end())
      sum2 += std::pow((b->second - a->second) / (b->first - a->first) * kParts / units::turn, 2);
  return x_rad.size() > 3 ? std::max(kUnknown, std::sqrt(sum2 / static_cast<double>(x_rad.size() - 1))) : kUnknown;
}

double Deviation2(const Eigen::VectorXd& values) {
  return (values.array() - values.mean()).square().mean();
}

/// A zero that follows a temperature is told from the thermometer's, whose noise looks like a wrong coefficient: by
/// the share that noise has of what was logged (errors in variables). Its noise itself the zero does not follow.
void AddThermometer(const std::vector<Reading>& readings, const Scenario& scenario, TwinComparison& comparison) {
  const double noise_K = scenario.environment.sensor_noise_K;
  const auto logged_K = [reference_degC = scenario.environment.reference_degC](const std::vector<Reading>& used) {
    const Eigen::VectorXd above_K = model::Above_K(model::CourseOf(used), reference_degC);
    return Eigen::VectorXd(above_K.array() - above_K.mean());
  };
  const auto smooth_K = [=](const std::vector<Reading>& used) -> Eigen::MatrixXd {
    return model::Smoothed(model::CourseOf(used).time_s, logged_K(used), noise_K);
  };
  const double logged2 = Deviation2(logged_K(readings));
  const bool follows = TurntableOf(scenario).collimator.x_per_kelvin_rad != 0.0 ||
                       TurntableOf(scenario).collimator.y_per_kelvin_rad != 0.0;
  if (!follows || !(noise_K > 0.0) || !(logged2 > 0.0)) return;
  const double share = std::min(1.0, std::pow(noise_K, 2) / logged2);
  comparison.free_courses.push_back({"room.temperature", smooth_K, "the room", std::sqrt(share)});
  const auto rough_K = [=](const std::vector<Reading>& used) -> Eigen::MatrixXd { return logged_K(used) - smooth_K(used); };
  comparison.free_courses.push_back({"room.temperature", rough_K, "the thermometer's noise", 1.0});
}

/// What readings may absorb without anything being wrong: errors of the turntable at every position; of each
/// mounting the constants of x and y and the tilt of the multi-tooth table's axis; what is known to some extent of
/// teeth and of the turntable along a sweep.
void LeaveFree(const std::vector<Reading>& readings, const Scenario& scenario, TwinComparison& comparison) {
  const TurntableSettings& own = TurntableOf(scenario);
  comparison.free_places = TwinComparison::FreePlaces{{"turntable.ez", "turntable.ex"}, PlacesOf, "a position"};
  comparison.free_points = {"turntable.ez", "turntable.ex", "axis.ex", "axis.ey"};
  comparison.free_rounds = 8;  // what a steep ripple shows of a small turn depends on where it is
  comparison.free_sd = [](const model::Point&) { return kFree_rad; };
  const auto add = [&](const std::string& point, const auto& courses, const std::string& of, double sd) {
    if (courses(readings).cols() > 0) comparison.free_courses.push_back({point, courses, of, sd});
  };
  add("multitooth.ez", Teeth, own.HasPolygon() ? "a face" : "a tooth",
      own.HasPolygon() ? kFree_rad : std::max(own.multitooth.u_tooth_rad, kLeastNoise_rad));
  add("multitooth.ex", Teeth, own.HasPolygon() ? "a face" : "a tooth", kToothTilt_rad);
  add("turntable.ez", Sweeps_rad, "a sweep", TypicalSlope(readings));
  AddThermometer(readings, scenario, comparison);
}

/// What is drawn anew at a stop.
std::vector<TwinComparison::Scatter> ScatterOf(const Scenario& scenario) {
  const TurntableSettings& own = TurntableOf(scenario);
  std::vector<TwinComparison::Scatter> scatter = {{"room.temperature", scenario.environment.sensor_noise_K}};
  for (const auto& table : {diagnose::RepeatabilityOf("turntable", own.turntable.repeatability_sd),
                            diagnose::RepeatabilityOf("multitooth", own.multitooth_table.repeatability_sd)})
    scatter.insert(scatter.end(), table.begin(), table.end());
  for (const EffectSettings& e : scenario.effects)
    if (e.name == "multitooth_seating") scatter.push_back({"multitooth.ez", e.parameters.at("scatter")});
  if (own.HasPolygon())  // beside a multi-tooth table the encoder is not read
    scatter.push_back({"turntable.yaw", std::hypot(own.encoder.noise_rad, own.encoder.step_rad / std::sqrt(12.0))});
  return scatter;
}

bool HasX(const Reading& r) {
  return std::isfinite(X_rad(r)) && std::isfinite(r.target_rad) && std::isfinite(r.reference_rad);
}
bool HasBoth(const Reading& r) {
  return HasX(r) && std::isfinite(Y_rad(r));
}

/// Of an instrument of one axis: tilts show nowhere, and nothing is left free for them.
void LeaveOutTilt(TwinComparison& comparison) {
  comparison.channels = {"x"};
  comparison.is_used = HasX;
  comparison.shown = [](const Reading& r) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, X_rad(r)); };
  comparison.show = [](Reading& r, const Eigen::VectorXd& shown_rad) { r.autocollimator_yaw_rad = shown_rad[0]; };
  comparison.noise_of = [both = comparison.noise_of](const Scenario& s, const Reading& r) -> Eigen::VectorXd {
    return both(s, r).head(1);
  };
  comparison.tones = comparison.steps = {{"x", Eigen::VectorXd::Ones(1)}};
  comparison.free_places->points = {"turntable.ez"};
  comparison.free_points = {"turntable.ez"};
  std::erase_if(comparison.free_courses, [](const TwinComparison::FreeCourses& c) { return c.point == "multitooth.ex"; });
}

TwinComparison Comparison(const std::vector<Reading>& readings, const Scenario& scenario) {
  const TurntableSettings& own = TurntableOf(scenario);
  TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowOften();
  comparison.unit = "arcsec";
  comparison.to_SI = arcsec;
  comparison.plausible = 0.5 * arcsec;
  comparison.sizes_by_trace = comparison.alike_by_trace = true;
  if (own.HasPolygon()) comparison.nulled = {"x"};
  comparison.is_used = HasBoth;
  comparison.noise_of = [](const Scenario& s, const Reading&) -> Eigen::VectorXd {
    return Eigen::Vector2d::Constant(std::max(TurntableOf(s).ReadingNoise_rad(), kLeastNoise_rad));
  };
  comparison.scatter = ScatterOf;
  if (!own.HasPolygon())
    comparison.scatter_cause = TwinComparison::ScatterCause{"multitooth_seating", "scatter", "multitooth.ez"};
  LeaveFree(readings, scenario, comparison);
  // Every order of the turntable is free, and of the multi-tooth table where shifts tell its teeth.
  comparison.angles = {{"turntable", &Reading::target_rad, "target angle", "harmonic", 0}};
  if (Teeth(readings).cols() > 0)
    comparison.angles.push_back({"multitooth", &Reading::reference_rad, "reference angle", "harmonic", 0});
  if (!own.HasPolygon()) AddRipples(readings, "x", X_rad, own, comparison);
  const bool shows_tilt = separate::turntable::ShowsTilt(readings);
  if (shows_tilt) AddRipples(readings, "y", Y_rad, own, comparison);
  comparison.tones = comparison.steps = {{"x", Eigen::Vector2d::UnitX()}, {"y", Eigen::Vector2d::UnitY()}};
  comparison.named = {{"direction offset", ""},
                      {"trend", ""}, {"slope", ""},
                      {"tone", "tone"},
                      {"step", "slip"},
                      {"linear map", ""},
                      {"restart", ""},
                      {"reading fringes", "autocollimator_periodic"}};
  comparison.bends = true;
  comparison.shown_by = [has_polygon = own.HasPolygon()](const std::string& effect) {
    return WhatWouldShow(effect, has_polygon);
  };
  comparison.next_measurement = [has_polygon = own.HasPolygon()](const std::string& effect,
                                                                 const std::string& rival) {
    return NextMeasurement(effect, rival, has_polygon);
  };
  const auto lacks = [&readings](double Reading::*value) {
    return std::ranges::none_of(readings, [&](const Reading& r) { return std::isfinite(r.*value); });
  };
  if (lacks(&Reading::temperature_degC)) comparison.unrecorded.emplace_back("autocollimator_temperature");
  if (lacks(&Reading::dwell_s)) comparison.unrecorded.emplace_back("settling");
  if (!HasClock(readings)) comparison.unrecorded.emplace_back("mount_creep");
  if (!shows_tilt) LeaveOutTilt(comparison);
  return comparison;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  std::vector<std::string> notes;
  const std::vector<Reading> reduced = AlongTheReference(AtNominal(readings, TurntableOf(scenario)), notes);
  diagnose::DiagnosisRun run = diagnose::DiagnoseByTwin(reduced, scenario, options, Comparison(reduced, scenario));
  std::ranges::move(notes, std::back_inserter(run.diagnosis.notes));
  TellPeriods(reduced, run.diagnosis);
  return run;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  std::vector<std::string> notes;
  const std::vector<Reading> reduced = AlongTheReference(AtNominal(readings, TurntableOf(scenario)), notes);
  return diagnose::CompareWithTwin(reduced, scenario, Comparison(reduced, scenario));
}

}  // namespace twinbench::benches::turntable
