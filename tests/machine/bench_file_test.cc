#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hw_bridge/machine_file.h"
#include "tests/machine/benches.h"
#include "tests/support/machine_run.h"

namespace twinbench::test {
namespace {

using testing::AllOf;
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
  try {
    hw::ParseMachineFile(text, "bench.toml", kAxes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
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
  EXPECT_THAT(Refusal(OnLinuxCnc("[axis_a]\n", "[axis_a]\nletter = \"Z\"\n")),
              AllOf(HasSubstr("bench.toml:11"), HasSubstr("axis a has no letter"), HasSubstr("A, B or C")));
  EXPECT_THAT(Refusal(OnLinuxCnc("[axis_a]\n", "[axis_a]\njoint = 0\n")),
              HasSubstr("axes x and a have the same joint"));
  EXPECT_THAT(Refusal(OnLinuxCnc("stall_s", "watchdog = \"XW\"\nstall_s")), HasSubstr("machine.watchdog"));
  EXPECT_THAT(Refusal(OnLinuxCnc("stall_s", "enable_password = \"a b\"\nstall_s")), HasSubstr("one word"));
  EXPECT_THAT(Refusal(OnLinuxCnc() + "[clock]\nkind = \"scpi\"\naddress = \"tcp:twin:5025\"\n"),
              HasSubstr("goes in real time"));
  EXPECT_THAT(Refusal(Changed("[axis_a]\n", "[axis_a]\nletter = \"A\"\n")), HasSubstr("kind = \"linuxcnc\" only"));
  EXPECT_THAT(Refusal(Changed("stall_s", "connect_password = \"EMC\"\nstall_s")),
              HasSubstr("kind = \"linuxcnc\" only"));
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
  EXPECT_THAT(Refusal(WithNumbers(gateway)), HasSubstr("0 is read for 2 fields"));
  EXPECT_THAT(Refusal(WithNumbers(gateway + "read = \"input 4 int16\"\n")), HasSubstr("1 is read for 2 fields"));
  EXPECT_THAT(
      Refusal(WithNumbers(gateway + "read = \"input 4 int16, coil 3\"\n")),
      AllOf(HasSubstr("bench.toml:17"), HasSubstr("\"coil 3\" is no register"), HasSubstr("holding 100 int32")));
  EXPECT_THAT(Refusal(WithNumbers(gateway + "arm = \"INIT\"\nread = \"input 4 int16, input 5 int16\"\n")),
              HasSubstr("is read, not spoken to"));
  EXPECT_THAT(Refusal(WithNumbers("kind = \"comedi\"\nread = \"2 0, 2 1\"\n")),
              HasSubstr("instrument_1.device is missing"));
  EXPECT_THAT(Refusal(Changed("arm = \"\"", "unit = 3")), HasSubstr("beside an instrument that is spoken to"));
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
  EXPECT_THAT(Refusal(Changed("lower_mm = -150.0", "lower_mm = 250.0")),
              AllOf(HasSubstr("bench.toml:6"), HasSubstr("axis x")));
  EXPECT_THAT(Refusal(Changed("lower_mm", "lower_deg")), AllOf(HasSubstr("bench.toml:7"), HasSubstr("lower_mm")));
  EXPECT_THAT(Refusal(Changed("serial:/dev/ttyUSB0:19200", "ttyUSB0")), HasSubstr("tcp:HOST:PORT"));
  EXPECT_THAT(Refusal(Changed("scale = [1.0, 1000.0]", "scale = [1.0]")), HasSubstr("1 scales for 2 fields"));
  EXPECT_THAT(Refusal(Changed("[axis_a]", "[axis_b]")), AllOf(HasSubstr("bench.toml:10"), HasSubstr("axis_b")));
  EXPECT_THAT(Refusal(Changed("[instrument_1]\nkind = \"scpi\"", "[instrument_1]\nkind = \"none\"")),
              HasSubstr("instrument_1.address"));
  EXPECT_THAT(Refusal("kind = \"twin\"\n[machine]\nkind = \"esp\"\n"), HasSubstr("kind = \"hardware\""));
}

TEST(MachineFile, WhatServeWritesIsOne) {
  const ServedMachineTwin served(ShortCircles());
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}};
  const hw::MachineFile file = hw::ParseMachineFile(served.BenchFile(), "served.toml", axes);
  EXPECT_EQ(file.machine.kind, "esp");
  EXPECT_THAT(file.instruments[0].words.fields, testing::Contains("bar_um"));
}

/// Opens the served circles with a changed bench file; what it says if that is refused.
std::string OpeningRefusal(const std::string& from, const std::string& to) {
  const ServedMachineTwin served(ShortCircles());
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}};
  std::string text = served.BenchFile();
  text.replace(text.find(from), from.size(), to);
  try {
    hw::OpenMachineHardware(hw::ParseMachineFile(text, "served.toml", axes), axes,
                            InstrumentColumns(FormatOf(kCircularBench).columns));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(OpenMachine, RefusesWhatTheControllerDoesNotAllow) {
  EXPECT_THAT(OpeningRefusal("[instrument_1]", "[axis_x]\nlower_mm = -500.0\n[instrument_1]"),
              HasSubstr("the controller allows axis x"));
}

TEST(OpenMachine, RefusesAFieldThatTheBenchHasNot) {
  EXPECT_THAT(OpeningRefusal("\"bar_um\"", "\"bar_mm\""), HasSubstr("expected \"bar_um\""));
}

TEST(OpenMachine, RefusesAMachineOfOtherAxes) {
  const ServedMachineTwin served(ShortCircles());
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}, {"z"}};
  try {
    hw::OpenMachineHardware(hw::ParseMachineFile(served.BenchFile(), "served.toml", axes), axes,
                            InstrumentColumns(FormatOf(kCircularBench).columns));
    FAIL() << "two axes are not three";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kRefused);
    EXPECT_THAT(fault.what(), HasSubstr("1HN1,2,3"));
  }
}

