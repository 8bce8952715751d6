#include "tests/hw_serve/conversations.h"

namespace twinbench::test {

void PrintTo(const Conversation& conversation, std::ostream* out) {
  *out << conversation.name;
}

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

}  // namespace
}  // namespace twinbench::test
