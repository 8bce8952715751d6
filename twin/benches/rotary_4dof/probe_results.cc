#include "twin/benches/rotary_4dof/parts_of_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/rotary_4dof/columns.h"
#include "twin/benches/rotary_4dof/estimators/far_readings.h"
#include "twin/benches/rotary_4dof/estimators/probe_separation.h"
#include "twin/benches/rotary_4dof/estimators/standing_orders.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"
#include "twin/report/error_motion_json.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::rotary {
namespace {

using report::DirectedMotion;
using separate::ErrorMotion;
using separate::OfTurns;
using separate::PlotCentre;
using separate::rotary::FarReading;
using separate::rotary::OfStandingOrders;
using separate::rotary::ProbeTurns;
using separate::rotary::RadialMotion;
using separate::rotary::ReplaceFar;
using separate::rotary::SeparateRadial;
using separate::rotary::TurnsOf;

constexpr const char* kArtefactInIt =
    "the artefact's roundness is in it: a reversal or three probes and more separate it";
constexpr const char* kOneAxis = "displacements of probes at one axis: there is no second table to be separated";

/// The probes' columns in the order of TurnsOf.
enum ProbeAt : std::size_t { kAxialAt = kMostProbes, kTiltXAt, kTiltYAt };

std::vector<Quantity> AllColumns() {
  std::vector<Quantity> columns;
  for (int k = 0; k < kMostProbes; ++k) columns.push_back(ProbeRadial_m(k));
  for (const Quantity& other : {kProbeAxial_m, kProbeTiltX_rad, kProbeTiltY_rad}) columns.push_back(other);
  return columns;
}

std::vector<std::size_t> RadialOf(const ProbeTurns& mounting) {
  std::vector<std::size_t> radial;
  for (std::size_t k = 0; k < kMostProbes; ++k) {
    if (mounting.shown[k].rows() > 0) radial.push_back(k);
  }
  return radial;
}

std::vector<double> PlacesOfProbes(const std::vector<std::size_t>& radial, const ProbeSettings& probes) {
  std::vector<double> at_rad;
  for (const std::size_t k : radial) {
    if (k >= probes.angles_rad.size())
      throw InputError("probes.angles_deg",
                       fmt::format("probe {} was read, and {} angles are stated", k + 1, probes.angles_rad.size()),
                       "an angle for each probe, as in --set 'probes.angles_deg=[0, 90, 210]'");
    at_rad.push_back(probes.angles_rad[k]);
  }
  return at_rad;
}

DirectedMotion Directed(const std::string& name, bool is_angle, const ErrorMotion& motion,
                        PlotCentre centre = PlotCentre::kLeastSquares) {
  DirectedMotion directed{name, is_angle, OfStandingOrders(motion)};
  directed.centre = centre;
  if (motion.cov.size() > 0) directed.parts = {{"repeatability", directed.motion.cov}};
  return directed;
}

void AddRadial(const RadialMotion& radial, std::vector<DirectedMotion>& all) {
  if (radial.along) all.push_back(Directed("radial_fixed", false, *radial.along));
  if (radial.x) all.push_back(Directed("radial_fixed_x", false, *radial.x));
  if (radial.y) all.push_back(Directed("radial_fixed_y", false, *radial.y));
  if (radial.rotating) all.push_back(Directed("radial_rotating", false, *radial.rotating));
}

std::vector<DirectedMotion> AxialAndTilts(const ProbeTurns& m) {
  std::vector<DirectedMotion> all;
  if (m.shown[kAxialAt].rows() > 0)
    all.push_back(Directed("axial", false, OfTurns(m.angle_rad, m.shown[kAxialAt]), PlotCentre::kPolarChart));
  const Eigen::MatrixXd &x = m.shown[kTiltXAt], &y = m.shown[kTiltYAt];
  if (x.rows() > 0) all.push_back(Directed("tilt_fixed_x", true, OfTurns(m.angle_rad, x)));
  if (y.rows() > 0) all.push_back(Directed("tilt_fixed_y", true, OfTurns(m.angle_rad, y)));
  if (x.rows() == 0 || x.rows() != y.rows()) return all;
  const Eigen::MatrixXd turning =
      x * m.angle_rad.array().cos().matrix().asDiagonal() + y * m.angle_rad.array().sin().matrix().asDiagonal();
  all.push_back(Directed("tilt_rotating", true, OfTurns(m.angle_rad, turning)));
  return all;
}

std::vector<std::string> NotesOf(const RadialMotion& radial, const ProbeTurns& first) {
  std::vector<std::string> notes;
  if (!radial.lost_orders.empty())
    notes.push_back(fmt::format(
        "orders {} of the artefact are not seen by probes at these angles: they are in the radial motion",
        fmt::join(radial.lost_orders, ", ")));
  if (radial.separated_by == "probes") notes.push_back("order 1 is where the artefact stands");
  if (first.is_interpolated)
    notes.push_back(
        "readings lay at other angles from turn to turn: values are linear between two of them, which lowers what "
        "varies from one to the next");
  if (first.incomplete > 0)
    notes.push_back(fmt::format("of {} whole turns more than two readings in a row are missing: they are left out", first.incomplete));
  if (first.Turns() < 2) notes.push_back("one turn: there is no asynchronous motion, and no uncertainty");
  return notes;
}

/// Width of the artefact's deviations about their least-squares circle.
nlohmann::json RoundnessJson(const ErrorMotion& artefact, separate::ErrorMotionDraws& draws) {
  const separate::ErrorMotionValue width =
      EvaluateErrorMotion(OfStandingOrders(artefact), PlotCentre::kLeastSquares, draws).synchronous;
  nlohmann::json json = {{"value", report::In(units::um, width.value)}};
  if (std::isfinite(width.u)) json["u"] = report::In(units::um, width.u);
  if (std::isfinite(width.bias)) json["bias"] = report::In(units::um, width.bias);
  return json;
}

/// How far the artefact stands off the axis, by each probe's order 1.
nlohmann::json EccentricityJson(const ProbeTurns& m, const std::vector<std::size_t>& radial) {
  nlohmann::json json = nlohmann::json::object();
  for (const std::size_t k : radial) {
    const ErrorMotion motion = OfTurns(m.angle_rad, m.shown[k]);
    const Eigen::VectorXd c = m.angle_rad.array().cos(), s = m.angle_rad.array().sin();
    const double n = static_cast<double>(c.size()),
                 amplitude_m = 2.0 / n * std::hypot(c.dot(motion.contour), s.dot(motion.contour));
    nlohmann::json& own = json[fmt::format("probe_{}_um", k + 1)] = {{"value", report::In(units::um, amplitude_m)}};
    if (motion.cov.size() > 0) own["u"] = report::In(units::um, std::sqrt(2.0 / n * motion.cov.diagonal().mean()));
  }
  return json;
}

/// Of readings that were replaced.
nlohmann::json LeftOutJson(const std::vector<FarReading>& far) {
  nlohmann::json all = nlohmann::json::array();
  for (const FarReading& one : far)
    all.push_back({{"reading", one.reading}, {"column", one.column}, {"times_scatter", one.times}});
  return all;
}

std::string LeftOutText(const std::vector<FarReading>& far) {
  std::string text;
  for (const FarReading& one : far) {
    const bool is_angle = one.column.ends_with("arcsec");
    text += fmt::format(
        "doubtful: {} of reading {} (row {}; {:.6g} deg) lies {:.3g} {} from the curve through its neighbours, {:.2g} "
        "times the scatter of the others, and no other turn does: left out\n",
        one.column, one.reading, one.reading + 1, one.target_rad / units::deg,
        one.off / (is_angle ? units::arcsec : units::um), is_angle ? "arcsec" : "µm", one.times);
  }
  return text;
}

}  // namespace

