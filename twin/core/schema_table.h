#pragma once

#include <array>
#include <memory>
#include <utility>

#include "twin/core/scenario_schema.h"

/// How the keys of the file format are written down; only the settings of the benches need this.
namespace twinbench::schema {

using Keys = std::vector<ScenarioKey>;

inline constexpr Unit kPure{};
inline constexpr Unit kMm{"mm", units::mm}, kUm{"um", units::um}, kNm{"nm", units::nm};
inline constexpr Unit kDeg{"deg", units::deg}, kArcsec{"arcsec", units::arcsec}, kMrad{"mrad", units::mrad};
inline constexpr Unit kUrad{"urad", units::urad};
inline constexpr Unit kMillivolt{"mV", units::mV}, kVolt{"V"}, kMw{"mW", units::mW};
inline constexpr Unit kSecond{"s"}, kMicrosecond{"us", units::us}, kHz{"Hz"}, kKilohertz{"kHz", units::kHz};
inline constexpr Unit kMillikelvin{"mK", 1e-3}, kCelsius{"degC"};

inline constexpr double kHuge = 1e9;  // of pure numbers that need no closer bound

inline Bounds Within(double limit) {
  return {-limit, limit};
}
inline Bounds UpTo(double upper) {
  return {0.0, upper};
}
/// What is divided by: nothing that anybody builds is a million million times smaller than the largest.
inline Bounds Positive(double upper) {
  return {1e-12 * upper, upper};
}
inline Bounds Between(double lower, double upper) {
  return {lower, upper};
}

/// Adds keys to one table.
class Table {
 public:
  Table(Keys& keys, std::string name) : keys_(keys), name_(std::move(name)) {}

  void Add(const std::string& name, const Unit& unit, const Bounds& bounds, Field field,
           const std::string& meaning) {
    keys_.push_back({name_, name, unit, bounds, {}, field, meaning});
  }
  void Flag(const std::string& name, bool& field, const std::string& meaning) {
    keys_.push_back({name_, name, {}, {}, {}, &field, meaning});
  }
  void Text(const std::string& name, Field field, std::vector<std::string> choices, const std::string& meaning) {
    keys_.push_back({name_, name, {}, {}, std::move(choices), field, meaning});
  }
  /// The name of a file that must be readable once it is given.
  void File(const std::string& name, std::string& path, const std::string& meaning) {
    keys_.push_back({name_, name, {}, {}, {}, &path, meaning, true});
  }

  /// A list of tables, at least one.
  /// @param add_keys  Puts the keys of one into a table without a name.
  template <class Record, class AddKeys>
  void Records(const std::string& name, std::vector<Record>& records, AddKeys add_keys,
               const std::string& meaning) {
    const auto keys_of = [add_keys](Record& record) {
      Keys keys;
      Table table(keys, "");
      add_keys(table, record);
      return keys;
    };
    const auto example = std::make_shared<Record>();
    const RecordList list{[&records] { return records.size(); },
                          [&records](std::size_t count) { records.assign(count, Record{}); },
                          [&records, keys_of](std::size_t i) { return keys_of(records.at(i)); },
                          [example, keys_of] { return keys_of(*example); }};
    keys_.push_back({name_, name, {}, {}, {}, list, meaning});
  }

 private:
  Keys& keys_;
  std::string name_;
};

template <std::size_t kCount>
std::span<double> List(std::array<double, kCount>& array) {
  return {array.data(), kCount};
}
template <int kRows>
std::span<double> List(Eigen::Matrix<double, kRows, 1>& vector) {
  return {vector.data(), static_cast<std::size_t>(kRows)};
}

/// Errors and motion of a rotary table.
/// @param frame      In which the table's errors are given.
/// @param is_driven  To any angle, so that a compensation can be commanded; not by whole teeth.
void AddTable(Keys& keys, const std::string& table, const std::string& frame, TableSettings& s,
              bool is_driven = true);
void AddEnvironment(Keys& keys, EnvironmentSettings& s);
void AddAutocollimator(Keys& keys, AutocollimatorSettings& s);

}  // namespace twinbench::schema
