#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "runner/cli/cli_commands.h"
#include "runner/cli/console.h"
#include "runner/cli/signals.h"

namespace terrazzo {

namespace {

struct CacheFlags {
  std::string folder;
  std::string limit;

  Cache open() const {
    return Cache(folder.empty() ? Cache::default_folder() : std::filesystem::path(folder),
                 limit.empty() ? 0 : parse_bytes(limit, "--limit"));
  }
};

int show_status(const CacheFlags& flags) {
  Cache cache = flags.open();
  const CacheStatus s = cache.status();
  answer("folder  {}\nsize    {} of {}\nstages  {}\nvalues  {}\n", cache.folder().string(), shown_bytes(s.bytes),
         shown_bytes(s.limit), s.stages, s.values);
  return exit_done;
}

int verify(const CacheFlags& flags) {
  const CancelOnSignal signals;
  Cache cache = flags.open();
  const std::vector<std::string> damaged = cache.verify(Task(&signals.flag(), {}));
  for (const std::string& line : damaged) answer("{}\n", line);
  answer("{}\n", damaged.empty() ? "every entry is sound"
                                 : fmt::format("{} damaged, removed; they will be computed again", damaged.size()));
  return damaged.empty() ? exit_done : exit_failed;
}

}  // namespace

void add_cache_command(CLI::App& app, Chosen& chosen) {
  CLI::App* cache = app.add_subcommand("cache", "Manages the cache that runs share");
  cache->require_subcommand(1);
  cache->footer(
      "The folder is $TERRAZZO_CACHE, or terrazzo under $XDG_CACHE_HOME, or ~/.cache/terrazzo.\n"
      "Example:\n  terrazzo cache gc --limit 2G");
  const auto flags = std::make_shared<CacheFlags>();
  const auto add = [&](const char* name, const char* help, const std::function<int(const CacheFlags&)>& act) {
    CLI::App* sub = cache->add_subcommand(name, help);
    sub->add_option("--cache", flags->folder, "The cache's folder, if not the usual one")->type_name("DIR");
    sub->callback([&chosen, flags, act] { chosen = [flags, act] { return act(*flags); }; });
    return sub;
  };
  add("status", "Prints its folder and size", show_status);
  add("verify", "Reads every entry and removes damaged ones; exit code 1 if there were any", verify);
  add("gc", "Evicts entries until the size limit holds",
      [](const CacheFlags& f) {
        answer("{} freed\n", shown_bytes(f.open().collect()));
        return exit_done;
      })
      ->add_option("--limit", flags->limit, "A limit for this call, such as 500M or 2G")
      ->type_name("SIZE");
  add("clear", "Removes everything that no running process uses", [](const CacheFlags& f) {
    answer("{} freed\n", shown_bytes(f.open().clear()));
    return exit_done;
  });
}

}  // namespace terrazzo
