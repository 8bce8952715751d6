#include "hw_bridge/bench_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const ServedAddresses kAddresses = {"127.0.0.1", 30431, 5025, 5026, "/dev/pts/7"};

BenchFile Parse(const std::string& text) {
  return ParseBenchFile(text, "bench.toml", "/benches");
}

/// What the refusal of a text says; empty if it is taken.
std::string Refusal(const std::string& text) {
  try {
    Parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
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

TEST(BenchFile, OfAServedTwinDrivesItsTablesAsAsked) {
  const BenchFile esp = Parse(WriteServedBenchFile(kAddresses, "esp"));
  EXPECT_EQ(esp.target.kind + " " + esp.target.address, "esp tcp:127.0.0.1:5026");
  const BenchFile pty = Parse(WriteServedBenchFile(kAddresses, "pty"));
  EXPECT_EQ(pty.reference.kind + " " + pty.reference.address, "esp serial:/dev/pts/7");
}

TEST(BenchFile, IsReadFromDisk) {
  const std::string path = testing::TempDir() + "bench_file_test." + std::to_string(::getpid()) + ".toml";
  std::ofstream(path) << ServedText();
  EXPECT_EQ(LoadBenchFile(path).path, path);
  std::filesystem::remove(path);
  EXPECT_THROW(LoadBenchFile(path), InputError);
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

TEST(BenchFile, AMinimalOneHasAHostClockAnOperatorAndNothingElse) {
  const BenchFile file = Parse(
      "[adc]\nkind = \"comedi\"\ndevice = \"/dev/comedi0\"\nchannels = [\"0\", \"1\", \"2\", \"3\"]\n"
      "calibration_file = \"card.calibration\"\n"
      "[target]\nkind = \"esp\"\naddress = \"serial:/dev/ttyUSB0\"\n"
      "[reference]\nkind = \"esp\"\naddress = \"serial:/dev/ttyUSB0\"\naxis = 2\n");
  EXPECT_EQ(file.clock.kind, "host");
  EXPECT_EQ(file.fixture.kind, "console");
  EXPECT_EQ(file.autocollimator.kind, "none");
  EXPECT_EQ(file.adc.calibration_file, "/benches/card.calibration");
}

TEST(BenchFile, OfATwinOrARecordNeedsNoDevices) {
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

struct Wrong {
  std::string text, line, what;  // which line is named, by something that stands there
};
void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.what;
}

class WrongBenchFile : public testing::TestWithParam<Wrong> {};
INSTANTIATE_TEST_SUITE_P(
    Texts, WrongBenchFile,
    testing::Values(
        Wrong{"kind = \"hardware\"", "kind", "there is no [adc]"}, Wrong{"kind = 3 4", "kind", "TOML"},
        Wrong{"atempts = 2", "atempts", "the nearest is attempts"},
        Wrong{"[traget]\naxis = 1", "[traget]", "the nearest is target"},
        Wrong{"kind = \"twin\"\n\n[adc]\nkind = \"iio\"", "[adc]", "adc in a bench of kind \"twin\""},
        Wrong{"kind = \"replay\"", "kind", "without a record"},
        Wrong{"record = \"x\"", "record", "a record in a bench of another kind"},
        Wrong{"attempts = 0", "attempts", "from 1 to 100"},
        Wrong{With("target", "lower = 1"), "lower", "target.lower_deg"},
        Wrong{With("target", "lower_rad = 1"), "lower_rad", "target.lower_deg"},
        Wrong{With("target", "adress = \"tcp:a:1\""), "adress", "target.address"},
        Wrong{With("target", "lower_deg = 10\nupper_deg = 10"), "upper_deg", "not above lower_deg"},
        Wrong{With("target", "in_position_arcsec = 0"), "in_position", "above 0"},
        Wrong{With("thermometer", "color = 1"), "color", "thermometer.color"},
        Wrong{With("adc", "timeout_s = \"2\""), "timeout_s", "adc.timeout_s is \"2\""},
        Wrong{With("adc", "subdevice = 1"), "subdevice", "adc.subdevice with kind = \"iio\""},
        Wrong{Replaced(ServedText(), "\"voltage1\"", "\"voltage0\""), "channels", "names 3 inputs"},
        Wrong{Replaced(ServedText(), "kind = \"iio\"", "kind = \"nidaq\""), "nidaq", "\"iio\" or \"comedi\""},
        Wrong{Replaced(ServedText(), "\"tcp:127.0.0.1:5025", "\"127.0.0.1:5025"), "\"127.0.0.1:5025",
              "tcp:HOST:PORT"},
        Wrong{Replaced(ServedText(), "axis = 2", "axis = 1 # same"), "# same", "the same axis"},
        Wrong{Replaced(ServedText(),
                       "[reference]\nkind = \"scpi\"\naddress =", "[reference]\nkind = \"esp\"\naddress  ="),
              "address  =", "reference shares the address of target"},
        Wrong{Replaced(ServedText(), "[clock]\nkind = \"scpi\"\naddress =", "[clock]\nkind = \"host\"\naddress  ="),
              "address  =", "clock.address with kind = \"host\""}));

TEST_P(WrongBenchFile, IsRefusedWithPlaceAndWhatWouldBeRight) {
  const Wrong& wrong = GetParam();
  EXPECT_THAT(Refusal(wrong.text), AllOf(HasSubstr(LineOf(wrong.text, wrong.line)), HasSubstr(wrong.what)))
      << wrong.text;
}

TEST(BenchFile, EveryKeyStandsInTheDocumentation) {
  std::ifstream in(std::string(TWINBENCH_SOURCE_DIR) + "/docs/hardware.md");
  std::ostringstream text;
  text << in.rdbuf();
  BenchFile file;
  for (const ScenarioKey& key : KeysOf(file))
    EXPECT_THAT(text.str(), HasSubstr("`" + key.Name() + "`")) << key.Path();
}

}  // namespace
}  // namespace twinbench::hw