TEST(OpenMachine, RefusesAnotherDevice) {
  EXPECT_THAT(OpeningRefusal("ESP301 twinbench ", "XPS-"), HasSubstr("expected what begins with \"XPS-\""));
}

/// The words of an instrument are the bench file's: the same samples, of one field, asked in other words.
TEST(DescribedInstrument, IsAskedInTheWordsOfTheBenchFile) {
  const ServedMachineTwin served(ShortCircles());
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}};
  std::string text = served.BenchFile();
  const auto begin = text.find("fields = "), end = text.find('\n', begin);
  text.replace(
      begin, end - begin,
      "fields = [\"ignored\", \"status\", \"bar_um\", \"encoder_deg\", \"ignored\", \"ignored\", "
      "\"temperature_degC\"]\nscale = [1.0, 1.0, 1000.0, 1.0, 1.0, 1.0, 1.0]\nread = \":INSTRUMENT:READ?\"");
  const auto opened = hw::OpenMachineHardware(hw::ParseMachineFile(text, "served.toml", axes), axes,
                                              InstrumentColumns(FormatOf(kCircularBench).columns));
  const auto plain = BenchOf(ShortCircles()).make_devices(ShortCircles());
  MachineBench bench = opened->Devices();
  bench.simulation->Restart();
  const Reading shown = bench.instruments.Read(), expected = plain->Devices().instruments.Read();
  const std::vector<ReadingColumn> columns = InstrumentColumns(FormatOf(kCircularBench).columns);
  EXPECT_DOUBLE_EQ(std::stod(columns[0].print(shown)), 1000.0 * std::stod(columns[0].print(expected)));
  EXPECT_EQ(columns[1].print(shown), columns[1].print(expected));
  EXPECT_EQ(shown.temperature_degC, expected.temperature_degC);
}

}  // namespace
}  // namespace twinbench::test
