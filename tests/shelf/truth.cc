#include "tests/shelf/truth.h"

#include <fstream>

#include "twin/core/errors.h"

namespace twinbench::shelf {
namespace {

using nlohmann::json;

/// A key that is misspelt would quietly ask for nothing.
void CheckKeys(const json& object, const std::vector<std::string>& known, const std::string& where) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end())
      throw InputError(where, "has a key \"" + key + "\"", "one of truth.h");
  }
}

Expected ExpectedOf(const json& cause, const std::string& where) {
  CheckKeys(
      cause,
      {"effects", "words", "order", "parameter", "size", "unit", "others", "at", "over_s", "share", "approximate"},
      where);
  Expected expected;
  expected.effects = cause.value("effects", expected.effects);
  expected.words = cause.value("words", expected.words);
  expected.order = cause.value("order", kNaN);
  expected.parameter = cause.value("parameter", "");
  expected.size = cause.value("size", kNaN);
  expected.unit = cause.value("unit", "");
  expected.others = cause.value("others", expected.others);
  expected.at_deg = cause.value("at", kNaN);
  expected.over_s = cause.value("over_s", kNaN);
  expected.share = cause.value("share", 0.0);
  expected.approximate = cause.value("approximate", false);
  return expected;
}

void AddBesides(const json& besides, const std::string& where, Truth& truth) {
  CheckKeys(besides, {"orders", "any_order_below", "effects", "words", "rest"}, where);
  truth.orders = besides.value("orders", truth.orders);
  truth.any_order_below_deg = besides.value("any_order_below", 0.0);
  truth.effects = besides.value("effects", truth.effects);
  truth.words = besides.value("words", truth.words);
  truth.has_rest = besides.value("rest", false);
}

}  // namespace

Truth ReadTruth(const std::string& path, const std::string& name) {
  std::ifstream in(path);
  const json all = json::parse(in, nullptr, false);
  if (!all.is_object() || !all.contains(name))
    throw InputError(path, "has no case " + name, "every file of the folder");
  const json& one = all.at(name);
  const std::string where = path + ", " + name;
  CheckKeys(one, {"causes", "besides", "nothing_else"}, where);
  Truth truth;
  for (const json& cause : one.at("causes")) truth.causes.push_back(ExpectedOf(cause, where));
  if (one.contains("besides")) AddBesides(one.at("besides"), where, truth);
  truth.nothing_else = one.value("nothing_else", false);
  return truth;
}

}  // namespace twinbench::shelf
