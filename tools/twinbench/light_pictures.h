#pragma once

#include <string>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::tools {

/// The irradiance maps (OpenEXR) of a folder, each cut to where there is light and made coarser until it is small enough for a page.
/// @return none if there is no such folder.
/// @throws std::runtime_error that names a file that cannot be read.
std::vector<report::PageImage> LightPictures(const std::string& folder);

}  // namespace twinbench::tools
