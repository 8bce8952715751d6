#include "hw_bridge/serve/scpi_parameters.h"

#include <cmath>

#include "hw_bridge/serve/scpi_text.h"
#include "hw_bridge/serve/words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kNotANumber = "9.91E37";

}  // namespace

std::string PrintScpi(double value_SI, double unit) {
  return std::isfinite(value_SI) ? PrintInUnit(value_SI, unit) : kNotANumber;
}

double ScpiNumber(const std::string& text, double unit) {
  const auto number = ParseInUnit(text, unit);
  if (!number) throw ScpiError{-120, ""};
  return *number;
}

long long ScpiWholeNumber(const std::string& text, long long least, long long most) {
  const auto number = ParseWholeNumber(text);
  if (!number) throw ScpiError{-120, ""};
  if (*number < least || *number > most) throw ScpiError{-222, ""};
  return *number;
}

bool ScpiSwitch(const std::string& text) {
  const std::string word = UpperCase(text);
  if (word == "ON" || word == "1") return true;
  if (word == "OFF" || word == "0") return false;
  throw ScpiError{-224, ""};
}

}  // namespace twinbench::hw