report::Evaluation EvaluateProbes(const Scenario& scenario, const std::vector<Reading>& all_readings) {
  const ProbeSettings& probes = RotaryOf(scenario).probes;
  std::vector<Reading> readings = all_readings;
  const std::vector<FarReading> left_out = ReplaceFar(AllColumns(), readings);
  const std::vector<ProbeTurns> mountings = TurnsOf(readings, AllColumns());
  report::Evaluation evaluation;
  evaluation.results = {{"instrument", "probes"}, {"readings", readings.size()}, {"not_separated", kOneAxis}};
  evaluation.not_separated = kOneAxis;
  if (mountings.empty()) {
    evaluation.results["notes"] = {"no whole turn was read"};
    evaluation.summary = "no whole turn was read: there are no error motions\n";
    return evaluation;
  }
  const ProbeTurns& first = mountings.front();
  const std::vector<std::size_t> radial_at = RadialOf(first);
  const RadialMotion radial =
      SeparateRadial(mountings, radial_at, PlacesOfProbes(radial_at, probes), probes.reversed_mounting);
  separate::ErrorMotionDraws draws;
  report::ErrorMotionTexts motions;
  std::vector<DirectedMotion> directed;
  AddRadial(radial, directed);
  AppendErrorMotions(
      "target", directed,
      radial.separated_by.empty() ? std::vector<std::string>{kArtefactInIt} : std::vector<std::string>{}, draws,
      motions);
  AppendErrorMotions("target", AxialAndTilts(first), {}, draws, motions);
  const std::vector<std::string> notes = NotesOf(radial, first);
  evaluation.results.update({{"turns", first.Turns()},
                             {"angles_per_turn", first.angle_rad.size()},
                             {"iso230_7", motions.json},
                             {"notes", notes}});
  if (!radial_at.empty()) evaluation.results["eccentricity"] = EccentricityJson(first, radial_at);
  evaluation.summary =
      fmt::format("{} turns of probes, {} readings each\n{}", first.Turns(), first.angle_rad.size(), motions.text);
  if (radial.artefact) {
    evaluation.results["artefact"] = {{"roundness_um", RoundnessJson(*radial.artefact, draws)},
                                      {"separated_by", radial.separated_by}};
    evaluation.summary +=
        fmt::format("artefact                roundness {:.3f} um, separated by {}\n",
                    evaluation.results["artefact"]["roundness_um"]["value"].get<double>(), radial.separated_by);
  }
  if (radial.separated_by.empty() && !radial_at.empty())
    evaluation.summary += fmt::format("note: {}\n", kArtefactInIt);
  if (!left_out.empty()) evaluation.results["left_out"] = LeftOutJson(left_out);
  evaluation.summary += LeftOutText(left_out);
  for (const std::string& note : notes) evaluation.summary += fmt::format("note: {}\n", note);
  return evaluation;
}

}  // namespace twinbench::benches::rotary
