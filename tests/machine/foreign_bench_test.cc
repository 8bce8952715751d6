#include "tests/support/foreign_bench.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>
#include <numeric>

#include "hw_bridge/numbers/number_source.h"
#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

/// `measure` on benches that others have written, in real time: their controllers, instruments and physics.
namespace twinbench::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Of standard uncertainties. The noise of benches that are read at stops is the same in every run.
constexpr double kCoverage = 3.0;
/// Of a machine that turns on, when a path begins is a matter of the computer's time, and so is what is drawn, as
/// it is behind a gateway that is asked again: 14 values in every run, with 20 degrees of freedom or more;
/// Student's t leaves 1 run in 10 000 outside.
constexpr double kCoverageByChance = 6.0;

/// `measure` of a scenario on a bench whose file has `{device}` where a device's address belongs.
class ForeignBenchProgram : public ProgramHere {
 protected:
  ForeignBenchProgram(const std::string& program, const std::string& scenario, std::string bench_file)
      : program_(program), bench_file_(std::move(bench_file)) {
    Write("foreign.toml", scenario);
  }
  void BeRunBy(const char* python) { python_ = python; }
  /// What the bench's program is told besides its faults.
  void BeSet(const std::string& setting) { settings_.push_back(setting); }
  void Replace(const std::string& from, const std::string& to) {
    const auto at = bench_file_.find(from);
    if (at == std::string::npos) throw BenchError("the bench file has no " + from);
    bench_file_.replace(at, from.size(), to);
  }

  /// @param faults  The bench is troubled by them, as line_devices.py writes them.
  Outcome MeasureWith(const std::vector<std::string>& faults, int attempts = 5) {
    std::vector<std::string> words = faults;
    words.insert(words.end(), settings_.begin(), settings_.end());
    const ForeignBench bench(program_, At(""), words, python_);
    hidden_ = bench.told();
    std::string text = bench_file_;
    if (const auto at = text.find("attempts = "); at != std::string::npos) text.erase(at, text.find('\n', at) + 1 - at);
    text = "attempts = " + std::to_string(attempts) + "\n" + text;
    const auto fill = [&](const std::string& place, const std::string& device) {
      if (text.find(place) != std::string::npos) Fill(text, place, bench.Address(device));
    };
    for (const auto& [device, port] : hidden_.at("ports").items()) fill("{" + device + "}", device);
    if (hidden_.contains("gateway")) Fill(text, "tcp:{gateway}", hidden_.at("gateway").get<std::string>());
    fill("{fixture}", "indexer");  // where no device of that name is a hand
    Write("bench.toml", text);
    return Call({"measure", "foreign.toml", "--bench", "bench.toml", "-o", "measured", "--allow-homing"});
  }

  nlohmann::json Separated() {
    Write("readings.csv", ReadingsOf("measured"));
    return Json({"separate", "readings.csv", "--scenario", "foreign.toml", "--json", "-"});
  }

  std::size_t Kept() const { return RunRecord::Open(At("measured"))->Readings().size(); }

  /// How often each fault cost an attempt. On a computer that is short of time an answer may also be late by itself, which is
  /// survived too: counts are at least what was scripted.
  std::map<std::string, int> FailedAttemptsByFault() const {
    std::map<std::string, int> counts;
    for (const FailedAttempt& failed : RunRecord::Open(At("measured"))->FailedAttempts()) ++counts[failed.fault];
    return counts;
  }

  /// Values of a table have no mean.
  /// @param u_most  Of an interval that says something.
  static void ExpectRecoveredButForMean(const nlohmann::json& table, const std::string& component, const nlohmann::json& hidden,
                                        double u_most) {
    const auto truth = hidden.get<std::vector<double>>();
    const nlohmann::json &values = table.at(component), &u = table.at("u_" + component);
    ASSERT_EQ(values.size(), truth.size());
    const double mean = std::accumulate(truth.begin(), truth.end(), 0.0) / static_cast<double>(truth.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_NEAR(values[k].get<double>(), truth[k] - mean, kCoverage * u[k].get<double>()) << k;
      EXPECT_LT(u[k].get<double>(), u_most) << k;
    }
  }

