#include "hw_bridge/open_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <iostream>

#include "hw_bridge/ad/ad_converter.h"
#include "hw_bridge/ad/negotiation.h"
#include "hw_bridge/bench_dialogue.h"
#include "hw_bridge/control/absent.h"
#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/esp_table.h"
#include "hw_bridge/control/operator_devices.h"
#include "hw_bridge/control/scpi_instruments.h"
#include "hw_bridge/control/scpi_table.h"
#include "hw_bridge/control/served_clock.h"
#include "hw_bridge/clock_notices.h"
#include "hw_bridge/conversations.h"
#include "hw_bridge/watched_adc.h"

namespace twinbench::hw {
namespace {

class OpenedBench : public OpenBench {
 public:
  OpenedBench(const BenchFile& file, const AdcSettings& adc, double noise_V, Duration elapsed, int run,
              const std::function<bool()>& stop_asked)
      : file_(file), hands_(std::cin, std::cerr), conversations_(stop_asked) {
    OpenClock(elapsed, run, stop_asked);  // first: a served twin's time stands still from here on
    target_ = OpenTable("target", file.target, file.target_limits);
    reference_ = OpenTable("reference", file.reference, file.reference_limits);
    OpenInstruments();
    adc_ = MakeAdConverter(file.adc, adc, *clock_, noise_V);
    if (file.clock.kind != "host") return;  // a served twin's time stands while its tables are asked
    watched_.emplace(*adc_, StandingTable{"target", *target_, file.target_limits.in_position_rad},
                     StandingTable{"reference", *reference_, file.reference_limits.in_position_rad});
  }

  RotaryBench Bench() override {
    AdConverter& adc = watched_ ? static_cast<AdConverter&>(*watched_) : *adc_;
    return {*clock_,      *target_,  *reference_,      adc, *autocollimator_, *thermometer_,
            *goniometer_, *fixture_, simulation_.get()};
  }

  std::string Identity() const override {
    std::string text = file_.name.empty() ? "" : file_.name + ": ";
    for (const std::string& identity : conversations_.Identities()) text += identity + "; ";
    return text + adc_->Identity();
  }

  std::vector<std::string> Configuration() const override { return DescribeChannels(adc_->Actual()); }

  std::optional<AgreedLimits> Limits() const override { return AgreedLimits{target_->limits(), reference_->limits()}; }

  void HearClock(std::function<void(const std::string&)> listener) override { clock_notices_.listener = std::move(listener); }

  std::vector<std::string> Notices() const override {
    std::vector<std::string> notices;
    const ClockWatch::Drift drift = adc_->ClockDrift();
    if (!std::isnan(drift.ppm)) {
      notices.push_back(
          fmt::format("the card's clock went {:+.2g} ppm against the bench's, standard uncertainty {:.2g}",
                      drift.ppm, drift.u_ppm));
    }
    const auto& mains_V = adc_->LargestMains_V();
    for (std::size_t k = 0; k < kChannels; ++k) {
      if (std::isnan(mains_V[k])) continue;
      notices.push_back(fmt::format("{}: mains hum of at most {:.3g} mV at {} Hz", kChannelNames[k],
                                    1e3 * mains_V[k], file_.adc.mains_Hz));
    }
    if (!watched_) return notices;
    for (const StandingTable& table : watched_->tables())
      notices.push_back(fmt::format("{}: at most {:+.3g} arcsec off its measuring position while blocks were taken", table.name,
                                    table.furthest_rad / units::arcsec));
    return notices;
  }

 private:
  void OpenClock(Duration elapsed, int run, const std::function<bool()>& stop_asked) {
    if (file_.clock.kind != "scpi") {
      clock_ = OpenHostClock(elapsed, clock_notices_, stop_asked);
      return;
    }
    auto clock = std::make_unique<ScpiClock>(own_conversation_.LineOf("clock", file_.clock));
    clock->Open();
    if (clock->IsTwin()) simulation_ = std::make_unique<ScpiSimulation>(*clock, run);
    clock_ = std::move(clock);
  }

  std::unique_ptr<ControlledTable> OpenTable(const std::string& name, const ControlSettings& s,
                                             const TableLimits& limits) {
    const bool clock_is_held = file_.clock.kind == "scpi";
    std::unique_ptr<ControlledTable> table;
    DeviceLine line = conversations_.LineOf(name, s);
    if (s.kind == "esp") {
      table =
          std::make_unique<EspTable>(std::move(line), s.axis, limits, CommandNumbers{s.decimals}, clock_is_held);
    } else {
      table = std::make_unique<ScpiTable>(std::move(line), s.axis, limits, CommandNumbers{s.decimals});
    }
    table->AgreeOnLimits();
    return table;
  }

  void OpenInstruments() {
    autocollimator_ =
        Open<Autocollimator, DescribedAutocollimator, NoAutocollimator>("autocollimator", file_.autocollimator);
    thermometer_ = Open<Thermometer, DescribedThermometer, NoThermometer>("thermometer", file_.thermometer);
    goniometer_ = Open<Goniometer, DescribedGoniometer, NoGoniometer>("goniometer", file_.goniometer);
    if (file_.goniometer.kind == "console") goniometer_ = std::make_unique<ConsoleGoniometer>(hands_);
    if (file_.fixture.kind == "console")
      fixture_ = std::make_unique<ConsoleFixture>(hands_);
    else
      fixture_ = std::make_unique<ScpiFixture>(conversations_.LineOf("fixture", file_.fixture));
  }

  template <class Device, class Described, class None>
  std::unique_ptr<Device> Open(const std::string& name, const ControlSettings& s) {
    if (HasConnection(s.kind)) return std::make_unique<Described>(conversations_.LineOf(name, s), s.words);
    return std::make_unique<None>();
  }

  BenchFile file_;
  Operator hands_;
  Conversations own_conversation_;  // the clock's
  Conversations conversations_;
  ClockNotices clock_notices_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<ControlledTable> target_, reference_;
  std::unique_ptr<AdFrontEnd> adc_;
  std::optional<WatchedAdc> watched_;  // none: on a served twin
  std::unique_ptr<Autocollimator> autocollimator_;
  std::unique_ptr<Thermometer> thermometer_;
  std::unique_ptr<Goniometer> goniometer_;
  std::unique_ptr<Fixture> fixture_;
};

}  // namespace

std::unique_ptr<OpenBench> OpenHardware(const BenchFile& file, const AdcSettings& adc, double noise_V,
                                        Duration elapsed, int run, const std::function<bool()>& stop_asked) {
  Require(file.kind == "hardware", "only a bench of hardware is opened");
  return std::make_unique<OpenedBench>(file, adc, noise_V, elapsed, run, stop_asked);
}

}  // namespace twinbench::hw
