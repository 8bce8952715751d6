#include "twin/benches/proof_by_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/expected.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/proof_by_closing.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/step_proof.h"

namespace twinbench {
namespace {

using plausible::Expected;
using procedure::ColumnInStep;

constexpr double kShareOfMachineRange = 0.05;  // of an instrument's, which the tilts of its set-ups need too
constexpr double kShareOfVolts = 0.01;
constexpr double kShareOfSpot = 0.4;
constexpr double kShaftStep_rad = 5.0 * units::deg;
constexpr double kBesideRadius_rad = 0.6;         // so that either axis goes a part of it at whole parts of a turn
constexpr double kOffCircle_m = 0.2 * units::mm;  // less than the stroke of any bar, and more than lost motion

/// Those columns that a step of an axis moves, or should leave alone.
std::vector<Expected> MovedByAxes(const Scenario& scenario) {
  std::vector<Expected> moved = ExpectedOf(scenario, {});
  if (scenario.bench == kCircularBench)
    for (Expected& column : moved)
      if (!column.is_angle) column.by_axes = column.nominal ? column.nominal : benches::circular::Radius_m;
  std::erase_if(moved, [](const Expected& column) { return !column.by_axes; });
  if (const auto& compared = FormatOf(scenario.bench).compared)
    moved.push_back({.column = compared->reference,
                     .by_axes = [](const Reading& r) { return r.reference_rad; },
                     .is_angle = true});
  return moved;
}

double& NumberIn(Reading& reading, const Scenario& scenario, const std::string& column) {
  return std::ranges::find(FormatOf(scenario.bench).columns, column, &ReadingColumn::name)->number(reading);
}

/// Controllers count in steps; what is a whole number of these is understood as it is commanded.
double InSteps(double angle_rad) {
  constexpr double kStep_rad = 1e-3 * units::deg;
  return kStep_rad * std::max(1.0, std::round(angle_rad / kStep_rad));
}

/// By how much each axis of a bench's machine goes beside a reading; empty: nothing proves anything.
std::vector<double> StepOf(const Scenario& scenario, const Reading& reading) {
  if (scenario.bench == kCircularBench) {
    const double towards_rad = reading.target_rad + kBesideRadius_rad;
    return {kOffCircle_m * std::cos(towards_rad), kOffCircle_m * std::sin(towards_rad)};
  }
  if (scenario.bench == kTurntableBench)
    return {InSteps(kShareOfMachineRange * FormatOf(scenario.bench).range_of(scenario, "autocollimator_x_arcsec"))};
  if (scenario.bench == kEncoderBench) return {kShaftStep_rad};
  if (scenario.bench != kFreeformBench) return {};
  const auto& qpd = FreeformOf(scenario).qpd;
  const double tilt_rad =
      InSteps(kShareOfSpot * qpd.spot_radius_m / (2.0 * qpd.lens_m));  // a mirror turns light by twice its angle
  return {0.0, 0.0, 0.0, tilt_rad, tilt_rad};
}

/// A reading filed so far beside another.
Reading Beside(const Reading& reading, const std::vector<double>& by, const std::vector<MachineAxis>& axes,
               const Scenario& scenario) {
  const auto& compared = FormatOf(scenario.bench).compared;  // its axis is filed where the reference stands
  const std::string commanded = scenario.bench == kCircularBench ? "commanded_" : "";
  Reading beside = reading;
  for (std::size_t k = 0; k < by.size(); ++k)
    if (by[k] != 0.0)
      NumberIn(beside, scenario,
               compared ? compared->reference : commanded + axes[k].name + "_" + axes[k].unit()) += by[k];
  return beside;
}

/// Behind a sweep nothing has been read at rest yet. Returns false where nothing can be.
bool ShowIn(Reading& here, const Scenario& scenario, const std::vector<Expected>& columns, MachineBench& bench) {
  const auto is_shown = [&](const Expected& c) { return std::isfinite(NumberIn(here, scenario, c.column)); };
  if (std::ranges::any_of(columns, is_shown)) return true;
  try {
    Reading look = bench.instruments.Look();
    for (const Expected& c : columns) NumberIn(here, scenario, c.column) = NumberIn(look, scenario, c.column);
  } catch (const DeviceFault&) {
    return false;  // an instrument that only latches
  }
  return std::ranges::any_of(columns, is_shown);
}

bool ShowsAngles(const Reading& reading) {
  return std::isfinite(reading.autocollimator_yaw_rad);
}

/// What converter and, where the reading shows its angles, autocollimator show now.
Reading ShownNow(RotaryBench& bench, Reading reading, int samples) {
  const Acquisition block = bench.adc.Acquire(samples, false);
  reading.n_samples = block.n_samples;
  for (std::size_t c = 0; c < kChannels; ++c)
    reading.mean_V[c] = block.channel[c].mean_V, reading.std_V[c] = block.channel[c].std_V;
  if (!ShowsAngles(reading)) return reading;
  const AutocollimatorReading angles = bench.autocollimator.Read();
  reading.autocollimator_yaw_rad = angles.yaw_rad, reading.autocollimator_tilt_rad = angles.tilt_rad;
  return reading;
}

}  // namespace

std::function<void(const Reading&)> WayOf(const std::function<void(const Reading&)>& proof) {
  if (!proof) return {};
  return [proof](const Reading& reading) {
    try {
      proof(reading);
    } catch (const DeviceFault& fault) {
      if (fault.kind() != FaultKind::kMoved && fault.kind() != FaultKind::kImplausible && fault.kind() != FaultKind::kChanged) throw;
    }
  };
}

std::function<void(const Reading&)> ProofBySteps(MachineBench& bench, const Scenario& scenario,
                                                 const procedure::MachineOptions& options) {
  if (StepOf(scenario, {}).empty()) return {};
  const auto proof = std::make_shared<procedure::StepProof>(false);
  // Of a comparison from reading to reading either device goes with the other.
  const bool is_compared = FormatOf(scenario.bench).compared.has_value();
  return [&bench, &scenario, &options, proof, is_compared, proved = std::optional<int>(),
          columns = MovedByAxes(scenario),
          close = ProofByClosing(bench, scenario, options)](const Reading& reading) mutable {
    if (is_compared && proved == reading.setup) return close(reading);
    Reading here = reading;
    if (scenario.bench == kCircularBench && !ShowIn(here, scenario, columns, bench)) return;
    std::vector<double> by = StepOf(scenario, reading);
    if (NumberIn(here, scenario, columns[0].column) > 0.0)
      for (double& way : by) way = -way;  // towards the middle of its range
    Reading shown = procedure::ShownBeside(bench, by, options), back = bench.instruments.Look();
    const Reading there = Beside(reading, by, bench.machine.Axes(), scenario);
    std::vector<ColumnInStep> in_step;
    for (const Expected& c : columns) {
      if (scenario.bench == kCircularBench && !std::isfinite(NumberIn(here, scenario, c.column)))
        continue;  // of the other instrument
      const auto since = [&](Reading& later) {
        const double went = NumberIn(later, scenario, c.column) - NumberIn(here, scenario, c.column);
        return c.is_angle ? std::remainder(went, units::turn) : went;
      };
      in_step.push_back(
          {c.column, c.by_axes(there) - c.by_axes(reading), since(shown), c.noise, !c.is_loose, since(back)});
    }
    proof->Require(in_step);
    proved = reading.setup;
    close(reading);
  };
}

std::function<void(const Reading&)> ProofBySteps(RotaryBench& bench, const Scenario& scenario,
                                                 const procedure::Options& options) {
  const RotarySettings& own = RotaryOf(scenario);
  const bool is_calibrated = std::ranges::count(own.procedure.phases, "calibration") > 0;
  const auto wires = std::make_shared<procedure::StepProof>(is_calibrated),
             angles = std::make_shared<procedure::StepProof>(false);
  const auto show = [&bench, &own](const Reading& at) { return ShownNow(bench, at, own.adc.samples); };
  return [&bench, &options, &own, wires, angles, show, columns = MovedByAxes(scenario),
          close = ProofByClosing(bench, scenario, options, show)](const Reading& reading) {
    if (reading.status != ReadingStatus::kOk) return;
    const Reading here = reading.n_samples > 0 ? reading : show(reading);
    Reading unit_yaw, at_zero, beside;
    unit_yaw.target_rad = 1.0, unit_yaw.reference_rad = at_zero.target_rad = at_zero.reference_rad = 0.0;
    const auto V_rad = [&](const Expected& column) { return column.by_axes(unit_yaw) - column.by_axes(at_zero); };
    const double yaw = ShowsAngles(here) ? here.autocollimator_yaw_rad : here.mean_V[0] * V_rad(columns[0]);
    const double towards = yaw > 0.0 ? -1.0 : 1.0;  // the middle of its range
    double yaw_rad = towards * InSteps(kShareOfVolts * own.adc.range_V / std::abs(V_rad(columns[0])));
    procedure::LookBeside(bench, yaw_rad, options, [&] { beside = show(here); });
    const Reading back = show(here);
    std::vector<ColumnInStep> in_step;
    for (std::size_t c = 0; c < kChannels; ++c)
      in_step.push_back({columns[c].column, V_rad(columns[c]) * yaw_rad, beside.mean_V[c] - here.mean_V[c],
                         here.std_V[c] / std::sqrt(here.n_samples) + 0.3 * own.amplifier.hum_V, true,
                         back.mean_V[c] - here.mean_V[c]});
    wires->Require(in_step);
    if (!ShowsAngles(here)) return close(here);
    const auto angle = [&](const char* column, double should_rad, double Reading::*shown_rad) {
      return ColumnInStep{column,
                          should_rad,
                          beside.*shown_rad - here.*shown_rad,
                          own.autocollimator.noise_rad,
                          true,
                          back.*shown_rad - here.*shown_rad};
    };
    angles->Require({angle("autocollimator_yaw_arcsec", yaw_rad, &Reading::autocollimator_yaw_rad),
                     angle("autocollimator_tilt_arcsec", 0.0, &Reading::autocollimator_tilt_rad)});
  };
}

}  // namespace twinbench
