#include "hw_bridge/bench_file.h"
#include "hw_bridge/control/absent.h"
#include "hw_bridge/control/host_clock.h"
#include "hw_bridge/control/operator_devices.h"
#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "tests/support/faults.h"

namespace twinbench::hw {
namespace {

using testing::HasSubstr;

constexpr const char* kWhole = R"(title = "autocollimator of the cellar"
[read]
ask = "A?"
fields = ["x", "y"]
units = ["urad", "urad"]
)";

TEST(DialogueWords, AWholeOneIsTakenAsItStands) {
  const DialogueWords words = ParseDialogue(kWhole, "my.toml");
  EXPECT_EQ(words.title, "autocollimator of the cellar");
  EXPECT_EQ(words.read.fields, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(words.identify, "*IDN?") << "what is not said is as of SCPI";
  EXPECT_TRUE(words.errors == ErrorWords{});
}

TEST(DialogueWords, WhatIsWrongIsToldWithFileLineAndTheNearestRightThing) {
  const std::string whole = kWhole;
  ExpectRefused("my.toml", [](const auto& text) { return MessageOf([&] { ParseDialogue(text, "my.toml"); }); }, {
      {6, whole + "unitts = 3\n"}, {1, "[raed]\nask = \"A?\"\n"},
      {4, "[read]\nask = \"A?\"\nfields = [\"x\"]\nunits = [\"arcsecs\"]\n"},
      {4, "[read]\nask = \"A?\"\nfields = [\"x\", \"y\"]\nvalid = [\"4\"]\n"}, {1, "[read]\nfields = [\"x\"]\n"},
      {2, "[move]\ncommand = \"GOTO {toth}\"\n"}, {0, whole + "[latch]\narm = \"ARM {samples}\"\n"},
      {7, whole + "[line]\nends = \"LFCR\"\n"}, {7, whole + "[line]\nseparator = \"\"\n"},
      {0, "title = \"mute\"\n"},
  });
}

/// Each is tried against its counterpart: the served ones in tests/contract and tests/machine, the others in
/// described_devices_test.cc.
TEST(DialogueWords, ReadyOnesAreTheseAndAllAreWhole) {
  std::set<std::string> names;
  for (const ReadyDialogue& ready : ReadyDialogues()) {
    names.insert(ready.name);
    EXPECT_FALSE(ParseDialogue(ready.text, ready.name).title.empty()) << ready.name;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"elcomat", "elcomat_relative", "heidenhain_nd287", "served_autocollimator",
                                   "served_goniometer", "served_indexer", "served_thermometer"}));
}

TEST(DialogueWords, EveryKeyStandsInTheDocumentation) {
  const std::string whole = Contents(TWINBENCH_SOURCE_DIR "/docs/hardware.md");
  const auto begin = whole.find("## An instrument in words");
  ASSERT_NE(begin, std::string::npos);
  const std::string section = whole.substr(begin, whole.find("\n## ", begin + 1) - begin);
  DialogueWords words;
  for (const ScenarioKey& key : words.Keys()) {
    EXPECT_THAT(section, HasSubstr("`" + key.name + "`")) << key.Path();
    EXPECT_THAT(section, HasSubstr(key.table.empty() ? "`" : "`[" + key.table + "]`"));
  }
  for (const ReadyDialogue& ready : ReadyDialogues()) EXPECT_THAT(section, HasSubstr("`" + ready.name + "`"));
}

TEST(DialogueWords, UnitsOfOneKindAreToldInEachOther) {
  EXPECT_NEAR(ScaleToColumn("urad", "autocollimator_x_arcsec", "here"), 0.20626480624709636, 1e-16);
  EXPECT_DOUBLE_EQ(ScaleToColumn("mm", "bar_um", "here"), 1e3);
  EXPECT_EQ(ScaleToColumn("um", "bar_um", "here"), 1.0);
  EXPECT_EQ(ScaleToColumn("", "bar_um", "here"), 1.0) << "the bench file's scale says what it is";
  EXPECT_THROW(ScaleToColumn("deg", "bar_um", "here"), InputError);
}

/// A bench file with a table of an instrument, which begins in line 11.
void ParseWithTable(const std::string& table, const std::string& folder) {
  const std::string file =
      "[adc]\nkind = \"iio\"\ndevice = \"d\"\nchannels = [\"a\", \"b\", \"c\", \"d\"]\n"
      "[target]\nkind = \"esp\"\naddress = \"tcp:a:1\"\n"
      "[reference]\nkind = \"esp\"\naddress = \"tcp:b:1\"\n";
  ParseBenchFile(file + table, "bench.toml", folder);
}

TEST(BenchFileWithDialogue, FindsAReadyOneAndAFileBesideTheBenchFile) {
  const TemporaryFolder folder;
  folder.Write("my.toml", kWhole);
  for (const char* dialogue : {"elcomat", "my.toml"})
    EXPECT_NO_THROW(ParseWithTable(
        "[autocollimator]\nkind = \"dialogue\"\naddress = \"serial:/dev/ttyUSB0:9600:7E2\"\ndialogue = \"" +
            std::string(dialogue) + "\"\n",
        folder.path()));
}

