#include "twin/benches/turntable_autocollimator/twin/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/world.h"
#include "twin/core/built.h"
#include "twin/core/device_fault.h"
#include "twin/core/happened_once.h"
#include "twin/core/numbered_runs.h"
#include "twin/sim/setup_check.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {

namespace {

constexpr double kTravel_rad = 10.0 * units::turn;

}  // namespace

struct TurntableTwin::Impl : Clock, MachineController, InstrumentSet, MachineFixture, Indexer, Simulation, NumberedRuns {
  explicit Impl(const Scenario& its_scenario) : begun(its_scenario), scenario(its_scenario) { Begin(); }

  void Begin() { world = std::make_unique<TurntableWorld>(scenario); }

  // Clock
  Time Now() const override { return world->queue().Now(); }
  void Wait(Duration duration) override { world->queue().RunUntil(Now() + duration); }

  // Controller
  const std::vector<MachineAxis>& Axes() const override { return axes; }
  std::vector<AxisLimits> Travel() override { return {{.lower = -kTravel_rad, .upper = kTravel_rad}}; }
  void StartMove(const std::vector<double>& to, double /*feed_m_s*/) override {
    Require(to.size() == axes.size(), "a move has one coordinate an axis");
    if (!(std::abs(to[0]) <= kTravel_rad))
      throw DeviceFault(FaultKind::kLimit, axes[0].name,
                        fmt::format("{:.6g} deg lies outside its travel of {:.6g} deg either way", to[0] / units::deg,
                                    kTravel_rad / units::deg));
    world->StartMove(to[0]);
  }
  void StartArc(const Arc&) override {
    throw DeviceFault(FaultKind::kRefused, axes[0].name, "one axis goes no arc");
  }
  bool Settles(Duration within) override { return world->Settles(within); }
  std::vector<AxisState> State() override { return {world->TurntableState()}; }
  void Stop() override { world->Stop(); }
  void Home() override { Stop(); }  // it never loses its origin

  // Instruments
  Reading Read() override {
    Reading sample = Sample(world->Look());
    sample.time = world->ReadAt();
    sample.temperature_degC = world->environment().Measure_degC(sample.time);
    return sample;
  }
  Reading Look() override { return Sample(world->LookOnTheWay()); }
  void Arm(int, int) override {
    throw DeviceFault(FaultKind::kRefused, "instruments", "an autocollimator is read at rest, not latched");
  }
  LatchedSamples Latched() override { return {}; }

  // Fixture
  void Clear() override {}
  void Mount(int setup, const std::string&) override {
    RequireSetup(setup, TurntableOf(scenario).turntable_procedure.SetUps());
    world->Mount(setup);
  }

  // Indexer
  void IndexTo(int tooth, double) override { world->IndexTo(tooth); }

  // Simulation
  void Restart() override { Begin(); }
  void BeRun(int repeat) override { scenario = InRun(begun, repeat); }
  void SetPaced(bool) override {}  // it never is

  Reading Sample(const AutocollimatorReading& shown) {
    Reading sample;
    sample.time = Now();
    sample.status = shown.status;
    sample.autocollimator_yaw_rad = shown.yaw_rad;
    sample.autocollimator_tilt_rad = shown.tilt_rad;
    return sample;
  }

  Scenario begun, scenario;  // as it was made, and in its present run
  std::vector<MachineAxis> axes = {{"turntable", true}};
  std::unique_ptr<TurntableWorld> world;
};

TurntableTwin::TurntableTwin(const Scenario& scenario) : impl_(Built(scenario.bench, [&] { return std::make_unique<Impl>(scenario); })) {}
TurntableTwin::~TurntableTwin() = default;

MachineBench TurntableTwin::Devices() {
  const bool has_teeth = !TurntableOf(impl_->scenario).HasPolygon();
  return {*impl_, *impl_, *impl_, *impl_, impl_.get(), has_teeth ? impl_.get() : nullptr};
}

namespace {

/// Angles at which the faces of a polygon are nulled, within a turn, ascending.
std::vector<double> FaceAngles(const TurntableSettings& own) {
  constexpr double kSame_rad = 1e-9;
  std::vector<double> angles_rad;
  for (int setup = 0; setup < own.turntable_procedure.SetUps(); ++setup) {
    for (int k = 0; k < own.turntable_procedure.positions; ++k) {
      const double rest_rad = std::fmod(own.FaceAngle_rad(setup, own.FaceAt(k)), units::turn);
      angles_rad.push_back(rest_rad < -kSame_rad ? rest_rad + units::turn : rest_rad);
      if (angles_rad.back() > units::turn - kSame_rad) angles_rad.back() = 0.0;
    }
  }
  std::ranges::sort(angles_rad);
  const auto is_same = [](double a, double b) { return b - a < kSame_rad; };
  angles_rad.erase(std::unique(angles_rad.begin(), angles_rad.end(), is_same), angles_rad.end());
  return angles_rad;
}

}  // namespace

nlohmann::json TurntableTwin::Truth() const {
  const MirrorStand& stand = impl_->world->stand();
  const Scenario& scenario = impl_->scenario;
  const TurntableSettings& own = TurntableOf(scenario);
  const TableMotion& turntable = stand.turntable();
  return {{"turntable",
           ToJson(own.HasPolygon() ? turntable.Repeatable(FaceAngles(own)) : turntable.Repeatable(own.multitooth.teeth))},
          {own.HasPolygon() ? "polygon" : "multitooth", ToJson(stand.MultitoothErrors())},
          {"effects", ToJson(scenario.effects)},
          {"seed", scenario.seed}};
}

}  // namespace twinbench::sim
