#include "tests/core/input_error.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/hw_serve/serving.h"

/// Programs that nobody here wrote, as they are installed. Those that are not are skipped.
namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::StartsWith;

bool Installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}
#define SKIP_WITHOUT(program) \
  if (!Installed(program)) GTEST_SKIP() << program << " is not installed"

/// What a shell command writes, errors included.
std::string Output(const std::string& command) {
  FILE* pipe = popen(("timeout 60 " + command + " 2>&1").c_str(), "r");
  std::string output;
  char bytes[65536];
  for (std::size_t n = 0; (n = fread(bytes, 1, sizeof bytes, pipe)) > 0;) output.append(bytes, n);
  pclose(pipe);
  return output;
}

std::string Uri(int port) { return "ip:127.0.0.1:" + std::to_string(port); }

/// What the running converter of a new twin delivers, taken here in blocks of 4 ms.
std::string RawStream(int scans) {
  sim::Twin twin{test::RotaryScenario()};
  std::string bytes;
  for (int first = 0; first < scans; first += 250) {
    const Acquisition block = twin.Bench().adc.Acquire(250, true);
    for (int s = 0; s < 250; ++s) {
      const std::int64_t stamp_ns = block.start.time_since_epoch().count() + 16000 * s;
      bytes.append(reinterpret_cast<const char*>(&block.raw[s * kChannels]), sizeof(std::int16_t) * kChannels);
      bytes.append(reinterpret_cast<const char*>(&stamp_ns), sizeof stamp_ns);
    }
  }
  bytes.resize(static_cast<std::size_t>(scans) * BufferClient::kScanBytes);
  return bytes;
}

