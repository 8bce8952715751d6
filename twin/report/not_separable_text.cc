#include "twin/report/not_separable_text.h"

#include <regex>

#include "twin/report/compensation_text.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

/// "both tables, order 12: seen alike": what stands before and behind the order.
struct Lost {
  std::string before, behind;
  std::vector<int> orders;  // none: `before` is all

  bool IsLike(const Lost& other) const { return !orders.empty() && !other.orders.empty() && before == other.before && behind == other.behind; }
  std::string Words() const { return orders.empty() ? before : before + OrderRanges(orders) + behind; }
};

Lost LostOf(const std::string& words) {
  static const std::regex pattern(R"((.*, |)order (\d{1,6})(:.*))");
  std::smatch match;
  if (!std::regex_match(words, match, pattern)) return {words, "", {}};
  return {match[1], match[3], {std::stoi(match[2])}};
}

}  // namespace

std::string NotSeparableText(const std::vector<std::string>& all, std::size_t width) {
  std::vector<Lost> groups;
  for (const std::string& words : all) {
    const Lost lost = LostOf(words);
    if (!groups.empty() && groups.back().IsLike(lost))
      groups.back().orders.push_back(lost.orders.front());
    else
      groups.push_back(lost);
  }
  std::string text;
  for (const Lost& group : groups) text += Paragraph("Not separable: ", group.Words(), 4, width);
  return text;
}

}  // namespace twinbench::report
