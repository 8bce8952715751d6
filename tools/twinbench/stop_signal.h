#pragma once

namespace twinbench::tools {

/// From now on Ctrl-C, SIGTERM, SIGQUIT and a closed session (SIGHUP) do not end the program but are remembered, however
/// often they come; output that nobody reads any more (SIGPIPE) ends nothing either.
void ListenForStop();
/// Nothing can move any more: signals end the program again.
void ListenNoMore();
bool StopWasAsked();
/// The same as Ctrl-C after ListenForStop, from any thread.
void AskToStop();

}  // namespace twinbench::tools
