#include "runner/cli/submit_flags.h"

#include <CLI/CLI.hpp>

namespace terrazzo {

namespace {

void add_choices(CLI::App& command, SubmitFlags& flags) {
  CLI::Option* print =
      command.add_flag("--print", flags.print, "Print the scripts that would be handed over; write and submit nothing");
  CLI::Option* openjd = command.add_option(
      "--openjd", flags.openjd, "Write an Open Job Description template instead, for Deadline Cloud and others");
  openjd->type_name("FILE.json")->excludes(print);
  CLI::Option* status =
      command.add_flag("--status", flags.status, "Say how far a job is; without a name, list all jobs");
  CLI::Option* cancel = command.add_flag("--cancel", flags.cancel, "End a job's tasks");
  CLI::Option* wait = command.add_flag(
      "--wait", flags.wait,
      "Wait until the job is done; tasks that get lost are handed over again. Ctrl-C ends the waiting, not the job");
  for (CLI::Option* o : {status, cancel, wait}) o->excludes(print)->excludes(openjd);
  cancel->excludes(status)->excludes(wait);
  command.add_flag("--json", flags.json, "With --status: for programs")->needs(status);
  command.add_option("--retries", flags.retries, "With --wait: how often what got lost is handed over again")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
}

void add_demands(CLI::App& command, SubmitFlags& flags) {
  command.add_option("--partition", flags.slurm.partition, "Slurm's partition")->type_name("NAME");
  command.add_option("--account", flags.slurm.account, "Whom Slurm charges")->type_name("NAME");
  command.add_option("--time", flags.slurm.time, "Slurm's time limit of a task, such as 2:00:00")->type_name("TIME");
  command.add_option("--sbatch", flags.slurm.more, "A further option of sbatch, such as --sbatch=--nice=100")
      ->type_name("OPTION")
      ->take_all()
      ->expected(1);
  command
      .add_option("--cores", flags.arrays.cores,
                  "Cores of each task; if not given, as many as earlier ones of its kind have used")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command.add_option("--memory", flags.memory, "Memory of each task, such as 4G; if not given, likewise")
      ->type_name("SIZE");
  command
      .add_option("--pack", flags.arrays.pack_seconds,
                  "Short work is put into one task until it takes about this many seconds")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--program", flags.program, "Where terrazzo is on the farm's machines, if not where it is here")
      ->type_name("FILE");
}

}  // namespace

void add_submit_flags(CLI::App& command, SubmitFlags& flags) {
  command.add_option("GRAPH", flags.graph, "The graph file; or a job, with --status, --wait or --cancel")
      ->type_name("FILE.json");
  add_value_flags(command, flags);
  add_variation_flags(command, flags.variations);
  command.add_option("--only", flags.only, "Make only this node and what it needs; may be given several times")
      ->type_name("NODE")
      ->take_all()
      ->expected(1);
  command.add_flag("--keep-going", flags.keep_going,
                   "Leave out what needs a source that cannot be read, and submit all else; the exit code is 1 all the "
                   "same");
  command
      .add_option("--cache", flags.cache,
                  "Folder of the cache, which all machines must share; jobs are kept in its folder farm")
      ->type_name("DIR");
  add_choices(command, flags);
  add_demands(command, flags);
}

}  // namespace terrazzo
