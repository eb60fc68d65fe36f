#include <malloc.h>

#include "runner/cli/cli_commands.h"

int main(int argc, char** argv) {
  // Stages take buffers of some megabytes again and again. Kept rather than given back to the system each time, they
  // save a fiftieth of a run of one map.
  constexpr int kept = 64 << 20, mapped_from = 16 << 20;
  mallopt(M_TRIM_THRESHOLD, kept);
  mallopt(M_MMAP_THRESHOLD, mapped_from);
  return terrazzo::run_command_line(argc, argv);
}
