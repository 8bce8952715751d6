#pragma once

#include <memory>
#include <mutex>

#include "twin/core/scenario.h"
#include "twin/core/stream.h"
#include "twin/diagnose/engine/projector.h"

/// Runs of the twin that differ in everything that may differ without being wrong.
namespace twinbench::hidden {

inline constexpr double kSensitivity_V_m = 2000.0;  // of the rotary bench's PSDs

/// The designs that cases are made with.
enum class Design {
  kRotary,  // rotary_4dof, re-seated
  kStops,
  kSweep,          // encoder_comparison
  kStopsAllKnown,  // the same with two mountings of the device, and its lines and teeth stated
  kSweepAllKnown,
  kTurntable,  // turntable_autocollimator, two tilts and eccentricities, with a sweep
  kHob,        // hob_transmission, two heads and two speeds
  kCircles,    // circular_motion, two radii and the grid
  kFreeform,   // freeform_five_axis, four mountings
  kStopsInWarmRoom  // encoder_comparison, whose room changes
};
struct DesignNames {
  std::string name, bench;
  std::vector<std::string> keys;  // in which it differs from the bench's scenario
};
const DesignNames& NamesOf(Design design);
inline const std::string& BenchOf(Design design) { return NamesOf(design).bench; }

/// What is believed of the bench.
Scenario Believed(Design design);

/// The bench of one case: tables, mountings, room and dwells drawn from `seed`, as believed otherwise.
Scenario Drawn(Design design, std::uint64_t seed);

/// Carries the scenario out on the twin of its bench.
std::vector<Reading> TakeReadings(const Scenario& actual);

/// Adds a signal to what the readings show: readings x channels, SI. Rotary bench: four PSD axes; turntable: x and
/// y; circles: radial and tangential; five axes: quadrants' x and y [V], camera [px]; the others: the angle.
void AddTo(const std::string& bench, const Eigen::MatrixXd& signal, std::vector<Reading>& readings);

/// Measures signatures in units of noise after projection, by what a clean run of the design leaves open, made when the
/// first one is asked for; where a design draws its schedule, by one of the same schedule.
class SignatureScale {
 public:
  explicit SignatureScale(Design design) : design_(design) {}

  /// Length of what two runs of the same schedule differ by.
  /// @param seed  Of the scenario that both were drawn by.
  double Rho(const std::vector<Reading>& with, const std::vector<Reading>& without, std::uint64_t seed) const;

 private:
  struct Clean {
    diagnose::LinearRun run;
    diagnose::NoiseModel noise;
    std::unique_ptr<diagnose::Projector> projector;
  };

  const Clean& CleanRun(std::uint64_t seed) const;
  Eigen::VectorXd Rows(std::vector<Reading> readings, const diagnose::LinearRun& clean) const;

  Design design_;
  mutable std::mutex one_at_a_time_;
  mutable std::map<std::uint64_t, Clean> clean_;  // by the seed of the schedule
};

/// Of the design, one a process.
const SignatureScale& ScaleOf(Design design);

double UniformIn(Stream& stream, double lower, double upper);
double LogUniformIn(Stream& stream, double lower, double upper);

}  // namespace twinbench::hidden