  static void ExpectStateUnknown(const Outcome& measured) {
    EXPECT_EQ(measured.exit_code, 3);
    EXPECT_THAT(measured.err, AllOf(HasSubstr("STATE UNKNOWN - USE THE EMERGENCY STOP"),
                                    HasSubstr("WHETHER THE AXES STAND STILL IS NOT KNOWN"), HasSubstr("--resume")));
  }

  const nlohmann::json& hidden() const { return hidden_; }

 private:
  static void Fill(std::string& text, const std::string& place, const std::string& with) {
    for (auto at = text.find(place); at != std::string::npos; at = text.find(place))
      text.replace(at, place.size(), with);
  }

  std::string program_, bench_file_;
  const char* python_ = kPlainPython;
  std::vector<std::string> settings_;
  nlohmann::json hidden_;
};

// --- a turntable ---

constexpr const char* kForeignTurntable = R"(bench = "turntable_autocollimator"
[multitooth]
teeth = 360
u_tooth_arcsec = 0.2
[autocollimator]
noise_arcsec = 0.05
range_arcsec = 300.0
[turntable_procedure]
phases = ["full_circle"]
positions = 6
tilts_arcsec = [40.0, 200.0, 150.0]
tilt_azimuths_deg = [25.0, 25.0, 140.0]
shifts_teeth = [0, 0, 60]
passes = [1, -1]
dwell_s = [0.01]
)";

