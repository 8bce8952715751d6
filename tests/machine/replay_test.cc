#include "hw_bridge/replay/replay_bench.h"
#include "hw_bridge/replay/replay_machine.h"
#include "tests/core/input_error.h"
#include "tests/machine/benches.h"
#include "tests/support/kept_text.h"
#include "tests/support/machine_run.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"

/// Recordings of benches that cannot begin again: machine_serve_test.cc plays those of simulated ones.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

/// A twin that does not say it is one, at whose clock time passes while nobody asks anything.
class RealBench : Clock {
 public:
  explicit RealBench(const Scenario& scenario) : twin_(BenchOf(scenario).make_devices(scenario)), inner_(twin_->Devices()) {}
  MachineBench Devices() { return {*this, inner_.machine, inner_.instruments, inner_.fixture, nullptr, inner_.indexer}; }

 private:
  Time Now() const override {
    inner_.clock.Wait(std::chrono::microseconds(3));
    return inner_.clock.Now();
  }
  void Wait(Duration duration) override { inner_.clock.Wait(duration); }

  std::unique_ptr<MachineDevices> twin_;
  MachineBench inner_;
};

/// @param stop_at  The operator says stop when so many readings are kept, and has it resumed.
std::vector<Reading> Recorded(const Scenario& scenario, const std::string& folder, std::vector<std::size_t> stop_at) {
  RealBench bench(scenario);
  MachineBench devices = bench.Devices();
  const auto record = RunRecord::Create(folder, {"test", "real", scenario.seed, "", scenario.bench});
  record->SpareTheDisk();
  stop_at.push_back(1U << 30U);
  for (const std::size_t kept : stop_at) {
    procedure::MachineOptions options;
    options.log = record.get();
    options.kept = record->Readings();
    options.stop_requested = [&] { return record->Readings().size() >= kept; };
    const auto kind = KindOf([&] { BenchOf(scenario).drive(devices, scenario, *record, {}, options); });
    EXPECT_EQ(kind.value_or(FaultKind::kStopped), FaultKind::kStopped);
  }
  record->Finish();
  return record->Readings();
}

MemoryLog Replayed(const Scenario& scenario, const std::string& folder) {
  const Bench& whole = BenchOf(scenario);
  const auto twin = whole.make_devices(scenario);
  hw::ReplayMachine replay(folder, twin->Devices().machine.Axes(), InstrumentColumns(whole.format->columns),
                           twin->Devices().indexer != nullptr);
  MachineBench bench = replay.Devices();
  MemoryLog log;
  procedure::MachineOptions options;
  options.log = &log;
  options.attempts = replay.Attempts();
  whole.drive(bench, scenario, log, {}, options);
  return log;
}

TEST(ReplayOfARealBench, GoesOnWhereTheRunDidAfterItWasStopped) {
  for (Scenario (*make)() : {ShortCircles, ShortFreeform, ShortTurntable, ShortPolygon, ShortStops, ShortHob}) {
    const Scenario scenario = make();
    SCOPED_TRACE(scenario.bench);
    const TemporaryFolder folder;
    const std::vector<Reading> readings = Recorded(scenario, folder.path(), {5, 15});
    ASSERT_EQ(static_cast<int>(readings.size()), BenchOf(scenario).planned_readings(scenario));
    const MemoryLog played = Replayed(scenario, folder.path());
    EXPECT_EQ(TextOf(played.readings, scenario), TextOf(readings, scenario));
    ASSERT_EQ(played.attempts.size(), 2u);
    EXPECT_EQ(played.attempts[0].reading, static_cast<int>(KeptWhenStoppedAt(5, scenario)));
    EXPECT_EQ(played.attempts[1].reading, static_cast<int>(KeptWhenStoppedAt(15, scenario)));
  }
}

/// The rotary bench's run by a version that did not look at encoders about a block.
TEST(ReplayBench, PlaysARecordThatKnowsNoLooksAtEncoders) {
  const Scenario scenario = ParseScenario(
      "bench = \"rotary_4dof\"\nseed = 5\n[mechanics]\nfidelity = \"kinematic\"\n[procedure]\npositions = 3\nshifts = [0]\n",
      "short.toml", "");
  const TemporaryFolder folder;
  std::vector<Reading> readings[2];
  for (const bool looks : {false, true}) {
    const std::string name = folder.File(looks ? "new" : "old");
    const auto record = RunRecord::Create(name, {"test", "twin", scenario.seed, "", scenario.bench});
    record->SpareTheDisk();
    procedure::Options options;
    options.log = record.get();
    options.looks_at_encoders = looks;
    sim::Twin twin(scenario);
    RotaryBench bench = twin.Bench();
    procedure::CarryOut(bench, scenario, *record, {}, options);
    record->Finish();
    EXPECT_EQ(hw::LooksAtEncoders(name), looks);
    hw::ReplayBench replay(name);
    RotaryBench played = replay.Bench();
    MemoryLog log;
    options.log = &log;
    procedure::CarryOut(played, scenario, log, {}, options);
    EXPECT_EQ(TextOf(log.readings), TextOf(record->Readings()));
    readings[looks] = log.readings;
  }
  EXPECT_TRUE(readings[0].front().extra.empty());
  for (std::vector<Reading>* both : {&readings[0], &readings[1]})
    for (Reading& reading : *both) reading.extra.clear();
  EXPECT_EQ(TextOf(readings[0]), TextOf(readings[1])) << "a look changes no bit of what is measured";
}

TEST(ReplayMachine, ARecordThatEndsTooEarlyOrHasNoCallsOrNoAnswersToThemSaysSo) {
  const Scenario scenario = ShortStops();
  const TemporaryFolder early, uncalled, unanswered;
  Recorded(scenario, early.path(), {});
  Scenario longer = scenario;
  EncoderOf(longer).encoder_procedure.mounting_rad.push_back(1.0);  // a third one was not recorded
  EXPECT_THAT(MessageOf<BenchError>([&] { Replayed(longer, early.path()); }), HasSubstr("the recording ends before \"fixture: mount 2"));
  RunRecord::Create(uncalled.path(), {"test", "import: readings.csv", 1, "", scenario.bench})
      ->Append(Reading{}, {});
  EXPECT_KEPT(MessageOf([&] { Replayed(scenario, uncalled.path()); }));
  {
    const auto record = RunRecord::Create(unanswered.path(), {"old", "twin", 1, "", scenario.bench});
    record->Called({Time{}, "machine", "move 0 0.1", ""});
    record->Append(Reading{}, {});
  }
  EXPECT_KEPT(MessageOf([&] { Replayed(scenario, unanswered.path()); }));
}

}  // namespace
}  // namespace twinbench::test
