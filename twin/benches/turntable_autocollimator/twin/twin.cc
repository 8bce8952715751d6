#include "twin/benches/turntable_autocollimator/twin/twin.h"

#include <algorithm>
#include <cmath>
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

class TableOnAutocollimator : public NullServo {
 public:
  explicit TableOnAutocollimator(TurntableWorld& world) : world_(world) {}
  bool Null(int direction) override { return world_.Null(direction); }

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
  TableOnAutocollimator servo{world};
};

TurntableTwin::TurntableTwin(const Scenario& scenario) {
  try {
    impl_ = std::make_unique<Impl>(scenario);
  } catch (const std::invalid_argument& error) {
    throw InputError("bench " + scenario.bench, error.what(), "a scenario of parts that can be built");
  }
}
TurntableTwin::~TurntableTwin() = default;

NullingTurntableBench TurntableTwin::Bench() {
  return {{impl_->clock, impl_->turntable, impl_->multitooth, impl_->autocollimator, impl_->thermometer,
           impl_->fixture},
          impl_->servo};
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
  const auto same = std::ranges::unique(angles_rad, [](double a, double b) { return b - a < kSame_rad; });
  angles_rad.erase(same.begin(), same.end());
  return angles_rad;
}

}  // namespace

nlohmann::json TurntableTwin::Truth() const {
  const MirrorStand& stand = impl_->world.stand();
  const Scenario& scenario = impl_->scenario;
  const TurntableSettings& own = TurntableOf(scenario);
  const TableMotion& turntable = stand.turntable();
  nlohmann::json json = {{"turntable", ToJson(own.HasPolygon() ? turntable.Repeatable(FaceAngles(own))
                                                               : turntable.Repeatable(own.multitooth.teeth))},
                         {own.HasPolygon() ? "polygon" : "multitooth", ToJson(stand.MultitoothErrors())},
                         {"effects", nlohmann::json::array()},
                         {"seed", scenario.seed}};
  for (const EffectSettings& effect : scenario.effects) json["effects"].push_back(ToJson(effect));
  return json;
}

}  // namespace twinbench::sim