/// A TOML text of docs/hardware.md, by the comment that it begins with. Waits are short there, so that faults are.
std::string Documented(const std::string& name) {
  std::ifstream in(TWINBENCH_SOURCE_DIR "/docs/hardware.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string fence = "```toml\n# " + name + "\n";
  const auto begin = text.find(fence);
  if (begin == std::string::npos) throw BenchError("docs/hardware.md has no " + name);
  const auto from = begin + fence.size();
  return text.substr(from, text.find("```", from) - from);
}

class ForeignTurntable : public ForeignBenchProgram {
 protected:
  ForeignTurntable() : ForeignBenchProgram("turntable_bench.py", kForeignTurntable, Documented("bench.toml")) {
    for (const char* dialogue : {"ac300.toml", "hirth360.toml"}) Write(dialogue, Documented(dialogue));
  }

  void ExpectRecovered(const nlohmann::json& separation, const std::string& table) const {
    SCOPED_TRACE(table);
    ExpectRecoveredButForMean(separation.at(table), "ez_arcsec", hidden().at(table + "_arcsec"), 0.1);
  }
};

TEST_F(ForeignTurntable, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  const Outcome measured = MeasureWith({"autocollimator.late@14", "controller.restart@20", "indexer.drop@30"});
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  EXPECT_EQ(Kept(), 36u);
  std::map<std::string, int> failed = FailedAttemptsByFault();
  EXPECT_GE(failed["timeout"], 1) << "a late autocollimator";
  EXPECT_GE(failed["dropped"], 1);
  EXPECT_GE(failed["restarted"], 1) << "told by its motors, for it has no MS?";

  const nlohmann::json separation = Separated();
  ExpectRecovered(separation, "turntable");
  ExpectRecovered(separation, "multitooth");
  const auto& roll = separation.at("roll");
  const double u_mrad = roll.at("u_gamma_mrad");
  EXPECT_NEAR(roll.at("gamma_mrad").get<double>(), hidden().at("roll_mrad").get<double>(), kCoverage * u_mrad);
  EXPECT_LT(u_mrad, 0.5);
}

TEST_F(ForeignTurntable, AControllerThatFreezesWhileTheTableTurnsIsToldSo) {
  ExpectStateUnknown(MeasureWith({"controller.freeze@9"}, 1));
  EXPECT_GT(Kept(), 0u);
  EXPECT_LT(Kept(), 8u) << "what was kept are ends of moves 1 to 8 at most, one of which was the run-up";
}

// --- the same turntable, as axis C of a machine that LinuxCNC runs ---

class ForeignTurntableOnLinuxCnc : public ForeignTurntable {
 protected:
  ForeignTurntableOnLinuxCnc() {
    Replace("kind = \"esp\"", "kind = \"linuxcnc\"");
    Replace("identity = \"ESP301 Version 3\"", "identity = \"HELLO ACK EMCNETSVR\"");
    Replace("[axis_turntable]", "[axis_turntable]\nletter = \"C\"");
  }

  /// @param joint  That moves axis C.
  void BeControlledBy(const std::string& controller, int joint) {
    BeSet("controller=" + controller);
    Replace("letter = \"C\"", "letter = \"C\"\njoint = " + std::to_string(joint));
  }

  void ExpectMeasured(const Outcome& measured) {
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    EXPECT_EQ(Kept(), 36u);
    const nlohmann::json separation = Separated();
    ExpectRecovered(separation, "turntable");
    ExpectRecovered(separation, "multitooth");
  }
};

TEST_F(ForeignTurntableOnLinuxCnc, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  BeControlledBy("linuxcnc", 2);
  ExpectMeasured(MeasureWith({"controller.mute@3", "controller.drop@9"}));
  std::map<std::string, int> failed = FailedAttemptsByFault();
  EXPECT_GE(failed["timeout"], 1);
  EXPECT_GE(failed["dropped"], 1);
}

TEST_F(ForeignTurntableOnLinuxCnc, AnEmergencyStopEndsTheRunWithTheTableAtRest) {
  BeControlledBy("linuxcnc", 2);
  const Outcome measured = MeasureWith({"controller.estop@9"});
  EXPECT_NE(measured.exit_code, 0);
  EXPECT_THAT(measured.err,
              AllOf(HasSubstr("emergency stop is on"), HasSubstr("brought to rest"), HasSubstr("--resume")));
  EXPECT_GT(Kept(), 0u);
}

TEST_F(ForeignTurntableOnLinuxCnc, IsBroughtToRestWhenAnotherProgramTakesTheCommand) {
  BeControlledBy("linuxcnc", 2);
  const Outcome measured = MeasureWith({"controller.taken@9"});
  EXPECT_EQ(measured.exit_code, 1);
  EXPECT_THAT(measured.err, AllOf(HasSubstr("somebody else commands it now"), HasSubstr("brought to rest"),
                                  HasSubstr("--resume")));
}

TEST_F(ForeignTurntableOnLinuxCnc, AControllerThatFreezesWhileTheTableTurnsIsToldSo) {
  BeControlledBy("linuxcnc", 2);
  ExpectStateUnknown(MeasureWith({"controller.freeze@9"}, 1));
}

/// LinuxCNC itself, which is not written by us: tests/data/linuxcnc/README.md says how it is started.
TEST_F(ForeignTurntableOnLinuxCnc, IsMeasuredOnTheRealProgram) {
  const char* address = std::getenv("TWINBENCH_LINUXCNC");
  if (!address) GTEST_SKIP() << "TWINBENCH_LINUXCNC=HOST:PORT names no linuxcncrsh (tests/data/linuxcnc/README.md)";
  Replace("{controller}", address);
  BeControlledBy(address, 0);
  ExpectMeasured(MeasureWith({}));
}

// --- a shaft with two encoders behind a gateway ---

constexpr const char* kForeignShaft = R"(bench = "encoder_comparison"
[encoder_procedure]
turns = 1.0
stops_per_turn = 12
stop_interval_s = 0.02
remount_s = 0.0
passes = [1, -1]
mounting_deg = [0.0, 90.0, 210.0]
)";

class ForeignShaft : public ForeignBenchProgram {
 protected:
  ForeignShaft() : ForeignBenchProgram("encoder_bench.py", kForeignShaft, Documented("shaft.toml")) {
    BeRunBy(kDebianPython);
  }
  void SetUp() override {
    if (!hw::HasNumberDriver("modbus")) GTEST_SKIP() << "this build has no libmodbus";
  }

