#include "runner/scheduler/slurm.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "runner/scheduler/openjd.h"
#include "runner/scheduler/run_tool.h"
#include "tests/runner/farm/tools.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

TaskArray array_of(std::vector<std::vector<std::string>> tasks) {
  TaskArray a{.label = "layout", .tasks = std::move(tasks)};
  a.cores = 3;
  a.memory = uint64_t{500} << 20;
  return a;
}

}  // namespace

TEST_CASE("a tool's output, its messages and its end") {
  CHECK(run_tool({"sh", "-c", "echo out; echo err >&2; exit 3"}).exit_code == 3);
  CHECK(run_tool({"sh", "-c", "echo out; echo err >&2; exit 3"}).out == "out\n");
  CHECK(run_tool({"sh", "-c", "echo out; echo err >&2; exit 3"}).err == "err\n");
  CHECK(run_tool({"sh", "-c", "kill -9 $$"}).exit_code == 128 + 9);
  CHECK(run_tool({"no-such-tool"}).exit_code == 127);
  // More than a pipe holds, on both.
  const ToolResult much = run_tool({"sh", "-c", "seq 100000 >&2; seq 100000"});
  CHECK(much.out.size() == much.err.size());
  CHECK(much.out.size() > 500000);
  // Only the variables that pass.
  const Environment one("TERRAZZO_TEST_ONE", "1"), two("TERRAZZO_TEST_TWO", "2");
  CHECK(run_tool({"sh", "-c", "echo $TERRAZZO_TEST_ONE$TERRAZZO_TEST_TWO"}).out == "12\n");
  CHECK(run_tool({"sh", "-c", "echo $TERRAZZO_TEST_ONE$TERRAZZO_TEST_TWO"}, [](std::string_view name) {
          return name != "TERRAZZO_TEST_ONE";
        }).out == "2\n");
}

TEST_CASE("a script asks for what its tasks need, and calls the program with its task") {
  FarmJob job;
  job.name = "walls-1";
  job.graph = "/projects/walls.json";
  SlurmOptions options{.partition = "night", .account = "", .time = "1:00:00", .program = "/opt/terra zzo"};
  options.more = {"--nice=5"};
  const TaskArray array = array_of({{"a"}, {"b", "c"}});
  const std::string script = slurm_script(job, array, "/cache/it's/walls-1", {"7", "8"}, options);
  for (const char* line :
       {"#SBATCH --job-name=walls-1\n", "#SBATCH --array=0-1\n", "--cpus-per-task=3\n", "--mem=500M\n",
        "--dependency=afterany:7:8\n", "--partition=night\n", "--time=1:00:00\n", "--nice=5\n", "--requeue"})
    CHECK_MESSAGE(script.find(line) != script.npos, line);
  CHECK(script.find("--account") == script.npos);
  CHECK(script.find("exec '/opt/terra zzo' task '/cache/it'\\''s/walls-1' --array " + array.id().hex() +
                    " --index \"$SLURM_ARRAY_TASK_ID\"") != script.npos);
  const TemporaryFolder folder;
  write_text(folder.path() / "script.sh", script);
  CHECK(run_tool({"bash", "-n", (folder.path() / "script.sh").string()}).ok());
}

