#include "hw_bridge/ad/comedi_card.h"

#include <bit>
#include <cmath>
#include <optional>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

struct Reference {
  unsigned aref;
  int flag;  // of a subdevice that has it
};

Reference ReferenceOf(const std::string& name) {
  if (name == "common") return {AREF_COMMON, SDF_COMMON};
  if (name == "differential") return {AREF_DIFF, SDF_DIFF};
  return {AREF_GROUND, SDF_GROUND};
}

unsigned SubdeviceOf(comedi_t* card, const std::string& name, int asked) {
  const int found = asked >= 0 ? asked : comedi_find_subdevice_by_type(card, COMEDI_SUBD_AI, 0);
  if (found < 0) RefuseCard(name, "has no analogue inputs");
  const auto subdevice = static_cast<unsigned>(found);
  if (comedi_get_subdevice_type(card, subdevice) != COMEDI_SUBD_AI) {
    RefuseCard(name, "subdevice " + std::to_string(found) + " is no analogue input");
  }
  if ((comedi_get_subdevice_flags(card, subdevice) & SDF_CMD_READ) == 0) {
    RefuseCard(name, "its analogue inputs cannot run commands");
  }
  if (comedi_get_read_subdevice(card) != found && comedi_set_read_subdevice(card, subdevice) < 0) {
    RefuseCard(name, "subdevice " + std::to_string(found) + " cannot be read from as a stream");
  }
  return subdevice;
}

unsigned ChannelOf(comedi_t* card, const std::string& name, unsigned subdevice, const std::string& id) {
  const auto number = ParseWholeNumber(id);
  const int channels = comedi_get_n_channels(card, subdevice);
  if (!number || *number < 0 || *number >= channels) {
    RefuseCard(name,
               "has no channel \"" + id + "\"; its " + std::to_string(channels) + " channels are numbered from 0");
  }
  return static_cast<unsigned>(*number);
}

bool Covers(const comedi_range& range, double range_V) {
  const double most_V = range_V * (1.0 - 1e-9);
  return range.unit == UNIT_volt && range.min <= -most_V && range.max >= most_V;
}

/// Number of the smallest range that covers +-range_V.
unsigned RangeOf(comedi_t* card, const std::string& name, unsigned subdevice, unsigned channel, double range_V) {
  std::optional<unsigned> best;
  double best_V = 0.0;
  const int ranges = comedi_get_n_ranges(card, subdevice, channel);
  for (unsigned k = 0; static_cast<int>(k) < ranges; ++k) {
    const comedi_range* range = comedi_get_range(card, subdevice, channel, k);
    if (range == nullptr || !Covers(*range, range_V)) continue;
    if (best && range->max - range->min >= best_V) continue;
    best = k;
    best_V = range->max - range->min;
  }
  if (!best) RefuseCard(name, "has no range that covers ±" + std::to_string(range_V) + " V");
  return *best;
}

int BitsOf(comedi_t* card, const std::string& name, unsigned subdevice, unsigned channel) {
  const lsampl_t most = comedi_get_maxdata(card, subdevice, channel);
  const int bits = std::bit_width(most);
  if (bits < 2 || bits > 16 || !std::has_single_bit(std::uint64_t{most} + 1)) {
    RefuseCard(name, "its highest code is " + std::to_string(most) + ", not that of 2 to 16 bits");
  }
  return bits;
}

void AddChannel(comedi_t* card, const ScanChannel& asked, ComediInputs& inputs) {
  const unsigned channel = ChannelOf(card, inputs.name, inputs.subdevice, asked.id);
  const Reference reference = ReferenceOf(asked.reference);
  if ((comedi_get_subdevice_flags(card, inputs.subdevice) & reference.flag) == 0) {
    RefuseCard(inputs.name, "cannot measure against \"" + asked.reference + "\"");
  }
  const unsigned range = RangeOf(card, inputs.name, inputs.subdevice, channel, asked.range_V);
  const int bits = BitsOf(card, inputs.name, inputs.subdevice, channel);
  if (inputs.bits != 0 && inputs.bits != bits) RefuseCard(inputs.name, "its channels differ in resolution");
  inputs.bits = bits;
  inputs.chanlist.push_back(CR_PACK(channel, range, reference.aref));
  inputs.range.push_back(*comedi_get_range(card, inputs.subdevice, channel, range));
}

/// What a command that the card has accepted will do.
ComediTiming TimingOf(const comedi_cmd& command) {
  const double convert_ns = command.convert_src == TRIG_TIMER ? command.convert_arg : 0.0;
  const double scan_ns =
      command.scan_begin_src == TRIG_TIMER ? command.scan_begin_arg : convert_ns * command.chanlist_len;
  return {command, 1e9 / scan_ns, convert_ns * 1e-9};
}

}  // namespace

void ThrowComedi(FaultKind kind, const std::string& card, const std::string& doing) {
  const int error = comedi_errno();
  throw DeviceFault(kind, card, doing + ": " + comedi_strerror(error) + " (errno " + std::to_string(error) + ")");
}

ComediCard OpenComedi(const std::string& device) {
  ComediCard card(comedi_open(device.c_str()));
  if (!card) ThrowComedi(FaultKind::kDropped, device, "cannot be opened");
  return card;
}

ComediInputs FindInputs(comedi_t* card, const std::string& name, int subdevice, const ScanSpec& spec) {
  comedi_set_global_oor_behavior(COMEDI_OOR_NUMBER);
  ComediInputs inputs;
  inputs.name = name;
  inputs.subdevice = SubdeviceOf(card, name, subdevice);
  inputs.wide = (comedi_get_subdevice_flags(card, inputs.subdevice) & SDF_LSAMPL) != 0;
  for (const ScanChannel& channel : spec.channels) AddChannel(card, channel, inputs);
  return inputs;
}

ComediTiming SettleCommand(comedi_t* card, ComediInputs& inputs, double scan_rate_Hz, int scans) {
  comedi_cmd command{};
  const auto channels = static_cast<unsigned>(inputs.chanlist.size());
  const auto scan_ns = static_cast<unsigned>(std::lround(1e9 / scan_rate_Hz));
  if (comedi_get_cmd_generic_timed(card, inputs.subdevice, &command, channels, scan_ns) < 0) {
    ThrowComedi(FaultKind::kRefused, inputs.name,
                "cannot scan " + std::to_string(channels) + " channels by itself");
  }
  command.chanlist = inputs.chanlist.data();
  command.chanlist_len = command.scan_end_arg = channels;
  command.stop_src = TRIG_COUNT;
  command.stop_arg = static_cast<unsigned>(scans);
  // Evenly over the scan, as the multiplexer of the twin does: what is asked for, not what must be.
  if (command.convert_src == TRIG_TIMER) command.convert_arg = scan_ns / channels;
  if (command.scan_begin_src == TRIG_TIMER) command.scan_begin_arg = scan_ns;
  int stage = 0;
  constexpr int kTests = 6;  // each may pass one of its five stages and change arguments in the next
  for (int k = 0; k < kTests; ++k) {
    stage = comedi_command_test(card, &command);
    if (stage == 0) return TimingOf(command);
    if (stage < 0) ThrowComedi(FaultKind::kRefused, inputs.name, "testing a command");
  }
  RefuseCard(inputs.name,
             "does not come to accept a command; it stops at stage " + std::to_string(stage) + " of the test");
}

}  // namespace twinbench::hw
