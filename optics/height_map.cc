#include "optics/height_map.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "optics/exr_header.h"

namespace twinbench::optics {
namespace {

constexpr double kOfAnInch_m = 0.0254;

/// Weights of four pixels in a row, `t` from the second to the third, and their slopes per pixel.
struct Cubic {
  std::array<double, 4> weight, slope;

  explicit Cubic(double t)
      : weight{0.5 * t * (-1.0 + t * (2.0 - t)), 0.5 * (2.0 + t * t * (-5.0 + 3.0 * t)),
               0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)},
        slope{0.5 * (-1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * (-10.0 + 9.0 * t), 0.5 * (1.0 + t * (8.0 - 9.0 * t)),
              0.5 * t * (3.0 * t - 2.0)} {}
};

Imf::Slice PixelsOf(std::vector<float>& pixels, const Imath::Box2i& window, int width) {
  const auto step = static_cast<std::ptrdiff_t>(sizeof(float));
  // OpenEXR counts from the corner of its data window.
  char* const base = reinterpret_cast<char*>(pixels.data()) - window.min.x * step - window.min.y * step * width;
  return Imf::Slice(Imf::FLOAT, base, sizeof(float), sizeof(float) * static_cast<std::size_t>(width));
}

double PixelPitch_m(const Imf::Header& header) {
  if (const auto* pitch_um = header.findTypedAttribute<Imf::FloatAttribute>("sensorPhotositePitch"))
    return pitch_um->value() * 1e-6;
  const auto* per_inch = header.findTypedAttribute<Imf::FloatAttribute>("xDensity");
  return per_inch ? kOfAnInch_m / per_inch->value() : std::nan("");
}

HeightMap Read(const std::string& path) {
  RequirePlausibleExr(path);
  Imf::InputFile file(path.c_str());
  if (!file.header().channels().findChannel("Y")) throw std::runtime_error("no channel Y (height)");
  const Imath::Box2i window = file.header().dataWindow();
  HeightMap map{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, PixelPitch_m(file.header()), {}};
  if (!(map.pitch_m > 0.0)) throw std::runtime_error("no pixel pitch (sensorPhotositePitch or xDensity)");
  map.height_um.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  Imf::FrameBuffer buffer;
  buffer.insert("Y", PixelsOf(map.height_um, window, map.width));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  if (!std::ranges::all_of(map.height_um, [](float h) { return std::isfinite(h); }))
    throw std::runtime_error("a height is not finite");
  return map;
}

}  // namespace

HeightAt Interpolate(const HeightMap& map, double x_m, double y_m) {
  const double column = x_m / map.pitch_m + 0.5 * (map.width - 1), row = 0.5 * (map.height - 1) - y_m / map.pitch_m;
  const double left = std::floor(std::clamp(column, 0.0, map.width - 1.0));
  const double top = std::floor(std::clamp(row, 0.0, map.height - 1.0));
  const Cubic across(std::clamp(column, 0.0, map.width - 1.0) - left);
  const Cubic down(std::clamp(row, 0.0, map.height - 1.0) - top);
  HeightAt at;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      const auto u = static_cast<std::size_t>(k), v = static_cast<std::size_t>(i);
      const double height_m = 1e-6 * map.At(std::clamp(static_cast<int>(top) + i - 1, 0, map.height - 1),
                                            std::clamp(static_cast<int>(left) + k - 1, 0, map.width - 1));
      at.height_m += height_m * across.weight[u] * down.weight[v];
      at.slope.x() += height_m * across.slope[u] * down.weight[v] / map.pitch_m;
      at.slope.y() -= height_m * across.weight[u] * down.slope[v] / map.pitch_m;
    }
  }
  if (column != std::clamp(column, 0.0, map.width - 1.0)) at.slope.x() = 0.0;
  if (row != std::clamp(row, 0.0, map.height - 1.0)) at.slope.y() = 0.0;
  return at;
}

void WriteHeightMap(const std::string& path, const HeightMap& map) {
  const auto size = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  if (map.width < 1 || map.height < 1 || map.height_um.size() != size || !(map.pitch_m > 0.0))
    throw std::invalid_argument("height map: size, pitch and number of values disagree");
  Imf::Header header(map.width, map.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.insert("sensorPhotositePitch", Imf::FloatAttribute(static_cast<float>(map.pitch_m * 1e6)));
  header.insert("bench:units", Imf::StringAttribute("um"));
  header.insert("bench:quantity", Imf::StringAttribute("height"));
  std::vector<float> pixels = map.height_um;
  Imf::FrameBuffer buffer;
  buffer.insert("Y", PixelsOf(pixels, header.dataWindow(), map.width));
  try {
    WriteExrBeside(path, [&](const char* to) {
      Imf::OutputFile file(to, header);
      file.setFrameBuffer(buffer);
      file.writePixels(map.height);
    });
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot write the height map: " + error.what());
  }
}

HeightMap ReadHeightMap(const std::string& path) {
  try {
    return Read(path);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot read the height map: " + error.what());
  }
}

}  // namespace twinbench::optics
