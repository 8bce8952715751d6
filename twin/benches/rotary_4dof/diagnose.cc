#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/columns.h"
#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/names.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/compared.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/products.h"
#include "twin/model/signals.h"

namespace twinbench::benches::rotary {
namespace {

using diagnose::TwinComparison;
using separate::Clamping;

constexpr double kTableAngle_rad = 500.0 * units::arcsec, kTableLength_m = 0.5 * units::mm;
constexpr double kMountAngle_rad = 0.05, kMountLength_m = 10.0 * units::mm;
constexpr int kNowhere = -1;  // of a reading in the calibration

constexpr std::array<const char*, 4> kOfTarget = {"target.ex", "target.ey", "target.ez", "target.dy"};
constexpr std::array<const char*, 5> kOfReference = {"reference.ex", "reference.ey", "reference.ez", "reference.dx",
                                                     "reference.dy"};

bool IsUsable(const Reading& r) {
  if (r.status != ReadingStatus::kOk) return false;
  if (!std::ranges::all_of(r.mean_V, [](double V) { return std::isfinite(V); })) return false;
  if (IsInCalibration(r)) return std::isfinite(r.autocollimator_yaw_rad + r.autocollimator_tilt_rad);
  return r.phase == Phase::kFullCircle && std::isfinite(r.target_rad + r.reference_rad);
}

std::vector<Reading> Usable(const std::vector<Reading>& readings) {
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), IsUsable);
  return used;
}

/// Where tables stood at each used reading, and in which set-up. The target stands behind its positions in the
/// calibration, whose mounting is none of the set-ups.
struct Places {
  separate::Design design;
  std::vector<int> target, reference, setup, seat;
};

/// With the clamping that the scenario and its effects state.
Places PlacesOf(const std::vector<Reading>& used, const Scenario& scenario) {
  std::vector<measure::Motion> labels;
  for (const Reading& r : used) {
    measure::Motion& label = labels.emplace_back();
    label.reading = r.reading;
    label.setup = r.setup;
    label.phase = r.phase;
    label.target_rad = r.target_rad;
    label.reference_rad = r.reference_rad;
    label.status = ReadingStatus::kOk;
  }
  separate::LayoutOptions options = separate::OptionsFrom(scenario).layout;
  if (std::ranges::count(scenario.effects, "reclamp_frame", &EffectSettings::name) > 0)
    options.clamping = Clamping::kReclamp;
  const separate::Layout layout = separate::FindLayout(labels, measure::NominalGeometry(scenario), options);
  const std::vector<int> nowhere(used.size(), kNowhere);
  Places places{layout.design, std::vector<int>(used.size(), layout.design.n), nowhere, nowhere, nowhere};
  for (const separate::Sample& s : layout.samples) {
    places.target[s.motion] = s.target;
    places.reference[s.motion] = s.reference;
    places.setup[s.motion] = s.setup;
    if (layout.design.setups[static_cast<std::size_t>(s.setup)].clamping == Clamping::kReseat)
      places.seat[s.motion] = s.setup;
  }
  return places;
}

/// 1 where a label has a value: readings x values; not where there is nothing.
Eigen::MatrixXd WhereAny(const std::vector<int>& labels) {
  const Eigen::MatrixXd all = model::Indicators(labels);
  return all.rightCols(all.cols() - (std::ranges::count(labels, kNowhere) > 0 ? 1 : 0));
}

/// What readings may absorb without anything being wrong: errors of both tables at every position; the constants of
/// every mounting, of the calibration's as well; the seat of a reference that was re-mounted whole.
void LeaveFree(const Places& places, TwinComparison& comparison) {
  comparison.free_places = TwinComparison::FreePlaces{
      {kOfTarget.begin(), kOfTarget.end()}, [at = places.target](const auto&) { return at; }, "a position"};
  const auto add = [&](const std::string& point, const Eigen::MatrixXd& courses, const std::string& of) {
    if (courses.cols() > 0)
      comparison.free_courses.push_back({point, [courses](const auto&) { return courses; }, of});
  };
  for (const char* point : kOfReference) add(point, WhereAny(places.reference), "a position");
  for (const char* point : {"mount.ez", "mount.ex", "mount.ey", "mount.dy"})
    add(point, model::Indicators(places.setup), "a mounting");
  for (const char* point : {"seat.ex", "seat.ey", "seat.dx", "seat.dy"}) add(point, WhereAny(places.seat), "a mounting");
  comparison.free_sd = [](const model::Point& point) {
    const bool is_of_table = point.name.starts_with("target") || point.name.starts_with("reference");
    if (point.unit == "um") return is_of_table ? kTableLength_m : kMountLength_m;
    return is_of_table ? kTableAngle_rad : kMountAngle_rad;
  };
}

