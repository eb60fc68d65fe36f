#pragma once

namespace terrazzo {

/// The program. Exit codes: 0 done, 1 a node failed, 2 bad usage or an invalid graph, 130 cancelled.
int run_command_line(int argc, const char* const* argv);

}  // namespace terrazzo
