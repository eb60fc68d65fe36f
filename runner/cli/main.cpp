#include "runner/cli/cli_commands.h"

int main(int argc, char** argv) {
  return terrazzo::run_command_line(argc, argv);
}
