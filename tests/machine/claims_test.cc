#include "twin/benches/claims.h"

#include "hw_bridge/in_position.h"
#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "tests/machine/benches.h"
#include "tests/support/machine_run.h"
#include "twin/benches/circular_motion/procedure.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/twin/twin.h"
#include "twin/report/evaluation.h"

/// What results claim of the places of axes, what a bench file may allow there, and when readings are due.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

/// The mean of a list of uncertainties in the results that a run of the twin gives.
double MeanU_arcsec(const Scenario& scenario, const std::string& place) {
  const Bench& bench = BenchOf(scenario);
  const auto record = RunRecord::CreateInMemory({"test", "twin", scenario.seed, "", scenario.bench});
  bench.make_twin(scenario)->CarryOut(*record, {});
  const nlohmann::json u =
      bench.evaluate(scenario, record->Readings(), Estimator::kRigorous).results.at(nlohmann::json::json_pointer(place));
  double sum = 0.0;
  for (const double one : u) sum += one;
  return sum / static_cast<double>(u.size());
}

double Claimed_arcsec(const Scenario& scenario, const std::string& axis) {
  for (const Claim& claim : ClaimsOf(scenario)) {
    if (claim.axis == axis) return claim.u / units::arcsec;
  }
  return 0.0;
}

Scenario Rotary(const std::string& procedure) {
  return ParseScenario("bench = \"rotary_4dof\"\nseed = 5\n[mechanics]\nfidelity = \"kinematic\"\n[optics]\nfidelity = "
                       "\"closed\"\n[procedure]\n" + procedure,
                       "claims.toml", "");
}

TEST(Claims, OfTwoTablesAreWhatTheSeparationStates) {
  for (const char* procedure : {"positions = 12\nshifts = [0, 1, 5]\npasses = [1, -1]\n",
                                "positions = 18\nshifts = [0, 1, 5, 7]\npasses = [1, -1, -1, 1]\n"}) {
    const Scenario scenario = Rotary(procedure);
    // The errors' mean is taken out, and with it one of `positions` parts of the variance: 4 % of 12. The samples' own scatter is
    // the weight: of some hundred blocks of 100 samples, to a per cent or two.
    const double stated = MeanU_arcsec(scenario, "/separation/target/u_ez_arcsec");
    EXPECT_NEAR(Claimed_arcsec(scenario, "target") / stated, 1.03, 0.04) << procedure;
    EXPECT_EQ(Claimed_arcsec(scenario, "reference"), Claimed_arcsec(scenario, "target"));
  }
}

TEST(Claims, OfAComparisonAtStopsAreWhatItsCurveStates) {
  const Scenario scenario = ParseScenario(
      "bench = \"encoder_comparison\"\nseed = 5\n[device]\nnoise_known = true\n[encoder_procedure]\nturns = 1.0\n"
      "stops_per_turn = 36\npasses = [1, -1, -1, 1]\n",
      "claims.toml", "");
  EXPECT_NEAR(Claimed_arcsec(scenario, "shaft") / MeanU_arcsec(scenario, "/device/u_ez_arcsec"), 1.0, 0.05);
}

/// Slopes of what the twin shows where one axis of the ideal machine after the other is moved off its pose.
TEST(Claims, OfFiveAxesAreWhatTheTwinsReadingsSay) {
  const Scenario scenario = ParseScenario(
      "bench = \"freeform_five_axis\"\nseed = 4\n[optics]\nfidelity = \"closed\"\n[artefact]\nmounting_um = 0.0\nmounting_arcsec = 0.0\n"
      "[machine.random]\ntranslation_um = 0.0\nrotation_arcsec = 0.0\nsquareness_arcsec = 0.0\n"
      "[freeform_procedure]\nmounts = [ { } ]\nposes = 8\n",
      "claims.toml", "");
  const std::vector<Claim> claims = ClaimsOf(scenario);
  ASSERT_EQ(claims.size(), 5u);
  const FreeformSettings& own = FreeformOf(scenario);
  sim::FreeformTwin twin(scenario, sim::Draw(scenario));
  const auto shown = [&](Reading pose, std::size_t axis, double by) {
    benches::freeform::kCommanded[axis](pose) += by;
    const sim::ProbeSignals signals = twin.Show(pose, 0.0);
    return Eigen::Vector3d(signals.qpd_x_V / own.qpd.noise_V, signals.qpd_y_V / own.qpd.noise_V, signals.ccd_px / own.ccd.noise_px);
  };
  const std::vector<Reading> plan = procedure::FreeformSchedule(scenario);
  for (std::size_t axis = 0; axis < claims.size(); ++axis) {
    const double step = axis < 3 ? 1e-6 : units::arcsec;
    double information = 0.0;
    for (const Reading& pose : plan) information += ((shown(pose, axis, step) - shown(pose, axis, -step)) / (2.0 * step)).squaredNorm();
    const double u = 1.0 / std::sqrt(2.0 * information / static_cast<double>(plan.size()));
    EXPECT_NEAR(claims[axis].u / u, 1.0, 1e-3) << claims[axis].axis;
  }
  // What the message of a refused bench file says is so: the claim grows with the stated noise.
  Scenario scattering = scenario;
  FreeformOf(scattering).qpd.noise_V *= 4.0;
  FreeformOf(scattering).ccd.noise_px *= 4.0;
  EXPECT_NEAR(ClaimsOf(scattering)[0].u / claims[0].u, 4.0, 1e-9);
  EXPECT_THAT(claims[0].less, HasSubstr("qpd.noise_mV"));
  EXPECT_LT(claims[0].u, 1e-6) << "fractions of a um";
  EXPECT_LT(claims[3].u, 5.0 * units::arcsec);
}

