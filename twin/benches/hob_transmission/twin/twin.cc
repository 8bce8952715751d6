#include "twin/benches/hob_transmission/twin/twin.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/world.h"
#include "twin/core/built.h"
#include "twin/core/device_fault.h"
#include "twin/core/happened_once.h"
#include "twin/core/numbered_runs.h"
#include "twin/sim/setup_check.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {

namespace {

constexpr double kTravel_rad = 1e6 * units::turn;  // what its counter holds

nlohmann::json HarmonicJson(double order, double amplitude_rad, double phase_rad) {
  return {
      {"order", order}, {"amplitude_arcsec", amplitude_rad / units::arcsec}, {"phase_deg", phase_rad / units::deg}};
}

/// Orders of the ring's error that matter, by Fourier sums over a turn.
nlohmann::json RingHarmonics(const Counters& counters) {
  constexpr int kPoints = 720, kOrders = 100;
  constexpr double kWorthTelling_rad = 1e-5 * units::arcsec;
  nlohmann::json harmonics = nlohmann::json::array();
  for (int order = 1; order <= kOrders; ++order) {
    std::complex<double> sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double angle_rad = 2.0 * units::kPi * i / kPoints;
      sum += counters.TableRingError_rad(angle_rad) * std::polar(2.0 / kPoints, -order * angle_rad);
    }
    if (std::abs(sum) > kWorthTelling_rad) harmonics.push_back(HarmonicJson(order, std::abs(sum), std::arg(sum)));
  }
  return harmonics;
}

/// What bodies make of an error more than turning slowly does: they swing along, as a mass on a spring of the chain's stiffness. Lowest order.
double Swing_rad(const HobSettings& s, const mechanics::AngleHarmonic& h) {
  if (s.mechanics.fidelity != "bullet") return 0.0;
  const double fastest_rad_s = s.transmission.Ratio() * std::ranges::max(s.hob_procedure.hob_speeds_rad_s);
  const double own_rad2_s2 = s.transmission.stiffness_Nm_rad / s.transmission.table_inertia_kg_m2;
  return h.amplitude_rad * std::pow(h.order * fastest_rad_s, 2) / own_rad2_s2;
}

}  // namespace

struct HobTwin::Impl : Clock, MachineController, InstrumentSet, MachineFixture, Simulation, NumberedRuns {
  explicit Impl(const Scenario& its_scenario) : begun(its_scenario), scenario(its_scenario) { Begin(); }

  void Begin() { world = std::make_unique<HobWorld>(scenario); }

  // Clock
  Time Now() const override { return world->Now(); }
  void Wait(Duration duration) override { world->RunUntil(Now() + duration); }

  // Controller
  const std::vector<MachineAxis>& Axes() const override { return axes; }
  std::vector<AxisLimits> Travel() override { return {{.lower = -kTravel_rad, .upper = kTravel_rad}}; }
  void StartMove(const std::vector<double>&, double) override {
    throw DeviceFault(FaultKind::kRefused, axes[0].name, "it turns, and is sent nowhere");
  }
  void StartArc(const Arc&) override { StartMove({}, 0.0); }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    Require(axis == 0, "there is one axis");
    if (!std::isfinite(speed_rad_s) || ramp <= Duration(0))
      throw DeviceFault(FaultKind::kRefused, axes[0].name, "no speed, or no time to go over to it");
    world->Run(speed_rad_s, ramp);
  }
  /// Nobody waits for an axis that turns on and on.
  bool Settles(Duration within) override {
    const Time until = Now() + within;
    world->RunUntil(world->Turns() ? until : std::min(until, std::max(Now(), world->SlowedDown())));
    return !world->Moves();
  }
  std::vector<AxisState> State() override {
    AxisState hob;
    hob.encoder = world->Hob_rad();
    hob.moving = world->Moves();
    hob.in_position = !hob.moving;
    return {hob};
  }
  void Stop() override {
    if (world->Turns()) world->Run(0.0, FromSeconds(HobOf(scenario).hob_procedure.ramp_s));
  }
  void Home() override { Stop(); }  // it never loses its origin

  // Instruments
  Reading Read() override { return ReadingOf(world->Latch()); }
  void Arm(int samples, int lines) override {
    if (lines <= 0)
      throw DeviceFault(FaultKind::kRefused, "instruments", "the card latches at lines of the table's encoder");
    world->Arm(lines, samples);
  }
  LatchedSamples Latched() override {
    const CounterSamples look = world->ReadCounters();
    LatchedSamples latched;
    latched.overrun = look.overrun;
    for (const CounterSample& sample : look.samples) latched.samples.push_back(ReadingOf(sample));
    return latched;
  }

  // Fixture
  void Clear() override {}
  void Mount(int setup, const std::string&) override {
    const std::vector<double>& heads_rad = HobOf(scenario).hob_procedure.heads_rad;
    RequireSetup(setup, static_cast<int>(std::ssize(heads_rad)));
    world->Mount(heads_rad[static_cast<std::size_t>(setup)]);
  }

  // Simulation
  void Restart() override { Begin(); }
  void BeRun(int repeat) override { scenario = InRun(begun, repeat); }
  void SetPaced(bool) override {}  // it never is

  static Reading ReadingOf(const CounterSample& sample) {
    Reading reading;
    reading.time = sample.time;
    reading.measured_rad = sample.table_encoder_rad;
    reading.reference_rad = sample.hob_encoder_rad;
    reading.interferometer_rad = sample.interferometer_rad;
    return reading;
  }

  Scenario begun, scenario;  // as it was made, and in its present run
  std::vector<MachineAxis> axes = {{"hob", true}};
  std::unique_ptr<HobWorld> world;
};

HobTwin::HobTwin(const Scenario& scenario) : impl_(Built(scenario.bench, [&] { return std::make_unique<Impl>(scenario); })) {}
HobTwin::~HobTwin() = default;

MachineBench HobTwin::Devices() {
  return {*impl_, *impl_, *impl_, *impl_, impl_.get()};
}

nlohmann::json HobTwin::Truth() const {
  nlohmann::json json = {{"transmission", nlohmann::json::array()},
                         {"gears_ahead_deg", impl_->world->GearsAhead_rad() / units::deg},
                         {"table_encoder", RingHarmonics(impl_->world->counters())},
                         {"effects", ToJson(impl_->scenario.effects)},
                         {"seed", impl_->scenario.seed}};
  for (const mechanics::AngleHarmonic& h : impl_->world->Transmission()) {
    json["transmission"].push_back(HarmonicJson(h.order, h.amplitude_rad, h.phase_rad));
    if (const double swing_rad = Swing_rad(HobOf(impl_->scenario), h); swing_rad > 0.0)
      json["transmission"].back()["swing_arcsec"] = swing_rad / units::arcsec;
  }
  return json;
}

}  // namespace twinbench::sim
