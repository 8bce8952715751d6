#pragma once

namespace twinbench::tools {

/// From now on Ctrl-C and SIGTERM do not end the program but are remembered; a second Ctrl-C ends it.
void ListenForStop();
bool StopWasAsked();

}  // namespace twinbench::tools
