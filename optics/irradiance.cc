#include "optics/irradiance.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "optics/exr_header.h"

namespace twinbench::optics {
namespace {

constexpr double kPerSquareMm = 1e-6;  // W/m^2 -> W/mm^2
constexpr double kInch_m = 0.0254;

Imath::M44d PoseMatrix(const Eigen::Isometry3d& pose) {
  Imath::M44d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix[row][column] = pose.matrix()(row, column);
  }
  return matrix;
}

void AddDouble(Imf::Header& header, const std::string& name, double value) {
  header.insert(name, Imf::DoubleAttribute(value));
}

void AddGeometry(Imf::Header& header, const IrradianceMap& map) {
  const auto f = [](double x) { return static_cast<float>(x); };
  const double pitch_um = map.pitch_m * 1e6;
  header.insert("sensorPhotositePitch", Imf::FloatAttribute(f(pitch_um)));
  header.insert("sensorOverallDimensions",
                Imf::V2fAttribute({f(map.width * map.pitch_m * 1e3), f(map.height * map.pitch_m * 1e3)}));
  header.insert("xDensity", Imf::FloatAttribute(f(kInch_m / map.pitch_m)));
  AddDouble(header, "bench:pitch_um", pitch_um);
  header.insert("bench:psdToWorld", Imf::M44dAttribute(PoseMatrix(map.X_LP)));
}

void AddLight(Imf::Header& header, const IrradianceMap& map) {
  header.insert("bench:units", Imf::StringAttribute("W.mm^-2"));
  header.insert("bench:quantity", Imf::StringAttribute("irradiance"));
  header.insert("bench:order", Imf::IntAttribute(map.order));
  AddDouble(header, "bench:wavelength_nm", map.wavelength_m * 1e9);
  AddDouble(header, "bench:power_W", map.power_W);
  const MapCentroid centroid = Centroid(map);
  AddDouble(header, "bench:centroid_u_um", centroid.u_m * 1e6);
  AddDouble(header, "bench:centroid_v_um", centroid.v_m * 1e6);
}

Imf::Header MakeHeader(const IrradianceMap& map) {
  Imf::Header header(map.width, map.height);
  header.setName(map.name);
  header.setType(Imf::SCANLINEIMAGE);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  AddGeometry(header, map);
  AddLight(header, map);
  return header;
}

Imf::Slice SliceOf(std::vector<float>& pixels, const Imath::Box2i& window, int width) {
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(width);
  char* base = reinterpret_cast<char*>(pixels.data());
  // OpenEXR adds y * row + x * pixel of the data window; take its corner off without leaving the array's
  // arithmetic.
  return Imf::Slice(Imf::FLOAT,
                    base - static_cast<std::ptrdiff_t>(window.min.y) * static_cast<std::ptrdiff_t>(row_bytes) -
                        static_cast<std::ptrdiff_t>(window.min.x) * static_cast<std::ptrdiff_t>(sizeof(float)),
                    sizeof(float), row_bytes);
}

void CheckMaps(const std::vector<IrradianceMap>& maps) {
  std::set<std::string> names;
  for (const IrradianceMap& map : maps) {
    const auto size = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    if (map.width < 1 || map.height < 1 || map.irradiance_W_m2.size() != size || !(map.pitch_m > 0.0)) {
      throw std::invalid_argument("irradiance map " + map.name + ": size, pitch and number of values disagree");
    }
    if (!names.insert(map.name).second) throw std::invalid_argument("two irradiance maps are named " + map.name);
  }
  if (maps.empty()) throw std::invalid_argument("no irradiance map to write");
}

void WritePart(Imf::MultiPartOutputFile& file, int index, const IrradianceMap& map) {
  std::vector<float> pixels(map.irradiance_W_m2.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = static_cast<float>(map.irradiance_W_m2[i] * kPerSquareMm);
  }
  Imf::OutputPart part(file, index);
  Imf::FrameBuffer buffer;
  buffer.insert("Y", SliceOf(pixels, part.header().dataWindow(), map.width));
  part.setFrameBuffer(buffer);
  part.writePixels(map.height);
}

double DoubleOr(const Imf::Header& header, const char* name, double otherwise) {
  const auto* attribute = header.findTypedAttribute<Imf::DoubleAttribute>(name);
  return attribute ? attribute->value() : otherwise;
}

/// Pixel pitch from our own attribute, the standard one or the density of a picture; NaN without any.
double PitchOf(const Imf::Header& header) {
  const double own_um = DoubleOr(header, "bench:pitch_um", 0.0);
  if (own_um > 0.0) return own_um * 1e-6;
  const auto* standard_um = header.findTypedAttribute<Imf::FloatAttribute>("sensorPhotositePitch");
  if (standard_um) return standard_um->value() * 1e-6;
  const auto* density = header.findTypedAttribute<Imf::FloatAttribute>("xDensity");
  return density ? kInch_m / density->value() : std::nan("");
}

void ReadMeaning(const Imf::Header& header, IrradianceMap& map) {
  map.pitch_m = PitchOf(header);
  map.name = header.hasName() ? header.name() : map.name;
  map.wavelength_m = DoubleOr(header, "bench:wavelength_nm", std::nan("")) * 1e-9;
  map.power_W = DoubleOr(header, "bench:power_W", std::nan(""));
  if (const auto* order = header.findTypedAttribute<Imf::IntAttribute>("bench:order")) map.order = order->value();
  if (const auto* pose = header.findTypedAttribute<Imf::M44dAttribute>("bench:psdToWorld")) {
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) map.X_LP.matrix()(row, column) = pose->value()[row][column];
    }
  }
}