/// What the diagnosis is told: what has no number in a reading of these phases is no reading.
std::vector<Reading> Wanted(std::vector<Reading> readings) {
  std::erase_if(readings, [](const Reading& r) { return !IsInCalibration(r) && r.phase != Phase::kFullCircle; });
  return readings;
}

/// Causes that are a point of the twin times a signal that all benches have.
void AddSignals(const std::vector<Reading>& used, const Scenario& scenario, TwinComparison& comparison) {
  for (int c = 0; c < kChannels; ++c)
    comparison.tones.push_back({kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c), true});
  comparison.tones.push_back({"yaw", Eigen::Vector4d(1.0, 0.0, 1.0, 0.0), true});
  comparison.tones.push_back({"tilt", Eigen::Vector4d(0.0, 1.0, 0.0, 1.0), true});
  comparison.tones.push_back({"all", Eigen::Vector4d::Ones(), true});
  comparison.tones.push_back({"all", Eigen::MatrixXd::Identity(kChannels, kChannels), true});
  comparison.steps_at = {{"slip", "yaw", "grating.yaw", "angle"},
                         {"slip", "tilt", "grating.tilt", "angle"},
                         {"slip", "lateral", "grating.lateral", "shift"},
                         {"mode_hop", "", "laser.wavelength", "wavelength_step"}};
  for (const std::string motion : {"yaw", "tilt", "roll", "lateral"})
    comparison.motions.push_back({motion, "grating." + motion});
  if (!model::HasTemperature(model::CourseOf(used))) {
    comparison.unrecorded = {"wavelength_temperature", "post_growth", "thermal_tilt"};
    return;
  }
  for (const std::string where : {"yaw", "tilt"})
    comparison.products.push_back(diagnose::FollowsTemperature("thermal_tilt", where, "grating." + where,
                                                               "tilt_per_kelvin",
                                                               scenario.environment.reference_degC));
}

/// A wrong sensitivity of both axes of a PSD looks the same as some.
double Listed(const std::string& effect, const std::string&) {
  const bool is_doubled = effect == "stray_light" || effect == "background" || effect == "psd_distance";
  return is_doubled ? diagnose::tuning::kListedDoubled : diagnose::tuning::kListed;
}

/// A wrong constant of the bench: large ones bend.
bool IsOfBench(const std::string& effect) {
  const EffectEntry* entry = FindEffect(effect, kRotaryBench);
  return effect == "incidence_offset" || (entry && entry->ChangesKeysAlone() && effect != "psd_nonlinearity");
}

/// The scenario of the record: with the noise that it has.
Scenario AsRead(Scenario scenario, const std::vector<Reading>& readings, Estimator estimator) {
  scenario.noise_free = IsNoiseFree(Usable(readings));
  // Equation 13 adds the reference's wobble as it is, however the grating was clamped.
  if (estimator == Estimator::kPublished) RotaryOf(scenario).procedure.clamping = "reseat";
  return scenario;
}

std::vector<diagnose::Alternative> Alternatives(const Scenario& scenario) {
  std::vector<diagnose::Alternative> alternatives;
  for (const char* where : {"swap_xy_a", "swap_xy_b", "swap_psds", "negate_psd_a_x", "negate_psd_a_y",
                            "negate_psd_b_x", "negate_psd_b_y"})
    alternatives.push_back({"convention", where, true});
  const bool is_reseated = RotaryOf(scenario).procedure.clamping == "reseat" &&
                           std::ranges::count(scenario.effects, "reclamp_frame", &EffectSettings::name) == 0;
  if (is_reseated) alternatives.push_back({"reclamp_frame", ""});
  return alternatives;
}

/// Of one table: root mean square by component; those that nobody reads are left out.
nlohmann::json RmsJson(std::span<const char* const> points, const Eigen::MatrixXd& errors) {
  nlohmann::json out = nlohmann::json::object();
  Eigen::Index column = 0;
  for (const std::string point : points) {
    const std::string component = point.substr(point.find('.') + 1);
    const bool is_angle = component.starts_with("e");
    out[component + (is_angle ? "_arcsec" : "_um")] =
        model::Rms(errors.col(column++)) / (is_angle ? units::arcsec : units::um);
  }
  return out;
}

}  // namespace

const std::vector<TwinComparison::KnownConstant>& CalibratedConstants() {
  static const std::vector<TwinComparison::KnownConstant> constants = {
      {"psd_gain", "psd_a_x", "gain_error", 1e-4},      {"psd_gain", "psd_a_y", "gain_error", 1e-4},
      {"psd_gain", "psd_b_x", "gain_error", 1e-4},      {"psd_gain", "psd_b_y", "gain_error", 1e-4},
      {"psd_roll", "psd_a", "roll", 1e-4},              {"psd_roll", "psd_b", "roll", 1e-4},
      {"psd_distance", "psd_a", "distance_error", 10e-6}, {"psd_distance", "psd_b", "distance_error", 10e-6},
      {"wavelength_offset", "", "wavelength_error", 0.05e-9}, {"incidence_offset", "", "incidence", 1e-4}};
  return constants;
}

