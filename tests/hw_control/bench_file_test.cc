#include "hw_bridge/bench_file.h"

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"

namespace twinbench::hw {
namespace {

using testing::AllOf, testing::HasSubstr;

const ServedAddresses kAddresses = {"127.0.0.1", 30431, 5025, 5026, "/dev/pts/7"};

BenchFile Parse(const std::string& text) {
  return ParseBenchFile(text, "bench.toml", "/benches");
}

std::string ServedText() {
  return WriteServedBenchFile(kAddresses, "scpi");
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The served file with lines behind a table's head.
std::string With(const std::string& table, const std::string& lines) {
  return Replaced(ServedText(), "[" + table + "]\n", "[" + table + "]\n" + lines + "\n");
}

TEST(BenchFile, OfAServedTwinReadsBackAsItsAddresses) {
  const BenchFile file = Parse(ServedText());
  EXPECT_EQ(file.kind, "hardware");
  EXPECT_EQ(file.adc.kind, "iio");
  EXPECT_EQ(file.adc.uri, "ip:127.0.0.1:30431");
  EXPECT_EQ(file.adc.channels.size(), 4u);
  EXPECT_EQ(file.target.address, "tcp:127.0.0.1:5025");
  EXPECT_EQ(file.target.axis, 1);
  EXPECT_EQ(file.reference.axis, 2);
  for (const ControlSettings* device :
       {&file.autocollimator, &file.thermometer, &file.goniometer, &file.fixture, &file.clock}) {
    EXPECT_EQ(device->kind, "scpi");
    EXPECT_EQ(device->address, "tcp:127.0.0.1:5025");
  }
}

TEST(BenchFile, OfAServedTwinDrivesItsTablesAsAskedAndIsReadFromDisk) {
  for (const auto& [tables, address] :
       {std::pair{"esp", "esp tcp:127.0.0.1:5026"}, std::pair{"pty", "esp serial:/dev/pts/7"}}) {
    const BenchFile file = Parse(WriteServedBenchFile(kAddresses, tables));
    for (const ControlSettings* table : {&file.target, &file.reference})
      EXPECT_EQ(table->kind + " " + table->address, address);
  }
  const TemporaryFolder folder;
  const std::string path = folder.Write("bench.toml", ServedText());
  EXPECT_EQ(LoadBenchFile(path).path, path);
  EXPECT_THROW(LoadBenchFile(folder.File("none.toml")), InputError);
}

TEST(BenchFile, TakesUnitsFromItsKeys) {
  const BenchFile file =
      Parse(With("target", "lower_deg = -180\nupper_deg = 90\nin_position_arcsec = 0.5\nfollowing_deg = 2"));
  EXPECT_DOUBLE_EQ(file.target_limits.lower_rad, -units::kPi);
  EXPECT_DOUBLE_EQ(file.target_limits.upper_rad, units::kPi / 2);
  EXPECT_DOUBLE_EQ(file.target_limits.in_position_rad, 0.5 * units::kPi / 648000);
  EXPECT_DOUBLE_EQ(file.target_limits.following_rad, units::kPi / 90);
  EXPECT_TRUE(std::isinf(file.reference_limits.upper_rad));  // none given: none
}

TEST(BenchFile, AMinimalOneHasAHostClockAndAnOperatorAndOfATwinOrARecordNoDevices) {
  const BenchFile file = Parse(
      "[adc]\nkind = \"comedi\"\ndevice = \"/dev/comedi0\"\nchannels = [\"0\", \"1\", \"2\", \"3\"]\n"
      "calibration_file = \"card.calibration\"\n"
      "[target]\nkind = \"esp\"\naddress = \"serial:/dev/ttyUSB0\"\n"
      "[reference]\nkind = \"esp\"\naddress = \"serial:/dev/ttyUSB0\"\naxis = 2\n");
  EXPECT_EQ(file.clock.kind, "host");
  EXPECT_EQ(file.fixture.kind, "console");
  EXPECT_EQ(file.autocollimator.kind, "none");
  EXPECT_EQ(file.adc.calibration_file, "/benches/card.calibration");
  EXPECT_EQ(Parse("kind = \"twin\"").kind, "twin");
  EXPECT_EQ(Parse("kind = \"replay\"\nrecord = \"run1\"").record, "/benches/run1");
}

/// Where the first line with `marker` stands.
std::string LineOf(const std::string& text, const std::string& marker) {
  const auto at = text.find(marker);
  EXPECT_NE(at, std::string::npos) << marker;
  return "bench.toml:" + std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n')) +
         ":";
}

TEST(BenchFile, ThatIsWrongIsRefusedWithPlaceAndWhatWouldBeRight) {
  const std::string served = ServedText();
  const std::pair<std::string, std::string> files[] = {  // the text, and what stands in the line that is named
      {"kind = \"hardware\"", "kind"}, {"atempts = 2", "atempts"}, {"[traget]\naxis = 1", "[traget]"},
      {"kind = \"twin\"\n\n[adc]\nkind = \"iio\"", "[adc]"}, {"kind = \"replay\"", "kind"},
      {"record = \"x\"", "record"}, {"attempts = 0", "attempts"}, {With("target", "lower = 1"), "lower"},
      {With("target", "lower_rad = 1"), "lower_rad"}, {With("target", "adress = \"tcp:a:1\""), "adress"},
      {With("target", "lower_deg = 10\nupper_deg = 10"), "upper_deg"},
      {With("target", "in_position_arcsec = 0"), "in_position"}, {With("thermometer", "color = 1"), "color"},
      {With("adc", "timeout_s = \"2\""), "timeout_s"}, {With("adc", "subdevice = 1"), "subdevice"},
      {Replaced(served, "\"voltage1\"", "\"voltage0\""), "channels"},
      {Replaced(served, "kind = \"iio\"", "kind = \"nidaq\""), "nidaq"},
      {Replaced(served, "\"tcp:127.0.0.1:5025", "\"127.0.0.1:5025"), "\"127.0.0.1:5025"},
      {Replaced(served, "axis = 2", "axis = 1 # same"), "# same"},
      {Replaced(served, "[reference]\nkind = \"scpi\"\naddress =", "[reference]\nkind = \"esp\"\naddress  ="),
       "address  ="},
      {Replaced(served, "[clock]\nkind = \"scpi\"\naddress =", "[clock]\nkind = \"host\"\naddress  ="),
       "address  ="},
  };
  for (const auto& [text, line] : files) {
    const std::string refusal = MessageOf([text = text] { Parse(text); });
    EXPECT_THAT(refusal, HasSubstr(LineOf(text, line))) << text;
    EXPECT_KEPT(refusal);
  }
  EXPECT_THAT(MessageOf([] { Parse("kind = 3 4"); }), AllOf(HasSubstr("bench.toml:1:"), HasSubstr("TOML")));
}

TEST(BenchFile, EveryKeyStandsInTheDocumentation) {
  const std::string text = Contents(TWINBENCH_SOURCE_DIR "/docs/hardware.md");
  BenchFile file;
  for (const ScenarioKey& key : KeysOf(file)) EXPECT_THAT(text, HasSubstr("`" + key.Name() + "`")) << key.Path();
}

}  // namespace
}  // namespace twinbench::hw
