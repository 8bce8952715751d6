#include "hw_bridge/serve/scpi_text.h"
#include "tests/core/input_error.h"
#include "tests/hw_serve/serving.h"

namespace twinbench::test {

void PrintTo(const Conversation& conversation, std::ostream* out) { *out << conversation.name; }

namespace {

class OfAServedBench : public testing::TestWithParam<Conversation> {};

TEST_P(OfAServedBench, IsAsItIsWrittenDown) {
  hw::ServeOptions options = OnFreePorts(kAtOnce);
  if (GetParam().name.starts_with("Guarded")) options.token = kToken;
  const ServedTwin served(options);
  const std::map<std::string, int> ports = {
      {"scpi", served.at().scpi_port}, {"esp", served.at().esp_port}, {"iiod", served.at().iiod_port}};
  std::map<std::string, TcpClient> clients;
  for (const Said& said : GetParam().turns) {
    const int port = ports.at(said.port.substr(0, said.port.find('2')));
    TcpClient& client = clients.try_emplace(said.port, port).first->second;
    client.Send(said.text + "\n");
    for (const std::string& answer : said.answers) {
      if (answer.starts_with("~"))
        EXPECT_THAT(client.Line(), testing::MatchesRegex(answer.substr(1))) << said.text;
      else
        EXPECT_EQ(client.Line(), answer) << said.text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Conversation, OfAServedBench, testing::ValuesIn(Conversations()), [](const auto& one) {
  std::string name = one.param.name;
  std::ranges::replace(name, '.', '_');
  return name;
});

using testing::ElementsAre, testing::HasSubstr;

TEST(ServedBench, NamesItselfBySerialNumberOfItsScenario) {
  const ServedTwin served(OnFreePorts(kAtOnce));
  const std::string name = served.Ask("*IDN?");
  EXPECT_THAT(name, testing::MatchesRegex("twinbench,rotary-bench,[0-9A-F]{16},[0-9.]+"));
  TcpClient esp(served.at().esp_port);
  EXPECT_THAT(esp.Ask("VE?"), testing::AllOf(testing::StartsWith("ESP301"), HasSubstr(name.substr(23, 16))));
  EXPECT_THAT(esp.Ask("1ID?"), HasSubstr(name.substr(23, 16)));
  Scenario other = test::RotaryScenario();
  EXPECT_EQ(ServedTwin(OnFreePorts(kAtOnce), other).Ask("*IDN?"), name);
  other.seed = 2;
  EXPECT_NE(ServedTwin(OnFreePorts(kAtOnce), other).Ask("*IDN?"), name);
}

TEST(ScpiText, AKeywordIsItsShortOrItsLongFormInAnyCaseAndANumberBehindItIsOneIfItIsLeftOut) {
  for (const char* form : {"ANGL", "ANGLe", "angle", "Angl"}) EXPECT_EQ(hw::MatchKeyword("ANGLe", form), 0) << form;
  for (const char* form : {"ANG", "ANGLES", "ANGL1", ""})
    EXPECT_EQ(hw::MatchKeyword("ANGLe", form), std::nullopt) << form;
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "rot"), 1);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROTATION2"), 2);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROT2x"), std::nullopt);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROT99999999999999999999"), std::nullopt);
}

TEST(ScpiText, AUnitIsHeaderQuestionMarkAndParametersAndNoneWithoutAHeader) {
  const auto unit = hw::ParseScpiUnit("SIM:FAUL adc , \"a,b\",3");
  ASSERT_TRUE(unit);
  EXPECT_THAT(unit->header, ElementsAre("SIM", "FAUL"));
  EXPECT_THAT(unit->parameters, ElementsAre("adc", "\"a,b\"", "3"));
  EXPECT_FALSE(unit->query);
  EXPECT_TRUE(hw::ParseScpiUnit("*IDN?")->query);
  EXPECT_TRUE(hw::ParseScpiUnit(":ROT1:ANGL?")->rooted);
  for (const char* text : {"", "?", ":", "A::B", "ROT1:", "**IDN?", "R\x01T", "=", "ROT(1)"})
    EXPECT_FALSE(hw::ParseScpiUnit(text)) << text;
}

TEST(ScpiText, TheErrorQueueIsBoundedAndSaysWhenItOverflowed) {
  hw::ScpiErrorQueue queue;
  for (int k = 0; k < 1000; ++k) queue.Add({-113, ""});
  std::vector<std::string> entries;
  for (std::string entry = queue.Next(); entry != "0,\"No error\""; entry = queue.Next()) entries.push_back(entry);
  ASSERT_EQ(entries.size(), 20u);
  EXPECT_EQ(entries.front(), "-113,\"Undefined header\"");
  EXPECT_EQ(entries.back(), "-350,\"Queue overflow\"");
}

class Iiod : public testing::Test {
 protected:
  ServedTwin served{OnFreePorts(kAtOnce)};
  TcpClient iiod{served.at().iiod_port};

