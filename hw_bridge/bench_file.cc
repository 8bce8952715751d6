#include "hw_bridge/bench_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "hw_bridge/ad/ad_source.h"
#include "hw_bridge/bench_dialogue.h"
#include "hw_bridge/control/address.h"
#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/reading.h"
#include "twin/core/toml_reader.h"

namespace twinbench::hw {
namespace {

/// What keys say together.
class FileCheck {
 public:
  FileCheck(const BenchFile& file, const KeyPlaces& places) : file_(file), places_(places) {}

  void Check() const {
    if (file_.kind != "hardware") RefuseDevices(places_, file_.kind, {"kind", "name", "record", "attempts"});
    CheckRecord(places_, file_.path, file_.kind, file_.record);
    if (file_.kind == "hardware") CheckDevices();
  }

 private:
  std::string Where(const std::string& path) const { return WhereIn(places_, file_.path, path); }

  void CheckDevices() const {
    CheckAd();
    CheckTable("target", file_.target, file_.target_limits);
    CheckTable("reference", file_.reference, file_.reference_limits);
    CheckConnection("autocollimator", file_.autocollimator);
    CheckConnection("thermometer", file_.thermometer);
    CheckConnection("goniometer", file_.goniometer);
    CheckConnection("fixture", file_.fixture);
    CheckConnection("clock", file_.clock);
    CheckShared();
  }

  void CheckAd() const {
    const AdSettings& adc = file_.adc;
    Demand("adc", adc.kind, "kind = \"iio\" or \"comedi\"");
    if (!HasAdDriver(adc.kind))
      throw InputError(Where("adc.kind"), fmt::format("this build was made without the driver \"{}\"", adc.kind),
                       "another kind, or a build with it");
    if (adc.device.empty()) throw InputError(Where("adc.device"), "adc.device is missing", "the name of the card");
    const std::set<std::string> once(adc.channels.begin(), adc.channels.end());
    if (adc.channels.size() != kChannels || once.size() != kChannels)
      throw InputError(Where("adc.channels"), fmt::format("adc.channels names {} inputs", once.size()),
                       "four different ones: psd_a_x, psd_a_y, psd_b_x, psd_b_y");
    if (adc.kind == "iio") RefuseAd({"subdevice", "reference", "calibration_file"});
    if (adc.kind == "comedi") RefuseAd({"uri"});
  }

  void RefuseAd(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      if (places_.contains("adc." + name))
        throw InputError(Where("adc." + name), fmt::format("adc.{} with kind = \"{}\"", name, file_.adc.kind),
                         "keys of that driver");
    }
  }

  void Demand(const std::string& table, const std::string& kind, const std::string& expected) const {
    if (!places_.contains(table))
      throw InputError(file_.path + ":1", fmt::format("there is no [{}]", table), expected);
    if (kind.empty()) throw InputError(Where(table), fmt::format("{}.kind is missing", table), expected);
  }

  void CheckTable(const std::string& table, const ControlSettings& s, const TableLimits& limits) const {
    Demand(table, s.kind, "kind = \"scpi\" or \"esp\"");
    CheckConnection(table, s);
    if (limits.lower_rad >= limits.upper_rad)
      throw InputError(Where(table + ".upper_deg"), fmt::format("{}.upper_deg is not above lower_deg", table),
                       "a range to move in");
  }

  void CheckConnection(const std::string& table, const ControlSettings& s) const {
    const std::string key = table + ".address";
    if (!HasConnection(s.kind) && !s.address.empty())
      throw InputError(Where(key), fmt::format("{} with kind = \"{}\"", key, s.kind),
                       "an address of \"scpi\", \"esp\" or \"dialogue\"");
    if (HasConnection(s.kind) && !ParseAddress(s.address))
      throw InputError(Where(key), fmt::format("{} is \"{}\"", key, s.address), kAddressForm);
    RequireTokenText(Where(table + ".token"), s.token);
  }

  /// Who shares an address shares a connection: one language, one identity. The clock has its own.
  void CheckShared() const {
    const std::vector<std::pair<std::string, const ControlSettings*>> devices = {
        {"target", &file_.target},
        {"reference", &file_.reference},
        {"autocollimator", &file_.autocollimator},
        {"thermometer", &file_.thermometer},
        {"goniometer", &file_.goniometer},
        {"fixture", &file_.fixture}};
    for (auto a = devices.begin(); a != devices.end(); ++a) {
      for (auto b = a + 1; b != devices.end(); ++b) CheckPair(a->first, *a->second, b->first, *b->second);
      const bool takes_clock = file_.clock.kind == "scpi" && file_.clock.address == a->second->address;
      if (takes_clock && file_.clock.address.starts_with("serial:"))
        throw InputError(Where("clock.address"), fmt::format("the clock shares a serial line with {}", a->first),
                         "a connection of its own");
    }
    const bool same_axis =
        file_.target.address == file_.reference.address && file_.target.axis == file_.reference.axis;
    if (same_axis) throw InputError(Where("reference.axis"), "target and reference are the same axis", "two axes");
  }

  void CheckPair(const std::string& name_a, const ControlSettings& a, const std::string& name_b,
                 const ControlSettings& b) const {
    if (a.address.empty() || a.address != b.address) return;
    if (SpeakAlike(a, b)) return;
    throw InputError(Where(name_b + ".address"), fmt::format("{} shares the address of {}", name_b, name_a),
                     "the same kind, identity, token, watchdog and way of speaking, then");
  }

  const BenchFile& file_;
  const KeyPlaces& places_;
};

}  // namespace

BenchFile ParseBenchFile(const std::string& text, const std::string& name, const std::string& folder) {
  BenchFile file;
  file.path = name;
  file.places = ReadToml(text, name, KeysOf(file));
  const auto take = [&](const char* table, DialogueRole role, ControlSettings& s) {
    TakeWords(name, file.places, folder, table, role, s);
  };
  take("autocollimator", DialogueRole::kAutocollimator, file.autocollimator);
  take("thermometer", DialogueRole::kThermometer, file.thermometer);
  take("goniometer", DialogueRole::kGoniometer, file.goniometer);
  FileCheck(file, file.places).Check();
  MakeAbsolute(folder, file.record);
  MakeAbsolute(folder, file.adc.calibration_file);
  return file;
}

BenchFile LoadBenchFile(const std::string& path) {
  return ParseBenchFile(InputText(path, "a bench file in TOML"), path, std::filesystem::path(path).parent_path().string());
}

}  // namespace twinbench::hw
