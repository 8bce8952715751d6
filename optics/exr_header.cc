#include "optics/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace twinbench::optics {
namespace {

constexpr std::array<char, 4> kExrMagic = {0x76, 0x2f, 0x31, 0x01};
constexpr std::uint32_t kMultiPart = 0x1000;
constexpr std::int64_t kMostBytesAByte = 1032, kLeastPixel_B = 2;  // of a half
constexpr std::size_t kLongestName = 255;

class ExrHeader {
 public:
  explicit ExrHeader(const std::string& path) : in_(path, std::ios::binary) {
    std::error_code unknown;
    const auto size = std::filesystem::file_size(path, unknown);
    if (!in_ || unknown) throw std::runtime_error("it cannot be opened");
    bytes_ = static_cast<std::int64_t>(size);
    const std::int64_t holds = std::min<std::int64_t>(bytes_, kMostExrPixels) * kMostBytesAByte / kLeastPixel_B;
    pixels_left_ = std::min<std::int64_t>(holds, kMostExrPixels);
  }

  void Check() {
    if (Take<std::array<char, 4>>() != kExrMagic) throw std::runtime_error("it does not begin as OpenEXR files do");
    const bool has_parts = (Take<std::uint32_t>() & kMultiPart) != 0;
    do {
      while (CheckAttribute()) {
      }
    } while (has_parts && in_.peek() != 0);
  }

 private:
  template <class T>
  T Take() {
    T value;
    if (!in_.read(reinterpret_cast<char*>(&value), sizeof value)) throw std::runtime_error("it ends within its header");
    return value;
  }

  std::string TakeName() {
    std::string name;
    for (char c = Take<char>(); c != 0; c = Take<char>()) {
      if (name.size() == kLongestName) throw std::runtime_error("a name in its header has no end");
      name += c;
    }
    return name;
  }

  /// @return false at the end of a header.
  bool CheckAttribute() {
    const std::string name = TakeName();
    if (name.empty()) return false;
    TakeName();  // its type
    const auto size = Take<std::int32_t>();
    const std::int64_t begin = in_.tellg();
    if (size < 0 || begin + size > bytes_) throw std::runtime_error("its attribute " + name + " is longer than the file");
    if (name == "dataWindow") CheckWindow();
    if (name == "tiles") CheckTile();
    if (name == "channels" && size > kMostExrChannels_B) throw std::runtime_error("it has too many channels");
    in_.seekg(begin + size);
    return true;
  }

  /// Of the next picture: x and y of its first and its last pixel.
  void CheckWindow() {
    const auto window = Take<std::array<std::int32_t, 4>>();
    const std::int64_t width = std::int64_t{window[2]} - window[0] + 1, height = std::int64_t{window[3]} - window[1] + 1;
    if (width < 1 || height < 1) throw std::runtime_error("it has a picture without pixels");
    if (width > kMostExrSide || height > kMostExrSide || width * height > pixels_left_)
      throw std::runtime_error("its header speaks of " + std::to_string(width) + " x " + std::to_string(height) +
                               " pixels, which are more than the file can hold or than are read");
    pixels_left_ -= width * height;
  }

  void CheckTile() {
    const auto size = Take<std::array<std::uint32_t, 2>>();
    if (std::uint64_t{size[0]} * size[1] > std::uint64_t{kMostExrTile}) throw std::runtime_error("its tiles are too large");
  }

  std::ifstream in_;
  std::int64_t bytes_ = 0, pixels_left_ = 0;
};

}  // namespace

void RequirePlausibleExr(const std::string& path) {
  ExrHeader(path).Check();
}

}  // namespace twinbench::optics