  std::string Value(const std::string& command) {
    const long long length = iiod.AskNumber(command);
    if (length < 0) return std::to_string(length);
    const std::string bytes = iiod.Bytes(static_cast<std::size_t>(length) + 1);
    EXPECT_EQ(bytes.back(), '\n');
    EXPECT_EQ(bytes[bytes.size() - 2], '\0');  // counted, as iiod does
    return bytes.substr(0, bytes.size() - 2);
  }
  long long Write(const std::string& what, const std::string& value) {
    iiod.Send("WRITE " + what + " " + std::to_string(value.size()) + "\r\n" + value);
    return std::stoll(iiod.Line());
  }
};

TEST_F(Iiod, TheContextIsValidByItsOwnDtd) {
  if (std::system("xmllint --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "xmllint is not installed";
  const long long length = iiod.AskNumber("PRINT");
  const std::string xml = iiod.Bytes(static_cast<std::size_t>(length) + 1);
  const TemporaryFolder folder;
  EXPECT_EQ(std::system(("xmllint --noout --valid '" + folder.Write("context.xml", xml) + "'").c_str()), 0);
  EXPECT_THAT(xml, testing::HasSubstr("version-git="));
}

TEST_F(Iiod, DevicesAnswerToIdAndName) {
  EXPECT_EQ(Value("READ iio:device0 serial"), Value("READ psd-adc16 serial"));
  EXPECT_EQ(Value("read psd-adc16 input voltage2 scale"),
            Value("READ iio:device0 INPUT psd_b_x in_voltage2_scale"));
}

TEST_F(Iiod, NumbersHaveAllTheirBits) {
  const Scenario scenario = test::RotaryScenario();
  EXPECT_EQ(ParseInUnit(Value("READ psd-adc16 INPUT voltage0 scale"), 1e-3),
            RotaryOf(scenario).adc.range_V / 32768.0);
  EXPECT_EQ(ParseNumber(Value("READ psd-adc16 range_V")), RotaryOf(scenario).adc.range_V);
  EXPECT_EQ(ParseNumber(Value("READ psd-adc16 sampling_frequency")), RotaryOf(scenario).adc.rate_Hz / kChannels);
}

TEST_F(Iiod, ATableMovesByItsAttribute) {
  EXPECT_EQ(Write("rotary-target angle_deg", std::string("12.5\0", 5)), 5);
  EXPECT_EQ(Value("READ rotary-target commanded_deg"), "12.5");
  EXPECT_EQ(Value("READ rotary-target in_position"), "0");
  EXPECT_EQ(Write("rotary-target angle_deg", "1e9"), -22);
}

TEST_F(Iiod, AllAttributesOfADeviceComeAsOnePaddedBlob) {
  const long long length = iiod.AskNumber("READ rotary-target");
  const std::string blob = iiod.Bytes(static_cast<std::size_t>(length));
  EXPECT_EQ(iiod.Bytes(1), "\n");
  // angle_deg "0", commanded_deg "0", in_position "1", moving "0": each 4 bytes of length, 2 of value, 2 empty.
  std::string expected;
  for (const char value : {'0', '0', '1', '0'})
    expected += std::string("\0\0\0\2", 4) + value + std::string(3, '\0');
  EXPECT_EQ(blob, expected);
}

TEST_F(Iiod, AScanIsItsChannelsAndTheAlignedTimeStamp) {
  // Bytes of a scan: 2 a channel; with the time stamp padded to 8 and 8 more.
  const std::pair<const char*, int> masks[] = {
      {"00000001", 2}, {"0000000f", 8}, {"00000010", 8}, {"00000011", 16}, {"0000001f", 16}};
  for (const auto& [mask, scan_bytes] : masks) {
    TcpClient client(served.at().iiod_port);
    ASSERT_EQ(client.Ask(std::string("OPEN psd-adc16 10 ") + mask), "0");
    const std::string bytes = std::to_string(10 * scan_bytes);
    EXPECT_EQ(client.Ask("READBUF psd-adc16 " + bytes), bytes) << mask;
    EXPECT_EQ(client.Line(), mask);
    client.Bytes(static_cast<std::size_t>(10 * scan_bytes));
    EXPECT_EQ(client.Ask("CLOSE psd-adc16"), "0");
  }
}

TEST_F(Iiod, ARequestThatEndsInsideAScanIsServedShort) {
  ASSERT_EQ(iiod.Ask("OPEN psd-adc16 10 0000001f"), "0");
  EXPECT_EQ(iiod.Ask("READBUF psd-adc16 167"), "160");
  iiod.Line();
  iiod.Bytes(160);
  EXPECT_EQ(iiod.Line(), "0");
  EXPECT_EQ(iiod.Ask("READBUF psd-adc16 15"), "-22");
}

TEST_F(Iiod, ExitClosesTheConnection) {
  iiod.Send("EXIT\r\n");
  EXPECT_TRUE(iiod.Ends());
}

}  // namespace
}  // namespace twinbench::test