TEST_CASE("Slurm finds no patterns in the path of the logs") {
  FarmJob job;
  job.name = "walls-1";
  job.graph = "/projects/two\nlines.json";
  const TaskArray array = array_of({{"a"}});
  const std::string script =
      slurm_script(job, array, "/a%20b/100%/%j/it's x/walls-1", {}, {.program = "/bin/terrazzo"});
  CHECK_MESSAGE(script.find("#SBATCH --output='/a%%20b/100%%/%%j/it'\\''s x/walls-1/logs/" +
                            array.id().hex().substr(0, 12) + ".%A_%a.log'\n") != script.npos,
                script);
  CHECK(script.find("task '/a%20b/100%/%j/it'\\''s x/walls-1' --array") != script.npos);
  // All options stand before the first line that is no comment.
  for (size_t at = 0; script.compare(at, 5, "exec ") != 0; at = script.find('\n', at) + 1) CHECK(script[at] == '#');

  const auto refused = [](const SlurmOptions& options,
                          const std::filesystem::path& jobs = "/cache/farm/jobs") -> std::string {
    try {
      check_slurm_options(options, jobs);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  CHECK(refused({}, "/a%20b/it's \"x\" #1/jobs").empty());
  for (const char* path : {"/back\\slash/jobs", "/two\nlines/jobs"})
    CHECK(refused({}, path).find("--cache") != std::string::npos);
  CHECK(refused({.partition = "a\n#SBATCH --wait"}).find("--partition: expected one line") == 0);
}

TEST_CASE("options of sbatch that would break a submission are refused with the reason") {
  const auto refused = [](const std::string& option) -> std::string {
    try {
      check_slurm_options({.more = {option}}, "/cache/farm/jobs");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  for (const char* option :
       {"--job-name=x", "-Jx", "-J x", "--job-n=x", "--array=0-9", "-a", "--nice=5 --array=1", "--wait", "-W",
        "--comment=x", "--clusters=other", "-M other", "--test-only", "--wrap=ls"}) {
    CAPTURE(option);
    CHECK(refused(option).find("cannot be set: ") != std::string::npos);
  }
  CHECK(refused("--clusters=x").find("SLURM_CONF") != std::string::npos);
  CHECK(refused("nice=5").find("expected an option of sbatch") != std::string::npos);
  CHECK(refused("--nice=5\n#SBATCH --wait").find("expected an option of sbatch") != std::string::npos);
  for (const char* option : {"--nice=5", "--wait-all-nodes=1", "--qos=long", "-A project", "--mem-per-cpu=1G", "-w n1",
                             "--constraint=a|b", "--no-requeue", "--exclusive", "--export=NONE", "-C avx2"}) {
    CAPTURE(option);
    CHECK(refused(option).empty());
  }
}

TEST_CASE("Slurm's tools get none of the user's settings, but what leads to the cluster") {
  const Tools tools;
  std::vector<std::unique_ptr<Environment>> settings;
  for (const char* name :
       {"SQUEUE_STATES", "SQUEUE_FORMAT", "SBATCH_JOB_NAME", "SBATCH_WAIT", "SCANCEL_STATE", "SCONTROL_ALL",
        "SINFO_PARTITION", "SACCT_FORMAT", "SALLOC_QOS", "SRUN_DEBUG", "SPANK_X", "SLURM_CLUSTERS", "SLURM_EXIT_ERROR",
        "SLURM_JOB_ID", "SLURM_HINT", "_SLURM_SPANK_OPTION_x_y", "SLURM_JWT", "SLURM_CONF_SERVER", "SLURMY"})
    settings.push_back(std::make_unique<Environment>(name, "hostile"));
  const Environment configuration("SLURM_CONF", "/etc/passwd");
  const Environment other("TERRAZZO_TEST_ONE", "1");
  for (const char* name : {"scontrol", "squeue", "sbatch", "scancel", "sinfo"})
    tools.add(
        name,
        std::string("env | grep -E '^_?(SLURM|S(BATCH|QUEUE|CANCEL|CONTROL|INFO|ACCT|ALLOC|RUN|PANK)_|TERRAZZO_TEST)' "
                    "| cut -d= -f1 | LC_ALL=C sort > ") +
            name +
            ".env; case $0 in *scontrol) echo 'Slurmctld(primary) at farm is UP';; *sbatch) echo 12;; "
            "*sinfo) echo '4|16000|day*';; esac");
  const Slurm slurm;
  slurm.limits({});
  slurm.submit("x.sh", "job", "abc");
  slurm.cancel("job");
  for (const char* name : {"scontrol", "squeue", "sbatch", "scancel", "sinfo"}) {
    CAPTURE(name);
    CHECK(tools.text(std::string(name) + ".env") == "SLURM_CONF\nSLURM_CONF_SERVER\nSLURM_JWT\nTERRAZZO_TEST_ONE\n");
  }
  CHECK(ignored_slurm_settings() == std::vector<std::string>{"SBATCH_JOB_NAME", "SBATCH_WAIT", "SLURM_CLUSTERS"});
}

TEST_CASE("cancelling looks whether the tasks are gone") {
  const Tools tools;
  tools.add("scontrol", "echo 'Slurmctld(primary) at farm is UP'");
  tools.add("scancel", "echo >> cancelled");
  SUBCASE("soon, and one is still being cleaned up") {
    tools.add("squeue",
              "[ $(wc -l < cancelled) -gt 1 ] || printf '17_3|3|R|terrazzo:abc|n1|None|ann\\n'; "
              "printf '17_4|4|CG|terrazzo:abc|n1|None|ann\\n'");
    Slurm().cancel("walls-1");
    CHECK(tools.text("cancelled").size() == 2);
  }
  SUBCASE("never") {
    tools.add("scancel", "echo 'scancel: error: Kill job error on job id 17: Access/permission denied' >&2; exit 1");
    tools.add("squeue", "printf '17_3|3|PD|terrazzo:abc||None|bob\\n17_4|4|R|terrazzo:abc|n1|None|bob\\n'");
    CHECK_THROWS_WITH_AS(
        Slurm().cancel("walls-1"),
        doctest::Contains("2 tasks of walls-1 are still in the queue after 10 seconds: 17_3 of bob, 17_4 of "
                          "bob; scancel: scancel: error: Kill job error on job id 17: Access/permission "
                          "denied"),
        Error);
  }
}

TEST_CASE("what is in the queue") {
  const Tools tools;
  tools.add("scontrol", "echo 'Slurmctld(primary) at farm is UP'");
  tools.add("squeue",
            "echo \"$@\" > asked; printf '17_3|3|R|terrazzo:abc|n1|None|ann\\n17_4|4|PD|terrazzo:abc||Resources|ann\\n"
            "9|N/A|R|other|n2|None|ann\\n'");
  const auto tasks = Slurm().queued("walls-1");
  CHECK(tools.text("asked").find("--name=walls-1") != std::string::npos);
  CHECK(tools.text("asked").find("--all") != std::string::npos);  // hidden partitions
  REQUIRE(tasks.size() == 2);
  CHECK(tasks[0].id == "17_3");
  CHECK(tasks[0].array == "abc");
  CHECK(tasks[0].index == 3);
  CHECK(tasks[0].is_running);
  CHECK(tasks[0].reason == "n1");
  CHECK_FALSE(tasks[1].is_running);
  CHECK(tasks[1].reason == "Resources");
}

TEST_CASE("a controller that is busy is asked again; what it has taken is not handed over twice") {
  const Tools tools;
  tools.add("scontrol", "echo 'Slurmctld(primary) at farm is UP'");
  std::vector<std::string> told;
  const Slurm slurm([&](const std::string& text) { told.push_back(text); });
  SUBCASE("busy") {
    tools.add("sbatch",
              "echo >> count; [ $(wc -l < count) -gt 1 ] || { echo 'sbatch: error: Socket timed out' >&2; exit 1; }; "
              "echo '12;cluster'");
    tools.add("squeue", "true");
    CHECK(slurm.submit("x.sh", "job", "abc") == "12");
    CHECK(told.size() == 1);
  }
  SUBCASE("its answer got lost") {
    tools.add("sbatch", "echo >> count; echo 'sbatch: error: Socket timed out' >&2; exit 1");
    tools.add("squeue", "printf '31_0|0|PD|terrazzo:abc||None|ann\\n'");
    CHECK(slurm.submit("x.sh", "job", "abc") == "31");
    CHECK(tools.text("count") == "\n");
  }
  SUBCASE("it refuses") {
    tools.add("sbatch", "echo 'sbatch: error: invalid partition specified: nigth' >&2; exit 1");
    CHECK_THROWS_WITH_AS(slurm.submit("x.sh", "job", "abc"), doctest::Contains("invalid partition specified: nigth"),
                         Error);
    CHECK(told.empty());
  }
  SUBCASE("it says something else") {
    tools.add("sbatch", "echo 'sbatch: error: odd' >&2; exit 0");
    CHECK_THROWS_WITH_AS(slurm.submit("x.sh", "job", "abc"), doctest::Contains("expected the number of the batch job"),
                         Error);
  }
  SUBCASE("cancelled while it waits") {
    tools.add("squeue", "echo 'Unable to contact slurm controller' >&2; exit 1");
    const std::atomic<bool> cancelled = true;
    CHECK_THROWS_AS(Slurm({}, &cancelled).queued("job"), Cancelled);
  }
}

TEST_CASE("a controller that cannot be reached is given up after seconds; the message says what to set") {
  const Tools tools;
  const Slurm slurm;
  const auto message = [&]() -> std::string {
    try {
      slurm.queued("job");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  tools.add("squeue", "echo 'Unable to contact slurm controller' >&2; exit 1");
  SUBCASE("no configuration") {
    tools.add("scontrol", "echo 'fetching' >&2; echo 'scontrol: fatal: no configuration source' >&2; exit 1");
    CHECK(message() ==
          "cannot reach Slurm: scontrol: fatal: no configuration source. SLURM_CONF is not set: set it to the "
          "cluster's slurm.conf, unless Slurm finds it without. --print and --openjd need no Slurm");
    CHECK(slurm.limits({}).tasks == 1001);
  }
  SUBCASE("a configuration that is not there") {
    const Environment setting("SLURM_CONF", "/nowhere/slurm.conf");
    CHECK(message().find("SLURM_CONF names /nowhere/slurm.conf, which does not exist") != std::string::npos);
  }
  SUBCASE("it does not run") {
    const Environment setting("SLURM_CONF", "/etc/passwd");
    tools.add("scontrol", "echo 'Slurmctld(primary) at farm is DOWN'; exit 1");
    CHECK(message().find("farm is DOWN. SLURM_CONF is /etc/passwd") != std::string::npos);
  }
  SUBCASE("it begins to answer") {
    tools.add("scontrol",
              "echo >> asked; [ $(wc -l < asked) -gt 1 ] || { echo 'Slurmctld(primary) at farm is DOWN'; exit 1; }; "
              "echo 'Slurmctld(primary) at farm is UP'");
    tools.add("squeue", "true");
    CHECK(slurm.queued("job").empty());
  }
  SUBCASE("there are no tools") {
    const Environment setting("PATH", "/nowhere");
    CHECK(message().find("must be on $PATH") != std::string::npos);
  }
}

TEST_CASE("what a cluster can give: tasks of an array, and the largest node of the partition") {
  const Tools tools;
  tools.add("scontrol", "echo 'Slurmctld(primary) at farm is UP'; echo 'MaxArraySize            = 21'");
  tools.add("sinfo", "echo $* > asked; printf '4|8000|day*\n8|4000|day*\n64|900000|night\n'");
  const FarmLimits day = Slurm().limits({});
  CHECK(day.tasks == 21);
  CHECK(day.cores == 8);
  CHECK(day.memory == uint64_t{8000} << 20);
  // Which partition is meant is Slurm's to know.
  CHECK(Slurm().limits({.more = {"--qos=long"}}).cores == 64);
  Slurm().limits({.partition = "night"});
  CHECK(tools.text("asked").find("--partition=night") != std::string::npos);
}

TEST_CASE("a template keeps the rules of the Open Job Description specification, 2023-09") {
  FarmJob job;
  job.name = "walls-1";
  job.graph = "walls.json";
  job.program = "terrazzo 1.0";
  std::vector<TaskArray> arrays = {array_of({{"index"}}), array_of({{"a"}, {"b"}, {"c"}})};
  arrays[1].label = std::string(200, 'x');
  arrays[1].needs = {0};
  const auto json =
      nlohmann::json::parse(openjd_template(job, arrays, "/cache/farm/jobs/walls-1", "/usr/bin/terrazzo"));
  CHECK(json.at("specificationVersion") == "jobtemplate-2023-09");
  CHECK(json.at("name").get<std::string>().size() <= 128);
  std::set<std::string> parameters, steps;
  for (const auto& p : json.at("parameterDefinitions")) parameters.insert(p.at("name").get<std::string>());
  for (const auto& step : json.at("steps")) {
    const auto name = step.at("name").get<std::string>();
    CHECK(name.size() <= 64);
    if (step.contains("dependencies"))
      for (const auto& d : step.at("dependencies")) CHECK(steps.contains(d.at("dependsOn").get<std::string>()));
    CHECK(steps.insert(name).second);
    const auto& run = step.at("script").at("actions").at("onRun");
    CHECK(run.at("command") == "{{Param.Program}}");
    CHECK(run.at("args").at(1) == "{{Param.JobFolder}}");
    CHECK(run.at("args").at(5) == "{{Task.Param.Task}}");
    CHECK(step.at("hostRequirements").at("amounts").at(1).at("min") == 500);
  }
  CHECK(parameters == std::set<std::string>{"JobFolder", "Program"});
  CHECK(json.at("steps").at(1).at("parameterSpace").at("taskParameterDefinitions").at(0).at("range") == "0-2");
  CHECK(json.at("steps").at(1).contains("dependencies"));
}
