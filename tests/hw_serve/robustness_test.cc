#include <malloc.h>

#include "hw_bridge/serve/iiod_buffer.h"
#include "tests/hw_serve/serving.h"

namespace twinbench::test {
namespace {

using std::chrono::milliseconds;

/// For so many clients; those who are slow are soon left.
hw::ServeOptions For(int clients, double speed, std::chrono::nanoseconds patience = hw::ServeOptions{}.idle_limit) {
  hw::ServeOptions options = OnFreePorts(speed);
  options.max_connections = clients;
  options.idle_limit = options.write_limit = patience;
  return options;
}

/// Answers others as if nothing had happened.
void ExpectAlive(const ServedTwin& served) {
  EXPECT_EQ(TcpClient(served.at().iiod_port).Ask("VERSION"), "0.24.v0.24  ");
  EXPECT_EQ(TcpClient(served.at().scpi_port).Ask("SYST:ERR?"), "0,\"No error\"");
  EXPECT_EQ(TcpClient(served.at().esp_port).Ask("TE?"), "0");
}

TEST(Robustness, ALineOrAPayloadThatIsTooLongIsAnErrorAndTheEnd) {
  ServedTwin served(OnFreePorts(kAtOnce));
  for (const int port : {served.at().iiod_port, served.at().scpi_port, served.at().esp_port}) {
    for (const char* end : {"", "\n"}) {
      TcpClient client(port);
      client.Send(std::string(8000, 'A') + end);
      EXPECT_TRUE(client.Ends());
    }
  }
  TcpClient scpi(served.at().scpi_port);
  scpi.Send(std::string(100'000, 'A'));
  EXPECT_EQ(scpi.Line(), "-363,\"Input buffer overrun\"");
  TcpClient iiod(served.at().iiod_port);
  EXPECT_EQ(iiod.Ask("WRITE psd-adc16 serial 500000000"), "-7");
  EXPECT_TRUE(iiod.Ends());
  ExpectAlive(served);
}

TEST(Robustness, AClientThatSaysNothingIsLeft) {
  ServedTwin served(For(4, kAtOnce, milliseconds(400)));
  TcpClient silent(served.at().scpi_port), half(served.at().iiod_port);
  half.Send("WRITE psd-adc16 serial 100\nonly a few");
  EXPECT_TRUE(silent.Ends());
  EXPECT_TRUE(half.Ends());
}

TEST(Robustness, AClientThatTakesNothingIsLeftAndDelaysNobody) {
  ServedTwin served(For(4, kAtOnce, milliseconds(400)));
  TcpClient slow(served.at().iiod_port, 4096);
  ASSERT_EQ(slow.Ask("OPEN psd-adc16 100000 0000001f"), "0");
  for (int k = 0; k < 200; ++k) slow.Send("READBUF psd-adc16 1600000\n");
  TcpClient scpi(served.at().scpi_port);
  const auto began = std::chrono::steady_clock::now();
  for (int k = 0; k < 100; ++k) scpi.Ask("ROT1:ANGL?");
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
  bool is_taken = true;
  for (int k = 0; k < 250 && is_taken; ++k) {
    std::this_thread::sleep_for(milliseconds(20));
    is_taken = slow.Send("\n");
  }
  EXPECT_FALSE(is_taken);
}

TEST(Robustness, WhenAllPlacesAreTakenOneThatHasNeverSpokenGivesWay) {
  ServedTwin served(For(3, kAtOnce));
  TcpClient first(served.at().scpi_port), second(served.at().scpi_port), third(served.at().scpi_port);
  for (TcpClient* client : {&first, &third}) client->Ask("*OPC?");
  TcpClient fourth(served.at().scpi_port);
  EXPECT_EQ(fourth.Ask("*OPC?"), "1");
  EXPECT_TRUE(second.Ends());
  TcpClient fifth(served.at().scpi_port);
  EXPECT_TRUE(fifth.Ends()) << "quiet clients were pushed out";
  for (TcpClient* client : {&first, &third, &fourth}) EXPECT_EQ(client->Ask("*OPC?"), "1");
}

TEST(Robustness, AnythingOfTheWebEndsTheConnectionBeforeItsBody) {
  ServedTwin served(OnFreePorts(kAtOnce));
  for (const int port : {served.at().scpi_port, served.at().esp_port, served.at().iiod_port}) {
    TcpClient browser(port);
    browser.Send("POST / HTTP/1.1\r\nHost: localhost\r\n\r\nROT1:ANGL 90\n1PA90\n");
    EXPECT_TRUE(browser.Ends());
  }
  EXPECT_EQ(TcpClient(served.at().scpi_port).Ask("ROT1:ANGL:COMM?"), "0");
}

TEST(Robustness, AClientThatIsBeingServedKeepsItsPlaceAndWhoWaitsForItGetsItWhenItLeaves) {
  ServedTwin served(For(1, 1.0));
  auto waiting = std::make_unique<TcpClient>(served.at().scpi_port);
  waiting->Send("ROT1:ANGL 45;SETT? 60\n");  // two seconds; nobody waits for a place longer than one
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_TRUE(TcpClient(served.at().scpi_port).Ends());
  EXPECT_EQ(waiting->Line(), "1");
  waiting->Send("ROT1:ANGL 145;SETT? 60\n");
  std::this_thread::sleep_for(milliseconds(100));
  TcpClient late(served.at().scpi_port);
  late.Send("*OPC\nSYST:ERR?\n");
  EXPECT_TRUE(late.Silent(milliseconds(200)));
  waiting.reset();
  EXPECT_EQ(late.Line(), "0,\"No error\"");
}

TEST(Robustness, AThousandClientsLeaveNothingBehind) {
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                         std::filesystem::directory_iterator{});
  };
  ServedTwin served(OnFreePorts(kAtOnce));
  ExpectAlive(served);
  std::this_thread::sleep_for(milliseconds(100));
  const auto before = open_files();
  for (int k = 0; k < 1000; ++k) TcpClient(served.at().esp_port).Send("1TP?");
  ExpectAlive(served);
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_LE(open_files(), before + 2);
}

TEST(Robustness, BlocksUnderWayHaveABoundTogether) {
  constexpr std::size_t kScans = hw::IiodBuffer::kMostScans;
  constexpr auto kMost = static_cast<int>(hw::IiodBuffer::kMostScansOfAll / kScans);
  ServedTwin served(OnFreePorts(1.0));  // a block of so many takes 17 s
  std::vector<std::unique_ptr<TcpClient>> clients;
  for (int k = 0; k <= kMost; ++k) {
    auto& client = *clients.emplace_back(std::make_unique<TcpClient>(served.at().iiod_port));
    ASSERT_EQ(client.Ask("OPEN psd-adc16 " + std::to_string(kScans) + " 0000001f"), "0");
    client.Send("READBUF psd-adc16 " + std::to_string(kScans * 16) + "\n");
    if (k < kMost) {
      EXPECT_TRUE(client.Silent(milliseconds(100))) << k;
    } else {
      EXPECT_EQ(client.Line(), std::to_string(-ENOMEM));
    }
  }
  clients.erase(clients.begin());
  std::this_thread::sleep_for(milliseconds(200));
  clients.back()->Send("READBUF psd-adc16 " + std::to_string(kScans * 16) + "\n");
  EXPECT_TRUE(clients.back()->Silent(milliseconds(100))) << "one that has left makes room";
}

TEST(Robustness, AServerThatNobodyReadsFromStaysSmall) {
  ServedTwin served(OnFreePorts(50.0));
  BufferClient adc(served.at().iiod_port, 1000);
  TcpClient scpi(served.at().scpi_port);
  const auto heap = [] { return static_cast<double>(mallinfo2().uordblks); };
  for (int k = 0; k < 20; ++k) scpi.Ask("CLOC:NOW?");
  std::this_thread::sleep_for(milliseconds(100));
  scpi.Ask("CLOC:NOW?");
  const double before = heap();
  for (int k = 0; k < 20; ++k) {  // half a minute of bench time: 15 MB of scans
    std::this_thread::sleep_for(milliseconds(30));
    scpi.Ask("CLOC:NOW?");
  }
  EXPECT_LT(heap() - before, 3e6);  // a second of scans with their stamps is 1 MB
}

}  // namespace
}  // namespace twinbench::test
