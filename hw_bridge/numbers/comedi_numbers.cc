#include "hw_bridge/numbers/number_drivers.h"

#include <fmt/format.h>

#include <sstream>

#include "hw_bridge/ad/comedi_card.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

struct ComediItem {
  unsigned subdevice = 0, channel = 0;
  bool is_signed = false;
};

ComediItem ParseComediItem(const std::string& item, const std::string& where) {
  std::istringstream in(item);
  std::string subdevice, channel, sign, more;
  in >> subdevice >> channel >> sign >> more;
  const auto first = ParseWholeNumber(subdevice), second = ParseWholeNumber(channel);
  const bool is_one = first && second && *first >= 0 && *first < 256 && *second >= 0 && *second < 65536 &&
                      (sign.empty() || sign == "signed") && more.empty();
  if (!is_one) throw InputError(where, fmt::format("\"{}\" is no channel", item), NumberItemForm("comedi"));
  return {static_cast<unsigned>(*first), static_cast<unsigned>(*second), !sign.empty()};
}

class ComediNumbers : public NumberSource {
 public:
  ComediNumbers(const NumberSettings& settings, std::string device, const std::string& where)
      : settings_(settings), device_(std::move(device)) {
    for (const std::string& item : settings.items) items_.push_back(ParseComediItem(item, where));
  }

  std::vector<double> Read() override {
    Open();
    std::vector<double> numbers;
    for (const ComediItem& item : items_) numbers.push_back(NumberOf(item));
    return numbers;
  }

  std::string Identity() override {
    Open();
    const char* board = comedi_get_board_name(card_.get());
    return fmt::format("comedi {} at {}", board ? board : "card", settings_.device);
  }

 private:
  void Open() {
    if (!card_) card_ = OpenComedi(settings_.device);
  }

  double NumberOf(const ComediItem& item) {
    if (static_cast<int>(item.subdevice) >= comedi_get_n_subdevices(card_.get()) ||
        static_cast<int>(item.channel) >= comedi_get_n_channels(card_.get(), item.subdevice))
      Refuse(fmt::format("there is no channel {} of subdevice {}", item.channel, item.subdevice));
    lsampl_t code = 0;
    if (comedi_data_read(card_.get(), item.subdevice, item.channel, 0, AREF_GROUND, &code) < 0) {
      const std::string why = comedi_strerror(comedi_errno());
      card_.reset();
      throw DeviceFault(FaultKind::kDropped, device_,
                        fmt::format("channel {} of subdevice {} was not read: {} ({})", item.channel,
                                    item.subdevice, why, settings_.device));
    }
    const lsampl_t most = comedi_get_maxdata(card_.get(), item.subdevice, item.channel);
    if (comedi_get_subdevice_type(card_.get(), item.subdevice) == COMEDI_SUBD_AI)
      return comedi_to_phys(code, comedi_get_range(card_.get(), item.subdevice, item.channel, 0), most);
    const bool is_below_zero = item.is_signed && code > most / 2;
    return is_below_zero ? static_cast<double>(code) - (static_cast<double>(most) + 1.0)
                         : static_cast<double>(code);
  }

  [[noreturn]] void Refuse(const std::string& why) const {
    throw DeviceFault(FaultKind::kRefused, device_, fmt::format("{} ({})", why, settings_.device));
  }

  NumberSettings settings_;
  std::string device_;
  std::vector<ComediItem> items_;
  ComediCard card_;
};

}  // namespace

std::unique_ptr<NumberSource> MakeComediNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where) {
  return std::make_unique<ComediNumbers>(settings, device, where);
}

}  // namespace twinbench::hw
