#include "tests/support/foreign_bench.h"

#include "hw_bridge/numbers/number_source.h"
#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

/// `measure` on benches that others have written, in real time: their controllers, instruments and physics.
namespace twinbench::test {
namespace {

/// Of standard uncertainties. The noise of benches that are read at stops is the same in every run.
constexpr double kCoverage = 3.0;
/// Of a machine that turns on, when a path begins is a matter of the computer's time, and so is what is drawn, as
/// it is behind a gateway that is asked again: 14 values in every run, with 20 degrees of freedom or more;
/// Student's t leaves 1 run in 10 000 outside.
constexpr double kCoverageByChance = 6.0;

/// `measure` of a scenario on a bench whose file has `{device}` where a device's address belongs.
class ForeignBenchProgram : public ProgramHere {
 protected:
  /// @param name  Of its program and its scenario in tests/data/foreign_bench/.
  ForeignBenchProgram(const std::string& name, std::string bench_file)
      : program_(name + "_bench.py"), bench_file_(std::move(bench_file)) {
    Write("foreign.toml", Data(name + ".toml"));
  }
  static std::string Data(const std::string& file) {
    return Contents(TWINBENCH_TEST_DATA "/foreign_bench/" + file);
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
    const ForeignBench bench(program_, At(""), With(faults, settings_), python_);
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

  /// It ended well with so many readings, and faults cost attempts. On a computer short of time an answer may
  /// also be late by itself, which is survived too: counts are at least what was scripted.
  void ExpectKept(const Outcome& measured, std::size_t readings,
                  const std::map<std::string, int>& at_least = {}) const {
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    EXPECT_EQ(Kept(), readings);
    std::map<std::string, int> counts;
    for (const FailedAttempt& failed : RunRecord::Open(At("measured"))->FailedAttempts()) ++counts[failed.fault];
    for (const auto& [fault, times] : at_least) EXPECT_GE(counts[fault], times) << fault;
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

  /// @param hidden  A wave of some arcsec and its phase, against what was found of it.
  static void ExpectWave(const nlohmann::json& hidden, double amplitude_arcsec, double u_arcsec, double phase_deg,
                         double u_deg) {
    EXPECT_NEAR(amplitude_arcsec, hidden.at("amplitude_arcsec").get<double>(), kCoverageByChance * u_arcsec)
        << hidden;
    EXPECT_NEAR(phase_deg, hidden.at("phase_deg").get<double>(), kCoverageByChance * u_deg) << hidden;
    EXPECT_LT(u_arcsec, 0.1) << hidden;
  }

  static void ExpectStateUnknown(const Outcome& measured) {
    ExpectEnded(measured, 3, {"STATE UNKNOWN - USE THE EMERGENCY STOP", "WHETHER THE AXES STAND STILL IS NOT KNOWN",
                              "--resume"});
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

/// A TOML text of docs/hardware.md, by the comment that it begins with. Waits are short there, so that faults are.
std::string Documented(const std::string& name) {
  const std::string text = Contents(TWINBENCH_SOURCE_DIR "/docs/hardware.md");
  const std::string fence = "```toml\n# " + name + "\n";
  const auto begin = text.find(fence);
  if (begin == std::string::npos) throw BenchError("docs/hardware.md has no " + name);
  const auto from = begin + fence.size();
  return text.substr(from, text.find("```", from) - from);
}

class ForeignTurntable : public ForeignBenchProgram {
 protected:
  ForeignTurntable() : ForeignBenchProgram("turntable", Documented("bench.toml")) {
    for (const char* dialogue : {"ac300.toml", "hirth360.toml"}) Write(dialogue, Documented(dialogue));
  }

  void ExpectRecovered(const nlohmann::json& separation, const std::string& table) const {
    SCOPED_TRACE(table);
    ExpectRecoveredButForMean(separation.at(table), "ez_arcsec", hidden().at(table + "_arcsec"), 0.1);
  }
};

TEST_F(ForeignTurntable, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  const auto faults = {"autocollimator.late@14", "controller.restart@20", "indexer.drop@30"};
  // A late autocollimator; and a controller that has no MS? tells a restart by its motors.
  ExpectKept(MeasureWith({faults.begin(), faults.end()}), 36, {{"timeout", 1}, {"dropped", 1}, {"restarted", 1}});

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

/// Its faces are nulled, some of them beyond the places of the plan.
TEST_F(ForeignTurntable, WithAPolygonIsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  Write("foreign.toml", Data("polygon.toml"));
  BeSet("polygon");
  const auto faults = {"autocollimator.late@14", "controller.mute@20", "controller.unsettled@30"};
  ExpectKept(MeasureWith({faults.begin(), faults.end()}), 36, {{"timeout", 1}, {"not_in_position", 1}});
  ExpectRecovered(Separated(), "turntable");
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

  void ExpectMeasured(const Outcome& measured, const std::map<std::string, int>& faults = {}) {
    ExpectKept(measured, 36, faults);
    const nlohmann::json separation = Separated();
    ExpectRecovered(separation, "turntable");
    ExpectRecovered(separation, "multitooth");
  }
};

TEST_F(ForeignTurntableOnLinuxCnc, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  BeControlledBy("linuxcnc", 2);
  ExpectMeasured(MeasureWith({"controller.mute@3", "controller.drop@9"}), {{"timeout", 1}, {"dropped", 1}});
}

TEST_F(ForeignTurntableOnLinuxCnc, AnEmergencyStopOrAnotherProgramThatTakesTheCommandEndsTheRunWithTheTableAtRest) {
  BeControlledBy("linuxcnc", 2);
  for (const auto& [fault, said] : {std::pair{"controller.estop@9", "emergency stop is on"},
                                    std::pair{"controller.taken@9", "somebody else commands it now"}}) {
    std::filesystem::remove_all(At("measured"));
    ExpectEnded(MeasureWith({fault}), 1, {said, "brought to rest", "--resume"});
    EXPECT_GT(Kept(), 0u);
  }
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

class ForeignShaft : public ForeignBenchProgram {
 protected:
  ForeignShaft() : ForeignBenchProgram("encoder", Documented("shaft.toml")) { BeRunBy(kDebianPython); }
  void SetUp() override {
    if (!hw::HasNumberDriver("modbus")) GTEST_SKIP() << "this build has no libmodbus";
  }

  void ExpectMeasured(const Outcome& measured) {
    ExpectKept(measured, 72, {{"timeout", 1}});  // a late answer
    const nlohmann::json harmonics = Separated().at("harmonics");
    ExpectRecovered(harmonics, "device");
    ExpectRecovered(harmonics, "reference");
  }

  void ExpectRecovered(const nlohmann::json& harmonics, const std::string& what) const {
    for (const auto& wave : hidden().at(what)) {
      const auto& found = harmonics.at(what).at(wave.at("order").get<std::size_t>() - 1);
      ExpectWave(wave, found.at("amplitude_arcsec"), found.at("u_amplitude_arcsec"), found.at("phase_deg"),
                 found.at("u_phase_deg"));
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
  ExpectEnded(MeasureWith({"gateway.refuse@9"}), 1,
              {"4 input registers from 20 were not read: Illegal data address", "unit 3", "brought to rest"});
}

// --- a five-axis machine ---

class ForeignFiveAxes : public ForeignBenchProgram {
 protected:
  ForeignFiveAxes() : ForeignBenchProgram("five_axis", Documented("five_axes.toml")) {
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

  void ExpectMeasured(const Outcome& measured, const std::map<std::string, int>& faults = {}) {
    ExpectKept(measured, 120, faults);
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
  ExpectMeasured(MeasureWith({"controller.mute@3", "controller.unsettled@9", "probe.late@14", "probe.drop@30"}),
                 {{"timeout", 2}, {"dropped", 1}, {"not_in_position", 1}});
}

TEST_F(ForeignFiveAxes, AreMeasuredWhereLinuxCncRunsThem) {
  BeOnLinuxCnc("linuxcnc");
  ExpectMeasured(MeasureWith({"controller.drop@9"}));
}

TEST_F(ForeignFiveAxes, AreNotSentHomeUnderAnArtefact) {
  ExpectEnded(MeasureWith({"controller.restart@9"}), 1, {"lost its origin with an instrument mounted", "--resume"});
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

class ForeignHob : public ForeignBenchProgram {
 protected:
  ForeignHob() : ForeignBenchProgram("hob", Data("hob_bench.toml")) {}

  /// Every order that is hidden in a curve, with its phase.
  void ExpectRecovered(const nlohmann::json& curve, const std::string& what) const {
    for (const auto& wave : hidden().at(what)) {
      const auto at = wave.at("order").get<std::size_t>() - 1;
      ExpectWave(wave, curve.at("amplitude_arcsec")[at], curve.at("u_amplitude_arcsec")[at],
                 curve.at("phase_deg")[at], curve.at("u_phase_deg")[at]);
    }
  }
};

TEST_F(ForeignHob, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  ExpectKept(MeasureWith({"counters.lost@4", "controller.drop@4"}), 600,
             {{"dropped", 1}, {"overrun", 1}});  // a sample that was lost
  const nlohmann::json separation = Separated();
  ExpectRecovered(separation.at("table_encoder"), "ring");
  ASSERT_EQ(separation.at("transmission").size(), 2u) << "both directions";
  for (const auto& direction : separation.at("transmission")) ExpectRecovered(direction, "transmission");
}

TEST_F(ForeignHob, AControllerThatFreezesWhileTheHobTurnsOnIsToldSo) {
  ExpectStateUnknown(MeasureWith({"controller.freeze@3"}, 1));
  EXPECT_EQ(Kept(), 150u) << "the first pass; event 3 begins the second";
}

// --- a machine that goes round ---

class ForeignCircle : public ForeignBenchProgram {
 protected:
  ForeignCircle() : ForeignBenchProgram("circle", Data("circle_bench.toml")) {}
};

TEST_F(ForeignCircle, IsMeasuredThroughFaultsAndItsErrorsAreThoseItHides) {
  ExpectKept(MeasureWith({"bar.lost@1", "controller.mute@3"}), 72, {{"gap", 1}, {"timeout", 1}});
  const nlohmann::json errors = Separated().at("errors");
  for (const char* what : {"scale_mismatch_um_m", "squareness_arcsec"}) {
    const auto& error = errors.at(std::string("machine.") + what);
    EXPECT_NEAR(error.at("value").get<double>(), hidden().at(what).get<double>(),
                kCoverage * error.at("u").get<double>())
        << what;
  }
}

// --- two rotary tables ---

class ForeignRotary : public ForeignBenchProgram {
 protected:
  ForeignRotary() : ForeignBenchProgram("rotary", Data("rotary_bench.toml")) {}

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
  ExpectKept(measured, 24, {{"timeout", 1}, {"dropped", 1}, {"gap", 1}});
  const nlohmann::json separation = Separated();
  ExpectRecovered(separation, "target", "ez_arcsec", 0.3);
  ExpectRecovered(separation, "reference", "ez_arcsec", 0.3);
  ExpectRecovered(separation, "target", "ex_arcsec", 0.6);
  ExpectRecovered(separation, "target", "dy_um", 0.5);
}

}  // namespace
}  // namespace twinbench::test
