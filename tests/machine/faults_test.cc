#include "tests/machine/benches.h"
#include "tests/support/machine_run.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/sample_text.h"
#include "twin/procedure/machine_watch.h"

/// What goes wrong with a machine and its instruments, and what becomes of the run.
namespace twinbench::test {
namespace {

using benches::circular::kEncoder_rad;
using testing::HasSubstr;

/// For an answer.
constexpr const char* kForAnAnswer = kSanitized ? "timeout_s = 3.0\n" : "timeout_s = 0.5\n";

struct Failing {
  explicit Failing(Scenario (*make)() = ShortCircles) : scenario(make()) {}

  Scenario scenario;
  ServedMachineTwin served{scenario};
  std::vector<Reading> readings = DrivenInProcess(scenario);
  std::string undisturbed = TextOf(readings, scenario);

  /// Who is silent shall not be waited for long.
  std::string BenchFile() const {
    std::string file = served.BenchFile();
    for (auto at = file.find("kind = \"scpi\""); at != std::string::npos;
         at = file.find("kind = \"scpi\"", at + 20))
      file.insert(at, kForAnAnswer);
    return file.insert(file.find("kind = \"esp\""), kForAnAnswer);
  }
  MachineRun Run(std::map<int, std::string> faults, const std::vector<Reading>& kept = {}) {
    return RunServedMachine(served, scenario, BenchFile(), std::move(faults), kept);
  }
  void ExpectGoneOn(const MachineRun& run, const std::string& fault) {
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(TextOf(run.log.readings, scenario), undisturbed);
    ASSERT_EQ(run.log.attempts.size(), 1u);
    EXPECT_EQ(run.log.attempts[0].fault, fault);
  }
};

/// Faults of connections and controllers, wherever they meet a bench; the others on one bench.
TEST(MachineFaults, ThatPassCostOneAttemptAndNoBitOnEveryBench) {
  constexpr int kTogether = 32;  // readings of a simulation are kept so many at a time
  Failing circles;
  for (const auto& [trouble, fault] : {std::pair("machine,mute", "timeout"), {"machine,partial", "timeout"},
                                       {"machine,not_in_position", "not_in_position"}, {"instruments,gap", "overrun"}})
    circles.ExpectGoneOn(circles.Run({{kTogether, trouble}}), fault);
  for (Scenario (*make)() : {ShortCircles, ShortFreeform, ShortTurntable, ShortPolygon, ShortStops, ShortSweep, ShortHob}) {
    Failing bench(make);
    const int when = std::ssize(bench.readings) > kTogether ? kTogether : 0;
    bench.ExpectGoneOn(bench.Run({{when, "machine,disconnect"}}), "dropped");
    bench.ExpectGoneOn(bench.Run({{when, "machine,restart"}}), "restarted");
    bench.ExpectGoneOn(bench.Run({{when, "instruments,mute"}}), "timeout");
  }
}

/// The wait before a reading at rest and the reading itself are the last that is asked before the looks about it.
TEST(MachineFaults, ARestartAboutAReadingAtRestCostsAnAttemptAndLeavesNoCellEmpty) {
  for (Scenario (*make)() : {ShortFreeform, ShortTurntable}) {
    Failing bench(make);
    for (const std::string asked_last : {"clock", "instruments"}) {
      int times = 0;
      const auto restart = [&](const std::string& device, const std::string& request, std::string&) {
        const bool is_next = device == asked_last && (request == "read" || request.starts_with("wait"));
        if (is_next && ++times == 10) bench.served.Inject("machine,restart");
      };
      bench.ExpectGoneOn(RunServedMachine(bench.served, bench.scenario, bench.BenchFile(), {}, {}, restart), "restarted");
    }
  }
}

/// A twin that does not say it is one, whose controller restarts once, in the reading number `restarts_in`.
struct Restarting {
  Restarting(const Scenario& scenario, int restarts_in)
      : twin(scenario),
        troubled(AsHardware(twin.bench), InstrumentColumns(FormatOf(scenario.bench).columns), {},
                 [this, restarts_in](const std::string& device, const std::string& request, std::string& answer) {
                   if (request == "read" && ++reads == restarts_in) is_lost = true;
                   if (request == "home") Home();
                   if (device == "machine" && request == "state" && is_lost) answer = WithoutOrigin(answer);
                 }) {}
  void Home() {
    ++homes;
    is_lost = false;
  }
  static std::string WithoutOrigin(const std::string& answer) {
    std::vector<AxisState> states = ParseStates(answer);
    for (AxisState& state : states) {
      state.referenced = false;
      state.commanded = state.encoder = kNaN;
    }
    return StatesText(states);
  }
  std::string Fault(bool may_home) {
    twin.options.may_home = may_home;
    return twin.FaultOn(troubled.Bench());
  }

