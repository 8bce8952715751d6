#include "hw_bridge/ad/comedi_source.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <span>

#include "hw_bridge/ad/backoff.h"
#include "hw_bridge/ad/comedi_calibration.h"
#include "hw_bridge/ad/comedi_card.h"
#include "hw_bridge/ad/host_stamp.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

using Deadline = std::chrono::steady_clock::time_point;

class ComediSource : public AdSource {
 public:
  explicit ComediSource(const AdSettings& settings) : settings_(settings) {}

  Negotiated Configure(const ScanSpec& spec) override {
    asked_ = spec;
    card_.reset();
    negotiated_ = Open();
    return negotiated_;
  }

  AdBlock Take(int scans) override {
    try {
      if (!card_) Reopen();
      return TakeOpen(scans);
    } catch (const DeviceFault&) {
      Close();
      throw;
    }
  }

 private:
  Negotiated Open();
  Negotiated Ask();
  void Reopen();
  void Close();
  AdBlock TakeOpen(int scans);
  std::vector<std::byte> ReadBlock(std::size_t bytes, Deadline deadline) const;
  std::size_t ReadSome(std::span<std::byte> into) const;
  void AwaitData(Deadline deadline, std::size_t missing) const;
  std::vector<std::int16_t> CodesOf(const std::vector<std::byte>& bytes) const;
  std::string Light() const;

  AdSettings settings_;
  ScanSpec asked_;
  Negotiated negotiated_;
  Backoff backoff_;
  ComediCard card_;
  ComediInputs inputs_;
};

// --- opening ---

Negotiated ComediSource::Open() {
  backoff_.BeforeAttempt();
  card_ = OpenComedi(settings_.device);
  try {
    const Negotiated answer = Ask();
    backoff_.Succeeded();
    return answer;
  } catch (const DeviceFault&) {
    Close();
    throw;
  }
}

Negotiated ComediSource::Ask() {
  inputs_ = FindInputs(card_.get(), settings_.device, settings_.subdevice, asked_);
  const ComediTiming timing = SettleCommand(card_.get(), inputs_, asked_.scan_rate_Hz, 1);
  Negotiated n;
  n.actual = asked_;
  n.actual.scan_rate_Hz = timing.scan_rate_Hz;
  for (std::size_t k = 0; k < inputs_.range.size(); ++k) {
    n.actual.channels[k].range_V = 0.5 * (inputs_.range[k].max - inputs_.range[k].min);
    n.skew_s.push_back(static_cast<double>(k) * timing.skew_s);
  }
  n.bits = inputs_.bits;
  n.calibrated = !settings_.calibration_file.empty();
  n.calibration = n.calibrated ? ReadCalibration(card_.get(), inputs_, settings_.calibration_file)
                               : NominalCalibration(inputs_);
  n.identity = std::string(comedi_get_board_name(card_.get())) + ", driver " + comedi_get_driver_name(card_.get());
  const int version = comedi_get_version_code(card_.get());
  n.firmware = "comedi " + std::to_string(version >> 16 & 0xff) + "." + std::to_string(version >> 8 & 0xff) + "." +
               std::to_string(version & 0xff);
  return n;
}

/// The card that answers now must be the one that was configured.
void ComediSource::Reopen() {
  const Negotiated now = Open();
  if (now.identity == negotiated_.identity && now.actual.scan_rate_Hz == negotiated_.actual.scan_rate_Hz) return;
  throw DeviceFault(
      FaultKind::kIdentity, settings_.device,
      "was \"" + negotiated_.identity + "\", opened again it is \"" + now.identity + "\" or has another rate");
}

void ComediSource::Close() {
  if (card_) comedi_cancel(card_.get(), inputs_.subdevice);
  card_.reset();
}

// --- taking blocks ---

void ComediSource::AwaitData(Deadline deadline, std::size_t missing) const {
  using std::chrono::milliseconds;
  pollfd waiting{comedi_fileno(card_.get()), POLLIN, 0};
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now());
    const int ready = left > milliseconds(0) ? poll(&waiting, 1, static_cast<int>(left.count())) : 0;
    if (ready > 0) return;
    if (ready < 0 && errno == EINTR) continue;
    throw DeviceFault(FaultKind::kTimeout, settings_.device,
                      "a block is not complete in time; " + std::to_string(missing) + " bytes are missing");
  }
}