TEST(BenchFileWithDialogue, SaysWhichKeyIsWrongAndWhatWouldBeRight) {
  const std::string begin = "[autocollimator]\naddress = \"tcp:c:1\"\nkind = \"dialogue\"\n";
  ExpectRefused("bench.toml", [](const auto& table) { return MessageOf([&] { ParseWithTable(table, "/nowhere"); }); }, {
      {11, begin}, {14, begin + "dialogue = \"elcomatt\"\n"}, {14, begin + "dialogue = \"mine.toml\"\n"},
      {14, begin + "dialogue = \"heidenhain_nd287\"\n"},
      {15, begin + "dialogue = \"elcomat\"\nidentity = \"ELCOMAT\"\n"},
      {15, begin + "dialogue = \"elcomat\"\ntoken = \"abc\"\n"},
      {14, "[thermometer]\nkind = \"scpi\"\naddress = \"tcp:c:1\"\ndialogue = \"elcomat\"\n"},
  });
}

using test::KindOf;

/// A computer whose clocks are set by hand.
struct Computer {
  std::int64_t steady_ns = 5'000'000'000, utc_ns = 1'700'000'000'000'000'000;
  std::vector<std::string> notices;

  HostClock Clock(Duration elapsed) {
    return {elapsed, [this](const std::string& notice) { notices.push_back(notice); }, [this] { return steady_ns; },
            [this] { return utc_ns; }, [this](Duration duration) { Pass(duration); }};
  }
  void Pass(Duration duration) {
    steady_ns += duration.count();
    utc_ns += duration.count();
  }
};

TEST(HostClock, BeginsAtZeroOrBehindWhatHasElapsedAndIsNotMovedByTheWallClock) {
  Computer computer;
  const HostClock clock = computer.Clock(Duration(0));
  computer.utc_ns -= 3'600'000'000'000;
  EXPECT_EQ(clock.Now(), Time{});
  EXPECT_EQ(clock.UtcStep(), -std::chrono::hours(1));
  HostClock resumed = computer.Clock(std::chrono::minutes(7));
  resumed.Wait(std::chrono::seconds(3));
  EXPECT_EQ(resumed.Now(), Time(std::chrono::minutes(7) + std::chrono::seconds(3)));
}

TEST(HostClock, HearsAStopWhileItWaits) {
  Computer computer;
  HostClock clock = computer.Clock(Duration(0));
  clock.HearStop([&] { return clock.Now() > Time(std::chrono::seconds(1)); });
  EXPECT_EQ(KindOf([&] { clock.Wait(std::chrono::seconds(5)); }), FaultKind::kStopped);
  EXPECT_LT(clock.Now(), Time(std::chrono::milliseconds(1100)));
}

TEST(HostClock, TellsOnceOfEachStepOfTheWallClockAndNotOfItsSlewing) {
  Computer computer;
  HostClock clock = computer.Clock(Duration(0));
  computer.utc_ns += 400'000'000;
  clock.Wait(std::chrono::seconds(1));
  EXPECT_TRUE(computer.notices.empty());
  computer.utc_ns += 2'000'000'000;
  clock.Wait(std::chrono::seconds(1));
  clock.Wait(std::chrono::seconds(1));
  ASSERT_EQ(computer.notices.size(), 1u);
  EXPECT_THAT(computer.notices[0], HasSubstr("+2.400 s"));
}

TEST(HostClock, OfThisComputerPassesAtLeastWhatItWaits) {
  HostClock clock(Duration(0), [](const std::string&) {});
  const Time before = clock.Now();
  clock.Wait(std::chrono::milliseconds(20));
  EXPECT_GE(clock.Now() - before, std::chrono::milliseconds(20));
}

TEST(OperatorDevices, SayWhatToDoAndWaitForEnter) {
  std::istringstream in("\n\n");
  std::ostringstream out;
  ConsoleFixture fixture(Operator(in, out));
  fixture.Mount(2, 30.0 * units::deg, -10.0 * units::deg);
  EXPECT_KEPT(out.str());
  EXPECT_EQ(in.tellg(), 1);  // one Enter, not both
  std::istringstream enter("\n");
  std::ostringstream angles;
  ConsoleGoniometer(Operator(enter, angles)).MoveTo(-300.0 * units::arcsec, 50.0 * units::arcsec);
  EXPECT_KEPT(angles.str());
}

TEST(OperatorDevices, EndTheRunWhereNobodyIsAndWhereSomebodySaysStop) {
  for (const char* input : {"", "stop\n"}) {
    std::istringstream in(input);
    std::ostringstream out;
    ConsoleFixture fixture(Operator(in, out));
    EXPECT_EQ(KindOf([&] { fixture.Mount(0, 0.0, 0.0); }), FaultKind::kStopped);
  }
}

TEST(AbsentDevices, SayWhatNeedsThem) {
  EXPECT_TRUE(std::isnan(NoThermometer().Read_degC()));
  EXPECT_KEPT(test::TextOf([] { NoAutocollimator().Read(); }));
  EXPECT_KEPT(test::TextOf([] { NoGoniometer().MoveTo(0.0, 0.0); }));
}

}  // namespace
}  // namespace twinbench::hw
