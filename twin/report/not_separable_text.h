#pragma once

#include <string>
#include <vector>

namespace twinbench::report {

/// A paragraph each; orders that follow each other and differ by their number alone are one: "both tables, orders 1-3, 9: the heads see them alike".
/// @param all  What, and why (plan::Outlook::not_separable).
std::string NotSeparableText(const std::vector<std::string>& all, std::size_t width);

}  // namespace twinbench::report