  DrivenTwin twin;
  TroubledMachine troubled;
  int reads = 0, homes = 0;
  bool is_lost = false;
};

TEST(MachineFaults, ARealTurntableFindsItsOriginAgainIfItMay) {
  Restarting bench(ShortTurntable(), 8);
  EXPECT_EQ(bench.Fault(true), "") << bench.twin.said;
  EXPECT_EQ(bench.homes, 1);
  const MemoryLog& log = bench.twin.log;
  EXPECT_EQ(std::ssize(log.readings), BenchOf(bench.twin.scenario).planned_readings(bench.twin.scenario));
  for (const Reading& reading : log.readings) EXPECT_EQ(reading.extra.size(), 2u) << reading.reading;
  ASSERT_EQ(log.attempts.size(), 1u);
  EXPECT_EQ(log.attempts[0].fault, "restarted");
  EXPECT_EQ(log.attempts[0].reading, 7);

  Restarting forbidden(ShortTurntable(), 8);
  EXPECT_EQ(forbidden.Fault(false), "refused");
  EXPECT_THAT(forbidden.twin.said, HasSubstr("--allow-homing"));
  EXPECT_EQ(forbidden.homes, 0);
  EXPECT_EQ(forbidden.twin.log.readings.size(), 7u);
}

TEST(MachineFaults, ARealMachineIsNotHomedWithAnInstrumentMounted) {
  Restarting bench(ShortCircles(), 2);
  EXPECT_EQ(bench.Fault(true), "refused");
  EXPECT_THAT(bench.twin.said, HasSubstr("with an instrument mounted: take it off"));
  EXPECT_EQ(bench.homes, 0);
}

TEST(MachineFaults, ASpindleThatTurnsBeyondItsLimitsIsStopped) {
  DrivenTwin twin(ShortHob());
  twin.options.axes = {AxisLimits{.lower = -1.0, .upper = 100.0}};
  EXPECT_EQ(twin.Fault(), "limit") << "a turn of the table takes more";
  EXPECT_FALSE(twin.bench.machine.State()[0].moving);
  EXPECT_FALSE(twin.log.readings.empty()) << "what was taken before is kept";
}

TEST(MachineFaults, CountersThatNobodyEmptiesInTimeEndARun) {
  DrivenTwin twin(Altered(ShortHob(), {"hob_procedure.fifo_samples=2", "hob_procedure.poll_s=60"}));
  EXPECT_EQ(twin.Fault(), "overrun");
  EXPECT_EQ(twin.log.readings.size(), 2u) << "those behind them are lost, those before are not";
}

/// What ends a run keeps what was taken, and the run can be gone on with.
void ExpectStopped(const std::string& fault, const std::string& kind, const std::string& said) {
  Failing bench;
  const MachineRun run = bench.Run({{32, fault}});
  EXPECT_EQ(run.stopped_by, kind);
  EXPECT_THAT(run.said, HasSubstr(said));
  EXPECT_GE(run.log.readings.size(), 32u);
  EXPECT_LT(run.log.readings.size(), 64u);
  ASSERT_EQ(run.log.attempts.size(), 1u);
  const MachineRun rest = bench.Run({}, run.log.readings);
  EXPECT_EQ(rest.stopped_by, "") << rest.said;
  EXPECT_EQ(TextOf(rest.log.readings, bench.scenario), bench.undisturbed);
}

TEST(MachineFaults, ThatWaitAtAResumeAreNotTakenForARecordThatDoesNotFit) {
  Failing bench;
  const std::vector<Reading> kept(bench.readings.begin(), bench.readings.begin() + 32);
  for (const char* fault : {"machine,disconnect", "machine,restart", "machine,not_in_position", "instruments,disconnect",
                            "instruments,gap"}) {
    const MachineRun run = bench.Run({{0, fault}}, kept);
    EXPECT_EQ(run.stopped_by, "") << fault << ": " << run.said;
    EXPECT_EQ(TextOf(run.log.readings, bench.scenario), bench.undisturbed) << fault;
    EXPECT_EQ(run.log.attempts.size(), 1u) << fault;
  }
  for (const std::string fault : {"limit", "stall"}) {  // a hand is needed; then it goes on
    const MachineRun run = bench.Run({{0, "machine," + fault}}, kept);
    EXPECT_EQ(run.stopped_by, fault == "stall" ? "stalled" : fault) << run.said;
    EXPECT_EQ(run.log.readings.size(), 32u);
  }
  EXPECT_EQ(TextOf(bench.Run({}, kept).log.readings, bench.scenario), bench.undisturbed);
}

/// The axes of a twin, of which one is pushed off its place whenever something is read.
class Pushed : PassingInstruments, PassingMachine {
 public:
  Pushed(const MachineBench& inner, std::size_t axis, double by)
      : PassingInstruments(inner.instruments), PassingMachine(inner.machine), bench_(inner), axis_(axis), by_(by) {}
  MachineBench Bench() { return {bench_.clock, *this, *this, bench_.fixture, bench_.simulation, bench_.indexer}; }
  int times = 1;               // to go
  Duration stamped_late_by{};  // by a clock of the instruments' own

