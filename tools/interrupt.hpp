// Signals end a run at the next opportunity, in order, with what it has computed.
#pragma once

namespace cradle::tools {

/// From now on SIGINT, SIGTERM and SIGUSR1 are noted instead of ending the program.
void note_signals();

/// The signal that arrived since, or 0.
int noted_signal();

}  // namespace cradle::tools
