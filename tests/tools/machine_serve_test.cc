#include "tests/tools/served_program.h"
#include "twin/core/run_record.h"

/// `serve` and `measure` of every bench; serve_test.cc has what only the rotary one does.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

/// A bench, its scenario in tests/data/machine/, one of its axes and limits that are too narrow for it.
struct Machine {
  const char *name, *scenario, *axis, *limits;
};
class ServedMachineProgram : public ServedProgram, public ::testing::WithParamInterface<Machine> {
 protected:
  ServedMachineProgram() : ServedProgram(GetParam().scenario, ServedScenario(GetParam().scenario)) {}

  std::unique_ptr<Process> ServeAt(const std::string& speed, const std::string& machine = "esp") {
    return Serve({"--token", "--speed", speed, "--tables", machine});
  }
};

using EveryBench = ServedMachineProgram;
using MachineThatMoves = ServedMachineProgram;

TEST_P(EveryBench, MeasuresTheReadingsThatRunMakesBitForBit) {
  const auto server = ServeAt("max", "pty");
  Succeed(Measure("measured"));
  ExpectAsRun("measured");
  EXPECT_THAT(RunRecord::Open(At("measured"))->provenance().source, HasSubstr("twinbench,"));
}

TEST_P(EveryBench, AKilledMeasurementGoesOnToTheSameReadings) {
  const auto server = ServeAt("2000");
  Process run(At(""), Measure("killed"));
  run.Await(1);
  ASSERT_TRUE(run.Runs()) << "it was too quick to be killed";
  run.Kill();
  const std::size_t kept = RunRecord::Open(At("killed"))->Readings().size();
  EXPECT_GT(kept, 0u);
  Succeed(Measure("killed"));
  EXPECT_EQ(ReadingsOf("killed"), readings_);
  Replay("killed", "played");
  ExpectAsRun("played");
}

TEST_P(MachineThatMoves, CtrlCStopsTheAxesAndTheRunCanBeResumed) {
  const auto server = ServeAt("2000");
  {
    Process run(At(""), Measure("stopped"));
    run.Await(1);
    run.Signal(SIGINT);
    ExpectEnded(run.Wait(), 1, {"The controller says that all "});
  }
  Succeed(Measure("stopped"));
  EXPECT_EQ(ReadingsOf("stopped"), readings_);
}

TEST_P(MachineThatMoves, AServerThatDiesIsToldAndGoneOnFromWithANewOne) {
  auto server = ServeAt("2000");
  WaitBriefly("0.3");
  Process run(At(""), Measure("cut"));
  run.Await(1);
  server->Kill();
  ExpectEnded(run.Wait(), 3, {"STATE UNKNOWN - USE THE EMERGENCY STOP", "STAND STILL IS NOT KNOWN"});
  server = ServeAt("max");
  Succeed(Measure("cut"));
  EXPECT_EQ(ReadingsOf("cut"), readings_);
}

TEST_P(ServedMachineProgram, ARehearsalAsksTheControllerAndMovesNothing) {
  const auto server = ServeAt("max");
  const std::string axis = std::string("axis ") + GetParam().axis;
  ExpectEnded(Call({"measure", "small.toml", "--bench", "bench.toml", "--rehearse-only"}), 0, {axis, "limits "});
  Write("bench.toml", Read("bench.toml") + "\n[axis_" + GetParam().axis + "]\n" + GetParam().limits);
  ExpectEnded(Call({"measure", "small.toml", "--bench", "bench.toml", "--rehearse", "-o", "narrow"}), 1,
              {"PROBLEM: " + axis + " would travel"});
  EXPECT_FALSE(Exists("narrow"));
}

TEST_F(ProgramHere, ARecordingOfAMachineIsAskedWhatItWasAskedOnly) {
  Write("small.toml", Contents(TWINBENCH_TEST_DATA "/machine/served_stops.toml"));
  Write("bench.toml", "kind = \"twin\"\n");
  Write("replay.toml", "kind = \"replay\"\nrecord = \"own\"\n");
  Succeed({"measure", "small.toml", "--bench", "bench.toml", "-o", "own"});
  const Outcome other = Call({"measure", "small.toml", "--bench", "replay.toml", "-o", "other", "--set",
                              "encoder_procedure.stop_interval_s=7.0"});
  ExpectEnded(other, 1, {"\"clock: wait 5000000000\" is not in the recording at this place"});
  EXPECT_THAT(other.err, testing::Not(HasSubstr("stand"))) << "of a recording's axes nothing can be asked";
}

constexpr const char *kNarrow_mm = "lower_mm = -20.0\nupper_mm = 20.0\n",
                     *kNarrow_deg = "lower_deg = -20.0\nupper_deg = 20.0\n";
constexpr Machine kFreeformMachine = {"Freeform", "freeform", "x", kNarrow_mm};  // as circles, and takes longest
constexpr Machine kRotaryMachine = {"Rotary", "rotary", "", ""};  // its limits: serve_test.cc
constexpr Machine kMachines[] = {{"Circles", "circles", "x", kNarrow_mm},
                                 {"Turntable", "turntable", "turntable", kNarrow_deg},
                                 {"Stops", "stops", "shaft", kNarrow_deg},
                                 {"Hob", "hob", "hob", kNarrow_deg}};
std::string NameOfMachine(const ::testing::TestParamInfo<Machine>& machine) {
  return machine.param.name;
}
INSTANTIATE_TEST_SUITE_P(Machines, EveryBench, ::testing::ValuesIn(kMachines), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Others, EveryBench,
                         ::testing::Values(kFreeformMachine, Machine{"Sweep", "sweep", "shaft", kNarrow_deg},
                                           kRotaryMachine),
                         NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Machines, ServedMachineProgram, ::testing::ValuesIn(kMachines), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Machines, MachineThatMoves,
                         ::testing::Values(kMachines[0], kMachines[3], kRotaryMachine),  // on paths; turning on; tables
                         NameOfMachine);

}  // namespace
}  // namespace twinbench::test
