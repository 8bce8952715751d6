#include "hw_bridge/serve/iiod_devices.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr double kMilli = 1e-3;
constexpr int kSampleBits = 16;

std::string Print(double value_SI, double unit) {
  return std::isfinite(value_SI) ? PrintInUnit(value_SI, unit) : "nan";
}

double ScanRate_Hz(const AdcSettings& adc) {
  return adc.rate_Hz / kChannels;
}

IiodAttribute Constant(const std::string& name, const std::string& value) {
  return {name, [value] { return value; }};
}

/// Settings of the converter can be asked for, and only be set to what they are.
IiodAttribute Settled(const std::string& name, double value) {
  return {name, [value] { return PrintInUnit(value, 1.0); },
          [value](const std::string& text) { return ParseNumber(text) == value; }};
}

/// An attribute that moves or spoils something. IIOD has no place for a token: where one is asked for it can only be read.
IiodAttribute Changing(const ServedBench& served, IiodAttribute attribute) {
  if (!served.token.empty()) attribute.write = nullptr;
  return attribute;
}

IiodChannel Voltage(const ServedBench& served, int k) {
  const double lsb_V = served.adc.range_V / static_cast<double>(1 << (served.adc.bits - 1));
  IiodChannel channel{fmt::format("voltage{}", k), kChannelNames[k]};
  channel.attributes = {Constant("offset", "0"), Constant("scale", PrintInUnit(lsb_V, kMilli))};
  for (IiodAttribute& a : channel.attributes) a.filename = fmt::format("in_voltage{}_{}", k, a.name);
  channel.scan_index = k;
  channel.format = fmt::format("le:S{0}/{0}>>0", kSampleBits);
  return channel;
}

IiodDevice Adc(ServedBench& served) {
  IiodDevice adc{"iio:device0", "psd-adc16"};
  adc.has_buffer = true;
  for (int k = 0; k < kChannels; ++k) adc.channels.push_back(Voltage(served, k));
  adc.channels.push_back({"timestamp", "", {}, kTimestampIndex, "le:S64/64>>0"});
  adc.attributes = {Constant("bits", std::to_string(served.adc.bits)),
                    Settled("conversion_frequency", served.adc.rate_Hz),
                    {"light", [&served] { return served.paced.stream().light(); }},
                    {"overruns", [&served] { return std::to_string(served.paced.stream().overruns()); }},
                    Settled("range_V", served.adc.range_V),
                    Settled("sampling_frequency", ScanRate_Hz(served.adc)),
                    Constant("serial", served.serial)};
  adc.debug = {Changing(served, {"fault", [&served] { return served.faults.Waiting(); },
                                 [&served](const std::string& text) { return served.faults.Add("adc", text); }})};
  return adc;
}

TableState StateOf(ServedBench& served, ShownTable& table) {
  served.StrikeRestarts();
  served.paced.CatchUp();
  return table.State();
}

bool Move(ServedBench& served, ShownTable& table, const std::string& text) {
  const auto angle_rad = ParseInUnit(text, units::deg);
  if (!angle_rad || table.Refuses(*angle_rad) != ShownTable::Refusal::kNone) return false;
  served.paced.Spend([&] { table.StartMove(*angle_rad); });
  return true;
}

IiodDevice Table(ServedBench& served, ShownTable& table, const std::string& id) {
  IiodDevice device{id, "rotary-" + table.name()};
  const auto state = [&served, &table] { return StateOf(served, table); };
  device.attributes = {
      Changing(served, {"angle_deg", [state] { return Print(state().encoder_rad, units::deg); },
                        [&served, &table](const std::string& text) { return Move(served, table, text); }}),
                       {"commanded_deg", [state] { return Print(state().commanded_rad, units::deg); }},
                       {"in_position", [state] { return std::string(state().in_position ? "1" : "0"); }},
                       {"moving", [state] { return std::string(state().moving ? "1" : "0"); }}};
  return device;
}

IiodDevice Environment(ServedBench& served) {
  IiodDevice device{"iio:device3", "environment"};
  const auto read = [&served] {
    double temperature_degC = kNaN;
    served.paced.Spend([&] { temperature_degC = served.bench().thermometer.Read_degC(); });
    return Print(temperature_degC, kMilli);
  };
  device.channels = {{"temp", "", {{"input", read, nullptr, "in_temp_input"}}}};
  return device;
}

}  // namespace

std::vector<IiodDevice> IiodDevices(ServedBench& served) {
  return {Adc(served),
          Table(served, served.target, "iio:device1"),
          Table(served, served.reference, "iio:device2"),
          Environment(served),
          {"trigger0", "scan-clock"}};
}

}  // namespace twinbench::hw