 private:
  Reading Read() override {
    is_pushed_ = times-- > 0;
    return Stamped(PassingInstruments::Read());
  }
  LatchedSamples Latched() override {
    LatchedSamples latched = PassingInstruments::Latched();
    for (Reading& sample : latched.samples) sample = Stamped(sample);
    return latched;
  }
  Reading Stamped(Reading sample) const {
    sample.time += stamped_late_by;
    return sample;
  }
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    is_pushed_ = false;
    PassingMachine::StartMove(to, feed_m_s);
  }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states = PassingMachine::State();
    if (is_pushed_) states[axis_].encoder += by_;
    return states;
  }
  void Stop() override {
    is_pushed_ = false;
    PassingMachine::Stop();
  }

  MachineBench bench_;
  std::size_t axis_;
  double by_;
  bool is_pushed_ = false;
};

TEST(MachineFaults, AnAxisThatLeavesItsStopWhileItIsReadCostsAnAttempt) {
  for (const double by_um : {0.9, 1.1}) {
    DrivenTwin twin(ShortFreeform());
    Pushed pushed(twin.bench, 1, by_um * 1e-6);
    twin.options.axes.assign(5, AxisLimits{.in_position = 1e-6});
    twin.DriveOn(pushed.Bench());
    ASSERT_EQ(twin.log.attempts.size(), by_um > 1.0 ? 1u : 0u);
    if (by_um > 1.0) {
      EXPECT_EQ(twin.log.attempts[0].fault, "moved");
      EXPECT_THAT(twin.log.attempts[0].text, HasSubstr("y: does not stand at its measuring position"));
    } else {
      const auto& extra = twin.log.readings[0].extra;
      EXPECT_NEAR(std::stod(extra.at("y_encoder_after_mm")) - std::stod(extra.at("y_encoder_before_mm")), 0.9e-3, 1e-9);
      EXPECT_EQ(extra.size(), 10u) << "five axes, before and after; " << extra.begin()->first;
    }
  }
}

/// At rest (the first readings of the freeform bench) and in motion (those of the circles).
TEST(MachineFaults, AnInstrumentsOwnClockGoesIntoNoReading) {
  for (Scenario (*make)() : {ShortFreeform, ShortCircles}) {
    for (const Duration late_by : {Duration(std::chrono::milliseconds(90)), Duration(std::chrono::hours(1)), -Duration(std::chrono::hours(1))}) {
      DrivenTwin twin(make());
      Pushed late(twin.bench, 0, 0.0);
      late.stamped_late_by = late_by;
      const bool is_what_a_connection_takes = std::chrono::abs(late_by) < std::chrono::seconds(1);
      EXPECT_EQ(twin.FaultOn(late.Bench()), is_what_a_connection_takes ? "" : "clock");
      if (is_what_a_connection_takes) continue;
      EXPECT_TRUE(twin.log.readings.empty());
      ASSERT_EQ(twin.log.attempts.size(), 3u);
      EXPECT_EQ(twin.log.attempts[0].fault, "clock");
    }
  }
}

