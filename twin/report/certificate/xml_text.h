#pragma once

#include <string>
#include <vector>

namespace twinbench::certificate {

/// UTF-8 text as XML 1.0 allows it and the schema wants it (notEmptyStringType): no control characters, no blanks before and behind;
/// bytes that are no UTF-8 (an instrument may answer anything) become "?".
/// Markup stays what it is; whoever writes the document escapes it.
std::string XmlText(const std::string& text);

/// Every number so that it reads back to the same bits, separated by blanks.
std::string XmlNumbers(const std::vector<double>& values);

}  // namespace twinbench::certificate
