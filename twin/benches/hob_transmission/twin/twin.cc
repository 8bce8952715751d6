#include "twin/benches/hob_transmission/twin/twin.h"

#include <complex>
#include <nlohmann/json.hpp>

#include "twin/benches/hob_transmission/twin/world.h"
#include "twin/core/errors.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {
// Not in the unnamed namespace: a type of the header holds them, and would be local to this file as well.

class MachineClock : public Clock {
 public:
  explicit MachineClock(HobWorld& world) : world_(world) {}
  Time Now() const override { return world_.Now(); }
  void Wait(Duration duration) override { world_.RunUntil(Now() + duration); }

 private:
  HobWorld& world_;
};

class SpindleDrive : public HobDrive {
 public:
  explicit SpindleDrive(HobWorld& world) : world_(world) {}
  void Run(double hob_speed_rad_s, Duration ramp) override { world_.Run(hob_speed_rad_s, ramp); }

 private:
  HobWorld& world_;
};

class EdgeCounters : public CounterCard {
 public:
  explicit EdgeCounters(HobWorld& world) : world_(world) {}
  void Arm(int edges, int samples) override { world_.Arm(edges, samples); }
  CounterSamples Read() override { return world_.ReadCounters(); }
  CounterSample Latch() override { return world_.Latch(); }

 private:
  HobWorld& world_;
};

class HeadFixture : public HobFixture {
 public:
  explicit HeadFixture(HobWorld& world) : world_(world) {}
  void Mount(int /*setup*/, double head_rad) override { world_.Mount(head_rad); }

 private:
  HobWorld& world_;
};

namespace {

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

}  // namespace

struct HobTwin::Impl {
  explicit Impl(const Scenario& its_scenario) : scenario(its_scenario), world(its_scenario) {}

  Scenario scenario;
  HobWorld world;
  MachineClock clock{world};
  SpindleDrive drive{world};
  EdgeCounters counters{world};
  HeadFixture fixture{world};
};

HobTwin::HobTwin(const Scenario& scenario) {
  try {
    impl_ = std::make_unique<Impl>(scenario);
  } catch (const std::invalid_argument& error) {
    throw InputError("bench " + scenario.bench, error.what(), "a scenario of parts that can be built");
  }
}
HobTwin::~HobTwin() = default;

HobBench HobTwin::Bench() {
  return {impl_->clock, impl_->drive, impl_->counters, impl_->fixture};
}

nlohmann::json HobTwin::Truth() const {
  nlohmann::json json = {{"transmission", nlohmann::json::array()},
                         {"table_encoder", RingHarmonics(impl_->world.counters())},
                         {"effects", nlohmann::json::array()},
                         {"seed", impl_->scenario.seed}};
  for (const mechanics::AngleHarmonic& h : impl_->world.Transmission())
    json["transmission"].push_back(HarmonicJson(h.order, h.amplitude_rad, h.phase_rad));
  for (const EffectSettings& effect : impl_->scenario.effects) json["effects"].push_back(ToJson(effect));
  return json;
}

}  // namespace twinbench::sim
