#include "twin/report/certificate/not_told_apart.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "twin/report/page/named_numbers.h"
#include "twin/report/page/walk.h"

namespace twinbench::certificate {
namespace {

std::vector<std::string> SplitAt(const std::string& text, const std::string& by) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at = text.find(by); at != std::string::npos; at = text.find(by, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + by.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

bool IsQuantity(const std::string& word) {
  return word.size() == 2 && (word[0] == 'd' || word[0] == 'e') && word[1] >= 'x' && word[1] <= 'z';
}

/// "target ex,ey": the table, and its motions.
void ReadOne(const std::string& words, NotToldApart& lost) {
  const std::size_t space = words.rfind(' ');
  const std::vector<std::string> last = SplitAt(space == std::string::npos ? "" : words.substr(space + 1), ",");
  const bool has_quantities = std::ranges::all_of(last, IsQuantity);
  if (has_quantities) lost.quantities = last;
  lost.subjects = {has_quantities ? words.substr(0, space) : words};
}

NotToldApart Read(const std::string& what, const std::string& why) {
  static const std::regex ends_in_order("(.*?),? ?order ([+-]?[0-9]+)");
  NotToldApart lost;
  lost.what = what, lost.why = why;
  std::smatch match;
  std::string words = what;
  if (std::regex_match(what, match, ends_in_order)) {
    words = match[1];
    lost.order = std::abs(std::stoi(match[2]));
  }
  const std::vector<std::string> several = SplitAt(words, " and ");
  if (several.size() > 1) lost.subjects = several;
  else if (!words.empty()) ReadOne(words, lost);
  return lost;
}

}  // namespace

bool NotToldApart::Concerns(const std::string& subject, const std::string& quantity) const {
  const auto has = [](const std::vector<std::string>& list, const std::string& one) {
    return list.empty() || std::ranges::find(list, one) != list.end();
  };
  return has(subjects, subject) && has(quantities, quantity);
}

std::vector<NotToldApart> AllNotToldApart(const nlohmann::json& results) {
  std::vector<NotToldApart> all;
  report::ForEachObject(results, [&all](const std::string&, const nlohmann::json& object) {
    if (!object.contains("not_separable") || !object.at("not_separable").is_array()) return;
    for (const nlohmann::json& entry : object.at("not_separable")) {
      const std::string what = entry.is_string() ? entry.get<std::string>() : report::TextAt(entry, "what");
      if (std::ranges::find(all, what, &NotToldApart::what) == all.end()) all.push_back(Read(what, report::TextAt(entry, "why")));
    }
  });
  return all;
}

}  // namespace twinbench::certificate
