// Signals end a run at the next opportunity, in order, with what it has computed.
#pragma once

namespace cradle::tools {

/// From now on SIGINT, SIGTERM and SIGUSR1 are noted instead of ending the program.
void note_signals();

/// The signal that arrived since, or 0. May be called from any thread.
int noted_signal();

/// As if it had arrived here: it did so at another process of the same job.
void note_signal(int signal);

}  // namespace cradle::tools
