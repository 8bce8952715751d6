#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/serve/conversation.h"
#include "hw_bridge/serve/iiod_attributes.h"
#include "hw_bridge/serve/iiod_buffer.h"
#include "hw_bridge/serve/iiod_delivery.h"

namespace twinbench::hw {

/// IIOD, the text protocol of version 0.24. Each connection may have one buffer open.
class IiodConversation : public Conversation {
 public:
  static constexpr std::size_t kLongestLine = 1024, kLongestValue = 4096;

  explicit IiodConversation(ServedBench& served) : served_(served), devices_(IiodDevices(served)) {}
  Step Next(InputBuffer& input) override;

 private:
  using Words = std::vector<std::string>;

  Step TakeCommand(InputBuffer& input);
  Step TakeValue(InputBuffer& input);
  Step Obey(const std::string& line);
  const IiodDevice* Device(const Words& words) const;

  Step Print();
  Step Read(const IiodDevice& device, const Words& words);
  Step Write(const IiodDevice* device, const Words& words);
  Step Open(const IiodDevice& device, const Words& words);
  Step ReadBuffer(const IiodDevice& device, const Words& words);
  Step Close(const IiodDevice& device);
  Step Set(const Words& words);
  Step GetTrigger(const IiodDevice& device);
  Step SetTrigger(const IiodDevice& device, const Words& words);
  Step Deliver();

  ServedBench& served_;
  std::vector<IiodDevice> devices_;
  bool awaits_value_ = false;  // of a WRITE
  IiodTarget target_;          // of it
  int value_error_ = 0;        // that it will get whatever it is
  std::size_t value_bytes_ = 0;
  std::unique_ptr<IiodBuffer> buffer_;
  std::optional<IiodDelivery> delivery_;  // of the READBUF that is being served
};

}  // namespace twinbench::hw