TEST(Claims, ThereAreNoneWhereNothingIsClaimedAtAStop) {
  Scenario scenario = Rotary("positions = 12\n");
  scenario.noise_free = true;
  EXPECT_TRUE(ClaimsOf(scenario).empty());
  EXPECT_TRUE(ClaimsOf(ParseScenario("bench = \"hob_transmission\"\n", "hob.toml", "")).empty());
  EXPECT_TRUE(ClaimsOf(ParseScenario("bench = \"circular_motion\"\n", "circular.toml", "")).empty());
}

const std::string kTurntableFile = Contents(TWINBENCH_TEST_DATA "/machine/turntable_by_esp.toml");

TEST(InPosition, IsTheClaimUnlessTheFileAsksForLess) {
  const std::vector<MachineAxis> axes = {{"turntable", true}};
  hw::MachineFile file = hw::ParseMachineFile(kTurntableFile, "bench.toml", axes);
  EXPECT_TRUE(std::isinf(file.axes[0].in_position));
  hw::TieToClaim(file, axes, "shaft", 0.1 * units::arcsec, "");
  EXPECT_TRUE(std::isinf(file.axes[0].in_position)) << "another axis";
  hw::TieToClaim(file, axes, "turntable", 0.1 * units::arcsec, "");
  EXPECT_EQ(file.axes[0].in_position, 0.1 * units::arcsec);
  std::string text = kTurntableFile;
  text.replace(text.find("lower_deg = -30.0"), 17, "in_position_arcsec = 0.04");
  file = hw::ParseMachineFile(text, "bench.toml", axes);
  hw::TieToClaim(file, axes, "turntable", 0.1 * units::arcsec, "");
  EXPECT_DOUBLE_EQ(file.axes[0].in_position, 0.04 * units::arcsec);
  EXPECT_KEPT(MessageOf([&] { hw::TieToClaim(file, axes, "turntable", 0.03 * units::arcsec, "a larger key"); }));
}

TEST(InPosition, OfALinearAxisIsToldInMicrometres) {
  const std::vector<MachineAxis> axes = {{"x"}};
  std::string text = kTurntableFile;
  text.replace(text.find("[axis_turntable]\nlower_deg = -30.0"), 34, "[axis_x]\nin_position_um = 0.3");
  hw::MachineFile file = hw::ParseMachineFile(text, "bench.toml", axes);
  hw::TieToClaim(file, axes, "x", 0.4 * units::um, "");
  EXPECT_DOUBLE_EQ(file.axes[0].in_position, 0.3 * units::um);
  EXPECT_KEPT(MessageOf([&] { hw::TieToClaim(file, axes, "x", 0.2 * units::um, ""); }));
}

double Between_s(const Reading& one, const Reading& other) { return ToSeconds(other.time - one.time); }

/// The last reading of the first set-up and the first of the second.
std::pair<Reading, Reading> AtTheChange(const std::vector<Reading>& plan) {
  const auto next = std::ranges::find(plan, 1, &Reading::setup);
  return {*std::prev(next), *next};
}

TEST(Schedules, OfPosesAreAsFarApartAsTheScenarioSays) {
  const std::vector<Reading> plan = procedure::FreeformSchedule(
      Altered(ShortFreeform(), {"freeform_procedure.interval_s=0.5", "freeform_procedure.remount_s=30"}));
  EXPECT_NEAR(Between_s(plan[0], plan[1]), 0.5, 1e-9);
  const auto [before, behind] = AtTheChange(plan);
  EXPECT_NEAR(Between_s(before, behind), 30.5, 1e-9);
}

