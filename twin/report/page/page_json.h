#pragma once

#include <string>
#include <string_view>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// The page as JSON, every number of it as it was in the files; not available is null.
std::string PageJson(const Page& page);

/// JSON that can stand in a script element of HTML: no text of a scenario can end the element or begin another.
std::string ForScriptElement(const std::string& json);

/// Text between tags.
std::string ForHtml(const std::string& text);

/// The page as one file: the program's own markup with the page's data in it.
/// @param markup  With the marks "<!--TITLE-->" and "<!--DATA-->" once each; what comes from a scenario is put in escaped.
std::string PageHtml(const Page& page, std::string_view markup);

}  // namespace twinbench::report
