#include "twin/report/spoken_keys.h"

#include <array>
#include <string_view>
#include <utility>

namespace twinbench::report {
namespace {

/// By the first word of the key.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kSpoken = {
    {{"equation_5", "equation 5 of the paper"},
     {"multitooth", "multi-tooth table"},
     {"standard", "errors of the reference standard"},
     {"roll", "roll of the autocollimator"}}};

}  // namespace

std::string WithWords(const std::string& key) {
  for (const auto& [first, words] : kSpoken)
    if (key.substr(0, key.find('.')) == first) return std::string(words) + " (" + key + ")";
  return key;
}

}  // namespace twinbench::report