TEST(Schedules, OfCirclesLetHandsWorkAsLongAsTheScenarioSays) {
  Scenario scenario = ShortCircles();
  const auto [before, behind] = AtTheChange(procedure::CircleSchedule(CircularOf(scenario).procedure));
  CircularOf(scenario).procedure.remount_s += 100.0;
  const auto [early, late] = AtTheChange(procedure::CircleSchedule(CircularOf(scenario).procedure));
  EXPECT_EQ(early.time, before.time);
  EXPECT_NEAR(Between_s(behind, late), 100.0, 1e-9);
}

const std::vector<MachineAxis> kAxes = {{"x", false}, {"a", true}};

const std::string kWhole = Contents(TWINBENCH_TEST_DATA "/machine/mill_by_esp.toml");

std::string Refusal(const std::string& text) {
  return MessageOf([&] { hw::ParseMachineFile(text, "bench.toml", kAxes); });
}

/// At these lines of the bench file.
void ExpectRefused(const std::vector<Refused>& files) { twinbench::ExpectRefused("bench.toml", Refusal, files); }

std::string Changed(const std::string& from, const std::string& to) {
  std::string text = kWhole;
  return text.replace(text.find(from), from.size(), to);
}

std::string OnLinuxCnc(const std::string& from = "", const std::string& to = "") {
  std::string text = Changed("kind = \"esp\"\naddress = \"serial:/dev/ttyUSB0:19200\"",
                             "kind = \"linuxcnc\"\naddress = \"tcp:mill.lab:5007\"");
  return from.empty() ? text : text.replace(text.find(from), from.size(), to);
}

