#pragma once

#include <string>
#include <vector>

#include "runner/cli/cli_graph.h"
#include "runner/cli/cli_sweep.h"
#include "runner/farm/arrays.h"
#include "runner/scheduler/slurm_script.h"
#include "runner/terminal/command.h"

namespace terrazzo {

/// The options of `submit`.
struct SubmitFlags : GraphFlags {
  SweepFlags variations;
  std::vector<std::string> only;
  std::string cache, openjd, memory, program;
  bool print = false, status = false, cancel = false, wait = false, json = false, keep_going = false;
  int retries = 2;
  ArrayOptions arrays;
  SlurmOptions slurm;
};

void add_submit_flags(Command& command, SubmitFlags& flags);

}  // namespace terrazzo
