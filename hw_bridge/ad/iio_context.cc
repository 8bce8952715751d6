#include "hw_bridge/ad/iio_context.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <future>
#include <thread>
#include <utility>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

std::string TextOf(int error) {
  std::array<char, 256> text{};
  iio_strerror(error, text.data(), text.size());
  return std::string(text.data()) + " (errno " + std::to_string(error) + ")";
}

std::string NameOf(const iio_device* device) {
  const char* name = iio_device_get_name(device);
  return name != nullptr ? name : iio_device_get_id(device);
}

std::string Trimmed(std::string text) {
  text.erase(text.find_last_not_of(std::string("\0 \r\n\t", 5)) + 1);
  return text;
}

std::optional<double> NumberIn(const std::optional<std::string>& text, const std::string& device,
                               const std::string& attribute) {
  if (!text) return {};
  const std::optional<double> number = ParseNumber(*text);
  if (!number) {
    throw DeviceFault(FaultKind::kProtocol, device, attribute + " is \"" + *text + "\", which is no number");
  }
  return number;
}

/// libiio 0.24 sends without MSG_NOSIGNAL: writing to a server that has gone would end the program.
void OutliveClosedSockets() {
  struct sigaction now {};
  sigaction(SIGPIPE, nullptr, &now);
  if (now.sa_handler == SIG_DFL) std::signal(SIGPIPE, SIG_IGN);
}

/// What libiio answered, or nothing yet.
struct Opened {
  IioContext context;
  int error = 0;
};

}  // namespace

FaultKind FaultOf(int error) {
  switch (error) {
    case ETIMEDOUT:
    case EAGAIN:
      return FaultKind::kTimeout;
    case EOVERFLOW:
    case ENOBUFS:
    case ENOSPC:
      return FaultKind::kOverrun;
    case EPROTO:
    case EBADMSG:
      return FaultKind::kProtocol;
    case EINVAL:
    case EACCES:
    case EPERM:
    case EBUSY:
    case ENOSYS:
    case ENOENT:
    case ENOTSUP:
      return FaultKind::kRefused;
    default:  // EPIPE, ECONNRESET, ECONNREFUSED, ENODEV, EIO ...: nothing more will come
      return FaultKind::kDropped;
  }
}

void ThrowErrno(const std::string& device, const std::string& doing, int error) {
  throw DeviceFault(FaultOf(error), device, doing + ": " + TextOf(error));
}

IioContext OpenIioContext(const std::string& uri, Duration deadline) {
  OutliveClosedSockets();
  std::packaged_task<Opened()> open([uri] {
    Opened opened{IioContext(iio_create_context_from_uri(uri.c_str())), 0};
    if (!opened.context) opened.error = errno != 0 ? errno : EIO;
    return opened;
  });
  std::future<Opened> answer = open.get_future();
  // Not joined: there is no way to stop libiio here. If it comes late, the context goes with the unread answer.
  std::thread(std::move(open)).detach();
  if (answer.wait_for(deadline) != std::future_status::ready) {
    throw DeviceFault(FaultKind::kTimeout, uri, "no answer within " + std::to_string(ToSeconds(deadline)) + " s");
  }
  Opened opened = answer.get();
  if (!opened.context) ThrowErrno(uri, "cannot be opened", opened.error);
  return std::move(opened.context);
}

std::optional<std::string> DeviceText(const iio_device* device, const std::string& attribute) {
  if (iio_device_find_attr(device, attribute.c_str()) == nullptr) return {};
  std::array<char, 1024> text{};
  const ssize_t n = iio_device_attr_read(device, attribute.c_str(), text.data(), text.size() - 1);
  if (n < 0) ThrowErrno(NameOf(device), "reading " + attribute, static_cast<int>(-n));
  return Trimmed(std::string(text.data()));
}

std::optional<std::string> ChannelText(const iio_channel* channel, const std::string& attribute) {
  if (iio_channel_find_attr(channel, attribute.c_str()) == nullptr) return {};
  std::array<char, 1024> text{};
  const ssize_t n = iio_channel_attr_read(channel, attribute.c_str(), text.data(), text.size() - 1);
  if (n < 0) ThrowErrno(iio_channel_get_id(channel), "reading " + attribute, static_cast<int>(-n));
  return Trimmed(std::string(text.data()));
}

std::optional<std::string> ContextText(const iio_context* context, const std::string& attribute) {
  const char* text = iio_context_get_attr_value(context, attribute.c_str());
  if (text == nullptr) return {};
  return std::string(text);
}

std::optional<double> DeviceNumber(const iio_device* device, const std::string& attribute) {
  return NumberIn(DeviceText(device, attribute), NameOf(device), attribute);
}

std::optional<double> ChannelNumber(const iio_channel* channel, const std::string& attribute) {
  return NumberIn(ChannelText(channel, attribute), iio_channel_get_id(channel), attribute);
}

}  // namespace twinbench::hw