/// Drops what the `trigger`th of all triggers latched, once.
std::string FaultWithout(DrivenTwin& twin, std::size_t trigger) {
  const std::vector<ReadingColumn> shown = InstrumentColumns(FormatOf(twin.scenario.bench).columns);
  std::size_t seen = 0;
  bool is_lost = false;
  TroubledMachine troubled(twin.bench, shown, {}, [&](const std::string&, const std::string& request, std::string& answer) {
    if (request != "latched" || is_lost) return;
    LatchedSamples latched = ParseLatched(answer, shown);
    const std::size_t before = seen;
    if ((seen += latched.samples.size()) < trigger) return;
    latched.samples.erase(latched.samples.begin() + static_cast<std::ptrdiff_t>(trigger - before - 1));
    answer = LatchedText(latched, shown);
    is_lost = true;
  });
  return twin.FaultOn(troubled.Bench());
}

TEST(MachineFaults, ATriggerThatLatchesNothingIsAGapOfWhichNothingIsKeptAndIsGoneForAgain) {
  const std::vector<Reading> whole = DrivenInProcess(ShortCircles());
  constexpr std::size_t kCircle = 12;
  for (const std::size_t trigger : {std::size_t{1}, std::size_t{5}, kCircle}) {
    DrivenTwin twin(ShortCircles());
    EXPECT_EQ(FaultWithout(twin, trigger), "");
    ASSERT_EQ(twin.log.attempts.size(), 1u);
    EXPECT_EQ(twin.log.attempts[0].fault, "gap");
    EXPECT_EQ(twin.log.attempts[0].reading, 0);
    ASSERT_EQ(twin.log.readings.size(), whole.size());
    for (std::size_t k = 0; k < kCircle; ++k) EXPECT_NEAR(kEncoder_rad(twin.log.readings[k]), kEncoder_rad(whole[k]), 1e-3) << k;
  }
}

TEST(MachineFaults, AMachineThatFreezesInMidMoveAndALimitSwitchEndTheRun) {
  ExpectStopped("machine,stall", "stalled", "on its way");
  ExpectStopped("machine,limit", "limit", "limit switch");
}

TEST(MachineFaults, AShaftThatFreezesInASweepIsStalled) {
  Failing bench(ShortSweep);
  const MachineRun run = bench.Run({{0, "machine,stall"}});
  EXPECT_EQ(run.stopped_by, "stalled") << run.said;
  EXPECT_THAT(run.said, HasSubstr("should turn, and stands at"));
}

/// A served twin at the pace of the world whose clock nobody holds is what hardware is.
TEST(MachineFaults, AStopIsHeardAtOnceInRealTime) {
  const Scenario scenario = ShortCircles();
  const ServedMachineTwin served(scenario, 1.0);
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}};
  hw::MachineFile file = hw::ParseMachineFile(served.BenchFile(), "served.toml", axes);
  file.clock.kind = "system";
  std::atomic<bool> is_asked = false;
  const auto opened = hw::OpenMachineHardware(file, axes, InstrumentColumns(FormatOf(kCircularBench).columns), {}, 0,
                                              [&] { return is_asked.load(); });
  MachineBench devices = opened->Devices();
  const std::vector<AxisState> at = devices.machine.State();
  devices.machine.StartMove({at[0].encoder + 1e-3, at[1].encoder}, 1e-4);  // takes 10 s
  EXPECT_FALSE(procedure::WhetherMachineStands(devices, {}).is_sure);
  std::jthread operator_([&is_asked] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    is_asked = true;
  });
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_THROW(devices.machine.Settles(std::chrono::seconds(1)), DeviceFault);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(500)) << "not the second that it may take";
  EXPECT_TRUE(procedure::StopMachine(devices, {}).is_sure);
  EXPECT_TRUE(procedure::WhetherMachineStands(devices, {}).is_sure);
}

TEST(MachineFaults, AnOperatorWhoSaysStopIsHeardInTheMiddleOfASweep) {
  DrivenTwin twin(ShortCircles());
  int asked = 0;
  twin.options.stop_requested = [&] { return ++asked > 40; };
  EXPECT_EQ(twin.Fault(), "stopped");
  for (const AxisState& axis : twin.bench.machine.State()) EXPECT_FALSE(axis.moving);
  ASSERT_EQ(twin.log.attempts.size(), 1u);
  EXPECT_EQ(twin.log.attempts[0].fault, "stopped");
  EXPECT_LT(twin.log.readings.size(), 64u);
}

}  // namespace
}  // namespace twinbench::test