/// Factor to W/m^2. A file that does not say its unit is a relative profile: only its shape counts.
double ToWattsPerSquareMetre(const Imf::Header& header) {
  const auto* units = header.findTypedAttribute<Imf::StringAttribute>("bench:units");
  return units && units->value() == "W.m^-2" ? 1.0 : 1.0 / kPerSquareMm;
}

IrradianceMap ReadPart(Imf::MultiPartInputFile& file, int index) {
  Imf::InputPart part(file, index);
  const Imf::Header& header = part.header();
  if (!header.channels().findChannel("Y")) throw std::runtime_error("no channel Y (irradiance)");
  const Imath::Box2i window = header.dataWindow();
  IrradianceMap map;
  ReadMeaning(header, map);
  if (!(map.pitch_m > 0.0)) throw std::runtime_error("no pixel pitch (sensorPhotositePitch or xDensity)");
  map.width = window.max.x - window.min.x + 1;
  map.height = window.max.y - window.min.y + 1;
  map.irradiance_W_m2.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  Imf::FrameBuffer buffer;
  buffer.insert("Y", SliceOf(map.irradiance_W_m2, window, map.width));
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  const double factor = ToWattsPerSquareMetre(header);
  for (float& value : map.irradiance_W_m2) {
    if (!(value >= 0.0f) || std::isinf(value)) throw std::runtime_error("an irradiance is negative or not finite");
    value = static_cast<float>(value * factor);
  }
  return map;
}

}  // namespace

MapCentroid Centroid(const IrradianceMap& map) {
  double sum = 0.0, u = 0.0, v = 0.0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double value = map.At(row, column);
      sum += value;
      u += value * map.U(column);
      v += value * map.V(row);
    }
  }
  return {.u_m = u / sum, .v_m = v / sum, .power_W = sum * map.pitch_m * map.pitch_m};
}

void WriteIrradianceMaps(const std::string& path, const std::vector<IrradianceMap>& maps) {
  CheckMaps(maps);
  std::vector<Imf::Header> headers;
  for (const IrradianceMap& map : maps) headers.push_back(MakeHeader(map));
  try {
    WriteExrBeside(path, [&](const char* to) {
      Imf::MultiPartOutputFile file(to, headers.data(), static_cast<int>(headers.size()));
      for (std::size_t i = 0; i < maps.size(); ++i) WritePart(file, static_cast<int>(i), maps[i]);
    });
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot write the irradiance map: " + error.what());
  }
}

std::vector<IrradianceMap> ReadIrradianceMaps(const std::string& path) {
  try {
    RequirePlausibleExr(path);
    Imf::MultiPartInputFile file(path.c_str());
    std::vector<IrradianceMap> maps;
    for (int i = 0; i < file.parts(); ++i) maps.push_back(ReadPart(file, i));
    return maps;
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot read the irradiance map: " + error.what());
  }
}

}  // namespace twinbench::optics
