#include "twin/benches/turntable_autocollimator/twin/twin.h"

#include <nlohmann/json.hpp>


#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/world.h"
#include "twin/core/errors.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {

using mechanics::Axis;

// Not in the unnamed namespace: a type of the header holds them, and would be local to this file as well.

class TurntableClock : public Clock {
 public:
  explicit TurntableClock(TurntableWorld& world) : world_(world) {}
  Time Now() const override { return world_.queue().Now(); }
  void Wait(Duration duration) override { world_.queue().RunUntil(Now() + duration); }

 private:
  TurntableWorld& world_;
};

class Turntable : public RotaryTable {
 public:
  explicit Turntable(TurntableWorld& world) : world_(world) {}
  void StartMove(double angle_rad) override { world_.StartMove(angle_rad); }
  bool Settles(Duration within) override { return world_.axes().Settles(Axis::kTarget, within); }
  TableState State() override { return world_.TurntableState(); }
  void Stop() override { world_.axes().Stop(Axis::kTarget); }
  void Home() override {}  // it never loses its origin

 private:
  TurntableWorld& world_;
};

class Multitooth : public IndexingTable {
 public:
  explicit Multitooth(TurntableWorld& world) : world_(world) {}
  void IndexTo(int tooth) override { world_.IndexTo(tooth); }

 private:
  TurntableWorld& world_;
};

class MirrorAutocollimator : public Autocollimator {
 public:
  explicit MirrorAutocollimator(TurntableWorld& world) : world_(world) {}
  AutocollimatorReading Read() override { return world_.Look(); }

 private:
  TurntableWorld& world_;
};

class RoomThermometer : public Thermometer {
 public:
  explicit RoomThermometer(TurntableWorld& world) : world_(world) {}
  double Read_degC() override { return world_.environment().Measure_degC(world_.queue().Now()); }

 private:
  TurntableWorld& world_;
};

class MultitoothFixture : public TurntableFixture {
 public:
  explicit MultitoothFixture(TurntableWorld& world) : world_(world) {}
  void Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth) override {
    world_.Mount(setup, tilt_rad, azimuth_rad, eccentricity_m, shift_teeth);
  }

 private:
  TurntableWorld& world_;
};

struct TurntableTwin::Impl {
  explicit Impl(const Scenario& its_scenario) : scenario(its_scenario), world(its_scenario) {}

  Scenario scenario;
  TurntableWorld world;
  TurntableClock clock{world};
  Turntable turntable{world};
  Multitooth multitooth{world};
  MirrorAutocollimator autocollimator{world};
  RoomThermometer thermometer{world};
  MultitoothFixture fixture{world};
};

TurntableTwin::TurntableTwin(const Scenario& scenario) {
  try {
    impl_ = std::make_unique<Impl>(scenario);
  } catch (const std::invalid_argument& error) {
    throw InputError("bench " + scenario.bench, error.what(), "a scenario of parts that can be built");
  }
}
TurntableTwin::~TurntableTwin() = default;

TurntableBench TurntableTwin::Bench() {
  return {impl_->clock,          impl_->turntable,   impl_->multitooth,
          impl_->autocollimator, impl_->thermometer, impl_->fixture};
}

nlohmann::json TurntableTwin::Truth() const {
  const MirrorStand& stand = impl_->world.stand();
  const Scenario& scenario = impl_->scenario;
  nlohmann::json json = {
      {"turntable", ToJson(stand.turntable().Repeatable(TurntableOf(scenario).multitooth.teeth))},
      {"multitooth", ToJson(stand.MultitoothErrors())},
      {"effects", nlohmann::json::array()},
      {"seed", scenario.seed}};
  for (const EffectSettings& effect : scenario.effects) json["effects"].push_back(ToJson(effect));
  return json;
}

}  // namespace twinbench::sim