  void ExpectMeasured(const Outcome& measured) {
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    EXPECT_EQ(Kept(), 72u);
    std::map<std::string, int> failed = FailedAttemptsByFault();
    EXPECT_GE(failed["timeout"], 1) << "a late answer";
    const nlohmann::json harmonics = Separated().at("harmonics");
    ExpectRecovered(harmonics, "device");
    ExpectRecovered(harmonics, "reference");
  }

  void ExpectRecovered(const nlohmann::json& harmonics, const std::string& what) const {
    for (const auto& wave : hidden().at(what)) {
      const auto& found = harmonics.at(what).at(wave.at("order").get<std::size_t>() - 1);
      EXPECT_NEAR(found.at("amplitude_arcsec").get<double>(), wave.at("amplitude_arcsec").get<double>(),
                  kCoverageByChance * found.at("u_amplitude_arcsec").get<double>())
          << what << wave;
      EXPECT_NEAR(found.at("phase_deg").get<double>(), wave.at("phase_deg").get<double>(),
                  kCoverageByChance * found.at("u_phase_deg").get<double>())
          << what << wave;
      EXPECT_LT(found.at("u_amplitude_arcsec").get<double>(), 0.1);
    }
  }
};

TEST_F(ForeignShaft, IsMeasuredThroughAModbusGatewayOfOthers) {
  ExpectMeasured(MeasureWith({"gateway.late@9"}));
}

TEST_F(ForeignShaft, IsMeasuredOverASerialLineWhereALateAnswerLooksLikeTheNext) {
  BeSet("rtu");
  ExpectMeasured(MeasureWith({"gateway.late@9"}));
}

TEST_F(ForeignShaft, AnExceptionOfTheGatewayEndsTheRunWithTheShaftAtRest) {
  const Outcome measured = MeasureWith({"gateway.refuse@9"});
  EXPECT_EQ(measured.exit_code, 1);
  EXPECT_THAT(measured.err, AllOf(HasSubstr("4 input registers from 20 were not read: Illegal data address"),
                                  HasSubstr("unit 3"), HasSubstr("brought to rest")));
}

// --- a five-axis machine ---

constexpr const char* kForeignFiveAxes = R"(bench = "freeform_five_axis"
[artefact]
vertex_radius_mm = [60.0, 90.0]
pitch_mm = 40.0
cells = 2
[qpd]
noise_mV = 5.0
[ccd]
noise_px = 0.02
[freeform_procedure]
mounts = [ {}, { z_mm = 60.0, yaw_deg = 90.0 }, { x_mm = 5.0, y_mm = -8.0, z_mm = 120.0 } ]
poses = 20
interval_s = 0.01
remount_s = 0.0
)";

class ForeignFiveAxes : public ForeignBenchProgram {
 protected:
  ForeignFiveAxes() : ForeignBenchProgram("five_axis_bench.py", kForeignFiveAxes, Documented("five_axes.toml")) {
    Replace("timeout_s = 0.3", "timeout_s = 0.3\nstall_s = 1.0");
  }

  void BeOnLinuxCnc(const std::string& controller) {
    BeSet("controller=" + controller);
    Replace("kind = \"esp\"", "kind = \"linuxcnc\"");
  }

  /// What a separation says of one number, against the bench's own.
  void ExpectNear(const nlohmann::json& value, const nlohmann::json& u, double hidden, const std::string& what) {
    EXPECT_NEAR(value.get<double>(), hidden, kCoverageByChance * u.get<double>()) << what;
    ++compared_;
  }

  void ExpectMeasured(const Outcome& measured) {
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    EXPECT_EQ(Kept(), 120u);
    const nlohmann::json separation = Separated();
    for (const auto& [name, error] : separation.at("errors").items()) {
      const nlohmann::json truth = hidden().at("errors").value(name, nlohmann::json{0.0, 0.0, 0.0, 0.0});
      for (std::size_t k = 0; k < truth.size(); ++k) {
        if (error.at("identified")[k])
          ExpectNear(error.at("coefficients")[k], error.at("u")[k], truth[k], name + std::to_string(k));
      }
    }
    for (const auto& [name, error] : separation.at("squareness").items()) {
      if (error.at("identified"))
        ExpectNear(error.at("value"), error.at("u"), hidden().at("squareness").value(name, 0.0), name);
    }
    EXPECT_GT(compared_, 40);
  }

