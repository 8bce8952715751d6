#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// A figure as a picture to be passed on: light, with title, axes, legend and bands, as the page opens it. Needs no browser.
std::string SvgOf(const Figure& figure);

/// The pictures of a page by the name of their files, "errors-target-ez.svg": every figure, of a choice the first.
std::vector<std::pair<std::string, std::string>> SvgPictures(const Page& page);

}  // namespace twinbench::report
