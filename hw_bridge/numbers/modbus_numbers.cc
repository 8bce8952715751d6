#include "hw_bridge/numbers/number_drivers.h"

#include <fmt/format.h>
#include <modbus.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <numeric>
#include <sstream>

#include "hw_bridge/control/address.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr int kMostTogether = 125;  // registers in one answer

struct Register {
  bool is_holding = true;
  int at = 0;
  std::string type;
  bool low_first = false;

  int Words() const { return type.ends_with("32") ? 2 : 1; }
};

/// Registers that are read by one request.
struct Run {
  bool is_holding = true;
  int from = 0, words = 0;
  std::vector<std::size_t> items;
};

Register ParseRegister(const std::string& item, const std::string& where) {
  std::istringstream in(item);
  std::string table, at, type, order, more;
  in >> table >> at >> type >> order >> more;
  const auto number = ParseWholeNumber(at);
  const bool is_type =
      type == "int16" || type == "uint16" || type == "int32" || type == "uint32" || type == "float32";
  const bool is_one = (table == "holding" || table == "input") && number && *number >= 0 && *number <= 0xffff &&
                      is_type && (order.empty() || order == "low") && more.empty();
  if (!is_one) throw InputError(where, fmt::format("\"{}\" is no register", item), NumberItemForm("modbus"));
  return {table == "holding", static_cast<int>(*number), type, order == "low"};
}

std::vector<Run> RunsOf(const std::vector<Register>& registers) {
  std::vector<std::size_t> order(registers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair{registers[k].is_holding, registers[k].at}; });
  std::vector<Run> runs;
  for (const std::size_t k : order) {
    const Register& r = registers[k];
    const bool goes_on = !runs.empty() && runs.back().is_holding == r.is_holding &&
                         r.at <= runs.back().from + runs.back().words &&
                         r.at + r.Words() - runs.back().from <= kMostTogether;
    if (!goes_on) runs.push_back({r.is_holding, r.at, 0, {}});
    runs.back().words = std::max(runs.back().words, r.at + r.Words() - runs.back().from);
    runs.back().items.push_back(k);
  }
  return runs;
}

double NumberOf(const Register& r, const std::uint16_t* words) {
  if (r.type == "int16") return static_cast<std::int16_t>(words[0]);
  if (r.type == "uint16") return words[0];
  const std::uint32_t high = r.low_first ? words[1] : words[0], low = r.low_first ? words[0] : words[1],
                      bits = high << 16 | low;
  if (r.type == "float32") return std::bit_cast<float>(bits);
  return r.type == "int32" ? static_cast<double>(static_cast<std::int32_t>(bits)) : bits;
}

/// Which fault an errno of libmodbus stands for. Exceptions by which a device says that it is busy, or a gateway
/// that nobody answers, pass.
FaultKind KindOf(int error) {
  switch (error) {
    case ETIMEDOUT:
      return FaultKind::kTimeout;
    case EMBXILFUN:
    case EMBXILADD:
    case EMBXILVAL:
      return FaultKind::kRefused;
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBMDATA:
    case EMBBADSLAVE:
      return FaultKind::kProtocol;
    default:
      return FaultKind::kDropped;
  }
}

struct ModbusCloser {
  void operator()(modbus_t* line) const {
    modbus_close(line);
    modbus_free(line);
  }
};

class ModbusNumbers : public NumberSource {
 public:
  ModbusNumbers(const NumberSettings& settings, std::string device, const std::string& where)
      : settings_(settings), address_(ParseAddress(settings.address).value()), device_(std::move(device)) {
    for (const std::string& item : settings.items) registers_.push_back(ParseRegister(item, where));
    runs_ = RunsOf(registers_);
  }

  std::vector<double> Read() override {
    Open();
    std::vector<double> numbers(registers_.size());
    for (const Run& run : runs_) {
      const std::vector<std::uint16_t> words = Ask(run);
      for (const std::size_t k : run.items)
        numbers[k] = NumberOf(registers_[k], &words[static_cast<std::size_t>(registers_[k].at - run.from)]);
    }
    return numbers;
  }

