#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hw_bridge/serve/served_bench.h"

/// The bench as an IIO context: devices, channels and attributes as data.
namespace twinbench::hw {

struct IiodAttribute {
  std::string name;
  std::function<std::string()> read;
  std::function<bool(const std::string&)> write = nullptr;  // false: not a value that it takes. None: read-only
  std::string filename = {};                                // of channels
};
using IiodAttributes = std::vector<IiodAttribute>;

struct IiodChannel {
  std::string id, name;
  IiodAttributes attributes = {};
  int scan_index = -1;  // -1: not in a buffer
  std::string format = {};
};

struct IiodDevice {
  std::string id, name;
  IiodAttributes attributes = {}, debug = {}, buffer = {};
  std::vector<IiodChannel> channels = {};
  bool has_buffer = false;

  bool Is(std::string_view id_or_name) const { return id == id_or_name || name == id_or_name; }
};

inline constexpr int kTimestampIndex = kChannels;

/// @param served  Outlives the result.
std::vector<IiodDevice> IiodDevices(ServedBench& served);

/// The context as the XML that libiio's clients parse, with its DTD.
std::string IiodXml(const std::vector<IiodDevice>& devices, const std::string& serial);

}  // namespace twinbench::hw
