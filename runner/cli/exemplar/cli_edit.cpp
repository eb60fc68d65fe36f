#include <filesystem>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file/atomic_file.h"
#include "core/file/private_folder.h"
#include "core/image_io/image_file.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/exemplar/new_graph.h"
#include "runner/editor/edited_document_access.h"
#include "runner/editor/server.h"
#include "runner/terminal/console.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct EditFlags {
  std::string graph;
  int port = 0;
  bool no_open = false, read_only = false, no_cache = false;
  std::vector<std::string> allow;
  std::string cache;
  int threads = 0;
  LimitFlags limits{};
};

/// How often the program looks whether it has been told to stop.
constexpr std::chrono::milliseconds between_looks_at_signals{50};

/// As `new` makes it, whose argument has another name.
NewGraph graph_for(const ExemplarFlags& exemplar, const fs::path& graph, const std::atomic<bool>& cancelled) try {
  return new_graph(exemplar, graph, std::string(stock_graph_like(exemplar)), cancelled);
} catch (const GraphError& e) {
  std::vector<Problem> problems = e.problems();
  for (Problem& p : problems) p.where.clear();
  throw GraphError(e.file(), std::move(problems));
}

/// A graph that does not exist begins empty. Only a name that says so is one: a folder or a picture may be misspelled.
void begin_new(const EditFlags& flags) {
  const fs::path graph = fs::absolute(flags.graph);
  std::error_code missing;
  if (graph.extension() != ".json" || graph.stem().empty())
    throw UsageError(fmt::format("{} does not exist; a new graph's name ends in .json", flags.graph));
  if (!fs::is_directory(graph.parent_path(), missing))
    throw UsageError(fmt::format("{} does not exist, and there is no folder {} for a new graph", flags.graph,
                                 graph.parent_path().string()));
  if (flags.read_only) throw UsageError(fmt::format("{} does not exist, and --read-only writes nothing", flags.graph));
  print_message("{} does not exist yet: it begins empty, and the first edit writes it\n", flags.graph);
}

/// The graph file to edit: the one given, or that of a folder of maps or a picture, which is written if there is none.
/// Nullopt if the folder makes no graph; `exit_code` then says why.
std::optional<fs::path> graph_to_edit(const EditFlags& flags, const std::atomic<bool>& cancelled, int& exit_code) {
  const fs::path given = flags.graph;
  std::error_code missing;
  const bool is_picture = looks_like_image(given) && fs::is_regular_file(given, missing);
  if (!fs::is_directory(given, missing) && !is_picture) {
    if (!fs::exists(given, missing)) begin_new(flags);
    return given;
  }
  const fs::path exemplar = fs::canonical(given);
  if (!exemplar.has_filename()) throw UsageError(fmt::format("{} is no folder of maps", flags.graph));
  const fs::path graph =
      exemplar.parent_path() / ((is_picture ? exemplar.stem() : exemplar.filename()).string() + ".json");
  if (fs::exists(graph, missing)) {
    print_message("{} exists, and is opened\n", graph.string());
    return graph;
  }
  if (flags.read_only) throw UsageError(fmt::format("{} has no graph yet, and --read-only writes none", flags.graph));
  const NewGraph made = graph_for({.folder = flags.graph}, graph, cancelled);
  exit_code = made.exit_code;
  if (exit_code != exit_done) return std::nullopt;
  write_whole_file(graph, made.text);
  for (const std::string& line : made.findings) print_message("{}\n", line);
  print_message("wrote {}\n", graph.string());
  return graph;
}

/// Without a shell. A missing or failing program does not matter: the address has been printed.
void open_in_browser(const std::string& address) {
  std::string program = "xdg-open", argument = address;
  char* words[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
  pid_t process = -1;
  const int failure = ::posix_spawnp(&process, words[0], &actions, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) {
    print_message("open the address in a browser\n");
    return;
  }
  std::thread([process] { ::waitpid(process, nullptr, 0); }).detach();
}

Sandbox sandbox_for(const fs::path& graph, const std::vector<std::string>& allow) {
  Sandbox out(graph.parent_path(), "start with --allow FOLDER to let the graph use it");
  for (const std::string& folder : allow) {
    std::error_code missing;
    if (!fs::is_directory(folder, missing))
      throw UsageError(fmt::format("--allow {}: there is no such folder", folder));
    out.open(folder);
  }
  return out;
}

int edit(const EditFlags& flags) {
  flags.limits.apply();
  const CancelOnSignal signals;
  int exit_code = exit_done;
  const std::optional<fs::path> given = graph_to_edit(flags, signals.flag(), exit_code);
  if (!given) return exit_code;
  const fs::path graph = fs::absolute(*given).lexically_normal();
  const Sandbox sandbox = sandbox_for(graph, flags.allow);
  // Without a cache every change would begin from the start.
  std::optional<PrivateFolder> passing;
  if (flags.no_cache) passing.emplace(fs::temp_directory_path(), "terrazzo-edit");
  Session session({.cache = passing ? passing->path() : fs::path(flags.cache), .threads = flags.threads});
  EditedDocumentAccess document(graph, flags.read_only);
  EditorServer::Options options{.port = flags.port};
  for (const std::string& folder : flags.allow) options.folders.push_back(fs::canonical(folder));
  EditorServer server(document, session, sandbox, options);
  print_result("{}\n", server.address());
  if (!flags.no_open) open_in_browser(server.address());
  while (!signals.flag()) std::this_thread::sleep_for(between_looks_at_signals);
  return exit_done;
}

}  // namespace

void add_edit_command(Command& program) {
  Command& command = program.add_command("edit", "Opens a graph in an editor in the browser");
  const auto flags = std::make_shared<EditFlags>();
  command
      .add_option(
          "GRAPH", &flags->graph,
          "The graph file; a .json that does not exist begins empty, and the first edit writes it. Or a folder of "
          "maps, or a picture: its graph FOLDER.json is written beside it, if there is none")
      .required();
  command.add_option("--port", &flags->port, "The port to listen at, on this machine only; a free one if not given")
      .takes("N")
      .from_to(1, 65535);
  command.add_flag("--no-open", &flags->no_open, "Only print the address; open no browser");
  command.add_flag("--read-only", &flags->read_only, "Show the graph and its results; change and write nothing");
  command
      .add_option("--allow", &flags->allow,
                  "Lets the graph read and write in this folder, too; else only in its own; may be given several times")
      .takes("DIR")
      .repeated();
  command.add_option("--cache", &flags->cache, "Folder of the cache, if not the default").takes("DIR");
  command.add_flag("--no-cache", &flags->no_cache, "Keep no results when the editor ends").not_with("--cache");
  command.add_option("--threads", &flags->threads, "Threads to use; one per core if not given")
      .takes("N")
      .from_to(1, 1024);
  add_limit_flags(command, flags->limits);
  command.footer =
      "It prints an address that works once, and opens it. Opening a graph runs none of its sinks: files are written "
      "when you ask for it. Ctrl-C ends it.\n"
      "Examples:\n"
      "  terrazzo edit bricks.json\n"
      "  terrazzo edit bricks/ --allow ../scans";
  command.run = [flags] { return edit(*flags); };
}

}  // namespace terrazzo
