#include <gmock/gmock.h>

#include "hw_bridge/machine_file.h"
#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "tests/machine/benches.h"
#include "tests/support/kept_text.h"
#include "tests/support/machine_run.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr;

const std::vector<MachineAxis> kAxes = {{"x", false}, {"a", true}};

constexpr const char* kWhole = R"([machine]
kind = "esp"
address = "serial:/dev/ttyUSB0:19200"
traverse_mm_s = 30.0
stall_s = 2.0
[axis_x]
lower_mm = -150.0
upper_mm = 200.0
in_position_um = 5.0
[axis_a]
lower_deg = -10.0
upper_deg = 10.0
[instrument_1]
kind = "scpi"
address = "tcp:bar.lab:5025"
fields = ["ignored", "bar_um"]
scale = [1.0, 1000.0]
read = "MEAS:LENG?"
arm = ""
)";

std::string Refusal(const std::string& text) {
  return MessageOf([&] { hw::ParseMachineFile(text, "bench.toml", kAxes); });
}

/// At these lines of the bench file.
void ExpectRefused(const std::vector<Refused>& files) {
  twinbench::ExpectRefused("bench.toml", Refusal, files);
}

std::string Changed(const std::string& from, const std::string& to) {
  std::string text = kWhole;
  return text.replace(text.find(from), from.size(), to);
}

std::string OnLinuxCnc(const std::string& from = "", const std::string& to = "") {
  std::string text = Changed("kind = \"esp\"\naddress = \"serial:/dev/ttyUSB0:19200\"",
                             "kind = \"linuxcnc\"\naddress = \"tcp:mill.lab:5007\"");
  return from.empty() ? text : text.replace(text.find(from), from.size(), to);
}

TEST(MachineFile, NamesTheAxesOfALinuxCncMachine) {
  hw::MachineFile file = hw::ParseMachineFile(OnLinuxCnc(), "bench.toml", kAxes);
  EXPECT_EQ(hw::LetterOf(file, kAxes, 0), "X") << "its own name, where LinuxCNC has such an axis";
  EXPECT_EQ(file.joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(file.machine.enable_password, "EMCTOO");
  file =
      hw::ParseMachineFile(OnLinuxCnc("[axis_a]\n", "[axis_a]\nletter = \"c\"\njoint = 5\n"), "bench.toml", kAxes);
  EXPECT_EQ(hw::LetterOf(file, kAxes, 1), "C");
  EXPECT_EQ(file.joints[1], 5);
}

TEST(MachineFile, RefusesWhatALinuxCncMachineCannotBeOrOthersAreNot) {
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

TEST(MachineFile, IsReadInTheUnitsOfItsKeys) {
  const hw::MachineFile file = hw::ParseMachineFile(kWhole, "bench.toml", kAxes);
  EXPECT_DOUBLE_EQ(file.axes[0].lower, -0.15);
  EXPECT_DOUBLE_EQ(file.axes[0].in_position, 5e-6);
  EXPECT_DOUBLE_EQ(file.axes[1].upper, 10.0 * units::deg);
  EXPECT_EQ(file.axes[1].stall_s, 2.0) << "of the machine, and so of every axis";
  EXPECT_DOUBLE_EQ(file.traverse_m_s, 0.03);
  EXPECT_EQ(file.fixture.kind, "console");
}

TEST(MachineFile, WhatIsWrongIsToldWithItsLine) {
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
    try {
      Open(text, axes);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  const ServedMachineTwin served_{ShortCircles()};
};

TEST_F(OpenMachine, TakesWhatServeWrites) {
  const hw::MachineFile file = hw::ParseMachineFile(served_.BenchFile(), "served.toml", {{"x"}, {"y"}});
  EXPECT_EQ(file.machine.kind, "esp");
  EXPECT_THAT(file.instruments[0].words.fields, testing::Contains("bar_um"));
}

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