std::size_t ComediSource::ReadSome(std::span<std::byte> into) const {
  const ssize_t n = read(comedi_fileno(card_.get()), into.data(), into.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return 0;
  if (n == 0) {
    throw DeviceFault(FaultKind::kDropped, settings_.device,
                      "the command ended with " + std::to_string(into.size()) + " bytes missing");
  }
  const int error = errno;
  throw DeviceFault(error == EPIPE ? FaultKind::kOverrun : FaultKind::kDropped, settings_.device,
                    "reading: " + std::string(std::strerror(error)) + " (errno " + std::to_string(error) + ")" +
                        (error == EPIPE ? ": the FIFO or the buffer of the driver ran full" : ""));
}

std::vector<std::byte> ComediSource::ReadBlock(std::size_t bytes, Deadline deadline) const {
  std::vector<std::byte> block(bytes);
  for (std::size_t got = 0; got < bytes;) {
    AwaitData(deadline, bytes - got);
    got += ReadSome(std::span(block).subspan(got));
  }
  return block;
}

/// Offset binary to two's complement.
std::vector<std::int16_t> ComediSource::CodesOf(const std::vector<std::byte>& bytes) const {
  const std::int64_t middle = std::int64_t{1} << (inputs_.bits - 1);
  const std::size_t width = inputs_.wide ? sizeof(lsampl_t) : sizeof(sampl_t);
  std::vector<std::int16_t> codes(bytes.size() / width);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    lsampl_t wide = 0;
    sampl_t narrow = 0;
    if (inputs_.wide) std::memcpy(&wide, &bytes[i * width], width);
    if (!inputs_.wide) std::memcpy(&narrow, &bytes[i * width], width);
    codes[i] = static_cast<std::int16_t>(std::int64_t{inputs_.wide ? wide : narrow} - middle);
  }
  return codes;
}

/// Lines 0 and 1: light on PSD A, B; line 2: both spots inside. A broken wire reads 0 and is no light.
std::string ComediSource::Light() const {
  if (settings_.light.empty()) return "ok";
  const auto subdevice = ParseWholeNumber(settings_.light);
  if (!subdevice || *subdevice < 0) {
    throw DeviceFault(FaultKind::kRefused, settings_.device, "light = \"" + settings_.light + "\" is no subdevice");
  }
  unsigned lines = 0;
  if (comedi_dio_bitfield2(card_.get(), static_cast<unsigned>(*subdevice), 0, &lines, 0) < 0) {
    ThrowComedi(FaultKind::kRefused, settings_.device, "reading the lines of subdevice " + settings_.light);
  }
  if ((lines & 3u) != 3u) return "no_light";
  return (lines & 4u) != 0 ? "ok" : "clipped_spot";
}

AdBlock ComediSource::TakeOpen(int scans) {
  ComediTiming timing = SettleCommand(card_.get(), inputs_, asked_.scan_rate_Hz, scans);
  const Duration length = FromSeconds(scans / timing.scan_rate_Hz);
  AdBlock block;
  block.stamp = HostStamp();
  const Deadline deadline = std::chrono::steady_clock::now() + length + asked_.deadline;
  if (comedi_command(card_.get(), &timing.command) < 0)
    ThrowComedi(FaultKind::kRefused, settings_.device, "starting");
  const std::size_t width = inputs_.wide ? sizeof(lsampl_t) : sizeof(sampl_t);
  block.raw = CodesOf(ReadBlock(static_cast<std::size_t>(scans) * inputs_.chanlist.size() * width, deadline));
  // The driver is busy until told that nobody wants more.
  if (comedi_cancel(card_.get(), inputs_.subdevice) < 0)
    ThrowComedi(FaultKind::kDropped, settings_.device, "stopping");
  block.light = Light();
  return block;
}

}  // namespace

std::unique_ptr<AdSource> MakeComediSource(const AdSettings& settings) {
  return std::make_unique<ComediSource>(settings);
}

}  // namespace twinbench::hw
