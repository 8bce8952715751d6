// Does the served twin keep up with the fastest card, for as long as it takes?
//
// A server process shows the twin at 250 000 scans/s of 4 channels in real time; a libiio client reads it and looks
// at the time stamp of every scan. Then the same without pacing: how fast it could go, beside the limits that the
// machine sets: bytes through the loopback, and blocks of the sampler without any network.
//
//   build/tests/perf/bench_bridge [seconds = 60]
#include <fmt/core.h>
#include <iio.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <thread>

#include "hw_bridge/serve/server.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/errors.h"

namespace twinbench {
namespace {

constexpr double kScanRate_Hz = 250e3;
constexpr std::size_t kScans = 25000;  // a buffer: 0.1 s
constexpr std::size_t kScan_B = 16;    // 4 channels of 2 bytes and the time stamp

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Scenario FastCard() {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.rate_Hz = kScanRate_Hz * kChannels;
  RotaryOf(scenario).amplifier.hum_V = 0.01;  // so that no signal is constant
  return scenario;
}

/// A server in a process of its own, told apart from the client by its memory.
class ServerProcess {
 public:
  explicit ServerProcess(double speed) {
    int ends[2];
    if (pipe(ends) != 0) throw BenchError("no pipe");
    id_ = fork();
    if (id_ == 0) ServeForever(speed, ends[1]);
    if (read(ends[0], &port_, sizeof port_) != sizeof port_) throw BenchError("the server did not start");
  }
  ~ServerProcess() {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  int port() const { return port_; }
  long Memory_kB() const {
    std::ifstream status("/proc/" + std::to_string(id_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmRSS:")) return std::atol(line.c_str() + 6);
    }
    return -1;
  }

 private:
  [[noreturn]] static void ServeForever(double speed, int tell) {
    hw::ServeOptions options;
    options.iiod_port = options.scpi_port = options.esp_port = 0;
    options.pty = false;
    options.speed = speed;
    const Scenario scenario = FastCard();
    sim::Twin twin(scenario);
    hw::Server server(twin.Bench(), scenario, RotaryOf(scenario).adc, options);
    const int port = server.Addresses().iiod_port;
    if (write(tell, &port, sizeof port) != sizeof port) std::_Exit(1);
    server.Run();
    std::_Exit(0);
  }

  pid_t id_ = 0;
  int port_ = 0;
};

/// A libiio buffer on all channels and the time stamp.
class Stream {
 public:
  explicit Stream(int port) {
    context_ = iio_create_context_from_uri(("ip:127.0.0.1:" + std::to_string(port)).c_str());
    if (!context_) throw BenchError("no context");
    iio_device* device = iio_context_find_device(context_, "psd-adc16");
    for (const char* name : {"voltage0", "voltage1", "voltage2", "voltage3", "timestamp"})
      iio_channel_enable(iio_device_find_channel(device, name, false));
    buffer_ = iio_device_create_buffer(device, kScans, false);
    if (!buffer_) throw BenchError("no buffer");
  }
  ~Stream() {
    iio_buffer_destroy(buffer_);
    iio_context_destroy(context_);
  }

  /// Reads a buffer. @return how many scans are missing in front of and inside it.
  std::int64_t Refill() {
    if (iio_buffer_refill(buffer_) != static_cast<ssize_t>(kScans * kScan_B)) throw BenchError("refill failed");
    const char* at = static_cast<const char*>(iio_buffer_start(buffer_));
    std::int64_t lost = 0;
    for (std::size_t k = 0; k < kScans; ++k) {
      std::int64_t stamp_ns;
      std::memcpy(&stamp_ns, at + k * kScan_B + 8, sizeof stamp_ns);
      if (last_ns_ >= 0) lost += (stamp_ns - last_ns_ + 2000) / 4000 - 1;
      last_ns_ = stamp_ns;
    }
    return lost;
  }

 private:
  iio_context* context_;
  iio_buffer* buffer_;
  std::int64_t last_ns_ = -1;
};

void StreamInRealTime(double seconds) {
  const ServerProcess server(1.0);
  Stream stream(server.port());
  std::int64_t scans = 0, lost = 0;
  stream.Refill();
  long after_a_tenth_kB = 0, largest_kB = 0;
  const double begin_s = Now_s();
  while (Now_s() - begin_s < seconds) {
    lost += stream.Refill();
    scans += kScans;
    largest_kB = std::max(largest_kB, server.Memory_kB());
    if (Now_s() - begin_s < 0.1 * seconds) after_a_tenth_kB = largest_kB;
  }
  const double took_s = Now_s() - begin_s;
  fmt::print("real time: {:.1f} s, {} scans of 4 channels, {:.0f} scans/s ({:.4f} of asked), {} lost\n", took_s,
             scans, static_cast<double>(scans) / took_s, static_cast<double>(scans) / took_s / kScanRate_Hz, lost);
  fmt::print("server memory: {} kB at most in the first tenth, {} kB at most in all, {} kB at last\n",
             after_a_tenth_kB, largest_kB, server.Memory_kB());
}

double UnpacedScansPerSecond(double seconds) {
  const ServerProcess server(std::numeric_limits<double>::infinity());
  Stream stream(server.port());
  std::int64_t scans = 0;
  const double begin_s = Now_s();
  while (Now_s() - begin_s < seconds) {
    stream.Refill();
    scans += kScans;
  }
  return static_cast<double>(scans) / (Now_s() - begin_s);
}

double SamplerScansPerSecond(double seconds) {
  const Scenario scenario = FastCard();
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  std::int64_t scans = 0;
  const double begin_s = Now_s();
  while (Now_s() - begin_s < seconds) scans += bench.adc.Acquire(kScans, true).n_samples;
  return static_cast<double>(scans) / (Now_s() - begin_s);
}

/// Bytes through a pair of sockets, as scans.
double LoopbackScansPerSecond(double seconds) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 0.0;
  std::jthread writer([&](std::stop_token stop) {
    const std::string block(kScans * kScan_B, 'x');
    while (!stop.stop_requested() && send(ends[0], block.data(), block.size(), MSG_NOSIGNAL) > 0) {
    }
  });
  std::string block(kScans * kScan_B, ' ');
  double bytes = 0.0;
  const double begin_s = Now_s();
  while (Now_s() - begin_s < seconds) bytes += static_cast<double>(read(ends[1], block.data(), block.size()));
  const double rate = bytes / kScan_B / (Now_s() - begin_s);
  writer.request_stop();
  close(ends[1]);
  return rate;
}

}  // namespace
}  // namespace twinbench

int main(int argc, char** argv) {
  using namespace twinbench;
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60.0;
  StreamInRealTime(seconds);
  const double unpaced = UnpacedScansPerSecond(3.0);
  const double sampler = SamplerScansPerSecond(2.0), loopback = LoopbackScansPerSecond(2.0);
  fmt::print(
      "unpaced: {:.2f} M scans/s = {:.1f} x asked, {:.2f} of the sampler alone ({:.2f} M), {:.2f} of a socket "
      "pair ({:.2f} M)\n",
      unpaced / 1e6, unpaced / kScanRate_Hz, unpaced / sampler, sampler / 1e6, unpaced / loopback, loopback / 1e6);
  return 0;
}
