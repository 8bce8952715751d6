#pragma once

#include <string>
#include <vector>

/// The causes that a scenario can switch on and a diagnosis can name. The name of an effect is unique on its bench.
namespace twinbench {

/// What a parameter changes of the scenario where all that it does is that a number of the bench is another one.
struct KeyChange {
  enum class How { kAdd, kMultiply, kDivide };  // the parameter; or by 1 + it
  std::string key;          // "@.roll_mrad": @ is the effect's place, [@] the entry of a list with its place's number
  How how = How::kAdd;
  double share = 1.0;       // of the parameter, where it is added
  std::vector<std::string> only_at = {};  // the places where it does so; empty: at all
};

/// One parameter of an effect. In a scenario its key is `name` + "_" + `unit` ("roll_mrad"; just `name` if the unit
/// is "1"); inside it is SI.
struct EffectParameter {
  std::string name;
  std::string unit;   // "1", "mrad", "arcsec", "um", "nm", "s", "Hz", "per_m2", "nm_per_K", ...
  double to_SI;       // factor from `unit` to SI
  double default_SI;  // plausible size, used when the block leaves the key out
  double lower_SI, upper_SI;
  std::string meaning;
  std::vector<std::string> only_at = {};  // the places it belongs to; empty: to all
  std::vector<KeyChange> changes = {};

  /// The same parameter, which changes a key. @param key, share, places  As in KeyChange.
  EffectParameter Adds(const std::string& key, double share = 1.0, const std::vector<std::string>& places = {}) const;
  EffectParameter Multiplies(const std::string& key) const;
  EffectParameter Divides(const std::string& key) const;

  std::string Key() const { return unit == "1" ? name : name + "_" + unit; }
  std::string UncertaintyKey() const { return "u_" + Key(); }  // of a value that a diagnosis fitted
  bool BelongsTo(const std::string& place) const;
};

/// One cause of formats.md, with the places where it can act.
struct EffectEntry {
  std::string name;
  std::string title;                // one line, what it is
  std::vector<std::string> places;  // allowed `where`; empty: none may be given
  std::vector<EffectParameter> parameters;
  std::string default_place = {};  // if `where` is left out; empty: it must be given (where there are places)

  /// How large a parameter plausibly is [SI]: its default. One that is 0 unless stated (the sine of a wave) is as
  /// large as the others of its unit, or a tenth of its bounds.
  double Plausible(const EffectParameter& parameter) const;

  /// Whether all that it does is to change keys of the scenario.
  bool ChangesKeysAlone() const;
};

/// Every effect of a bench, in the order of formats.md.
/// @throws InputError if there is no such bench.
const std::vector<EffectEntry>& EffectCatalogue(const std::string& bench);

/// @return the entry, or nullptr.
const EffectEntry* FindEffect(const std::string& name, const std::string& bench);

}  // namespace twinbench
