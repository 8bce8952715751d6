#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_encoder {
namespace {

using test::Change, test::OwnKey;

std::vector<OwnKey> EncoderChanges() {
  const std::vector<std::string> sweep = {"encoder_procedure.kind=sweep"};
  return {Change("noise_free", "true"),
          Change("device.noise_deg", "0.005"),
          Change("device.noise_known", "true"),
          Change("device.resolution_deg", "0.005"),
          Change("device.turn_mm", "5.0"),
          Change("device.lines_per_turn", "30"),
          Change("device.teeth", "22"),
          Change("device.signal_periods", "3"),
          Change("device.signal_zero_deg", "40.0"),
          Change("device.signal_zero_known", "true"),
          Change("encoder_procedure.kind", "\"sweep\""),
          Change("encoder_procedure.turns", "1.0"),
          Change("encoder_procedure.start_deg", "77.0"),
          Change("encoder_procedure.passes", "[1, -1]"),
          Change("encoder_procedure.mounting_deg", "[0.0, 120.0]"),
          Change("encoder_procedure.remount_s", "60.0", {"encoder_procedure.mounting_deg=[0.0, 120.0]"}),
          Change("encoder_procedure.stops_per_turn", "48"),
          Change("encoder_procedure.stop_interval_s", "9.0"),
          Change("encoder_procedure.readings_per_stop", "16",
                 {"device.noise_known=true", "device.resolution_deg=0.0005"}),
          Change("encoder_procedure.read_s", "0.01", {"encoder_procedure.readings_per_stop=16"}),
          Change("encoder_procedure.speeds_deg_s", "[20.0]", sweep),
          Change("encoder_procedure.ramp_s", "1.5", sweep),
          Change("encoder_procedure.rest_s", "5.0", sweep),
          Change("encoder_procedure.interval_s", "0.15", sweep),
          Change("encoder_procedure.heads_deg", "[0.0, 90.0, 217.0]"),
          Change("encoder_procedure.reference_noise_arcsec", "5.0",
                 {"encoder_procedure.heads_deg=[0.0, 90.0, 217.0]"})};
}

/// A coast is read by the times of lines; the readings are compared as the mean angle errors of each pass.
std::vector<OwnKey> CoastChanges() {
  const std::vector<std::string> coast = {"encoder_procedure.kind=coast", "encoder_procedure.turns=8.0",
                                          "encoder_procedure.speeds_deg_s=[1800.0, 900.0]",
                                          "encoder_procedure.stamps_per_turn=256"};
  return {Change("device.stamp_noise_ns", "50.0", coast),
          Change("encoder_procedure.stamps_per_turn", "128", {coast[0], coast[1], coast[2]}),
          Change("spindle.friction_deg_s2", "2.0", coast),
          Change("spindle.viscous_per_s", "3e-3", coast),
          Change("spindle.drag_per_turn", "1e-5", coast)};
}

std::vector<OwnKey> Keys() {
  std::vector<OwnKey> all = EncoderChanges();
  for (const OwnKey& key : CoastChanges()) all.push_back(key);
  for (const char* key : {"device.graduation_arcsec", "device.graduation_fall", "device.graduation_orders"})
    all.push_back({key, {}, "the ring's errors are drawn: a diagnosis finds them, no scenario says which they are"});
  for (const char* key : {"spindle.torque_deg_s2", "spindle.torque_order", "spindle.ripple_deg_s2", "spindle.ripple_order"})
    all.push_back({key, {}, "not followed yet: in the mean turns that are compared, what they move the shaft by counts as the ring's"});
  all.push_back({"bench", {}, "another bench"});
  all.push_back({"title", {}, "words"});
  all.push_back({"seed", {}, "every run has its own"});
  all.push_back({"repeat", {"repeat=3"}});
  return all;
}

const std::vector<std::string> kBase = {};

}  // namespace

test::OwnBench Bench() {
  return {kEncoderBench, "encoder_comparison.toml", kBase, Keys(), {"device.lines_per_turn=30", "device.teeth=22"}, 20};
}

}  // namespace twinbench::own_encoder
