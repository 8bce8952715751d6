#pragma once

#include <string>

namespace twinbench::plausible {

struct Finding {
  bool fatal = false;  // no result from these readings can be trusted
  std::string line;    // what was seen and what it may mean
};

}  // namespace twinbench::plausible