TEST(MachineFile, NamesTheAxesOfALinuxCncMachineAndRefusesWhatItCannotBeOrOthersAreNot) {
  hw::MachineFile file = hw::ParseMachineFile(OnLinuxCnc(), "bench.toml", kAxes);
  EXPECT_EQ(hw::LetterOf(file, kAxes, 0), "X") << "its own name, where LinuxCNC has such an axis";
  EXPECT_EQ(file.joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(file.machine.enable_password, "EMCTOO");
  file =
      hw::ParseMachineFile(OnLinuxCnc("[axis_a]\n", "[axis_a]\nletter = \"c\"\njoint = 5\n"), "bench.toml", kAxes);
  EXPECT_EQ(hw::LetterOf(file, kAxes, 1), "C");
  EXPECT_EQ(file.joints[1], 5);
  ExpectRefused({{11, OnLinuxCnc("[axis_a]\n", "[axis_a]\nletter = \"Z\"\n")},
                 {10, OnLinuxCnc("[axis_a]\n", "[axis_a]\njoint = 0\n")},
                 {5, OnLinuxCnc("stall_s", "watchdog = \"XW\"\nstall_s")},
                 {5, OnLinuxCnc("stall_s", "enable_password = \"a b\"\nstall_s")},
                 {21, OnLinuxCnc() + "[clock]\nkind = \"scpi\"\naddress = \"tcp:twin:5025\"\n"},
                 {11, Changed("[axis_a]\n", "[axis_a]\nletter = \"A\"\n")},
                 {5, Changed("stall_s", "connect_password = \"EMC\"\nstall_s")}});
}

std::string WithNumbers(const std::string& lines) {
  const std::string instrument =
      "kind = \"scpi\"\naddress = \"tcp:bar.lab:5025\"\nfields = [\"ignored\", \"bar_um\"]\nscale = [1.0, "
      "1000.0]\nread = \"MEAS:LENG?\"\narm = \"\"\n";
  return Changed(instrument, "fields = [\"ignored\", \"bar_um\"]\n" + lines);
}

TEST(MachineFile, ReadsRegistersAsOneItemAField) {
  const std::string gateway = "kind = \"modbus\"\naddress = \"tcp:gateway.lab:502\"\n";
  const hw::MachineFile file = hw::ParseMachineFile(
      WithNumbers(gateway + "unit = 9\nread = \"input 4 int16, holding 65535 uint16\"\n"), "bench.toml", kAxes);
  EXPECT_EQ(file.instruments[0].Numbers().unit, 9);
  EXPECT_THAT(file.instruments[0].Numbers().items, testing::ElementsAre("input 4 int16", "holding 65535 uint16"));
  ExpectRefused({{13, WithNumbers(gateway)}, {17, WithNumbers(gateway + "read = \"input 4 int16\"\n")},
                 {17, WithNumbers(gateway + "read = \"input 4 int16, coil 3\"\n")},
                 {17, WithNumbers(gateway + "arm = \"INIT\"\nread = \"input 4 int16, input 5 int16\"\n")},
                 {13, WithNumbers("kind = \"comedi\"\nread = \"2 0, 2 1\"\n")},
                 {19, Changed("arm = \"\"", "unit = 3")}});
}

TEST(MachineFile, IsReadInTheUnitsOfItsKeysAndWhatIsWrongIsToldWithItsLine) {
  const hw::MachineFile file = hw::ParseMachineFile(kWhole, "bench.toml", kAxes);
  EXPECT_DOUBLE_EQ(file.axes[0].lower, -0.15);
  EXPECT_DOUBLE_EQ(file.axes[0].in_position, 5e-6);
  EXPECT_DOUBLE_EQ(file.axes[1].upper, 10.0 * units::deg);
  EXPECT_EQ(file.axes[1].stall_s, 2.0) << "of the machine, and so of every axis";
  EXPECT_DOUBLE_EQ(file.traverse_m_s, 0.03);
  EXPECT_EQ(file.fixture.kind, "console");
  ExpectRefused({{6, Changed("lower_mm = -150.0", "lower_mm = 250.0")}, {7, Changed("lower_mm", "lower_deg")},
                 {3, Changed("serial:/dev/ttyUSB0:19200", "ttyUSB0")},
                 {17, Changed("scale = [1.0, 1000.0]", "scale = [1.0]")}, {10, Changed("[axis_a]", "[axis_b]")},
                 {15, Changed("[instrument_1]\nkind = \"scpi\"", "[instrument_1]\nkind = \"none\"")},
                 {2, "kind = \"twin\"\n[machine]\nkind = \"esp\"\n"}});
}

/// The bench file that is served with circles, with a change.
class OpenMachine : public testing::Test {
 protected:
  std::string Served(const std::string& from, const std::string& to) const {
    std::string text = served_.BenchFile();
    return text.replace(text.find(from), from.size(), to);
  }
  static std::unique_ptr<hw::OpenMachine> Open(const std::string& text,
                                               const std::vector<MachineAxis>& axes = {{"x"}, {"y"}}) {
    return hw::OpenMachineHardware(hw::ParseMachineFile(text, "served.toml", axes), axes, Columns());
  }
  static std::vector<ReadingColumn> Columns() { return InstrumentColumns(FormatOf(kCircularBench).columns); }
  static std::string Refusal(const std::string& text, const std::vector<MachineAxis>& axes = {{"x"}, {"y"}}) {
    return MessageOf<std::runtime_error>([&] { Open(text, axes); });
  }

  const ServedMachineTwin served_{ShortCircles()};
};

TEST_F(OpenMachine, RefusesWhatTheControllerDoesNotAllowAFieldThatTheBenchHasNotOtherAxesAndAnotherDevice) {
  EXPECT_THAT(Refusal(Served("[instrument_1]", "[axis_x]\nlower_mm = -500.0\n[instrument_1]")),
              HasSubstr("the controller allows axis x"));
  EXPECT_KEPT(Refusal(Served("\"bar_um\"", "\"bar_mm\"")));
  EXPECT_THAT(Refusal(served_.BenchFile(), {{"x"}, {"y"}, {"z"}}), HasSubstr("1HN1,2,3"))
      << "two axes are not three";
  EXPECT_THAT(Refusal(Served("ESP301 twinbench ", "XPS-")), HasSubstr("expected what begins with \"XPS-\""));
}

/// The words of an instrument are the bench file's: the same samples, of one field, asked in other words.
TEST_F(OpenMachine, AsksAnInstrumentInTheWordsOfTheBenchFile) {
  const std::string text = served_.BenchFile();
  const auto begin = text.find("fields = "), end = text.find('\n', begin);
  const auto opened = Open(Served(
      text.substr(begin, end - begin),
      "fields = [\"ignored\", \"status\", \"bar_um\", \"encoder_deg\", \"ignored\", \"ignored\", "
      "\"temperature_degC\"]\nscale = [1.0, 1.0, 1000.0, 1.0, 1.0, 1.0, 1.0]\nread = \":INSTRUMENT:READ?\""));
  const auto plain = BenchOf(ShortCircles()).make_devices(ShortCircles());
  MachineBench bench = opened->Devices();
  bench.simulation->Restart();
  const Reading shown = bench.instruments.Read(), expected = plain->Devices().instruments.Read();
  const std::vector<ReadingColumn> columns = Columns();
  EXPECT_DOUBLE_EQ(std::stod(columns[0].print(shown)), 1000.0 * std::stod(columns[0].print(expected)));
  EXPECT_EQ(columns[1].print(shown), columns[1].print(expected));
  EXPECT_EQ(shown.temperature_degC, expected.temperature_degC);
}

}  // namespace
}  // namespace twinbench::test
