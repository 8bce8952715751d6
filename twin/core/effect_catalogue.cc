#include "twin/core/effect_catalogue.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/effect_entries.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

using units::arcsec;
using units::deg;
using units::mm;
using units::mrad;
using units::mV;
using units::nm;
using units::um;
using units::urad;

double FactorOf(const std::string& unit) {
  const std::map<std::string, double> factors = {{"1", 1.0},
                                                 {"mm", mm},
                                                 {"um", um},
                                                 {"nm", nm},
                                                 {"mrad", mrad},
                                                 {"arcsec", arcsec},
                                                 {"deg", deg},
                                                 {"mV", mV},
                                                 {"V", 1.0},
                                                 {"s", 1.0},
                                                 {"s2", 1.0},
                                                 {"Hz", 1.0},
                                                 {"per_m2", 1.0},
                                                 {"nm_per_K", nm},
                                                 {"arcsec_per_K", arcsec},
                                                 {"arcsec_per_h", arcsec / units::hour},
                                                 {"urad_per_h", urad / units::hour},
                                                 {"deg_per_h", deg / units::hour},
                                                 {"deg_per_K", deg},
                                                 {"deg_per_s", deg},
                                                 {"K", 1.0},
                                                 {"um_m", um},
                                                 {"um_K", um},
                                                 {"nA", 1e-9},
                                                 {"um_m_K", um},
                                                 {"per_mm2", 1.0 / (mm * mm)},
                                                 {"rad", 1.0},
                                                 {"px", 1.0},
                                                 {"per_px", 1.0}};
  const auto found = factors.find(unit);
  Require(found != factors.end(), "a parameter of the effect catalogue has an unknown unit");
  return found->second;
}

}  // namespace

EffectParameter Parameter(const std::string& name, const std::string& unit, double value, double lower,
                          double upper, const std::string& meaning, std::vector<std::string> only_at) {
  const double f = FactorOf(unit);
  return {name, unit, f, value * f, lower * f, upper * f, meaning, std::move(only_at)};
}

EffectParameter Signed(const std::string& name, const std::string& unit, double value, double limit,
                       const std::string& meaning, std::vector<std::string> only_at) {
  return Parameter(name, unit, value, -limit, limit, meaning, std::move(only_at));
}

EffectParameter EffectParameter::Adds(const std::string& key, double share,
                                      const std::vector<std::string>& places) const {
  EffectParameter with = *this;
  with.changes.push_back({key, KeyChange::How::kAdd, share, places});
  return with;
}

EffectParameter EffectParameter::Multiplies(const std::string& key) const {
  EffectParameter with = *this;
  with.changes.push_back({key, KeyChange::How::kMultiply});
  return with;
}

EffectParameter EffectParameter::Divides(const std::string& key) const {
  EffectParameter with = *this;
  with.changes.push_back({key, KeyChange::How::kDivide});
  return with;
}

bool EffectParameter::BelongsTo(const std::string& place) const {
  return only_at.empty() || std::find(only_at.begin(), only_at.end(), place) != only_at.end();
}

double EffectEntry::Plausible(const EffectParameter& parameter) const {
  constexpr double kShareOfBounds = 0.1;
  double plausible = std::abs(parameter.default_SI);
  for (const EffectParameter& other : parameters) {
    if (plausible == 0.0 && other.unit == parameter.unit) plausible = std::abs(other.default_SI);
  }
  return plausible > 0.0 ? plausible
                         : kShareOfBounds * std::max(std::abs(parameter.lower_SI), std::abs(parameter.upper_SI));
}

bool EffectEntry::ChangesKeysAlone() const {
  return !parameters.empty() &&
         std::ranges::all_of(parameters, [](const EffectParameter& p) { return !p.changes.empty(); });
}

const std::vector<EffectEntry>& EffectCatalogue(const std::string& bench) {
  return FormatOf(bench).effects;
}

const EffectEntry* FindEffect(const std::string& name, const std::string& bench) {
  for (const EffectEntry& entry : EffectCatalogue(bench)) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace twinbench
