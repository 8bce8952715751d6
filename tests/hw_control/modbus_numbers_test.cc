#include <poll.h>
#include <pty.h>

#include <thread>

#include "hw_bridge/numbers/number_source.h"
#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

using testing::ElementsAre;

using Frame = std::vector<std::uint8_t>;

constexpr std::uint8_t kUnit = 3, kReadHolding = 3, kException = 0x80, kIllegalFunction = 1;

/// MODBUS over Serial Line V1.02, 6.2.2: CRC-16, reflected 0x8005, low byte first.
Frame Checked(Frame frame) {
  std::uint16_t crc = 0xffff;
  for (const std::uint8_t byte : frame) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint16_t>(crc & 1 ? crc >> 1 ^ 0xa001 : crc >> 1);
  }
  frame.push_back(static_cast<std::uint8_t>(crc & 0xff));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

/// The answer to a request for one holding register.
Frame OneRegister(std::uint8_t value) {
  return Checked({kUnit, kReadHolding, 2, 0, value});
}

/// A device on a serial line, made of what it says to each function that it is asked. Written on the operating
/// system's calls alone.
class SerialDevice {
 public:
  using Answer = std::function<Frame(std::uint8_t function)>;

  explicit SerialDevice(Answer answer) : answer_(std::move(answer)) {
    std::array<char, 128> name{};
    termios raw{};
    cfmakeraw(&raw);
    openpty(&far_, &near_, name.data(), &raw, nullptr);
    settings_.kind = "modbus";
    settings_.address = std::string("serial:") + name.data() + ":115200:8N1";
    settings_.unit = kUnit;
    settings_.items = {"holding 7 uint16"};
    settings_.timeout = std::chrono::milliseconds(300);
    thread_ = std::thread([this] { AnswerAll(); });
  }
  ~SerialDevice() {
    stop_ = true;
    thread_.join();
    close(far_);
    close(near_);
  }

  std::unique_ptr<NumberSource> Reader() const { return MakeNumberSource(settings_, "instrument_1", "test"); }

 private:
  void AnswerAll() {
    constexpr std::size_t kRequestBytes = 8;  // of all functions that are asked here
    Frame request;
    while (!stop_) {
      pollfd waiting{far_, POLLIN, 0};
      std::uint8_t byte = 0;
      if (poll(&waiting, 1, 10) <= 0 || read(far_, &byte, 1) != 1) continue;
      request.push_back(byte);
      if (request.size() < kRequestBytes) continue;
      const Frame answer = answer_(request[1]);
      EXPECT_EQ(write(far_, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
      request.clear();
    }
  }

  Answer answer_;
  NumberSettings settings_;
  int far_ = -1, near_ = -1;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class ModbusNumbers : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasNumberDriver("modbus")) GTEST_SKIP() << "this build has no libmodbus";
  }
};

/// Of a program that was killed while it waited: its answer comes when the next one already asks.
TEST_F(ModbusNumbers, TakeNoAnswerForTheirsThatAnEarlierProgramAskedFor) {
  bool is_first = true;
  SerialDevice device([&](std::uint8_t function) {
    Frame said = function == kReadHolding
                     ? OneRegister(22)
                     : Checked({kUnit, static_cast<std::uint8_t>(function | kException), kIllegalFunction});
    if (is_first) {
      const Frame late = OneRegister(11);
      said.insert(said.begin(), late.begin(), late.end());
    }
    is_first = false;
    return said;
  });
  const auto reader = device.Reader();
  EXPECT_THAT(reader->Read(), ElementsAre(22.0));
  EXPECT_THAT(reader->Read(), ElementsAre(22.0));
}

/// Its silence is as good a sign that nothing is left to come, as long as nothing has gone wrong with it.
TEST_F(ModbusNumbers, AreReadFromADeviceThatSaysNothingToWhatItDoesNotKnow) {
  SerialDevice device([](std::uint8_t function) { return function == kReadHolding ? OneRegister(22) : Frame{}; });
  EXPECT_THAT(device.Reader()->Read(), ElementsAre(22.0));
}

TEST_F(ModbusNumbers, AreNotReadAgainFromSuchADeviceOnceAnAnswerIsMissing) {
  int asked = 0;
  SerialDevice device(
      [&](std::uint8_t function) { return function == kReadHolding && ++asked != 2 ? OneRegister(22) : Frame{}; });
  const auto reader = device.Reader();
  EXPECT_THAT(reader->Read(), ElementsAre(22.0));
  EXPECT_THROW(reader->Read(), DeviceFault);
  EXPECT_THROW(reader->Read(), DeviceFault);
}

}  // namespace
}  // namespace twinbench::hw