 private:
  int compared_ = 0;
};

TEST_F(ForeignFiveAxes, AreMeasuredThroughFaultsAndTheirErrorsAreThoseTheyHide) {
  ExpectMeasured(MeasureWith({"controller.mute@3", "controller.unsettled@9", "probe.late@14", "probe.drop@30"}));
  std::map<std::string, int> failed = FailedAttemptsByFault();
  EXPECT_GE(failed["timeout"], 2);
  EXPECT_GE(failed["dropped"], 1);
  EXPECT_GE(failed["not_in_position"], 1);
}

TEST_F(ForeignFiveAxes, AreMeasuredWhereLinuxCncRunsThem) {
  BeOnLinuxCnc("linuxcnc");
  ExpectMeasured(MeasureWith({"controller.drop@9"}));
}

TEST_F(ForeignFiveAxes, AreNotSentHomeUnderAnArtefact) {
  const Outcome measured = MeasureWith({"controller.restart@9"});
  EXPECT_EQ(measured.exit_code, 1);
  EXPECT_THAT(measured.err, AllOf(HasSubstr("lost its origin with an instrument mounted"), HasSubstr("--resume")));
}

TEST_F(ForeignFiveAxes, AControllerThatFreezesOnItsWayIsToldSo) {
  ExpectStateUnknown(MeasureWith({"controller.freeze@9"}, 1));
}

TEST_F(ForeignFiveAxes, AreMeasuredOnTheRealProgram) {
  const char* address = std::getenv("TWINBENCH_LINUXCNC_XYZAB");
  if (!address)
    GTEST_SKIP() << "TWINBENCH_LINUXCNC_XYZAB=HOST:PORT names no linuxcncrsh (tests/data/linuxcnc/README.md)";
  Replace("{controller}", address);
  BeOnLinuxCnc(address);
  ExpectMeasured(MeasureWith({}));
}

// --- a hobbing machine ---

constexpr const char* kForeignHob = R"(bench = "hob_transmission"
[transmission]
hob_starts = 2
gear_teeth = 20
worm_wheel_teeth = 36
[hob_encoder]
lines = 10000
interpolation = 100
[interferometer]
used = false
[hob_procedure]
heads_deg = [0.0, 100.0]
hob_speeds_rev_min = [9600.0]
turns = 5
samples_per_turn = 30
ramp_s = 0.1
rest_s = 0.0
poll_s = 0.05
)";

// The counters answer in lines of the table's encoder, 18000 a turn, and in millionths of a turn of the hob.
constexpr const char* kForeignHobBench = R"(kind = "hardware"
[machine]
kind = "esp"
address = "tcp:{controller}"
identity = "ESP301 Version 3"
timeout_s = 0.3
[instrument_1]
kind = "scpi"
address = "tcp:{counters}"
identity = "FOREIGN COUNTING,IK2,"
timeout_s = 0.3
fields = ["table_encoder_deg", "hob_encoder_deg"]
scale = [0.02, 0.00036]
read = "NOW?"
arm = "LATCH {samples},{lines}"
fetch = "LATCHED?"
[fixture]
kind = "scpi"
address = "tcp:{counters}"
timeout_s = 0.3
)";

class ForeignHob : public ForeignBenchProgram {
 protected:
  ForeignHob() : ForeignBenchProgram("hob_bench.py", kForeignHob, kForeignHobBench) {}

