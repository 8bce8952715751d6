#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/displacement_results.h"
#include "twin/benches/freeform_five_axis/estimators/probe_model.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/twin/factory.h"
#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/products.h"
#include "twin/model/signals.h"

namespace twinbench::benches::freeform {
namespace {

/// 1, t, t^2, t^3 of an axis at each reading.
Eigen::MatrixXd Cubics(const std::vector<Reading>& readings, std::size_t axis, double centre, double half) {
  Eigen::MatrixXd powers(std::ssize(readings), kCubicTerms);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double t = (kCommanded[axis](readings[i]) - centre) / half;
    powers.row(static_cast<Eigen::Index>(i)) << 1.0, t, t * t, t * t * t;
  }
  return powers;
}

std::vector<diagnose::TwinComparison::FreeCourses> FreeOfMachine(const MachineSettings& machine) {
  std::vector<diagnose::TwinComparison::FreeCourses> free;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto cubics = [axis, centre = machine.centre[axis], half = machine.half[axis]](
                            const std::vector<Reading>& readings) { return Cubics(readings, axis, centre, half); };
    for (const char* error : kBodyErrorNames) free.push_back({std::string(kAxisNames[axis]) + "." + error, cubics});
  }
  for (const char* squareness : kSquarenessNames)
    free.push_back({squareness, [](const std::vector<Reading>& readings) {
                      return Eigen::MatrixXd(Eigen::VectorXd::Ones(std::ssize(readings)));
                    }});
  return free;
}

std::vector<std::string> FreeOfMountings() {
  std::vector<std::string> points;
  for (const char* error : kBodyErrorNames) points.push_back(std::string("mount.") + error);
  return points;
}

/// What a free constant may well be: far more than the scenario lets be drawn, far less than hides a fault of the
/// probe. Nothing but sizes tells a detector that is turned by so many hundredths of a radian from a whole machine
/// that is turned under it: squareness, axes, slides and artefact together.
double LargestFree(const FreeformSettings& own, const model::Point& point) {
  constexpr double kTimes = 30.0, kMachine_m = 100.0 * units::um, kMachine_rad = 100.0 * units::arcsec;
  constexpr double kMount_m = units::mm, kMount_rad = 1000.0 * units::arcsec;
  const bool is_turn = point.unit == "arcsec";
  if (point.name.starts_with("mount."))
    return is_turn ? std::max(kMount_rad, kTimes * own.artefact.mounting_rad)
                   : std::max(kMount_m, kTimes * own.artefact.mounting_m);
  const double turn_rad = std::max(own.machine.random_rotation_rad, own.machine.random_squareness_rad);
  return is_turn ? std::max(kMachine_rad, kTimes * turn_rad)
                 : std::max(kMachine_m, kTimes * own.machine.random_translation_m);
}

/// Values of 1 / period, in even steps, so close that a wave between two of them keeps nearly all of its size.
std::vector<double> Frequencies(double first, double last, double range) {
  constexpr int kMost = 1500;  // thinned evenly beyond that, for the time it takes
  const int count = std::min(kMost, 1 + static_cast<int>(std::ceil((last - first) * range * 2.0)));
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first + (last - first) * k / std::max(1, count - 1));
  return values;
}

/// Up to two readings a period; slow ones are drifts.
std::vector<double> Tones_Hz(const std::vector<Reading>& readings) {
  const Eigen::VectorXd time_s = model::CourseOf(readings).time_s;
  const double run_s = time_s[time_s.size() - 1] - time_s[0];
  double step_s = run_s;
  for (Eigen::Index k = 1; k < time_s.size(); ++k) {
    const double between_s = time_s[k] - time_s[k - 1];
    if (between_s > 0.0) step_s = std::min(step_s, between_s);
  }
  constexpr double kSlowest = 4.0;  // periods in the run
  return Frequencies(kSlowest / run_s, 0.5 / step_s, run_s);
}

Eigen::MatrixXd ToneAt(const std::vector<Reading>& readings, double frequency_Hz) {
  return model::Tone(model::CourseOf(readings).time_s, frequency_Hz);
}

/// Part of the light on a fixed place: what is missing elsewhere, and what is shown of it there.
diagnose::TwinComparison::Product Leakage(const std::string& channel, const Quantity& shown_V) {
  constexpr double kFarthest_V = 2.0, kStep_V = 0.1;
  const auto places = [](const std::vector<Reading>&) {
    std::vector<double> values;
    for (int k = 0; k * kStep_V <= 2.0 * kFarthest_V; ++k) values.push_back(k * kStep_V - kFarthest_V);
    return values;
  };
  const auto missing = [shown_V](const std::vector<Reading>& readings, double at_V) {
    Eigen::MatrixXd course(std::ssize(readings), 1);
    for (std::size_t i = 0; i < readings.size(); ++i)
      course(static_cast<Eigen::Index>(i), 0) = at_V - shown_V(readings[i]);
    return course;
  };
  return {"leakage", channel, channel, {"fraction"}, "at", places, missing};
}

