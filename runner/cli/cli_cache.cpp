#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/suggest.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_folder.h"
#include "runner/cli/cli_commands.h"
#include "runner/terminal/console.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// The end of a message about a missing folder.
std::string folder_hint(const fs::path& folder) {
  const fs::path path = without_trailing_slash(fs::absolute(folder));
  std::vector<std::string> siblings;
  std::error_code unreadable;
  for (fs::directory_iterator at(path.parent_path(), unreadable), end; !unreadable && at != end;
       at.increment(unreadable))
    if (CacheFolder::is_in(at->path())) siblings.push_back(at->path().filename().string());
  std::sort(siblings.begin(), siblings.end());
  return did_you_mean(path.filename().string(), siblings);
}

struct CacheFlags {
  std::string folder;
  std::string limit;

  fs::path path() const { return folder.empty() ? Cache::default_folder() : fs::path(folder); }

  /// The cache; null if the default one does not exist yet. Only runs create caches, so a misspelt name is an error.
  std::unique_ptr<Cache> open() const {
    const uint64_t bytes = limit.empty() ? 0 : parse_bytes(limit, "--limit");
    std::error_code missing;
    if (CacheFolder::is_in(path())) return as_usage([&] { return std::make_unique<Cache>(path(), bytes); });
    if (folder.empty() && !fs::exists(path(), missing)) return nullptr;
    if (fs::exists(path(), missing))
      throw UsageError(fmt::format("{} is not a cache: it has no folder v1{}", path().string(), folder_hint(path())));
    throw UsageError(fmt::format("--cache {}: there is no such folder{}", folder, folder_hint(path())));
  }
};

int no_cache_yet(const CacheFlags& flags) {
  print_result("there is no cache yet in {}; the first run makes it\n", flags.path().string());
  return exit_done;
}

int show_status(const CacheFlags& flags) {
  const std::unique_ptr<Cache> cache = flags.open();
  if (!cache) return no_cache_yet(flags);
  const CacheStatus s = cache->status();
  print_result("folder  {}\nsize    {} of {}\nlimit   from {}\nstages  {}\nvalues  {}\ngraphs  {}\n",
               cache->folder().string(), shown_bytes(s.bytes), shown_bytes(s.limit), s.limit_from, s.stages, s.values,
               s.histories);
  return exit_done;
}

/// A one-line summary of the findings.
std::string verdict_text(const CacheVerdict& verdict) {
  const size_t damaged = verdict.damaged.size(), removed = damaged - size_t(verdict.left);
  if (damaged == 0) return "every entry is sound";
  if (verdict.left == 0) return fmt::format("{} damaged, removed; they will be computed again", damaged);
  return fmt::format(
      "{} damaged, {} removed; the others cannot be removed, are not used, and are computed again by every run that "
      "needs them: verify as a user who may write to the cache",
      damaged, removed);
}

int verify(const CacheFlags& flags) {
  const CancelOnSignal signals;
  const std::unique_ptr<Cache> cache = flags.open();
  if (!cache) return no_cache_yet(flags);
  const CacheVerdict verdict = cache->verify(Task(&signals.flag(), {}));
  for (const std::string& line : verdict.damaged) print_result("{}\n", line);
  for (const std::string& warning : cache->take_warnings()) print_message("warning: {}\n", warning);
  print_result("{}\n", verdict_text(verdict));
  return verdict.damaged.empty() ? exit_done : exit_failed;
}

int free_with(const CacheFlags& flags, uint64_t (Cache::*act)()) {
  const std::unique_ptr<Cache> cache = flags.open();
  if (!cache) return no_cache_yet(flags);
  print_result("{} freed\n", shown_bytes((cache.get()->*act)()));
  return exit_done;
}

}  // namespace

void add_cache_command(Command& program) {
  Command& cache = program.add_command("cache", "Manages the cache that runs share");
  cache.footer =
      "The folder is $TERRAZZO_CACHE, or terrazzo under $XDG_CACHE_HOME, or ~/.cache/terrazzo.\n"
      "Example:\n  terrazzo cache gc --limit 2G";
  const auto flags = std::make_shared<CacheFlags>();
  const auto add = [&](const char* name, const char* help,
                       const std::function<int(const CacheFlags&)>& act) -> Command& {
    Command& sub = cache.add_command(name, help);
    sub.add_option("--cache", &flags->folder, "The cache's folder, if not the default").takes("DIR");
    sub.run = [flags, act] { return act(*flags); };
    return sub;
  };
  add("status", "Prints its folder and size", show_status);
  add("verify", "Reads every entry and removes damaged ones; exit code 1 if there were any", verify);
  add("gc", "Evicts entries until the size limit holds",
      [](const CacheFlags& f) { return free_with(f, &Cache::collect); })
      .add_option("--limit", &flags->limit, "A limit for this call, such as 500M or 2G")
      .takes("SIZE");
  add("clear", "Removes everything that no running process uses",
      [](const CacheFlags& f) { return free_with(f, &Cache::clear); });
}

}  // namespace terrazzo
