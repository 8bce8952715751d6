#pragma once

#include <string_view>

namespace twinbench::web {

/// The page's markup with its script and style, where title and data are to be put in (twin/report/page/page_json.h). Empty
/// if the program was built without (TWINBENCH_REPORT=OFF, or npm was not there).
std::string_view PageMarkup();

/// The page that shows a measurement while it goes on (tools/live/server.h), whole. Empty if the program was built without.
std::string_view LiveMarkup();

}  // namespace twinbench::web
