#include "runner/cli/farm/submit_flags.h"

namespace terrazzo {

namespace {

void add_choices(Command& command, SubmitFlags& flags) {
  command.add_flag("--print", &flags.print, "Print the scripts that would be submitted; write and submit nothing");
  command
      .add_option("--openjd", &flags.openjd,
                  "Write an Open Job Description template instead, for Deadline Cloud and others")
      .takes("FILE.json")
      .not_with("--print");
  command.add_flag("--status", &flags.status, "Show the progress of a job; without a name, list all jobs")
      .not_with("--print")
      .not_with("--openjd");
  command.add_flag("--cancel", &flags.cancel, "End a job's tasks")
      .not_with("--print")
      .not_with("--openjd")
      .not_with("--status");
  command
      .add_flag("--wait", &flags.wait,
                "Wait until the job is done; lost tasks are submitted again. Ctrl-C ends the waiting, not the job")
      .not_with("--print")
      .not_with("--openjd")
      .not_with("--cancel");
  command.add_flag("--json", &flags.json, "With --status: for programs").only_with("--status");
  command.add_option("--retries", &flags.retries, "With --wait: how often lost units are submitted again")
      .takes("N")
      .not_negative();
}

void add_demands(Command& command, SubmitFlags& flags) {
  command.add_option("--partition", &flags.slurm.partition, "Slurm's partition").takes("NAME");
  command.add_option("--account", &flags.slurm.account, "Whom Slurm charges").takes("NAME");
  command.add_option("--time", &flags.slurm.time, "Slurm's time limit of a task, such as 2:00:00").takes("TIME");
  command.add_option("--sbatch", &flags.slurm.more, "A further option of sbatch, such as --sbatch=--nice=100")
      .takes("OPTION")
      .repeated();
  command
      .add_option("--cores", &flags.arrays.cores,
                  "Cores of each task; if not given, as many as earlier ones of its kind have used")
      .takes("N")
      .from_to(1, 1024);
  command
      .add_option("--memory", &flags.memory,
                  "Memory of each task, such as 4G; if not given, as much as earlier ones of its kind have used")
      .takes("SIZE");
  command
      .add_option("--pack", &flags.arrays.pack_seconds,
                  "Short work is put into one task until it takes about this many seconds")
      .takes("SECONDS")
      .not_negative();
  command
      .add_option("--program", &flags.program,
                  "The path of terrazzo on the farm's machines, if it differs from this one")
      .takes("FILE");
}

}  // namespace

void add_submit_flags(Command& command, SubmitFlags& flags) {
  command.add_option("GRAPH", &flags.graph, "The graph file; or a job, with --status, --wait or --cancel")
      .takes("FILE.json");
  add_value_flags(command, flags);
  add_variation_flags(command, flags.variations);
  command.add_option("--only", &flags.only, "Make only this node and what it needs; may be given several times")
      .takes("NODE")
      .repeated();
  command.add_flag(
      "--keep-going", &flags.keep_going,
      "Leave out nodes that need an unreadable source, and submit the others; the exit code is 1 nevertheless");
  command
      .add_option("--cache", &flags.cache,
                  "Folder of the cache, which all machines must share; jobs are kept in its folder farm")
      .takes("DIR");
  add_choices(command, flags);
  add_demands(command, flags);
}

}  // namespace terrazzo