/// What depends on a shape that nobody knows, as slopes of the twin times courses.
std::vector<diagnose::TwinComparison::Product> Products(double reference_degC) {
  constexpr double kShortest_m = 2.0 * units::mm,
                   kLongest_m = 40.0 * units::mm;  // of pitches, as the catalogue has
  std::vector<diagnose::TwinComparison::Product> products;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = kAxisNames[axis], point = name + ".t" + name;
    products.push_back(diagnose::SlipAt(name, "x.t" + name));  // between X slide and artefact
    products.push_back(
        diagnose::FollowsTemperature("thermal_growth", name, "z.t" + name, "growth", reference_degC));
    const std::vector<std::string> sizes = {"cosine", "sine"};
    products.push_back(
        diagnose::WaveAlong("cyclic", name, point, "pitch", kCommanded[axis], kShortest_m, kLongest_m));
    products.push_back({"tone", name, point, sizes, "frequency", Tones_Hz, ToneAt});
  }
  for (const auto& [channel, shown_V] : {std::pair{"qpd_x", kQpdX_V}, std::pair{"qpd_y", kQpdY_V}})
    products.push_back(Leakage(channel, shown_V));
  for (const char* channel : {"qpd_x", "qpd_y"})
    products.push_back({"tone", channel, channel, {"cosine_signal", "sine_signal"}, "frequency", Tones_Hz, ToneAt});
  return products;
}

/// Heights of the cells in a wave over the array, of any length and direction: as far apart as two that the array
/// can tell.
diagnose::TwinComparison::ShapedProduct WavesOverTheArray(const ArtefactSettings& artefact) {
  constexpr double kShortest = 0.5, kLongest = 6.0,
                   kStep = 0.5;  // periods over its side, as the catalogue has them
  const auto lengths = static_cast<Eigen::Index>(std::lround((kLongest - kShortest) / kStep)) + 1;
  const auto azimuths = static_cast<Eigen::Index>(std::ceil(units::kPi * kLongest / kStep));
  Eigen::MatrixXd values(lengths * azimuths, 2);
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    values(k, 0) = kShortest + kStep * static_cast<double>(k / azimuths);
    values(k, 1) = units::kPi * (static_cast<double>(k % azimuths) / static_cast<double>(azimuths) - 0.5);
  }
  return {"artefact_form",
          "",
          "cell.height",
          {"cosine", "sine"},
          {"waves", "azimuth"},
          values,
          [side = 2 * artefact.cells + 1](const std::vector<Reading>& readings, const Eigen::VectorXd& shape) {
            Eigen::ArrayXd periods(std::ssize(readings));
            for (std::size_t i = 0; i < readings.size(); ++i)
              periods[static_cast<Eigen::Index>(i)] =
                  shape[0] * (std::cos(shape[1]) * kCellI(readings[i]) + std::sin(shape[1]) * kCellJ(readings[i])) /
                  side;
            return model::Wave(units::turn * periods);
          }};
}

std::vector<diagnose::TwinComparison::Coordinate> Coordinates() {
  std::vector<diagnose::TwinComparison::Coordinate> axes;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const bool turns = IsRotaryAxis(static_cast<int>(axis));
    axes.push_back({kAxisNames[axis], turns ? "deg" : "mm", turns ? units::deg : units::mm, kCommanded[axis]});
  }
  return axes;
}

/// Light that has gone two ways beats with where the spot lies.
std::vector<diagnose::TwinComparison::FringesAlong> SpotFringes(const QuadrantSettings& qpd) {
  constexpr double kShortest_m = 4.0 * units::um, kLongest_m = 100.0 * units::um;
  const auto along = [&qpd](const std::string& name, const Quantity& shown_V) {
    const auto place_m = [qpd, shown_V](const Reading& r) {
      const double all_V = kQpdSum_V(r);
      return estimators::SpotAt_m(shown_V(r) / (std::isfinite(all_V) ? all_V : qpd.sum_V), qpd);
    };
    return diagnose::TwinComparison::Coordinate{name, "um", units::um, place_m};
  };
  return {{"spot.x", along("the spot's x", kQpdX_V), kShortest_m, kLongest_m},
          {"spot.y", along("the spot's y", kQpdY_V), kShortest_m, kLongest_m}};
}

Eigen::VectorXd Noise(const Scenario& scenario, const Reading&) {
  const FreeformSettings& own = FreeformOf(scenario);
  const double quadrants_V = own.qpd.noise_V > 0.0 ? own.qpd.noise_V : QuadrantSettings{}.noise_V;
  const double camera_px = own.ccd.noise_px > 0.0 ? own.ccd.noise_px : CameraSettings{}.noise_px;
  return Eigen::Vector3d(quadrants_V, quadrants_V, camera_px);
}

/// Channels read volts and pixels; what is plausible without a name is a few times the noise of either.
diagnose::TwinComparison Comparison(const Scenario& scenario) {
  constexpr int kRounds = 8;  // spots go far into the bend of the quadrant detector
  const FreeformSettings& own = FreeformOf(scenario);
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowRecord;
  comparison.units = {{"V"}, {"V"}, {"px"}};
  comparison.outliers = "y.ty";
  comparison.noise_of = Noise;
  comparison.free_points = FreeOfMountings();
  comparison.free_courses = FreeOfMachine(own.machine);
  comparison.free_sd = [own](const model::Point& point) { return LargestFree(own, point); };
  comparison.free_rounds = kRounds;
  comparison.products = Products(scenario.environment.reference_degC);
  comparison.shaped_products = {WavesOverTheArray(own.artefact)};
  comparison.interaction_points = {"x.tx", "y.ty", "z.tz"};
  comparison.coordinates = Coordinates();
  comparison.fringes = SpotFringes(own.qpd);
  comparison.angles = {{"a", kCommanded[3]}, {"b", kCommanded[4]}};
  return comparison;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  RefuseDisplacements(scenario, "diagnosis");
  return diagnose::DiagnoseByTwin(readings, scenario, options, Comparison(scenario));
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  RefuseDisplacements(scenario, "prediction");
  return diagnose::CompareWithTwin(readings, scenario, Comparison(scenario));
}

}  // namespace twinbench::benches::freeform
