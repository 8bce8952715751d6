#include "twin/campaign/vary_block.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario_values.h"

namespace twinbench::campaign {
namespace {

constexpr const char* kForms =
    "values = [...], or from, to and n, or distribution = \"normal\" (mean, sd), \"uniform\" (lower, upper), "
    "\"triangular\" (lower, mode, upper) or \"log_uniform\" (lower, upper)";

TomlValue Need(const TomlValue& block, const std::string& key) {
  if (const auto value = Inside(block, key)) return *value;
  throw InputError(block.Where(), "the [[vary]] block has no " + key, kForms);
}

double Number(const TomlValue& block, const std::string& key) {
  return ReadNumber(Need(block, key), key, {}, {});
}

bool Flag(const TomlValue& value, const std::string& key) {
  if (const auto flag = value.node().value_exact<bool>()) return *flag;
  throw InputError(value.Where(), key + " is " + value.Found(), "true or false");
}

/// The block may have `key`, `hidden` and these.
void AllowOnly(const TomlValue& block, const std::vector<std::string>& names) {
  std::vector<KnownKey> known = {{"", "key", ""}, {"", "hidden", ""}};
  for (const std::string& name : names) known.push_back({"", name, ""});
  RefuseUnknown(block, "vary", known);
}

void Ascend(const TomlValue& block, const std::string& lower, const std::string& upper) {
  const double a = Number(block, lower), b = Number(block, upper);
  if (a < b) return;
  throw InputError(Need(block, upper).Where(), fmt::format("{} is {} and {} is {}", lower, a, upper, b),
                   fmt::format("{} above {}", upper, lower));
}

/// A value as it stands after "key=": numbers as they were written; text without its quotes, so that whole blocks
/// can be told: '[{name = "psd_roll", ...}]'.
std::string ValueText(const TomlValue& value) {
  if (const auto text = value.node().value_exact<std::string>()) return *text;
  if (const auto flag = value.node().value_exact<bool>()) return *flag ? "true" : "false";
  return value.NumberText("values", "a number, text, true or false");
}

Grid ReadValues(const TomlValue& block) {
  AllowOnly(block, {"values"});
  const TomlValue values = Need(block, "values");
  const toml::array* list = values.node().as_array();
  if (!list || list->empty())
    throw InputError(values.Where(), list ? "values is empty" : "values is " + values.Found(),
                     "a list of numbers or texts");
  Grid grid;
  for (const toml::node& node : *list) grid.values.push_back(ValueText(values.With(node)));
  return grid;
}

Grid ReadRange(const TomlValue& block) {
  AllowOnly(block, {"from", "to", "n"});
  const double from = Number(block, "from"), to = Number(block, "to");
  const TomlValue count = Need(block, "n");
  const auto n = count.node().value_exact<std::int64_t>();
  if (!n || *n < 2 || *n > 1000000)
    throw InputError(count.Where(), "n is " + count.Found(), "a whole number from 2 to 1000000");
  Grid grid;
  for (std::int64_t i = 0; i < *n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(*n - 1);
    grid.values.push_back(PrintInUnit(from + share * (to - from), 1.0));
  }
  return grid;
}

Distribution ReadNormal(const TomlValue& block) {
  AllowOnly(block, {"distribution", "mean", "sd"});
  Bounds positive;
  positive.lower = 0.0;
  positive.above_lower = true;
  return Normal{Number(block, "mean"), ReadNumber(Need(block, "sd"), "sd", {}, positive)};
}

Distribution ReadUniform(const TomlValue& block) {
  AllowOnly(block, {"distribution", "lower", "upper"});
  Ascend(block, "lower", "upper");
  return Uniform{Number(block, "lower"), Number(block, "upper")};
}

Distribution ReadTriangular(const TomlValue& block) {
  AllowOnly(block, {"distribution", "lower", "mode", "upper"});
  Ascend(block, "lower", "upper");
  Bounds between;
  between.lower = Number(block, "lower");
  between.upper = Number(block, "upper");
  return Triangular{between.lower, ReadNumber(Need(block, "mode"), "mode", {}, between), between.upper};
}

Distribution ReadLogUniform(const TomlValue& block) {
  AllowOnly(block, {"distribution", "lower", "upper"});
  Ascend(block, "lower", "upper");
  Bounds positive;
  positive.lower = 0.0;
  positive.above_lower = true;
  return LogUniform{ReadNumber(Need(block, "lower"), "lower", {}, positive), Number(block, "upper")};
}

Distribution ReadDistribution(const TomlValue& block) {
  const std::string name =
      ReadText(Need(block, "distribution"), "distribution", {"normal", "uniform", "triangular", "log_uniform"});
  if (name == "normal") return ReadNormal(block);
  if (name == "uniform") return ReadUniform(block);
  return name == "triangular" ? ReadTriangular(block) : ReadLogUniform(block);
}

}  // namespace

Variation ReadVariation(const TomlValue& block) {
  if (!block.node().is_table()) throw InputError(block.Where(), "vary holds " + block.Found(), "[[vary]] blocks");
  Variation variation;
  variation.location = Need(block, "key").Where();
  variation.key = ReadText(Need(block, "key"), "key", {});
  if (const auto hidden = Inside(block, "hidden")) variation.hidden = Flag(*hidden, "hidden");
  if (Inside(block, "values")) {
    variation.how = ReadValues(block);
  } else if (Inside(block, "from")) {
    variation.how = ReadRange(block);
  } else if (Inside(block, "distribution")) {
    variation.how = ReadDistribution(block);
  } else {
    throw InputError(block.Where(), "the [[vary]] block of " + variation.key + " says no values", kForms);
  }
  return variation;
}

}  // namespace twinbench::campaign
