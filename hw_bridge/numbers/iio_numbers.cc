#include "hw_bridge/numbers/number_drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "hw_bridge/ad/iio_context.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

struct IioItem {
  std::string channel, attribute;  // without a channel: of the device
};

IioItem ParseIioItem(const std::string& item, const std::string& where) {
  std::istringstream in(item);
  std::string first, second, more;
  in >> first >> second >> more;
  if (first.empty() || !more.empty())
    throw InputError(where, fmt::format("\"{}\" is no attribute", item), NumberItemForm("iio"));
  return second.empty() ? IioItem{"", first} : IioItem{first, second};
}

class IioNumbers : public NumberSource {
 public:
  IioNumbers(const NumberSettings& settings, std::string device, const std::string& where)
      : settings_(settings), device_(std::move(device)) {
    for (const std::string& item : settings.items) items_.push_back(ParseIioItem(item, where));
  }

  std::vector<double> Read() override {
    Open();
    try {
      std::vector<double> numbers;
      for (const IioItem& item : items_) numbers.push_back(NumberOf(item));
      return numbers;
    } catch (const DeviceFault&) {
      context_.reset();
      throw;
    }
  }

  std::string Identity() override { return fmt::format("iio {} at {}", settings_.device, settings_.uri); }

 private:
  void Open() {
    if (context_) return;
    IioContext context = OpenIioContext(settings_.uri, settings_.timeout);
    found_ = iio_context_find_device(context.get(), settings_.device.c_str());
    if (!found_)
      throw DeviceFault(FaultKind::kRefused, device_,
                        fmt::format("there is no device \"{}\" at {}", settings_.device, settings_.uri));
    const auto timeout_ms = std::chrono::duration_cast<std::chrono::milliseconds>(settings_.timeout).count();
    iio_context_set_timeout(context.get(), static_cast<unsigned>(std::max<long>(1, timeout_ms)));
    context_ = std::move(context);
  }

  double NumberOf(const IioItem& item) const {
    std::optional<double> number;
    if (item.channel.empty()) {
      number = DeviceNumber(found_, item.attribute);
    } else {
      const iio_channel* channel = iio_device_find_channel(found_, item.channel.c_str(), false);
      if (channel) number = ChannelNumber(channel, item.attribute);
    }
    if (!number)
      throw DeviceFault(FaultKind::kRefused, device_,
                        fmt::format("{} has no \"{}{}{}\"", settings_.device, item.channel,
                                    item.channel.empty() ? "" : " ", item.attribute));
    return *number;
  }

  NumberSettings settings_;
  std::string device_;
  std::vector<IioItem> items_;
  IioContext context_;
  iio_device* found_ = nullptr;
};

}  // namespace

std::unique_ptr<NumberSource> MakeIioNumbers(const NumberSettings& settings, const std::string& device,
                                             const std::string& where) {
  return std::make_unique<IioNumbers>(settings, device, where);
}

}  // namespace twinbench::hw
