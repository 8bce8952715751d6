#include "tests/support/comedi_device/card.h"

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cmath>
#include <cstring>
#include <utility>

namespace twinbench::test {
namespace {

constexpr unsigned kSubdevices = 3, kAnalogue = 0, kDigital = 1, kCounter = 2;
constexpr unsigned kCounterBits = 24;
constexpr std::array<unsigned, 2> kCounts = {1234567, (1u << kCounterBits) - 42};  // the second has gone below zero
constexpr unsigned kWanted = 1;  // of the ranges below; the samples are of this one
constexpr unsigned kRanges = 3;

/// Twice the range, the range, and half of it from 0 up.
std::array<comedi_krange, kRanges> RangesOf(double range_V) {
  const int range_uV = static_cast<int>(std::lround(range_V * 1e6));
  return {{{-2 * range_uV, 2 * range_uV, UNIT_volt}, {-range_uV, range_uV, UNIT_volt}, {0, range_uV, UNIT_volt}}};
}

bool Mask(unsigned& source, unsigned supported) { return (source &= supported) != 0; }

bool Set(unsigned& argument, unsigned value) { return std::exchange(argument, value) == value; }

bool AtLeast(unsigned& argument, unsigned least) {
  if (argument >= least) return true;
  argument = least;
  return false;
}

/// Stage 1: sources that the card has.
bool HasSources(comedi_cmd& c) {
  const comedi_cmd asked = c;
  bool good = Mask(c.start_src, TRIG_NOW);
  good = Mask(c.scan_begin_src, TRIG_FOLLOW) && good;
  good = Mask(c.convert_src, TRIG_TIMER) && good;
  good = Mask(c.scan_end_src, TRIG_COUNT) && good;
  good = Mask(c.stop_src, TRIG_COUNT | TRIG_NONE) && good;
  return good && asked.start_src == c.start_src && asked.scan_begin_src == c.scan_begin_src &&
         asked.convert_src == c.convert_src && asked.scan_end_src == c.scan_end_src && asked.stop_src == c.stop_src;
}

/// Stage 3: arguments within bounds.
bool HasArguments(comedi_cmd& c, unsigned least_convert_ns) {
  bool good = Set(c.start_arg, 0);
  good = Set(c.scan_begin_arg, 0) && good;
  good = AtLeast(c.convert_arg, least_convert_ns) && good;
  good = Set(c.scan_end_arg, c.chanlist_len) && good;
  return (c.stop_src == TRIG_COUNT ? AtLeast(c.stop_arg, 1) : Set(c.stop_arg, 0)) && good;
}

/// Stage 5: the inputs from 0 on, all in the range that there are samples of.
bool HasChannels(const comedi_cmd& c) {
  if (c.chanlist == nullptr) return true;
  bool good = c.chanlist_len == kInputs;
  for (unsigned k = 0; k < c.chanlist_len; ++k)
    good = CR_CHAN(c.chanlist[k]) == k && CR_RANGE(c.chanlist[k]) == kWanted && good;
  return good;
}

}  // namespace

Card::Card(int descriptor) : descriptor_(descriptor), traits_(TwinOfThisProcess()->Traits()) {}

int Card::Control(unsigned long request, void* argument) {
  switch (request) {
    case COMEDI_DEVINFO:
      return DeviceInfo(*static_cast<comedi_devinfo*>(argument));
    case COMEDI_SUBDINFO:
      return SubdeviceInfo(static_cast<comedi_subdinfo*>(argument));
    case COMEDI_RANGEINFO:
      return RangeInfo(*static_cast<const comedi_rangeinfo*>(argument));
    case COMEDI_INSN:
      return Instruct(*static_cast<const comedi_insn*>(argument));
    case COMEDI_INSNLIST:
      return Instruct(*static_cast<const comedi_insnlist*>(argument));
    case COMEDI_CMDTEST:
      return Test(*static_cast<comedi_cmd*>(argument));
    case COMEDI_CMD:
      return Start(*static_cast<comedi_cmd*>(argument));
    case COMEDI_CANCEL:
      command_.reset();
      return 0;
    case COMEDI_BUFCONFIG: {
      auto& config = *static_cast<comedi_bufconfig*>(argument);
      config.size = config.maximum_size = 1 << 16;
      return 0;
    }
    case COMEDI_CHANINFO:  // nothing differs from channel to channel
    case COMEDI_LOCK:
    case COMEDI_UNLOCK:
    case COMEDI_POLL:
      return 0;
    default:
      return -ENOTTY;
  }
}

int Card::DeviceInfo(comedi_devinfo& info) const {
  info = {};
  info.version_code = 0x000764;  // 0.7.100
  info.n_subdevs = kSubdevices;
  std::strcpy(info.driver_name, "twinbench");
  std::strcpy(info.board_name, "preloaded-ai16");
  info.read_subdevice = kAnalogue;
  info.write_subdevice = -1;
  return 0;
}

int Card::SubdeviceInfo(comedi_subdinfo* info) const {
  info[kAnalogue] = {};
  info[kAnalogue].type = COMEDI_SUBD_AI;
  info[kAnalogue].n_chan = info[kAnalogue].len_chanlist = kInputs;
  info[kAnalogue].subd_flags = SDF_READABLE | SDF_GROUND | SDF_DIFF | SDF_CMD_READ | SDF_SOFT_CALIBRATED;
  info[kAnalogue].maxdata = (1u << traits_.bits) - 1;
  info[kAnalogue].range_type = kAnalogue << 24 | kRanges;
  info[kDigital] = {};
  info[kDigital].type = COMEDI_SUBD_DI;
  info[kDigital].n_chan = 3;
  info[kDigital].subd_flags = SDF_READABLE;
  info[kDigital].maxdata = 1;
  info[kDigital].range_type = kDigital << 24 | 1;
  info[kDigital].insn_bits_support = COMEDI_SUPPORTED;
  info[kCounter] = {};
  info[kCounter].type = COMEDI_SUBD_COUNTER;
  info[kCounter].n_chan = static_cast<unsigned>(kCounts.size());
  info[kCounter].subd_flags = SDF_READABLE;
  info[kCounter].maxdata = (1u << kCounterBits) - 1;
  info[kCounter].range_type = kCounter << 24 | 1;
  return 0;
}

int Card::RangeInfo(const comedi_rangeinfo& info) const {
  auto* ranges = static_cast<comedi_krange*>(info.range_ptr);
  if ((info.range_type >> 24 & 0xf) != kAnalogue) {
    ranges[0] = {0, 1000000, UNIT_none};
    return 0;
  }
  const auto analogue = RangesOf(traits_.range_V);
  std::memcpy(ranges, analogue.data(), sizeof analogue);
  return 0;
}

int Card::Instruct(const comedi_insn& instruction) {
  if (instruction.subdev == kDigital && instruction.insn == INSN_BITS && instruction.n == 2) {
    instruction.data[1] = TwinOfThisProcess()->Lines();
    return 2;
  }
  if (instruction.insn == INSN_GTOD &&
      instruction.n == 2) {  // with which libcomedi tries whether there are instructions
    instruction.data[0] = static_cast<lsampl_t>(std::time(nullptr));
    instruction.data[1] = 0;
    return 2;
  }
  const unsigned channel = CR_CHAN(instruction.chanspec);
  if (instruction.subdev == kCounter && instruction.insn == INSN_READ && channel < kCounts.size() &&
      instruction.n == 1) {
    instruction.data[0] = kCounts[channel];
    return 1;
  }
  if (instruction.subdev != kAnalogue || instruction.insn != INSN_READ || channel >= kInputs) return -EINVAL;
  unsigned n = 0;
  TwinOfThisProcess()->Acquire(static_cast<int>(instruction.n), [&](std::span<const std::int16_t, kInputs> codes) {
    instruction.data[n++] = static_cast<lsampl_t>(codes[channel] + (1 << (traits_.bits - 1)));
  });
  return static_cast<int>(n);
}

int Card::Instruct(const comedi_insnlist& list) {
  for (unsigned k = 0; k < list.n_insns; ++k) {
    if (const int result = Instruct(list.insns[k]); result < 0) return result;
  }
  return static_cast<int>(list.n_insns);
}

unsigned Card::ConvertPeriod_ns() const { return static_cast<unsigned>(std::lround(1e9 / traits_.conversions_Hz)); }

int Card::Test(comedi_cmd& command) const {
  if (command.subdev != kAnalogue) return -EINVAL;
  if (!HasSources(command)) return 1;
  if ((command.stop_src & (command.stop_src - 1)) != 0) return 2;
  if (!HasArguments(command, ConvertPeriod_ns())) return 3;
  if (!Set(command.convert_arg, ConvertPeriod_ns())) return 4;
  return HasChannels(command) ? 0 : 5;
}

int Card::Start(comedi_cmd& command) {
  if (command_ && !command_->failed()) return -EBUSY;
  if (Test(command) != 0) return -EINVAL;
  command_.reset();
  command_ =
      std::make_unique<Command>(TwinOfThisProcess(), descriptor_, static_cast<int>(command.stop_arg), traits_.bits);
  return 0;
}

Command::Command(std::unique_ptr<IiodTwin> source, int program_end, int scans, int bits)
    : source_(std::move(source)) {
  std::array<int, 2> pair{};
  socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data());
  dup2(pair[0], program_end);
  close(pair[0]);
  driver_end_ = pair[1];
  thread_ = std::thread([this, scans, bits] { Run(scans, bits); });
}

Command::~Command() {
  stopped_ = true;
  shutdown(driver_end_, SHUT_RDWR);
  source_->Abort();
  thread_.join();
  close(driver_end_);
}

void Command::Run(int scans, int bits) {
  const Ending ending =
      source_->Acquire(scans, [&](std::span<const std::int16_t, kInputs> codes) { Put(codes, bits); });
  if (stopped_) return;
  failed_ = ending == Ending::kFifoFull;
  shutdown(driver_end_, SHUT_WR);  // behind the last sample there is nothing to wait for
}

void Command::Put(std::span<const std::int16_t, kInputs> codes, int bits) {
  std::array<std::uint16_t, kInputs> samples;
  for (std::size_t k = 0; k < kInputs; ++k) samples[k] = static_cast<std::uint16_t>(codes[k] + (1 << (bits - 1)));
  send(driver_end_, samples.data(), sizeof samples, MSG_NOSIGNAL);  // fails where nobody reads any more
}

}  // namespace twinbench::test