  std::string Identity() override { return fmt::format("modbus unit {} at {}", settings_.unit, settings_.address); }

 private:
  /// Whose answers may still be under way: of a program before this one, which may have been killed, or of this
  /// one.
  enum class Doubt { kNone, kOfOthers, kOwn };

  bool IsSerial() const { return address_.kind == Address::Kind::kSerial; }

  modbus_t* NewLine() const {
    if (address_.kind == Address::Kind::kTcp)
      return modbus_new_tcp_pi(address_.place.c_str(), std::to_string(address_.number).c_str());
    return modbus_new_rtu(address_.place.c_str(), address_.number, address_.frame[1], address_.frame[0] - '0',
                          address_.frame[2] - '0');
  }

  void Open() {
    if (line_) return;
    line_.reset(NewLine());
    if (!line_) Fail("is no address that libmodbus takes");
    const auto timeout_us = std::chrono::duration_cast<std::chrono::microseconds>(settings_.timeout).count();
    modbus_set_response_timeout(line_.get(), static_cast<std::uint32_t>(timeout_us / 1000000),
                                static_cast<std::uint32_t>(timeout_us % 1000000));
    modbus_set_slave(line_.get(), settings_.unit);
    if (modbus_connect(line_.get()) != 0) Fail("cannot be reached");
    modbus_flush(line_.get());  // of what a serial line still holds
    if (doubt_ != Doubt::kNone) GetInStep();
  }

  /// Answers over a serial line have no number, so that one that comes too late is taken for that of the next
  /// request, and every answer behind it for that of another. A device answers in turn: once it has answered
  /// something that is not asked otherwise, be it by an exception, nothing is left to come. One that has never
  /// failed may also say nothing at all.
  void GetInStep() {
    constexpr std::uint8_t kReadCoils = 0x01, kIsException = 0x80;
    const std::uint8_t coil_0[] = {static_cast<std::uint8_t>(settings_.unit), kReadCoils, 0, 0, 0, 1};
    std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH> answer{};
    const bool is_sent = modbus_send_raw_request(line_.get(), coil_0, sizeof coil_0) > 0;
    do {
      const bool is_answered = is_sent && modbus_receive_confirmation(line_.get(), answer.data()) >= 2;
      if (is_sent && !is_answered && errno == ETIMEDOUT && doubt_ == Doubt::kOfOthers) break;
      if (!is_answered)
        Fail("has not answered since: coil 0 is asked before its registers are again, for late answers to pass");
    } while ((answer[1] & ~kIsException) != kReadCoils);
    doubt_ = Doubt::kNone;
  }

  std::vector<std::uint16_t> Ask(const Run& run) {
    std::vector<std::uint16_t> words(static_cast<std::size_t>(run.words));
    const auto read = run.is_holding ? modbus_read_registers : modbus_read_input_registers;
    if (read(line_.get(), run.from, run.words, words.data()) != run.words)
      Fail(fmt::format("{} {} {} were not read", run.words,
                       run.is_holding ? "holding registers from" : "input registers from", run.from));
    return words;
  }

  /// A late answer must never be taken for another: the line is closed.
  [[noreturn]] void Fail(const std::string& what) {
    const int error = errno;
    line_.reset();
    if (IsSerial()) doubt_ = Doubt::kOwn;
    throw DeviceFault(
        KindOf(error), device_,
        fmt::format("{}: {} ({}, unit {})", what, modbus_strerror(error), settings_.address, settings_.unit));
  }

  NumberSettings settings_;
  Address address_;
  std::string device_;
  std::vector<Register> registers_;
  std::vector<Run> runs_;
  std::unique_ptr<modbus_t, ModbusCloser> line_;
  Doubt doubt_ = IsSerial() ? Doubt::kOfOthers : Doubt::kNone;
};

}  // namespace

std::unique_ptr<NumberSource> MakeModbusNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where) {
  return std::make_unique<ModbusNumbers>(settings, device, where);
}

}  // namespace twinbench::hw
