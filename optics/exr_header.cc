#include "optics/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace twinbench::optics {
namespace {

constexpr std::array<char, 4> kExrMagic = {0x76, 0x2f, 0x31, 0x01};
constexpr std::uint32_t kMultiPart = 0x1000;
constexpr std::int64_t kMostBytesAByte = 1032, kLeastPixel_B = 2;  // of a half
constexpr std::size_t kLongestName = 255;

/// Types whose values the library reads by themselves, whatever size the header gives them.
struct ExrType {
  std::string_view name;
  int size_B;
};
constexpr std::array kFixedTypes = {
    ExrType{"box2f", 16},     ExrType{"box2i", 16},    ExrType{"chromaticities", 32}, ExrType{"compression", 1},
    ExrType{"deepImageState", 1}, ExrType{"double", 8}, ExrType{"envmap", 1},          ExrType{"float", 4},
    ExrType{"int", 4},        ExrType{"keycode", 28},  ExrType{"lineOrder", 1},       ExrType{"m33d", 72},
    ExrType{"m33f", 36},      ExrType{"m44d", 128},    ExrType{"m44f", 64},           ExrType{"rational", 8},
    ExrType{"tiledesc", 9},   ExrType{"timecode", 8},  ExrType{"v2d", 16},            ExrType{"v2f", 8},
    ExrType{"v2i", 8},        ExrType{"v3d", 24},      ExrType{"v3f", 12},            ExrType{"v3i", 12}};
constexpr std::int64_t kChannel_B = 16;  // behind its name

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
    const std::string type = TakeName();
    const auto size = Take<std::int32_t>();
    const std::int64_t begin = in_.tellg();
    if (size < 0 || begin + size > bytes_) throw std::runtime_error("its attribute " + name + " is longer than the file");
    if (!HasItsSize(type, size, begin + size)) throw std::runtime_error("its attribute " + name + " is damaged");
    in_.seekg(begin);
    if (name == "dataWindow") CheckWindow();
    if (name == "tiles") CheckTile();
    in_.seekg(begin + size);
    return true;
  }

  /// Whether the library takes as many bytes for the value as the header says.
  bool HasItsSize(const std::string& type, std::int64_t size, std::int64_t end) {
    const auto fixed = std::ranges::find(kFixedTypes, type, &ExrType::name);
    if (fixed != kFixedTypes.end()) return size == fixed->size_B;
    if (type == "chlist") return size <= kMostExrChannels_B && EndsWithItsChannels(end);
    if (type == "stringvector") return EndsWithItsStrings(end);
    if (type != "preview") return true;  // strings and what is not known are taken by the size
    if (size < 8) return false;
    const auto side = Take<std::array<std::uint32_t, 2>>();
    return side[0] <= bytes_ && side[1] <= bytes_ && size == 8 + std::int64_t{4} * side[0] * side[1];
  }

  bool EndsWithItsChannels(std::int64_t end) {
    while (in_.tellg() < end) {
      if (TakeName().empty()) return in_.tellg() == end;
      in_.seekg(kChannel_B, std::ios::cur);
    }
    return false;
  }

  bool EndsWithItsStrings(std::int64_t end) {
    while (in_.tellg() < end) {
      const auto length = Take<std::int32_t>();
      if (length < 0 || in_.tellg() + std::int64_t{length} > end) return false;
      in_.seekg(length, std::ios::cur);
    }
    return in_.tellg() == end;
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

void WriteExrBeside(const std::string& path, const std::function<void(const char* to)>& write) {
  std::error_code no_place;
  const auto target = std::filesystem::weakly_canonical(path, no_place);  // a link stays one
  const bool is_new = !std::filesystem::exists(path);
  if (no_place || (!is_new && !std::filesystem::is_regular_file(target))) return write(path.c_str());
  const std::string beside = target.string() + ".part";
  write(beside.c_str());
  std::filesystem::rename(beside, target);
}

}  // namespace twinbench::optics
