#include "twin/core/record_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

/// Text that is no UTF-8 (from an imported file) keeps its place, not its odd bytes.
std::string ExtraText(const Reading& reading) {
  if (reading.extra.empty()) return "";
  return nlohmann::json(reading.extra).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A quantity that is not available is left out: JSON has no NaN.
std::string QuantitiesText(const Reading& reading) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : reading.quantities) {
    if (std::isfinite(value)) json[name] = value;
  }
  return json.empty() ? "" : json.dump();
}

/// The object that a text column holds; null if the text is none. An empty text is an empty object.
nlohmann::json ObjectIn(const std::string& text) {
  if (text.empty()) return nlohmann::json::object();
  const auto json = nlohmann::json::parse(text, nullptr, false);
  return json.is_object() ? json : nlohmann::json();
}

}  // namespace

void BindReading(SqliteStatement& insert, const Reading& r) {
  int index = 0;
  const auto bind = [&](const auto& value) { insert.Bind(index++, value); };
  const auto bind_integer = [&](std::int64_t value) { insert.Bind(index++, value); };
  bind_integer(r.reading);
  bind_integer(r.time.time_since_epoch().count());
  for (const int number : {r.setup, r.pass, r.direction, r.position}) bind_integer(number);
  bind(std::string(PhaseName(r.phase)));
  bind(std::string(ReadingStatusName(r.status)));
  for (const double angle_rad : {r.target_rad, r.reference_rad}) bind(angle_rad);
  for (const double mean_V : r.mean_V) bind(mean_V);
  for (const double std_V : r.std_V) bind(std_V);
  bind_integer(r.n_samples);
  for (const double value : {r.dwell_s, r.temperature_degC, r.autocollimator_yaw_rad, r.autocollimator_tilt_rad})
    bind(value);
  bind(ExtraText(r));
  for (const double value : {r.measured_rad, r.velocity_rad_s, r.head_rad, r.interferometer_rad}) bind(value);
  bind(QuantitiesText(r));
}

Reading TakeReading(const SqliteStatement& row, const std::string& path) {
  Reading r;
  int column = 1;  // behind the id
  const auto take_integer = [&] { return static_cast<int>(row.Integer(column++)); };
  const auto take_real = [&] { return row.Real(column++); };
  r.reading = take_integer();
  r.time = Time(Duration(row.Integer(column++)));
  for (int* number : {&r.setup, &r.pass, &r.direction, &r.position}) *number = take_integer();
  const auto phase = PhaseOf(row.Text(column++));
  const auto status = ReadingStatusOf(row.Text(column++));
  for (double* angle_rad : {&r.target_rad, &r.reference_rad}) *angle_rad = take_real();
  for (double& mean_V : r.mean_V) mean_V = take_real();
  for (double& std_V : r.std_V) std_V = take_real();
  r.n_samples = take_integer();
  for (double* value : {&r.dwell_s, &r.temperature_degC, &r.autocollimator_yaw_rad, &r.autocollimator_tilt_rad})
    *value = take_real();
  const std::string extra_text = row.Text(column++);
  for (double* value : {&r.measured_rad, &r.velocity_rad_s, &r.head_rad, &r.interferometer_rad})
    *value = take_real();
  const nlohmann::json extra = ObjectIn(extra_text), quantities = ObjectIn(row.Text(column++));
  const auto is_text = [](const nlohmann::json& value) { return value.is_string(); };
  const auto is_number = [](const nlohmann::json& value) { return value.is_number(); };
  if (!phase || !status || extra.is_null() || quantities.is_null() || !std::ranges::all_of(extra, is_text) ||
      !std::ranges::all_of(quantities, is_number))
    throw InputError(path, fmt::format("reading {} of the record is damaged", r.reading), "names and JSON of ours");
  r.phase = *phase;
  r.status = *status;
  r.extra = extra.get<std::map<std::string, std::string>>();
  for (const auto& [name, value] : quantities.items()) r.quantities.emplace_back(name, value.get<double>());
  return r;
}

}  // namespace twinbench
