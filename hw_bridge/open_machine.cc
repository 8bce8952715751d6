#include "hw_bridge/open_machine.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <iostream>

#include "hw_bridge/clock_notices.h"
#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/esp_machine.h"
#include "hw_bridge/control/instrument.h"
#include "hw_bridge/control/linuxcnc_machine.h"
#include "hw_bridge/control/operator_devices.h"
#include "hw_bridge/control/scpi_instruments.h"
#include "hw_bridge/control/served_clock.h"
#include "hw_bridge/conversations.h"
#include "hw_bridge/numbers/number_source.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

/// An instrument whose numbers are read in a card or behind a gateway. It latches nothing, and is read with every
/// look.
class NumberInstrument : public Instrument {
 public:
  /// @param names, scale, columns, where  As of Instrument, one a number of the source.
  NumberInstrument(std::unique_ptr<NumberSource> source, const std::vector<std::string>& names,
                   const std::vector<double>& scale, const std::vector<ReadingColumn>& columns,
                   const std::string& where)
      : Instrument(names, scale, columns, where), source_(std::move(source)) {}

  /// A float that is none, or not finite, is how a register says that nothing is shown.
  Reading Read() override {
    static const std::vector<std::string> nothing;
    const std::vector<double> numbers = source_->Read();
    Reading sample;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!std::isfinite(numbers[k])) {
        sample.status = ReadingStatus::kNoLight;
      } else if (!Put(fields()[k], PrintInUnit(numbers[k], 1.0), nothing, sample)) {
        throw DeviceFault(FaultKind::kProtocol, source_->Identity(), "shows what is no " + fields()[k].name);
      }
    }
    return sample;
  }

 private:
  std::unique_ptr<NumberSource> source_;
};

class OpenedMachine : public OpenMachine {
 public:
  OpenedMachine(const MachineFile& file, const std::vector<MachineAxis>& axes,
                const std::vector<ReadingColumn>& columns, Duration elapsed, int run,
                const std::function<bool()>& stop_asked)
      : name_(file.name),
        conversations_(stop_asked),
        clock_(OpenClock(file.clock, elapsed, run, stop_asked)),
        machine_(OpenAxes(file, axes)),
        instruments_(OpenInstruments(file, columns), *clock_),
        indexer_(OpenIndexer(file)),
        fixture_(OpenFixture(file.fixture)) {}

  MachineBench Devices() override {
    return {*clock_, *machine_, instruments_, *fixture_, simulation_.get(), indexer_.get()};
  }
  std::vector<AxisLimits> Limits() const override { return machine_->limits(); }

  void HearClock(std::function<void(const std::string&)> listener) override { clock_notices_.listener = std::move(listener); }

  std::string Identity() const override {
    std::string text;
    for (const std::string& identity : conversations_.Identities()) text += (text.empty() ? "" : "; ") + identity;
    text += cards_;
    return name_.empty() ? text : name_ + ": " + text;
  }

 private:
  /// First of all: a served twin's time stands still from here on.
  std::unique_ptr<Clock> OpenClock(const ControlSettings& settings, Duration elapsed, int run, const std::function<bool()>& stop_asked) {
    if (settings.kind != "scpi") {
      return OpenHostClock(elapsed, clock_notices_, stop_asked);
    }
    auto clock = std::make_unique<ScpiClock>(own_conversation_.LineOf("clock", settings));
    clock->Open();
    if (clock->IsTwin()) simulation_ = std::make_unique<ScpiSimulation>(*clock, run);
    return clock;
  }

  std::unique_ptr<ControlledMachine> OpenAxes(const MachineFile& file, const std::vector<MachineAxis>& axes) {
    const MachineManner manner = {.traverse_m_s = file.traverse_m_s,
                                  .polls_pass_time = file.clock.kind == "scpi",
                                  .numbers = {file.machine.decimals}};
    auto machine = Machine(file, axes, manner);
    machine->AgreeOnLimits();
    return machine;
  }

  std::unique_ptr<ControlledMachine> Machine(const MachineFile& file, const std::vector<MachineAxis>& axes,
                                             const MachineManner& manner) {
    DeviceLine line = conversations_.LineOf("machine", file.machine);
    if (file.machine.kind != "linuxcnc") return std::make_unique<EspMachine>(line, axes, file.axes, manner);
    std::vector<LinuxCncAxis> at;
    for (std::size_t k = 0; k < axes.size(); ++k) at.push_back({LetterOf(file, axes, k)[0], file.joints[k]});
    return std::make_unique<LinuxCncMachine>(line, axes, file.axes, at, file.machine.enable_password, manner);
  }

  std::vector<std::unique_ptr<Instrument>> OpenInstruments(const MachineFile& file,
                                                           const std::vector<ReadingColumn>& columns) {
    std::vector<std::unique_ptr<Instrument>> instruments;
    for (std::size_t k = 0; k < kMostInstruments; ++k) {
      const InstrumentSettings& s = file.instruments[k];
      if (s.connection.kind == "none") continue;
      const std::string name = fmt::format("instrument_{}", k + 1);
      instruments.push_back(s.IsNumbers() ? Numbers(s, name, columns) : Box(s, name, columns));
    }
    return instruments;
  }

  std::unique_ptr<Instrument> Box(const InstrumentSettings& s, const std::string& name,
                                  const std::vector<ReadingColumn>& columns) {
    const bool is_described = s.connection.kind == "dialogue";
    return std::make_unique<InstrumentBox>(
        conversations_.LineOf(name, s.connection),
        is_described ? WithDialogue(s.words, s.connection.words, columns) : s.words, columns);
  }

  std::unique_ptr<Instrument> Numbers(const InstrumentSettings& s, const std::string& name,
                                      const std::vector<ReadingColumn>& columns) {
    auto source = MakeNumberSource(s.Numbers(), name, s.words.where);
    source->Read();  // one that is not there is told now
    cards_ += "; " + source->Identity();
    return std::make_unique<NumberInstrument>(std::move(source), s.words.fields, s.words.scale, columns,
                                              s.words.where);
  }

  std::unique_ptr<Indexer> OpenIndexer(const MachineFile& file) {
    if (file.indexer.kind == "none") return nullptr;
    if (file.indexer.kind == "console") return std::make_unique<ConsoleIndexer>(Operator(std::cin, std::cerr));
    return std::make_unique<DescribedIndexer>(conversations_.LineOf("indexer", file.indexer), file.indexer.words,
                                              file.indexer_timeout_s);
  }

  std::unique_ptr<MachineFixture> OpenFixture(const ControlSettings& settings) {
    if (settings.kind == "console") return std::make_unique<ConsoleMachineFixture>(Operator(std::cin, std::cerr));
    return std::make_unique<ScpiMachineFixture>(conversations_.LineOf("fixture", settings));
  }

  std::string name_, cards_;
  Conversations own_conversation_;  // the clock's
  Conversations conversations_;
  std::unique_ptr<Simulation> simulation_;
  ClockNotices clock_notices_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<ControlledMachine> machine_;
  Instruments instruments_;
  std::unique_ptr<Indexer> indexer_;
  std::unique_ptr<MachineFixture> fixture_;
};

}  // namespace

std::unique_ptr<OpenMachine> OpenMachineHardware(const MachineFile& file, const std::vector<MachineAxis>& axes,
                                                 const std::vector<ReadingColumn>& columns, Duration elapsed,
                                                 int run, const std::function<bool()>& stop_asked) {
  Require(file.kind == "hardware", "only a bench of hardware is opened");
  return std::make_unique<OpenedMachine>(file, axes, columns, elapsed, run, stop_asked);
}

}  // namespace twinbench::hw
