#include <algorithm>
#include <cerrno>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/portable_math.h"
#include "core/node/serialize.h"
#include "runner/cache/cache_records.h"
#include "runner/cache/cache_state.h"

namespace terrazzo {

namespace {

/// How full the cache is after an eviction: room for some runs before the next.
constexpr double filled_after_eviction = 0.9;
constexpr double half_life_days = 7;
/// Small entries that nothing is known to need are kept this long after their last use.
constexpr double kept_unused_days = 30;
/// Removals under one hold of the eviction lock, which those who ask for values wait for.
constexpr size_t removals_at_once = 64;

double days_unused(const CacheEntry& entry, int64_t now) {
  return std::max(0.0, double(now - entry.used_ns) / double(24 * 3600 * ns_per_second));
}

/// What a byte of the entry is worth: seconds to compute it again, less the longer it has not been used.
double worth(const CacheEntry& entry, int64_t now) {
  constexpr double least_seconds = 1e-3;
  double seconds = 0;
  try {
    seconds = summarize_value_file(entry.path).seconds;
  } catch (const Error&) {
    return -1;
  }
  const double discount = portable::pow(0.5, days_unused(entry, now) / half_life_days);
  return std::max(seconds, least_seconds) * discount / double(std::max<uint64_t>(1, entry.bytes));
}

std::vector<CacheEntry> cheapest_first(const std::vector<CacheEntry>& values) {
  const int64_t now = now_ns();
  std::vector<std::pair<double, const CacheEntry*>> order;
  for (const CacheEntry& e : values) order.push_back({worth(e, now), &e});
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.first, a.second->used_ns, a.second->name) <
           std::tuple(b.first, b.second->used_ns, b.second->name);
  });
  std::vector<CacheEntry> sorted;
  for (const auto& [worth, entry] : order) sorted.push_back(*entry);
  return sorted;
}

std::vector<CacheEntry> of_kind(const CacheScan& scan, EntryKind kind) {
  std::vector<CacheEntry> found;
  std::copy_if(scan.entries.begin(), scan.entries.end(), std::back_inserter(found),
               [kind](const CacheEntry& e) { return e.kind == kind; });
  return found;
}

uint64_t remove(const std::filesystem::path& path, uint64_t bytes) {
  return ::unlink(path.c_str()) == 0 ? bytes : 0;
}

/// Removes values in the order given, but no pinned ones, until `enough` bytes are freed. Returns the bytes freed.
uint64_t remove_values(const CacheFolder& folder, const std::vector<CacheEntry>& values, uint64_t enough) {
  uint64_t freed = 0;
  for (size_t first = 0; first < values.size() && freed < enough; first += removals_at_once) {
    const EvictionLock lock(folder.lock());
    const LivePins pins = read_live_pins(folder.pins());
    const size_t end = std::min(values.size(), first + removals_at_once);
    for (size_t i = first; i < end && freed < enough; i++)
      if (!pins.values.count(values[i].name)) freed += remove(values[i].path, values[i].bytes);
  }
  return freed;
}

/// Removes what dead processes left: their leases, their pins, and what they had half-written.
uint64_t remove_abandoned(const CacheFolder& folder, const std::vector<TemporaryEntry>& temporaries) {
  remove_abandoned_leases(folder.leases());
  const EvictionLock lock(folder.lock());
  const LivePins pins = read_live_pins(folder.pins());
  uint64_t freed = 0;
  for (const TemporaryEntry& t : temporaries)
    if (!pins.owners.count(t.owner)) freed += remove(t.path, t.bytes);
  return freed;
}

/// Whether any value that a stage's record names is still there. False for records that cannot be read.
bool has_values_left(const CacheFolder& folder, const CacheEntry& stage) {
  try {
    const auto bytes = CacheFolder::read(stage.path);
    if (!bytes) return false;
    const StageRecord record = stage_from_bytes(stage.name, *bytes);
    return std::any_of(record.outputs.begin(), record.outputs.end(), [&](const auto& output) {
      return ::access(folder.path_of(EntryKind::value, output.second).c_str(), F_OK) == 0;
    });
  } catch (const Error&) {
    return false;
  }
}

/// Reads an entry from its first to its last byte. Throws DamagedFile, or Error if it cannot be read.
void read_all(const CacheEntry& entry) {
  if (entry.kind == EntryKind::value) {
    if (digest_of(load_value(entry.path)) != entry.name)
      throw DamagedFile(fmt::format("{} is stored under another value's name", entry.path.string()));
    return;
  }
  const auto bytes = CacheFolder::read(entry.path);
  if (!bytes) return;
  try {
    if (entry.kind == EntryKind::stage)
      stage_from_bytes(entry.name, *bytes);
    else
      memo_from_bytes(entry.name, *bytes);
  } catch (const DamagedFile& e) {
    throw DamagedFile(fmt::format("{} cannot be used: {}", entry.path.string(), e.what()));
  }
}

}  // namespace

CacheStatus Cache::status() {
  const CacheScan scan = state_->folder.scan();
  CacheStatus status{scan.bytes(), state_->limit, 0, 0};
  for (const CacheEntry& e : scan.entries) {
    status.stages += e.kind == EntryKind::stage;
    status.values += e.kind == EntryKind::value;
  }
  return status;
}

std::vector<std::string> Cache::verify(const Task& task) {
  const CacheScan scan = state_->folder.scan();
  std::vector<std::string> damaged;
  const uint64_t total = scan.bytes();
  uint64_t done = 0;
  for (const CacheEntry& e : scan.entries) {
    task.progress(double(done) / double(total));
    done += e.bytes;
    try {
      read_all(e);
    } catch (const DamagedFile& trouble) {
      ::unlink(e.path.c_str());
      damaged.push_back(trouble.what());
    } catch (const FileError& trouble) {
      if (trouble.code() != ENOENT) state_->warn(trouble.what());
    } catch (const Error& trouble) {
      state_->warn(trouble.what());
    }
  }
  return damaged;
}

uint64_t Cache::collect() {
  const CacheFolder& folder = state_->folder;
  const CacheScan scan = folder.scan();
  uint64_t freed = remove_abandoned(folder, scan.temporaries);
  const uint64_t total = scan.bytes() - freed;
  if (total > state_->limit) {
    const auto target = uint64_t(double(state_->limit) * filled_after_eviction);
    freed += remove_values(folder, cheapest_first(of_kind(scan, EntryKind::value)), total - target);
  }
  const int64_t now = now_ns();
  for (const CacheEntry& e : scan.entries) {
    if (e.kind == EntryKind::value || days_unused(e, now) < kept_unused_days) continue;
    if (e.kind == EntryKind::file || !has_values_left(folder, e)) freed += remove(e.path, e.bytes);
  }
  return freed;
}

uint64_t Cache::clear() {
  const CacheFolder& folder = state_->folder;
  const CacheScan scan = folder.scan();
  uint64_t freed = remove_abandoned(folder, scan.temporaries);
  freed += remove_values(folder, of_kind(scan, EntryKind::value), scan.bytes() + 1);
  for (const CacheEntry& e : scan.entries)
    if (e.kind == EntryKind::file || (e.kind == EntryKind::stage && !has_values_left(folder, e)))
      freed += remove(e.path, e.bytes);
  return freed;
}

}  // namespace terrazzo