  /// Every order that is hidden in a curve, with its phase.
  void ExpectRecovered(const nlohmann::json& curve, const std::string& what) const {
    for (const auto& wave : hidden().at(what)) {
      const auto at = wave.at("order").get<std::size_t>() - 1;
      const double u_arcsec = curve.at("u_amplitude_arcsec")[at], u_deg = curve.at("u_phase_deg")[at];
      EXPECT_NEAR(curve.at("amplitude_arcsec")[at].get<double>(), wave.at("amplitude_arcsec").get<double>(), kCoverageByChance * u_arcsec)
          << what << wave;
      EXPECT_NEAR(curve.at("phase_deg")[at].get<double>(), wave.at("phase_deg").get<double>(), kCoverageByChance * u_deg) << what << wave;
      EXPECT_LT(u_arcsec, 0.1) << what << wave;  // of arcsecs
    }
  }
};

TEST_F(ForeignHob, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  const Outcome measured = MeasureWith({"counters.lost@4", "controller.drop@4"});
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  EXPECT_EQ(Kept(), 600u);
  std::map<std::string, int> failed = FailedAttemptsByFault();
  EXPECT_GE(failed["dropped"], 1);
  EXPECT_GE(failed["overrun"], 1) << "a sample that was lost";

  const nlohmann::json separation = Separated();
  ExpectRecovered(separation.at("table_encoder"), "ring");
  ASSERT_EQ(separation.at("transmission").size(), 2u) << "both directions";
  for (const auto& direction : separation.at("transmission")) ExpectRecovered(direction, "transmission");
}

TEST_F(ForeignHob, AControllerThatFreezesWhileTheHobTurnsOnIsToldSo) {
  ExpectStateUnknown(MeasureWith({"controller.freeze@3"}, 1));
  EXPECT_EQ(Kept(), 150u) << "the first pass; event 3 begins the second";
}

// --- two rotary tables ---

constexpr const char* kForeignRotary = R"(bench = "rotary_4dof"
[procedure]
phases = ["full_circle"]
positions = 6
shifts = [0, 1]
passes = [1, -1]
clamping = "reseat"
dwell_s = [0.01]
remount_s = 0.0
)";

constexpr const char* kForeignRotaryBench = R"(kind = "hardware"
[adc]
kind = "iio"
uri = "ip:{adc}"
device = "foreign-adc"
channels = ["voltage0", "voltage1", "voltage2", "voltage3"]
serial = "F-0815"
timeout_s = 0.5
[target]
kind = "esp"
address = "tcp:{controller}"
identity = "ESP301 Version 3"
axis = 1
decimals = 6
timeout_s = 0.3
[reference]
kind = "esp"
address = "tcp:{controller}"
identity = "ESP301 Version 3"
axis = 2
decimals = 6
timeout_s = 0.3
[fixture]
kind = "scpi"
address = "tcp:{fixture}"
timeout_s = 0.3
)";

class ForeignRotary : public ForeignBenchProgram {
 protected:
  ForeignRotary() : ForeignBenchProgram("rotary_bench.py", kForeignRotary, kForeignRotaryBench) {}

  void ExpectRecovered(const nlohmann::json& separation, const std::string& table, const std::string& component,
                       double u_most) const {
    SCOPED_TRACE(table + "." + component);
    ExpectRecoveredButForMean(separation.at(table), component, hidden().at(table + "." + component), u_most);
  }
};

/// Its bench file has no goniometer: a full circle needs none, also behind a fault.
TEST_F(ForeignRotary, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  const Outcome measured = MeasureWith({"controller.mute@5", "adc.gap@3", "adc.drop@9"});
  if (measured.err.find("made without the driver") != std::string::npos) GTEST_SKIP() << measured.err;
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  EXPECT_EQ(Kept(), 24u);
  std::map<std::string, int> failed = FailedAttemptsByFault();
  EXPECT_GE(failed["timeout"], 1);
  EXPECT_GE(failed["dropped"], 1);
  EXPECT_GE(failed["gap"], 1);

  const nlohmann::json separation = Separated();
  ExpectRecovered(separation, "target", "ez_arcsec", 0.3);
  ExpectRecovered(separation, "reference", "ez_arcsec", 0.3);
  ExpectRecovered(separation, "target", "ex_arcsec", 0.6);
  ExpectRecovered(separation, "target", "dy_um", 0.5);
}

}  // namespace
}  // namespace twinbench::test
