#pragma once

namespace twinbench::tools {

/// From now on Ctrl-C, SIGTERM, SIGQUIT and a closed session (SIGHUP) do not end the program but are remembered, however
/// often they come; output that nobody reads any more (SIGPIPE) ends nothing either.
/// @param said  On stderr at the first of them; none: nothing.
void ListenForStop(const char* said = nullptr);
/// For a bench whose axes move.
inline constexpr const char* kStopIsHeard =
    "\nstop is heard: what moves is told to stop. If anything goes on that must not, USE THE EMERGENCY STOP.\n";
/// Nothing can move any more: signals end the program again.
void ListenNoMore();
bool StopWasAsked();
/// The same as Ctrl-C after ListenForStop, from any thread.
void AskToStop();

}  // namespace twinbench::tools