TwinComparison ComparisonWith(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator,
                              const model::FollowMaker& follow) {
  const bool published = estimator == Estimator::kPublished;
  const std::vector<Reading> used = Usable(readings);
  TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = follow;
  comparison.unit = "um";
  comparison.to_SI = units::um;
  comparison.plausible = 0.5 * units::um;
  comparison.is_used = IsUsable;
  comparison.shown = [geometry = measure::NominalGeometry(scenario)](const Reading& r) -> Eigen::VectorXd {
    return measure::OnSurface(r.mean_V, geometry);
  };
  comparison.at_their_times = [adc = RotaryOf(scenario).adc](const std::vector<Reading>& at_begin) {
    return AtMiddleOfBlocks(at_begin, adc);
  };
  StateNoise(used, scenario, comparison);
  LeaveFree(PlacesOf(used, scenario), comparison);
  if (!published) comparison.known = CalibratedConstants();
  AddSignals(used, scenario, comparison);
  comparison.own_families = [=, sample_V = SampleNoise_V(used, scenario)](const diagnose::Compared& c, const auto&,
                                                                         const auto&) {
    return OwnFamilies(c, scenario, sample_V, published);
  };
  comparison.structure = [scenario](const diagnose::Compared& c, diagnose::unknown::Design& design) {
    SetStructure(c, scenario, design);
  };
  comparison.alike_by_trace = true;
  comparison.asked_points = 8.0;
  comparison.listed = Listed;
  comparison.may_bend = IsOfBench;
  comparison.bends = true;
  comparison.next_measurement = NextMeasurement;
  return comparison;
}

namespace {

/// The twin has no probes: it cannot say what they should have shown.
void RefuseProbes(const std::vector<Reading>& readings) {
  if (ShowsProbes(readings))
    throw InputError("the readings",
                     "displacements of probes are not diagnosed: their error motions are in results.json",
                     "voltages of the PSDs");
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& as_read, const Scenario& stated,
                                const diagnose::DiagnoseOptions& options) {
  RefuseProbes(as_read);
  std::vector<Reading> readings = Wanted(as_read);
  std::vector<diagnose::Cause> decided;
  if (!diagnose::IsExcluded(options, "convention")) decided = UndoLabelBlunder(stated, readings);
  const Scenario scenario = AsRead(stated, readings, options.model);
  const model::FollowMaker follow = FollowOnPsds(options.model == Estimator::kPublished);
  diagnose::DiagnosisRun result = diagnose::DiagnoseByTwin(
      readings, scenario, options,
      [&](const Scenario& believed) { return ComparisonWith(readings, believed, options.model, follow); },
      Alternatives(scenario), decided);
  for (const char* where : {"reverse_target", "reverse_reference", "index_offset"}) {
    result.diagnosis.invisible.push_back(
        {"convention", where, "the positions that the separated errors belong to"});
  }
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& as_read, const Scenario& stated, Estimator estimator) {
  RefuseProbes(as_read);
  const std::vector<Reading> readings = Wanted(as_read);
  const Scenario scenario = AsRead(stated, readings, estimator);
  const model::FollowMaker follow = FollowOnPsds(estimator == Estimator::kPublished);
  return diagnose::CompareWithTwin(readings, scenario, ComparisonWith(readings, scenario, estimator, follow));
}

/// The unknowns begin with those of the target, position by position and the calibration last, and then those of the
/// reference, point by point.
nlohmann::json ChangeOfTables(const diagnose::DiagnosisRun& found, const Scenario& scenario) {
  const diagnose::LeftOver fitted = diagnose::FitAll(found.run, found.noise, found.accepted);
  const Eigen::VectorXd change = fitted.unknowns_after - fitted.unknowns_before;
  const Eigen::Index n = RotaryOf(scenario).procedure.positions, places = found.run.nuisance.blocks;
  const Eigen::Index of_target = std::ssize(kOfTarget), of_reference = std::ssize(kOfReference);
  Require(places >= n && change.size() >= of_target * places + of_reference * n, "a rotary run begins with the errors of both tables");
  const Eigen::MatrixXd target = change.head(of_target * n).reshaped(of_target, n).transpose();
  const Eigen::MatrixXd reference = change.segment(of_target * places, of_reference * n).reshaped(n, of_reference);
  return {{"target", RmsJson(kOfTarget, target)}, {"reference", RmsJson(kOfReference, reference)}};
}

}  // namespace twinbench::benches::rotary