/// The distribution's iiod, showing on its own port what the served twin shows.
class Reserving {
 public:
  explicit Reserving(int twin_port) : port_(ReservedPort().Port()) {
    const std::string command = "iiod -u " + Uri(twin_port) + " -p " + std::to_string(port_);
    process_ = std::stoi(Output("sh -c '" + command + " > /dev/null 2>&1 & echo $!'"));
    for (int attempt = 0; attempt < 100 && !Answers(); ++attempt) usleep(50'000);
  }
  ~Reserving() { kill(process_, SIGKILL); }
  int port() const { return port_; }

 private:
  bool Answers() const {
    try {
      return TcpClient(port_).Ask("VERSION") == "0.24.v0.24  ";
    } catch (const std::exception&) {
      return false;
    }
  }
  int port_;
  pid_t process_ = -1;
};

class RealClients : public testing::Test {
 protected:
  ServedTwin served{OnFreePorts(kAtOnce)};
  std::string iiod = Uri(served.at().iiod_port);
  std::string scpi_port = std::to_string(served.at().scpi_port);
};

TEST_F(RealClients, IioInfoFindsEveryDeviceAndNoError) {
  SKIP_WITHOUT("iio_info");
  const std::string text = Output("iio_info -u " + iiod);
  for (const char* device : {"psd-adc16 (buffer capable)", "rotary-target", "rotary-reference", "environment",
                             "Current trigger: trigger0(scan-clock)", "voltage3: psd_b_y", "timestamp:"}) {
    EXPECT_THAT(text, HasSubstr(device));
  }
  EXPECT_THAT(text, testing::Not(HasSubstr("ERROR")));
}

TEST_F(RealClients, IioAttrReadsWritesAndIsRefused) {
  SKIP_WITHOUT("iio_attr");
  EXPECT_EQ(Output("iio_attr -u " + iiod + " -d psd-adc16 sampling_frequency"), "62500\n");
  EXPECT_EQ(Output("iio_attr -u " + iiod + " -c psd-adc16 voltage0 scale"), "0.30517578125\n");
  Output("iio_attr -u " + iiod + " -d rotary-target angle_deg 7.5");
  EXPECT_EQ(Output("iio_attr -u " + iiod + " -d rotary-target commanded_deg"), "7.5\n");
  EXPECT_THAT(Output("iio_attr -u " + iiod + " -d rotary-target angle_deg 1e9"), HasSubstr("Invalid argument"));
  Output("iio_attr -u " + iiod + " -D psd-adc16 fault stuck,2");
  EXPECT_EQ(TcpClient(served.at().scpi_port).Ask("SIM:FAUL?"), "\"adc,stuck,2\"");
}

TEST_F(RealClients, IioReaddevGetsTheBytesOfTheConverterAndTheChannelsThatItAsksFor) {
  SKIP_WITHOUT("iio_readdev");
  EXPECT_TRUE(Output("iio_readdev -u " + iiod + " -b 1024 -s 40960 psd-adc16") == RawStream(40960));
  ServedTwin another(OnFreePorts(kAtOnce));
  const std::string all = RawStream(1000), other = Uri(another.at().iiod_port);
  std::string wanted;
  for (std::size_t at = 0; at < all.size(); at += BufferClient::kScanBytes)
    wanted += all.substr(at + 2, 2) + all.substr(at + 6, 2);
  EXPECT_TRUE(Output("iio_readdev -u " + other + " -b 100 -s 1000 psd-adc16 voltage1 voltage3") == wanted);
}

TEST_F(RealClients, TheDistributionsIiodServesTheSameBytesOn) {
  SKIP_WITHOUT("iiod");
  SKIP_WITHOUT("iio_readdev");
  const Reserving through(served.at().iiod_port);
  EXPECT_TRUE(Output("iio_readdev -u " + Uri(through.port()) + " -b 1024 -s 40960 psd-adc16") == RawStream(40960));
}

/// Answers until the one to a VERSION that follows each command.
std::string Answers(TcpClient& client, const std::string& command) {
  client.Send(command + "VERSION\n");
  std::string answers;
  for (std::string line = client.Line(); !line.ends_with("0.24.v0.24  "); line = client.Line())
    answers += line + "\n";
  return answers;
}

// Not PRINT, to which iiod adds its own address.
TEST_F(RealClients, TheDistributionsIiodAnswersTheSameToTheSameCommands) {
  SKIP_WITHOUT("iiod");
  const Reserving through(served.at().iiod_port);
  TcpClient own(served.at().iiod_port), other(through.port());
  for (const Conversation& conversation : Conversations()) {
    if (!conversation.name.starts_with("Iiod.")) continue;
    for (const auto& [port, text, answers] : conversation.turns) {
      if (port != "iiod" || text == "VERSION") continue;
      EXPECT_EQ(Answers(own, text + "\n"), Answers(other, text + "\n")) << text;
    }
  }
}

TEST_F(RealClients, IioStresstestFindsNoFault) {
  SKIP_WITHOUT("iio_stresstest");
  const std::string text = Output("timeout -s INT 2 iio_stresstest -u " + iiod + " -t 1 psd-adc16");
  EXPECT_THAT(text.substr(0, 1000),
              testing::Not(testing::AnyOf(HasSubstr("ERROR"), HasSubstr("Unable"), HasSubstr("Usage"))));
  EXPECT_THAT(text, HasSubstr("over 1 s     :       0"));
  EXPECT_EQ(TcpClient(served.at().iiod_port).Ask("VERSION"), "0.24.v0.24  ");
}

TEST_F(RealClients, LxiAsksOverARawSocket) {
  SKIP_WITHOUT("lxi");
  const std::string ask = "lxi scpi -a 127.0.0.1 -r -p " + scpi_port + " ";
  EXPECT_THAT(Output(ask + "'*IDN?'"), StartsWith("twinbench,rotary-bench,"));
  EXPECT_EQ(Output(ask + "'ROT1:ANGL 3;SETT? 60;ANGL?'"), "1;3\n");
}

/// What a script of tests/data/clients prints.
std::string Python(const std::string& script, const std::string& resource) {
  return Output("/usr/bin/python3 -W ignore " TWINBENCH_TEST_DATA "/clients/" + script + " " + resource);
}
std::string Printed(const std::string& script) {
  return Contents(TWINBENCH_TEST_DATA "/clients/" + script + ".txt");
}
std::string Socket(int port) { return "TCPIP0::127.0.0.1::" + std::to_string(port) + "::SOCKET"; }

bool HasModule(const std::string& module) {
  return std::system(("/usr/bin/python3 -c 'import " + module + "' >/dev/null 2>&1").c_str()) == 0;
}

TEST_F(RealClients, PyvisaAsksOverARawSocket) {
  if (!HasModule("pyvisa_py")) GTEST_SKIP() << "pyvisa-py is not installed";
  EXPECT_EQ(Python("asks.py", Socket(served.at().scpi_port)), Printed("asks.py"));
}

TEST_F(RealClients, PyMeasuresDriverMovesTheTablesOverTcpAndOverASerialLine) {
  if (!HasModule("pymeasure")) GTEST_SKIP() << "PyMeasure is not installed";
  EXPECT_EQ(Python("moves.py", Socket(served.at().esp_port)), Printed("moves.py"));
  const ServedTwin another{OnFreePorts(kAtOnce)};
  EXPECT_EQ(Python("moves.py", "ASRL" + another.at().pty + "::INSTR"), Printed("moves.py"));
}

}  // namespace
}  // namespace twinbench::test
