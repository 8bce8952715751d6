#include "hw_bridge/bench_file.h"

namespace twinbench::hw {
namespace {

using Keys = std::vector<ScenarioKey>;
using Choices = std::vector<std::string>;

constexpr Unit kPure{}, kDeg{"deg", units::deg}, kArcsec{"arcsec", units::arcsec}, kSecond{"s"}, kHz{"Hz"};

Bounds Positive(double upper) {
  return {0.0, upper, true};
}

class Table {
 public:
  Table(Keys& keys, std::string name) : keys_(keys), name_(std::move(name)) {}

  void Number(const std::string& name, const Unit& unit, const Bounds& bounds, Field field,
              const std::string& meaning) {
    keys_.push_back({name_, name, unit, bounds, {}, field, meaning});
  }
  void Text(const std::string& name, Field field, Choices choices, const std::string& meaning) {
    keys_.push_back({name_, name, {}, {}, std::move(choices), field, meaning});
  }

 private:
  Keys& keys_;
  std::string name_;
};

void AddTop(Keys& keys, BenchFile& f) {
  Table t(keys, "");
  t.Text("kind", &f.kind, {"hardware", "twin", "replay"}, "what stands there");
  t.Text("name", &f.name, {}, "of the bench, for the record");
  t.Text("record", &f.record, {}, "replay: folder of the recorded run, from the bench file's folder");
  t.Number("attempts", kPure, {1, 100}, &f.attempts, "at one reading, before the run stops");
  t.Number("jump", {"V"}, Positive(100), &f.jump_V, "of a channel between neighbouring measuring positions; more is implausible");
}

void AddAd(Keys& keys, AdSettings& s) {
  Table t(keys, "adc");
  t.Text("kind", &s.kind, {"iio", "comedi"}, "driver");
  t.Text("uri", &s.uri, {}, "iio: where the context is, as libiio takes it");
  t.Text("device", &s.device, {}, "iio: name or id of the device; comedi: device file");
  t.Text("channels", &s.channels, {}, "of psd_a_x, psd_a_y, psd_b_x, psd_b_y, as the driver calls them");
  t.Number("subdevice", kPure, {-1, 255}, &s.subdevice, "comedi: of the inputs; -1 looks for the first");
  t.Text("reference", &s.reference, {"ground", "common", "differential"}, "comedi: how the inputs are wired");
  t.Text("light", &s.light, {}, "where the PSD amplifiers tell whether there is light; empty: not wired");
  t.Text("serial", &s.serial, {}, "serial number that the card must have; empty: any");
  t.Text("calibration_file", &s.calibration_file, {}, "comedi: soft calibration; empty: nominal");
  t.Number("timeout", kSecond, Positive(3600), &s.timeout_s, "for a block, beyond its own length");
  t.Number("rate_tolerance", kPure, {0, 1}, &s.rate_tolerance, "relative; a card that is further off is refused");
  t.Number("mains", kHz, {10, 1000}, &s.mains_Hz, "where hum is looked for");
}

/// What every instrument on a connection has.
Table AddConnection(Keys& keys, const std::string& table, ControlSettings& s, const Choices& kinds) {
  Table t(keys, table);
  t.Text("kind", &s.kind, kinds, "language, or who does it");
  t.Text("address", &s.address, {}, "where the controller is reached");
  t.Text("identity", &s.identity, {}, "what its answer to *IDN? or VE? must begin with; empty: any");
  t.Text("token", &s.token, {}, "of a served twin that asks for one; empty: none");
  t.Text("watchdog", &s.watchdog, {}, "command that arms the controller's own, after every opening; empty: it has none");
  t.Number("timeout", kSecond, Positive(3600), &s.timeout_s, "of one answer");
  return t;
}

void AddDescribed(Keys& keys, const std::string& table, ControlSettings& s, const Choices& kinds) {
  AddConnection(keys, table, s, kinds)
      .Text("dialogue", &s.dialogue, {}, "kind dialogue: a ready one, or a file that ends in .toml, from the bench file's folder");
}

void AddTable(Keys& keys, const std::string& table, ControlSettings& s, TableLimits& limits) {
  Table t = AddConnection(keys, table, s, {"scpi", "esp"});
  t.Number("axis", kPure, {1, 99}, &s.axis, "of the controller");
  t.Number("decimals", kPure, {-1, 15}, &s.decimals,
           "digits behind the point of an angle in deg; -1: all that matter");
  t.Number("lower", kDeg, {-1e6, 1e6}, &limits.lower_rad, "soft limit; without it the controller's own");
  t.Number("upper", kDeg, {-1e6, 1e6}, &limits.upper_rad, "soft limit; without it the controller's own");
  t.Number("in_position", kArcsec, Positive(1e6), &limits.in_position_rad, "encoder against command when settled");
  t.Number("following", kDeg, Positive(1e6), &limits.following_rad,
           "how far it may go the wrong way; without it not watched");
  t.Number("stall", kSecond, Positive(3600), &limits.stall_s, "a moving table may stand still so long");
  t.Number("move_timeout", kSecond, Positive(36000), &limits.move_timeout_s, "a move may take so long");
}

}  // namespace

std::vector<ScenarioKey> KeysOf(BenchFile& file) {
  Keys keys;
  AddTop(keys, file);
  AddAd(keys, file.adc);
  AddTable(keys, "target", file.target, file.target_limits);
  AddTable(keys, "reference", file.reference, file.reference_limits);
  AddDescribed(keys, "autocollimator", file.autocollimator, {"scpi", "dialogue", "none"});
  AddDescribed(keys, "thermometer", file.thermometer, {"scpi", "dialogue", "none"});
  AddDescribed(keys, "goniometer", file.goniometer, {"scpi", "dialogue", "console", "none"});
  AddConnection(keys, "fixture", file.fixture, {"scpi", "console"});
  AddConnection(keys, "clock", file.clock, {"host", "scpi"});
  return keys;
}

}  // namespace twinbench::hw
