#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/twin/factory.h"
#include "twin/diagnose/by_twin.h"

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

/// It turns the spot about the detector's middle: arcseconds show nothing, and what would show is a detector that
/// is turned.
constexpr const char* kAboutTheBeam = "b.rz";

std::vector<diagnose::TwinComparison::FreeCourses> FreeOfMachine(const MachineSettings& machine) {
  std::vector<diagnose::TwinComparison::FreeCourses> free;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto cubics = [axis, centre = machine.centre[axis], half = machine.half[axis]](
                            const std::vector<Reading>& readings) { return Cubics(readings, axis, centre, half); };
    for (const char* error : kBodyErrorNames) {
      const std::string point = std::string(kAxisNames[axis]) + "." + error;
      if (point != kAboutTheBeam) free.push_back({point, cubics});
    }
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

/// [cos, sin] of so many periods.
Eigen::MatrixXd Waves(const Eigen::ArrayXd& periods) {
  Eigen::MatrixXd waves(periods.size(), 2);
  waves << (units::turn * periods).cos(), (units::turn * periods).sin();
  return waves;
}

Eigen::ArrayXd Along(const std::vector<Reading>& readings, std::size_t axis) {
  Eigen::ArrayXd at(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i)
    at[static_cast<Eigen::Index>(i)] = kCommanded[axis](readings[i]);
  return at;
}

Eigen::ArrayXd Times_s(const std::vector<Reading>& readings) {
  Eigen::ArrayXd time_s(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i)
    time_s[static_cast<Eigen::Index>(i)] = ToSeconds(readings[i].time);
  return time_s;
}

/// Values of 1 / period, in even steps, so close that a wave between two of them keeps nearly all of its size.
std::vector<double> Frequencies(double first, double last, double range) {
  const int count = 1 + static_cast<int>(std::ceil((last - first) * range * 2.0));
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first + (last - first) * k / std::max(1, count - 1));
  return values;
}

std::vector<double> Pitches_m(const std::vector<Reading>& readings, std::size_t axis) {
  constexpr double kLongest_m = 40.0 * units::mm, kShortest_m = 2.0 * units::mm;  // as the catalogue has them
  const Eigen::ArrayXd at = Along(readings, axis);
  std::vector<double> pitches = Frequencies(1.0 / kLongest_m, 1.0 / kShortest_m, at.maxCoeff() - at.minCoeff());
  for (double& value : pitches) value = 1.0 / value;
  std::ranges::reverse(pitches);
  return pitches;
}

/// Up to two readings a period; slow ones are drifts.
std::vector<double> Tones_Hz(const std::vector<Reading>& readings) {
  const Eigen::ArrayXd time_s = Times_s(readings);
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
  return Waves(Times_s(readings) * frequency_Hz);
}

/// Waves whose period nobody knows: as slopes of the twin times waves.
std::vector<diagnose::TwinComparison::Product> WavesOfUnknownPeriod() {
  std::vector<diagnose::TwinComparison::Product> products;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = kAxisNames[axis], point = name + ".t" + name;
    const std::vector<std::string> sizes = {"cosine", "sine"};
    products.push_back(
        {"cyclic", name, point, sizes, "pitch",
         [axis](const std::vector<Reading>& r) { return Pitches_m(r, axis); },
         [axis](const std::vector<Reading>& r, double pitch_m) { return Waves(Along(r, axis) / pitch_m); }});
    products.push_back({"tone", name, point, sizes, "frequency", Tones_Hz, ToneAt});
  }
  for (const char* channel : {"qpd_x", "qpd_y"})
    products.push_back({"tone", channel, channel, {"cosine_signal", "sine_signal"}, "frequency", Tones_Hz, ToneAt});
  return products;
}

/// Channels read volts and pixels; what is plausible without a name is a few times the noise of either.
diagnose::TwinComparison Comparison(const Scenario& scenario) {
  constexpr double kFittedRank = 3e-4;  // as the rigorous estimator has it
  constexpr int kRounds = 8;            // spots go far into the bend of the quadrant detector
  const FreeformSettings& own = FreeformOf(scenario);
  const double quadrants_V = own.qpd.noise_V > 0.0 ? own.qpd.noise_V : QuadrantSettings{}.noise_V;
  const double camera_px = own.ccd.noise_px > 0.0 ? own.ccd.noise_px : CameraSettings{}.noise_px;
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowRecord;
  comparison.unit = "V or px";
  comparison.noise_of_channel = {quadrants_V, quadrants_V, camera_px};
  comparison.free_points = FreeOfMountings();
  comparison.free_courses = FreeOfMachine(own.machine);
  comparison.free_rank = kFittedRank;
  comparison.free_rounds = kRounds;
  comparison.products = WavesOfUnknownPeriod();
  comparison.angles = {{"a", kCommanded[3]}, {"b", kCommanded[4]}};
  return comparison;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  return diagnose::DiagnoseByTwin(readings, scenario, options, Comparison(scenario));
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::CompareWithTwin(readings, scenario, Comparison(scenario));
}

}  // namespace twinbench::benches::freeform
