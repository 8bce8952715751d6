#include "twin/benches/rotary_4dof/twin/twin.h"

#include <optional>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/world.h"
#include "twin/core/happened_once.h"
#include "twin/core/numbered_runs.h"

namespace twinbench::sim {

using mechanics::Axis;

// Not in the unnamed namespace: a type of the header holds them, and would be local to this file as well.

class TwinClock : public Clock {
 public:
  explicit TwinClock(World& world) : world_(world) {}
  Time Now() const override { return world_.queue().Now(); }
  void Wait(Duration duration) override { world_.queue().RunUntil(Now() + duration); }

 private:
  World& world_;
};

class TwinTable : public RotaryTable {
 public:
  TwinTable(World& world, Axis axis) : world_(world), axis_(axis) {}
  void StartMove(double angle_rad) override { world_.StartMove(axis_, angle_rad); }
  bool Settles(Duration within) override { return world_.Settles(axis_, within); }
  TableState State() override { return world_.StateOf(axis_); }
  void Stop() override { world_.Stop(axis_); }
  void Home() override {}  // it never loses its origin

 private:
  World& world_;
  Axis axis_;
};

class TwinAdc : public AdConverter {
 public:
  explicit TwinAdc(World& world) : world_(world) {}
  Acquisition Acquire(int n_samples, bool keep_raw) override { return world_.Acquire(n_samples, keep_raw); }

 private:
  World& world_;
};

/// Looks at the grating's normal; out of its range it shows nothing.
class TwinAutocollimator : public Autocollimator {
 public:
  explicit TwinAutocollimator(World& world)
      : world_(world),
        schedule_(world.queue(), "autocollimator"),
        settings_(RotaryOf(world.actual()).autocollimator),
        noise_(world.actual().RunSeed(), "autocollimator.noise") {}

  AutocollimatorReading Read() override {
    AutocollimatorReading reading;
    schedule_.Now([&] { reading = ReadNow(); });
    return reading;
  }

 private:
  AutocollimatorReading ReadNow() {
    const Vector3 normal_L = world_.GratingPose().linear().col(1);
    const double yaw_rad = Show(std::atan2(-normal_L.x(), normal_L.y()));
    const double tilt_rad = Show(std::atan2(normal_L.z(), std::hypot(normal_L.x(), normal_L.y())));
    return {yaw_rad, tilt_rad};
  }

  double Show(double angle_rad) {
    const double noise_rad = settings_.noise_rad > 0.0 ? settings_.noise_rad * noise_.Normal() : 0.0;
    const double shown_rad = (1.0 + settings_.gain_error) * angle_rad + noise_rad;
    return std::abs(shown_rad) <= settings_.range_rad ? shown_rad : kNaN;
  }

  World& world_;
  Schedule schedule_;
  AutocollimatorSettings settings_;
  Stream noise_;
};

class TwinThermometer : public Thermometer {
 public:
  explicit TwinThermometer(World& world) : world_(world), schedule_(world.queue(), "thermometer") {}
  double Read_degC() override {
    double shown_degC = kNaN;
    schedule_.Now([&] { shown_degC = world_.environment().Measure_degC(world_.queue().Now()); });
    return shown_degC;
  }

 private:
  World& world_;
  Schedule schedule_;
};

class TwinGoniometer : public Goniometer {
 public:
  explicit TwinGoniometer(World& world) : world_(world), schedule_(world.queue(), "goniometer") {}
  void MoveTo(double yaw_rad, double tilt_rad) override {
    schedule_.Now([&] { world_.SetGoniometer(yaw_rad, tilt_rad); });
  }

 private:
  World& world_;
  Schedule schedule_;
};

class TwinFixture : public Fixture {
 public:
  explicit TwinFixture(World& world) : world_(world) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override {
    world_.Mount(setup, clamp_rad, reseat_rad);
  }

 private:
  World& world_;
};

/// The devices are rebuilt in their place: whoever holds them keeps them over a restart.
struct Twin::Impl : public Simulation, public NumberedRuns {
  struct Devices {
    explicit Devices(const Scenario& scenario) : world(scenario) {}

    World world;
    TwinClock clock{world};
    TwinTable target{world, Axis::kTarget};
    TwinTable reference{world, Axis::kReference};
    TwinAdc adc{world};
    TwinAutocollimator autocollimator{world};
    TwinThermometer thermometer{world};
    TwinGoniometer goniometer{world};
    TwinFixture fixture{world};
  };

  explicit Impl(const Scenario& its_scenario) : own(its_scenario), scenario(own) { devices.emplace(scenario); }
  void Restart() override { devices.emplace(scenario); }
  void BeRun(int repeat) override { scenario = InRun(own, repeat); }
  void SetPaced(bool) override {}  // in a program's own twin no time is ever waited for

  const Scenario own;
  Scenario scenario;  // own, or another run of it
  std::optional<Devices> devices;
};

Twin::Twin(const Scenario& scenario) : impl_(std::make_unique<Impl>(scenario)) {}
Twin::~Twin() = default;

RotaryBench Twin::Bench() {
  Impl::Devices& d = *impl_->devices;
  return {d.clock,       d.target,     d.reference, d.adc,      d.autocollimator,
          d.thermometer, d.goniometer, d.fixture,   impl_.get()};
}

Truth Twin::TheTruth() const {
  const Stand& stand = impl_->devices->world.stand();
  const Scenario& scenario = impl_->scenario;
  const int positions = RotaryOf(scenario).procedure.positions;
  return {stand.target().Repeatable(positions), stand.reference().Repeatable(positions), scenario.effects,
          scenario.seed};
}

const std::map<std::string, std::uint64_t>& Twin::ScheduledEvents() const {
  return impl_->devices->world.Scheduled();
}

std::uint64_t Twin::RaysTraced() const {
  return impl_->devices->world.light().rays();
}

void Twin::WriteIrradiance(const std::string& path) {
  impl_->devices->world.WriteIrradiance(path);
}

}  // namespace twinbench::sim
