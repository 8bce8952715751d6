#pragma once

namespace twinbench::tools {

/// The program from its command line to its exit code.
int Main(int argc, char** argv);

}  // namespace twinbench::tools
